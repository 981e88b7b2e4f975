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


def schema(name: Annotated[SchemaName, typer.Argument(help="Which schema.")]) -> int:
    """Print a JSON Schema: of a report, of a rubric, or of an inspection."""
    from grader.report.plain import to_json
    from grader.report.schemas import INSPECT_SCHEMA, REPORT_SCHEMA, rubric_schema

    match name:
        case SchemaName.REPORT:
            emit(to_json(REPORT_SCHEMA))
        case SchemaName.INSPECT:
            emit(to_json(INSPECT_SCHEMA))
        case SchemaName.RUBRIC:
            emit(to_json(rubric_schema()))
    return 0
