"""Checks of the joint that moves a link: limits, axis, mimic, dynamics.

It is the last joint above the link that is not fixed.

The numbers of an element of a joint are compared with the expected ones together, in one outcome.
"""

from collections.abc import Collection, Mapping, Sequence
from math import degrees, hypot, isfinite
from typing import Any, NamedTuple

from grader.base.errors import MissingElement, RubricError
from grader.base.names import did_you_mean
from grader.base.quantities import SLACK, in_degrees, in_millimetres, number_text, point, within
from grader.base.source import LazyLocation, place
from grader.base.toml_types import Direction, NonNegative
from grader.base.transforms import FULL_TURN, Vector, cross, degrees_between, minus, unit
from grader.lab.checks.check import MIMIC_TURNED, About
from grader.lab.checks.outcome import Outcome, failed, judged
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Dynamics, Joint
from grader.ros.urdf.visuals import axis_place

_Ratios = dict[str, tuple[float, float]]  # multiplier and offset, by joint


def _breaks_without_direction(arguments: Mapping[str, Any]) -> Collection[str]:
    """Numbers for one direction of an axis, which a mimic joint may have the other way round."""
    return () if arguments.get("direction") is not None else (MIMIC_TURNED,)


ABOUT = {
    "joint_limits": About(("limit",), breaks_under=_breaks_without_direction),
    "joint_axis": About(
        ("axis",),
        breaks_under=lambda arguments: () if arguments.get("either_way") else (MIMIC_TURNED,),
    ),
    "mimics": About(("mimic",), breaks_under=_breaks_without_direction),
    "joint_dynamics": About(("dynamics",)),
}
_EXACT = 1e-6  # for numbers that a URDF states as they are expected
_RIGHT_ANGLE = 90.0  # degrees


def joint_limits(
    robot: Configuration,
    *,
    link: str,
    lower: float | None = None,
    upper: float | None = None,
    tolerance: NonNegative = 0.0,
    effort: float | None = None,
    velocity: float | None = None,
    relative_to: str | None = None,
    direction: Direction | None = None,
) -> Outcome:
    """The joint that moves a link has the given limits.

    A continuous, planar or floating joint has no range. Effort and velocity may be off by 1e-6. If
    the limits are the expected ones, but in metres instead of degrees or the other way round, the
    joint has the wrong type. With `direction`, limits of the opposite sign pass for the opposite
    axis, as a joint that mimics another one may have.

    Args:
        link: The link that the joint moves.
        lower: The lower limit, in degrees for a revolute joint, in metres for a prismatic joint; it
            and `upper` may both be absent.
        upper: The upper limit, in degrees or metres.
        tolerance: How far each of the two limits may be off, in degrees or metres.
        effort: The maximum effort, in N m for a revolute joint, in N for a prismatic joint.
        velocity: The maximum velocity, in rad/s or m/s.
        relative_to: The link in whose frame the direction is given; default: the joint's parent.
        direction: The direction of the axis for which the limits are given.
    """
    joint = robot.moving_joint(link)
    limit = joint.limit
    effort_and_velocity = []
    if limit:
        others = {"effort": (limit.effort, effort), "velocity": (limit.velocity, velocity)}
        effort_and_velocity = list(_expected_numbers(others, _EXACT))
    if lower is not None and upper is not None:
        if direction is not None and _is_reversed(robot, joint, relative_to, direction):
            lower, upper = -upper, -lower
        return _judge_range(joint, link, _WantedRange(lower, upper, tolerance), effort_and_velocity)
    if lower is not None or upper is not None or (effort, velocity) == (None, None):
        raise RubricError(("joint_limits needs lower and upper, or effort or velocity",))
    if not limit:
        message = f"the joint that moves {link!r} has no <limit>"
        return failed(message, joint.location, detail=_joint_detail(joint))
    message = f"the joint that moves {link!r} has a <limit>"
    return _compare_numbers(message, effort_and_velocity, joint, limit.location)


class _WantedRange(NamedTuple):
    """The limits that a joint should have, in degrees or metres, and how far each may be off."""

    lower: float
    upper: float
    tolerance: float


def _judge_range(
    joint: Joint, link: str, wanted: _WantedRange, more: "Sequence[_Number]"
) -> Outcome:
    """Return whether a joint has a range, and `more` of the numbers of its <limit>."""
    detail, (lower, upper, tolerance) = _joint_detail(joint), wanted
    if joint.type not in ("revolute", "prismatic"):
        message = (
            f"the joint that moves {link!r} is {joint.type}, so it has no limits; "
            f"they should be {_range_text(lower, upper)}"
        )
        return failed(message, place(joint.location, "type"), detail=detail)
    units, unit_of_json = ("degrees", "deg") if joint.type == "revolute" else ("m", "m")
    fault = f"it should be {_range_text(lower, upper)} {units}"
    limit = joint.limit
    if not limit:
        message = f"the joint that moves {link!r} has no limits; {fault}"
        return failed(message, joint.location, detail=detail)
    low = limit.lower
    high = limit.upper
    if joint.type == "revolute":
        low = degrees(low)
        high = degrees(high)
    numbers = [
        _Number("lower", low, lower, tolerance, fault),
        _Number("upper", high, upper, tolerance, fault),
    ]
    if numbers[0].is_wrong or numbers[1].is_wrong:
        failure = _wrong_type(joint, link, lower, upper, tolerance)
        if failure:
            return failure
    numbers += more
    message = f"the range of the joint that moves {link!r} is {_range_text(low, high)} {units}"
    return _compare_numbers(message, numbers, joint, limit.location, unit_of_json)


def joint_axis(
    robot: Configuration,
    *,
    link: str,
    relative_to: str,
    direction: Direction,
    tolerance: NonNegative,
    either_way: bool = False,
    through: Vector | None = None,
    distance: NonNegative = 0.002,
) -> Outcome:
    """The axis of the joint that moves a link has the given direction in another link's frame.

    The length of `<axis>` does not matter, nor where on the axis the frame of the joint is.

    Args:
        link: The link that the joint moves.
        relative_to: The link in whose frame the direction and the point are given.
        direction: The direction along which the axis should point.
        tolerance: How far the direction may be off, in degrees.
        either_way: Whether the opposite direction is correct, too.
        through: A point through which the axis should pass, in metres.
        distance: How far the axis may be from that point, in metres.
    """
    robot.between(relative_to, link)  # raises where no joints connect the two
    joint = robot.moving_joint(link)
    if joint.type == "floating":
        message = f"the joint that moves {link!r} is floating, so it has no axis"
        return failed(message, place(joint.location, "type"), detail=_joint_detail(joint))
    own_axis = robot.axis(joint)
    T_relative_joint = robot.pose(joint.child, relative_to=relative_to)
    actual = T_relative_joint.rotate(own_axis)
    expected = unit(direction) or direction
    off = degrees_between(actual, expected)
    off = min(off, 180.0 - off) if either_way else off
    axis = f"the axis of the joint that moves {link!r}"
    message = f"{axis} points along {point(actual)} in {relative_to!r}"
    if not off <= tolerance + SLACK:
        message += f"; it should point along {point(expected)} ({in_degrees(off)} off)"
        at = axis_place(joint)
        return judged(
            False, message, actual, expected, tolerance, "deg", at=at, detail=_joint_detail(joint)
        )
    if through is None:
        return judged(True, message, actual, expected, tolerance, "deg")
    away = hypot(*cross(minus(through, T_relative_joint.translation), actual))
    fine = away <= distance + SLACK
    message += f" and passes {in_millimetres(away)} from {point(through)} m"
    message += "" if fine else "; it should pass through that point"
    at = place(joint.origin.location if joint.origin else None, "xyz") or joint.location
    measured_distance = away if isfinite(away) else None
    return judged(
        fine,
        message,
        measured_distance,
        0.0,
        distance,
        "m",
        at=at,
        detail="" if fine else _joint_detail(joint),
    )


def mimics(
    robot: Configuration,
    *,
    link: str,
    leader: str,
    multiplier: float | None = None,
    offset: float | None = None,
    tolerance: NonNegative = _EXACT,
    relative_to: str | None = None,
    direction: Direction | None = None,
) -> Outcome:
    """The joint that moves a link mimics the joint that moves another link.

    It may do so through other mimic joints: then the multipliers and offsets are composed. With
    `direction`, the motion counts: the opposite axis with the opposite multiplier and offset
    passes.

    Args:
        link: The link whose joint follows.
        leader: The link whose joint is followed.
        multiplier: The ratio of the position of the following joint to that of the other.
        offset: The position of the following joint where the other is at 0, in radians or metres.
        tolerance: How far multiplier and offset may be off, in their units.
        relative_to: The link in whose frame the direction is given; default: the joint's parent.
        direction: The direction of the following joint's axis for which multiplier and offset are
            given.
    """
    joint = robot.moving_joint(link)
    leading = robot.moving_joint(leader)
    followed = _mimic_chain(robot, joint, link)
    at = place(joint.mimic.location, "joint") if joint.mimic else joint.location
    if leading.name not in followed:
        message = f"the joint that moves {link!r} does not mimic the joint that moves {leader!r}"
        detail = f" (joint {joint.name!r})"
        if joint.mimic:
            detail = f" (joint {joint.name!r} mimics {joint.mimic.joint!r}, not {leading.name!r})"
        last = next(reversed(followed), joint.name)
        if not robot.robot.has_joint(last):
            message = f"the joint that moves {link!r} mimics a joint that does not exist"
            detail += did_you_mean(last, (other.name for other in robot.robot.joints))
        return failed(message, at, detail=detail)
    ratio, shift = followed[leading.name]
    message = f"the joint that moves {link!r} mimics the joint that moves {leader!r}"
    if direction is not None and _is_reversed(robot, joint, relative_to, direction):
        multiplier = None if multiplier is None else -multiplier
        offset = None if offset is None else -offset
    numbers = _expected_numbers(
        {"multiplier": (ratio, multiplier), "offset": (shift, offset)}, tolerance
    )
    return _compare_numbers(message, numbers, joint, joint.mimic.location if joint.mimic else None)


def joint_dynamics(
    robot: Configuration,
    *,
    link: str,
    friction: float | None = None,
    damping: float | None = None,
    tolerance: NonNegative = _EXACT,
) -> Outcome:
    """The joint that moves a link has the given friction and damping.

    Omitted values are 0, as in ROS 2. With neither argument, the joint must have `<dynamics>`.

    Args:
        link: The link that the joint moves.
        friction: The static friction, in N m for a joint that turns, in N for one that slides.
        damping: The damping, in N m s/rad or N s/m.
        tolerance: How far both may be off, in their units.
    """
    joint = robot.moving_joint(link)
    given = joint.dynamics
    dynamics = given or Dynamics()
    numbers = _expected_numbers(
        {"friction": (dynamics.friction, friction), "damping": (dynamics.damping, damping)},
        tolerance,
    )
    message = f"the joint that moves {link!r} has {'<dynamics>' if given else 'no <dynamics>'}"
    if not given and not numbers:
        return failed(f"{message}; it should have one", joint.location, detail=_joint_detail(joint))
    return _compare_numbers(message, numbers, joint, given.location if given else joint.location)


def _is_reversed(
    robot: Configuration, joint: Joint, relative_to: str | None, direction: Vector
) -> bool:
    """Return whether the axis of a joint points rather against a direction than along it.

    Raises MissingElement where no joints connect the links, and for an axis of length zero.
    """
    frame = relative_to or joint.parent
    robot.between(frame, joint.child)
    axis = robot.pose(joint.child, relative_to=frame).rotate(robot.axis(joint))
    return degrees_between(axis, unit(direction) or direction) > _RIGHT_ANGLE


def _mimic_chain(robot: Configuration, joint: Joint, link: str) -> _Ratios:
    """Return the joints that a joint mimics, directly and through others.

    Each has the multiplier and offset to it.

    The last may not exist. Raises MissingElement for a loop.
    """
    ratios: _Ratios = {}
    first = joint
    ratio = 1.0
    shift = 0.0
    while True:
        if not joint.mimic:
            return ratios
        name = joint.mimic.joint
        ratio, shift = ratio * joint.mimic.multiplier, ratio * joint.mimic.offset + shift
        if name == first.name or name in ratios:
            message = f"the joint that moves {link!r} mimics itself, directly or through others"
            at = place(joint.mimic.location, "joint")
            raise MissingElement(
                "mimicked joint", link, message=message, detail=_joint_detail(first), location=at
            )
        ratios[name] = ratio, shift
        if not robot.robot.has_joint(name):
            return ratios
        joint = robot.joint(name)


def _range_text(lower: float, upper: float) -> str:
    return f"{number_text(lower, 5)} to {number_text(upper, 5)}"


def _wrong_type(
    joint: Joint, link: str, lower: float, upper: float, tolerance: float
) -> Outcome | None:
    """Return the failure of limits that are as expected in another unit.

    They are in metres instead of degrees, or the other way round.
    """
    limit = joint.limit
    assert limit
    # More than a full turn in radians is a range in degrees, whatever the type of the joint.
    if max(abs(limit.lower), abs(limit.upper)) > FULL_TURN:
        return None
    if joint.type == "revolute":
        other = "prismatic"
        ends = (limit.lower, limit.upper)
        units = "m"
    else:
        other = "revolute"
        ends = (degrees(limit.lower), degrees(limit.upper))
        units = "degrees"
    if not within(ends[0], lower, tolerance) or not within(ends[1], upper, tolerance):
        return None
    message = (
        f"the joint that moves {link!r} is {joint.type}; it should be {other}, with a range "
        f"of {_range_text(lower, upper)} {units}"
    )
    return failed(message, place(joint.location, "type"), detail=_joint_detail(joint))


class _Number(NamedTuple):
    """A number that is compared: its attribute, and what is said where it is wrong."""

    attribute: str
    actual: float
    expected: float
    tolerance: float
    fault: str

    @property
    def is_wrong(self) -> bool:
        """Whether it is outside of its tolerance, or NaN."""
        return not within(self.actual, self.expected, self.tolerance)


def _expected_numbers(
    values: Mapping[str, tuple[float, float | None]], tolerance: float
) -> list[_Number]:
    """Return the numbers that are compared, by attribute: those with an expected value."""
    return [
        _Number(
            name,
            actual,
            expected,
            tolerance,
            f"its {name} is {number_text(actual)}; it should be {number_text(expected)}",
        )
        for name, (actual, expected) in values.items()
        if expected is not None
    ]


def _compare_numbers(
    message: str,
    numbers: Sequence[_Number],
    joint: Joint,
    element: LazyLocation | None,
    of: str | None = None,
) -> Outcome:
    """Compare numbers of an element, which are in the unit `of` if they have one tolerance.

    NaN fails.
    """
    faults = {number.fault: number.attribute for number in reversed(numbers) if number.is_wrong}
    message = "; ".join((message, *reversed(faults)))
    values = [(number.actual, number.expected) for number in numbers]
    actual, expected = (
        zip(*values, strict=True) if values and isfinite(sum(map(sum, values))) else (None, None)
    )
    tolerances = {number.tolerance for number in numbers}
    tolerance = tolerances.pop() if len(tolerances) == 1 else None
    at = place(element, next(reversed(faults.values()), None))
    detail = _joint_detail(joint) if faults else ""
    return judged(
        not faults,
        message,
        actual,
        expected,
        tolerance,
        of if tolerance is not None else None,
        at=at,
        detail=detail,
    )


def _joint_detail(joint: Joint) -> str:
    """Return the end of a message that names a joint."""
    return f" (joint {joint.name!r})"
