"""Checks of a robot as a whole: how it stands on level ground, and where its wheels drive it."""

from collections.abc import Iterable, Iterator, Sequence

from grader.base.errors import NotDecided, RubricError
from grader.base.quantities import SLACK, in_degrees, in_millimetres
from grader.base.text import in_quotes
from grader.base.toml_types import Direction, NonNegative
from grader.lab.checks.check import About
from grader.lab.checks.outcome import Outcome, difference, judged
from grader.ros.urdf.driving import DRIVES_AHEAD, Drivetrain, RobotFault
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.standing_robot import StandingRobot
from grader.ros.urdf.visuals import origin_place

ABOUT = {
    "stands_level": About(picture="outline"),
    "drives_straight": About(picture="wheel"),
    "turns_in_place": About(picture="wheel"),
    "does_not_tip": About(picture="outline"),
}

_LEVEL = 1e-4  # metres by which a link that is level with others may be off
_MOST = 100.0  # m/s^2; nothing is said of more


def stands_level(
    robot: Configuration,
    *,
    on: list[str],
    base: str = "",
    tilt: NonNegative = 1.0,
    tolerance: NonNegative = 0.002,
) -> Outcome:
    """Set down upright on level ground, the robot rests on these links and on no other, and its
    base is level.

    It comes to rest where its centre of mass is at a local minimum of height; a robot that balances
    falls. The shapes of a link are its collision shapes, else its visuals, and a mesh needs manual
    grading. If any link has a mass, the others weigh nothing; otherwise all shapes have the same
    density. What is fixed to a link of `on` counts as that link.

    Args:
        on: The links on which the robot rests.
        base: The link that should be level; default: the nearest one above all of `on` that has a
            shape.
        tilt: How far the base may lean, in degrees.
        tolerance: How far above the ground a link of `on` may be, in metres.
    """
    standing = StandingRobot(robot, on, base)
    rest = standing.rest
    faults = []
    hanging = list(_find_hanging(standing, robot, on, tolerance))
    others = [link for link in standing.touching if link not in on]
    if rest.has_fallen:
        faults.append(RobotFault("it tips over"))
    elif not rest.tilt <= tilt + SLACK:
        leaning = f"it leans by {in_degrees(rest.tilt)}, on {in_quotes(standing.touching)}"
        odd, height = standing.find_odd_height()
        if not hanging and abs(height) > _LEVEL:
            side = difference(height, "above", "below")
            leaning += f": with its base level, {odd!r} is {side} the others"
        at = hanging[0].at if hanging else origin_place(robot, odd)
        faults += [RobotFault(leaning, rest.tilt, tilt, "deg", at), *hanging]
    else:
        faults += hanging
        if others:
            text = f"it rests on {in_quotes(others)}"
            faults.append(RobotFault(text, at=origin_place(robot, others[0])))
    message = f"it stands level on {in_quotes(on)}"
    return _judge(standing, faults, message, RobotFault("", rest.tilt, tilt, "deg"))


def _find_hanging(
    standing: StandingRobot, robot: Configuration, links: Iterable[str], tolerance: float
) -> Iterator[RobotFault]:
    """Yield a fault for each of these links that does not touch the ground."""
    for link in links:
        height = standing.height(link)
        if not height <= tolerance + SLACK:
            text = f"{link!r} is {in_millimetres(height)} above the ground"
            yield RobotFault(text, height, tolerance, "m", origin_place(robot, link))


def drives_straight(
    robot: Configuration,
    *,
    wheels: list[str],
    base: str = "",
    forward: Direction = (1.0, 0.0, 0.0),
    angle: NonNegative = 2.0,
    turn: NonNegative = 2.0,
    rollers: list[float] | None = None,
    level: bool = False,
) -> Outcome:
    """With its wheels turning at one positive rate, the base drives forward and straight, and no
    wheel slips.

    The robot is judged as it stands, as `stands_level` computes it. Each wheel must touch the
    ground, be round about its joint (2 mm in one turn), and slip by at most 5 % of the speed of its
    rim. Everything else slides. More than two wheels whose axes cross need `rollers`.

    Args:
        wheels: The links of the wheels that are driven.
        base: The link that drives; default: the nearest one above all wheels that has a shape.
        forward: The direction in which the base should drive, in its own frame.
        angle: How far the direction may be off, in degrees.
        turn: How far the base may turn, in degrees for each metre.
        rollers: The angles in degrees from the axis of each wheel to that of its roller that
            touches the ground: 90 for an omni wheel, 45 or -45 for a mecanum wheel.
        level: Whether the robot is judged with its base level and all wheels on the ground, however
            it stands.
    """
    standing = StandingRobot(robot, wheels, base, is_level=level)
    driven = _read_drivetrain(standing, rollers)
    faults = driven.find_idle_wheels()
    if not faults:
        _refuse_crossed(driven)
        faults = driven.find_faults_ahead(forward, angle, turn)
    return _judge(standing, faults, DRIVES_AHEAD, RobotFault("", 0.0, angle, "deg"), by_mass=False)


def turns_in_place(
    robot: Configuration,
    *,
    wheels: list[str],
    base: str = "",
    rollers: list[float] | None = None,
    level: bool = False,
) -> Outcome:
    """With the right wheels turning forward and the left ones backward, the base turns to the left,
    about the middle between the wheels.

    The robot is judged as it stands, as `stands_level` computes it. Forward is the x axis of the
    base; the middle may be off by 10 % of the distance between the wheels. Wheels may slip.

    Args:
        wheels: The links of the wheels that are driven.
        base: The link that turns; default: the nearest one above all wheels that has a shape.
        rollers: The angles in degrees from the axis of each wheel to that of its roller that
            touches the ground: 90 for an omni wheel, 45 or -45 for a mecanum wheel.
        level: Whether the robot is judged with its base level and all wheels on the ground, however
            it stands.
    """
    standing = StandingRobot(robot, wheels, base, is_level=level)
    driven = _read_drivetrain(standing, rollers)
    faults = driven.find_idle_wheels()
    if not faults:
        _refuse_crossed(driven)
        faults = driven.find_turning_faults()
    message = "with its wheels turning against each other, it turns to the left in place"
    return _judge(standing, faults, message, RobotFault(""), by_mass=False)


def does_not_tip(robot: Configuration, *, on: list[str], acceleration: NonNegative) -> Outcome:
    """Accelerated forward and backward, the robot does not tip over: its centre of mass stays over
    the area between its contacts.

    The robot is judged as it stands, as `stands_level` computes it. Forward is the x axis of the
    nearest link above all of `on` that has a shape.

    Args:
        on: The links on which the robot rests.
        acceleration: The acceleration in m/s^2 that it must bear.
    """
    standing = StandingRobot(robot, on)
    at = origin_place(robot, on[-1])
    if standing.rest.has_fallen:
        return _judge(standing, [RobotFault("it tips over", at=at)], "", RobotFault(""))
    limits = standing.tipping_accelerations()
    if limits is None:
        text = f"its centre of mass is not over the area between {in_quotes(on)}"
        return _judge(standing, [RobotFault(text, at=at)], "", RobotFault(""))
    faults = []
    ways = (("forward", "backward"), ("backward", "forward"))
    for limit, (way, falls) in zip(limits, ways, strict=True):
        if not acceleration <= limit + SLACK:
            text = (
                f"accelerated {way}, it tips {falls} from {limit:.3g} m/s^2 on; it should bear "
                f"{acceleration:g} m/s^2"
            )
            faults.append(RobotFault(text, limit, None, "m/s^2", at))
    least = min(*limits, _MOST)
    message = f"it does not tip over below {least:.3g} m/s^2"
    return _judge(standing, faults, message, RobotFault("", least, None, "m/s^2"))


def _read_drivetrain(standing: StandingRobot, rollers: list[float] | None) -> Drivetrain:
    """Return the wheels that drive a robot; raise RubricError for rollers of other wheels."""
    if rollers is not None and len(rollers) != len(standing.named):
        raise RubricError(("rollers must have an angle for each of the wheels",))
    return Drivetrain(standing, rollers)


def _refuse_crossed(driven: Drivetrain) -> None:
    """Raise NotDecided for wheels that may have rollers of which the rubric says nothing."""
    if driven.crossed_wheels is not None:
        first, second = driven.crossed_wheels
        raise NotDecided(
            f"the axes of {first!r} and {second!r} cross: the rubric does not say what rollers "
            "they have",
            "the axes of wheels cross",
        )


def _judge(
    standing: StandingRobot,
    faults: Sequence[RobotFault],
    message: str,
    fine: RobotFault,
    *,
    by_mass: bool = True,
) -> Outcome:
    """Return the outcome for faults; `fine` has the numbers of a robot without any.

    If it is decided by the centre of mass, the message says what is assumed of that.
    """
    shown = faults[0] if faults else fine
    text = "; ".join(fault.text for fault in faults) or message
    if by_mass and not standing.body.is_weighed:
        text += " (no link has a mass, so all shapes have the same density)"
    expected = None if shown.measured is None or shown.tolerance is None else 0.0
    return judged(
        not faults, text, shown.measured, expected, shown.tolerance, shown.unit, at=shown.at
    )
