"""Options that several commands share."""

import os
from pathlib import Path
from typing import Annotated, Any

from typer import Option

from grader.base.errors import InputError
from grader.base.text import enumerated, printable_path
from grader.report.formats import OutputFormat
from grader.ros.api import Release

PartOption = Annotated[
    list[str] | None,
    Option(
        "--part",
        metavar="ID",
        help="Grade only this part; repeatable.",
    ),
]
RUBRIC_VARIABLE = "GRADER_RUBRIC"


def rubric_option(text: str, *, shows_default: bool = False) -> Any:
    """Return the option --rubric with a help text."""
    return Option(
        metavar="ID|FILE",
        envvar=RUBRIC_VARIABLE,
        help=text,
        show_default=shows_default,
    )


RubricOption = Annotated[
    str, rubric_option("The rubric: an id or a .toml file.", shows_default=True)
]
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
            f"name one with --gradebook: {enumerated(map(printable_path, folders), 10, 'or')}"
        )
    raise InputError(
        "there is no gradebook here: name one with --gradebook; `grader batch PATH` makes it"
    )


_ONLY = {
    "default_factory": lambda: _NOT_NAMED,
    "callback": only_gradebook,
    "show_default": False,
}
GradebookOption = Annotated[
    Path,
    Option(
        "--gradebook",
        metavar="FOLDER",
        help="The gradebook; default: the only one in the current folder.",
        **_ONLY,
    ),
]
MaxSizeOption = Annotated[int, Option(metavar="BYTES", min=1, help="Maximum size of a URDF.")]
AnswersOption = Annotated[
    Path | None,
    Option("--answers", metavar="FILE", help="The .toml file with the model answers."),
]
LogOption = Annotated[
    str | None,
    Option(
        "--log",
        metavar="FILE",
        help="Explain this log, or a folder of logs; - for a pipe, which is passed on.",
    ),
]
ArgOption = Annotated[
    list[str] | None,
    Option(
        "--arg", metavar="NAME=VALUE", help="The value of an argument of a xacro file; repeatable."
    ),
]
DistroOption = Annotated[
    Release | None,
    Option(
        metavar="NAME",
        help="The release of ROS 2, such as humble; default: what the files state.",
    ),
]
SaveOption = Annotated[
    list[str] | None,
    Option("--save", metavar="FORMAT=FILE", help="Also write a report to a file; repeatable."),
]
ByOption = Annotated[
    str, Option("--by", metavar="NAME", help="Your name in reports; default: none.")
]
PortOption = Annotated[
    int,
    Option(
        "--port",
        metavar="N",
        min=0,
        max=65535,
        show_default=False,
        help="The port of the page; default: any free port.",
    ),
]
NoBrowserOption = Annotated[bool, Option("--no-browser", help="Only print the address.")]
FormatOption = Annotated[OutputFormat, Option("--format", help="Output format.")]
