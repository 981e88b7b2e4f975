"""A student's grade as a comment in HTML for an LMS: which points were lost, and why.

Moodle stores the comment unchanged and has it in the next worksheet (mod/assign/feedback/comments/locallib.php). An
HTML comment at its end holds a hash of the words: without a match, a person has changed or added some.
"""

import html
import re
from collections.abc import Iterable, Iterator, Sequence
from decimal import ROUND_FLOOR, Decimal
from itertools import accumulate
from typing import NamedTuple

from grader.classroom.tables import FORMULA_BEHIND_SEMICOLON, spelt_out
from grader.files.reading import sha256_of
from grader.grading.report import Result
from grader.text import cut, format_points

LIMIT = 4_000  # characters
_MAX_MESSAGE = 600
_OPENING = "Graded "  # automatically, manually, or both
_MARK = re.compile(r"<!-- grader ([0-9a-f]{12}) -->")
_TAG = re.compile(r"<[^>]*+>")


class CommentItem(NamedTuple):
    """A line of a comment: a criterion, or several that share a cause; without points, a remark on the submission."""

    title: str
    points: Decimal | None = None
    out_of: Decimal = Decimal(0)
    message: str = ""
    is_open: bool = False


def comment_items(results: Iterable[Result]) -> Iterator[CommentItem]:
    """Yield an item for each criterion below its maximum, with a comment, or with points that no check decides.

    Criteria that are skipped because of the same criterion, or open for the same reason, are one item.
    """
    groups: dict[tuple[str, str], list[Result]] = {}
    for number, result in enumerate(results):
        if result.points < result.criterion.points or _comment(result) or result.why_given:
            groups.setdefault(_cause(result) or ("", str(number)), []).append(result)
    for (kind, cause), group in groups.items():
        out_of = sum((result.criterion.points for result in group), Decimal(0))
        if len(group) > 1:
            is_open = kind == "pending"
            what = "need manual grading" if is_open else f"were skipped because {cause} failed"
            message = _capitalise(cause) if is_open else ""
            yield CommentItem(f"{len(group)} criteria {what}", Decimal(0), out_of, message, is_open)
            continue
        (result,) = group
        title = result.criterion.title + (" (extra credit)" if result.criterion.bonus else "")
        yield CommentItem(title, result.points, out_of, _message(result), result.is_open)


def comment_html(score: Decimal, out_of: Decimal, items: Sequence[CommentItem], graded: str = "automatically") -> str:
    """Return a comment in one line of at most LIMIT characters: who graded, the exported score, then the items."""
    exported = format_points(score.quantize(Decimal("0.01"), ROUND_FLOOR))
    opening = f"<p>{_OPENING}{_escape(graded)}: {exported} of {format_points(out_of)} points.</p>"
    lines = [_line(item) for item in items]
    room = LIMIT - len(opening) - 100  # for the list's tags, the mark, and the line that counts the rest
    shown = sum(length <= room for length in accumulate(map(len, lines)))
    more = [f"<li>... and {len(lines) - shown} more</li>"] if shown < len(lines) else []
    listed = f"<ul>{''.join([*lines[:shown], *more])}</ul>" if lines else ""
    return f"{opening}{listed}<!-- grader {_hash(opening + listed)} -->"


def is_own_comment(text: str) -> bool:
    """Return whether a comment is from `comment_html`, its words unchanged; tags and spaces may have changed."""
    mark = _MARK.search(text)
    rest = _MARK.sub("", text, count=1)
    return mark is not None and _plain(rest).startswith(_OPENING) and mark[1] == _hash(rest)


def _message(result: Result) -> str:
    """Return what is said of one criterion: what the check found or why it does not count, and a person's comment."""
    comment, why = _comment(result), result.why_given
    message = _capitalise(result.outcome.message)
    if result.manual_mark is not None or (comment and not why and result.outcome.status == "passed"):
        return comment
    parts = (why,) if result.is_adjusted else (message, why)  # what the check found may not be the student's mistake
    return ". ".join(filter(None, (*parts, comment)))


def _comment(result: Result) -> str:
    """Return the comment of a person, with points or without."""
    if result.manual_mark is not None:
        return result.manual_mark.comment
    return result.comment.text if result.comment is not None else ""


def _cause(result: Result) -> tuple[str, str] | None:
    """Return why a criterion is skipped or open, if others may have the same cause."""
    if result.manual_mark is not None or result.comment is not None or result.is_adjusted:
        return None
    if result.because is not None:
        return "skipped", result.because
    return ("pending", result.outcome.message) if result.is_open else None


def _capitalise(message: str) -> str:
    """Return a message with a capital, unless its first word has other characters than letters."""
    return message[:1].upper() + message[1:] if message.partition(" ")[0].isalpha() else message


def _line(item: CommentItem) -> str:
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
    line = cut(spelt_out(" ".join(text.split())), _MAX_MESSAGE)
    escaped = html.escape(line).replace("\\", "&#92;")
    return FORMULA_BEHIND_SEMICOLON.sub(lambda found: re.sub(r"\S", lambda one: f"&#{ord(one[0])};", found[0]), escaped)


def _hash(text: str) -> str:
    return sha256_of(_plain(text).encode("utf-8", "replace"))[:12]


def _plain(text: str) -> str:
    return " ".join(html.unescape(_TAG.sub(" ", text)).split())
