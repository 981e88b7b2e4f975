"""grader explain: more about a problem's code, a check, or a criterion."""

from typing import Annotated

import typer

from grader.cli.options import DEFAULT_RUBRIC, RubricOption
from grader.cli.output import emit
from grader.cli.suggestions import explainable


def explain(
    name: Annotated[
        str,
        typer.Argument(
            metavar="CODE|CHECK|CRITERION",
            help="Such as URDF051, frame_at or lidar-frame.",
            autocompletion=explainable,
        ),
    ],
    rubric: RubricOption = DEFAULT_RUBRIC,
) -> int:
    """Say more about a problem's code, a check, or a criterion.

    Examples:

      grader explain lidar-frame

      grader explain URDF051

      grader explain my-criterion --rubric my_lab.toml
    """
    from grader.grading.rubric import load_rubric
    from grader.report.rubrics import explanation

    emit(explanation(name, load_rubric(rubric)))
    return 0
