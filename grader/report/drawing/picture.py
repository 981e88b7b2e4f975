"""The content of a picture of a robot.

It has its shapes in their colours, frames, and driving directions of wheels; of a graded robot also
what `graded_picture.py` adds to it.
"""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from math import isfinite
from typing import TYPE_CHECKING, Any, NamedTuple

from grader.base.errors import MissingElement, NotDecided
from grader.base.grouping import Strings
from grader.base.text import counted, enumerated, quoted, quoted_end
from grader.base.transforms import Z_AXIS, Transform, Vector
from grader.ros.api import (
    Box,
    Capsule,
    Configuration,
    Cylinder,
    Link,
    Mesh,
    Shape,
    Sphere,
    UnknownShape,
    Visual,
    find_travel,
    turning_joint,
)

if TYPE_CHECKING:
    from grader.ros.api import MeshLoader

_Rgba = tuple[float, float, float, float]

_MAX_BODIES = 500  # in software, a browser draws more only in seconds
_MAX_COORDINATE = 1e4  # metres
_MAX_OMITTED = 4  # links that are not shown
_MAX_REASONS = 50  # why links are not shown
_WITHOUT_MATERIAL = (1.0, 0.0, 0.0, 1.0)  # RViz shows such a shape in red
_OWN_COLOUR = (0.7, 0.7, 0.7, 1.0)  # for the colours in a mesh file, which are not read
_MESHES = "mesh files are not opened"
_UNKNOWN = "the size or place of a shape is zero, too large or not known"
_NOT_KNOWN = (MissingElement, NotDecided, UnknownShape)


class Body(NamedTuple):
    """A visible shape of a link: its pose in the frame of the scene in metres, and its colour.

    Sizes are not negative, and the channels of the colour are from 0 to 1. With a `mesh`, the shape
    is the box around it.
    """

    link: str
    shape: Shape
    T_frame_shape: Transform
    rgba: _Rgba
    mesh: Mesh | None = None


class Wheel(NamedTuple):
    """A wheel in the frame of a scene.

    It has its centre, and the unit direction in which it drives at a positive rotation.
    """

    centre: Vector
    travel: Vector


@dataclass(frozen=True, slots=True)
class Scene:
    """The content of a picture of a robot."""

    robot: Configuration
    frame: str  # the link in whose frame it is drawn; its z axis points up
    poses: Mapping[str, Transform]  # the T_frame_link of the links that have one
    bodies: tuple[Body, ...]  # the different shapes of these links
    wheels: tuple[Wheel, ...]
    missing: Strings  # sentences that say what is not shown, and why
    boxed: Strings = ()  # the links that have boxes in place of meshes

    @property
    def remarks(self) -> Strings:
        """Sentences that say what is not shown, or shown as a box."""
        if not self.boxed:
            return self.missing
        shown = enumerated([quoted(link) for link in self.boxed], _MAX_OMITTED)
        return (*self.missing, f"Shown as the boxes around them: the meshes of {shown}")

    def centre(self, link: str) -> Vector | None:
        """Return the centre of the first shape of a link, else the origin of its frame.

        It is None without a pose.
        """
        pose = next(
            (body.T_frame_shape for body in self.bodies if body.link == link), self.poses.get(link)
        )
        return pose.translation if pose else None

    @property
    def root(self) -> str:
        """The root of the tree that `frame` is in.

        It is `frame` itself if that is on or below a loop of joints.
        """
        with suppress(MissingElement):
            return self.robot.find_root(self.frame)
        return self.frame

    @property
    def ground(self) -> Transform | None:
        """The frame of the root, at whose z = 0 the robot stands; None if it has no pose here."""
        return self.poses.get(self.root)


def make_scene(
    robot: Configuration,
    frame: str,
    wheels: Collection[str] = (),
    meshes: "MeshLoader | None" = None,
) -> Scene:
    """Return the content of a picture of a robot, in the frame of a link.

    `wheels` are links that are meant to roll. Without `meshes`, no mesh is shown.
    """
    # The links that are not shown, or not wholly, by reason.
    omitted: dict[str, dict[str, None]] = {}
    poses = {}
    bodies: dict[Body, None] = {}  # each once
    for link in robot.robot.links:
        pose = _pose(robot, link.name, frame)
        if isinstance(pose, Transform):
            poses[link.name] = pose
        for body in _bodies(link, pose, meshes):
            if isinstance(body, Body):
                bodies[body] = None
            else:
                omitted.setdefault(body, {})[link.name] = None
    missing = _list_omitted(omitted)
    boxed = dict.fromkeys(body.link for body in bodies if body.mesh)
    if len(bodies) > _MAX_BODIES:
        missing.append(f"Not shown: {counted(len(bodies) - _MAX_BODIES, 'more shape')}")
    shown = tuple(bodies)[:_MAX_BODIES]
    scene = Scene(robot, frame, poses, shown, (), tuple(missing), tuple(boxed))
    return replace(scene, wheels=_turning_wheels(scene, wheels))


def _turning_wheels(scene: Scene, links: Iterable[str]) -> tuple[Wheel, ...]:
    """Return the wheels among the links that are meant to roll."""
    turning = (_wheel(scene, link) for link in links)
    return tuple(wheel for wheel in turning if wheel)


def _list_omitted(omitted: Mapping[str, Collection[str]]) -> list[str]:
    """Return sentences on the links that are not shown, by reason."""
    sentences = []
    for why, names in list(omitted.items())[:_MAX_REASONS]:
        shown = enumerated([quoted(name) for name in names], _MAX_OMITTED)
        sentences.append(f"Not shown: {shown}: {why}")
    rest = len(omitted) - _MAX_REASONS
    if rest > 0:
        sentences.append(f"Not shown: shapes for {counted(rest, 'other reason')}")
    return sentences


def _pose(robot: Configuration, link: str, frame: str) -> Transform | str:
    """Return the pose of a link, or why it has none that can be drawn."""
    try:
        pose = robot.pose(link, relative_to=frame)
    except _NOT_KNOWN as error:
        return str(error)
    return pose if _is_drawable(pose.translation) else "it is too far away"


def _bodies(link: Link, pose: Transform | str, meshes: "MeshLoader | None") -> Iterator[Body | str]:
    """Yield the bodies of a link, and why the others are not drawn."""
    if isinstance(pose, str):
        if link.visuals:
            yield pose
        return
    for visual in link.visuals:
        yield _body(link.name, visual, pose, meshes)
    if link.unresolved.keys() & {"visual", ""}:
        yield _UNKNOWN


def _body(link: str, visual: Visual, pose: Transform, meshes: "MeshLoader | None") -> Body | str:
    """Return the body of a visual; else why it cannot be drawn."""
    drawn: Shape
    mesh = None
    place = visual.origin.placed_in()
    rgba = visual.material.rgba if visual.material else _WITHOUT_MATERIAL
    match visual.geometry:
        case Mesh() as shown:
            if not meshes:
                return _MESHES
            box = _box_around(shown, meshes)
            if isinstance(box, str):
                return f"the mesh {quoted_end(shown.filename)} {box}"
            size, centre = box
            mesh = shown
            sizes = size
            drawn = Box(size)
            place = place @ Transform(translation=centre)
            if not visual.material and not shown.filename.lower().endswith(".stl"):
                rgba = _OWN_COLOUR
        case Box(size=(x, y, z)):
            sizes = (x, y, z)
            drawn = Box((abs(x), abs(y), abs(z)))
        case Cylinder(radius=radius, length=length):
            sizes = (radius, length, 0.0)
            drawn = Cylinder(abs(radius), abs(length))
        case Capsule(radius=radius, length=length):
            sizes = (radius, length, 0.0)
            drawn = Capsule(abs(radius), abs(length))
        case Sphere(radius=radius):
            sizes = (radius, 0.0, 0.0)
            drawn = Sphere(abs(radius))
    if visual.geometry.is_empty or not _is_drawable(sizes) or not _is_drawable(place.translation):
        return _UNKNOWN
    red, green, blue, alpha = map(_channel, rgba)
    return Body(link, drawn, pose @ place, (red, green, blue, alpha), mesh)


def _box_around(mesh: Mesh, meshes: "MeshLoader") -> tuple[Vector, Vector] | str:
    """Return the size and the centre of the box around a scaled mesh, in its frame (m).

    If there is none, return why.
    """
    loaded = meshes.load(mesh)
    if isinstance(loaded, str):
        return loaded
    sizes = []
    centres = []
    for low, high, factor in zip(*loaded.bounds, mesh.scale, strict=True):
        sizes.append(abs(factor) * (high - low))
        centres.append(factor * (low + high) / 2.0)
    return (sizes[0], sizes[1], sizes[2]), (centres[0], centres[1], centres[2])


def _channel(value: float) -> float:
    """Return a channel of a colour that can be drawn."""
    return min(1.0, max(0.0, value)) if isfinite(value) else 0.0


def _is_drawable(values: Vector) -> bool:
    """Return whether a size or place in metres is a number that can be drawn."""
    return all(isfinite(value) and abs(value) <= _MAX_COORDINATE for value in values)


def _wheel(scene: Scene, link: str) -> Wheel | None:
    """Return a link as a wheel.

    It is None if it has no place, no joint turns it, it does not roll, or no shape is known.
    """
    centre = scene.centre(link)
    with suppress(*_NOT_KNOWN):
        joint = turning_joint(scene.robot, link, scene.frame)
        travel, _ = find_travel(scene.robot, link, joint, scene.frame, Z_AXIS)
        if centre is not None and travel is not None:
            return Wheel(centre, travel)
        return None
    return None


class Callout(NamedTuple):
    """What is marked at a link of a graded robot: the criteria that failed on it."""

    number: int
    link: str  # empty for the whole robot
    # what marks it, in metres in the scene's frame; None if the link has no pose there
    point: Vector | None
    names: Strings  # the ids of the criteria
    cost: str  # what they are worth in all: 8 points


@dataclass(frozen=True, slots=True)
class Picture:
    """What a picture of a graded robot shows.

    Nothing of the reference is shown if the hint level does not allow it.
    """

    scene: Scene
    outlines: tuple[
        Body, ...
    ]  # bodies of the reference where shapes or their places failed, or the robot has none
    frames: tuple[
        Transform, ...
    ]  # poses of the reference's links whose frames failed, or that the robot has not
    callouts: tuple[Callout, ...]
    # The arguments of `plan_drive`: the wheels that drive it, and what a rubric says of them.
    driving: Mapping[str, Any] = field(default_factory=dict)


def plain_picture(
    robot: Configuration | None,
    frame: str | None,
    meshes: "MeshLoader | None" = None,
    wheels: Sequence[str] = (),
) -> Picture | None:
    """Return the picture of a robot that is not graded, in the frame of one of its links.

    It is None without either. `wheels` are the links that drive it, if they are known.
    """
    if robot and frame is not None:
        return Picture(make_scene(robot, frame, meshes=meshes), (), (), (), {"wheels": wheels})
    return None
