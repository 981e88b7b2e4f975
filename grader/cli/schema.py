"""grader schema: the JSON Schemas of what the grader reads and writes."""

from enum import StrEnum
from typing import Annotated

import typer

from grader.cli.output import emit


class SchemaName(StrEnum):
    """What there is a schema of."""

    REPORT = "report"
    RUBRIC = "rubric"
    INSPECT = "inspect"
    CLASS = "class"
    DIFF = "diff"


def schema(
    name: Annotated[SchemaName, typer.Argument(metavar="|".join(SchemaName), help="Which schema.")],
) -> int:
    """Print a JSON Schema of what the grader writes or reads.

    That is of a report, a rubric, an inspection, a class (batch, stats, export json), or of what a diff says.

    Examples:

      grader schema report

      grader schema rubric > rubric.schema.json
    """
    from grader.grading.keys import rubric_schema
    from grader.report.plain import to_json
    from grader.report.schemas import CLASS_SCHEMA, DIFF_SCHEMA, INSPECT_SCHEMA, REPORT_SCHEMA

    match name:
        case SchemaName.REPORT:
            emit(to_json(REPORT_SCHEMA))
        case SchemaName.INSPECT:
            emit(to_json(INSPECT_SCHEMA))
        case SchemaName.CLASS:
            emit(to_json(CLASS_SCHEMA))
        case SchemaName.DIFF:
            emit(to_json(DIFF_SCHEMA))
        case SchemaName.RUBRIC:
            emit(to_json(rubric_schema()))
    return 0
