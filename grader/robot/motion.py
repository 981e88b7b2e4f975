"""The motion of one joint: the transform from its origin to its child at a position."""

from collections.abc import Sequence
from math import atan2, isfinite

from grader.robot.joints import MOVING_TYPES
from grader.robot.model import Joint, Origin
from grader.robot.transforms import IDENTITY, Transform, Vector, cross, dot, rotation_about, rotation_from_rpy, unit
from grader.text import counted, quoted

Position = float | Sequence[float]

# The number of coordinates of a joint's position; the other types do not move.
DEGREES_OF_FREEDOM = {"continuous": 1, "revolute": 1, "prismatic": 1, "planar": 3, "floating": 6}


def placed_by(T_frame_parent: Transform, origin: Origin) -> Transform:
    """Return T_frame_child: the frame that an origin places in its parent."""
    if origin.rpy == (0.0, 0.0, 0.0):
        return T_frame_parent.shifted(origin.xyz)
    return T_frame_parent @ Transform(rotation_from_rpy(origin.rpy), origin.xyz)


def after_joint(T_root_parent: Transform, joint: Joint, position: Position) -> Transform | None:
    """Return T_root_child, or None if it is undefined."""
    motion = motion_of(joint, position)
    if joint.origin is None or motion is None:
        return None
    T_root_joint = placed_by(T_root_parent, joint.origin)
    return T_root_joint if motion is IDENTITY else T_root_joint @ motion


def motion_of(joint: Joint, position: Position) -> Transform | None:
    """Return T_origin_child; None if it is undefined, as it is for every position about a zero axis (KDL)."""
    if joint.type not in MOVING_TYPES:
        return IDENTITY
    if isinstance(position, int | float) and not isfinite(position):
        return None  # a chain of mimic joints can overflow
    if joint.type == "floating":
        if isinstance(position, int | float):
            return IDENTITY
        x, y, z, roll, pitch, yaw = position
        return Transform(rotation_from_rpy((roll, pitch, yaw)), (x, y, z))
    direction = unit(joint.axis) if joint.axis is not None else None
    if direction is None:
        # KDL divides by the axis' length before it uses the position. An unreadable axis matters only if the joint moves.
        return IDENTITY if joint.axis is None and not position else None
    if joint.type == "planar":
        return _planar(direction, position)
    if not position:
        return IDENTITY
    assert isinstance(position, int | float)  # check_position has made sure
    if joint.type == "prismatic":
        x, y, z = direction
        return Transform(translation=(x * position, y * position, z * position))
    return Transform(rotation_about(direction, position))


def _planar(normal: Vector, position: Position) -> Transform:
    """Return a motion in the plane across `normal`, then about it; x and y are the frame's if the normal is its z axis."""
    if isinstance(position, int | float):
        return IDENTITY
    x, y, angle = position
    around = cross((0.0, 0.0, 1.0), normal)
    turn = unit(around)
    if turn is None:
        slide: Vector = (x, y, 0.0) if normal[2] > 0 else (x, -y, 0.0)
    else:
        tilt = rotation_about(turn, atan2(dot(turn, around), normal[2]))
        slide = Transform(tilt).rotate((x, y, 0.0))
    return Transform(rotation_about(normal, angle), slide)


def check_position(joint: Joint, position: Position) -> None:
    """Raise ValueError for a position that a joint of this type cannot have."""
    wanted = DEGREES_OF_FREEDOM.get(joint.type, 0)
    values = (position,) if isinstance(position, int | float) else position
    if wanted == 0:
        raise ValueError(f"joint {quoted(joint.name)} is {joint.type or 'without type'}: it cannot move")
    if not all(map(isfinite, values)):
        raise ValueError(f"joint {quoted(joint.name)} cannot be at {position}")
    if len(values) != wanted:
        takes = f"its position takes {counted(wanted, 'number')}, not {len(values)}"
        raise ValueError(f"joint {quoted(joint.name)} is {joint.type}: {takes}")
