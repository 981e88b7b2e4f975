"""grader bundle: the grader and a rubric in one file, for a platform that grades what students upload."""

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from grader.cli.options import DEFAULT_RUBRIC, RubricOption
from grader.cli.output import emit
from grader.errors import GraderError
from grader.usecases.writing import save_bytes

if TYPE_CHECKING:
    from grader.grading.rubric import Rubric


class Platform(StrEnum):
    """Where a bundle is used."""

    GRADESCOPE = "gradescope"


def bundle(
    platform: Annotated[Platform, typer.Argument(metavar="PLATFORM", help="Where the bundle is used: gradescope.")],
    output: Annotated[Path, typer.Argument(metavar="OUT.zip", help="The file that is written.")],
    rubric: RubricOption = DEFAULT_RUBRIC,
) -> int:
    """Write an autograder for Gradescope, in one zip.

    You upload it there: it installs the grader, and grades what students hand in by one rubric.

    Examples:

      grader bundle gradescope autograder.zip

      grader bundle gradescope autograder.zip --rubric my_lab.toml
    """
    from grader.bundle.gradescope import autograder_zip
    from grader.grading.rubric import load_rubric

    if output.suffix.lower() != ".zip":
        raise GraderError(f"{platform.value} takes a zip: give a name that ends in .zip, not {str(output)!r}")
    rules = load_rubric(rubric)
    save_bytes(output, autograder_zip(rules))
    emit(_next_step(rules, output))
    return 0


def _next_step(rubric: "Rubric", output: Path) -> str:
    from decimal import Decimal

    from grader.checks.manual import MANUAL_CHECKS
    from grader.report.points import points_words
    from grader.text import printable

    by_hand = [each for each in rubric.criteria if each.check.function in MANUAL_CHECKS]
    points = sum((each.points for each in by_hand), Decimal(0))
    listed = ", ".join(f"{each.id} ({points_words(each.points)})" for each in by_hand)
    step = f"upload it under Configure Autograder; autograder points: {points_words(rubric.points - points)}"
    if by_hand:
        step += f"; points that a person gives: {points_words(points)} for {listed}"
    title = f"{rubric.title}, {len(rubric.criteria)} criteria, {points_words(rubric.points)} points"
    return printable(f"wrote {output}: {title}") + "\n" + printable(f"next: {step}") + "\n"
