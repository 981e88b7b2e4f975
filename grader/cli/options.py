"""Options that several commands share."""

from pathlib import Path
from typing import Annotated

import typer

from grader.report.formats import OutputFormat

PartOption = Annotated[
    list[str] | None,
    typer.Option("--part", metavar="ID", help="Grade only this part; repeatable."),
]
RUBRIC_VARIABLE = "GRADER_RUBRIC"
RubricOption = Annotated[
    str, typer.Option(metavar="ID|FILE", envvar=RUBRIC_VARIABLE, help="The rubric: an id or a .toml file.")
]
GradebookOption = Annotated[Path, typer.Option("--gradebook", metavar="FOLDER", help="The gradebook, a folder.")]
MaxSizeOption = Annotated[int, typer.Option(metavar="BYTES", min=1, help="Maximum size of a URDF.")]
AnswersOption = Annotated[
    Path | None, typer.Option("--answers", metavar="FILE", help="The .toml file with the model answers.")
]
ArgOption = Annotated[
    list[str] | None,
    typer.Option("--arg", metavar="NAME=VALUE", help="The value of an argument of a xacro file; repeatable."),
]
ByOption = Annotated[str, typer.Option("--by", metavar="NAME", help="Your name in reports; default: none.")]
FormatOption = Annotated[OutputFormat, typer.Option("--format", help="Output format.")]
