"""A robot for checks: reading a value of it that xacro leaves open needs manual grading.

A plug-in cannot read such a value by accident: each field of a view that can be open is a property,
which raises NotDecided, or MissingElement where xacro refuses the text of the field.
"""

from dataclasses import field, replace
from typing import Any, Self, TypeVar

from grader.base.errors import MissingElement, NotDecided
from grader.base.text import quoted
from grader.ros.urdf.model import Colour, Joint, Joints, Link, Material, Robot, Visual

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


def guarded(robot: Robot, parents: Joints) -> tuple[Robot, dict[str, Joint]]:
    """Return views of a robot and of its parent joints, in which reading what is open raises.

    So does reading the links and joints as a whole, and asking for one that is not there, where it
    is open which ones there are.
    """
    joints = tuple(_JointView(joint) if joint.unresolved else joint for joint in robot.joints)
    view = replace(
        robot,
        links=tuple(map(_view_of_link, robot.links)),
        joints=joints,
        materials=tuple(map(_view_of_material, robot.materials)),
    )
    view_by_child = {}
    for joint in joints:
        child = joint.known.child
        if parents.get(child) is joint.known:
            view_by_child[child] = joint
    view_parents = {child: view_by_child[child] for child in parents}
    return _IncompleteRobot(view) if robot.incomplete else view, view_parents


def _view_of_link(link: Link) -> Link:
    if any(visual.material is not None and visual.material.unresolved for visual in link.visuals):
        link = link._replace(visuals=tuple(map(_view_of_visual, link.visuals)))
    return _LinkView(link) if link.unresolved else link


def _view_of_visual(visual: Visual) -> Visual:
    material = visual.material
    return visual if not material else visual._replace(material=_view_of_material(material))


def _view_of_material(material: Material) -> Material:
    if any(part.reason for part in material.unresolved.values()):
        return _MaterialView(material)
    return material


def _value_if_known(part: Link | Joint, field: str, value: _Value) -> _Value:
    """Return the value of a field of a link or joint.

    Raises NotDecided or MissingElement if it is open.
    """
    key = _KEYS.get(field, field)
    unresolved = part.unresolved.get(key)
    # What the file does not give may be among unknown children. A visual that is known counts, even
    # if there are more.
    if not unresolved and (field == "collisions" or not value):
        unresolved = part.unresolved.get("")
    if not unresolved:
        return value
    unresolved.check()
    if field in _OF_PLACE:
        return value
    if isinstance(part, Joint):
        kind = "joint"
        owner = part.child
    else:
        kind = "link"
        owner = part.name
    message = f"xacro cannot expand the {key} of {kind} {quoted(part.name)}"
    raise MissingElement(key, owner, message=message, location=unresolved.location)


def _field_if_known(field: str) -> Any:
    """Return the property of a view that is this field of what it shows, unless it is open."""
    return property(lambda view: _value_if_known(view, field, getattr(view.known, field)))


def _closed_field(field: str) -> Any:
    """Return the property of a view that is this field of what it shows, which is never open."""
    return property(lambda view: getattr(view.known, field))


class _MaterialView(Material):
    """A material of which something is open.

    Neither its colour nor its texture can be read.
    """

    _known: Material

    def __new__(cls, known: Material) -> Self:
        view = super().__new__(cls, *known)
        view._known = known
        return view

    @property
    def known(self) -> Material:
        return self._known

    name = _closed_field("name")
    location = _closed_field("location")
    unresolved = _closed_field("unresolved")

    @property
    def rgba(self) -> Colour:
        raise self._undecided()

    @property
    def texture(self) -> str:
        raise self._undecided()

    def _undecided(self) -> NotDecided:
        reasons = (part.reason for part in self.known.unresolved.values())
        return NotDecided(next(filter(None, reasons)))


class _LinkView(Link):
    """A link of which something is open."""

    _known: Link

    def __new__(cls, known: Link) -> Self:
        view = super().__new__(cls, *known)
        view._known = known
        return view

    @property
    def known(self) -> Link:
        return self._known

    location = _closed_field("location")
    unresolved = _closed_field("unresolved")

    name = _field_if_known("name")
    visuals = _field_if_known("visuals")
    collisions = _field_if_known("collisions")
    inertial = _field_if_known("inertial")


class _JointView(Joint):
    """A joint of which something is open."""

    _known: Joint

    def __new__(cls, known: Joint) -> Self:
        view = super().__new__(cls, *known)
        view._known = known
        return view

    @property
    def known(self) -> Joint:
        return self._known

    location = _closed_field("location")
    axis_location = _closed_field("axis_location")
    unresolved = _closed_field("unresolved")

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


_ALL_ELEMENTS = property(Robot.check_complete)


class _IncompleteRobot(Robot):
    """A robot that may have more links and joints than are known.

    Those that are known can be read one by one.
    """

    known: Robot = field(init=False)

    def __init__(self, known: Robot) -> None:
        vars(self)["known"] = known

    name = _closed_field("name")
    links = joints = _ALL_ELEMENTS
    materials = _closed_field("materials")
    rejected = _closed_field("rejected")
    incomplete = _closed_field("incomplete")

    def link(self, name: str) -> Link:
        return self.known.link(name)

    def joint(self, name: str) -> Joint:
        return self.known.joint(name)

    def has_link(self, name: str) -> bool:
        if not self.known.has_link(name):
            self.check_complete()
        return True

    def has_joint(self, name: str) -> bool:
        if not self.known.has_joint(name):
            self.check_complete()
        return True
