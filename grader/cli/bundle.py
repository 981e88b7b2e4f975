"""grader bundle: the grader and a rubric in one file, for a grading platform."""

from pathlib import Path
from typing import Annotated, Literal

import typer

from grader.cli.options import RubricOption
from grader.usecases import DEFAULT_RUBRIC


def bundle(
    platform: Annotated[Literal["gradescope"], typer.Argument(metavar="PLATFORM", help="The platform: gradescope.")],
    output: Annotated[Path, typer.Argument(metavar="OUT.zip", help="The file to write.")],
    rubric: RubricOption = DEFAULT_RUBRIC,
) -> str:
    """Write an autograder zip for Gradescope.

    Upload it to Gradescope: it installs the grader there and grades submissions against the rubric.

    Examples:

      grader bundle gradescope autograder.zip

      grader bundle gradescope autograder.zip --rubric my_lab.toml
    """
    from grader.usecases.bundle import write_bundle

    return write_bundle(platform, output, rubric)
