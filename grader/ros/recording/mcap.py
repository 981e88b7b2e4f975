"""Reads a file in MCAP from its beginning, closed or not: no index is needed.

The source is the specification, https://mcap.dev/spec.
"""

import io
import struct
from contextlib import suppress
from typing import IO

from grader.base.errors import RecordingError
from grader.base.text import size_text
from grader.files import limits
from grader.ros.recording.compression import unpack
from grader.ros.recording.recorded import Channel, Collector

MAGIC = b"\x89MCAP0\r\n"
_HEAD = struct.Struct("<BQ")  # of a record: its kind, and its size
_MESSAGE = struct.Struct("<HIQQ")  # channel, number, the recorder's time, the publisher's time
_CHUNK_HEAD = 28  # bytes: two times, the size, a checksum
_END = 15  # the kind of the record behind the data


class _Cut(Exception):
    """The file ends inside of a record."""


def read_mcap(file: IO[bytes], collector: Collector) -> None:
    """Read a file behind its magic into channels; raises RecordingError beyond a limit."""
    with suppress(_Cut):
        if _McapReader(file, collector).read():
            return
    collector.note("unclosed", "the recorder did not close the file")


class _McapReader:
    """Reads the records of a file, and those of the chunks in it."""

    def __init__(self, file: IO[bytes], collector: Collector) -> None:
        self._file = file
        self._collector = collector
        self._schemas: dict[int, tuple[str, str]] = {}
        self._channels: dict[int, Channel | None] = {}

    def read(self, *, is_chunk: bool = False) -> bool:
        """Read all records; return whether the one that ends the data is there."""
        while head := self._file.read(_HEAD.size):
            if len(head) < _HEAD.size:
                raise _Cut
            kind, size = _HEAD.unpack(head)
            if size > limits.MAX_RECORDING_SIZE:
                self._collector.note("damaged", "a record is longer than any file may be")
                raise _Cut
            if kind == _END and not is_chunk:
                return True
            try:
                self._read_record(kind, size, is_chunk=is_chunk)
            except (struct.error, ValueError):
                self._collector.note("damaged", "a record cannot be read")
        return False

    def _read_record(self, kind: int, size: int, *, is_chunk: bool) -> None:
        match kind:  # as the specification numbers them
            case 3:
                self._read_schema(self._read_whole(size))
            case 4:
                self._read_channel(self._read_whole(size))
            case 5 if size >= _MESSAGE.size:
                self._read_message(size - _MESSAGE.size)
            case 6 if not is_chunk:
                self._read_chunk(size)
            case _:
                self._file.seek(size, io.SEEK_CUR)

    def _read_part(self, size: int) -> bytes:
        """Return the content of a record, as far as it is there."""
        if size > limits.MAX_CHUNK_SIZE:
            limit = size_text(limits.MAX_CHUNK_SIZE)
            raise RecordingError(f"a record is longer than {limit}", is_limit=True)
        return self._file.read(size)

    def _read_whole(self, size: int) -> bytes:
        data = self._read_part(size)
        if len(data) < size:
            raise _Cut
        return data

    def _read_schema(self, data: bytes) -> None:
        (number,) = struct.unpack_from("<H", data)
        name, at = _read_text(data, 2)
        encoding, at = _read_text(data, at)
        definition, _ = _read_text(data, at)
        self._schemas[number] = (name, definition if encoding == "ros2msg" else "")

    def _read_channel(self, data: bytes) -> None:
        number, schema = struct.unpack_from("<HH", data)
        topic, _ = _read_text(data, 4)
        qos = data.partition(b"offered_qos_profiles")[2].decode(errors="replace")
        type_name, definition = self._schemas.get(schema, ("", ""))
        self._channels[number] = self._collector.open_channel(topic, type_name, definition, qos)

    def _read_message(self, size: int) -> None:
        number, _, time, _ = _MESSAGE.unpack(self._read_whole(_MESSAGE.size))
        channel = self._channels.get(number)
        wanted = channel.count_wanted(size) if channel else 0
        data = self._read_whole(wanted)
        if size > wanted:
            self._file.seek(size - wanted, io.SEEK_CUR)
        if channel:
            self._collector.add(channel, time, data)

    def _read_chunk(self, size: int) -> None:
        """Read the records of a chunk: also of the last one, which may be cut off."""
        data = self._read_part(size)
        method, at = _read_text(data, _CHUNK_HEAD)
        packed = data[at + 8 :]
        try:
            records = packed
            if method:
                records = unpack(method, packed, limits.MAX_CHUNK_SIZE)
                self._collector.spend(len(records))
        except RecordingError as error:
            if error.is_limit:
                raise
            self._collector.note("damaged", "a chunk cannot be decompressed")
        else:
            file = self._file
            self._file = io.BytesIO(records)
            with suppress(_Cut):
                self.read(is_chunk=True)
            self._file = file
        if len(data) < size:
            raise _Cut


def _read_text(data: bytes, at: int) -> tuple[str, int]:
    """Return a text with its size before it, and where it ends; raises struct.error, ValueError."""
    (size,) = struct.unpack_from("<I", data, at)
    end = at + 4 + size
    if end > len(data):
        raise ValueError("a text is cut off")
    return data[at + 4 : end].decode(errors="replace"), end
