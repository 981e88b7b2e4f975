"""The pages of a review in the browser: one item, the end of the review, an item that cannot be shown."""

from collections.abc import Iterator, Mapping, Sequence
from decimal import Decimal
from typing import Any, NamedTuple

from grader import __version__
from grader.classroom.grades import StudentGrade
from grader.classroom.review_items import UNMARKED, ReviewItem
from grader.documents.pictures import EmbeddedPicture, NotShown
from grader.grading.criterion import Criterion
from grader.grading.report import Result
from grader.report.details import answer_lines, model_lines
from grader.report.pages.shell import Assets, render_page
from grader.report.review import marked_text, message_text, together_text, who
from grader.text import counted, counted_points, format_points, shell_quoted

_SOURCES = "img-src 'self'; frame-src 'self'; connect-src 'self'"
_DECIMALS = Decimal("0.0001")


class Place(NamedTuple):
    """The number of an item among those that are shown, from 1, and its address; whether this review has marked it.

    `filters` are the lists to filter by: the name of each, its label, its values with their words, and the value that
    is chosen. `students` are the keys and names to find one by.
    """

    number: int
    total: int
    address: str
    is_own: bool
    filters: Sequence[tuple[str, str, Mapping[str, str], str]] = ()
    students: Sequence[tuple[str, str]] = ()


class Found(NamedTuple):
    """What the page shows besides the item: the check's result, pictures, paths, the grade so far, earlier comments."""

    result: Result
    pictures: Sequence[EmbeddedPicture | NotShown] = ()
    paths: Sequence[str] = ()
    grade: StudentGrade | None = None
    comments: Sequence[str] = ()


def item_page(item: ReviewItem, criterion: Criterion, found: Found, place: Place) -> str:
    """Return the page of an item. `criterion` has the model answer; pictures are at ADDRESS/picture/1 and so on."""
    mark, result, count = item.first.mark, found.result, len(item.members)
    together = f"{count} students" if count > 1 else who(item.first)
    values = {
        "title": f"{place.number} of {place.total}: {together}, {criterion.title}",
        "place": place,
        "who": together,
        "first": who(item.first),
        "together": together_text(item),
        "members": [who(one) for one in item.members] if count > 1 else [],
        "criterion": criterion,
        "points": counted_points(criterion.points),
        "maximum": format_points(criterion.points),
        "score": _grade(found.grade) if found.grade is not None else "",
        "message": message_text(item, result),
        "answer": answer_lines(result.outcome),
        "model": model_lines(criterion),
        "places": found.paths,
        "pictures": [*_pictures(found.pictures, place.address)],
        "not_shown": [(one.where, one.reason) for one in found.pictures if isinstance(one, NotShown)],
        "report": f"{place.address}/report" if has_report(item) else "",
        "marked": marked_text(item),
        "buttons": _buttons(criterion),
        "choices": [f"{text} ({format_points(points)})" for text, points in criterion.choices.items()],
        "comments": [" ".join(comment.split()) for comment in found.comments],
    }
    data = {
        "shown": item.view,
        "item": item.stamp,
        "points": format_points(mark.points) if mark is not None and mark.points is not None else "",
        "comment": mark.comment if mark is not None else "",
        "comments": [*found.comments],
        "choices": [[text, float(points)] for text, points in criterion.choices.items()],
        "maximum": float(criterion.points),
    }
    return _page("review.html", values, data)


def has_report(item: ReviewItem) -> bool:
    """Return whether the student's page may be shown: it has the name."""
    return item.first.number is None and not item.is_empty_group


def _grade(grade: StudentGrade) -> str:
    """Return the points that a student has so far, and whether that is after the late penalty."""
    if grade.total is None or grade.report is None:
        return ""
    late = " after the late penalty" if grade.late.points else ""
    return f"{format_points(grade.total)} of {format_points(grade.report.max_score)} points so far{late}"


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
    shared = {"version": __version__, **values}
    return render_page(template, shared, data, Assets("review.css", "review.js", sources=_SOURCES))


def _pictures(found: Sequence[EmbeddedPicture | NotShown], address: str) -> Iterator[tuple[str, str, int, int]]:
    """Yield the address of each picture, its words, width and height; a PDF has none."""
    for index, one in enumerate(found, 1):
        if isinstance(one, EmbeddedPicture):
            page = "" if one.height else f"#page={one.page}&navpanes=0"
            yield f"{address}/picture/{index}{page}", one.words, one.width, one.height


def _buttons(criterion: Criterion) -> list[tuple[str, str]]:
    """Return the points that have a button, and the name of each."""
    half = criterion.points / 2
    named = {Decimal(0): "none", half: "half", criterion.points: "all"}
    return [(format_points(value), name) for value, name in named.items() if value == value.quantize(_DECIMALS)]
