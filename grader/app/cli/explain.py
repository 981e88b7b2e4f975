"""grader explain and grader schema.

They print what codes and checks mean, and what the files of the grader hold.
"""

from typing import Annotated, Literal, get_args

from typer import Argument

from grader.app.cli.options import RubricOption
from grader.lab.rubric.rubric_files import DEFAULT_RUBRIC


def explain(
    name: Annotated[
        str,
        Argument(
            metavar="CODE|CHECK|CRITERION|PARAMETER",
            help="For example URDF051, frame_at, lidar-frame, ekf_node.frequency or releases.",
        ),
    ],
    rubric: RubricOption = DEFAULT_RUBRIC,
) -> str:
    """Explain a code, a check, a criterion, a parameter, or releases.

    Examples:

      grader explain lidar-frame

      grader explain releases

      grader explain URDF051

      grader explain my-criterion --rubric my_lab.toml
    """
    from grader.lab.rubric.rubric import load_rubric
    from grader.report.explanations import explanation

    return explanation(name, load_rubric(rubric))


SchemaName = Literal["report", "rubric", "inspect", "graph", "class", "diff", "rubric-test"]


def schema(
    name: Annotated[
        SchemaName,
        Argument(metavar="|".join(get_args(SchemaName)), help="The schema to print."),
    ],
) -> str:
    """Print a JSON Schema of the grader's input or output.

    These are reports, rubrics, inspections, graphs, classes (batch, stats, export json), diffs and
    rubric tests.

    Examples:

      grader schema report

      grader schema rubric > rubric.schema.json
    """
    from grader.app.commands.schemas import json_schema
    from grader.report.json_data import to_json

    return to_json(json_schema(name))
