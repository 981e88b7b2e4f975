"""Writes recordings: messages as CDR, and files in MCAP and SQLite as `ros2 bag record` writes them.

It shares no code with the reader but the table of well-known messages.
"""

import sqlite3
import struct
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any, NamedTuple

import yaml
from lz4 import frame as lz4  # type: ignore[import-untyped]

from grader.ros.interfaces.interface_types import FieldType
from grader.ros.interfaces.known_interfaces import known_interfaces

if sys.version_info >= (3, 14):
    from compression import zstd
else:
    from backports import zstd

MAGIC = b"\x89MCAP0\r\n"
_FORMATS = {
    "bool": "?", "byte": "B", "char": "B", "int8": "b", "uint8": "B", "int16": "h", "uint16": "H", "int32": "i",
    "uint32": "I", "int64": "q", "uint64": "Q", "float32": "f", "float64": "d",
}  # fmt: skip
compress_zstd = zstd.compress
_PACK: Mapping[str, Callable[[bytes], bytes]] = {
    "": bytes,
    "zstd": compress_zstd,
    "lz4": lz4.compress,
    "snappy": bytes,
}
# What a message has if nothing is given: no rotation.
_DEFAULTS: Mapping[str, Mapping[str, Any]] = {"geometry_msgs/Quaternion": {"w": 1.0}}
OWN_TYPES = {
    "lab_msgs/Goal": {"goal": FieldType("geometry_msgs", "Point"), "name": FieldType("", "string")}
}


class Recorded(NamedTuple):
    """A message: its topic, its type, the recorder's time in nanoseconds and its bytes."""

    topic: str
    type: str
    time: int
    data: bytes


def fields_of(name: str) -> Mapping[str, FieldType]:
    """Return the fields of a message, std_msgs/Header."""
    if name in OWN_TYPES:
        return OWN_TYPES[name]
    package, short = name.split("/")
    known = known_interfaces(package, ("humble",))
    assert known is not None, name
    return {key: field.type for key, field in known[f"msg.{short}"].sections[0].fields.items()}


def encode(type_name: str, values: Mapping[str, Any], order: str = "<") -> bytes:
    """Return a message as CDR; what is not given is 0 or empty."""
    out = bytearray()
    package, name = type_name.replace("/msg/", "/").split("/")
    _put(out, FieldType(package, name), values, order)
    return bytes((0, order == "<", 0, 0)) + bytes(out)


def _put(out: bytearray, kind: FieldType, value: Any, order: str) -> None:
    one = kind._replace(is_list=False, size=None, is_bounded=False)
    if kind.is_list:
        items = list(value or ())
        if kind.size is None or kind.is_bounded:
            _put_number(out, order + "I", len(items))
        else:
            items += [None] * (kind.size - len(items))
        for item in items:
            _put(out, one, item, order)
    elif kind.package:
        name = f"{kind.package}/{kind.name}"
        given = {**_DEFAULTS.get(name, {}), **(value or {})}
        assert given.keys() <= fields_of(name).keys(), (name, given)
        for key, field in fields_of(name).items():
            _put(out, field, given.get(key), order)
    elif kind.name == "string":
        text = (value or "").encode() + b"\0"
        _put_number(out, order + "I", len(text))
        out += text
    else:
        _put_number(out, order + _FORMATS[kind.name], value or 0)


def _put_number(out: bytearray, code: str, value: Any) -> None:
    out += bytes(-len(out) % struct.calcsize(code)) + struct.pack(code, value)


def definition_of(type_name: str) -> str:
    """Return the definition of a message with those that it is made of, as MCAP has them."""
    main = type_name.replace("/msg/", "/")
    names = [main]
    for name in names:
        parts = [f"{kind.package}/{kind.name}" for kind in fields_of(name).values() if kind.package]
        names += [part for part in parts if part not in names]
    texts = [_definition(name) for name in names]
    line = "=" * 80
    others = [
        f"{line}\nMSG: {name}\n{text}" for name, text in zip(names[1:], texts[1:], strict=True)
    ]
    return "".join([f"# what {main} is\n{texts[0]}", *others])


def _definition(name: str) -> str:
    lines = []
    for key, kind in fields_of(name).items():
        word = f"{kind.package}/{kind.name}".removeprefix("/")
        bound = "<=" if kind.is_bounded else ""
        size = f"[{bound}{kind.size or ''}]" if kind.is_list else ""
        lines.append(f"{word}{size} {key}\n")
    return "".join(lines)


def _record(kind: int, content: bytes) -> bytes:
    return struct.pack("<BQ", kind, len(content)) + content


def _text(text: str) -> bytes:
    data = text.encode()
    return struct.pack("<I", len(data)) + data


def write_mcap(
    messages: Sequence[Recorded],
    *,
    topics: Sequence[tuple[str, str]] = (),
    chunked: int = 0,
    compression: str = "",
    is_closed: bool = True,
    is_defined: bool = True,
    qos: str = "",
) -> bytes:
    """Return a file in MCAP: with so many messages in a chunk if `chunked`, and more `topics` without messages.

    All publishers have one quality of service.
    """
    metadata = _text("offered_qos_profiles") + _text(qos) if qos else b""
    channels = dict.fromkeys([*topics, *((message.topic, message.type) for message in messages)])
    head, numbers = b"", {}
    for number, (topic, kind) in enumerate(channels, 1):
        numbers[topic, kind] = number
        definition = definition_of(kind) if is_defined else ""
        encoding = "ros2msg" if is_defined else ""
        head += _record(
            3, struct.pack("<H", number) + _text(kind) + _text(encoding) + _text(definition)
        )
        head += _record(
            4,
            struct.pack("<HH", number, number)
            + (_text(topic) + _text("cdr") + struct.pack("<I", len(metadata)) + metadata),
        )
    records = [
        _record(
            5,
            struct.pack("<HIQQ", numbers[one.topic, one.type], index, one.time, one.time)
            + one.data,
        )
        for index, one in enumerate(messages)
    ]
    parts = [head, *records]
    if chunked:
        parts = [head]
        for start in range(0, len(records), chunked):
            content = b"".join(records[start : start + chunked])
            packed = _PACK[compression](content)
            about = struct.pack("<QQQI", 0, 0, len(content), 0) + _text(compression)
            parts.append(_record(6, about + struct.pack("<Q", len(packed)) + packed))
    end = _record(15, bytes(4)) + _record(2, bytes(20)) + MAGIC if is_closed else b""
    return MAGIC + _record(1, _text("ros2") + _text("tests")) + b"".join(parts) + end


def write_sqlite(
    messages: Sequence[Recorded],
    *,
    topics: Sequence[tuple[str, str]] = (),
    is_defined: bool = True,
    qos: str = "",
) -> bytes:
    """Return a file in SQLite, as of Jazzy, or as of Humble without definitions, or as of Foxy without quality of service."""
    with closing(sqlite3.connect(":memory:")) as connection:
        connection.execute("PRAGMA page_size = 512")
        connection.execute(
            "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT)"
        )
        connection.execute(
            "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB)"
        )
        channels = list(
            dict.fromkeys([*topics, *((message.topic, message.type) for message in messages)])
        )
        rows = [(number, *channel, "cdr") for number, channel in enumerate(channels, 1)]
        connection.executemany("INSERT INTO topics VALUES (?, ?, ?, ?)", rows)
        if qos:
            connection.execute("ALTER TABLE topics ADD COLUMN offered_qos_profiles TEXT")
            connection.execute("UPDATE topics SET offered_qos_profiles = ?", (qos,))
        stored = [
            (channels.index((one.topic, one.type)) + 1, one.time, one.data) for one in messages
        ]
        connection.executemany(
            "INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)", stored
        )
        if is_defined:
            connection.execute(
                "CREATE TABLE message_definitions(topic_type TEXT, encoding TEXT, encoded_message_definition TEXT)"
            )
            defined = [
                (kind, "ros2msg", definition_of(kind))
                for kind in sorted({kind for _, kind in channels})
            ]
            connection.executemany("INSERT INTO message_definitions VALUES (?, ?, ?)", defined)
        connection.commit()
        return connection.serialize()


def write_metadata(*names: str) -> bytes:
    """Return a metadata.yaml that lists files, without what the grader does not read."""
    listed = "".join(f"    - {name}\n" for name in names)
    return f"rosbag2_bagfile_information:\n  version: 9\n  relative_file_paths:\n{listed}".encode()


def write_text(text: str) -> bytes:
    """Return a file in MCAP with messages in YAML: lists of seconds, topic, type and content.

    A header without a time gets that of the message, 100 s later.
    """
    messages = []
    for seconds, topic, kind, content in yaml.safe_load(text):
        header = content.get("header", {})
        if "header" in fields_of(kind.replace("/msg/", "/")):
            content = {**content, "header": {"stamp": {"sec": 100 + int(seconds)}, **header}}
        messages.append(Recorded(topic, kind, round((100 + seconds) * 1e9), encode(kind, content)))
    return write_mcap(messages)


def write_files(folder: Path, files: Mapping[str, bytes]) -> None:
    """Write files, by their paths in a folder."""
    for path, data in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(data)
