"""One student's comment for a learning management system, as HTML, and how it is known again.

Moodle keeps the HTML of an uploaded comment as it is and hands it out again in the next worksheet
(mod/assign/feedback/comments/locallib.php). A mark at the end, which readers do not see, holds a hash of the words: a comment
whose words a person has changed or added to is no longer ours.
"""

import html
import re
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal

from grader.classroom.lms.grades import cut, exact_words
from grader.classroom.lms.spreadsheet import FORMULA_BEHIND_SEMICOLON, spelt_out
from grader.files.reading import sha256_of

LIMIT = 4_000  # characters
_ONE_TEXT = 600
_OPENING = "Graded automatically"
_MARK = re.compile(r"<!-- grader ([0-9a-f]{12}) -->")
_TAG = re.compile(r"<[^>]*+>")


@dataclass(frozen=True, slots=True)
class FeedbackItem:
    """One criterion as the student reads of it."""

    title: str
    points: Decimal
    out_of: Decimal
    message: str = ""


def feedback_html(score: Decimal, out_of: Decimal, remarks: Sequence[FeedbackItem]) -> str:
    """A comment of one line and at most 4,000 characters: the score as it is exported, then the remarks, in their order."""
    opening = f"<p>{_OPENING}: {exact_words(cut(score))} of {exact_words(out_of)} points.</p>"
    items = [_item(remark) for remark in remarks]
    room = LIMIT - len(opening) - 100  # for the list's tags, the mark, and how many more there are
    shown = 0
    while shown < len(items) and room >= len(items[shown]):
        room -= len(items[shown])
        shown += 1
    more = [f"<li>... and {len(items) - shown} more</li>"] if shown < len(items) else []
    listed = f"<ul>{''.join([*items[:shown], *more])}</ul>" if items else ""
    return f"{opening}{listed}<!-- grader {_hash(opening + listed)} -->"


def is_our_feedback(text: str) -> bool:
    """Whether a comment is one of `feedback_html`, its words untouched; tags and spaces may have been written anew."""
    mark = _MARK.search(text)
    if mark is None:
        return False
    words = text[: mark.start()] + text[mark.end() :]
    return _words(words).startswith(_OPENING) and mark[1] == _hash(words)


def _item(remark: FeedbackItem) -> str:
    points = exact_words(remark.points)
    if remark.points >= 0:  # less is what being late costs: that is of nothing
        points += f" of {exact_words(remark.out_of)}"
    message = _escaped(remark.message)
    return f"<li>{_escaped(remark.title)}: {points}.{' ' if message else ''}{message}</li>"


def _escaped(text: str) -> str:
    """A student's text on one line of HTML.

    Two things are written as character references, so that they stay what they are: a backslash, which PHP's reader of CSV
    takes for an escape, and what a spreadsheet would take for a formula behind the semicolon of another reference.
    """
    line = spelt_out(" ".join(text.split()))
    short = line if len(line) <= _ONE_TEXT else line[: _ONE_TEXT - 3] + "..."
    escaped = html.escape(short).replace("\\", "&#92;")
    return FORMULA_BEHIND_SEMICOLON.sub(lambda found: "".join(map(_reference, found[0])), escaped)


def _reference(character: str) -> str:
    return character if character.isspace() else f"&#{ord(character)};"


def _hash(text: str) -> str:
    return sha256_of(_words(text).encode("utf-8", "replace"))[:12]


def _words(text: str) -> str:
    return " ".join(html.unescape(_TAG.sub(" ", text)).split())
