"""What an instructor should look at before grades go out, as text for a terminal."""

import textwrap
from collections.abc import Iterator, Sequence

from grader.base.text import counted, enumerated, printable, without_commands
from grader.classroom.gradebook.rubric_review import RubricReview
from grader.classroom.gradebook.statistics import CriterionFigures

_MAX_LISTED = 10  # criteria or groups


def render_rubric_review(review: RubricReview, width: int) -> str:
    """Return the findings in lines of at most this width, each with what it may mean."""
    rubric = review.figures.rubric
    lines = [f"{rubric.id}: {counted(review.submissions, 'submission')} graded"]
    findings = list(_finding_lines(review))
    if not findings:
        lines += ["", "Nothing stands out: no criterion passes or fails everywhere."]
    folded = []
    for line in lines + findings:
        folded += textwrap.wrap(printable(line), width, subsequent_indent="  ") or [""]
    return without_commands("\n".join([*folded, ""]))


def _finding_lines(review: RubricReview) -> Iterator[str]:
    yield from _failing_lines(review)
    if review.errored:
        yield from ("", f"A check is faulty: {_names(review.errored)}")
    if review.undecided:
        yield from ("", "Most often left to manual grading:")
        by_count: dict[int, list[CriterionFigures]] = {}
        for row in review.undecided:
            by_count.setdefault(row.counts["pending"], []).append(row)
        for count, rows in by_count.items():
            yield f"  {count} of {review.submissions}: {_names(rows)}"
    if review.unlike:
        yield from ("", "Equal robots, but other results. Is there a reason outside of the robot?")
        for unlike in review.unlike[:_MAX_LISTED]:
            names = [review.figures.names.get(key) or key for key in unlike.students]
            yield (
                f"  {enumerated(names, _MAX_LISTED)} ({unlike.equal}): "
                f"{enumerated(unlike.criteria, _MAX_LISTED)}"
            )
    if review.all_pass:
        yield from ("", "All submissions pass. Does the criterion test enough?")
        yield f"  {_names(review.all_pass)}"


def _failing_lines(review: RubricReview) -> Iterator[str]:
    """Yield the criteria that all submissions fail, each with its most common mistake."""
    if review.all_fail:
        yield from ("", "All submissions fail. Is the criterion right, and the handout clear?")
        for row in review.all_fail[:_MAX_LISTED]:
            yield f"  {row.criterion.id}: {_first_mistake(review, row)}"
        if len(review.all_fail) > _MAX_LISTED:
            yield f"  and {len(review.all_fail) - _MAX_LISTED} more"


def _first_mistake(review: RubricReview, row: CriterionFigures) -> str:
    """Return the most common mistake in a criterion, with the number of its students."""
    for mistake in review.figures.common_mistakes:
        if mistake.criterion == row.criterion.id:
            return f"{mistake.message} ({counted(len(mistake.students), 'student')})"
    return f"{row.counts['failed']} of {row.counts['decided']}"


def _names(rows: Sequence[CriterionFigures]) -> str:
    return enumerated([row.criterion.id for row in rows], _MAX_LISTED)
