"""The gradebook: one SQLite file with what the checks have found and what people have decided, which no re-run changes."""

import json
import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, NamedTuple, Self

from grader import __version__
from grader.classroom.schema import APPLICATION_ID, STEPS
from grader.classroom.students import HandIn, Student
from grader.classroom.work import UNITS, Graded
from grader.errors import GraderError, InputError
from grader.grading.rubric import Rubric, read_rubric
from grader.submission.files import printable_path

_PATIENCE = 60.0  # seconds in which another process may finish its transaction
_STUDENT = ("key", "name", "email", "login", "sis", "canvas", "moodle")


class Known(NamedTuple):
    """What the gradebook has of a student: the row, the newest result and what it was made from."""

    student: int
    result: int
    rubric: str
    version: str
    digest: str
    verdict: str
    fingerprint: str


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
        if not create and not path.exists():
            raise InputError(f"there is no gradebook {self._shown}: grader batch PATH --gradebook {self._shown} makes one")
        with self.complaining():
            self.connection = sqlite3.connect(path, timeout=_PATIENCE, isolation_level=None)
            try:
                self._prepare()
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

    def _prepare(self) -> None:
        with closing(self.connection.execute("PRAGMA application_id")) as found:
            marked = found.fetchone()[0] == APPLICATION_ID
        version = int(self.connection.execute("PRAGMA user_version").fetchone()[0])
        is_empty = self.connection.execute("SELECT count(*) FROM sqlite_master").fetchone()[0] == 0
        if not marked and not is_empty:
            raise InputError(f"{self._shown} is a database, but no gradebook")
        if version > len(STEPS):
            raise InputError(f"{self._shown} was made by a newer grader: install that one, or name another file")
        self.connection.execute("PRAGMA journal_mode = WAL")
        self.connection.execute("PRAGMA synchronous = NORMAL")
        self.connection.execute("PRAGMA foreign_keys = ON")
        if version < len(STEPS):
            self._migrate()

    def _migrate(self) -> None:
        with self.transaction():  # another process may have done it meanwhile
            version = int(self.connection.execute("PRAGMA user_version").fetchone()[0])
            for step in STEPS[version:]:
                for statement in _statements(step):
                    self.connection.execute(statement)
            self.connection.execute(f"PRAGMA user_version = {len(STEPS)}")
            self.connection.execute(f"PRAGMA application_id = {APPLICATION_ID}")

    @contextmanager
    def complaining(self) -> Iterator[None]:
        """Turn what SQLite says into one plain sentence."""
        try:
            yield
        except sqlite3.DatabaseError as error:
            raise InputError(f"the gradebook {self._shown}: {error}") from None

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

    def begin(self, source: str, layout: str, rubric: Rubric) -> int:
        """Begin a run; its number."""
        with self.transaction():
            self._keep_rubric(rubric)
            last_mark = self.connection.execute("SELECT coalesce(max(id), 0) FROM mark").fetchone()[0]
            row = (_now(), source, layout, rubric.sha256, __version__, last_mark)
            found = self.connection.execute(
                "INSERT INTO run (started, source, layout, rubric, version, last_mark) VALUES (?, ?, ?, ?, ?, ?)", row
            )
            return int(found.lastrowid or 0)

    def finish(self, run: int) -> None:
        """Note that a run went through to its end."""
        with self.transaction():
            self.connection.execute("UPDATE run SET finished = ? WHERE id = ?", (_now(), run))

    def _keep_rubric(self, rubric: Rubric) -> None:
        row = (rubric.sha256, rubric.id, rubric.title, str(rubric.path), rubric.data)
        self.connection.execute("INSERT OR IGNORE INTO rubric VALUES (?, ?, ?, ?, ?)", row)
        self.connection.executemany(
            "INSERT OR IGNORE INTO criterion VALUES (?, ?, ?, ?)",
            [
                (rubric.sha256, criterion.id, position, int(criterion.points * UNITS))
                for position, criterion in enumerate(rubric.criteria)
            ],
        )

    def is_empty(self) -> bool:
        """Whether there is no student in it yet."""
        return self.connection.execute("SELECT 1 FROM student LIMIT 1").fetchone() is None

    def known(self, key: str) -> Known | None:
        """The newest result of a student."""
        row = self.connection.execute(
            "SELECT student.id, seen.result, result.rubric, result.version, result.digest, result.verdict, seen.fingerprint"
            " FROM student JOIN seen ON seen.student = student.id JOIN result ON result.id = seen.result"
            " WHERE student.key = ? ORDER BY seen.run DESC LIMIT 1",
            (key,),
        ).fetchone()
        return Known(*row) if row is not None else None

    def keep_student(self, student: Student, expected: bool | None, due: str = "", late: str = "") -> int:
        """Take in what is known of a student; what was known before and is not said now stays."""
        values = tuple(getattr(student, name) for name in _STUDENT)
        found = self.connection.execute(
            f"SELECT id, expected, due, late, {', '.join(_STUDENT)} FROM student WHERE key = ?", (student.key,)
        ).fetchone()
        on_roster = None if expected is None else int(expected)
        if found is None:
            added = self.connection.execute(
                f"INSERT INTO student (expected, due, late, {', '.join(_STUDENT)}) VALUES (?, ?, ?{', ?' * len(_STUDENT)})",
                (on_roster, due, late, *values),
            )
            return int(added.lastrowid or 0)
        identity, *before = found
        told = [on_roster, due or before[1], late or before[2], *(new or old for new, old in zip(values, before[3:], strict=True))]
        told[0] = before[0] if on_roster is None else on_roster
        if told != before:
            columns = ", ".join(f"{name} = ?" for name in ("expected", "due", "late", *_STUDENT))
            self.connection.execute(f"UPDATE student SET {columns} WHERE id = ?", (*told, identity))
        return int(identity)

    def keep(self, student: int, rubric: str, graded: Graded) -> int:
        """Add a result, unless the newest one of the student says the same; its number."""
        newest = self.connection.execute(
            "SELECT id, rubric, version, digest, record FROM result WHERE student = ? ORDER BY id DESC LIMIT 1", (student,)
        ).fetchone()
        if newest is not None and newest[1:] == (rubric, __version__, graded.digest, graded.record):
            return int(newest[0])
        row = (
            student, rubric, __version__, graded.digest, graded.verdict, graded.reason, graded.score, graded.out_of,
            graded.pending, graded.signs, graded.record,
        )  # fmt: skip
        added = self.connection.execute(
            "INSERT INTO result (student, rubric, version, digest, verdict, reason, score, out_of, pending, signs, record)"
            " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
            row,
        )
        return int(added.lastrowid or 0)

    def see(self, student: int, run: int, result: int, hand_in: HandIn, fingerprint: str) -> None:
        """Note that a run has seen this of a student, and which result it has."""
        row = (
            student, run, result, _json(hand_in.paths), _json(hand_in.names), fingerprint, int(hand_in.is_late),
            hand_in.submitted, hand_in.attempt, _json(hand_in.earlier),
        )  # fmt: skip
        self.connection.execute("INSERT INTO seen VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)", row)

    # --- what others read ----------------------------------------------------------------------------------------------

    def runs(self) -> list[Run]:
        """All runs, the oldest first."""
        rows = self.connection.execute(
            "SELECT id, started, coalesce(finished, ''), source, layout, rubric, version, last_mark FROM run ORDER BY id"
        )
        return [Run(*row) for row in rows]

    def rubric(self, sha256: str) -> Rubric:
        """The rubric of a run, as it was then; raises RubricError where this grader cannot read it."""
        row = self.connection.execute("SELECT text, path FROM rubric WHERE sha256 = ?", (sha256,)).fetchone()
        if row is None:
            raise GraderError(f"the gradebook {self._shown} holds no rubric {sha256[:12]}")
        return read_rubric(row[0], Path(row[1]))

    def record(self, result: int) -> bytes:
        """The compressed record of a result."""
        row = self.connection.execute("SELECT record FROM result WHERE id = ?", (result,)).fetchone()
        return bytes(row[0])

    def rows(self, query: str, *values: Any) -> Iterator[tuple[Any, ...]]:
        """What a query gives, row by row."""
        with self.complaining():
            yield from self.connection.execute(query, values)


def _statements(script: str) -> Iterator[str]:
    """The statements of a script one by one: executescript would commit before it begins."""
    statement = ""
    for line in script.splitlines(keepends=True):
        statement += line
        if sqlite3.complete_statement(statement):
            yield statement
            statement = ""


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="seconds")


def _json(texts: tuple[str, ...]) -> str:
    return json.dumps(texts)
