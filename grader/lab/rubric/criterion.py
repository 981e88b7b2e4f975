"""The rows of a rubric.

They are criteria with what they are worth, parts, evidence, the late penalty, and ignored mutants.
"""

from collections.abc import Iterable, Mapping, Sequence
from datetime import datetime
from decimal import Decimal
from typing import Any, NamedTuple

from grader.base.records import Named
from grader.base.text import counted_points, format_points
from grader.lab.checks.check import Check
from grader.lab.checks.outcome import WRONG, Outcome

GRADE = "grade"  # in place of a criterion's id, in manual marks and tables: the whole submission
TOTAL = "total"  # another word for that, in manual marks
DEADLINE = "deadline"  # likewise: a deadline of the student


class Carried(NamedTuple):
    """Error carried forward.

    Points are kept where one of `causes` failed and the check, another fact, passes.
    """

    causes: Sequence[str]
    check: Check
    arguments: Mapping[str, Any]
    at: Mapping[str, float] = {}  # positions of joints, if not those of the criterion

    def of(self, criterion: "Criterion") -> "Criterion":
        """Return a criterion with the joints at the positions of this fact."""
        return criterion._replace(at=self.at) if self.at else criterion


class Adjustment(Named):
    """A correction of a criterion after grading.

    With the action "drop" it does not count. With "full", every graded submission gets its points.
    """

    action: str
    reason: str

    @property
    def message(self) -> str:
        """What is adjusted, and why."""
        return (
            f"{'Points given to all students' if self.action == 'full' else 'Not counted'}: "
            f"{self.reason}"
        )


class Criterion(NamedTuple):
    """A row of a rubric: a check with its arguments, and the exact points for passing it."""

    id: str
    title: str  # what should be true, in one sentence
    part: str  # the id of the part that it belongs to
    points: Decimal  # 0 if it is dropped
    check: Check
    arguments: Mapping[str, Any]
    requires: Sequence[str] = ()  # ids of criteria above it: it is skipped unless they passed
    feedback: Mapping[str, str] = {}  # for students who fail it, by the cause; "": for any cause
    about: str = ""  # a heading that consecutive criteria share
    position: int = 0  # in the rubric, from 0
    answer: str = ""  # the model answer; empty unless the rubric was loaded with its answers
    carried: Sequence[Carried] = ()
    at: Mapping[
        str, float
    ] = {}  # the positions of joints in which the robot is examined, degrees or metres; else 0
    args: Mapping[str, str] = {}  # launch arguments under which the submission is examined
    # whether arguments name links by their place in the tree, or joints by their links
    has_selectors: bool = False
    bonus: bool = False  # whether the points are extra credit, not part of the maximum
    adjustment: Adjustment | None = None  # after grading; then manual marks do not count
    package: str = ""  # the name of the package that it is about; empty for the one with the robot
    choices: Mapping[
        str, Decimal
    ] = {}  # usual deductions for manual grading: comments, and points below 0

    @property
    def maximum(self) -> Decimal:
        """The points that are part of the maximum: none of a bonus."""
        return Decimal(0) if self.bonus else self.points

    def feedback_on(self, outcome: Outcome) -> str:
        """Return the feedback on a failure: that for its cause, or that for any cause."""
        return self.feedback.get(outcome.cause or WRONG, self.feedback.get("", ""))

    @property
    def is_given(self) -> bool:
        """Return whether every graded submission gets the points."""
        return self.adjustment is not None and self.adjustment.action == "full"


class _Worth(Named):
    """The maximum of some criteria, and the points of extra credit in addition to it."""

    points: Decimal
    bonus: Decimal

    @property
    def text(self) -> str:
        """The points in words: 14 points; 14 points and 5 bonus points; 5 bonus points."""
        if not self.bonus:
            return counted_points(self.points)
        extra = f"{format_points(self.bonus)} bonus {'point' if self.bonus == 1 else 'points'}"
        if self.points:
            return f"{counted_points(self.points)} and {extra}"
        return extra

    @property
    def short(self) -> str:
        """The points in short: 14; 14 + 5 bonus; 5 bonus."""
        if not self.bonus:
            return format_points(self.points)
        extra = f"{format_points(self.bonus)} bonus"
        if self.points:
            return f"{format_points(self.points)} + {extra}"
        return extra


def worth(criteria: Iterable[Criterion]) -> _Worth:
    """Return what criteria are worth together."""
    points = bonus = Decimal(0)
    for criterion in criteria:
        points += criterion.maximum
        bonus += criterion.points - criterion.maximum
    return _Worth(points, bonus)


class Part(Named):
    """A task of the lab.

    `needs` is the required input: a urdf, a package, or all files of the submission.
    """

    id: str
    title: str
    needs: str = "urdf"


class Evidence(Named):
    """Evidence that the lab asks for.

    `names` are labels in the name of its file, in any spelling: "task 1 step 8".
    """

    id: str
    part: str
    title: str
    names: Sequence[str]


class Late(Named):
    """The late penalty: points once, and points and percent of the maximum for each day.

    A day counts that has begun after the deadline and the grace period.

    The penalty lowers no grade below `floor_percent` of the maximum, and does not change lower
    grades. `due` has a time zone.
    """

    percent_per_day: Decimal = Decimal(0)
    points_per_day: Decimal = Decimal(0)
    points: Decimal = Decimal(0)
    due: datetime | None = None
    grace_minutes: Decimal = Decimal(0)
    floor_percent: Decimal = Decimal(0)


class Ignored(Named):
    """Mutants of the reference that may lose nothing: patterns of their ids, and why."""

    mutants: Sequence[str]
    reason: str
