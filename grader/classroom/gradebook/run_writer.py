"""Write the results of one run into a gradebook."""

from collections.abc import Iterable
from datetime import UTC, datetime
from typing import Any

from grader import __version__
from grader.checks.manual import MANUAL_CHECKS
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.result import GradingResult, storable, units_of
from grader.classroom.gradebook.stored import PROFILE_COLUMNS, Enrolment, StoredSubmission, files_json, profile_of
from grader.classroom.students import ClassSubmission, Student
from grader.files.reading import URDF_LIMIT, sha256_of
from grader.grading.rubric import Rubric

_FIND = f"SELECT id, {', '.join(PROFILE_COLUMNS)} FROM student WHERE key = ?"
_UPDATE = f"UPDATE student SET {', '.join(f'{name} = ?' for name in PROFILE_COLUMNS)} WHERE id = ?"
_NEWEST = """
SELECT id, rubric, version, digest, dictionary, record, urdf, robot, forms FROM result WHERE student = ?
ORDER BY id DESC LIMIT 1
"""


class RunWriter:
    """Begins a run in a gradebook and writes its results. `run` is its id."""

    def __init__(
        self,
        book: Gradebook,
        source: str,
        layout: str,
        rubric: Rubric,
        deadline: str = "",
        assignment: str = "",
        max_size: int = URDF_LIMIT,
    ) -> None:
        self._book, self._rubric = book, rubric.sha256
        self._dictionary: str | None = None
        with book.transaction():
            _save_rubric(book, rubric)
            (last_mark,) = book.connection.execute("SELECT coalesce(max(id), 0) FROM mark").fetchone()
            row: dict[str, Any] = {"started": _now(), "source": storable(source), "layout": layout}
            row |= {"rubric": rubric.sha256, "version": __version__, "last_mark": last_mark}
            row |= {"deadline": deadline, "assignment": storable(assignment), "max_size": max_size}
            self.run = book.insert("run", row)

    def use_dictionary(self, dictionary: bytes) -> None:
        """Record that the next records are compressed with a dictionary; an empty one means none."""
        self._dictionary = sha256_of(dictionary) if dictionary else None
        if dictionary:
            with self._book.transaction():
                query = "INSERT OR IGNORE INTO dictionary VALUES (?, ?)"
                self._book.connection.execute(query, (self._dictionary, dictionary))

    def add_handed_out(self, hashes: Iterable[str]) -> None:
        """Record hashes of URDFs and robots that the course handed out."""
        with self._book.transaction():
            rows = [(sha256,) for sha256 in hashes]
            self._book.connection.executemany("INSERT OR IGNORE INTO handed_out VALUES (?)", rows)

    def add_result(self, student: int, result: GradingResult) -> int:
        """Add a result, unless the student's newest one is the same; return its id."""
        newest = self._book.connection.execute(_NEWEST, (student,)).fetchone()
        hashes = result.urdf, result.robot, result.forms
        same = (self._rubric, __version__, result.digest, self._dictionary, result.record, *hashes)
        if newest is not None and newest[1:] == same:
            return int(newest[0])
        row = {"student": student, "rubric": self._rubric, "version": __version__, "dictionary": self._dictionary}
        columns = ("digest", "verdict", "parts", "score", "out_of", "pending", "record", "urdf", "robot", "forms")
        values = {name: getattr(result, name) for name in columns}
        number = self._book.insert("result", row | values | {"reason": storable(result.reason)})
        rows = [(number, *outcome) for outcome in result.outcomes]
        self._book.connection.executemany("INSERT INTO outcome VALUES (?, ?, ?, ?, ?, ?)", rows)
        return number

    def add_submission(self, student: int, result: int, submission: ClassSubmission, fingerprint: str) -> None:
        """Record that this run found a submission, and which result it has."""
        files = files_json(submission)
        row = (student, self.run, result, files, fingerprint, int(submission.is_late), submission.submitted)
        self._book.connection.execute("INSERT INTO submission VALUES (?, ?, ?, ?, ?, ?, ?, 0)", row)

    def add_gone(self, stored: StoredSubmission) -> None:
        """Record that a submission is no longer in the class, unless this run has found it elsewhere."""
        row = (stored.student_id, self.run, stored.result, stored.files, "", stored.is_late, stored.submitted)
        query = "INSERT INTO submission VALUES (?, ?, ?, ?, ?, ?, ?, 1) ON CONFLICT DO NOTHING"
        self._book.connection.execute(query, row)

    def remove_from_roster(self, student: int) -> None:
        """Record that a student is no longer on the roster."""
        self._book.connection.execute("UPDATE student SET is_on_roster = 0, roster_entry = '' WHERE id = ?", (student,))

    def rename(self, student: int, key: str) -> bool:
        """Give a student another key; return False if another student with a result or mark has that key."""
        with self._book.transaction():
            connection = self._book.connection
            taken = connection.execute("SELECT id FROM student WHERE key = ?", (key,)).fetchone()
            if taken is not None:
                query = "SELECT 1 FROM result WHERE student = ? UNION ALL SELECT 1 FROM mark WHERE student = ? LIMIT 1"
                if connection.execute(query, (taken[0], taken[0])).fetchone() is not None:
                    return False
                connection.execute("DELETE FROM student WHERE id = ?", taken)  # has submitted nothing so far
            connection.execute("UPDATE student SET key = ? WHERE id = ?", (key, student))
        return True

    def finish(self) -> None:
        """Record that the run is complete."""
        with self._book.transaction():
            self._book.connection.execute("UPDATE run SET finished = ? WHERE id = ?", (_now(), self.run))


def save_student(book: Gradebook, student: Student, enrolment: Enrolment | None) -> int:
    """Add or update a student; return the id. Empty fields, and an `enrolment` of None, keep what is stored."""
    found = book.connection.execute(_FIND, (student.key,)).fetchone()
    if found is None:
        return book.insert("student", dict(zip(PROFILE_COLUMNS, profile_of(student, enrolment), strict=True)))
    number, *before = found
    after = profile_of(student, enrolment, before)
    if after != tuple(before):
        book.connection.execute(_UPDATE, (*after, number))
    return int(number)


def _save_rubric(book: Gradebook, rubric: Rubric) -> None:
    own = {"rubric": rubric.sha256}
    row: dict[str, Any] = {"sha256": rubric.sha256, "id": rubric.id, "title": rubric.title, "text": rubric.data}
    book.insert("rubric", row | {"path": storable(str(rubric.path))}, unless_known=True)
    for criterion in rubric.criteria:
        row = {
            "id": criterion.id,
            "position": criterion.position,
            "points": units_of(criterion.points),
            "is_bonus": criterion.bonus,
            "is_adjusted": criterion.adjustment is not None,
            "is_manual": criterion.check.function in MANUAL_CHECKS,
        }
        book.insert("criterion", own | row, unless_known=True)
    save_answers(book, rubric)


def save_answers(book: Gradebook, rubric: Rubric) -> None:
    """Save the model answers that a rubric was loaded with, for those who grade."""
    answers = [(rubric.sha256, row.id, storable(row.answer)) for row in rubric.criteria if row.answer]
    book.connection.executemany("INSERT OR REPLACE INTO model_answer VALUES (?, ?, ?)", answers)


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="seconds")
