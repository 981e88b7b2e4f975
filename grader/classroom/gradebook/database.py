"""A SQLite file made ready to be a gradebook: recognised, written ahead, brought to the newest version of the tables."""

import sqlite3
import time
from collections.abc import Iterator

from grader.classroom.gradebook.schema import APPLICATION_ID, STEPS
from grader.errors import InputError

PATIENCE = 60.0  # seconds in which another process may finish its transaction


def prepare(connection: sqlite3.Connection, shown: str) -> None:
    """Make an open file ready; raises InputError for one that is no gradebook, or a newer grader's. `shown` is its name."""
    connection.execute("BEGIN")  # another process may be making it just now: what is read is of one moment
    queries = ("PRAGMA application_id", "PRAGMA user_version", "SELECT count(*) FROM sqlite_master")
    kind, version, tables = (int(connection.execute(query).fetchone()[0]) for query in queries)
    connection.execute("COMMIT")
    if tables and kind != APPLICATION_ID:
        raise InputError(f"{shown} is a database, but no gradebook: name another file")
    if version > len(STEPS):
        raise InputError(f"{shown} was made by a newer grader: install that one, or name another file")
    _log_ahead(connection)
    connection.execute("PRAGMA synchronous = NORMAL")
    connection.execute("PRAGMA foreign_keys = ON")
    if version < len(STEPS):
        _migrate(connection)


def _log_ahead(connection: sqlite3.Connection) -> None:
    """Write ahead, so that readers and a writer do not wait for each other; for this SQLite itself has no patience."""
    until = time.monotonic() + PATIENCE
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
    """Take all steps that are missing, or, where one fails, none."""
    connection.execute("BEGIN IMMEDIATE")
    try:
        version = int(
            connection.execute("PRAGMA user_version").fetchone()[0]
        )  # another process may have done it meanwhile
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
    """The statements of a script one by one: executescript would commit before it begins."""
    statement = ""
    for line in script.splitlines(keepends=True):
        statement += line
        if sqlite3.complete_statement(statement):
            yield statement
            statement = ""
