"""A criterion: a row of a rubric."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from decimal import Decimal
from typing import Any, NamedTuple

from grader.checks.check import Check


class Carried(NamedTuple):
    """Error carried forward: points are kept where one of `causes` failed and the check, another fact, passes."""

    causes: tuple[str, ...]
    check: Check
    arguments: Mapping[str, Any]


class Adjustment(NamedTuple):
    """A correction of a criterion after grading.

    With the action "drop" it does not count. With "full", every graded submission gets its points.
    """

    action: str
    reason: str

    @property
    def message(self) -> str:
        """What is adjusted, and why."""
        return f"{'Points given to all students' if self.action == 'full' else 'Not counted'}: {self.reason}"


@dataclass(frozen=True, slots=True)
class Criterion:
    """A row of a rubric: a check with its arguments, and the exact points for passing it. `position` counts from 0.

    The points of a `bonus` are extra credit, not part of the maximum. A dropped criterion has 0 points; manual marks of
    adjusted criteria do not count.

    `answer` is the model answer; empty unless the rubric was loaded with its answers. `at` has the positions of joints,
    in degrees or metres, in which the robot is examined; the others are at 0. `has_selectors` says whether arguments
    name links by their place in the tree.
    """

    id: str
    title: str
    part: str
    points: Decimal
    check: Check
    arguments: Mapping[str, Any]
    requires: tuple[str, ...] = ()
    feedback: str = ""
    about: str = ""
    position: int = 0
    answer: str = ""
    carried: Carried | None = None
    at: Mapping[str, float] = field(default_factory=dict)
    has_selectors: bool = False
    bonus: bool = False
    adjustment: Adjustment | None = None

    @property
    def maximum(self) -> Decimal:
        """The points that are part of the maximum: none of a bonus."""
        return Decimal(0) if self.bonus else self.points

    @property
    def is_given(self) -> bool:
        """Return whether every graded submission gets the points."""
        return self.adjustment is not None and self.adjustment.action == "full"
