"""The criteria of a report in the order in which people read them: what to fix first, what is fine last."""

from collections.abc import Callable, Hashable, Iterable, Iterator
from decimal import Decimal
from itertools import groupby
from typing import NamedTuple, TypeVar

from grader.checks.manual import MANUAL_CHECKS
from grader.grading.criterion import worth
from grader.grading.report import Report, Result
from grader.text import format_points, signed_points

T = TypeVar("T")
K = TypeVar("K", bound=Hashable)


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


class FailedCriterion(NamedTuple):
    """A criterion that failed or lost points, with the criteria that are skipped because of it.

    `also` are the failures that the same edit fixes; each of them names this criterion as `first`.
    """

    result: Result
    skipped: tuple[Result, ...] = ()
    also: tuple["FailedCriterion", ...] = ()
    first: str = ""

    @property
    def id(self) -> str:
        """The id of the criterion."""
        return self.result.criterion.id

    @property
    def lost(self) -> Decimal:
        """The points that it costs, with those of what is skipped because of it; extra credit costs nothing."""
        own = self.result.criterion.maximum - self.result.points if not self.result.criterion.bonus else Decimal(0)
        return sum((other.criterion.maximum for other in self.skipped), own)

    @property
    def cost(self) -> str:
        """The points that it costs: -6 points; of extra credit what was earned: 0/5 bonus.

        Those of what is skipped because of it are apart: -3 points, and 21 for what depends on it.
        """
        others = sum((other.criterion.maximum for other in self.skipped), Decimal(0))
        own = self.lost - others
        lost = f"{signed_points(-own) if own else '0'} point{'' if own == 1 else 's'}"
        lost = f"{lost}, and {format_points(others)} for what depends on it" if others else lost
        if not self.result.criterion.bonus:
            return lost
        return earned_text(self.result) + (f", {lost}" if self.lost else "")


class Order(NamedTuple):
    """All criteria of a report, each once, except that skipped criteria with a comment are in two groups.

    `failures` is in the order of the function of that name. `skipped` are those whose cause is not a
    failure: a manual mark overrides it, or it is adjusted. `marked` have all their points by a manual mark. `commented`
    are the others with a grader's comment.
    """

    failures: tuple[FailedCriterion, ...]
    skipped: tuple[Result, ...]
    pending: tuple[Result, ...]
    marked: tuple[Result, ...]
    adjusted: tuple[Result, ...]
    commented: tuple[Result, ...]
    passed: tuple[Result, ...]

    @property
    def remarks(self) -> tuple[tuple[str, tuple[Result, ...]], ...]:
        """The criteria with a mark, an adjustment or a comment that are not failures, each group with its heading."""
        titles = ("Marked manually", "Corrected after grading", "Comments")
        found = zip(titles, (self.marked, self.adjusted, self.commented), strict=True)
        return tuple((title, results) for title, results in found if results)

    @property
    def sections(self) -> tuple[tuple[str, tuple[Result, ...]], ...]:
        """What needs manual grading, and the remarks."""
        return (*((("Needs manual grading", self.pending),) if self.pending else ()), *self.remarks)


def in_order(report: Report) -> Order:
    """Return the criteria of a report in the order in which people read them."""
    failed = failures(report)
    causes = {failure.id for failure in failed}
    others = [result for result in report.results if not is_failure(result)]
    by_status = dict(alike(others, status_of))
    return Order(
        failed,
        tuple(result for result in by_status.get("skipped", ()) if result.because not in causes),
        by_status.get("pending", ()),
        tuple(result for result in others if result.manual_mark),
        by_status.get("adjusted", ()),
        tuple(result for result in others if result.comment and status_of(result) not in ("pending", "adjusted")),
        tuple(filter(has_passed, others)),
    )


def failures(report: Report) -> tuple[FailedCriterion, ...]:
    """Return the criteria that failed or lost points; those that one edit fixes follow each other.

    What keeps ROS 2 from loading the file comes first, then the costliest mistake. What is about a package that was not
    submitted, and then what is carried forward, comes last. Equals are in the rubric's order.
    """
    skipped = dict(alike((one for one in report.results if status_of(one) == "skipped"), lambda one: one.because or ""))
    found = [
        FailedCriterion(result, skipped.get(result.criterion.id, ())) for result in report.results if is_failure(result)
    ]
    mistakes = [_together(some) for _, some in alike(found, _edit)]
    is_rejected, has_package = report.submission.verdict == "rejected", report.submission.package is not None

    def rank(mistake: tuple[FailedCriterion, ...]) -> tuple[bool, bool, bool, Decimal]:
        criteria = [failure.result.criterion for failure in mistake]
        is_last = not has_package and report.rubric.part(criteria[0].part).needs == "package"
        is_urgent = is_rejected and any(criterion.check.subject == "urdf" for criterion in criteria)
        lost = sum((failure.lost for failure in mistake), Decimal(0))
        return bool(mistake[0].result.why_given), is_last, not is_urgent, -lost

    return tuple(failure for mistake in sorted(mistakes, key=rank) for failure in mistake)


def _edit(failure: FailedCriterion) -> str:
    """Return what failures have in common that one edit fixes."""
    hint = failure.result.hint
    return hint.shown_by if hint is not None and not failure.result.why_given else failure.id


def _together(some: tuple[FailedCriterion, ...]) -> tuple[FailedCriterion, ...]:
    """Return failures that one edit fixes: the one that shows the hint first, then those of the file, the costliest."""

    def rank(failure: FailedCriterion) -> tuple[bool, bool, Decimal]:
        is_shown = failure.result.hint is not None and failure.result.hint.shown_by == failure.id
        return not is_shown, failure.result.criterion.check.subject != "urdf", -failure.lost

    first, *also = sorted(some, key=rank)
    return first._replace(also=tuple(also)), *(one._replace(first=first.id) for one in also)


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
