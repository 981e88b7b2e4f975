"""grader rubric: list, show and check rubrics."""

from typing import Annotated

import typer

from grader.cli.options import rubric_ids
from grader.cli.output import warn
from grader.usecases import rubrics

_HELP = """List, show and check rubrics, and list the checks.

Examples:

  grader rubric list

  grader rubric show lab6

  grader rubric check my_lab.toml
"""
rubric = typer.Typer(help=_HELP, no_args_is_help=True)
RubricArgument = Annotated[
    str, typer.Argument(metavar="ID|FILE", help="The rubric: an id or a .toml file.", autocompletion=rubric_ids)
]


@rubric.command("list")
def list_rubrics() -> str:
    """List the rubrics that come with the grader.

    Examples:

      grader rubric list
    """
    return rubrics.listed()


@rubric.command("show")
def show_rubric(
    name: RubricArgument,
    answers: Annotated[bool, typer.Option("--answers", help="Also show the model answers.")] = False,
) -> str:
    """Show the parts and criteria of a rubric with their points.

    Examples:

      grader rubric show lab6

      grader rubric show lab6 --answers

      grader rubric show my_lab.toml
    """
    from grader.report.rubrics import rubric_text

    return rubric_text(rubrics.load(name, warn, answers=answers))


@rubric.command("checks")
def list_checks() -> str:
    """List the checks for rubrics, with their arguments.

    `grader explain` describes one of them in detail.

    Examples:

      grader rubric checks
    """
    from grader.report.rubrics import checks_text

    return checks_text()


@rubric.command("check")
def check_rubric(file: RubricArgument) -> str:
    """Check a rubric and its reference solution.

    Exits 2 if there are mistakes, and lists all of them with their lines.

    Examples:

      grader rubric check my_lab.toml
    """
    return rubrics.check(file, warn) + "\n"
