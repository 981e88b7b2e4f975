"""Write the open items of a review into a CSV file, which a person fills in and `grader mark --import` records."""

import os
from pathlib import Path

from grader.classroom.review_items import ReviewItem
from grader.classroom.tables import write_table
from grader.errors import InputError
from grader.report.details import answer_lines
from grader.report.review import files_text, message_text, together_text, who
from grader.text import counted, cut, printable, printable_path, shell_quoted
from grader.usecases.review_pictures import open_item
from grader.usecases.review_session import ReviewScope, ReviewSession
from grader.usecases.writing import save

SHEET_COLUMNS = ("criterion", "answer", "points", "comment", "text", "students")
_PRIVATE = 0o600
_MAX_TEXT = 30_000  # characters; a cell of Excel has at most 32,767


def write_sheet(gradebook: Path, scope: ReviewScope, file: Path) -> str:
    """Write the items without a mark into a new file, and return what to do with it. Raises InputError."""
    session = ReviewSession(gradebook, scope)
    if os.path.lexists(file):
        raise InputError(f"{printable_path(file)} exists, perhaps with marks in it: name another file for --sheet")
    items = [session.item_at(position) for position in session.listed]
    by_student = sorted(range(len(items)), key=lambda at: items[at].first.order)  # a submission is read once
    texts = {at: _text(session, items[at]) for at in by_student}
    rows = ((one.criterion.id, one.answer, "", "", texts[at], _students(one)) for at, one in enumerate(items))
    save(file, write_table(SHEET_COLUMNS, rows), session.book.settings.roots(gradebook), _PRIVATE)
    command = f"grader mark --import {shell_quoted(file)} --gradebook {shell_quoted(gradebook)}"
    return f"{counted(len(items), 'item')} written for {session.left} marks; fill in the points, then: {command}\n"


def _students(item: ReviewItem) -> str:
    return "; ".join(one.student.key if one.number is None else who(one) for one in item.members)


def _text(session: ReviewSession, item: ReviewItem) -> str:
    """Return the answer, else what was found, and the files, which may show more."""
    if item.is_empty_group:
        return together_text(item)
    try:
        result = open_item(session.book, item).result
    except InputError as error:
        return f"Not shown: {error}"
    lines = [*filter(str.strip, answer_lines(result.outcome))] or [message_text(item, result)]
    files = files_text(item, result, session.root_of(item))
    return cut("\n".join(map(printable, [*lines, *files])), _MAX_TEXT)
