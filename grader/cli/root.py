"""grader without a command: its version, its help, and how a shell comes to complete its commands."""

from typing import Annotated

import typer

from grader import __version__
from grader.cli.output import emit
from grader.cli.suggestions import shells


def _print_version(is_wanted: bool) -> None:
    if is_wanted:
        emit(f"grader {__version__}\n")
        raise typer.Exit


def root(
    version: Annotated[
        bool,
        typer.Option("--version", "-V", help="Print the version and exit.", callback=_print_version, is_eager=True),
    ] = False,
    show_completion: Annotated[
        str | None,
        typer.Option(
            metavar="[SHELL]", help="Print what makes bash, zsh or fish complete commands.", autocompletion=shells
        ),
    ] = None,
    install_completion: Annotated[
        str | None,
        typer.Option(
            metavar="[SHELL]", help="Add that to what your shell reads when it starts.", autocompletion=shells
        ),
    ] = None,
) -> None:
    """Grade robotics lab submissions by what the robot does.

    A student starts with grade, an instructor with rubric show, whoever has a class to grade with batch. What a command takes is said
    by its own --help, with examples.

    Examples:

      grader grade my_robot.urdf

      grader rubric show lab6

      grader batch submissions.zip --gradebook lab6.db
    """
