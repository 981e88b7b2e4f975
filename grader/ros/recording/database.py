"""Reads and writes a file in SQLite: the tables of rosbag2, and nothing that computes.

A view, a virtual table or a generated column might compute without end, so none is asked.
"""

import shutil
import sqlite3
from collections.abc import Iterable, Sequence
from contextlib import closing
from functools import partial
from itertools import repeat
from tempfile import NamedTemporaryFile
from typing import IO
from urllib.parse import quote

from grader.base.errors import RecordingError
from grader.files import limits
from grader.ros.recording.recorded import Channel, Collector

MAGIC = b"SQLite format 3"
_TABLES = ("topics", "messages", "message_definitions")
_MAKE_TABLES = """
CREATE TABLE topics(id, name, type);
CREATE TABLE messages(topic_id, timestamp, data);
CREATE TABLE message_definitions(topic_type, encoding, encoded_message_definition);
"""
_STEP = 1_000  # instructions


def read_database(file: IO[bytes], collector: Collector) -> None:
    """Read a file into channels.

    Raises RecordingError if it has no tables of rosbag2, or exceeds a limit.

    A copy is opened, which has no other name: so nobody changes it, and no write-ahead log beside
    it is written back.
    """
    with NamedTemporaryFile() as copy:
        shutil.copyfileobj(file, copy)
        copy.flush()
        address = f"file:{quote(copy.name)}?mode=ro&immutable=1"
        with closing(sqlite3.connect(address, uri=True)) as connection:
            steps = iter(repeat(0, limits.MAX_QUERY_STEPS))
            connection.set_progress_handler(lambda: next(steps, 1), _STEP)
            try:
                _read_tables(connection, collector)
            except (sqlite3.Error, MemoryError, OverflowError, UnicodeError) as error:
                if next(steps, 1):
                    raise RecordingError("its tables take too long", is_limit=True) from None
                collector.note("damaged", f"the database is damaged ({type(error).__name__})")


def write_database(channels: Iterable[tuple[Channel, Sequence[tuple[int, bytes]]]]) -> bytes:
    """Return a file with other messages of channels, each with the recorder's time."""
    with closing(sqlite3.connect(":memory:")) as connection:
        connection.executescript(_MAKE_TABLES)
        for number, (channel, messages) in enumerate(channels):
            topic = (number, channel.topic, channel.type)
            connection.execute("INSERT INTO topics VALUES (?, ?, ?)", topic)
            definition = (channel.type, "ros2msg", channel.definition)
            connection.execute("INSERT INTO message_definitions VALUES (?, ?, ?)", definition)
            rows = [(number, *message) for message in messages]
            connection.executemany("INSERT INTO messages VALUES (?, ?, ?)", rows)
        return connection.serialize()


def _read_tables(connection: sqlite3.Connection, collector: Collector) -> None:
    connection.text_factory = partial(str, encoding="utf-8", errors="replace")
    connection.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, limits.MAX_CHUNK_SIZE)
    connection.execute("PRAGMA trusted_schema=OFF")
    plain = _find_plain_tables(connection)
    if not {"topics", "messages"} <= plain.keys():
        raise RecordingError("it has no tables of rosbag2")
    definitions: dict[object, object] = {}
    if "message_definitions" in plain:
        definitions.update(
            connection.execute(
                "SELECT topic_type, encoded_message_definition FROM message_definitions "
                "WHERE encoding = 'ros2msg'"
            )
        )
    channels = {}
    qos = "offered_qos_profiles" if "offered_qos_profiles" in plain["topics"] else "''"
    rows = connection.execute(f"SELECT id, name, type, {qos} FROM topics")  # noqa: S608
    for number, topic, type_name, profiles in rows:
        if isinstance(topic, str) and isinstance(type_name, str):
            definition = definitions.get(type_name)
            texts = [text if isinstance(text, str) else "" for text in (definition, profiles)]
            channels[number] = collector.open_channel(topic, type_name, *texts)
    size = 0  # of the data that was copied: rows of a hostile file may share their pages
    for number, time, data in connection.execute("SELECT topic_id, timestamp, data FROM messages"):
        size += len(data) if isinstance(data, bytes) else 0
        if size > limits.MAX_RECORDING_SIZE:
            raise RecordingError("its rows are larger than 1 GiB", is_limit=True)
        channel = channels.get(number)
        if channel and isinstance(time, int) and isinstance(data, bytes):
            collector.add(channel, time, data[: channel.count_wanted(len(data))])


def _find_plain_tables(connection: sqlite3.Connection) -> dict[str, list[str]]:
    """Return the columns of tables that rosbag2 makes, and that are stored with all columns."""
    stored = "SELECT name FROM sqlite_master WHERE type = 'table' AND rootpage > 0"
    plain = {}
    for (name,) in connection.execute(stored).fetchall():
        if name in _TABLES:
            columns = connection.execute(f"PRAGMA table_xinfo({name})").fetchall()
            if not any(hidden for *_, hidden in columns):
                plain[name] = [column for _, column, *_ in columns]
    return plain
