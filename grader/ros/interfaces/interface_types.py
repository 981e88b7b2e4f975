"""What a message, service or action is made of: sections of fields and constants."""

from collections.abc import Mapping
from typing import Literal, NamedTuple

from grader.base.source import Location

InterfaceKind = Literal["msg", "srv", "action"]
# The names that rosidl gives the sections of a file in Python: an empty one is the type itself.
SECTIONS: Mapping[InterfaceKind, tuple[str, ...]] = {
    "msg": ("",),
    "srv": ("Request", "Response"),
    "action": ("Goal", "Result", "Feedback"),
}
BOOLEANS, TEXTS = frozenset({"bool"}), frozenset({"string", "wstring"})
FLOATS = frozenset({"float32", "float64"})
INTEGERS = frozenset(
    {"int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64", "char"}
)
_BYTES = frozenset({"byte"})
PRIMITIVES = BOOLEANS | TEXTS | FLOATS | INTEGERS | _BYTES | {"duration", "time"}


class FieldType(NamedTuple):
    """The type of a field: a primitive one or a message; or a list of these.

    The `package` of a primitive type is empty.
    """

    package: str
    name: str
    is_list: bool = False
    size: int | None = None  # of a list: how long it is, or may be at most if it is bounded
    is_bounded: bool = False
    text_bound: int | None = None  # the most characters of a text

    @property
    def full_name(self) -> str:
        """The name of a message in Python, geometry_msgs.msg.Twist; a primitive type as it is."""
        if self.package:
            return f"{self.package}.msg.{self.name}"
        return self.name


class InterfaceField(NamedTuple):
    """A field of a section, and where its line begins."""

    name: str
    type: FieldType
    location: Location | None = None


class InterfaceSection(NamedTuple):
    """The fields and constants of a message, or of a part of a service or action.

    Of the constants, it has the names.
    """

    fields: Mapping[str, InterfaceField]
    constants: frozenset[str] = frozenset()


class InterfaceFault(NamedTuple):
    """Why rosidl does not accept a file.

    `written` is the word that is wrong, and `meant` the one that may be meant.
    """

    message: str
    location: Location
    written: str = ""
    meant: str | None = None


class Interface(NamedTuple):
    """A message, service or action.

    With `faults`, rosidl does not accept its file, and its fields are those that can be read.
    """

    kind: InterfaceKind
    sections: tuple[InterfaceSection, ...]
    faults: tuple[InterfaceFault, ...] = ()

    def section(self, name: str) -> InterfaceSection | None:
        """Return a section by its name in Python, such as Request; None where there is none."""
        names = SECTIONS[self.kind]
        if name in names and len(self.sections) == len(names):
            return self.sections[names.index(name)]
        return None
