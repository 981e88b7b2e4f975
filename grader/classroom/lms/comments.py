"""A student's grade as a comment in HTML for an LMS: which points were lost, and why.

Moodle stores the comment unchanged and has it in the next worksheet (mod/assign/feedback/comments/locallib.php). An
HTML comment at its end holds a hash of the words: without a match, a person has changed or added some.
"""

import html
import re
from collections.abc import Iterable, Iterator, Sequence

from grader.classroom.tables import protected, spelt_out
from grader.files.reading import sha256_of
from grader.grading.report import Result
from grader.text import cut, first_lines, format_points

MAX_LINES = 40
_MAX_LINE = 700  # characters: with all lines less than a cell of Excel has
_OPENING = "Grade"
_MARK = re.compile(r"<!-- grader ([0-9a-f]{12}) -->")
_TAG = re.compile(r"<[^>]*+>")


def lost_points(results: Iterable[Result]) -> Iterator[str]:
    """Yield a line for each criterion below its maximum, with a comment, or with points that no check decides."""
    for result in results:
        mark, criterion = result.manual_mark, result.criterion
        comment = mark.comment if mark is not None else result.comment.text if result.comment is not None else ""
        if result.points < criterion.points or comment or result.why_given:
            is_hidden = mark is not None or result.is_adjusted or (comment and result.outcome.status == "passed")
            points = "–" if result.is_open else format_points(result.points)
            extra = " (extra credit)" if criterion.bonus else ""
            about = f"{criterion.title}{extra}: {points} of {format_points(criterion.points)}"
            message = "" if is_hidden else result.outcome.message
            about += f": {message}" if message else ""
            yield ". ".join(filter(None, (about, result.why_given, comment)))


def comment_html(opening: str, lines: Sequence[str]) -> str:
    """Return a comment in one line: `opening`, which begins with Grade, then a list of lines, of many the first."""
    items = "".join(f"<li>{_escape(line)}</li>" for line in first_lines(lines, MAX_LINES))
    text = protected(f"<p>{_escape(opening)}</p>" + f"<ul>{items}</ul>" * bool(items))
    return f"{text}<!-- grader {_hash(text)} -->"


def is_own_comment(text: str) -> bool:
    """Return whether a comment is from `comment_html`, its words unchanged; tags and spaces may have changed."""
    mark = _MARK.search(text)
    rest = _MARK.sub("", text, count=1)
    return mark is not None and _plain(rest).startswith(_OPENING) and mark[1] == _hash(rest)


def _escape(text: str) -> str:
    """Return text on one line of HTML; PHP's CSV reader takes a backslash for an escape."""
    line = cut(spelt_out(" ".join(text.split())), _MAX_LINE)
    return html.escape(line, quote=False).replace("\\", "&#92;")


def _hash(text: str) -> str:
    return sha256_of(_plain(text).encode("utf-8", "replace"))[:12]


def _plain(text: str) -> str:
    return " ".join(html.unescape(_TAG.sub(" ", text)).split())
