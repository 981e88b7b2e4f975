"""Give manual marks: one by command, or all that need manual grading in an interactive review."""

from decimal import Decimal
from functools import partial
from pathlib import Path

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.marks import (
    NewerMarkError,
    PendingCriterion,
    criterion_of,
    manual_grading_queue,
    mark,
    pending_criterion,
    read_points,
)
from grader.errors import InputError
from grader.report.review import mark_text, render_pending
from grader.report.screen import draw
from grader.text import counted_points, format_points, printable
from grader.usecases import Terminal, Warn

_HELP = "points and a comment, s to skip, q to stop (all marks are kept), ? for this help"
_KEEP = "k to keep that mark, r to replace it with yours: "


def give_mark(gradebook: Path, submission: str, criterion: str, points: str, by: str, comment: str, warn: Warn) -> str:
    """Add a manual mark and return the student's new score. Raises InputError."""
    with Gradebook(gradebook) as book:
        grades = Grades(book)
        grade = grades.find(submission)
        rubric = grades.rubric(grade.rubric) if grade.rubric else grades.newest_rubric()
        marked = criterion_of(rubric, criterion)
        before = mark(book, grade, marked, read_points(points, marked), by, comment)
        now = grades.find(grade.student.key)
    if before is not None and before.points is not None:
        warn(f"this replaces the newest mark of {marked.id}: {mark_text(before)}")
    rest = f"; needs manual grading: {counted_points(now.pending)}" if now.pending else ""
    return printable(f"{now.student.key}: {format_points(now.score)} of {format_points(now.out_of)} points{rest}")


def review(gradebook: Path, criterion: str, by: str, terminal: Terminal) -> str:
    """Show what needs manual grading, one criterion of a student after the other, and mark it; return a summary."""
    with Gradebook(gradebook) as book:
        grades = Grades(book, answers=True)
        if criterion:
            criterion_of(grades.newest_rubric(), criterion)
        queue = manual_grading_queue(grades, criterion)
        given = 0
        for number, item in enumerate(queue, 1):
            found = pending_criterion(grades, item)
            if found is None:  # somebody else has marked it meanwhile
                continue
            page = partial(render_pending, found, f"{number} of {len(queue)}")
            terminal.show(draw(page, terminal.screen()))
            count = _ask(grades, found, by, terminal)
            if count is None:
                break
            given += count
        left = len(manual_grading_queue(grades, criterion))
    return f"{given} marked, {left} left\n" if queue else "nothing needs manual grading\n"


def _ask(grades: Grades, item: PendingCriterion, by: str, terminal: Terminal) -> int | None:
    """Ask until there is a valid answer; return the number of marks given, None to stop."""
    criterion = item.result.criterion
    prompt = f"points, 0 to {format_points(criterion.points)} (? for help): "
    while (line := terminal.ask(prompt)) is not None:
        answer, _, comment = line.strip().partition(" ")
        match answer.lower():
            case "q" | "quit":
                return None
            case "s" | "skip" | "":
                return 0
        try:
            points = read_points(answer, criterion) if answer != "?" else None
        except InputError as error:
            terminal.warn(str(error))
            continue
        if points is not None:
            return _mark(grades, item, points, by, comment.strip(), terminal)
        terminal.warn(_HELP)
    return None


def _mark(
    grades: Grades, item: PendingCriterion, points: Decimal, by: str, comment: str, terminal: Terminal
) -> int | None:
    """Add a mark, unless the person keeps that of somebody else; return the number of marks given, None to stop."""
    shown = item.newest
    while True:
        try:
            mark(grades.book, item.grade, item.result.criterion, points, by, comment, shown=shown)
        except NewerMarkError as error:
            shown = error.mark.id
            terminal.warn(f"somebody has marked this since it was shown: {mark_text(error.mark)}")
        else:
            return 1
        answer = _ask_to_keep(terminal)
        if answer != "r":
            return 0 if answer else None


def _ask_to_keep(terminal: Terminal) -> str:
    """Return `k` to keep the newer mark, `r` to replace it; empty to stop."""
    while (line := terminal.ask(_KEEP)) is not None:
        if line.strip().lower() in ("k", "keep", "r", "replace"):
            return line.strip().lower()[0]
    return ""
