"""grader diff: who changed between two runs or gradebooks, by how much, and why."""

from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from grader.cli.options import ClassFormat, FormatOption
from grader.cli.output import emit, show
from grader.errors import GraderError


def diff(
    gradebook: Annotated[
        Path, typer.Argument(metavar="GRADEBOOK", help="A gradebook; its last two runs are compared.")
    ],
    other: Annotated[Path | None, typer.Argument(metavar="[GRADEBOOK]", help="Another, which is the newer.")] = None,
    before: Annotated[int | None, typer.Option("--from", metavar="RUN", help="The number of the older run.")] = None,
    after: Annotated[int | None, typer.Option("--to", metavar="RUN", help="The number of the newer run.")] = None,
    output_format: FormatOption = ClassFormat.TERMINAL,
) -> int:
    """Say whose grade changed between two runs, by how much, and why.

    The last two runs of a gradebook are compared, or two gradebooks. Why is whether the submission, the rubric or the grader changed, or somebody marked by hand: since the older run began, and
    until the run after the newer one did. What being late costs is not in it. Runs count from 1.

    Examples:

      grader diff lab6.db

      grader diff before.db after.db --format json
    """
    from grader.classroom.gradebook.changes import changes, last_two, newest
    from grader.classroom.gradebook.gradebook import Gradebook

    if other is not None and (before or after):
        raise GraderError("--from and --to are runs of one gradebook: name one, or leave them out")
    with ExitStack() as opened:
        book = opened.enter_context(Gradebook(gradebook))
        if other is None:
            sides = last_two(book, before, after)
        else:
            sides = newest(book), newest(opened.enter_context(Gradebook(other)))
        found = changes(*sides)
        runs = sides[0].newest_run, sides[1].newest_run
    if output_format is ClassFormat.JSON:
        from grader.report.changes import render_changes_json

        emit(render_changes_json(found, runs))
        return 0
    from grader.report.changes import render_changes

    show(partial(render_changes, found, runs))
    return 0
