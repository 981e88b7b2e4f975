"""The content of a picture of a robot: shapes in their colours, frames, and driving directions of wheels."""

from collections.abc import Collection, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from math import isfinite
from typing import NamedTuple

from grader.checks.motion import travel_of, turning_joint
from grader.errors import MissingElement, NotDecided
from grader.robot.kinematics import Configuration, placed_by
from grader.robot.model import Box, Cylinder, Link, Mesh, Sphere, Visual
from grader.robot.shapes import Shape, UnknownShape, is_empty
from grader.robot.transforms import Z_AXIS, Transform, Vector
from grader.text import counted, enumerated, quoted

Rgba = tuple[float, float, float, float]

_MAX_BODIES = 500  # in software, a browser draws more only in seconds
_MAX_COORDINATE = 1e4  # metres
_MAX_NAMED = 4
_WITHOUT_MATERIAL: Rgba = (1.0, 0.0, 0.0, 1.0)  # RViz shows such a shape in red
_MESHES, _UNKNOWN = "mesh files are not opened", "the size or place of a shape is zero, too large or not known"
_NOT_KNOWN = (MissingElement, NotDecided, UnknownShape)


class Body(NamedTuple):
    """A visible shape of a link: its pose in the frame of the scene in metres, and its colour.

    Sizes are not negative, and the channels of the colour are from 0 to 1.
    """

    link: str
    shape: Shape
    T_frame_shape: Transform
    rgba: Rgba


class Wheel(NamedTuple):
    """A wheel in the frame of a scene: its centre, and the unit direction in which it drives at a positive rotation."""

    centre: Vector
    travel: Vector


@dataclass(frozen=True, slots=True)
class Scene:
    """The content of a picture of a robot, in the frame of the link `frame`, whose z axis points up.

    `poses` are the T_frame_link of the links that have one, and `bodies` the different shapes of these links.
    `missing` are sentences that say what is not shown, and why.
    """

    robot: Configuration
    frame: str
    poses: Mapping[str, Transform]
    bodies: tuple[Body, ...]
    wheels: tuple[Wheel, ...]
    missing: tuple[str, ...]

    def centre(self, link: str) -> Vector | None:
        """Return the centre of the first shape of a link, else the origin of its frame; None without a pose."""
        pose = next((body.T_frame_shape for body in self.bodies if body.link == link), self.poses.get(link))
        return pose.translation if pose is not None else None

    @property
    def root(self) -> str:
        """The root of the tree that `frame` is in; `frame` itself if it is on or below a loop of joints."""
        with suppress(MissingElement):
            return self.robot.root_of(self.frame)
        return self.frame

    @property
    def ground(self) -> Transform | None:
        """The frame of the root, at whose z = 0 the robot stands; None if it has no pose here."""
        return self.poses.get(self.root)


def scene_of(robot: Configuration, frame: str, wheels: Collection[str] = ()) -> Scene:
    """Return the content of a picture of a robot, in the frame of a link; `wheels` are links that are meant to roll."""
    omitted: dict[str, dict[str, None]] = {}  # the links that are not shown, or not wholly, by reason
    poses: dict[str, Transform] = {}
    bodies: dict[Body, None] = {}  # each once
    for link in robot.robot.links:
        pose = _pose(robot, link.name, frame)
        if isinstance(pose, Transform):
            poses[link.name] = pose
        for found in _bodies(link, pose):
            if isinstance(found, Body):
                bodies[found] = None
            else:
                omitted.setdefault(found, {})[link.name] = None
    missing = [f"Not shown: {enumerated([*map(quoted, names)], _MAX_NAMED)}: {why}" for why, names in omitted.items()]
    if len(bodies) > _MAX_BODIES:
        missing.append(f"Not shown: {counted(len(bodies) - _MAX_BODIES, 'more shape')}")
    scene = Scene(robot, frame, poses, (*bodies,)[:_MAX_BODIES], (), (*missing,))
    return replace(scene, wheels=(*filter(None, (_wheel(scene, link) for link in wheels)),))


def _pose(robot: Configuration, link: str, frame: str) -> Transform | str:
    """Return the pose of a link, or why it has none that can be drawn."""
    try:
        pose = robot.pose(link, relative_to=frame)
    except _NOT_KNOWN as error:
        return str(error)
    return pose if _is_drawable(pose.translation) else "it is too far away"


def _bodies(link: Link, pose: Transform | str) -> Iterator[Body | str]:
    """Yield the bodies of a link, and why the others are not drawn."""
    if isinstance(pose, str):
        yield from [pose] if link.visuals else ()
        return
    yield from (_body(link.name, visual, pose) for visual in link.visuals)
    if link.unresolved.keys() & {"visual", ""}:
        yield _UNKNOWN


def _body(link: str, visual: Visual, pose: Transform) -> Body | str:
    drawn: Shape
    match visual.geometry:
        case Mesh():
            return _MESHES
        case Box(size=(x, y, z)):
            sizes, drawn = (x, y, z), Box((abs(x), abs(y), abs(z)))
        case Cylinder(radius=radius, length=length):
            sizes, drawn = (radius, length, 0.0), Cylinder(abs(radius), abs(length))
        case Sphere(radius=radius):
            sizes, drawn = (radius, 0.0, 0.0), Sphere(abs(radius))
    own = placed_by(Transform(), visual.origin)
    if is_empty(visual.geometry) or not _is_drawable(sizes) or not _is_drawable(own.translation):
        return _UNKNOWN
    rgba = visual.material.rgba if visual.material is not None else _WITHOUT_MATERIAL
    red, green, blue, alpha = (min(1.0, max(0.0, value)) if isfinite(value) else 0.0 for value in rgba)
    return Body(link, drawn, pose @ own, (red, green, blue, alpha))


def _is_drawable(values: Vector) -> bool:
    """Return whether a size or place in metres is a number that can be drawn."""
    return all(isfinite(value) and abs(value) <= _MAX_COORDINATE for value in values)


def _wheel(scene: Scene, link: str) -> Wheel | None:
    """Return a link as a wheel; None if it has no place, no joint turns it, it does not roll, or no shape is known."""
    centre = scene.centre(link)
    with suppress(*_NOT_KNOWN):
        joint = turning_joint(scene.robot, link, scene.frame)
        travel, _ = travel_of(scene.robot, link, joint, scene.frame, Z_AXIS)
        return Wheel(centre, travel) if centre is not None and travel is not None else None
    return None
