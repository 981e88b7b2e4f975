"""What a student reads of the criteria, in an LMS's comment: what was missed and why, each cause once."""

from collections.abc import Iterable, Iterator
from decimal import Decimal

from grader.classroom.lms.feedback import FeedbackItem
from grader.grading.report import Result


def feedback_items(results: Iterable[Result]) -> Iterator[FeedbackItem]:
    """A remark on each criterion that has not all its points, or a person's comment, in their order.

    Those that are not decided because one and the same criterion failed, or that wait for the same reason, are one remark.
    """
    together: dict[tuple[str, str], list[Result]] = {}
    for number, each in enumerate(results):
        if each.points < each.criterion.points or (each.manual_mark is not None and each.manual_mark.comment):
            together.setdefault(_cause(each) or ("", str(number)), []).append(each)
    for (kind, cause), alike in together.items():
        first = alike[0]
        if len(alike) == 1:
            yield FeedbackItem(first.criterion.title, first.points, first.criterion.points, _said(first))
            continue
        out_of = sum((each.criterion.points for each in alike), Decimal(0))
        if kind == "skipped":
            yield FeedbackItem(f"{len(alike)} criteria are not decided, because {cause} failed", Decimal(0), out_of)
        else:
            yield FeedbackItem(f"{len(alike)} criteria wait for a person", Decimal(0), out_of, _capitalised(cause))


def _cause(result: Result) -> tuple[str, str] | None:
    """What a criterion was skipped for, or waits for, where others may be for the same."""
    if result.manual_mark is not None:
        return None
    if result.because is not None:
        return "skipped", result.because
    return ("pending", result.outcome.message) if result.is_open else None


def _said(result: Result) -> str:
    return _capitalised(result.outcome.message) if result.manual_mark is None else result.manual_mark.comment


def _capitalised(message: str) -> str:
    """As the report in the terminal begins it: what is no word, such as an attribute of the file, stays as it is."""
    return message[:1].upper() + message[1:] if message.partition(" ")[0].isalpha() else message
