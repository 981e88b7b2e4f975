"""grader explain: more about a problem's code, a check, or a criterion."""

from typing import Annotated

import typer

from grader.cli.options import DEFAULT_RUBRIC
from grader.cli.output import emit


def explain(
    name: Annotated[
        str, typer.Argument(metavar="CODE|CHECK|CRITERION", help="Such as URDF051, frame_at or lidar-frame.")
    ],
    rubric: Annotated[str, typer.Option(metavar="ID|FILE", help="The rubric of the criterion.")] = DEFAULT_RUBRIC,
) -> int:
    """Say more about a problem's code, a check, or a criterion of a rubric."""
    from grader.grading.rubric import load_rubric
    from grader.report.rubrics import explanation

    emit(explanation(name, load_rubric(rubric)))
    return 0
