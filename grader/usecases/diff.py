"""Compare two runs of a gradebook, or two gradebooks."""

from contextlib import ExitStack
from functools import partial
from pathlib import Path

from grader.classroom.gradebook.changes import changes, last_two, newest
from grader.classroom.gradebook.gradebook import Gradebook
from grader.errors import GraderError
from grader.report.changes import render_changes, render_changes_json
from grader.report.formats import OutputFormat
from grader.report.screen import Screen, draw


def diff(
    gradebook: Path, other: Path | None, before: int | None, after: int | None, kind: OutputFormat, screen: Screen
) -> str:
    """Return whose grade changed between two runs, by how much, and why. Raises GraderError."""
    if other is not None and (before or after):
        raise GraderError("--from and --to choose runs of one gradebook: give one gradebook, or omit them")
    with ExitStack() as opened:
        book = opened.enter_context(Gradebook(gradebook))
        if other is None:
            sides = last_two(book, before, after)
        else:
            sides = newest(book), newest(opened.enter_context(Gradebook(other)))
        found = changes(*sides)
        runs = sides[0].newest_run, sides[1].newest_run
    if kind is OutputFormat.JSON:
        return render_changes_json(found, runs)
    return draw(partial(render_changes, found, runs), screen)
