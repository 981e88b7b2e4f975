"""grader diff: whose grade changed between two runs, and why."""

from pathlib import Path
from typing import Annotated

import typer

from grader.cli.options import FormatOption
from grader.cli.output import screen
from grader.report.formats import OutputFormat


def diff(
    gradebook: Annotated[Path, typer.Argument(metavar="GRADEBOOK", help="A gradebook.")],
    other: Annotated[Path | None, typer.Argument(metavar="[GRADEBOOK]", help="A newer gradebook.")] = None,
    before: Annotated[int | None, typer.Option("--from", metavar="RUN", help="The number of the older run.")] = None,
    after: Annotated[int | None, typer.Option("--to", metavar="RUN", help="The number of the newer run.")] = None,
    output_format: FormatOption = OutputFormat.TERMINAL,
) -> str:
    """Show whose grade changed between two runs, and why.

    Compares the last two finished runs of a gradebook, or two gradebooks. A grade changes with the submission, the rubric, the grader or
    manual marks; marks that were given after the older run count as changes. If the rubric changed, the output says what
    changed for the criteria concerned. Grades include the late penalty. Runs count from 1.

    Examples:

      grader diff lab6.db

      grader diff before.db after.db --format json

    Recipes:

      What a rubric fix changed: rerun `grader batch`, then compare the last two runs.

      What a resubmission or a manual mark changed: the same command; each student has the reason.
    """
    from grader.usecases.two_gradebooks import diff as compare

    return compare(gradebook, other, before, after, output_format, screen())
