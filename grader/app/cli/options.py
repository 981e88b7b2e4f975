"""Options that several commands share."""

import os
from pathlib import Path
from typing import Annotated, Any

import typer

from grader.base.errors import InputError
from grader.base.text import enumerated, printable_path
from grader.report.formats import OutputFormat

PartOption = Annotated[
    list[str] | None,
    typer.Option(
        "--part",
        metavar="ID",
        help="Grade only this part; repeatable.",
    ),
]
RUBRIC_VARIABLE = "GRADER_RUBRIC"


def rubric_option(text: str, *, shows_default: bool = False) -> Any:
    """Return the option --rubric with a help text."""
    return typer.Option(
        metavar="ID|FILE",
        envvar=RUBRIC_VARIABLE,
        help=text,
        show_default=shows_default,
    )


RubricOption = Annotated[
    str, rubric_option("The rubric: an id or a .toml file.", shows_default=True)
]
_GRADEBOOK = "The gradebook; default: the only one in the current folder."
_NOT_NAMED = Path("*")  # no folder is searched for --help


def only_gradebook(named: Path = _NOT_NAMED) -> Path:
    """Return the gradebook that is named, else the only one in the current folder.

    Raises InputError.
    """
    if named != _NOT_NAMED or os.environ.get("_GRADER_COMPLETE"):  # which looks for it itself
        return named
    from grader.classroom.marks.gradebook_folder import CLASS_FILE

    folders = sorted(file.parent for file in Path().glob(f"*/{CLASS_FILE}"))
    if len(folders) == 1:
        return folders[0]
    if folders:
        raise InputError(
            f"name one with --gradebook: {enumerated([*map(printable_path, folders)], 10, 'or')}"
        )
    raise InputError(
        "there is no gradebook here: name one with --gradebook; `grader batch PATH` makes it"
    )


_ONLY: Any = {
    "default_factory": lambda: _NOT_NAMED,
    "callback": only_gradebook,
    "show_default": False,
}
GradebookOption = Annotated[
    Path, typer.Option("--gradebook", metavar="FOLDER", help=_GRADEBOOK, **_ONLY)
]
MaxSizeOption = Annotated[int, typer.Option(metavar="BYTES", min=1, help="Maximum size of a URDF.")]
AnswersOption = Annotated[
    Path | None,
    typer.Option("--answers", metavar="FILE", help="The .toml file with the model answers."),
]
ArgOption = Annotated[
    list[str] | None,
    typer.Option(
        "--arg", metavar="NAME=VALUE", help="The value of an argument of a xacro file; repeatable."
    ),
]
SaveOption = Annotated[
    list[str] | None,
    typer.Option(
        "--save", metavar="FORMAT=FILE", help="Also write a report to a file; repeatable."
    ),
]
ByOption = Annotated[
    str, typer.Option("--by", metavar="NAME", help="Your name in reports; default: none.")
]
PortOption = Annotated[
    int,
    typer.Option(
        "--port",
        metavar="N",
        min=0,
        max=65535,
        show_default=False,
        help="The port of the page; default: any free port.",
    ),
]
NoBrowserOption = Annotated[bool, typer.Option("--no-browser", help="Only print the address.")]
FormatOption = Annotated[OutputFormat, typer.Option("--format", help="Output format.")]
