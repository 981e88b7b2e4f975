"""The reference solution that a rubric is made from, what is measured on it, and how its numbers are written."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import cos, degrees, isclose, isfinite, radians
from typing import Any

from grader.errors import MissingElement, NotDecided
from grader.robot.kinematics import Configuration
from grader.robot.model import Joint, Link
from grader.robot.reader import Reading
from grader.robot.transforms import Vector
from grader.submission.submission import Submission


class Solution:
    """A solution that ROS 2 loads: its submission, its URDF as it was read, and its robot with the joints at 0."""

    def __init__(self, submission: Submission, reading: Reading, robot: Configuration) -> None:
        self.submission, self.reading, self.robot = submission, reading, robot

    @cached_property
    def links(self) -> tuple[Link, ...]:
        """Its links, each after its parent, and before the next child of that."""
        children: dict[str, list[str]] = {}
        for joint in self.robot.robot.joints:
            children.setdefault(joint.parent, []).append(joint.child)
        waiting, found = [self.root], []
        while waiting:
            found.append(self.robot.link(waiting.pop()))
            waiting += reversed(children.get(found[-1].name, []))
        return tuple(found)

    @property
    def root(self) -> str:
        """The link that has no parent joint."""
        return self.robot.main_tree[0]

    @property
    def joints(self) -> Mapping[str, Joint]:
        """The parent joints, by the link below."""
        return self.robot.parent_joints

    @property
    def moving_joints(self) -> tuple[Joint, ...]:
        """The joints that are not fixed, in the order of the links that they move."""
        above = (self.joints.get(link.name) for link in self.links)
        return tuple(joint for joint in above if joint is not None and joint.type != "fixed")

    @cached_property
    def tips(self) -> tuple[str, ...]:
        """The last links of the chains that move."""
        inner = {joint.parent for joint in self.joints.values()}
        ends = (link.name for link in self.links if link.name not in inner)
        return tuple(name for name in ends if any(it.type != "fixed" for it in self.robot.chain(name) or ()))


_DIGITS = 6  # after the point, of a length in metres or a component of a direction
_EXACT_DIGITS = 12  # significant ones of a value that is compared exactly
_WHOLE = 0.1  # degrees: closer angles are meant as whole ones, such as 90 for 1.57 radians


@dataclass(frozen=True, slots=True)
class Fact:
    """A fact of the reference that one check can test: a criterion without its points.

    `subject` and `aspect` make its id, `about` is its heading. `otherwise` are the facts that count instead if
    the reference does not pass it.
    """

    subject: str
    aspect: str
    title: str
    check: str
    arguments: Mapping[str, Any] = field(default_factory=dict)
    about: str = ""
    of_package: bool = False
    otherwise: tuple["Fact", ...] = ()


@dataclass(frozen=True, slots=True)
class Omission:
    """Something of the reference that no criterion is about, and why."""

    what: str
    why: str


THE_FILE, THE_ROBOT, THE_PACKAGE = "The file", "The robot", "The package"  # headings

Facts = Iterator[Fact | Omission]
Measure = Callable[[Solution], Facts]


def of_links(rule: Callable[[Link], Iterable[Fact | Omission]]) -> Measure:
    """Return what a rule finds on each link."""

    def measure(solution: Solution) -> Facts:
        for link in solution.links:
            for found in rule(link):
                yield replace(found, about=link.name) if isinstance(found, Fact) else found

    return measure


def of_joints(name: str, rule: Callable[[Solution, Joint], Fact | None]) -> Measure:
    """Return what a rule finds on each joint, under the link below it; `name` says what it is about."""

    def measure(solution: Solution) -> Facts:
        for link in solution.links:
            joint = solution.joints.get(link.name)
            try:
                fact = rule(solution, joint) if joint is not None else None
            except (MissingElement, NotDecided) as error:  # an axis of length zero
                yield Omission(f"{link.name}: {name}", str(error))
                continue
            if fact is not None:
                yield replace(fact, about=link.name)

    return measure


def length(value: float) -> float:
    """Return a measured length without what rounding has added: 0.15 for 0.15000000000000002."""
    return round(value, _DIGITS) + 0.0


def lengths(vector: Vector) -> list[float]:
    """Return the components of a measured vector, each without rounding errors."""
    return [length(value) for value in vector]


def direction(vector: Vector) -> list[float]:
    """Return a unit vector without rounding errors: the axis of the frame that is close to it, if any (rpy 1.57)."""
    cosine = cos(radians(_WHOLE))
    return [float(round(value)) + 0.0 if max(map(abs, vector)) >= cosine else length(value) for value in vector]


def exact(value: float) -> float:
    """Return a value that is compared exactly, without the last digits of a binary number."""
    return float(f"{value:.{_EXACT_DIGITS}g}") + 0.0


def whole_degrees(angle: float) -> float:
    """Return an angle (radians) in degrees: a whole number where it is close to one, as 90 for 1.57."""
    value = degrees(angle)
    nearest = float(round(value)) if isfinite(value) else value
    return nearest + 0.0 if abs(value - nearest) <= _WHOLE else round(value, 2)


def whole_angle(angle: float) -> float:
    """Return an angle in radians that is a whole number of degrees where it is close to one: 1.5708 for 1.57."""
    return round(radians(whole_degrees(angle)), 4) + 0.0


def in_title(values: Iterable[float]) -> str:
    """Return numbers for a title: 0.15 0 0.225."""
    return " ".join(f"{value + 0.0:.6g}" for value in values)


def is_same_number(one: float, other: float) -> bool:
    """Return whether two numbers are equal up to rounding."""
    return isclose(one, other, rel_tol=1e-6, abs_tol=1e-9)
