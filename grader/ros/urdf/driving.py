"""How a robot stands on level ground and where its wheels drive it, in words.

They say what a person would see, and which wheel is the cause.
"""

from collections.abc import Sequence
from contextlib import suppress
from math import degrees

from grader.base.errors import MissingElement, NotDecided
from grader.base.grouping import Strings
from grader.base.quantities import SLACK, in_degrees, in_millimetres
from grader.base.records import Named
from grader.base.source import LazyLocation, place
from grader.base.text import enumerated, in_quotes
from grader.base.transforms import X_AXIS, Z_AXIS, Vector, degrees_between
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.shapes import UnknownShape
from grader.ros.urdf.standing_robot import StandingRobot
from grader.ros.urdf.visuals import axis_place, origin_place

_HANGING = 0.002  # metres above the ground from which on a wheel has no grip
_ROUND = 0.002  # metres by which the lowest point of a wheel may rise and fall
_MAX_SLIP = 0.05  # of the speed of the rim
_SLOW = 0.05  # of the speed of the rims: a robot that is slower does not drive
_OFF_CENTRE = 0.1  # of the distance between the wheels: how far the middle of a turn may be off
_OTHER_SIZE = 0.01  # of the radius from which on a wheel is said to be of another size
_ANGLE = 1.0  # degrees from which on a wheel is said to point elsewhere
_BACKWARD = 135.0  # degrees off forward from which on a robot is said to drive backward
_MAX_SLOPE = 45.0  # degrees between the axis of a wheel and the level
_CROSSED = 30.0  # degrees between the axes of wheels that can only be omni wheels
_OFF = 2.0  # degrees, or degrees for each metre, from which on a robot is said to drive elsewhere
_LEANING = 1.0  # degrees from which on a robot is said to lean
DRIVES_AHEAD = "with its wheels turning forward, it drives straight ahead"
_NOT_KNOWN = (MissingElement, NotDecided, UnknownShape)


class RobotFault(Named):
    """What a person would see, what was measured of it, what is allowed, and where to look."""

    text: str
    measured: float | None = None
    tolerance: float | None = None
    unit: str | None = None
    at: LazyLocation | None = None


_Faults = list[RobotFault]


class DescribedDriving(Named):
    """How a robot stands on level ground and where its wheels drive it, in one line.

    What is wrong with either is beside it. `describe_driving` makes it for inspections.
    """

    text: str = ""  # empty where it cannot be determined
    rest_faults: tuple[RobotFault, ...] = ()  # it leans or tips over, or wheels are in the air
    course_faults: tuple[RobotFault, ...] = ()  # its wheels do not drive it straight ahead


def describe_driving(robot: Configuration, wheels: Sequence[str]) -> DescribedDriving:
    """Return how a robot stands, and where these links drive it."""
    course_faults = []
    try:
        standing = StandingRobot(robot, wheels)
        driven = Drivetrain(standing)
        idle = driven.find_idle_wheels()
        if not idle:
            if driven.crossed_wheels is not None:
                return DescribedDriving()
            course_faults = driven.find_faults_ahead(X_AXIS, _OFF, _OFF)
    except _NOT_KNOWN:
        return DescribedDriving()
    if standing.rest.has_fallen:
        return DescribedDriving("on level ground, it tips over", tuple(idle))
    message = DRIVES_AHEAD
    faults = idle or course_faults
    if faults:
        message = f"when its wheels turn forward: {'; '.join(fault.text for fault in faults)}"
    text = f"{_describe_rest(standing)}; {message}"
    return DescribedDriving(text, (*_find_leaning(standing), *idle), tuple(course_faults))


def _find_leaning(standing: StandingRobot) -> _Faults:
    """Return that a robot leans, on what is no wheel if there is such a link.

    A robot that rests on its wheels and its base may be one without a caster, or one that balances.
    """
    tilt = standing.rest.tilt
    if not tilt > _LEANING or {*standing.touching} == {*standing.named, standing.base}:
        return []
    text = f"it leans by {in_degrees(tilt)} on {in_quotes(standing.touching)}"
    others = [link for link in standing.touching if link not in standing.named]
    at = origin_place(standing.robot, next(iter(others), standing.base))
    return [RobotFault(text, tilt, _LEANING, "deg", at)]


class Drive(Named):
    """How a robot comes to rest on level ground, and where its wheels drive it then.

    `plan_drive` makes it for pictures. `text` says in one line what one sees. While the `joints`
    turn at 1 rad/s, `velocity` (m/s, in the frame of the base) is that of the centre of mass at
    first, and `turn` (rad/s) how fast it turns to the left. Without joints, the wheels do not drive
    the robot, or it cannot be determined where.
    """

    standing: StandingRobot
    text: str
    velocity: Vector = (0.0, 0.0, 0.0)
    turn: float = 0.0
    joints: Strings = ()


def plan_drive(
    robot: Configuration,
    wheels: Sequence[str] = (),
    base: str = "",
    forward: Vector = X_AXIS,
    rollers: Sequence[float] | None = None,
) -> Drive | None:
    """Return how a robot stands, and where these wheels drive it.

    Returns None if it cannot be determined how it stands, or it has no wheel.

    Without names of links that it has, its wheels are all links that a continuous joint turns about
    a level axis, and that are round about it.
    """
    named = [link for link in wheels if robot.robot.has_link(link)]
    if named != list(wheels) or not named:
        rollers = None
        named = named or _find_rolling_links(robot)
    if not named:
        return None
    try:
        standing = StandingRobot(robot, named, base if robot.robot.has_link(base) else "")
    except _NOT_KNOWN:
        return None
    if standing.rest.has_fallen:
        return Drive(standing, "on level ground, it tips over")
    return _plan_course(standing, forward, rollers)


def _plan_course(
    standing: StandingRobot, forward: Vector, rollers: Sequence[float] | None
) -> Drive:
    """Return how a robot stands that has not fallen, and where its wheels drive it."""
    text = _describe_rest(standing)
    try:
        driven = Drivetrain(standing, rollers)
    except _NOT_KNOWN:
        return Drive(standing, text)
    is_crossed = driven.crossed_wheels is not None
    idle = driven.find_idle_wheels() if not is_crossed else []
    if is_crossed or idle:
        return Drive(standing, "; ".join([text, *(fault.text for fault in idle)]))
    faults = [fault.text for fault in driven.find_course_faults(forward, _OFF, _OFF)]
    moves = "; ".join(faults) or "it drives straight ahead"
    text = f"{text}; when its wheels turn forward, {moves}"
    turning = driven.wheels
    course = standing.drive(turning, [1.0] * len(turning), forward)
    velocity = course.velocity_at(standing.rest.mass_centre)
    joints = tuple(wheel.joint.name for wheel in turning)
    return Drive(standing, text, velocity, course.turn, joints)


def _find_rolling_links(robot: Configuration) -> list[str]:
    """Return the links that a continuous joint turns about a level axis.

    They are round about it.
    """
    turning = []
    for link in robot.robot.links:
        with suppress(MissingElement, NotDecided):
            types = [joint.type for joint in robot.chain(link.name)]
            is_shaped = link.visuals or link.collisions
            if is_shaped and types.count("continuous") == 1 and types[-1] == "continuous":
                turning.append(link.name)
    try:
        wheels = StandingRobot(robot, turning).wheels() if turning else []
    except _NOT_KNOWN:
        return []
    rolling = []
    for wheel in wheels:
        off_level = abs(90.0 - degrees_between(wheel.axis, Z_AXIS))
        if off_level <= _MAX_SLOPE and wheel.measure_roundness(Z_AXIS) <= _ROUND:
            rolling.append(wheel.link)
    return rolling


def _describe_rest(standing: StandingRobot) -> str:
    """Return in one line how a robot stands."""
    tilt = standing.rest.tilt
    stands = "stands level"
    if tilt > _LEANING:
        stands = f"leans by {in_degrees(tilt)}"
    return f"on level ground, it {stands} on {in_quotes(standing.touching)}"


class _Culprit(Named):
    """A wheel that does not drive as the others: how it differs, and where to look."""

    link: str
    how: str
    at: LazyLocation | None


class Drivetrain:
    """The driven wheels of a robot that stands, and what is wrong with how they drive it.

    The wheels are the named links of `standing`. `rollers` has the angle in degrees from the axis
    of each to that of its roller that touches the ground, of omni and mecanum wheels. Raises
    MissingElement for a link that no joint turns.
    """

    def __init__(self, standing: StandingRobot, rollers: Sequence[float] | None = None) -> None:
        self._standing = standing
        self._has_rollers = rollers is not None
        self.wheels = standing.wheels(rollers)

    def find_idle_wheels(self) -> _Faults:
        """Return the faults of wheels that drive nothing: they are in the air, or lie flat."""
        standing = self._standing
        if standing.rest.has_fallen:
            return [RobotFault("it tips over")]
        faults = []
        for wheel in self.wheels:
            height = standing.height(wheel.link)
            off_level = abs(90.0 - degrees_between(wheel.axis, standing.rest.up))
            if height > _HANGING + SLACK:
                text = f"{wheel.link!r} is {in_millimetres(height)} above the ground"
                at = origin_place(standing.robot, wheel.link)
                faults.append(RobotFault(text, height, _HANGING, "m", at))
            elif off_level > _MAX_SLOPE:
                off = in_degrees(off_level)
                text = f"{wheel.link!r} does not roll: its axis is {off} off level"
                faults.append(
                    RobotFault(text, off_level, _MAX_SLOPE, "deg", axis_place(wheel.joint))
                )
        return faults

    def _find_uneven_wheels(self) -> _Faults:
        """Return the faults of wheels that are not round about their joints."""
        faults = []
        for wheel in self.wheels:
            uneven = wheel.measure_roundness(self._standing.rest.up)
            if uneven > _ROUND + SLACK:
                text = (
                    f"{wheel.link!r} is not round about its joint: its lowest point rises and "
                    f"falls by {in_millimetres(uneven)} as it turns"
                )
                faults.append(RobotFault(text, uneven, _ROUND, "m", axis_place(wheel.joint)))
        return faults

    @property
    def crossed_wheels(self) -> tuple[str, str] | None:
        """Two of more than two wheels whose axes cross, so that they may be omni wheels.

        These have no known rollers. It is None without any.
        """
        if self._has_rollers or len(self.wheels) < 3:
            return None
        first = self.wheels[0]
        for wheel in self.wheels[1:]:
            off = degrees_between(first.axis, wheel.axis)
            if min(off, 180.0 - off) > _CROSSED:
                return first.link, wheel.link
        return None

    def find_faults_ahead(self, forward: Vector, angle: float, turn: float) -> _Faults:
        """Return why the robot does not drive straight ahead while all wheels turn at one rate.

        Args:
            forward: The direction that is ahead, in the frame of the base.
            angle: How far the direction may be off, in degrees.
            turn: How far the base may turn, in degrees for each metre.
        """
        faults = self._find_uneven_wheels()
        faults += self._with_culprits(self.find_course_faults(forward, angle, turn), forward)
        return faults

    def find_course_faults(self, forward: Vector, angle: float, turn: float) -> _Faults:
        """Return what is wrong with the way of a robot whose wheels all turn at one rate."""
        course = self._standing.drive(self.wheels, [1.0] * len(self.wheels), forward)
        at = axis_place(self.wheels[0].joint)
        faults = []
        if course.speed > _SLOW * course.rim_speed:
            off = course.off
            turned = degrees(course.turn) / course.speed
            if abs(off) > _BACKWARD:
                faults.append(RobotFault("it drives backward", off, angle, "deg", at))
            elif not abs(off) <= angle + SLACK:
                text = f"it drives {in_degrees(abs(off))} to the {_side(off)} of straight ahead"
                faults.append(RobotFault(text, off, angle, "deg", at))
            if not abs(turned) <= turn + SLACK:
                radius = course.speed / abs(course.turn)
                text = f"it drives a circle of radius {radius:.2g} m to the {_side(turned)}"
                faults.append(RobotFault(text, turned, turn, "deg/m", at))
        else:
            text = "it does not drive"
            reach = max(map(abs, course.sides))
            if abs(course.turn) * reach > _SLOW * course.rim_speed:
                text = f"it turns on the spot to the {_side(course.turn)}"
            faults.append(RobotFault(text, course.speed, None, "m/s", at))
        return faults + self._find_slips(course.slips)

    def _find_slips(self, slips: Sequence[float]) -> _Faults:
        """Return that wheels slip, at the speeds of their contacts in m/s: one fault for all."""
        shares = {}  # of the speed of the rim, of the wheels that slip
        for wheel, slip in zip(self.wheels, slips, strict=True):
            if slip > (_MAX_SLIP + SLACK) * wheel.radius:
                shares[wheel.link] = slip / max(wheel.radius, slip)
        if not shares:
            return []
        share = 100.0 * max(shares.values())
        verb = "slips" if len(shares) == 1 else "slip"
        text = f"{in_quotes([*shares])} {verb} by {share:.3g} % of the speed of the rim"
        at = axis_place(self.wheels[0].joint)
        return [RobotFault(text, share, 100.0 * _MAX_SLIP, "%", at)]

    def find_turning_faults(self) -> _Faults:
        """Return what is wrong with a robot's turn while its wheels turn against each other."""
        sides = self._standing.drive(self.wheels, [0.0] * len(self.wheels), X_AXIS).sides
        rates = [-1.0 if side > 0.0 else 1.0 for side in sides]
        course = self._standing.drive(self.wheels, rates, X_AXIS)
        width = max(sides) - min(sides)
        rim_speed = course.rim_speed
        if not width > _OFF_CENTRE * rim_speed:
            return [RobotFault("its wheels are not on two sides, so it cannot turn")]
        at = axis_place(self.wheels[0].joint)
        faults = []
        if abs(course.turn) * width / 2.0 <= _SLOW * rim_speed:
            text = "it does not turn"
            if course.speed > _SLOW * rim_speed:
                text = "it drives and does not turn"
            faults.append(RobotFault(text, course.turn, None, "rad/s", at))
        elif course.turn < 0.0:
            text = "it turns to the right; it should turn to the left"
            faults.append(RobotFault(text, course.turn, None, "rad/s", at))
        elif course.speed / course.turn > _OFF_CENTRE * width + SLACK:
            away = course.speed / course.turn
            far = in_millimetres(away)
            text = f"it turns about a point {far} from the middle between its wheels"
            faults.append(RobotFault(text, away, _OFF_CENTRE * width, "m", at))
        return self._with_culprits(faults, X_AXIS)

    def _with_culprits(self, faults: _Faults, forward: Vector) -> _Faults:
        """Return faults of which the first says which wheels are the cause."""
        culprits = [] if self._has_rollers or not faults else self._find_culprits(forward)
        if not culprits:
            return faults
        causes = enumerated([f"{culprit.link!r} {culprit.how}" for culprit in culprits])
        first = faults[0]._replace(text=f"{faults[0].text}: {causes}", at=culprits[0].at)
        return [first, *faults[1:]]

    def _find_culprits(self, forward: Vector) -> list[_Culprit]:
        """Return the wheels that do not drive as the others.

        These are those that point elsewhere, or else those of another size.
        """
        rates = [1.0] * len(self.wheels)
        headings = self._standing.drive(self.wheels, rates, forward).headings
        if all(abs(heading) <= _ANGLE for heading in headings):
            return self._find_other_sizes()
        if max(headings) - min(headings) <= _ANGLE:  # all alike
            return []
        culprits = []
        for wheel, off in zip(self.wheels, headings, strict=True):
            at = axis_place(wheel.joint)
            if abs(off) > 90.0:
                culprits.append(_Culprit(wheel.link, "drives it backward", at))
            elif abs(off) > _ANGLE:
                how = f"points {in_degrees(abs(off))} to the {_side(off)}"
                culprits.append(_Culprit(wheel.link, how, at))
        return culprits

    def _find_other_sizes(self) -> list[_Culprit]:
        """Return the wheels whose radius is not the usual one."""
        radii = sorted(wheel.radius for wheel in self.wheels)
        usual = radii[len(radii) // 2]
        culprits = []
        for wheel in self.wheels:
            share = wheel.radius / usual - 1.0
            if abs(share) > _OTHER_SIZE:
                size = "larger" if share > 0.0 else "smaller"
                link = self._standing.robot.link(wheel.link)
                at = axis_place(wheel.joint)
                for element in link.collisions or link.visuals:
                    at = place(element.geometry.location)
                how = f"is {abs(share) * 100.0:.3g} % {size}"
                culprits.append(_Culprit(wheel.link, how, at))
        return culprits


def _side(value: float) -> str:
    return "left" if value > 0.0 else "right"
