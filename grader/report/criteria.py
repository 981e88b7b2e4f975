"""Criteria in a report: their status and points, alone and in groups, and the blocks of what is said about each.

A writer decides how a block looks in its medium and which roles it leaves out, but neither words nor order.
"""

from collections.abc import Callable, Hashable, Iterable, Iterator
from decimal import Decimal
from itertools import groupby
from typing import Literal, NamedTuple, TypeVar

from grader.checks.manual import MANUAL_CHECKS
from grader.grading.criterion import worth
from grader.grading.report import Report, Result
from grader.source import Edits, Location
from grader.text import format_points, signed_points

T = TypeVar("T")
K = TypeVar("K", bound=Hashable)

# Of a submission, of a criterion, and of the list of evidence, problems and files.
Role = Literal[
    "summary", "pending", "provenance",
    "finding", "comment", "hint", "feedback", "expected", "skipped", "alike",
    "part", "found", "missing", "error", "warning", "note", "ignored",
]  # fmt: skip


def status_of(result: Result) -> str:
    """Return the status of a criterion: `adjusted` by the rubric, else that of the manual mark or the check.

    A manual mark is `passed` if it gives all points, and `partial` if it gives a part of them.
    """
    if result.is_adjusted:
        return "adjusted"
    if result.manual_mark is None:
        return result.outcome.status
    if result.points >= result.criterion.points:
        return "passed"
    return "partial" if result.points else "failed"


def is_failure(result: Result) -> bool:
    """Return whether a criterion failed or lost points; a manual mark or an adjustment overrides the check."""
    return status_of(result) in ("failed", "partial", "errored")


def has_passed(result: Result) -> bool:
    """Return whether a check passed, without a mark or a comment."""
    return status_of(result) == "passed" and result.manual_mark is None and result.comment is None


def is_manual(result: Result) -> bool:
    """Return whether a criterion is always graded manually: a question or a picture."""
    return result.criterion.check.function in MANUAL_CHECKS


def sum_text(results: tuple[Result, ...]) -> str:
    """Return the points of some criteria together: 58.5, or a dash if all of them need manual grading."""
    is_open = bool(results) and all(result.is_open for result in results)
    return "–" if is_open else format_points(sum((result.points for result in results), Decimal(0)))


def earned_text(*results: Result) -> str:
    """Return the points and the maximum of criteria together: 8/14, above it with extra credit; –/14; 5/5 bonus."""
    most = worth(result.criterion for result in results)
    return f"{sum_text(results)}/{format_points(most.points) if most.points or not most.bonus else most.short}"


def points_of(results: Iterable[Result]) -> str:
    """Return the maximum of some criteria together: 14 points, 14 points and 5 bonus points, 5 bonus points."""
    return worth(result.criterion for result in results).text


class Line(NamedTuple):
    """A printable sentence, and what it is."""

    role: Role
    text: str


class Answer(NamedTuple):
    """The lines of an answer, and whose it is."""

    title: Literal["Found", "Model answer"]
    lines: tuple[str, ...]


class Diff(NamedTuple):
    """The lines that edits change."""

    edits: Edits


Block = Line | Location | Answer | Diff  # a location is a place and its source line


class Entry(NamedTuple):
    """A criterion with what is said about it, and the criteria that are skipped because it failed.

    `also` are the criteria that the same edit fixes, each of which names this one as `first`, or about which the same
    is said.
    """

    result: Result
    skipped: tuple[Result, ...] = ()
    also: tuple["Entry", ...] = ()
    first: str = ""
    blocks: tuple[Block, ...] = ()

    @property
    def id(self) -> str:
        """The id of the criterion."""
        return self.result.criterion.id

    @property
    def status(self) -> str:
        """The status of the criterion."""
        return status_of(self.result)

    @property
    def lost(self) -> Decimal:
        """The points that a failure costs, with those of what is skipped because of it; extra credit costs nothing."""
        own = self.result.criterion.maximum - self.result.points if not self.result.criterion.bonus else Decimal(0)
        return sum((other.criterion.maximum for other in self.skipped), own)

    @property
    def points(self) -> str:
        """The points and the maximum, 3/4; of a failure the points that it costs: -6 points.

        Those of what is skipped because of it are apart: -3 points, and 21 for what depends on it. Of extra credit it
        is what was earned.
        """
        if not is_failure(self.result):
            return earned_text(self.result)
        others = sum((other.criterion.maximum for other in self.skipped), Decimal(0))
        own = self.lost - others
        lost = f"{signed_points(-own) if own else '0'} point{'' if own == 1 else 's'}"
        lost = f"{lost}, and {format_points(others)} for what depends on it" if others else lost
        if not self.result.criterion.bonus:
            return lost
        return earned_text(self.result) + (f", {lost}" if self.lost else "")

    @property
    def location(self) -> Location | None:
        """Where to look, if the criterion failed."""
        return next((block for block in self.blocks if isinstance(block, Location)), None)

    def texts(self, *roles: Role) -> list[str]:
        """Return the sentences with these roles."""
        return [block.text for block in self.blocks if isinstance(block, Line) and block.role in roles]


class Section(NamedTuple):
    """A part of a report under a title: entries, then lines."""

    title: str
    entries: tuple[Entry, ...] = ()
    lines: tuple[Line, ...] = ()


class CriteriaGroup(NamedTuple):
    """The criteria about one thing, in the rubric's order."""

    part: str
    title: str
    results: tuple[Result, ...]

    @property
    def points(self) -> str:
        """The points and the maximum of the group."""
        return earned_text(*self.results)

    @property
    def status(self) -> str:
        """The status of its worst criterion, without extra credit; one with all its points counts as passed."""
        counting = [result for result in self.results if not result.criterion.bonus] or self.results
        statuses = [status_of(result) for result in counting if result.points < result.criterion.points]
        lost = {"failed", "partial", "errored"}.intersection(statuses)
        if lost:
            return "partial" if lost == {"partial"} else "failed"
        return next(iter(statuses), "passed")


def groups(report: Report) -> Iterator[CriteriaGroup]:
    """Yield the criteria in the rubric's order, those about one thing together, else under the title of their part."""
    for (part, about), results in groupby(report.results, lambda one: (one.criterion.part, one.criterion.about)):
        yield CriteriaGroup(part, about or report.rubric.part(part).title, tuple(results))


def alike(items: Iterable[T], key: Callable[[T], K]) -> list[tuple[K, tuple[T, ...]]]:
    """Return each value of a key with the items that have it, in the order of the first ones."""
    found: dict[K, list[T]] = {}
    for item in items:
        found.setdefault(key(item), []).append(item)
    return [(value, tuple(some)) for value, some in found.items()]
