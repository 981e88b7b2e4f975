"""The pages of a review in the browser: one item that needs manual grading, the end of the queue, an error."""

from collections.abc import Iterator, Mapping, Sequence
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
from grader.report.review import (
    choice_words,
    files_text,
    marked_text,
    message_text,
    place_text,
    together_text,
    who,
    who_together,
)
from grader.text import counted, counted_points, format_points, shell_quoted

_SOURCES = "img-src 'self'; frame-src 'self'; connect-src 'self'"
_DECIMALS = Decimal("0.0001")


class Place(NamedTuple):
    """The number of an item in the queue, from 1, and its address; whether this review has marked it, or any item.

    `filters` are the lists to filter by: the name of each, its label, its values with their words, and the value that
    is chosen. `students` are the keys and names to find one by.
    """

    number: int
    total: int
    address: str
    is_own: bool
    can_undo: bool
    filters: Sequence[tuple[str, str, Mapping[str, str], str]] = ()
    students: Sequence[tuple[str, str]] = ()


def item_page(
    item: QueuedResult, place: Place, found: Sequence[EmbeddedPicture | NotShown], comments: Sequence[str], notice: str
) -> str:
    """Return the page of an item. The addresses of its pictures are ADDRESS/picture/1 and so on."""
    criterion = item.result.criterion
    given, comment = item.result.manual_mark, item.result.comment
    values = {
        "title": f"{place.number} of {place.total}: {who_together(item)}, {criterion.title}",
        "place": place,
        "who": who_together(item),
        "first": who(item.first),
        "together": together_text(item),
        "members": [who(one) for one in item.members if item.others],
        "criterion": criterion,
        "points": counted_points(criterion.points),
        "maximum": format_points(criterion.points),
        "score": "" if item.is_second or item.others else _grade(item.grade),
        "message": "" if item.is_empty_group else message_text(item),
        "answer": [] if item.is_empty_group else answer_lines(item.result.outcome),
        "model": model_lines(criterion),
        "places": [*files_text(item), *filter(None, [place_text(item)])],
        "pictures": [*_pictures(found, place.address)],
        "not_shown": [(one.where, one.reason) for one in found if isinstance(one, NotShown)],
        "report": f"{place.address}/report" if has_report(item) else "",
        "marked": marked_text(item),
        "buttons": _buttons(criterion),
        "choices": choice_words(criterion),
        "comments": [" ".join(comment.split()) for comment in comments],
        "notice": notice,
    }
    data = {
        "shown": item.newest,
        "item": stamp_of(item),
        "points": format_points(given.points) if given is not None else "",
        "comment": given.comment if given is not None else comment.text if comment is not None else "",
        "comments": [*comments],
        "choices": [[text, float(points)] for text, points in criterion.choices.items()],
        "maximum": float(criterion.points),
    }
    return _page("review.html", values, data)


def stamp_of(item: QueuedResult) -> str:
    """Return a text that tells whether an item is the one that a page shows, without the names of its students."""
    results = (f"{one.grade.student.key}\n{one.grade.result}" for one in item.members)
    return sha256_of("\n".join((item.result.criterion.id, *results)).encode())[:16]


def has_report(item: QueuedResult) -> bool:
    """Return whether the student's page may be shown: it has the name, and the marks of others."""
    return item.first.number is None and not item.is_second and not item.is_empty_group


def _grade(grade: StudentGrade) -> str:
    """Return the points that count for a student, and what they are: a final mark, after the penalty, or so far."""
    if grade.is_excused:
        return "excused"
    late = " after the late penalty" if grade.late.points else ""
    how = "final mark" if grade.final is not None else f"points so far{late}"
    return f"{format_points(grade.total)} of {format_points(grade.out_of)} {how}"


def end_page(marked: int, left: int, place: Place, gradebook: str, notice: str) -> str:
    """Return the page after the last item: the numbers of marked and remaining items, and the next command."""
    values = {
        "title": "Manual grading complete" if not left else f"{counted(left, 'mark')} left",
        "summary": f"{counted(marked, 'mark')} given in this review.",
        "left": left,
        "place": place,
        "is_filtered": any(chosen for *_, chosen in place.filters),
        "command": f"grader export csv --gradebook {shell_quoted(gradebook)}",
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


class _Picture(NamedTuple):
    """A picture on the page; a PDF has no width and height."""

    address: str
    words: str
    width: int
    height: int


def _pictures(found: Sequence[EmbeddedPicture | NotShown], address: str) -> Iterator[_Picture]:
    for index, one in enumerate(found, 1):
        if isinstance(one, EmbeddedPicture):
            page = "" if one.height else f"#page={one.page}&navpanes=0"
            yield _Picture(f"{address}/picture/{index}{page}", one.words, one.width, one.height)


def _buttons(criterion: Criterion) -> list[tuple[str, str]]:
    """Return the points that have a button, and the name of each."""
    half = criterion.points / 2
    named = {Decimal(0): "none", half: "half", criterion.points: "all"}
    return [(format_points(value), name) for value, name in named.items() if value == value.quantize(_DECIMALS)]
