"""The SQLite file of a gradebook: open it, bring its tables up to date, read rows and write in transactions."""

import sqlite3
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, Self

from grader.classroom.gradebook.schema import APPLICATION_ID, STEPS
from grader.errors import InputError
from grader.text import printable_path

BUSY_TIMEOUT = 60.0  # seconds in which another process may finish its transaction


class Database:
    """An open gradebook file. Raises InputError for a file that is not a gradebook or that cannot be written."""

    def __init__(self, path: Path, *, create: bool = False) -> None:
        self.path = path
        self.shown = printable_path(path)
        if not create and not path.exists():
            command = f"grader batch PATH --gradebook {self.shown}"
            raise InputError(f"there is no gradebook {self.shown}: create it with `{command}`")
        if not path.parent.exists():
            folder = printable_path(path.parent)
            raise InputError(
                f"cannot create the gradebook {self.shown}: there is no folder {folder} (create it with `mkdir -p {folder}`)"
            )
        with self.input_errors():
            self.connection = sqlite3.connect(path, timeout=BUSY_TIMEOUT, isolation_level=None)
            try:
                _prepare(self.connection, self.shown)
            except BaseException:
                self.connection.close()
                raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

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
            is_other_file = error.sqlite_errorcode in (sqlite3.SQLITE_NOTADB, sqlite3.SQLITE_CANTOPEN)
            advice = "; name another file" if is_other_file else ""
            raise InputError(f"the gradebook {self.shown}: {error}{advice}") from None

    @contextmanager
    def transaction(self) -> Iterator[None]:
        """Commit everything that is written inside, or nothing."""
        with self.input_errors():
            self.connection.execute("BEGIN IMMEDIATE")
            try:
                yield
            except BaseException:
                if self.connection.in_transaction:
                    self.connection.execute("ROLLBACK")
                raise
            self.connection.execute("COMMIT")

    def rows(self, query: str, *values: Any) -> Iterator[tuple[Any, ...]]:
        """Yield the rows of a query."""
        with self.input_errors():
            yield from self.connection.execute(query, values)

    def first(self, query: str, *values: Any) -> tuple[Any, ...] | None:
        """Return the first row of a query, or None."""
        with self.input_errors():
            row: tuple[Any, ...] | None = self.connection.execute(query, values).fetchone()
            return row


def _prepare(connection: sqlite3.Connection, shown: str) -> None:
    """Configure a connection and create or upgrade the tables; raises InputError for a file of another kind or version."""
    connection.execute("BEGIN")  # another process may be creating the file: read all three at one moment
    queries = ("PRAGMA application_id", "PRAGMA user_version", "SELECT count(*) FROM sqlite_master")
    kind, version, tables = (int(connection.execute(query).fetchone()[0]) for query in queries)
    connection.execute("COMMIT")
    if tables and kind != APPLICATION_ID:
        raise InputError(f"{shown} is a database, but not a gradebook: name another file")
    if version > len(STEPS):
        raise InputError(f"{shown} was made by a newer grader: install that version, or name another file")
    _enable_wal(connection)
    connection.execute("PRAGMA synchronous = NORMAL")
    connection.execute("PRAGMA foreign_keys = ON")
    if version < len(STEPS):
        _migrate(connection)


def _enable_wal(connection: sqlite3.Connection) -> None:
    """Switch to a write-ahead log, so that readers and a writer do not block each other.

    SQLite does not apply its busy timeout to this pragma, so it is retried here.
    """
    until = time.monotonic() + BUSY_TIMEOUT
    while True:
        try:
            connection.execute("PRAGMA journal_mode = WAL")
        except sqlite3.OperationalError as error:
            if "locked" not in str(error) or time.monotonic() > until:
                raise
            time.sleep(0.01)
        else:
            return


def _migrate(connection: sqlite3.Connection) -> None:
    """Apply all missing steps, or, if one fails, none."""
    connection.execute("BEGIN IMMEDIATE")
    try:
        (version,) = connection.execute("PRAGMA user_version").fetchone()  # another process may have migrated meanwhile
        for step in STEPS[version:]:
            for statement in _statements(step):
                connection.execute(statement)
        connection.execute(f"PRAGMA user_version = {len(STEPS)}")
        connection.execute(f"PRAGMA application_id = {APPLICATION_ID}")
    except BaseException:
        if connection.in_transaction:
            connection.execute("ROLLBACK")
        raise
    connection.execute("COMMIT")


def _statements(script: str) -> Iterator[str]:
    """Yield the statements of a script: `executescript` would commit the open transaction first."""
    statement = ""
    for line in script.splitlines(keepends=True):
        statement += line
        if sqlite3.complete_statement(statement):
            yield statement
            statement = ""
