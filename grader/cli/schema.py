"""grader schema: the JSON Schemas of what the grader reads and writes."""

from enum import StrEnum
from typing import Annotated

import typer

from grader.usecases.writing import write_stdout


class SchemaName(StrEnum):
    """The outputs and inputs that have a schema."""

    REPORT = "report"
    RUBRIC = "rubric"
    INSPECT = "inspect"
    CLASS = "class"
    DIFF = "diff"


def schema(
    name: Annotated[SchemaName, typer.Argument(metavar="|".join(SchemaName), help="The schema to print.")],
) -> int:
    """Print a JSON Schema of the grader's input or output.

    These are reports, rubrics, inspections, classes (batch, stats, export json) and diffs.

    Examples:

      grader schema report

      grader schema rubric > rubric.schema.json
    """
    from grader.report.json_data import to_json
    from grader.report.schemas import json_schema

    write_stdout(to_json(json_schema(name.value)))
    return 0
