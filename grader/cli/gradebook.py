"""grader gradebook: merge the marks of two gradebooks."""

import io
import sys
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from grader.cli.output import TERMINAL
from grader.usecases.writing import write_stdout

_HELP = """Merge the manual marks of two gradebooks.

Examples:

  grader gradebook merge lab6.db lab6-lee.db
"""
gradebook = typer.Typer(help=_HELP, no_args_is_help=True)


class Keep(StrEnum):
    """Whose marks count in a conflict."""

    FIRST = "first"
    SECOND = "second"


@gradebook.callback()
def _group() -> None:
    """Make typer treat the only command of the group as a command."""


@gradebook.command("merge")
def merge(
    first: Annotated[Path, typer.Argument(metavar="A", help="The gradebook that gets the marks.")],
    second: Annotated[
        Path, typer.Argument(metavar="B", help="The gradebook whose marks are added; it does not change.")
    ],
    keep: Annotated[
        Keep | None, typer.Option("--keep", help="Whose marks count in every conflict: those of A or B.")
    ] = None,
) -> int:
    """Add the manual marks of gradebook B to gradebook A.

    Use it if two people have graded in copies of one gradebook. Marks that only B has are added. It is a conflict if both
    gradebooks have new, different marks of the same criterion and student. The command then lists both marks and asks which one
    counts; A keeps both. Students are matched by their key, else by their ids.

    Exit codes: 0 everything is merged; 1 a conflict is not decided, or a student of B is not in A; 2 wrong usage.

    Examples:

      grader gradebook merge lab6.db lab6-lee.db

      grader gradebook merge lab6.db lab6-lee.db --keep first
    """
    from grader.usecases.two_gradebooks import merge_gradebooks

    if isinstance(sys.stdin, io.TextIOWrapper):
        sys.stdin.reconfigure(errors="backslashreplace")  # a terminal in another encoding
    text, code = merge_gradebooks(first, second, keep.value if keep else None, TERMINAL)
    write_stdout(text)
    return code
