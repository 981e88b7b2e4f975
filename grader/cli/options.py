"""Options that several commands share."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from grader.cli.suggestions import rubric_ids

DEFAULT_RUBRIC = "lab6"


class ClassFormat(StrEnum):
    """The formats of what there is to say of a class."""

    TERMINAL = "terminal"
    JSON = "json"


class Layout(StrEnum):
    """How a class folder is laid out."""

    AUTO = "auto"
    FOLDERS = "folders"
    CANVAS = "canvas"
    MOODLE = "moodle"
    TEAMS = "teams"
    NBGRADER = "nbgrader"


RubricOption = Annotated[
    str, typer.Option(metavar="ID|FILE", help="The rubric: an id or a .toml file.", autocompletion=rubric_ids)
]
GradebookOption = Annotated[Path, typer.Option("--gradebook", metavar="FILE", help="The gradebook, a SQLite file.")]
MaxSizeOption = Annotated[int, typer.Option(metavar="BYTES", min=1, help="The largest URDF that is read.")]
DueOption = Annotated[
    str | None, typer.Option("--due", metavar="TIME", help="When it was due, as 2026-11-20T23:59+01:00.")
]
FormatOption = Annotated[ClassFormat, typer.Option("--format", help="The format on standard output.")]
