"""The criteria of a report in the order in which people read them: what to fix first, what is fine last."""

from collections.abc import Callable, Iterable, Iterator
from decimal import Decimal
from itertools import groupby
from typing import NamedTuple, TypeVar

from grader.grading.report import Hint, Report, Result
from grader.text import enumerated, signed_points

T = TypeVar("T")
_MAX_NAMED = 3


class Failure(NamedTuple):
    """A criterion that failed or lost points, with the criteria that are skipped because of it.

    `also` are the failures that the same edit fixes; each of them names this criterion as `first`.
    """

    result: Result
    skipped: tuple[Result, ...] = ()
    also: tuple["Failure", ...] = ()
    first: str = ""

    @property
    def lost(self) -> Decimal:
        """The points that it costs, with those of the criteria that are skipped because of it; extra credit costs nothing."""
        own = self.result.criterion.maximum - self.result.points if not self.result.criterion.bonus else Decimal(0)
        return sum((other.criterion.maximum for other in self.skipped), own)


class Order(NamedTuple):
    """All criteria of a report, each once, except that skipped criteria with a comment are in two groups.

    `failures` is in the order of the function of that name. `skipped` are those whose cause is not a
    failure: a manual mark overrides it, or it is adjusted. `marked` have all their points by a manual mark. `commented` are the
    others with a grader's comment.
    """

    failures: tuple[Failure, ...]
    skipped: tuple[Result, ...]
    pending: tuple[Result, ...]
    marked: tuple[Result, ...]
    adjusted: tuple[Result, ...]
    commented: tuple[Result, ...]
    passed: tuple[Result, ...]

    @property
    def remarks(self) -> tuple[tuple[str, tuple[Result, ...]], ...]:
        """The criteria with a mark, an adjustment or a comment that are not failures, each group with its heading."""
        found = (("Marked manually", self.marked), ("Adjusted", self.adjusted), ("Comments", self.commented))
        return tuple((title, results) for title, results in found if results)


class Group(NamedTuple):
    """The criteria about one thing, in the rubric's order."""

    part: str
    title: str
    results: tuple[Result, ...]


def in_order(report: Report) -> Order:
    """Return the criteria of a report in the order in which people read them."""
    failed = failures(report)
    named = {failure.result.criterion.id for failure in failed}
    rest = [result for result in report.results if not is_failure(result)]
    skipped = tuple(result for result in rest if _is_skipped(result))
    return Order(
        failed,
        tuple(result for result in skipped if result.because not in named),
        tuple(result for result in rest if result.is_open),
        tuple(result for result in rest if result.manual_mark is not None),
        tuple(result for result in rest if result.is_adjusted),
        tuple(result for result in rest if result.comment is not None and not (result.is_open or result.is_adjusted)),
        tuple(result for result in rest if has_passed(result)),
    )


def failures(report: Report) -> tuple[Failure, ...]:
    """Return the criteria that failed or lost points; those that one edit fixes follow each other, the one at its place first.

    What keeps ROS 2 from loading the file comes first, then the costliest mistake. What is about a package that was not submitted,
    and then what is carried forward, comes last. Equals are in the rubric's order.
    """
    skipped = [result for result in report.results if _is_skipped(result)]
    found = [
        Failure(result, tuple(other for other in skipped if other.because == result.criterion.id))
        for result in report.results
        if is_failure(result)
    ]
    mistakes = [_together(some) for _, some in alike(found, _edit)]
    is_rejected, has_package = report.submission.verdict == "rejected", report.submission.package is not None

    def rank(mistake: tuple[Failure, ...]) -> tuple[bool, bool, bool, Decimal]:
        criteria = [failure.result.criterion for failure in mistake]
        is_last = not has_package and report.rubric.part(criteria[0].part).needs == "package"
        is_urgent = is_rejected and any(criterion.check.subject == "urdf" for criterion in criteria)
        lost = sum((failure.lost for failure in mistake), Decimal(0))
        return bool(mistake[0].result.why_given), is_last, not is_urgent, -lost

    return tuple(failure for mistake in sorted(mistakes, key=rank) for failure in mistake)


def _edit(failure: Failure) -> str:
    """Return what failures have in common that one edit fixes."""
    result = failure.result
    hint = next(iter(result.hints), None)
    return repr((hint.message, hint.at, [*hint.gains])) if hint and not result.why_given else result.criterion.id


def _together(some: tuple[Failure, ...]) -> tuple[Failure, ...]:
    """Return failures that one edit fixes: first the one at the line that is edited, of the file before the robot, else the costliest."""

    def rank(failure: Failure) -> tuple[bool, bool, Decimal]:
        where, at = failure.result.outcome.location, failure.result.hints[0].at
        is_there = where is not None and (where.path, where.line) == (at.path, at.line)
        return not is_there, failure.result.criterion.check.subject != "urdf", -failure.lost

    first, *also = sorted(some, key=rank) if len(some) > 1 else some
    return first._replace(also=tuple(also)), *(one._replace(first=first.result.criterion.id) for one in also)


def is_failure(result: Result) -> bool:
    """Return whether a criterion failed or lost points; a manual mark or an adjustment overrides the check."""
    if result.is_adjusted:
        return False
    if result.manual_mark is not None:
        return result.points < result.criterion.points
    return result.outcome.status in ("failed", "errored")


def has_passed(result: Result) -> bool:
    """Return whether a check passed, without a mark, a comment or an adjustment."""
    is_silent = result.manual_mark is None and result.comment is None and not result.is_adjusted
    return is_silent and result.outcome.status == "passed"


def _is_skipped(result: Result) -> bool:
    return result.outcome.status == "skipped" and result.manual_mark is None and not result.is_adjusted


def groups(report: Report) -> Iterator[Group]:
    """Yield the criteria in the rubric's order, those about one thing together; the others under the title of their part."""
    titles = {part.id: part.title for part in report.rubric.parts}
    for (part, about), results in groupby(
        report.results, lambda result: (result.criterion.part, result.criterion.about)
    ):
        yield Group(part, about or titles[part], tuple(results))


def alike(items: Iterable[T], key: Callable[[T], str]) -> list[tuple[str, tuple[T, ...]]]:
    """Return each value of a key with the items that have it, in the order of the first ones."""
    found: dict[str, list[T]] = {}
    for item in items:
        found.setdefault(key(item), []).append(item)
    return [(value, tuple(some)) for value, some in found.items()]


def hints_of(result: Result, report: Report) -> tuple[Hint, ...]:
    """Return the hints of a criterion, which say what they fix besides; one that an earlier failure has names that failure."""
    name = result.criterion.id
    found = (failure for failure in failures(report) if failure.result.criterion.id == name) if result.hints else ()
    return tuple(hint_of(failure, hint) for failure in found for hint in result.hints)


def hint_of(failure: Failure, hint: Hint) -> Hint:
    """Return a hint of a failure, which says what it fixes besides."""
    if failure.first:
        return hint._replace(message=f"Fixed by the same edit as {failure.first}.", edits=())
    also = [f"{other.result.criterion.id}, {signed_points(-other.lost)}" for other in failure.also]
    skipped = (result.criterion.id for one in (failure, *failure.also) for result in one.skipped)
    left = [name for name in skipped if name not in hint.gains]
    texts = [hint.message.removesuffix(".")]
    texts += [f"Also fixes {enumerated(also, _MAX_NAMED)}"] if also else []
    texts += [f"Then look at {enumerated(left, _MAX_NAMED)}"] if left else []
    return hint._replace(message=f"{'. '.join(texts)}.")
