"""A robot for checks: reading a value of it that xacro leaves open needs manual grading.

A plug-in cannot read such a value by accident: each field of a view that can be open is a property,
which raises NotDecided, or MissingElement where xacro refuses the text of the field.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, TypeVar

from grader.base.errors import MissingElement, NotDecided
from grader.base.text import quoted
from grader.ros.urdf.model import Joint, Link, Material, Robot, Visual

_KEYS = {
    "name": "@name",
    "type": "@type",
    "visuals": "visual",
    "collisions": "collision",
}  # in UnresolvedParts
_OF_PLACE = (
    "name",
    "parent",
    "child",
    "type",
    "origin",
    "axis",
)  # what xacro refuses of these is wrong, not missing

_Value = TypeVar("_Value")


def guarded(robot: Robot, parents: Mapping[str, Joint]) -> tuple[Robot, dict[str, Joint]]:
    """Return views of a robot and of its parent joints, in which reading what is open raises.

    So does reading the links and joints as a whole, and asking for one that is not there, where it
    is open which ones there are.
    """
    joints = tuple(_JointView(joint) if joint.unresolved else joint for joint in robot.joints)
    links, materials = (
        tuple(map(_view_of_link, robot.links)),
        tuple(map(_view_of_material, robot.materials)),
    )
    found = replace(robot, links=links, joints=joints, materials=materials)
    views = {
        view.known.child: view for view in joints if parents.get(view.known.child) is view.known
    }
    return _IncompleteRobot(found) if robot.incomplete else found, {
        child: views[child] for child in parents
    }


def _view_of_link(link: Link) -> Link:
    if any(visual.material is not None and visual.material.unresolved for visual in link.visuals):
        link = replace(link, visuals=tuple(map(_view_of_visual, link.visuals)))
    return _LinkView(link) if link.unresolved else link


def _view_of_visual(visual: Visual) -> Visual:
    if visual.material is not None:
        return replace(visual, material=_view_of_material(visual.material))
    return visual


def _view_of_material(material: Material) -> Material:
    if any(part.reason for part in material.unresolved.values()):
        return _MaterialView(material)
    return material


def _value_if_known(part: Link | Joint, field: str, value: _Value) -> _Value:
    """Return the value of a field of a link or joint; raise NotDecided or MissingElement if it is
    open.
    """
    key = _KEYS.get(field, field)
    found = part.unresolved.get(key)
    # What the file does not give may be among unknown children. A visual that is known counts, even
    # if there are more.
    if found is None and (field == "collisions" or not value):
        found = part.unresolved.get("")
    if found is None:
        return value
    found.check()
    if field in _OF_PLACE:
        return value
    kind, owner = ("joint", part.child) if isinstance(part, Joint) else ("link", part.name)
    message = f"xacro cannot expand the {key} of {kind} {quoted(part.name)}"
    raise MissingElement(key, owner, message=message, location=found.location)


def _field_if_known(field: str) -> Any:
    """Return the property of a view that is this field of what it shows."""
    return property(lambda view: _value_if_known(view, field, getattr(view.known, field)))


def _copy_fields(view: object, known: object, *names: str) -> None:
    """Give a view fields of what it shows, which are never open; it is frozen as that is."""
    for name in names:
        object.__setattr__(view, name, getattr(known, name))


class _MaterialView(Material):
    """A material of which something is open, so that neither its colour nor its texture can be
    read.
    """

    __slots__ = ()

    def __init__(self, known: Material) -> None:
        _copy_fields(self, known, "name", "location", "unresolved")

    @property
    def rgba(self) -> tuple[float, float, float, float]:
        raise self._undecided()

    @property
    def texture(self) -> str:
        raise self._undecided()

    def _undecided(self) -> NotDecided:
        return NotDecided(next(part.reason for part in self.unresolved.values() if part.reason))


class _LinkView(Link):
    """A link of which something is open."""

    __slots__ = ("_known",)
    _known: Link

    def __init__(self, known: Link) -> None:
        object.__setattr__(self, "_known", known)
        _copy_fields(self, known, "location", "unresolved")

    @property
    def known(self) -> Link:
        return self._known

    name = _field_if_known("name")
    visuals = _field_if_known("visuals")
    collisions = _field_if_known("collisions")
    inertial = _field_if_known("inertial")


class _JointView(Joint):
    """A joint of which something is open."""

    __slots__ = ("_known",)
    _known: Joint

    def __init__(self, known: Joint) -> None:
        object.__setattr__(self, "_known", known)
        _copy_fields(self, known, "location", "axis_location", "unresolved")

    @property
    def known(self) -> Joint:
        return self._known

    name = _field_if_known("name")
    type = _field_if_known("type")
    parent = _field_if_known("parent")
    child = _field_if_known("child")
    origin = _field_if_known("origin")
    axis = _field_if_known("axis")
    limit = _field_if_known("limit")
    mimic = _field_if_known("mimic")
    dynamics = _field_if_known("dynamics")
    safety_controller = _field_if_known("safety_controller")
    calibration = _field_if_known("calibration")


class _IncompleteRobot(Robot):
    """A robot that may have more links and joints than are known: those that are known can be read
    one by one.
    """

    __slots__ = ()

    def __init__(self, known: Robot) -> None:
        _copy_fields(
            self, known, "name", "materials", "rejected", "incomplete", "_links", "_joints"
        )

    @property
    def links(self) -> tuple[Link, ...]:
        raise NotDecided(self.incomplete)

    @property
    def joints(self) -> tuple[Joint, ...]:
        raise NotDecided(self.incomplete)

    def has_link(self, name: str) -> bool:
        if name not in self._links:
            self.check_complete()
        return True

    def has_joint(self, name: str) -> bool:
        if name not in self._joints:
            self.check_complete()
        return True
