"""A comment for an LMS as HTML: which points were lost, and why.

Moodle stores the HTML of an uploaded comment unchanged and includes it in the next worksheet
(mod/assign/feedback/comments/locallib.php). An HTML comment at its end holds a hash of the words: without a match, a
person has changed the words or added to them, and the comment is theirs.
"""

import html
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from decimal import Decimal
from itertools import accumulate

from grader.classroom.lms.grades import rounded_down
from grader.classroom.tables import FORMULA_BEHIND_SEMICOLON, spelt_out
from grader.files.reading import sha256_of
from grader.grading.report import Result
from grader.text import cut, format_points

LIMIT = 4_000  # characters


_MAX_MESSAGE = 600


_OPENING = "Graded "  # automatically, manually, or both


_MARK = re.compile(r"<!-- grader ([0-9a-f]{12}) -->")


_TAG = re.compile(r"<[^>]*+>")


@dataclass(frozen=True, slots=True)
class FeedbackItem:
    """A line of a comment: a criterion, or several that share a cause; without points, a remark on the submission.

    `is_open` says that it needs manual grading.
    """

    title: str
    points: Decimal | None
    out_of: Decimal
    message: str = ""
    is_open: bool = False


def feedback_items(results: Iterable[Result]) -> Iterator[FeedbackItem]:
    """Yield an item for each criterion below its maximum, with a person's comment, or with an error carried forward.

    Criteria that are skipped because of the same criterion, or pending for the same reason, are one item.
    """
    groups: dict[tuple[str, str], list[Result]] = {}
    for number, result in enumerate(results):
        has_comment = _comment(result)
        if result.points < result.criterion.points or has_comment or result.why_given:
            groups.setdefault(_cause(result) or ("", str(number)), []).append(result)
    for (kind, cause), group in groups.items():
        out_of = sum((result.criterion.points for result in group), Decimal(0))
        if len(group) == 1:
            (result,) = group
            title = f"{result.criterion.title} (extra credit)" if result.criterion.bonus else result.criterion.title
            yield FeedbackItem(title, result.points, out_of, _message(result), result.is_open)
        elif kind == "skipped":
            yield FeedbackItem(f"{len(group)} criteria were skipped because {cause} failed", Decimal(0), out_of)
        else:
            title = f"{len(group)} criteria need manual grading"
            yield FeedbackItem(title, Decimal(0), out_of, _capitalise(cause), is_open=True)


def _message(result: Result) -> str:
    """Return what is said of one criterion: what the check found or why it does not count, and a person's comment."""
    comment, why = _comment(result), result.why_given
    if result.manual_mark is not None:
        return comment
    message = _capitalise(result.outcome.message)
    if result.is_adjusted:  # what the check found is not the student's mistake
        message = why
    elif why:
        message = f"{message}. {why}"
    elif comment and result.outcome.status == "passed":
        return comment
    return f"{message}. {comment}" if comment else message


def _comment(result: Result) -> str:
    """Return the comment of a person, with points or without; empty if there is none."""
    if result.manual_mark is not None:
        return result.manual_mark.comment
    return result.comment.text if result.comment is not None else ""


def _cause(result: Result) -> tuple[str, str] | None:
    """Return why a criterion is skipped or pending, if others may have the same cause.

    None with a manual mark, a comment or an adjustment: these criteria are listed on their own.
    """
    if result.manual_mark is not None or result.comment is not None or result.is_adjusted:
        return None
    if result.because is not None:
        return "skipped", result.because
    return ("pending", result.outcome.message) if result.is_open else None


def _capitalise(message: str) -> str:
    """Return a message as in the terminal report: a first word with other characters than letters is unchanged."""
    return message[:1].upper() + message[1:] if message.partition(" ")[0].isalpha() else message


def feedback_html(score: Decimal, out_of: Decimal, items: Sequence[FeedbackItem], graded: str = "automatically") -> str:
    """Return a comment in one line of at most LIMIT characters: who graded, the exported score, then the items."""
    opening = (
        f"<p>{_OPENING}{_escape(graded)}: {format_points(rounded_down(score))} of {format_points(out_of)} points.</p>"
    )
    lines = [_item(item) for item in items]
    room = LIMIT - len(opening) - 100  # for the list's tags, the mark, and the line that counts the rest
    shown = sum(length <= room for length in accumulate(map(len, lines)))
    more = [f"<li>... and {len(lines) - shown} more</li>"] if shown < len(lines) else []
    listed = f"<ul>{''.join([*lines[:shown], *more])}</ul>" if lines else ""
    return f"{opening}{listed}<!-- grader {_hash(opening + listed)} -->"


def is_own_feedback(text: str) -> bool:
    """Return whether a comment is from `feedback_html`, its words unchanged; tags and spaces may have changed."""
    mark = _MARK.search(text)
    if mark is None:
        return False
    rest = text[: mark.start()] + text[mark.end() :]
    return _plain(rest).startswith(_OPENING) and mark[1] == _hash(rest)


def _item(item: FeedbackItem) -> str:
    message = _escape(item.message)
    if item.points is None:
        return f"<li>{_escape(item.title)}: {message}</li>"
    points = "–" if item.is_open else format_points(item.points)
    if item.points >= 0:  # a late penalty is negative, and has no maximum
        points += f" of {format_points(item.out_of)}"
    return f"<li>{_escape(item.title)}: {points}.{' ' if message else ''}{message}</li>"


def _escape(text: str) -> str:
    """Return a student's text on one line of HTML.

    Two things become character references: a backslash, which PHP's CSV reader takes for an escape, and what a
    spreadsheet would take for a formula after the semicolon of another reference.
    """
    line = spelt_out(" ".join(text.split()))
    short = cut(line, _MAX_MESSAGE)
    escaped = html.escape(short).replace("\\", "&#92;")
    return FORMULA_BEHIND_SEMICOLON.sub(
        lambda found: re.sub(r"\S", lambda character: f"&#{ord(character[0])};", found[0]), escaped
    )


def _hash(text: str) -> str:
    return sha256_of(_plain(text).encode("utf-8", "replace"))[:12]


def _plain(text: str) -> str:
    return " ".join(html.unescape(_TAG.sub(" ", text)).split())
