"""Read the submission of an item again: what was found for its criterion, its pictures, and a sheet of open items.

A person fills in the sheet, a CSV file, and `grader mark --import` records it.
"""

import os
from functools import lru_cache
from itertools import starmap
from pathlib import Path

from grader.classroom.gradebook import Gradebook
from grader.classroom.review_items import ReviewItem
from grader.classroom.tables import write_table
from grader.commands.review_session import ReviewSession
from grader.commands.writing import save
from grader.documents.pictures import EmbeddedPicture, NotShown
from grader.errors import InputError
from grader.grading.grade import grade
from grader.grading.pictures import evidence_files, may_have_pictures, pictures_of
from grader.grading.report import Report
from grader.report.details import answer_lines, counts_lines
from grader.report.pages.review import NO_ANSWER, OpenedItem
from grader.submission.submission import Submission
from grader.text import counted, cut, format_points, printable, printable_path, shell_quoted

SHEET_COLUMNS = ("criterion", "answer", "points", "maximum", "comment", "text", "students")
_PRIVATE = 0o600
_MAX_TEXT = 30_000  # characters; a cell of Excel has at most 32,767


@lru_cache(maxsize=1)  # a page asks for its pictures one by one
def _graded_again(book: Gradebook, key: str) -> tuple[Submission, Report]:
    """Return a student's submission as it was graded, and its report. Raises InputError."""
    graded = book.results.of(key)
    submission = book.reopened(graded) if graded is not None else None
    if submission is None:
        command = f"`grader batch NEWPATH --gradebook {shell_quoted(book.folder)}` with its class folder"
        raise InputError(f"the submission has moved or changed since it was graded: run {command}")
    return submission, grade(book.rubric, submission, book.settings.parts, is_one_of_class=True)


def open_item(book: Gradebook, item: ReviewItem) -> OpenedItem:
    """Return what a person looks at for an item. Raises InputError if its submission has moved or changed.

    Of an anonymous student it has no names of files, because students choose them.
    """
    first = item.members[0]
    if item.members[1:] and not item.answer:
        return OpenedItem("")
    submission, report = _graded_again(book, first.student.key)
    result = next((one for one in report.results if one.criterion.id == item.criterion.id), None)
    if result is None:
        raise InputError("this criterion is no longer graded for this student")
    pictures = pictures_of(result, submission) if may_have_pictures(result) else ()
    outcome, location, places = result.outcome, result.outcome.location, [*evidence_files(result)]
    if first.number:
        question = str(item.criterion.arguments.get("question", ""))
        message = question if outcome.status == "pending" else f"the check: {outcome.status}"
        return OpenedItem(message, answer_lines(outcome), [*starmap(_anonymous, enumerate(pictures, 1))])
    if location is not None:
        places.append(f"{location.path}, line {location.line}" if counts_lines(location) else location.path)
    root = book.settings.roots(book.folder)[first.stored.root]
    submitted = ", ".join(str(root / path) for path in first.stored.paths)
    paths = [f"{place} in {submitted}" for place in places] or [submitted]
    return OpenedItem(outcome.message, answer_lines(outcome), pictures, paths)


def _anonymous(number: int, found: EmbeddedPicture | NotShown) -> EmbeddedPicture | NotShown:
    if isinstance(found, EmbeddedPicture):
        return found._replace(where=f"picture {number}")
    return NotShown(f"file {number}", found.reason.replace(found.where, f"file {number}"))


def write_sheet(session: ReviewSession, file: Path) -> str:
    """Write the items that are shown into a new file, and return what to do with it. Raises InputError."""
    if os.path.lexists(file):
        raise InputError(f"{printable_path(file)} exists, perhaps with marks in it: name another file for --sheet")
    items = [session.item_at(at) for at in session.listed]
    by_student = sorted(items, key=lambda item: item.members[0].student.key)  # a submission is read once
    texts = {item.place: _text(session.book, item) for item in by_student}
    rows = [
        (*item.place, "", format_points(item.criterion.maximum), "", texts[item.place], _students(item))
        for item in items
    ]
    save(file, write_table(SHEET_COLUMNS, rows), session.book.settings.roots(session.folder), _PRIVATE)
    command = f"grader mark --import {shell_quoted(file)} --gradebook {shell_quoted(session.folder)}"
    return f"{counted(len(items), 'item')} written for {session.left} marks; fill in the points, then: {command}\n"


def _students(item: ReviewItem) -> str:
    return "; ".join(one.label if one.number else one.student.key for one in item.members)


def _text(book: Gradebook, item: ReviewItem) -> str:
    """Return the answer, else what was found, and the files, which may show more."""
    try:
        opened = open_item(book, item)
    except InputError as error:
        return f"Not shown: {error}"
    lines = [*filter(str.strip, opened.answer)] or [opened.message or NO_ANSWER]
    return cut("\n".join(map(printable, [*lines, *opened.paths])), _MAX_TEXT)
