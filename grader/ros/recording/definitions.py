"""The fields of messages: by the definition in a recording, else as Humble has them.

Recordings of Humble in SQLite have no definitions.
"""

import re
from collections.abc import Mapping

from grader.base.patterns import on_use
from grader.ros.interfaces.interface_file import read_interface
from grader.ros.interfaces.interface_types import FieldType, InterfaceSection
from grader.ros.interfaces.known_interfaces import known_interfaces

_Fields = Mapping[str, FieldType]

_PART = on_use(r"^=+[ \t]*\n", re.MULTILINE)
_RELEASE = "humble"
# What rosidl puts into a message without fields.
_EMPTY = {"structure_needs_at_least_one_member": FieldType("", "uint8")}
_MAX_PARTS = 200


def plain_name(type_name: str) -> str:
    """Return the name of a type as definitions have it: geometry_msgs/Twist."""
    return type_name.replace("/msg/", "/")


class MessageDefinitions:
    """The fields of a type, and those of the types that it is made of."""

    def __init__(self, type_name: str, text: str) -> None:
        self._parts = {}
        if not text.strip():
            return
        first, *others = _PART.split(text.replace("\r\n", "\n"))[:_MAX_PARTS]
        main = plain_name(type_name)
        self._parts[main] = _read_fields(main, first)
        for part in others:
            heading, _, fields = part.partition("\n")
            name = plain_name(heading.removeprefix("MSG:").strip())
            self._parts.setdefault(name, _read_fields(name, fields))

    def find_fields(self, name: str) -> _Fields | None:
        """Return the types of the fields of a type, in order; None if it is not known."""
        if self._parts.get(name) is None:
            self._parts[name] = _find_known(name)
        return self._parts[name]


def _read_fields(name: str, text: str) -> _Fields | None:
    """Return the fields that a text defines; None if rosidl does not accept it."""
    package = name.partition("/")[0]
    interface = read_interface(plain_name(text).encode(), "Message.msg", package)
    if interface.faults or not interface.sections:
        return None
    return _list_types(interface.sections[0])


def _find_known(name: str) -> _Fields | None:
    package, _, short = name.partition("/")
    known = known_interfaces(package, (_RELEASE,)) if package.isidentifier() else None
    interface = (known or {}).get(f"msg.{short}")
    return _list_types(interface.sections[0]) if interface else None


def _list_types(section: InterfaceSection) -> _Fields:
    fields = {name: field.type for name, field in section.fields.items()}
    return fields or _EMPTY
