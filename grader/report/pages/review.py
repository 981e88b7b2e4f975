"""The pages of a review in the browser: one item that needs manual grading, the end of the queue, an error."""

from collections.abc import Iterator, Sequence
from decimal import Decimal
from typing import Any, NamedTuple

from grader import __version__
from grader.classroom.gradebook.manual_queue import QueuedResult
from grader.classroom.gradebook.student_grade import StudentGrade
from grader.documents.pictures import EmbeddedPicture, NotShown
from grader.files.reading import sha256_of
from grader.grading.criterion import Criterion
from grader.report.details import answer_lines, model_lines
from grader.report.pages.shell import Assets, render_page
from grader.report.review import files_text, marked_text, message_text, place_text, who
from grader.text import counted, counted_points, format_points, shell_quoted

_SOURCES = "img-src 'self'; connect-src 'self'"
_DECIMALS = Decimal("0.0001")


class Place(NamedTuple):
    """The number of an item in the queue, from 1; whether this review has marked it; whether it has marked any item."""

    number: int
    total: int
    is_own: bool
    can_undo: bool


def item_page(
    item: QueuedResult, place: Place, found: Sequence[EmbeddedPicture | NotShown], comments: Sequence[str], notice: str
) -> str:
    """Return the page of an item. The addresses of its pictures are NUMBER/picture/1 and so on."""
    criterion, outcome = item.result.criterion, item.result.outcome
    given, comment = item.result.manual_mark, item.result.comment
    values = {
        "title": f"{place.number} of {place.total}: {who(item)}, {criterion.title}",
        "place": place,
        "who": who(item),
        "criterion": criterion,
        "points": counted_points(criterion.points),
        "maximum": format_points(criterion.points),
        "score": "" if item.is_second else _grade(item.grade),
        "message": message_text(item),
        "answer": answer_lines(outcome),
        "model": model_lines(criterion),
        "places": [*files_text(item), *filter(None, [place_text(item)])],
        "pictures": [*_pictures(found, place.number)],
        "not_shown": [(one.where, one.reason) for one in found if isinstance(one, NotShown)],
        "marked": marked_text(item),
        "choices": _choices(criterion),
        "comments": [" ".join(comment.split()) for comment in comments],
        "notice": notice,
    }
    data = {
        "shown": item.newest,
        "item": stamp_of(item),
        "points": format_points(given.points) if given is not None else "",
        "comment": given.comment if given is not None else comment.text if comment is not None else "",
        "comments": [*comments],
    }
    return _page("review.html", values, data)


def stamp_of(item: QueuedResult) -> str:
    """Return a text that tells whether an item is the one that a page shows, without the name of its student."""
    return sha256_of(f"{item.grade.student.key}\n{item.result.criterion.id}\n{item.grade.result}".encode())[:16]


def _grade(grade: StudentGrade) -> str:
    """Return the points that count for a student, and what they are: a final mark, after the penalty, or so far."""
    if grade.is_excused:
        return "excused"
    late = " after the late penalty" if grade.late.points else ""
    how = "final mark" if grade.final is not None else f"points so far{late}"
    return f"{format_points(grade.total)} of {format_points(grade.out_of)} {how}"


def end_page(marked: int, left: int, gradebook: str, notice: str) -> str:
    """Return the page after the last item: the numbers of marked and remaining items, and the next command."""
    values = {
        "title": "Nothing needs manual grading" if not left else f"{counted(left, 'item')} left",
        "summary": f"{counted(marked, 'item')} marked in this review.",
        "left": left,
        "command": f"grader export csv --gradebook {shell_quoted(gradebook)}",
        "can_undo": marked > 0,
        "notice": notice,
    }
    return _page("review-end.html", values, {})


def error_page(message: str, following: str) -> str:
    """Return the page of an item that cannot be shown; `following` is the address of the next one."""
    return _page(
        "review-error.html", {"title": "This item cannot be shown", "message": message, "following": following}, {}
    )


def _page(template: str, values: dict[str, Any], data: dict[str, Any]) -> str:
    shared = {"version": __version__, **values}
    return render_page(template, shared, data, Assets("review.css", "review.js", sources=_SOURCES))


def _pictures(found: Sequence[EmbeddedPicture | NotShown], number: int) -> Iterator[tuple[str, str, int, int]]:
    """Yield the address, the words, the width and the height of each picture."""
    for index, one in enumerate(found, 1):
        if isinstance(one, EmbeddedPicture):
            yield f"{number}/picture/{index}", one.words, one.width, one.height


def _choices(criterion: Criterion) -> list[tuple[str, str]]:
    """Return the points that have a button, and the name of each."""
    half = criterion.points / 2
    named = {Decimal(0): "none", half: "half", criterion.points: "all"}
    return [(format_points(value), name) for value, name in named.items() if value == value.quantize(_DECIMALS)]
