"""What a message, service or action is made of: sections of fields and constants."""

from collections.abc import Mapping
from typing import Literal

from grader.base.grouping import Strings
from grader.base.records import Named
from grader.base.source import Location

InterfaceKind = Literal["msg", "srv", "action"]
# The names that rosidl gives the sections of a file in Python: an empty one is the type itself.
SECTIONS: Mapping[InterfaceKind, Strings] = {
    "msg": ("",),
    "srv": ("Request", "Response"),
    "action": ("Goal", "Result", "Feedback"),
}
BOOLEANS = frozenset({"bool"})
TEXTS = frozenset({"string", "wstring"})
FLOATS = frozenset({"float32", "float64"})
INTEGERS = frozenset(
    {"int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64", "char"}
)
_BYTES = frozenset({"byte"})
PRIMITIVES = BOOLEANS | TEXTS | FLOATS | INTEGERS | _BYTES | {"duration", "time"}


class FieldType(Named):
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

    @property
    def written(self) -> str:
        """The type as a file of an interface has it: geometry_msgs/Point[<=3]."""
        name = f"{self.package}/{self.name}" if self.package else self.name
        bound = f"<={self.text_bound}" if self.text_bound is not None else ""
        size = "" if self.size is None else f"{self.size}"
        size = f"<={size}" if self.is_bounded else size
        return f"{name}{bound}[{size}]" if self.is_list else f"{name}{bound}"


class InterfaceField(Named):
    """A field of a section, and where its line begins."""

    name: str
    type: FieldType
    location: Location | None = None


class InterfaceSection(Named):
    """The fields and constants of a message, or of a part of a service or action.

    Of the constants, it has the names.
    """

    fields: Mapping[str, InterfaceField]
    constants: frozenset[str] = frozenset()


class InterfaceFault(Named):
    """Why rosidl does not accept a file.

    `written` is the word that is wrong, and `meant` the one that may be meant.
    """

    message: str
    location: Location
    written: str = ""
    meant: str | None = None


class Interface(Named):
    """A message, service or action.

    With `faults`, rosidl does not accept its file, and its fields are those that can be read.
    """

    kind: InterfaceKind
    sections: tuple[InterfaceSection, ...]
    faults: tuple[InterfaceFault, ...] = ()

    @property
    def fields(self) -> Mapping[str, InterfaceField]:
        """All fields by their names with those of their sections: goal.target."""
        fields = {}
        for part, section in zip(SECTIONS[self.kind], self.sections, strict=False):
            for name, field in section.fields.items():
                fields[f"{part.lower()}.{name}".removeprefix(".")] = field
        return fields

    def section(self, name: str) -> InterfaceSection | None:
        """Return a section by its name in Python, such as Request; None where there is none."""
        names = SECTIONS[self.kind]
        if name in names and len(self.sections) == len(names):
            return self.sections[names.index(name)]
        return None
