"""A robot as plain values.

It is the content of a URDF as ROS 2 keeps it, and what xacro leaves open of it.

Lengths are metres, angles radians about fixed axes x, y, z (REP 103). `None` is a value that the
file gives but that cannot be read; a value that the file does not give has ROS 2's default.
"""

from collections.abc import Collection, Iterable, Mapping
from functools import cached_property
from itertools import islice
from math import pi
from operator import attrgetter
from typing import NamedTuple, NoReturn, TypeVar

from grader.base.errors import MissingElement, NotDecided
from grader.base.grouping import Strings
from grader.base.names import closest, similar_there
from grader.base.records import Named, Record
from grader.base.source import LazyLocation
from grader.base.text import quoted
from grader.base.transforms import IDENTITY, Transform, Vector, rotation_from_rpy

_Place = LazyLocation | None

INERTIA = (
    "ixx",
    "ixy",
    "ixz",
    "iyy",
    "iyz",
    "izz",
)  # the components, in the order of Inertial.inertia


_MAX_COMPARED = 50  # links whose names are compared

_Value = TypeVar("_Value")
_PLACES = ("location", "axis_location", "unresolved")  # fields that are no values
_COMPARED: dict[type, Strings] = {}  # the other fields


def compared_fields(kind: type) -> Strings:
    """Return the fields of a kind of element that are its values: all but places in a file."""
    return _COMPARED[kind]


def _compared_by_values(kind: type[_Value]) -> type[_Value]:
    """Make elements of a kind equal if their values are.

    Where they are in a file does not count. Dataclasses do the same, but to make one takes six
    times as long as a named tuple, which all commands wait for.
    """
    every: Strings = getattr(kind, "_fields")  # noqa: B009  of a named tuple
    _COMPARED[kind] = fields = tuple(name for name in every if name not in _PLACES)
    values = attrgetter(*fields)

    def is_equal(self: _Value, other: object) -> bool:
        return self.__class__ is other.__class__ and values(self) == values(other)

    def shown(self: _Value) -> str:
        named = (f"{field}={getattr(self, field)!r}" for field in fields)
        return f"{kind.__name__}({', '.join(named)})"

    methods = {
        "__eq__": is_equal,
        "__ne__": lambda self, other: not is_equal(self, other),
        "__hash__": lambda self: hash((kind, values(self))),
        "__repr__": shown,
    }
    for name, method in methods.items():
        setattr(kind, name, method)
    return kind


@_compared_by_values
class Origin(NamedTuple):
    """The pose of a child frame in its parent.

    `xyz` is in metres, `rpy` in radians about fixed axes.
    """

    xyz: Vector = (0.0, 0.0, 0.0)
    rpy: Vector = (0.0, 0.0, 0.0)
    location: _Place = None

    def placed_in(self, T_frame_parent: Transform = IDENTITY) -> Transform:
        """Return T_frame_child, of the frame that it places in its parent.

        By default, it is in the parent's own frame.
        """
        if self.rpy == (0.0, 0.0, 0.0):
            return Transform(T_frame_parent.rotation, T_frame_parent.apply(self.xyz))
        return T_frame_parent @ Transform(rotation_from_rpy(self.rpy), self.xyz)


_SAME_FRAME = Origin()


@_compared_by_values
class Box(Named):
    """A box about its centre; `size` is the full edge lengths along x, y, z in metres."""

    size: Vector
    location: _Place = None

    @property
    def volume(self) -> float:
        """The volume in cubic metres."""
        a, b, c = self.size
        return abs(a * b * c)

    @property
    def is_empty(self) -> bool:
        """Whether it is invisible: with one zero edge it is a plate, which RViz shows."""
        return self.size.count(0.0) >= 2


@_compared_by_values
class Cylinder(Named):
    """A cylinder about its centre, its axis along z; lengths in metres."""

    radius: float
    length: float
    location: _Place = None

    @property
    def volume(self) -> float:
        """The volume in cubic metres."""
        return pi * self.radius * self.radius * abs(self.length)

    @property
    def is_empty(self) -> bool:
        """Whether it is invisible: with a length of zero it is a disc, which RViz shows."""
        return self.radius == 0.0


@_compared_by_values
class Capsule(Named):
    """A cylinder about its centre with a half sphere at each end, its axis along z.

    The length is that of the cylinder alone, as in SDF; lengths in metres.
    """

    radius: float
    length: float
    location: _Place = None

    @property
    def volume(self) -> float:
        """The volume in cubic metres."""
        radius = abs(self.radius)
        return pi * radius * radius * (abs(self.length) + 4.0 / 3.0 * radius)

    @property
    def is_empty(self) -> bool:
        """Whether it is invisible."""
        return self.radius == 0.0


@_compared_by_values
class Sphere(Named):
    """A sphere about its centre; its radius in metres."""

    radius: float
    location: _Place = None

    @property
    def volume(self) -> float:
        """The volume in cubic metres."""
        return 4.0 / 3.0 * pi * self.radius * self.radius * abs(self.radius)

    @property
    def is_empty(self) -> bool:
        """Whether it is invisible."""
        return self.radius == 0.0


@_compared_by_values
class Mesh(Named):
    """A mesh file, with a factor of its size along each axis.

    Only pictures open it, so to checks its extent is unknown.
    """

    filename: str
    scale: Vector = (1.0, 1.0, 1.0)
    location: _Place = None

    @property
    def is_empty(self) -> bool:
        """Whether it is invisible, because it is scaled by zero along all three axes."""
        return not any(self.scale)


Geometry = Box | Cylinder | Capsule | Sphere | Mesh


class UnresolvedPart(Named):
    """A part of a link, joint or material that xacro leaves open.

    It has the reason, which is empty where xacro refuses it.
    """

    reason: str
    location: LazyLocation

    def check(self) -> None:
        """Raise NotDecided if the part cannot be determined."""
        if self.reason:
            raise NotDecided(self.reason)


# The parts of an element that are unresolved: "@name" for its attribute, "visual" for something in
# a <visual>, "" for more children than are known. Empty for a plain URDF.
Colour = tuple[float, float, float, float]  # red, green, blue and alpha, from 0 to 1
UnresolvedParts = Mapping[str, UnresolvedPart]
_NOTHING_OPEN: UnresolvedParts = {}


@_compared_by_values
class Material(Named):
    """A colour with channels in 0..1, red, green, blue, alpha.

    `texture` is a file name, never opened.
    """

    name: str
    rgba: Colour = (0.0, 0.0, 0.0, 1.0)
    texture: str = ""
    location: _Place = None
    unresolved: UnresolvedParts = _NOTHING_OPEN


@_compared_by_values
class Visual(NamedTuple):
    """One shape that a link shows, placed in its frame.

    `material` is resolved; None if ROS 2 has no colour for it, or cannot read it.
    """

    geometry: Geometry
    origin: Origin = _SAME_FRAME
    material: Material | None = None
    material_name: str = ""
    has_unreadable_colour: bool = False
    location: _Place = None


@_compared_by_values
class Collision(NamedTuple):
    """One shape that a link collides with."""

    geometry: Geometry
    origin: Origin = _SAME_FRAME
    location: _Place = None


@_compared_by_values
class Inertial(Named):
    """Mass in kilograms, centre of mass, and ixx, ixy, ixz, iyy, iyz, izz in kg m^2."""

    mass: float
    inertia: tuple[float, float, float, float, float, float]
    origin: Origin = _SAME_FRAME
    location: _Place = None


@_compared_by_values
class Link(NamedTuple):
    """A rigid body, whose frame all of its shapes and its centre of mass are placed in.

    >>> visual = Visual(Cylinder(0.1, 0.05), Origin((0.0, 0.0, 0.025)))
    >>> Link("lidar", visuals=(visual,)).visuals[0].geometry
    Cylinder(radius=0.1, length=0.05)
    """

    name: str
    visuals: tuple[Visual, ...] = ()
    collisions: tuple[Collision, ...] = ()
    inertial: Inertial | None = None
    location: _Place = None
    unresolved: UnresolvedParts = _NOTHING_OPEN

    @property
    def known(self) -> "Link":
        """The link as it is known, for code that decides itself what is open."""
        return self


@_compared_by_values
class Limit(Named):
    """A joint's range (rad or m), maximum effort (N m or N) and maximum velocity (rad/s or m/s).

    Here and in the other elements of a joint, a number that cannot be read is NaN.
    """

    lower: float
    upper: float
    effort: float
    velocity: float
    location: _Place = None


@_compared_by_values
class Mimic(Named):
    """This joint's position is `multiplier` times the named joint's, plus `offset`."""

    joint: str
    multiplier: float = 1.0
    offset: float = 0.0
    location: _Place = None


@_compared_by_values
class Dynamics(NamedTuple):
    """Damping (N m s/rad or N s/m) and static friction (N m or N)."""

    damping: float = 0.0
    friction: float = 0.0
    location: _Place = None


@_compared_by_values
class SafetyController(Named):
    """The range (rad or m) in which a safety controller keeps a joint.

    It also has its gains for position and velocity.
    """

    k_velocity: float
    soft_lower_limit: float = 0.0
    soft_upper_limit: float = 0.0
    k_position: float = 0.0
    location: _Place = None


@_compared_by_values
class Calibration(Named):
    """The positions (rad or m) at which a joint's reference switch has a rising or falling edge.

    A position is None if it is not given.
    """

    rising: float | None = None
    falling: float | None = None
    location: _Place = None


@_compared_by_values
class Joint(NamedTuple):
    """A joint between two links; its frame is the child link's frame.

    `origin` places that frame in the parent's, with the joint at 0; `axis` is a direction in the
    child's frame. `type` is the file's text, so a misspelt one can be quoted. `origin` and `axis`
    are None if they are given but cannot be read. `parent` and `child` are empty if the file does
    not name them.

    >>> origin = Origin((0.0, 0.2, 0.0))
    >>> axis = (0.0, 1.0, 0.0)
    >>> wheel = Joint("wheel_joint", "continuous", "base_link", "wheel", origin, axis=axis)
    >>> wheel.origin.xyz, wheel.axis
    ((0.0, 0.2, 0.0), (0.0, 1.0, 0.0))
    """

    name: str
    type: str
    parent: str
    child: str
    origin: Origin | None = _SAME_FRAME
    axis: Vector | None = (1.0, 0.0, 0.0)
    limit: Limit | None = None
    mimic: Mimic | None = None
    dynamics: Dynamics | None = None
    safety_controller: SafetyController | None = None
    calibration: Calibration | None = None
    location: _Place = None
    axis_location: _Place = None
    unresolved: UnresolvedParts = _NOTHING_OPEN

    @property
    def has_position(self) -> bool:
        """Whether a position moves it."""
        return self.type in ("revolute", "continuous", "prismatic")

    @property
    def known(self) -> "Joint":
        """The joint as it is known, for code that decides itself what is open."""
        return self


Joints = Mapping[str, Joint]  # by their names


class Robot(Record):
    """The links and joints of a URDF, as plain values that know nothing of poses.

    The reader makes it; `Configuration` puts its joints at positions and computes poses. Checks
    read it through that, where a value that xacro leaves open raises NotDecided (see
    `open_values`). Two robots are equal if their values are; where these are in a file does not
    count.

    >>> shoulder = Joint("shoulder", "fixed", "base", "arm")
    >>> robot = Robot("r", (Link("base"), Link("arm")), (shoulder,))
    >>> robot.joint("shoulder").child
    'arm'
    >>> robot.link("amr")
    Traceback (most recent call last):
    grader.base.errors.MissingElement: there is no link 'amr'; there is 'arm'
    """

    name: str
    links: tuple[Link, ...] = ()  # in file order; of two with the same name the first is looked up
    joints: tuple[Joint, ...] = ()  # likewise
    materials: tuple[Material, ...] = ()  # those under <robot> and those that visuals define
    rejected: bool = False  # ROS 2 rejects the file: this is what could be read of it
    incomplete: str = ""  # why there may be more links and joints; empty if there are not

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Robot) and self._values == other._values

    def __hash__(self) -> int:
        return hash(self._values)

    def __repr__(self) -> str:
        return f"Robot{self._values}"

    @property
    def _values(self) -> tuple[object, ...]:
        return self.name, self.links, self.joints, self.materials

    @cached_property
    def _links(self) -> Mapping[str, Link]:
        return {link.known.name: link for link in reversed(self.links)}

    @cached_property
    def _joints(self) -> Joints:
        return {joint.known.name: joint for joint in reversed(self.joints)}

    def link(self, name: str) -> Link:
        """Return the link of this name; raises MissingElement, which lists the existing names."""
        return self._links.get(name) or self._raise_missing("link", name, self.links)

    def joint(self, name: str) -> Joint:
        """Return the joint of this name; raises MissingElement, which lists the existing names."""
        return self._joints.get(name) or self._raise_missing("joint", name, self.joints)

    def has_joint(self, name: str) -> bool:
        """Return whether there is a joint of this name."""
        return name in self._joints

    def has_link(self, name: str) -> bool:
        """Return whether there is a link of this name."""
        return name in self._links

    def known_links(self, wanted: Collection[str]) -> int:
        """Return how many of the wanted links it has, also under a similar name."""
        names = {link.name for link in self.links}
        missing = set(wanted) - names
        others = islice(sorted(names.difference(wanted)), _MAX_COMPARED)
        similar = {closest(name, missing) for name in others} - {None} if missing else ()
        return len(wanted) - len(missing) + len(similar)

    def is_another(self, wanted: Collection[str]) -> bool:
        """Return whether it is completely known and has fewer than half of the wanted links."""
        if self.incomplete or 2 * sum(map(self.has_link, wanted)) >= len(wanted):
            return False  # without comparing names, which takes long
        return 2 * self.known_links(wanted) < len(wanted)

    def is_foreign(self, wanted: Collection[str]) -> bool:
        """Return whether it is another robot, and not only unfinished.

        Most of its links are not wanted.
        """
        if not self.is_another(wanted):
            return False
        return 2 * sum(link.name not in wanted for link in self.links) > len(self.links)

    def check_complete(self) -> None:
        """Raise NotDecided if there may be more links and joints than are known."""
        if self.incomplete:
            raise NotDecided(self.incomplete)

    def _raise_missing(self, kind: str, name: str, existing: Iterable[Link | Joint]) -> NoReturn:
        self.check_complete()
        known = tuple(element.known.name for element in existing)
        guess = (
            similar_there(name, known)
            or f"; the file has: {', '.join(map(quoted, known[:20])) or 'none'}"
        )
        raise MissingElement(
            kind, name, known, message=f"there is no {kind} {quoted(name)}", detail=guess
        )
