"""grader stats and diff: the figures of a class, and whose grade changed between runs."""

from pathlib import Path
from typing import Annotated

import typer

from grader.cli.options import FormatOption, GradebookOption
from grader.cli.terminal import TERMINAL, screen
from grader.report.formats import OutputFormat

_FIRST = "The gradebook, in place of the first argument."
_VERBOSE = "Name all students who need attention (terminal)."


def stats(
    gradebook: GradebookOption,
    verbose: Annotated[bool, typer.Option("--verbose", help=_VERBOSE)] = False,
    output_format: FormatOption = OutputFormat.TERMINAL,
) -> str:
    """Show statistics of a class: grades, mistakes, equal work.

    A grade is the one that is published: after marks, adjustments and the late penalty. The share of a criterion is the
    mean share of its points that students earned.

    Examples:

      grader stats --gradebook lab6-grades

      grader stats --gradebook lab6-grades --format json

    Recipes:

      Who still needs attention, by name: --verbose.

      A criterion that is wrong: fix the rubric, and rerun `grader batch --rubric FILE`.
    """
    from grader.commands.class_figures import class_statistics

    return class_statistics(gradebook, output_format, TERMINAL, verbose=verbose)


def diff(
    gradebooks: Annotated[
        list[Path] | None,
        typer.Argument(metavar="[GRADEBOOK] [GRADEBOOK]", help="A gradebook; of two, the older one first."),
    ] = None,
    gradebook: Annotated[Path | None, typer.Option("--gradebook", metavar="FOLDER", help=_FIRST)] = None,
    before: Annotated[int | None, typer.Option(metavar="RUN", help="The number of the older run.")] = None,
    after: Annotated[int | None, typer.Option(metavar="RUN", help="The number of the newer run.")] = None,
    output_format: FormatOption = OutputFormat.TERMINAL,
) -> str:
    """Show whose grade changed between two runs, and why.

    Compares the last two runs of a gradebook, or two gradebooks. A grade changes with the submission, the rubric, the
    grader, marks, the roster or the deadline. Runs count from 1.

    Examples:

      grader diff lab6-grades

      grader diff --gradebook lab6-grades --before 3 --after 5

      grader diff lab6-monday lab6-grades --format json

    Recipes:

      Whose grade a new rubric changes: rerun `grader batch --rubric FILE`, then compare.

      What changed since the grades were published: --before with the number of that run.
    """
    from grader.commands.class_figures import compare

    books = [gradebook, *(gradebooks or ())] if gradebook is not None else gradebooks or []
    return compare(tuple(books), before, after, output_format, screen())
