"""Decodes a message: CDR, the first version, as all recordings of ROS 2 have it.

The source is the specification of DDS-XTYPES 1.3, 7.4, and the output of rosbags.
"""

import struct
from collections.abc import Mapping
from typing import Any

from grader.files import limits
from grader.ros.interfaces.interface_types import FieldType
from grader.ros.recording.definitions import MessageDefinitions, plain_name

_LETTERS = {
    "bool": "?",
    "byte": "B",
    "char": "B",
    "int8": "b",
    "uint8": "B",
    "int16": "h",
    "uint16": "H",
    "int32": "i",
    "uint32": "I",
    "int64": "q",
    "uint64": "Q",
    "float32": "f",
    "float64": "d",
}
_MAX_DEPTH = 20  # of messages inside each other

Message = Mapping[str, Any]


class CannotDecode(Exception):
    """A message is damaged, or its type is not known."""


class MessageDecoder:
    """Decodes the messages of one type."""

    def __init__(self, type_name: str, definition: str) -> None:
        self._name = plain_name(type_name)
        self._definitions = MessageDefinitions(type_name, definition)
        self._data = b""
        self._at = 0
        self._order = "<"
        self._left = 0

    @property
    def has_header(self) -> bool:
        """Whether messages begin with a header."""
        fields = self._definitions.find_fields(self._name) or {}
        first = next(iter(fields.items()), None)
        return first == ("header", FieldType("std_msgs", "Header"))

    def decode(self, data: bytes) -> Message:
        """Return the fields of a message by their names; raises CannotDecode."""
        if len(data) < 4 or data[0] or data[1] > 1:
            raise CannotDecode("it is not in CDR")
        self._order = "><"[data[1]]
        self._data = data
        self._at = 4
        self._left = limits.MAX_MESSAGE_VALUES
        try:
            return self._read_message(self._name, 0)
        except struct.error:
            raise CannotDecode("it is cut off") from None

    def _read_message(self, name: str, depth: int) -> Message:
        fields = self._definitions.find_fields(name)
        if fields is None or depth > _MAX_DEPTH:
            raise CannotDecode(f"the definition of {name} is not known")
        return {field: self._read_field(kind, depth) for field, kind in fields.items()}

    def _read_field(self, kind: FieldType, depth: int) -> Any:
        if not kind.is_list:
            return self._read_one(kind, depth)
        # Of a list, a fixed size is not in the message.
        is_fixed = kind.size is not None and not kind.is_bounded
        count: Any = kind.size if is_fixed else self._read_numbers("I", 1)[0]
        if kind.name in _LETTERS:
            return self._read_numbers(_LETTERS[kind.name], count)
        return [self._read_one(kind, depth) for _ in range(count)]

    def _read_one(self, kind: FieldType, depth: int) -> Any:
        self._left -= 1
        if self._left < 0:
            raise CannotDecode("it has too many values")
        if kind.package:
            return self._read_message(f"{kind.package}/{kind.name}", depth + 1)
        if kind.name in _LETTERS:
            return self._read_numbers(_LETTERS[kind.name], 1)[0]
        if kind.name != "string":
            raise CannotDecode(f"a field of the type {kind.name} cannot be decoded")
        (size,) = self._read_numbers("I", 1)
        start = self._at
        self._at = self._at + size
        if self._at > len(self._data):
            raise CannotDecode("it is cut off")
        return self._data[start : self._at].removesuffix(b"\0").decode(errors="replace")

    def _read_numbers(self, letter: str, count: Any) -> tuple[Any, ...]:
        """Return numbers, which are aligned to their size behind the head of the message."""
        size = struct.calcsize("<" + letter)
        if not count:
            return ()
        self._at += -(self._at - 4) % size
        if self._at + count * size > len(self._data):
            raise CannotDecode("it is cut off")
        values = struct.unpack_from(f"{self._order}{count}{letter}", self._data, self._at)
        self._at += count * size
        return values
