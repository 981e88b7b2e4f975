"""Recordings are read alike however they were written, within limits, and by what is in them."""

import struct
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

from grader.base.errors import RecordingError
from grader.files import limits
from grader.files.folder import read_folder
from grader.files.opening import open_tree
from grader.files.tree import make_tree
from grader.ros.api import Recording, find_recordings, read_recording
from tests.checks.submissions import file_of
from tests.recordings.cart import files_of, record
from tests.recordings.writing import (
    Recorded,
    compress_zstd,
    encode,
    write_mcap,
    write_metadata,
    write_sqlite,
)

WAYS: Mapping[str, Callable[[list[Recorded]], bytes]] = {
    "plain": write_mcap,
    "chunks": lambda messages: write_mcap(messages, chunked=7),
    "zstd": lambda messages: write_mcap(messages, chunked=7, compression="zstd"),
    "lz4": lambda messages: write_mcap(messages, chunked=7, compression="lz4"),
    "without definitions": lambda messages: write_mcap(messages, is_defined=False),
    "not closed": lambda messages: write_mcap(messages, chunked=7, is_closed=False),
    "sqlite": write_sqlite,
    "sqlite of Humble": lambda messages: write_sqlite(messages, is_defined=False),
    "a compressed file": lambda messages: compress_zstd(write_mcap(messages)),
    "a compressed database": lambda messages: compress_zstd(write_sqlite(messages)),
    "compressed messages": lambda messages: write_mcap(
        [one._replace(data=compress_zstd(one.data)) for one in messages]
    ),
    "big-endian": lambda messages: write_mcap(
        [one if one.topic != "/numbers" else one._replace(data=_numbers(">")) for one in messages]
    ),
}


def _numbers(order: str = "<") -> bytes:
    fields = {
        "name": ["a", "b"],
        "position": [1.5, -2.0],
        "header": {"stamp": {"sec": 3, "nanosec": 9}},
    }
    return encode("sensor_msgs/msg/JointState", fields, order)


def _read(files: Mapping[str, bytes]) -> Recording:
    """Return the only recording in files."""
    tree = make_tree("bag", [file_of(path, data) for path, data in files.items()], ())
    (found,) = find_recordings(tree)
    return read_recording(found)


def _contents(recording: Recording) -> dict[str, Any]:
    return {name: (topic.types, topic.messages) for name, topic in recording.topics.items()}


@pytest.mark.parametrize("way", WAYS)
def test_a_recording_is_read_alike_in_each_format(way: str) -> None:
    """Formats, compression and definitions change nothing of the topics, the types and the messages."""
    messages = record(speeds=((0.5, 0.3, 1.0),))
    messages.append(
        Recorded("/numbers", "sensor_msgs/msg/JointState", messages[-1].time, _numbers())
    )
    name = "bag.db3" if "sqlite" in way or "database" in way else "bag.mcap"
    expected = _read({"bag.mcap": write_mcap(messages)})
    assert expected.count == len(messages)
    read = _read({name: WAYS[way](messages)})
    assert _contents(read) == _contents(expected)
    assert read.topics["/numbers"].messages[0].message["position"] == (1.5, -2.0)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["folder", "zip"])
def test_a_recording_may_be_larger_than_other_files(kind: str, tmp_path: Path) -> None:
    """It is read as a stream from a folder and an archive, and no note says that it is too large; another file is ignored."""
    recorded = files_of("drive", {})["drive/drive_0.mcap"]
    (tmp_path / "film.mp4").write_bytes(b"")
    (tmp_path / "drive.mcap").write_bytes(recorded)
    for path in tmp_path.iterdir():
        with path.open("ab") as file:
            file.truncate(limits.MAX_FILE_SIZE + 1)
    tree = read_folder(tmp_path)
    if kind == "zip":
        packed = tmp_path / "packed.zip"
        with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
            for name in ("film.mp4", "drive.mcap"):
                archive.write(tmp_path / name, name)
        opened = open_tree(packed)
        assert opened is not None
        tree = opened
    assert [file.path for file in tree.ignored] == ["film.mp4"]
    (found,) = find_recordings(tree)
    assert read_recording(found).count == len(record())


def test_the_parts_of_a_recording_are_read_in_order() -> None:
    """Files that were split are sorted by their numbers, with and without metadata.yaml; two stems are two recordings."""
    messages = record()
    parts = {
        f"drive/drive_{number}.mcap": write_mcap(messages[number * 20 : number * 20 + 20])
        for number in range(11)
    }
    metadata = {
        "drive/metadata.yaml": write_metadata(*(path.removeprefix("drive/") for path in parts))
    }
    assert _contents(_read(parts)) == _contents(_read(parts | metadata))
    assert _read(parts).count == len(messages)
    files = [file_of(path, data) for path, data in {**parts, "drive/test.mcap": b""}.items()]
    assert [one.path for one in find_recordings(make_tree("bag", files, ()))] == [
        "drive",
        "drive/test.mcap",
    ]


@pytest.mark.parametrize(
    ("files", "notes"),
    [
        (["drive_0.mcap"], {"drive_0.mcap": []}),
        (["drive_0.mcap", "drive_1.mcap"], {"drive_0.mcap": ["missing"]}),
        (["old.mcap"], {"drive_0.mcap": ["renamed"]}),
    ],
    ids=["all", "missing", "renamed"],
)
def test_metadata_is_a_hint(files: list[str], notes: Mapping[str, list[str]]) -> None:
    """What it says otherwise is a note, and the messages are counted."""
    ((name, kinds),) = notes.items()
    read = _read(
        {f"drive/{name}": write_mcap(record()), "drive/metadata.yaml": write_metadata(*files)}
    )
    assert [note.kind for note in read.notes] == kinds
    assert read.count == len(record())


def test_other_files_are_no_recordings() -> None:
    """A metadata.yaml of something else is none, nor one that is too large."""
    large = write_metadata("a.mcap") + bytes(limits.MAX_METADATA_SIZE)
    files = {"a/metadata.yaml": b"a: 1", "b/metadata.yaml": large, "c/d.txt": b""}
    assert find_recordings(make_tree("bag", [file_of(*file) for file in files.items()], ())) == ()


def test_a_write_ahead_log_is_a_loss() -> None:
    """The last messages of a database are in it, and are not read."""
    read = _read({"bag.db3": write_sqlite(record()), "bag.db3-wal": b"1"})
    assert [note.kind for note in read.losses] == ["unclosed"]


@pytest.mark.parametrize(
    ("limit", "value", "way", "lost"),
    [
        ("MAX_MESSAGES", 50, "plain", True),
        ("MAX_TOPICS", 2, "plain", True),
        ("MAX_TOPIC_SIZE", 1_000, "plain", False),
        ("MAX_KEPT_SIZE", 5_000, "sqlite", False),
        ("MAX_RECORDING_UNPACKED", 5_000, "zstd", True),
        ("MAX_RECORDING_UNPACKED", 5_000, "compressed messages", True),
        ("MAX_CHUNK_SIZE", 2_000, "chunks", True),
        ("MAX_MESSAGE_SIZE", 100, "plain", False),
        ("MAX_RECORDING_SIZE", 100, "plain", True),
        ("MAX_RECORDING_UNPACKED", 5_000, "a compressed file", True),
        ("MAX_QUERY_STEPS", 0, "sqlite", True),
    ],
)
def test_each_limit_is_told(
    limit: str, value: int, way: str, lost: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What exceeds a limit needs a person: a note says so if some messages were read, else the error does."""
    messages = record()
    data = WAYS[way](messages)
    monkeypatch.setattr(limits, limit, value)
    try:
        read = _read({"bag.db3" if way == "sqlite" else "bag.mcap": data})
    except RecordingError as error:
        assert error.is_limit
    else:
        if limit != "MAX_MESSAGE_SIZE":
            assert "limit" in [note.kind for note in read.losses]
        assert (read.count < len(messages)) == lost


@pytest.mark.slow
def test_a_small_file_that_unpacks_to_much_is_not_unpacked() -> None:
    """Neither in a chunk, nor as a whole file."""
    bomb = compress_zstd(bytes(limits.MAX_CHUNK_SIZE + 1))
    about = struct.pack("<QQQI", 0, 0, 0, 0) + struct.pack("<I", 4) + b"zstd"
    chunk = about + struct.pack("<Q", len(bomb)) + bomb
    in_chunk = b"\x89MCAP0\r\n" + struct.pack("<BQ", 6, len(chunk)) + chunk
    whole = compress_zstd(write_mcap([]) + bytes(limits.MAX_RECORDING_UNPACKED))
    for data in (in_chunk, whole):
        assert len(data) < 100_000
        with pytest.raises(RecordingError, match="after decompression") as caught:
            _read({"bag.mcap": data})
        assert caught.value.is_limit


@pytest.mark.parametrize(
    "schema",
    [
        "CREATE TABLE raw(id, topic_id, timestamp, data); CREATE VIEW messages AS WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c) SELECT x AS id, 1 AS topic_id, x AS timestamp, x'00' AS data FROM c",
        "CREATE TABLE messages(id, topic_id, timestamp, data AS (zeroblob(1000000000)))",
        "CREATE VIRTUAL TABLE messages USING fts5(id, topic_id, timestamp, data)",
    ],
    ids=["view", "generated column", "virtual table"],
)
def test_a_database_computes_nothing(schema: str) -> None:
    """Only stored tables are asked."""
    import sqlite3
    from contextlib import closing

    with closing(sqlite3.connect(":memory:")) as connection:
        connection.executescript(
            "CREATE TABLE topics(id, name, type); INSERT INTO topics VALUES (1, '/a', 'b/msg/C');"
            + schema
        )
        data = connection.serialize()
    with pytest.raises(RecordingError, match=r"^it has no tables of rosbag2$"):
        _read({"bag.db3": data})


@pytest.mark.parametrize(
    "definition",
    [
        "a/B b\n================\nMSG: a/B\na/B b",
        "string text\nwstring other",
        "int32",
        "c/Unknown field",
        "\n".join(f"int32 f{number}" for number in range(3_000)),
    ],
    ids=["of itself", "wide text", "no definition", "unknown type", "too long"],
)
def test_a_type_that_is_not_known_is_counted(
    definition: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its messages have the recorder's times, and no content; no definition is executed or followed without end."""
    monkeypatch.setattr("tests.recordings.writing.definition_of", lambda _: definition)
    data = write_mcap(
        [Recorded("/a", "lab_msgs/msg/Own", 10**9 * second, bytes(20)) for second in range(5)]
    )
    topic = _read({"bag.mcap": data}).topics["/a"]
    assert (topic.count, topic.messages, topic.rate, topic.has_stamps) == (5, [], 1.0, False)


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\0\7\0\0abcd",
        b"\0\1\0\0\xff\xff\xff\xff",
        compress_zstd(b"\0\7" + bytes(limits.MAX_MESSAGE_SIZE)),
        compress_zstd(bytes(100))[:5] + b"damaged",
        b"\0\1\0\0" + struct.pack("<IIII", 1, 2, 0, 2**31),
        b"\0\1\0\0" + struct.pack("<IIIII", 0, 0, 1, 0, 210_000) + bytes(840_000),
    ],
    ids=["empty", "another encoding", "cut off", "a bomb", "damaged", "a long list", "many values"],
)
def test_a_message_that_is_damaged_is_passed_over(data: bytes) -> None:
    """The others count."""
    messages = [
        Recorded("/a", "sensor_msgs/msg/JointState", 10**9, data),
        Recorded("/a", "sensor_msgs/msg/JointState", 2 * 10**9, _numbers()),
    ]
    topic = _read({"bag.mcap": write_mcap(messages)}).topics["/a"]
    assert (topic.count, len(topic.messages)) == (2, 1)


def test_names_and_definitions_have_a_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    """Reading a hundred definitions of 60 kB would take long: the first ones are read."""
    monkeypatch.setattr("tests.recordings.writing.definition_of", lambda _: "int32 value\n" * 5_000)
    data = write_mcap(
        [], topics=[(f"/a{number}", f"lab_msgs/msg/A{number}") for number in range(100)]
    )
    read = _read({"bag.mcap": data})
    assert 60 < len(read.topics) < 80
    assert [note.kind for note in read.losses] == ["limit"]


def test_a_library_that_is_missing_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is compressed needs the extra `recordings`: a person can install it."""
    data = WAYS["lz4"](record())
    monkeypatch.setitem(__import__("sys").modules, "lz4.frame", None)
    with pytest.raises(RecordingError, match="with the extra `recordings`") as caught:
        _read({"bag.mcap": data})
    assert caught.value.is_limit
