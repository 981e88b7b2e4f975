"""Where the turning wheels of a robot drive it, from the points in which they touch the ground.

A wheel that rolls without slip holds its contact point still on the ground. Of all motions of the
base, that one is taken under which the contacts slip least; casters and fixed supports slide.
Lengths are metres, in the frame of the base; wheels turn at 1 rad/s.
"""

from collections.abc import Iterable, Sequence
from math import atan2, degrees, hypot, pi, radians

from grader.base.records import Named
from grader.base.transforms import (
    Transform,
    Vector,
    add_up,
    cross,
    dot,
    minus,
    rotation_about,
    unit,
    weighted_mean,
)
from grader.ros.urdf.model import Joint
from grader.ros.urdf.resting import level_directions, moved
from grader.ros.urdf.shapes import PlacedShape

_TURNS = 24  # positions of a wheel in one turn at which its lowest point is measured
_ANY = 1e-9  # a determinant that is smaller is 0


class DrivenWheel(Named):
    """A wheel in the frame of the base.

    It has its joint's axis, a point on it, its shapes, and where it touches the ground.

    `roller` is the angle in degrees from its axis to those of its rollers, of a mecanum or omni
    wheel; None for any other wheel.
    """

    link: str
    joint: Joint
    axis: Vector
    middle: Vector
    shapes: tuple[PlacedShape, ...]
    contact: Vector
    roller: float | None = None

    @property
    def rim_motion(self) -> Vector:
        """The velocity of the contact point relative to the base, at 1 rad/s."""
        return cross(self.axis, minus(self.contact, self.middle))

    @property
    def radius(self) -> float:
        """The distance of the contact from the axis."""
        return hypot(*self.rim_motion)

    def heading(self, up: Vector) -> float:
        """Return the angle in degrees from the base's x axis to where the wheel alone rolls.

        The angle is to the left, on the ground.
        """
        forward, left = level_directions(up)
        return degrees(atan2(-dot(self.rim_motion, left), -dot(self.rim_motion, forward)))

    def measure_roundness(self, up: Vector) -> float:
        """Return by how much the lowest point of the wheel rises and falls in one turn."""
        heights = []
        for number in range(_TURNS):
            # The wheel stays, and the ground turns about it.
            turn = Transform(rotation_about(self.axis, -2.0 * pi * number / _TURNS))
            turned_up = turn.rotate(up)
            lowest = min(shape.extent(turned_up)[0] for shape in self.shapes)
            heights.append(lowest - dot(self.middle, turned_up))
        return max(heights) - min(heights)


class Course(Named):
    """How a base moves on the ground while its wheels turn, seen from above.

    `forward` and `left` are m/s of the point in the middle between the contacts along the x axis of
    the base and to its left, `turn` is rad/s to the left. `slips` has m/s of the contact of each
    wheel, `goal` the direction in which it should drive, in degrees to the left of the x axis.
    """

    up: Vector
    wheels: tuple[DrivenWheel, ...]
    goal: float
    forward: float
    left: float
    turn: float
    slips: tuple[float, ...]

    @classmethod
    def of(
        cls, up: Vector, wheels: Sequence[DrivenWheel], rates: Sequence[float], goal: Vector
    ) -> "Course":
        """Return the motion under which the wheels slip least.

        This solves the constraints of rolling (Siegwart, Nourbakhsh, Autonomous Mobile Robots,
        2004, section 3.2) by least squares: two of each wheel, one of a wheel with rollers.
        """
        x, y = level_directions(up)
        middle = mean(wheel.contact for wheel in wheels)
        rows = []
        wheel_of_row = []
        for number, wheel in enumerate(wheels):
            lever = cross(up, minus(wheel.contact, middle))
            for held in _held_directions(wheel, up):
                row = (dot(x, held), dot(y, held), dot(lever, held))
                rows.append((row, -rates[number] * dot(wheel.rim_motion, held)))
                wheel_of_row.append(number)
        motion = _least_squares(rows)
        slips = [0.0] * len(wheels)
        for number, (row, right) in zip(wheel_of_row, rows, strict=True):
            slips[number] = hypot(slips[number], dot(row, motion) - right)
        angle = degrees(atan2(dot(goal, y), dot(goal, x)))
        return cls(up, tuple(wheels), angle, *motion, tuple(slips))

    def velocity_at(self, point: Vector) -> Vector:
        """Return the velocity of a point of the base, in m/s."""
        forward, left = level_directions(self.up)
        middle = mean(wheel.contact for wheel in self.wheels)
        swept = cross(self.up, minus(point, middle))
        return moved(
            (0.0, 0.0, 0.0), [(forward, self.forward), (left, self.left), (swept, self.turn)]
        )

    @property
    def speed(self) -> float:
        """The speed of the middle between the contacts, m/s."""
        return hypot(self.forward, self.left)

    @property
    def rim_speed(self) -> float:
        """The mean radius of the wheels, which is the speed of their rims at 1 rad/s."""
        return add_up(wheel.radius for wheel in self.wheels) / len(self.wheels)

    @property
    def off(self) -> float:
        """The angle in degrees to the left from where it should drive to where it drives."""
        return self._from_goal(degrees(atan2(self.left, self.forward)))

    @property
    def headings(self) -> list[float]:
        """The angles in degrees from where it should drive to where each wheel alone rolls.

        The angles are to the left.
        """
        return [self._from_goal(wheel.heading(self.up)) for wheel in self.wheels]

    def _from_goal(self, direction: float) -> float:
        return (direction - self.goal + 180.0) % 360.0 - 180.0

    @property
    def sides(self) -> list[float]:
        """How far to the left of the middle each wheel touches the ground, in metres."""
        _, left = level_directions(self.up)
        middle = mean(wheel.contact for wheel in self.wheels)
        return [dot(minus(wheel.contact, middle), left) for wheel in self.wheels]


def mean(points: Iterable[Vector]) -> Vector:
    """Return the mean of points."""
    return weighted_mean((1.0, point) for point in points)


def _held_directions(wheel: DrivenWheel, up: Vector) -> list[Vector]:
    """Return the directions on the ground in which a wheel does not slide.

    These are all, or those along the axis of the roller that touches the ground.
    """
    forward, left = level_directions(up)
    if wheel.roller is None:
        return [forward, left]
    roller = Transform(rotation_about(up, radians(wheel.roller))).rotate(wheel.axis)
    along = unit((dot(roller, forward), dot(roller, left), 0.0))
    assert along is not None  # the axis of a wheel that rolls does not stand up
    return [moved((0.0, 0.0, 0.0), [(forward, along[0]), (left, along[1])])]


def _least_squares(rows: Sequence[tuple[Vector, float]]) -> Vector:
    """Return the three unknowns of linear equations that they leave least, by normal equations.

    What they do not decide is 0.
    """
    table = [[0.0] * 4 for _ in range(3)]
    for row, right in rows:
        for number in range(3):
            for other in range(3):
                table[number][other] += row[number] * row[other]
            table[number][3] += row[number] * right
    largest = max(table[number][number] for number in range(3))
    for number in range(3):
        table[number][number] += _ANY * largest
    for number in range(3):  # the matrix is positive definite: no pivoting
        for other in range(3):
            if other == number:
                continue
            factor = table[other][number] / table[number][number]
            for column in range(number, 4):
                table[other][column] -= factor * table[number][column]
    x, y, z = (table[number][3] / table[number][number] for number in range(3))
    return (x, y, z)
