"""Options that several commands share."""

from pathlib import Path
from typing import Annotated

import typer

from grader.cli.suggestions import rubric_ids
from grader.report.formats import OutputFormat

DEFAULT_RUBRIC = "lab6"

RubricOption = Annotated[
    str, typer.Option(metavar="ID|FILE", help="The rubric: an id or a .toml file.", autocompletion=rubric_ids)
]
GradebookOption = Annotated[Path, typer.Option("--gradebook", metavar="FILE", help="The gradebook, a SQLite file.")]
MaxSizeOption = Annotated[int, typer.Option(metavar="BYTES", min=1, help="Maximum size of a URDF.")]
DueOption = Annotated[
    str | None, typer.Option("--due", metavar="TIME", help="The deadline, such as 2026-11-20T23:59+01:00.")
]
ByOption = Annotated[str, typer.Option("--by", metavar="NAME", help="Your name in reports; default: none.")]
FormatOption = Annotated[OutputFormat, typer.Option("--format", help="Output format.")]
