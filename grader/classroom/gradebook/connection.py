"""Connections to the file of a gradebook: its kind and version, its tables, its transactions."""

import re
import sqlite3
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager

from grader.classroom.gradebook.schema import APPLICATION_ID, JSON_COLUMNS, TABLES, VERSION
from grader.classroom.gradebook.views import VIEWS
from grader.errors import InputError

BUSY_TIMEOUT = 60.0  # seconds in which another process may finish its transaction


def prepare(connection: sqlite3.Connection, shown: str, read_only: str) -> None:
    """Configure a connection and create the tables of a new file; raises InputError for another kind or version."""
    connection.execute("BEGIN")  # another process may be creating the file: read all three at one moment
    queries = ("PRAGMA application_id", "PRAGMA user_version", "SELECT count(*) FROM sqlite_master")
    kind, version, tables = (int(connection.execute(query).fetchone()[0]) for query in queries)
    connection.execute("COMMIT")
    if tables and kind != APPLICATION_ID:
        raise InputError(f"{shown} is a database, but not a gradebook: name another file")
    if version != VERSION and (tables or read_only):
        raise InputError(
            f"{shown} is a gradebook of version {version}, and this grader reads version {VERSION}: "
            "use the grader that made it, or name another file"
        )
    if read_only:
        return
    _enable_wal(connection)
    connection.execute("PRAGMA synchronous = NORMAL")
    connection.execute("PRAGMA foreign_keys = ON")
    if not tables:
        _create_tables(connection)


def damage(connection: sqlite3.Connection) -> str:
    """Return what another program has changed: a table, or a value that is not of its column; empty for nothing.

    It reads the whole file, so it is called only where something is wrong, or where the whole file is copied.
    """
    with closing(sqlite3.connect(":memory:")) as own:
        own.executescript(TABLES + VIEWS)
        found = _definitions(connection)
        if other := [name for name, text in _definitions(own).items() if found.get(name) != text]:
            return f"{other[0]} is not what the grader has made"
        broken = connection.execute("PRAGMA integrity_check(1)").fetchone()[0]
        for (table,) in own.execute("SELECT name FROM sqlite_master WHERE type = 'table'"):
            wrong = " OR ".join(_is_wrong(*column) for column in own.execute(f"PRAGMA table_info({table})"))
            if connection.execute(f"SELECT 1 FROM {table} WHERE {wrong} LIMIT 1").fetchone():
                return f"{table} has a value that the grader does not write"
    return "" if broken == "ok" else str(broken)


def _definitions(connection: sqlite3.Connection) -> dict[str, str]:
    """Return the definition of each table, index, trigger and view, without comments and line breaks."""
    found = connection.execute("SELECT name, sql FROM sqlite_master WHERE sql <> ''")
    return {name: " ".join(re.sub(r"--.*", "", sql).split()) for name, sql in found}


def _is_wrong(_: int, name: str, kind: str, is_required: int, *__: object) -> str:
    """Return the SQL condition that is true for a value that a column cannot have."""
    nothing = "" if is_required else ", 'null'"
    wrong = f"typeof({name}) NOT IN ('{kind.lower()}'{nothing})"
    if kind == "REAL":
        wrong += f" OR abs({name}) > 1e9"  # infinite
    if name in JSON_COLUMNS:
        wrong += f" OR {name} <> '' AND (NOT json_valid({name}) OR json_type({name}) NOT IN ('array', 'object'))"
    return wrong


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


def _create_tables(connection: sqlite3.Connection) -> None:
    """Create all tables, or, if that fails, none."""
    with transaction_of(connection):
        if connection.execute("SELECT 1 FROM sqlite_master").fetchone():
            return  # another process has created them meanwhile
        for statement in _statements(TABLES + VIEWS):
            connection.execute(statement)
        connection.execute(f"PRAGMA user_version = {VERSION}")
        connection.execute(f"PRAGMA application_id = {APPLICATION_ID}")


@contextmanager
def transaction_of(connection: sqlite3.Connection) -> Iterator[None]:
    """Commit everything that is written inside, or nothing."""
    connection.execute("BEGIN IMMEDIATE")
    try:
        yield
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
