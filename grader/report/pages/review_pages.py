"""The pages of a review in the browser: one item in words and pictures, the end of the review, a message."""

from collections.abc import Mapping, Sequence
from datetime import datetime
from decimal import Decimal
from typing import Any, NamedTuple

from grader import __version__
from grader.classroom.lateness import time_text
from grader.classroom.marks import Mark
from grader.classroom.review_items import OLDER, STATES, UNMARKED, ReviewFilter, ReviewItem
from grader.documents.pictures import EmbeddedPicture, NotShown
from grader.grading.criterion import Criterion
from grader.report.criteria import model_lines
from grader.report.pages.shell import Assets, render_page
from grader.text import counted, counted_points, format_points, printable, shell_quoted

_ASSETS = Assets("review.css", "review.js", sources="img-src 'self'; frame-src 'self'; connect-src 'self'")
NO_ANSWER = "No answer"
_DECIMALS = Decimal("0.0001")


class OpenedItem(NamedTuple):
    """What was found, the lines of the answer, the pictures with what is not shown, and the paths of the files."""

    message: str
    answer: Sequence[str] = ()
    pictures: Sequence[EmbeddedPicture | NotShown] = ()
    paths: Sequence[str] = ()


def filters(shown: ReviewFilter, questions: Sequence[str], sections: Sequence[str]) -> list[tuple[object, ...]]:
    """Return the lists to filter by: the name of each, its label, its values with their words, the chosen value."""
    values = ({"": "all questions"} | dict(zip(questions, questions, strict=True)),
              {"": "all sections"} | dict(zip(sections, sections, strict=True)), STATES)  # fmt: skip
    return [*zip(ReviewFilter._fields, ("Question", "Section", "Items"), values, shown, strict=True)]


def item_page(item: ReviewItem, opened: OpenedItem, place: Mapping[str, Any]) -> str:
    """Return the page of an item; `place` has its `number` and address among a `total`, and the filters.

    The addresses of the pictures are ADDRESS/picture/1 and so on.
    """
    criterion, first, members = item.criterion, item.members[0], [one.label for one in item.members]
    mark, is_alone = first.mark, len(members) == 1
    marked = mark_text(mark) if mark else ""
    if first.state == OLDER:
        marked += ", before the submission changed"
    who = members[0] if is_alone else f"{len(members)} students"
    values = {
        **place,
        "title": f"{place['number']} of {place['total']}: {who}, {criterion.title}",
        "who": who,
        "members": [] if is_alone else members,
        "item": item,
        "maximum": format_points(criterion.points),
        "opened": opened,
        "model": model_lines(criterion),
        "pictures": [
            (f"{place['address']}/picture/{at}", one)
            for at, one in enumerate(opened.pictures, 1)
            if isinstance(one, EmbeddedPicture)
        ],
        "marked": marked,
        "buttons": _buttons(criterion),
        "choices": [f"{text} ({format_points(points)})" for text, points in criterion.choices.items()],
    }
    data = {
        "shown": item.view,
        "points": mark.value if mark else "",
        "comment": mark.comment if mark else "",
        "choices": [[text, float(points)] for text, points in criterion.choices.items()],
        "maximum": float(criterion.points),
    }
    return _page("review.html", values, data)


def end_page(marked: int, left: int, place: Mapping[str, Any], gradebook: str) -> str:
    """Return the page after the last item: how many marks were given, how many are left, and the next command."""
    values = {
        **place,
        "title": "Manual grading complete" if not left else f"{counted(left, 'mark')} left",
        "summary": f"{counted(marked, 'mark')} given in this review.",
        "left": left,
        "is_filtered": any(chosen not in ("", UNMARKED) for *_, chosen in place["filters"]),
        "command": f"grader export csv --gradebook {shell_quoted(gradebook)}",
    }
    return _page("review-end.html", values)


def error_page(message: str, following: str) -> str:
    """Return the page of an item that cannot be shown; `following` is the address of the next one."""
    title = "This item cannot be shown"
    return _page("review-error.html", {"title": title, "message": message, "following": following})


def _page(template: str, values: Mapping[str, object], data: Mapping[str, Any] = {}) -> str:
    return render_page(template, {"version": __version__, **values}, data, _ASSETS)


def _buttons(criterion: Criterion) -> list[tuple[str, str]]:
    """Return the points that have a button, and the name of each."""
    named = {Decimal(0): "none", criterion.points / 2: "half", criterion.points: "all"}
    return [(format_points(value), name) for value, name in named.items() if value == value.quantize(_DECIMALS)]


def mark_text(mark: Mark) -> str:
    """Return a mark or comment in one printable line: points, name, time, comment."""
    points = "withdrawn" if mark.value else "comment"
    if mark.points is not None:
        points = counted_points(mark.points)
    time = f"at {time_text(datetime.fromisoformat(mark.time))}" if mark.time else f"in {mark.place}"
    words = f"{points} by {mark.by or 'an unnamed person'} {time}"
    comment = " ".join(mark.comment.split())
    return printable(f"{words}: {comment}" if comment else words)
