"""grader rubric: what rubrics there are, what is in them, and whether one is right."""

from typing import Annotated

import typer

from grader.cli.output import emit
from grader.errors import RubricError

rubric = typer.Typer(help="List, show and check rubrics, and the checks that they can name.", no_args_is_help=True)


@rubric.command("list")
def list_rubrics() -> int:
    """List the rubrics that come with the grader."""
    from grader.grading.rubric import load_rubric, shipped_rubrics
    from grader.report.points import points_words

    for name in shipped_rubrics():
        rules = load_rubric(name)
        emit(f"{rules.id}  {rules.title} ({len(rules.criteria)} criteria, {points_words(rules.points)} points)\n")
    return 0


@rubric.command("show")
def show_rubric(
    name: Annotated[str, typer.Argument(metavar="ID|FILE", help="The rubric: an id or a .toml file.")],
) -> int:
    """Show a rubric: its parts and criteria with their points."""
    from grader.grading.rubric import load_rubric
    from grader.report.rubrics import rubric_text

    emit(rubric_text(load_rubric(name)))
    return 0


@rubric.command("checks")
def list_checks() -> int:
    """List the checks that a rubric can name, with what they state and the arguments that they take."""
    from grader.report.rubrics import checks_text

    emit(checks_text())
    return 0


@rubric.command("check")
def check_rubric(
    file: Annotated[str, typer.Argument(metavar="FILE", help="A .toml file, or the id of a rubric.")],
) -> int:
    """Check a rubric and its reference solution: exits 2 and names every mistake, each with its line."""
    from grader.grading.reference import grade_reference
    from grader.grading.rubric import load_rubric
    from grader.report.points import points_words
    from grader.report.text import printable

    rules = load_rubric(file)
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
