"""Grade what needs manual grading at a terminal, one item at a time."""

import re
from bisect import bisect
from collections.abc import Sequence
from decimal import Decimal
from functools import partial
from pathlib import Path

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.manual_queue import COMMENT_NUMBER, ReviewScope
from grader.classroom.gradebook.marks import NewerMarkError
from grader.classroom.review.session import ReviewSession
from grader.classroom.typed_names import read_points
from grader.errors import InputError
from grader.report.review import mark_text, render_item
from grader.report.screen import draw
from grader.text import format_points
from grader.usecases.review_pictures import PictureFolder, write_all_pictures
from grader.usecases.terminal import Terminal

NOTHING = "nothing needs manual grading\n"
_HELP = """\
3.5 a comment   points, and a comment for the student
3.5 #2          points, and comment 2 again
d1 d3 a comment usual deductions, instead of points
s or Enter      skip
b               go back
u               undo
o               the students of this item one by one
/NAME           go to a student
q               stop: all marks are kept
"""
_AT_END = "u to undo, b to go back, Enter to end"
_END = f"end of the queue: {_AT_END}: "
_DEDUCTION = re.compile(r"d([1-9])(?:\s+|$)", re.IGNORECASE)
_KEEP = "k to keep that mark, r to replace it with yours: "


def review(gradebook: Path, scope: ReviewScope, pictures: Path | None, terminal: Terminal) -> str:
    """Show what needs manual grading, one criterion of a student after the other, and mark it; return a summary.

    Pictures are written into the folder `pictures` first.
    """
    with Gradebook(gradebook) as book:
        session = ReviewSession(Grades(book, answers=True), scope)
        if not session.queue.items:
            return NOTHING
        book.check_writable()
        folder = PictureFolder(session, book, pictures) if pictures else None
        written = write_all_pictures(session, folder, terminal.print) if folder else {}
        try:
            while session.item is not None or _at_end(session, terminal):
                assert session.item is not None
                queued = session.queue.items[session.position]
                if folder is not None and queued not in written:
                    written[queued] = folder.write(session.item)
                _show(session, written.get(queued, ()), terminal)
                if not _go_on(session, terminal):
                    break
        except KeyboardInterrupt:
            terminal.print(f"\n{review_summary(session)}")
            raise
        return review_summary(session)


def _at_end(session: ReviewSession, terminal: Terminal) -> bool:
    """Ask what to do at the end of the queue, if a mark can be undone; return whether there is an item again."""
    while session.item is None and session.own.can_undo and (line := terminal.ask(_END)) is not None:
        match line.strip().lower():
            case "" | "q" | "quit":
                return False
            case "u" | "undo" | "b" | "back":
                _move(session, line.strip().lower(), terminal)
            case _:
                terminal.warn(_AT_END)
    return session.item is not None


def _show(session: ReviewSession, pictures: Sequence[str], terminal: Terminal) -> None:
    assert session.item is not None
    listed = session.queue.listed()
    position = f"{bisect(listed, session.position)} of {len(listed)}"
    used = session.comments()
    comments = {number: text for number, text in session.numbered_comments().items() if text in used}
    page = partial(render_item, session.item, position, pictures, comments)
    terminal.print(draw(page, terminal.screen()))


def review_summary(session: ReviewSession) -> str:
    """Return how many items were marked, and how many are left."""
    return f"{session.marked} marked, {session.left} left\n"


def _go_on(session: ReviewSession, terminal: Terminal) -> bool:
    """Ask until there is a valid answer, and execute it; return False to stop."""
    assert session.item is not None
    criterion = session.item.result.criterion
    count = len(session.item.members)
    all_of = f" for all {count} students" if count > 1 else ""
    prompt = f"points{all_of}, 0 to {format_points(criterion.points)} (? for help): "
    while (line := terminal.ask(prompt)) is not None:
        line = line.strip()
        if line.lower() in ("q", "quit"):
            return False
        word = line.partition(" ")[0].lower()
        try:
            if word.startswith("/"):
                session.find(line[1:].strip())
                return True
            if word == "?":
                terminal.print(f"\n{_HELP}")
            elif word not in _MOVES:
                return _mark(session, *_read_mark(line, session), terminal)
            elif _move(session, word, terminal):
                return True
        except InputError as error:
            terminal.warn(str(error))
    return False


def _read_mark(line: str, session: ReviewSession) -> tuple[Decimal, str]:
    """Return the points and the comment in a line; usual deductions take the place of points. Raises InputError."""
    criterion = session.current_item().result.criterion
    chosen, rest = list[str](), line
    while criterion.choices and (number := _DEDUCTION.match(rest)):
        if int(number[1]) > len(criterion.choices):
            raise InputError(f"there is no deduction {number[0].strip()}")
        text = [*criterion.choices][int(number[1]) - 1]
        chosen += [text] * (text not in chosen)
        rest = rest[number.end() :]
    if chosen:
        return criterion.after(chosen), "; ".join(filter(None, (*chosen, _comment(session, rest))))
    answer, _, comment = line.partition(" ")
    return read_points(answer, criterion.id, criterion.points), _comment(session, comment.strip())


# What an answer does that is not points.
_MOVES = {
    "": "next", "s": "next", "skip": "next", "b": "back", "back": "back", "u": "undo", "undo": "undo", "o": "split",
}  # fmt: skip


def move(session: ReviewSession, name: str) -> str:
    """Go to another item, or undo a mark; return a notice about it. Raises InputError."""
    if name == "undo":
        return _undo(session)
    {"next": session.next, "back": session.back, "split": session.split, "keep": session.stay}[name]()
    return ""


def _move(session: ReviewSession, word: str, terminal: Terminal) -> bool:
    """Do what a word means, and print what happened; return whether an item is to be shown."""
    here = session.position
    try:
        notice, is_done = move(session, _MOVES[word]), True
    except InputError as error:
        notice, is_done = str(error), session.position != here
    if notice:
        terminal.warn(notice)
    return is_done


def _comment(session: ReviewSession, typed: str) -> str:
    """Return the comment: `#2` is an earlier one. Raises InputError."""
    number = COMMENT_NUMBER.fullmatch(typed)
    if number is None:
        return typed
    comment = session.numbered_comments().get(int(number[1]))
    if comment is None:
        raise InputError(f"there is no comment {number[0]}")
    return comment


def _undo(session: ReviewSession) -> str:
    """Undo a mark of this review; return which mark counts now, or that a newer one stays. Raises InputError."""
    if not session.own.can_undo:
        raise InputError("nothing to undo: this review has marked nothing")
    try:
        before = session.undo()
    except NewerMarkError as error:
        return f"not undone: somebody has marked this since: {mark_text(error.mark)}"
    is_given = before is not None and before.entry.kind != "withdrawn"
    return f"undone; the mark before it counts again: {mark_text(before)}" if before and is_given else "undone"


def _mark(session: ReviewSession, points: Decimal, comment: str, terminal: Terminal) -> bool:
    """Add a mark, unless the person keeps another grader's newer one; go to the next item; return False to stop."""
    shown = None
    while True:
        try:
            session.mark(points, comment, shown)
            break
        except NewerMarkError as error:
            shown = error.mark.id
            terminal.warn(f"somebody has marked this since it was shown: {mark_text(error.mark)}")
        answer = _ask_to_keep(terminal)
        if not answer:
            return False
        if answer == "k":
            session.stay()
            return True
    session.next()
    return True


def _ask_to_keep(terminal: Terminal) -> str:
    """Return `k` to keep the newer mark, `r` to replace it; empty to stop."""
    while (line := terminal.ask(_KEEP)) is not None:
        if line.strip().lower() in ("k", "keep", "r", "replace"):
            return line.strip().lower()[0]
    return ""
