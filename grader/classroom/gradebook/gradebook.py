"""The gradebook: one SQLite file with what the checks have found and what people have decided, which no re-run changes."""

import sqlite3
import zlib
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, NamedTuple, Self

from grader import __version__
from grader.classroom.gradebook.database import PATIENCE, prepare
from grader.classroom.gradebook.result import UNITS_PER_POINT, GradingResult
from grader.classroom.gradebook.stored import (
    ADD_STUDENT,
    ALL_STUDENTS,
    CHANGE_STUDENT,
    FIND_STUDENT,
    KNOWN,
    UNKNOWN,
    Enrolment,
    StoredSubmission,
    known_of,
    place_of,
    storable,
    told_of,
    values_of,
)
from grader.classroom.students import ClassSubmission, Student
from grader.errors import GraderError, InputError
from grader.files.reading import sha256_of
from grader.grading.answers import with_answers
from grader.grading.rubric import Rubric, read_rubric
from grader.text import printable_path


class Run(NamedTuple):
    """One batch: when, of what, by which rubric and grader. `finished` is empty for one that was cut off."""

    id: int
    started: str
    finished: str
    source: str
    layout: str
    rubric: str
    version: str
    last_mark: int


class Gradebook:
    """An open gradebook. Raises InputError for a file that is none, and where it cannot be written."""

    def __init__(self, path: Path, *, create: bool = False) -> None:
        self.path = path
        self._shown = printable_path(path)
        self._template: str | None = None
        if not create and not path.exists():
            raise InputError(
                f"there is no gradebook {self._shown}: grader batch PATH --gradebook {self._shown} makes one"
            )
        if not path.parent.exists():
            folder = printable_path(path.parent)
            raise InputError(f"the gradebook {self._shown}: there is no folder {folder} (mkdir -p {folder} makes it)")
        with self.complaining():
            self.connection = sqlite3.connect(path, timeout=PATIENCE, isolation_level=None)
            try:
                prepare(self.connection, self._shown)
            except BaseException:
                self.connection.close()
                raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close it; what was not committed is gone."""
        with suppress(sqlite3.Error):
            self.connection.close()

    @contextmanager
    def complaining(self) -> Iterator[None]:
        """Turn what SQLite says into one plain sentence."""
        try:
            yield
        except sqlite3.DatabaseError as error:
            is_another = error.sqlite_errorcode in (sqlite3.SQLITE_NOTADB, sqlite3.SQLITE_CANTOPEN)
            advice = "; name another file" if is_another else ""
            raise InputError(f"the gradebook {self._shown}: {error}{advice}") from None

    def nothing_graded(self) -> InputError:
        """What to say where there was no run yet."""
        command = f"grader batch PATH --gradebook {self._shown}"
        return InputError(f"nothing has been graded into {self._shown} yet: {command} does that")

    @contextmanager
    def transaction(self) -> Iterator[None]:
        """All of what is written inside, or nothing of it."""
        with self.complaining():
            self.connection.execute("BEGIN IMMEDIATE")
            try:
                yield
            except BaseException:
                if self.connection.in_transaction:
                    self.connection.execute("ROLLBACK")
                raise
            self.connection.execute("COMMIT")

    # --- what a batch writes -------------------------------------------------------------------------------------------

    def begin(self, source: str, layout: str, rubric: Rubric, due: str = "", assignment: str = "") -> int:
        """Begin a run; its number."""
        with self.transaction():
            self._keep_rubric(rubric)
            last_mark = self.connection.execute("SELECT coalesce(max(id), 0) FROM mark").fetchone()[0]
            row = (_now(), storable(source), layout, rubric.sha256, __version__, last_mark, due, storable(assignment))
            found = self.connection.execute(
                "INSERT INTO run (started, source, layout, rubric, version, last_mark, due, assignment)"
                " VALUES (?, ?, ?, ?, ?, ?, ?, ?)",
                row,
            )
            return int(found.lastrowid or 0)

    def keep_beside(self, template: str) -> None:
        """Keep the records that follow beside a template; beside none, if it is empty."""
        self._template = sha256_of(template.encode()) if template else None
        if template:
            with self.transaction():
                self.connection.execute("INSERT OR IGNORE INTO template VALUES (?, ?)", (self._template, template))

    def finish(self, run: int) -> None:
        """Note that a run went through to its end."""
        with self.transaction():
            self.connection.execute("UPDATE run SET finished = ? WHERE id = ?", (_now(), run))

    def _keep_rubric(self, rubric: Rubric) -> None:
        row = (rubric.sha256, rubric.id, rubric.title, storable(str(rubric.path)), rubric.data)
        self.connection.execute("INSERT OR IGNORE INTO rubric VALUES (?, ?, ?, ?, ?)", row)
        self.connection.executemany(
            "INSERT OR IGNORE INTO criterion VALUES (?, ?, ?, ?)",
            [
                (rubric.sha256, criterion.id, position, int(criterion.points * UNITS_PER_POINT))
                for position, criterion in enumerate(rubric.criteria)
            ],
        )
        self.connection.executemany(
            "INSERT OR REPLACE INTO model_answer VALUES (?, ?, ?)",
            [(rubric.sha256, each.id, storable(each.answer)) for each in rubric.criteria if each.answer],
        )

    def all_known(self) -> Iterator[StoredSubmission]:
        """What there is of everyone, in the order of their keys, as it was when this began, whatever is written meanwhile."""
        with self.complaining(), closing(sqlite3.connect(self.path, timeout=PATIENCE)) as beside:
            for row in beside.execute(f"{KNOWN} ORDER BY student.key"):
                yield known_of(row)

    def keep_student(self, student: Student, enrolment: Enrolment | None) -> int:
        """Take in what is known of a student; what was known before and is not said now stays. `enrolment` is the roster's word."""
        found = self.connection.execute(FIND_STUDENT, (student.key,)).fetchone()
        if found is None:
            added = self.connection.execute(ADD_STUDENT, (*values_of(student), *(enrolment or UNKNOWN)))
            return int(added.lastrowid or 0)
        identity, *before = found
        told = told_of(tuple(before), student, enrolment)
        if told != tuple(before):
            self.connection.execute(CHANGE_STUDENT, (*told, identity))
        return int(identity)

    def keep(self, student: int, rubric: str, graded: GradingResult) -> int:
        """Add a result, unless the newest one of the student says the same; its number."""
        newest = self.connection.execute(
            "SELECT id, rubric, version, digest, template, record FROM result WHERE student = ? ORDER BY id DESC LIMIT 1",
            (student,),
        ).fetchone()
        same = (rubric, __version__, graded.digest, self._template, graded.record)
        if newest is not None and newest[1:] == same:
            return int(newest[0])
        row = (
            student, rubric, __version__, graded.digest, graded.verdict, storable(graded.reason), graded.score, graded.out_of,
            graded.pending, graded.signs, graded.misses, self._template, graded.record,
        )  # fmt: skip
        added = self.connection.execute(
            "INSERT INTO result (student, rubric, version, digest, verdict, reason, score, out_of, pending, signs, misses,"
            " template, record) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
            row,
        )
        return int(added.lastrowid or 0)

    def see(self, student: int, run: int, result: int, hand_in: ClassSubmission, fingerprint: str) -> None:
        """Note that a run has seen this of a student, and which result it has."""
        row = (student, run, result, place_of(hand_in), fingerprint, int(hand_in.is_late), hand_in.submitted)
        self.connection.execute("INSERT INTO seen VALUES (?, ?, ?, ?, ?, ?, ?, 0)", row)

    def see_gone(self, known: StoredSubmission, run: int) -> None:
        """Note that a hand-in is not there any more where the run before has seen it, unless this run has seen it after all."""
        row = (known.student, run, known.result, known.place, "", known.is_late, known.submitted, 1)
        self.connection.execute("INSERT INTO seen VALUES (?, ?, ?, ?, ?, ?, ?, ?) ON CONFLICT DO NOTHING", row)

    def leave_roster(self, student: int) -> None:
        """Note of a student who was on the roster that they no longer are."""
        self.connection.execute("UPDATE student SET expected = 0, entry = '' WHERE id = ?", (student,))

    def rename(self, student: int, key: str) -> bool:
        """Give a student another key, with all that there is of them; False where it is that of another who has something."""
        with self.transaction():
            taken = self.connection.execute("SELECT id FROM student WHERE key = ?", (key,)).fetchone()
            if taken is not None:
                query = "SELECT 1 FROM result WHERE student = ? UNION ALL SELECT 1 FROM mark WHERE student = ? LIMIT 1"
                if self.connection.execute(query, (taken[0], taken[0])).fetchone() is not None:
                    return False
                self.connection.execute("DELETE FROM student WHERE id = ?", taken)  # nothing was handed in, till now
            self.connection.execute("UPDATE student SET key = ? WHERE id = ?", (key, student))
        return True

    # --- what others read ----------------------------------------------------------------------------------------------

    def due(self) -> str:
        """When the newest run was told that it was due, as ISO 8601; empty where it was not told."""
        for (due,) in list(self.rows("SELECT due FROM run ORDER BY id DESC LIMIT 1")):
            return str(due)
        return ""

    def roster_entries(self) -> Iterator[str]:
        """The rows of the roster that was named last, as JSON, in the order of the keys."""
        for (entry,) in self.rows("SELECT entry FROM student WHERE expected = 1 AND entry <> '' ORDER BY key"):
            yield str(entry)

    def students(self) -> Iterator[Student]:
        """Every student, in the order of their keys."""
        for row in self.rows(ALL_STUDENTS):
            yield Student(*row)

    def runs(self) -> list[Run]:
        """All runs, the oldest first."""
        columns = "id, started, coalesce(finished, ''), source, layout, rubric, version, last_mark"
        return [Run(*row) for row in self.rows(f"SELECT {columns} FROM run ORDER BY id")]

    def rubric(self, sha256: str, *, answers: bool = False) -> Rubric:
        """The rubric of a run, as it was then, with or without model answers; raises RubricError where this grader cannot read it."""
        for text, path in list(self.rows("SELECT text, path FROM rubric WHERE sha256 = ?", sha256)):
            rubric = read_rubric(text, Path(path), answers=answers)
            kept = "SELECT criterion, text FROM model_answer WHERE rubric = ?"
            return with_answers(rubric, dict(self.rows(kept, sha256))) if answers else rubric
        raise GraderError(f"the gradebook {self._shown} holds no rubric {sha256[:12]}")

    def record(self, result: int) -> tuple[str, str]:
        """The record of a result, and the template that it is kept beside, empty where there is none."""
        query = "SELECT record, coalesce(text, '') FROM result LEFT JOIN template ON sha256 = template WHERE id = ?"
        ((record, template),) = self.rows(query, result)
        return zlib.decompress(record).decode(), str(template)

    def rows(self, query: str, *values: Any) -> Iterator[tuple[Any, ...]]:
        """What a query gives, row by row."""
        with self.complaining():
            yield from self.connection.execute(query, values)


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="seconds")
