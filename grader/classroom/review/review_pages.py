"""The pages of a review in the browser.

These are one item in words and pictures, the end of the review, and a message.
"""

from collections.abc import Mapping, Sequence
from datetime import datetime
from decimal import Decimal
from itertools import starmap
from pathlib import Path
from typing import Any, NamedTuple

from markupsafe import Markup

from grader import __version__
from grader.base.text import (
    counted,
    counted_points,
    format_points,
    people_text,
    printable,
    shell_quoted,
)
from grader.classroom.gradebook.review_items import (
    OLDER,
    STATES,
    UNMARKED,
    ReviewFilter,
    ReviewItem,
)
from grader.classroom.lms.forms import FORMS
from grader.classroom.marks.marks import Mark
from grader.classroom.roster.lateness import time_text
from grader.lab.documents.pictures import EmbeddedPicture, NotShown
from grader.report.criteria import model_lines
from grader.report.drawing.three_views import STYLE
from grader.report.locations import SourceLine
from grader.report.pages.shell import SPACE_SCRIPTS, Assets, render_page

_SOURCES = "img-src 'self'; frame-src 'self'; connect-src 'self'"
_FILES = Path(__file__).parent / "files"
_SCRIPTS = f"{SPACE_SCRIPTS} review.js"
_ASSETS = Assets("text.css robot.css review.css", _SCRIPTS, STYLE, _SOURCES, _FILES)
NO_ANSWER = "No answer"
_DECIMALS = Decimal("0.0001")
_Marks = Sequence[Mark | None]


class SimilarItem(NamedTuple):
    """An item with an answer that is similar to another one."""

    position: int
    item: ReviewItem
    text: str
    share: float  # of the words that both have in common


class OpenedItem(NamedTuple):
    """What was found for an item, as a page or a sheet shows it.

    `views` is an SVG element with the robot, empty without one, `space` the robot as data for the
    script of the page, and `legend` says what is marked in it. `places` are the lines of files
    around the places that decide, each with its location in words.
    """

    message: str
    answer: Sequence[str] = ()
    pictures: Sequence[EmbeddedPicture | NotShown] = ()
    paths: Sequence[str] = ()  # of the files, below the class folder
    views: str = ""
    space: Mapping[str, Any] | None = None
    legend: Sequence[str] = ()
    places: Sequence[tuple[str, Sequence[SourceLine]]] = ()
    title: str = "Answer"  # of the answer


def filters(
    shown: ReviewFilter, questions: Sequence[str], sections: Sequence[str]
) -> list[tuple[object, ...]]:
    """Return the lists to filter by.

    The name of each, its label, its values with their words, and the chosen value.
    """
    question_words = {"": "all questions"} | {question: question for question in questions}
    section_words = {"": "all sections"} | {section: section for section in sections}
    return [
        ("criterion", "Question", question_words, shown.criterion),
        ("section", "Section", section_words, shown.section),
        ("state", "Items", STATES, shown.state),
    ]


def item_page(
    item: ReviewItem,
    opened: OpenedItem,
    place: Mapping[str, Any],
    similar: Mapping[str, SimilarItem],
) -> str:
    """Return the page of an item.

    `place` has its `number` and address among a `total`, and the filters.

    The addresses of the pictures are ADDRESS/picture/1 and so on. `similar` are items by address.
    """
    criterion = item.criterion
    members = [member.label for member in item.members]
    marks = [shown.members[0].mark for shown in item.all]
    each = [
        (shown.criterion.title, shown.criterion.id, format_points(shown.criterion.points))
        for shown in item.all
    ]
    maximum = sum((shown.criterion.points for shown in item.all), Decimal(0))
    choices = criterion.choices if not item.also else {}
    pictures = []
    for number, picture in enumerate(opened.pictures, 1):
        if isinstance(picture, EmbeddedPicture):
            pictures.append((f"{place['address']}/picture/{number}", picture))
    who = f"{len(members)} students"
    listed = members
    if len(members) == 1:
        who = members[0]
        listed = []
    is_older = item.members[0].state == OLDER
    similar_answers = list(starmap(_similar_answer, similar.items()))
    values = {
        **place,
        "title": f"{place['number']} of {place['total']}: {who}, {criterion.title}",
        "who": who,
        "members": listed,
        "item": item,
        "maximum": format_points(maximum),
        "each": each,
        "opened": opened,
        "views": Markup(opened.views),  # noqa: S704  an element, whose text is escaped
        "model": model_lines(criterion),
        "pictures": pictures,
        "marked": _marked_text(marks, is_older=is_older),
        "similar": similar_answers,
        "buttons": _buttons(maximum),
        "choices": [f"{text} ({format_points(points)})" for text, points in choices.items()],
    }
    views = {address: one.item.view for address, one in similar.items()}
    data = {
        **_marked_data(item, marks),
        "similar": views,
        "choices": [(text, float(points)) for text, points in choices.items()],
        "maximum": float(maximum),
        "people": members,
    }
    if opened.space is not None:
        data["robot"] = opened.space
    return _page("review.html", values, data)


def _similar_answer(address: str, one: SimilarItem) -> tuple[str, str, list[str]]:
    """Return the address of an item, who has its answer, and the lines of the answer."""
    people = people_text([member.label for member in one.item.members])
    return address, f"{people}: {int(100 * one.share)}% the same words", one.text.splitlines()


def _marked_data(item: ReviewItem, marks: _Marks) -> dict[str, Any]:
    """Return how an item is marked, for the script of its page."""
    first = marks[0]
    each = [mark.value if mark else "" for mark in marks]
    return {
        "shown": item.view,
        "points": _total(marks),
        "each": each if item.also else [],
        "comment": first.comment if first else "",
    }


def _total(marks: _Marks) -> str:
    """Return the points of the marks of an item together; empty if one is missing."""
    points = [mark.points for mark in marks if mark and mark.points is not None]
    if len(points) == len(marks):
        return format_points(sum(points, Decimal(0)))
    return ""


def _marked_text(marks: _Marks, *, is_older: bool) -> str:
    """Return what is marked of an item: the first mark, with the points of all.

    It is empty without one.
    """
    given = [mark for mark in marks if mark]
    if not given:
        return ""
    text = mark_text(given[0]._replace(value=_total(marks) or given[0].value))
    if len(given) < len(marks):
        text = f"{len(given)} of {len(marks)} criteria, the first: {text}"
    return f"{text}, before the submission changed" if is_older else text


def end_page(marked: int, left: int, place: Mapping[str, Any], gradebook: str, lms: str) -> str:
    """Return the page after the last item.

    It says how many marks were given, how many are left, and the next command.

    It exports the grades to the LMS that the class came from, if that is known.
    """
    how = "export the grades"
    command = f"grader export {lms or 'csv'} --gradebook {shell_quoted(gradebook)}"
    if lms:
        how = f"fill the grade file that {FORMS[lms].lms} has exported"
        command += " --into EXPORTED.csv --output upload.csv"
    values = {
        **place,
        "title": f"{counted(left, 'mark')} still needed" if left else "Manual grading complete",
        "summary": f"{counted(marked, 'mark')} given in this review.",
        "left": left,
        "is_filtered": any(chosen not in ("", UNMARKED) for *_, chosen in place["filters"]),
        "how": how,
        "command": command,
    }
    return _page("review-end.html", values)


def error_page(message: str, following: str) -> str:
    """Return the page of an item that cannot be shown.

    `following` is the address of the next one.
    """
    title = "This item cannot be shown"
    return _page("review-error.html", {"title": title, "message": message, "following": following})


def _page(template: str, values: Mapping[str, object], data: Mapping[str, Any] = {}) -> str:
    return render_page(template, {"version": __version__, **values}, data, _ASSETS)


def _buttons(maximum: Decimal) -> list[tuple[str, str]]:
    """Return the points that have a button, and the name of each."""
    named = {Decimal(0): "none", maximum / 2: "half", maximum: "all"}
    return [
        (format_points(value), name)
        for value, name in named.items()
        if value == value.quantize(_DECIMALS)
    ]


def mark_text(mark: Mark) -> str:
    """Return a mark or comment in one printable line: points, name, time, comment."""
    points = "withdrawn" if mark.value else "comment"
    if mark.points is not None:
        points = counted_points(mark.points)
    time = f"at {time_text(datetime.fromisoformat(mark.time))}" if mark.time else f"in {mark.place}"
    words = f"{points} by {mark.by or 'an unnamed person'} {time}"
    comment = " ".join(mark.comment.split())
    return printable(f"{words}: {comment}" if comment else words)
