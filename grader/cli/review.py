"""grader review: walk through what waits for a person, one by one."""

import io
import sys
from typing import TYPE_CHECKING, Annotated

import typer

from grader.cli.mark import ByOption
from grader.cli.options import GradebookOption
from grader.cli.output import complain, emit, show
from grader.errors import InputError

if TYPE_CHECKING:
    from decimal import Decimal

    from grader.classroom.gradebook.grades import Grades
    from grader.classroom.gradebook.marks import PendingCriterion

_KEEP = "k to keep that mark, r to replace it with yours: "
_HELP = "points and a comment, or s to skip, q to stop (everything is kept), ? for this line"


def review(
    gradebook: GradebookOption,
    criterion: Annotated[str, typer.Option(metavar="ID", help="Only this criterion.")] = "",
    by: ByOption = "",
) -> int:
    """Walk through what waits for a person, and give it points.

    The answer that was found is shown beside the model answer, and where the pictures are. Type the points and, behind them, a comment: 3.5 the roots are missing. Stop whenever you like: what is given is kept, and
    the next review goes on with the rest.

    Examples:

      grader review --gradebook lab6.db

      grader review --gradebook lab6.db --criterion answer-floating-link
    """
    from grader.classroom.gradebook.gradebook import Gradebook
    from grader.classroom.gradebook.grades import Grades
    from grader.classroom.gradebook.marks import criterion_of, manual_grading_queue, pending_criterion

    if isinstance(sys.stdin, io.TextIOWrapper):
        sys.stdin.reconfigure(errors="backslashreplace")  # a terminal in another encoding
    with Gradebook(gradebook) as book:
        standings = Grades(book, answers=True)
        if criterion:
            criterion_of(standings.newest_rubric(), criterion)
        asked = manual_grading_queue(standings, criterion)
        given = 0
        for number, each in enumerate(asked, 1):
            found = pending_criterion(standings, each)
            if found is None:  # somebody else has decided it meanwhile
                continue
            answer = _ask(standings, found, f"{number} of {len(asked)}", by)
            if answer is None:
                break
            given += answer
        left = len(manual_grading_queue(standings, criterion))
    emit(f"{given} marked, {left} still wait\n" if asked else "nothing waits for a person\n")
    return 0


def _ask(standings: "Grades", pending: "PendingCriterion", place: str, by: str) -> int | None:
    """Ask until there is an answer: how many marks came of it, None to stop."""
    from grader.classroom.gradebook.marks import read_points
    from grader.report.review import render_pending

    show(lambda console: render_pending(pending, place, console))
    criterion = pending.result.criterion
    while (text := _line(f"points, 0 to {format(criterion.points.normalize(), 'f')} (? for help): ")) is not None:
        word, _, comment = text.strip().partition(" ")
        if word.lower() in ("q", "quit"):
            return None
        if word.lower() in ("s", "skip", ""):
            return 0
        if word == "?":
            complain(_HELP)
            continue
        try:
            points = read_points(word, criterion)
        except InputError as error:
            complain(str(error))
            continue
        if points is None:
            complain(_HELP)
            continue
        return _mark(standings, pending, points, by, comment.strip())
    return None


def _mark(standings: "Grades", pending: "PendingCriterion", points: "Decimal", by: str, comment: str) -> int | None:
    """Mark, unless somebody else has meanwhile and their mark is to be kept: how many marks came of it, None to stop."""
    from grader.classroom.gradebook.marks import NewerMarkError, mark
    from grader.report.review import mark_words

    shown = pending.newest
    while True:
        try:
            mark(standings.book, pending.grade, pending.result.criterion, points, by, comment, shown=shown)
        except NewerMarkError as error:
            shown = error.mark.id
            complain(f"somebody has marked this since it was shown: {mark_words(error.mark)}")
        else:
            return 1
        is_kept = _is_kept()
        if is_kept is not False:
            return 0 if is_kept else None


def _is_kept() -> bool | None:
    """Ask whether the newer mark is kept; None to stop."""
    while (typed := _line(_KEEP)) is not None:
        if typed.strip().lower() in ("k", "keep", "r", "replace"):
            return typed.strip().lower().startswith("k")
    return None


def _line(prompt: str) -> str | None:
    """A line that is typed; None where there is no more."""
    emit(prompt)
    try:
        return input()
    except (EOFError, RuntimeError):  # the latter where there is no standard input at all
        return None
