"""The pages of a review in the browser: one item in words and pictures, the end of the review, a message."""

from collections.abc import Mapping, Sequence
from datetime import datetime
from decimal import Decimal
from pathlib import Path
from typing import Any, NamedTuple

from grader import __version__
from grader.classroom.lateness import time_text
from grader.classroom.marks import Mark
from grader.classroom.review_items import OLDER, UNMARKED, Member, ReviewItem
from grader.documents.pictures import EmbeddedPicture, NotShown
from grader.grading.criterion import Criterion
from grader.grading.pictures import evidence_files
from grader.grading.report import Result
from grader.report.details import answer_lines, counts_lines, model_lines
from grader.report.pages.shell import Assets, render_page
from grader.text import counted, counted_points, format_points, named, printable, shell_quoted

_SOURCES = "img-src 'self'; frame-src 'self'; connect-src 'self'"
NO_ANSWER = "No answer"
_DECIMALS = Decimal("0.0001")


class Place(NamedTuple):
    """The number of an item among those that are shown, from 1, and its address.

    `filters` are the lists to filter by: the name of each, its label, its values with their words, the chosen value.
    """

    number: int
    total: int
    address: str
    filters: Sequence[tuple[str, str, Mapping[str, str], str]]


class OpenedItem(NamedTuple):
    """The result as the check finds it, the pictures, with files that are not shown, and the paths of the files."""

    result: Result
    pictures: Sequence[EmbeddedPicture | NotShown] = ()
    paths: Sequence[str] = ()


def item_page(item: ReviewItem, opened: OpenedItem, criterion: Criterion, place: Place) -> str:
    """Return the page of an item. `criterion` has the model answer.

    The addresses of the pictures are ADDRESS/picture/1 and so on.
    """
    mark, members, is_alone = item.first.mark, [who(one) for one in item.members], len(item.members) == 1
    together, shown = members[0] if is_alone else f"{len(members)} students", [*enumerate(opened.pictures, 1)]
    values = {
        "title": f"{place.number} of {place.total}: {together}, {criterion.title}",
        "place": place,
        "who": together,
        "together": "The same answer" if item.answer else NO_ANSWER,
        "members": [] if is_alone else members,
        "criterion": criterion,
        "maximum": format_points(criterion.points),
        "message": message_text(item, opened.result),
        "answer": answer_lines(opened.result.outcome),
        "model": model_lines(criterion),
        "places": opened.paths,
        "pictures": [(f"{place.address}/picture/{at}", one) for at, one in shown if isinstance(one, EmbeddedPicture)],
        "not_shown": [one for _, one in shown if isinstance(one, NotShown)],
        "marked": mark_text(mark) + ", before the submission changed" * (item.first.state == OLDER)
        if mark is not None
        else "",
        "buttons": _buttons(criterion),
        "choices": [f"{text} ({format_points(points)})" for text, points in criterion.choices.items()],
    }
    data = {
        "shown": item.view,
        "points": mark.value if mark is not None else "",
        "comment": mark.comment if mark is not None else "",
        "choices": [[text, float(points)] for text, points in criterion.choices.items()],
        "maximum": float(criterion.points),
    }
    return _page("review.html", values, data)


def end_page(marked: int, left: int, place: Place, gradebook: str) -> str:
    """Return the page after the last item: how many marks were given, how many are left, and the next command."""
    values = {
        "title": "Manual grading complete" if not left else f"{counted(left, 'mark')} left",
        "summary": f"{counted(marked, 'mark')} given in this review.",
        "left": left,
        "place": place,
        "is_filtered": any(chosen not in ("", UNMARKED) for *_, chosen in place.filters),
        "command": f"grader export csv --gradebook {shell_quoted(gradebook)}",
    }
    return _page("review-end.html", values, {})


def error_page(message: str, following: str) -> str:
    """Return the page of an item that cannot be shown; `following` is the address of the next one."""
    values = {"title": "This item cannot be shown", "message": message, "following": following}
    return _page("review-error.html", values, {})


def _page(template: str, values: dict[str, Any], data: dict[str, Any]) -> str:
    assets = Assets("review.css", "review.js", sources=_SOURCES)
    return render_page(template, {"version": __version__, **values}, data, assets)


def _buttons(criterion: Criterion) -> list[tuple[str, str]]:
    """Return the points that have a button, and the name of each."""
    named = {Decimal(0): "none", criterion.points / 2: "half", criterion.points: "all"}
    return [(format_points(value), name) for value, name in named.items() if value == value.quantize(_DECIMALS)]


def who(one: Member) -> str:
    """Return the name and key of the student, or the number of an anonymous one; printable."""
    return f"submission {one.number}" if one.number is not None else printable(named(one.student.key, one.student.name))


def message_text(item: ReviewItem, result: Result) -> str:
    """Return what was found; of an anonymous student the question alone, because students choose the names of files."""
    if item.is_empty_group or item.first.number is None:
        return printable(result.outcome.message)
    question = str(item.criterion.arguments.get("question", ""))
    return printable(question if result.outcome.status == "pending" else f"the check: {result.outcome.status}")


def mark_text(mark: Mark) -> str:
    """Return a mark or comment in one printable line: points, name, time, comment."""
    points = counted_points(mark.points) if mark.points is not None else "withdrawn" if mark.value else "comment"
    time = f"at {time_text(datetime.fromisoformat(mark.time))}" if mark.time else f"in {mark.place}"
    words = f"{points} by {mark.by or 'an unnamed person'} {time}"
    return printable(": ".join(filter(None, [words, " ".join(mark.comment.split())])))


def files_text(item: ReviewItem, result: Result, root: Path) -> list[str]:
    """Return the files that a criterion is about, and the submission in the class folder `root`, printable."""
    location, found = result.outcome.location, [*evidence_files(result)]
    if location is not None:
        found.append(f"{location.path}, line {location.line}" if counts_lines(location) else location.path)
    submitted = ", ".join(str(root / path) for path in item.first.graded.paths)
    return [printable(f"{place} in {submitted}") for place in found] or [printable(submitted)]
