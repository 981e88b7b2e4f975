"""grader schema: the JSON Schemas of what the grader reads and writes."""

from typing import Annotated, Literal, get_args

import typer

SchemaName = Literal["report", "rubric", "inspect", "class", "diff", "rubric-test"]


def schema(
    name: Annotated[SchemaName, typer.Argument(metavar="|".join(get_args(SchemaName)), help="The schema to print.")],
) -> str:
    """Print a JSON Schema of the grader's input or output.

    These are reports, rubrics, inspections, classes (batch, stats, export json), diffs and rubric
    tests.

    Examples:

      grader schema report

      grader schema rubric > rubric.schema.json
    """
    from grader.report.json_data import to_json
    from grader.report.schemas import json_schema

    return to_json(json_schema(name))
