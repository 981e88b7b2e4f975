"""The gradebook: one SQLite file with the results of the checks and the manual marks, which no run changes."""

import os
import sqlite3
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, closing, contextmanager, suppress
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

from grader.classroom.gradebook.connection import BUSY_TIMEOUT, damage, prepare, transaction_of
from grader.classroom.gradebook.result import StoredOutcome, decompressed
from grader.classroom.gradebook.stored import STORED_SUBMISSIONS, STUDENT_COLUMNS, WITHOUT_SUBMISSION, StoredSubmission
from grader.classroom.students import Student
from grader.errors import GraderError, InputError
from grader.grading.answers import with_answers
from grader.grading.rubric import Rubric, read_rubric
from grader.text import printable_path, shell_quoted

_PRIMARY = 0xFF  # the bits of an error code without its details


class Run(NamedTuple):
    """A run of `grader batch`. `finished` is empty if interrupted, `last_mark` the newest mark when it began."""

    id: int
    started: str
    finished: str
    source: str
    layout: str
    rubric: str
    version: str
    last_mark: int
    deadline: str


class Gradebook(AbstractContextManager["Gradebook"]):
    """An open gradebook; `RunWriter` and `marks` write into it.

    Raises InputError for a file that is not a gradebook or that cannot be written.
    """

    def __init__(self, path: Path, *, create: bool = False, shown: str = "") -> None:
        self.path = path
        self.shown = shown or printable_path(path)
        if not create and not path.exists():
            command = f"grader batch PATH --gradebook {shell_quoted(self.shown)}"
            raise InputError(f"there is no gradebook {self.shown}: create it with `{command}`")
        if not path.parent.exists():
            folder = printable_path(path.parent)
            raise InputError(
                f"cannot create the gradebook {self.shown}: there is no folder {folder} "
                f"(create it with `mkdir -p {shell_quoted(folder)}`)"
            )
        with self.input_errors():
            self.connection = self._connect(create)
            try:
                prepare(self.connection, self.shown, self.read_only)
            except BaseException:
                self.connection.close()
                raise

    def _connect(self, create: bool) -> sqlite3.Connection:
        if create or not self.read_only:
            return sqlite3.connect(self.path, timeout=BUSY_TIMEOUT, isolation_level=None)
        # In a folder without write permission SQLite reads a file with a write-ahead log only if nothing can write to
        # it.
        is_static = not Path(f"{self.path}-wal").exists()
        uri = f"{self.path.absolute().as_uri()}?mode=ro{'&immutable=1' * is_static}"
        return sqlite3.connect(uri, timeout=BUSY_TIMEOUT, isolation_level=None, uri=True)

    @cached_property
    def read_only(self) -> str:
        """Why nothing can be written; empty if it can."""
        effective = os.access in os.supports_effective_ids
        places = (place for place in (self.path, self.path.parent) if place.exists())
        refused = [place for place in places if not os.access(place, os.W_OK, effective_ids=effective)]
        names = " and ".join(printable_path(place) for place in refused)
        return f"there is no write permission for {names} (`chmod u+w` gives it to the owner)" if refused else ""

    def check_writable(self) -> None:
        """Raise InputError if marks cannot be saved."""
        if self.read_only:
            raise InputError(f"marks cannot be saved in the gradebook {self.shown}: {self.read_only}")

    def __exit__(self, kind: object, error: BaseException | None, _: object) -> None:
        try:
            if isinstance(error, Exception) and not isinstance(error, GraderError | OSError):
                self.check_undamaged()
        finally:
            self.close()

    def check_undamaged(self) -> None:
        """Raise InputError if another program has changed the file, and this explains an error."""
        with suppress(sqlite3.Error, UnicodeDecodeError):
            if what := damage(self.connection):
                raise InputError(f"the gradebook {self.shown} is damaged: {what}") from None

    def close(self) -> None:
        """Close the file; what was not committed is lost."""
        with suppress(sqlite3.Error):
            self.connection.close()

    @contextmanager
    def input_errors(self) -> Iterator[None]:
        """Turn errors of SQLite into InputError."""
        try:
            yield
        except sqlite3.DatabaseError as error:
            code = getattr(error, "sqlite_errorcode", sqlite3.SQLITE_ERROR)  # without one, the text is not UTF-8
            is_refused = code & _PRIMARY in (sqlite3.SQLITE_READONLY, sqlite3.SQLITE_CANTOPEN)
            if is_refused and self.read_only:
                raise InputError(f"the gradebook {self.shown}: {self.read_only}") from None
            if str(error).startswith("no such "):
                self.check_undamaged()
            is_other_file = code in (sqlite3.SQLITE_NOTADB, sqlite3.SQLITE_CANTOPEN)
            advice = "; name another file" if is_other_file else ""
            raise InputError(f"the gradebook {self.shown}: {error}{advice}") from None
        except UnicodeDecodeError:  # of a message of SQLite
            raise InputError(f"the gradebook {self.shown} is damaged: its text is not UTF-8") from None

    @contextmanager
    def transaction(self) -> Iterator[None]:
        """Commit everything that is written inside, or nothing."""
        with self.input_errors(), transaction_of(self.connection):
            yield

    def rows(self, query: str, *values: Any) -> Iterator[tuple[Any, ...]]:
        """Yield the rows of a query."""
        with self.input_errors():
            for row in self.connection.execute(query, values):  # noqa: UP028  its cursor may outlive the book
                yield row

    def records(self, query: str, *values: Any) -> Iterator[dict[str, Any]]:
        """Yield the rows of a query by the names of their columns."""
        with self.input_errors():
            found = self.connection.execute(query, values)
            names = [name for name, *_ in found.description]
            for row in found:
                yield dict(zip(names, row, strict=True))

    def first(self, query: str, *values: Any) -> tuple[Any, ...] | None:
        """Return the first row of a query, or None."""
        return next(self.rows(query, *values), None)

    def insert(self, table: str, values: Mapping[str, Any], *, unless_known: bool = False) -> int:
        """Insert a row and return its id."""
        head = f"INSERT{' OR IGNORE' * unless_known} INTO {table} ({', '.join(values)})"
        row = self.connection.execute(f"{head} VALUES ({', '.join('?' * len(values))})", tuple(values.values()))
        return int(row.lastrowid or 0)

    def nothing_graded(self) -> InputError:
        """Return the error for a gradebook without a run."""
        command = f"grader batch PATH --gradebook {shell_quoted(self.shown)}"
        return InputError(f"nothing has been graded into {self.shown} yet: run `{command}`")

    def runs(self) -> list[Run]:
        """Return all runs, the oldest first."""
        columns = "id, started, coalesce(finished, ''), source, layout, rubric, version, last_mark, deadline"
        return [Run(*row) for row in self.rows(f"SELECT {columns} FROM run ORDER BY id")]

    def newest_run(self) -> Run | None:
        """Return the newest run, or None."""
        return next(reversed(self.runs()), None)

    def roster_entries(self) -> Iterator[str]:
        """Yield the rows of the newest roster, as JSON, in the order of the keys."""
        query = "SELECT roster_entry FROM student WHERE is_on_roster = 1 AND roster_entry <> '' ORDER BY key"
        for (entry,) in self.rows(query):
            yield str(entry)

    def students(self) -> Iterator[Student]:
        """Yield every student, in the order of the keys."""
        for row in self.rows(f"SELECT {', '.join(STUDENT_COLUMNS)} FROM student ORDER BY key"):
            yield Student(*row)

    def stored_submissions(self) -> Iterator[StoredSubmission]:
        """Yield the newest submission of each student, in the order of the keys, unaffected by later writes."""
        return self._read_stored(STORED_SUBMISSIONS)

    def without_submission(self) -> Iterator[StoredSubmission]:
        """Yield the students who have submitted nothing, in the order of the keys, unaffected by later writes."""
        return self._read_stored(WITHOUT_SUBMISSION)

    def _read_stored(self, query: str) -> Iterator[StoredSubmission]:
        with self.input_errors(), closing(sqlite3.connect(self.path, timeout=BUSY_TIMEOUT)) as snapshot:
            for row in snapshot.execute(query):
                yield StoredSubmission.of(row)

    def rubric(self, sha256: str, *, answers: bool = False) -> Rubric:
        """Return a stored rubric, with or without model answers; raises RubricError if this grader cannot read it."""
        row = self.first("SELECT text, path FROM rubric WHERE sha256 = ?", sha256)
        if row is None:
            raise GraderError(f"the gradebook {self.shown} has no rubric {sha256[:12]}")
        rubric = read_rubric(row[0], Path(row[1]), answers=answers)
        query = "SELECT criterion, text FROM model_answer WHERE rubric = ?"
        return with_answers(rubric, dict(self.rows(query, sha256))) if answers else rubric

    def record(self, result: int) -> str:
        """Return the record of a result."""
        query = "SELECT record, text FROM result LEFT JOIN dictionary ON sha256 = dictionary WHERE id = ?"
        ((record, dictionary),) = self.rows(query, result)
        try:
            return decompressed(record, dictionary or b"")
        except ValueError:
            raise InputError(f"the gradebook {self.shown} is damaged: the record {result} cannot be read") from None

    def outcomes(self, result: int) -> dict[int, StoredOutcome]:
        """Return the outcomes of a result by the position of the criterion, except those that passed."""
        query = f"SELECT {', '.join(StoredOutcome._fields)} FROM outcome WHERE result = ?"
        with self.input_errors():
            rows = self.connection.execute(query, (result,)).fetchall()  # a class has many: faster than `rows`
        return {row[0]: StoredOutcome._make(row) for row in rows}
