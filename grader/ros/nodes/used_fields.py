"""The fields that code uses of messages, services and actions: which type should have each."""

from collections.abc import Callable, Sequence

from grader.base.names import closest, near
from grader.base.records import Named
from grader.ros.interfaces.interface_types import (
    FieldType,
    Interface,
    InterfaceSection,
)
from grader.ros.interfaces.known_interfaces import MORE_CONSTANTS
from grader.ros.nodes.message_uses import ITEM
from grader.ros.nodes.node_facts import FieldUse

_OF_PYTHON = ("get_fields_and_field_types", "SLOT_TYPES")  # besides what begins with _
_GOAL_HANDLE = "GoalHandle"
FindInterface = Callable[[str, str], Interface | None]  # by its package and name: msg.Twist


class UsedField(Named):
    """The last name of a path of fields, and the section of a type that should have it."""

    owner: str  # as ROS 2 writes it: geometry_msgs/msg/Twist
    section: InterfaceSection
    name: str

    @property
    def noun(self) -> str:
        """What the name is, in words."""
        return "constant" if self.name.isupper() else "field"

    @property
    def names(self) -> Sequence[str]:
        """The names that there are in its place."""
        return sorted(self.section.constants) if self.name.isupper() else list(self.section.fields)

    @property
    def is_of_python(self) -> bool:
        """Whether the class that rosidl generates has an attribute that is no field."""
        constants = self.section.constants
        name = self.name
        may_be_constant = MORE_CONSTANTS in constants and name.isupper()
        is_known = name in constants or name in _OF_PYTHON or may_be_constant
        return is_known or name.startswith("_") or name.endswith("__DEFAULT")

    @property
    def is_absent(self) -> bool:
        """Whether there is no field or attribute of the name; an item of a list is none."""
        return self.name not in self.section.fields and self.name != ITEM and not self.is_of_python

    def find_meant(self, find: FindInterface, *, is_sure: bool = False) -> str | None:
        """Return the path that is meant: in a field, or with a similar name unless it `is_sure`."""
        inside = []
        for field in self.section.fields.values():
            if field.type.package and not field.type.is_list:
                part = _section_of_type(field.type, find)
                if part and self.name in part.fields:
                    inside.append(f"{field.name}.{self.name}")
        if len(inside) == 1:
            return inside[0]
        sure = near(self.name, self.names)
        return sure if is_sure else sure or closest(self.name, self.names)


def resolve_field(use: FieldUse, find: FindInterface) -> UsedField | None:
    """Return the field that code uses; None where it is not known what should have it."""
    package, kind, name, *sections = use.type.split(".")
    section_name = "".join(sections)
    path = list(use.path)
    if section_name == _GOAL_HANDLE:
        if path.pop(0) != "request" or not path:
            return None
        section_name = "Goal"
    interface = find(package, f"{kind}.{name}")
    section = interface.section(section_name) if interface else None
    owner = (
        f"{package}/{kind}/{name}.{section_name}" if section_name else f"{package}/{kind}/{name}"
    )
    while section is not None:
        attribute = path.pop(0)
        if not path:
            return UsedField(owner, section, attribute)
        field = section.fields.get(attribute)
        if not field or (field.type.is_list and path.pop(0) != ITEM) or not path:
            return None
        section = _section_of_type(field.type, find)
        owner = f"{field.type.package}/msg/{field.type.name}"
    return None


def _section_of_type(kind: FieldType, find: FindInterface) -> InterfaceSection | None:
    """Return the fields of the message that a field has, or that its items are."""
    interface = find(kind.package, f"msg.{kind.name}")
    return interface.section("") if interface else None
