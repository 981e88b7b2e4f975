"""grader rubric: what rubrics there are, what is in them, and whether one is right."""

from typing import TYPE_CHECKING, Annotated

import typer

from grader.cli.output import complain, emit
from grader.cli.suggestions import rubric_ids
from grader.errors import RubricError

if TYPE_CHECKING:
    from grader.grading.rubric import Rubric

_HELP = """List, show and check rubrics, and the checks that they can name.

Examples:

  grader rubric list

  grader rubric show lab6

  grader rubric check my_lab.toml
"""
rubric = typer.Typer(help=_HELP, no_args_is_help=True)

RubricArgument = Annotated[
    str,
    typer.Argument(metavar="ID|FILE", help="The rubric: an id or a .toml file.", autocompletion=rubric_ids),
]


@rubric.command("list")
def list_rubrics() -> int:
    """List the rubrics that come with the grader.

    Examples:

      grader rubric list
    """
    from grader.grading.rubric import load_rubric, shipped_rubrics
    from grader.report.points import points_words

    for name in shipped_rubrics():
        rules = load_rubric(name)
        emit(f"{rules.id}  {rules.title} ({len(rules.criteria)} criteria, {points_words(rules.points)} points)\n")
    return 0


@rubric.command("show")
def show_rubric(
    name: RubricArgument,
    answers: Annotated[bool, typer.Option("--answers", help="Also show the model answers.")] = False,
) -> int:
    """Show a rubric: its parts and criteria with their points.

    Examples:

      grader rubric show lab6

      grader rubric show lab6 --answers

      grader rubric show my_lab.toml
    """
    from grader.grading.rubric import load_rubric
    from grader.report.rubrics import rubric_text

    emit(rubric_text(_with_answers(name) if answers else load_rubric(name)))
    return 0


@rubric.command("checks")
def list_checks() -> int:
    """List the checks that a rubric can name, with their arguments.

    Of each it says what it states; grader explain says more of one.

    Examples:

      grader rubric checks
    """
    from grader.report.rubrics import checks_text

    emit(checks_text())
    return 0


@rubric.command("check")
def check_rubric(
    file: RubricArgument,
) -> int:
    """Check a rubric and its reference solution.

    Exits 2 and names every mistake, each with its line.

    Examples:

      grader rubric check my_lab.toml
    """
    from grader.grading.grade import grade_reference
    from grader.report.points import points_words
    from grader.text import printable

    rules = _with_answers(file)
    summary = f"{rules.id}: {len(rules.criteria)} criteria, {points_words(rules.points)} points, no mistakes found"
    if rules.reference:
        report = grade_reference(rules)
        lost = [each for each in report.results if each.outcome.status not in ("passed", "pending")]
        if lost:
            raise RubricError(
                tuple(
                    printable(f"the reference does not get {each.criterion.id}: {each.outcome.message}")
                    for each in lost
                )
            )
        summary += "; its reference gets full marks"
    emit(summary + "\n")
    return 0


def _with_answers(name: str) -> "Rubric":
    """The rubric with its model answers; says so on standard error where their file is not there."""
    from grader.grading.answers import load_with_answers, missing_answers

    rules = load_with_answers(name)
    if missing_answers(rules):
        complain(missing_answers(rules))
    return rules
