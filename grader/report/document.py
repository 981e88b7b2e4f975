"""The description of a report in the order in which people read it: what to fix first, what is fine last."""

from collections.abc import Iterable, Iterator, Mapping
from decimal import Decimal
from typing import NamedTuple

from grader.grading.report import Report
from grader.report.criteria import Answer, Entry, Line, Section, alike, is_failure, points_of, status_of
from grader.report.details import blocks_of, skipped_text
from grader.text import enumerated

_REMARKS = ("Marked manually", "Corrected after grading", "Comments")


class Document(NamedTuple):
    """The criteria of a report, except those that passed and have no remark.

    `skipped` says what is skipped although nothing failed: a mark or an adjustment overrides its cause, or nothing was
    submitted. `remarks` have a mark, an adjustment or a comment and did not fail; one may be in two of their sections.
    """

    failures: tuple[Entry, ...]
    skipped: tuple[Line, ...]
    pending: tuple[Entry, ...]
    remarks: tuple[Section, ...]

    @property
    def sections(self) -> Iterator[Section]:
        """What failed, what needs manual grading, and the remarks."""
        if self.failures or self.skipped:
            yield Section("Failed" if self.failures else "Not graded", self.failures, self.skipped)
        if self.pending:
            yield Section("Needs manual grading", self.pending)
        yield from self.remarks


def document(report: Report, *, everything: bool = False) -> Document:
    """Return the description of a report; with `everything` the rubric's feedback where there is a hint, too."""
    known = entries(report, everything=everything)
    others = [entry for entry in known.values() if not is_failure(entry.result)]
    by_status = dict(alike(others, lambda entry: entry.status))
    skipped = alike((one.result for one in by_status.get("skipped", ())), lambda one: one.because or "")
    commented = [one for one in others if one.result.comment and one.status not in ("pending", "adjusted")]
    marked = [one for one in others if one.result.manual_mark]
    remarks = zip(_REMARKS, (marked, by_status.get("adjusted", ()), commented), strict=True)
    failed = [known[failure.id] for failure in failures(report)]
    return Document(
        tuple(_joined(_without_repeats(failed))),
        tuple(
            Line("skipped", skipped_text(cause, some))
            for cause, some in skipped
            if cause not in known or not known[cause].skipped
        ),
        tuple(_joined(by_status.get("pending", ()))),
        tuple(Section(title, tuple(some)) for title, some in remarks if some),
    )


def entries(report: Report, *, everything: bool = False) -> Mapping[str, Entry]:
    """Return the entry of every criterion by its id, in the rubric's order."""
    failed = {failure.id: failure for failure in failures(report)}
    found = (failed.get(result.criterion.id, Entry(result)) for result in report.results)
    return {one.id: one._replace(blocks=tuple(blocks_of(one, report, everything=everything))) for one in found}


def failures(report: Report) -> tuple[Entry, ...]:
    """Return the criteria that failed or lost points, without blocks; those that one edit fixes follow each other.

    What keeps ROS 2 from loading the file comes first, then the costliest mistake. What is about a package that was not
    submitted, and then what is carried forward, comes last. Equals are in the rubric's order.
    """
    skipped = dict(alike((one for one in report.results if status_of(one) == "skipped"), lambda one: one.because or ""))
    found = [Entry(one, skipped.get(one.criterion.id, ())) for one in report.results if is_failure(one)]
    mistakes = [_together(some) for _, some in alike(found, _edit)]
    is_rejected, has_package = report.submission.verdict == "rejected", report.submission.package is not None

    def rank(mistake: tuple[Entry, ...]) -> tuple[bool, bool, bool, Decimal]:
        criteria = [failure.result.criterion for failure in mistake]
        is_last = not has_package and report.rubric.part(criteria[0].part).needs == "package"
        is_urgent = is_rejected and any(criterion.check.subject == "urdf" for criterion in criteria)
        lost = sum((failure.lost for failure in mistake), Decimal(0))
        return bool(mistake[0].result.why_given), is_last, not is_urgent, -lost

    return tuple(failure for mistake in sorted(mistakes, key=rank) for failure in mistake)


def _edit(failure: Entry) -> str:
    """Return what failures have in common that one edit fixes."""
    hint = failure.result.hint
    return hint.shown_by if hint is not None and not failure.result.why_given else failure.id


def _together(some: tuple[Entry, ...]) -> tuple[Entry, ...]:
    """Return failures that one edit fixes: the one that shows the hint first, then those of the file, the costliest."""

    def rank(failure: Entry) -> tuple[bool, bool, Decimal]:
        is_shown = failure.result.hint is not None and failure.result.hint.shown_by == failure.id
        return not is_shown, failure.result.criterion.check.subject != "urdf", -failure.lost

    first, *also = sorted(some, key=rank)
    return first._replace(also=tuple(also)), *(one._replace(first=first.id) for one in also)


def _without_repeats(failed: Iterable[Entry]) -> Iterator[Entry]:
    """Yield entries without feedback that an earlier one has."""
    seen = set[Line]()
    for entry in failed:
        feedback = {one for one in entry.blocks if isinstance(one, Line) and one.role == "feedback"}
        yield entry._replace(blocks=tuple(block for block in entry.blocks if block not in feedback & seen))
        seen |= feedback


def _joined(entries: Iterable[Entry]) -> Iterator[Entry]:
    """Yield one entry for all that could not be graded for the same reason."""
    for _, (first, *others) in alike(entries, _reason):
        names = enumerated([entry.id for entry in others])
        line = Line("alike", f"The same holds for {names} ({points_of(one.result for one in others)}).")
        yield first._replace(also=tuple(others), blocks=(*first.blocks, line)) if others else first


def _reason(entry: Entry) -> str:
    """Return why a criterion could not be graded; of others, and of those with an answer or a comment, the id."""
    outcome, has_own = entry.result.outcome, any(isinstance(block, Answer) for block in entry.blocks)
    is_ungraded = entry.status in ("pending", "errored") and not (has_own or entry.result.comment)
    return outcome.mistake or outcome.message if is_ungraded else entry.id
