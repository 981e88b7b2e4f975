"""The frames that static_transform_publisher adds to a robot's tree.

It is started as the launch files of a package start it.
"""

from collections.abc import Collection, Sequence
from dataclasses import replace
from math import hypot, isfinite

from grader.base.grouping import StringsByName
from grader.base.records import Named
from grader.base.source import LazyLocation, Source, SourceOf
from grader.base.transforms import Transform, Vector, rotation_from_quaternion
from grader.ros.launch.launch_model import Launch, StartedNode
from grader.ros.package.package import Package
from grader.ros.urdf.link_tree import parent_joints
from grader.ros.urdf.model import Joint, Link, Origin, Robot, UnresolvedPart
from grader.ros.urdf.numbers import finite_number

STATIC_PUBLISHER = ("tf2_ros", "static_transform_publisher")
_PLACE = ("--x", "--y", "--z")
_RPY = ("--roll", "--pitch", "--yaw")
_QUATERNION = ("--qx", "--qy", "--qz", "--qw")
_FRAMES = ("--frame-id", "--child-frame-id")
_BY_POSITION = {  # the words without options: with yaw, pitch and roll, or with a quaternion
    8: (*_PLACE, *reversed(_RPY), *_FRAMES),
    9: (*_PLACE, *_QUATERNION, *_FRAMES),
}
_NORM_TOLERANCE = 10e-3  # of a quaternion; tf2 ignores others


class _StaticFrame(Named):
    """A frame that a launch file places.

    It is `open`, for a reason, where it is not known whether and where.
    """

    parent: str
    child: str
    origin: Origin | None
    location: LazyLocation
    open: str = ""


def with_transforms(
    robot: Robot,
    package: Package,
    paths: Sequence[str],
    source_of: SourceOf,
) -> Robot:
    """Return a robot with the frames that launch files of a package publish.

    The frames are links at fixed joints.

    tf2 has one parent of each frame, the one that it was told of last: a frame with two is open.
    What places the root of the robot in the world is not among them.

    Args:
        robot: The robot in the URDF.
        package: The package.
        paths: The launch files, by their paths in the package.
        source_of: The text of a file, whose path is that of a place; None if it cannot be read.
    """
    roots = {link.known.name for link in robot.links} - parent_joints(robot).keys()
    for path in paths:
        name = package.launch_file(path)
        if name is not None:
            robot = _with_frames(robot, package.launch(name), name, roots, source_of)
    if any(started.list_frames("") != ("",) for started in package.launches):
        robot = replace(
            robot,
            incomplete=robot.incomplete or "robot_state_publisher gives the frames other names",
        )
    return robot


def _with_frames(
    robot: Robot,
    launch: Launch,
    name: str,
    roots: Collection[str],
    source_of: SourceOf,
) -> Robot:
    """Return a robot with the frames that one launch file publishes."""
    if launch.syntax or launch.faults:
        return robot  # nothing is published
    publishers = [node for node in launch.nodes if node.program == STATIC_PUBLISHER]
    frames = [_read_frame(node, source_of) for node in publishers if node.when is not False]
    for frame in frames:
        if frame and frame.child not in roots:
            robot = _add_frame(robot, frame)
    reason = _why_frames_unknown(launch, frames)
    if not reason:
        return robot
    incomplete = f"cannot determine statically which frames {name} publishes: {reason}"
    return replace(robot, incomplete=incomplete)


def _why_frames_unknown(launch: Launch, frames: Sequence[_StaticFrame | None]) -> str:
    """Return why a launch file may publish other frames than these; empty if it does not."""
    if launch.unread:
        return launch.unread
    if launch.unknown:
        return launch.unknown[0].message
    if None in frames:
        return "the name of a frame is not evaluated"
    return ""


def _add_frame(robot: Robot, frame: _StaticFrame) -> Robot:
    if not frame.child or frame.parent == frame.child:
        return robot  # the publisher ends with an error
    part = {"origin": UnresolvedPart(frame.open, frame.location)} if frame.open else {}
    joint_name = f"static transform of {frame.child}"
    joint = Joint(
        joint_name,
        "fixed",
        frame.parent,
        frame.child,
        frame.origin,
        location=frame.location,
        unresolved=part,
    )
    before = next(
        (robot_joint for robot_joint in robot.joints if robot_joint.known.child == frame.child),
        None,
    )
    if not before and robot.has_link(frame.child):
        return robot
    if not before:
        return replace(
            robot,
            links=(*robot.links, Link(frame.child, location=frame.location)),
            joints=(*robot.joints, joint),
        )
    if before == joint:
        return robot
    reason = (
        f"the frame {frame.child!r} is placed twice: in {before.known.parent!r} and in "
        f"{frame.parent!r}"
    )
    part = {
        "origin": UnresolvedPart(f"{reason}, and the one that tf2 gets last counts", frame.location)
    }
    both = before.known._replace(origin=None, unresolved={**before.known.unresolved, **part})
    return replace(
        robot,
        joints=tuple(
            both if robot_joint is before else robot_joint for robot_joint in robot.joints
        ),
    )


def _read_frame(node: StartedNode, source_of: SourceOf) -> _StaticFrame | None:
    """Return the frame that a static_transform_publisher publishes, its child empty for none.

    Returns None if it is unknown.
    """
    words = _select_words(node)
    parent, child = frames_named(node)
    if None in words and not child:
        return None
    at = node.location
    source = source_of(at.path) or Source(at.path, "")
    location = LazyLocation(Source(at.path, source.text, [source.start_offset(at)]), 0)
    if None in words or node.when is None:
        what = "whether it is published" if node.when is None else "its place"
        reason = f"{what} is known only at run time ({at.path}, line {at.line})"
        return _StaticFrame(parent, child, None, location, f"the frame {child!r}: {reason}")
    origin = _make_origin(words, location)
    if not parent or not origin:
        child = ""
    return _StaticFrame(parent, child, origin, location)


def _select_words(node: StartedNode) -> tuple[str | None, ...]:
    words = node.arguments if node.arguments is not None else (None,)
    if "--ros-args" in words:
        return words[: words.index("--ros-args")]
    return words


def frames_named(node: StartedNode) -> tuple[str, str]:
    """Return the parent and the child that a static_transform_publisher is given.

    They are empty where they are not known.
    """
    options = _read_options(_select_words(node))
    parent, child = ((options.get(option) or "").removeprefix("/") for option in _FRAMES)
    return parent, child


def static_pose(node: StartedNode) -> Transform | None:
    """Return T_parent_child that a static_transform_publisher is given.

    Returns None where it is not known or not valid.
    """
    words = _select_words(node)
    if None in words:
        return None
    at = node.location
    location = LazyLocation(Source(at.path, "", [0]), 0)
    origin = _make_origin(words, location)
    return origin.placed_in() if origin else None


def has_zero_rotation(node: StartedNode) -> bool:
    """Return whether a static_transform_publisher is given the quaternion 0 0 0 0."""
    options = _read_options(_select_words(node))
    values = [finite_number(options.get(name)) for name in _QUATERNION]
    return all(value == 0.0 for value in values)


def _read_options(words: Sequence[str | None]) -> dict[str, str | None]:
    """Return the values by their options, also if they are given by their positions."""
    if words and words[0] is not None and words[0].startswith("--"):
        return dict(zip(((word or "") for word in words[::2]), words[1::2], strict=False))
    return dict(zip(_BY_POSITION.get(len(words), ()), words, strict=False))


def _make_origin(words: Sequence[str | None], location: LazyLocation) -> Origin | None:
    """Return where known words place a frame.

    Returns None where the publisher ends with an error, or tf2 ignores the transform.
    """
    options = {name: text or "" for name, text in _read_options(words).items()}
    values = _read_values(options)
    if values is None:
        return None
    x, y, z = (values.get(name, 0.0) for name in _PLACE)
    roll, pitch, yaw = (values.get(name, 0.0) for name in _RPY)
    if values.keys().isdisjoint(_QUATERNION):
        return Origin((x, y, z), (roll, pitch, yaw), location)
    rpy = _convert_quaternion(*(values.get(name, float(name == "--qw")) for name in _QUATERNION))
    if rpy is not None:
        return Origin((x, y, z), rpy, location)
    return None


def _read_values(options: StringsByName) -> dict[str, float] | None:
    """Return the numbers of options; None where the publisher ends with an error."""
    try:
        values = {name: float(text) for name, text in options.items() if name not in _FRAMES}
    except ValueError:
        return None
    known = {*_PLACE, *_RPY, *_QUATERNION}
    is_mixed = values.keys() & {*_RPY} and values.keys() & {*_QUATERNION}
    if not values.keys() <= known or is_mixed or not all(map(isfinite, values.values())):
        return None
    return values


def _convert_quaternion(x: float, y: float, z: float, w: float) -> Vector | None:
    if abs(hypot(x, y, z, w) ** 2 - 1) > _NORM_TOLERANCE:
        return None
    return Transform(rotation_from_quaternion((x, y, z, w))).rpy
