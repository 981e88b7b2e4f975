"""What a line of results keeps of a report: each criterion, and the answers that a person looks at."""

from grader.classroom.graded import Entry, digest_of
from grader.grading.pictures import content_of, is_empty
from grader.grading.report import Report, Result
from grader.text import cut

_MAX_CAUSE = 200  # characters


def entries_of(report: Report) -> dict[str, Entry]:
    """Return what a line keeps of each criterion of a report."""
    return {one.criterion.id: _entry(one) for one in report.results}


def _entry(result: Result) -> Entry:
    outcome = result.outcome
    is_open = outcome.status in ("pending", "errored") and not result.is_adjusted
    words = outcome.mistake or (outcome.message if outcome.status in ("failed", "errored") else "")
    points = result.points
    number = int(points) if points == int(points) else float(points)
    return None if is_open else number, outcome.status, cut(words, _MAX_CAUSE), result.carried


def answers_of(report: Report, digest: str) -> dict[str, str]:
    """Return the key of the answer for each criterion that needs manual grading, empty if there is nothing to read.

    It is that of the words, or of the whole submission where more than words is to be looked at.
    """
    open_ones = [one for one in report.results if one.outcome.status == "pending"]
    contents = {one.criterion.id: content_of(one, report) or digest * (not is_empty(one, report)) for one in open_ones}
    return {name: content and digest_of(content) for name, content in contents.items()}
