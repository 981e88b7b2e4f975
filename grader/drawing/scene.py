"""The content of a picture of a robot: shapes in their colours, frames, and driving directions of wheels."""

from collections.abc import Collection, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from math import inf, isfinite
from typing import NamedTuple

from grader.checks.motion import travel_of, turning_joint
from grader.checks.visuals import main_visual
from grader.errors import MissingElement, NotDecided
from grader.robot.frames import placed_by
from grader.robot.kinematics import Configuration
from grader.robot.model import Box, Cylinder, Mesh, Sphere, Visual
from grader.robot.shapes import Shape, UnknownShape, extent, is_empty
from grader.robot.transforms import Z_AXIS, Transform, Vector
from grader.text import counted, enumerated, quoted

Rgba = tuple[float, float, float, float]

_MAX_BODIES = 500  # in software, a browser draws more only in seconds
_MAX_COORDINATE = 1e4  # metres
_MAX_NAMED = 4
_WITHOUT_MATERIAL: Rgba = (1.0, 0.0, 0.0, 1.0)  # RViz shows such a shape in red
_LEVEL = 0.005  # metres: shapes whose bottoms differ by less stand on the same ground
_MESHES, _UNKNOWN = "mesh files are not opened", "the size or place of a shape is zero, too large or not known"
_NOT_KNOWN = (MissingElement, NotDecided, UnknownShape)


class Body(NamedTuple):
    """A visible shape of a link: its pose in the link's frame in metres, and its colour.

    Sizes are not negative, and the channels of the colour are from 0 to 1.
    """

    link: str
    shape: Shape
    T_link_shape: Transform
    rgba: Rgba


class Wheel(NamedTuple):
    """A wheel in the frame of a scene: its centre, and the unit direction in which it drives at a positive rotation.

    `travel` is None if it does not roll; `is_free` is whether neither limits nor another joint determine how far it
    turns.
    """

    link: str
    joint: str
    centre: Vector
    travel: Vector | None
    is_free: bool


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

    def pose(self, body: Body) -> Transform:
        """Return T_frame_shape of one of the bodies."""
        return self.poses[body.link] @ body.T_link_shape

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
    """Return the content of a picture of a robot, in the frame of one of its links.

    `wheels` are links that are meant to roll; other links count as wheels if they roll and stand on the ground.
    """
    omitted: dict[str, dict[str, None]] = {}  # the links that are not shown, or not wholly, by reason
    poses: dict[str, Transform] = {}
    bodies: dict[Body, None] = {}  # each once
    for link in robot.robot.links:
        pose = _pose(robot, link.name, frame)
        if isinstance(pose, Transform):
            poses[link.name] = pose
            found = [_body(link.name, visual) for visual in link.visuals]
            found += [_UNKNOWN] if link.unresolved.keys() & {"visual", ""} else []
        else:
            found = [pose] if link.visuals else []
        bodies |= {body: None for body in found if isinstance(body, Body)}
        for reason in (body for body in found if isinstance(body, str)):
            omitted.setdefault(reason, {})[link.name] = None
    scene = Scene(robot, frame, poses, (*bodies,)[:_MAX_BODIES], (), ())
    missing = [f"Not shown: {enumerated([*map(quoted, names)], _MAX_NAMED)}: {why}" for why, names in omitted.items()]
    if len(bodies) > _MAX_BODIES:
        missing.append(f"Not shown: {counted(len(bodies) - _MAX_BODIES, 'more shape')}")
    return replace(scene, wheels=(*_wheels(scene, wheels),), missing=tuple(missing))


def _pose(robot: Configuration, link: str, frame: str) -> Transform | str:
    """Return the pose of a link, or why it has none that can be drawn."""
    try:
        pose = robot.pose(link, relative_to=frame)
    except _NOT_KNOWN as error:
        return str(error)
    return pose if is_drawable(pose.translation) else "it is too far away"


def _body(link: str, visual: Visual) -> Body | str:
    """Return the body of a visual, or why it is not drawn."""
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
    pose = placed_by(Transform(), visual.origin)
    if is_empty(visual.geometry) or not is_drawable(sizes) or not is_drawable(pose.translation):
        return _UNKNOWN
    return Body(link, drawn, pose, _clamp(visual.material.rgba) if visual.material is not None else _WITHOUT_MATERIAL)


def _clamp(rgba: Rgba) -> Rgba:
    """Return a colour with channels from 0 to 1; one that is no finite number is 0."""
    red, green, blue, alpha = (min(max(value, 0.0), 1.0) if isfinite(value) else 0.0 for value in rgba)
    return red, green, blue, alpha


def is_drawable(values: Vector) -> bool:
    """Return whether a size or place in metres is a number that can be drawn."""
    return all(isfinite(value) and abs(value) <= _MAX_COORDINATE for value in values)


def _wheels(scene: Scene, meant: Collection[str]) -> Iterator[Wheel]:
    """Yield the links that are meant to roll, and those that roll with a round shape on the ground."""
    robot = scene.robot
    bottoms: dict[str, float] = {}
    for body in scene.bodies:
        bottom, _ = extent(body.shape, scene.pose(body), Z_AXIS)
        bottoms[body.link] = min(bottom, bottoms.get(body.link, inf))
    ground = min(bottoms.values(), default=0.0) + _LEVEL
    for joint in robot.parent_joints.values():
        link = joint.child
        if link not in meant and joint.type == "continuous" and bottoms.get(link, inf) <= ground:
            found = [wheel for wheel in _wheel(scene, link) if wheel.travel is not None]
            yield from found if found and isinstance(main_visual(robot, link).geometry, Cylinder | Sphere) else ()
    for link in meant:
        yield from _wheel(scene, link)


def _wheel(scene: Scene, link: str) -> Iterator[Wheel]:
    """Yield a link as a wheel, if a joint turns it and its shape and pose are known."""
    robot, frame = scene.robot, scene.frame
    try:
        joint = turning_joint(robot, link, frame)
        if link not in scene.poses:
            return
        centre = placed_by(scene.poses[link], main_visual(robot, link).origin).translation
        travel, _ = travel_of(robot, link, joint, frame, Z_AXIS)
    except _NOT_KNOWN:
        return
    if is_drawable(centre):
        is_free = joint.type == "continuous" and joint.mimic is None
        yield Wheel(link, joint.name, centre, travel, is_free)
