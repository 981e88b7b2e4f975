"""grader explain: a problem code, a check or a criterion."""

from typing import Annotated

import typer

from grader.cli.options import RubricOption, explainable
from grader.usecases import DEFAULT_RUBRIC

_NAME = "For example URDF051, frame_at or lidar-frame."


def explain(
    name: Annotated[str, typer.Argument(metavar="CODE|CHECK|CRITERION", help=_NAME, autocompletion=explainable)],
    rubric: RubricOption = DEFAULT_RUBRIC,
) -> str:
    """Explain a problem code, a check or a criterion.

    Examples:

      grader explain lidar-frame

      grader explain URDF051

      grader explain my-criterion --rubric my_lab.toml
    """
    from grader.grading.rubric import load_rubric
    from grader.report.rubrics import explanation

    return explanation(name, load_rubric(rubric))
