"""grader bundle: the grader and a rubric in one file, for a grading platform."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from grader.cli.options import DEFAULT_RUBRIC, RubricOption
from grader.usecases.writing import write_stdout


class Platform(StrEnum):
    """The platforms with bundles."""

    GRADESCOPE = "gradescope"


def bundle(
    platform: Annotated[Platform, typer.Argument(metavar="PLATFORM", help="The platform: gradescope.")],
    output: Annotated[Path, typer.Argument(metavar="OUT.zip", help="The file to write.")],
    rubric: RubricOption = DEFAULT_RUBRIC,
) -> int:
    """Write an autograder zip for Gradescope.

    Upload it to Gradescope: it installs the grader there and grades submissions against the rubric.

    Examples:

      grader bundle gradescope autograder.zip

      grader bundle gradescope autograder.zip --rubric my_lab.toml
    """
    from grader.usecases.bundle import write_bundle

    write_stdout(write_bundle(platform.value, output, rubric))
    return 0
