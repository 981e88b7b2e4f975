"""Write the results of one run into a gradebook."""

from collections.abc import Iterable
from datetime import UTC, datetime
from typing import Any

from grader import __version__
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.result import UNITS_PER_POINT, GradingResult
from grader.classroom.gradebook.stored import (
    PROFILE_COLUMNS,
    Enrolment,
    StoredSubmission,
    files_json,
    profile_of,
    storable,
)
from grader.classroom.students import ClassSubmission, Student
from grader.files.reading import sha256_of
from grader.grading.rubric import Rubric

_FIND = f"SELECT id, {', '.join(PROFILE_COLUMNS)} FROM student WHERE key = ?"
_UPDATE = f"UPDATE student SET {', '.join(f'{name} = ?' for name in PROFILE_COLUMNS)} WHERE id = ?"
_NEWEST = "SELECT id, rubric, version, digest, template, record, urdf, robot FROM result WHERE student = ? ORDER BY id DESC LIMIT 1"


class RunWriter:
    """Begins a run in a gradebook and writes its results. `run` is its id."""

    def __init__(
        self, book: Gradebook, source: str, layout: str, rubric: Rubric, deadline: str = "", assignment: str = ""
    ) -> None:
        self._book, self._rubric = book, rubric.sha256
        self._template: str | None = None
        with book.transaction():
            _save_rubric(book, rubric)
            (last_mark,) = book.connection.execute("SELECT coalesce(max(id), 0) FROM mark").fetchone()
            row = {"started": _now(), "source": storable(source), "layout": layout, "rubric": rubric.sha256}
            row |= {"version": __version__, "last_mark": last_mark}
            row |= {"deadline": deadline, "assignment": storable(assignment)}
            self.run = _insert(book, "run", row)

    def use_template(self, template: str) -> None:
        """Store the next records as differences from a template; an empty one means none."""
        self._template = sha256_of(template.encode()) if template else None
        if template:
            with self._book.transaction():
                query = "INSERT OR IGNORE INTO template VALUES (?, ?)"
                self._book.connection.execute(query, (self._template, template))

    def add_handed_out(self, hashes: Iterable[str]) -> None:
        """Record hashes of URDFs and robots that the course handed out."""
        with self._book.transaction():
            rows = [(sha256,) for sha256 in hashes]
            self._book.connection.executemany("INSERT OR IGNORE INTO handed_out VALUES (?)", rows)

    def add_result(self, student: int, result: GradingResult) -> int:
        """Add a result, unless the student's newest one is the same; return its id."""
        newest = self._book.connection.execute(_NEWEST, (student,)).fetchone()
        hashes = result.urdf, result.robot
        same = (self._rubric, __version__, result.digest, self._template, result.record, *hashes)
        if newest is not None and newest[1:] == same:
            return int(newest[0])
        values = {**result._asdict(), "reason": storable(result.reason), "undecided": storable(result.undecided)}
        del values["key"], values["fingerprint"]  # the other fields are columns
        row = {"student": student, "rubric": self._rubric, "version": __version__, "template": self._template}
        return _insert(self._book, "result", row | values)

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
        return _insert(book, "student", dict(zip(PROFILE_COLUMNS, profile_of(student, enrolment), strict=True)))
    number, *before = found
    after = profile_of(student, enrolment, before)
    if after != tuple(before):
        book.connection.execute(_UPDATE, (*after, number))
    return int(number)


def _save_rubric(book: Gradebook, rubric: Rubric) -> None:
    sha256, execute = rubric.sha256, book.connection.execute
    row = (sha256, rubric.id, rubric.title, storable(str(rubric.path)), rubric.data)
    execute("INSERT OR IGNORE INTO rubric VALUES (?, ?, ?, ?, ?)", row)
    for position, criterion in enumerate(rubric.criteria):
        units = int(criterion.points * UNITS_PER_POINT)
        kinds = int(criterion.bonus), int(criterion.adjustment is not None)
        execute(
            "INSERT OR IGNORE INTO criterion VALUES (?, ?, ?, ?, ?, ?)", (sha256, criterion.id, position, units, *kinds)
        )
        if criterion.answer:
            answer = (sha256, criterion.id, storable(criterion.answer))
            execute("INSERT OR REPLACE INTO model_answer VALUES (?, ?, ?)", answer)


def _insert(book: Gradebook, table: str, values: dict[str, Any]) -> int:
    """Insert a row and return its id."""
    query = f"INSERT INTO {table} ({', '.join(values)}) VALUES ({', '.join('?' * len(values))})"
    return int(book.connection.execute(query, tuple(values.values())).lastrowid or 0)


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="seconds")
