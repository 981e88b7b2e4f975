"""grader without a command: version, help, completion."""

from typing import Annotated

import typer

from grader import __version__
from grader.cli.suggestions import shells
from grader.usecases.writing import write_stdout


def _print_version(is_given: bool) -> None:
    if is_given:
        write_stdout(f"grader {__version__}\n")
        raise typer.Exit


def root(
    version: Annotated[
        bool,
        typer.Option("--version", "-V", help="Print the version and exit.", callback=_print_version, is_eager=True),
    ] = False,
    show_completion: Annotated[
        str | None,
        typer.Option(metavar="[SHELL]", help="Print the completion script for a shell.", autocompletion=shells),
    ] = None,
    install_completion: Annotated[
        str | None,
        typer.Option(metavar="[SHELL]", help="Install the completion script.", autocompletion=shells),
    ] = None,
) -> None:
    """Grade robotics lab submissions: URDF, forward kinematics, ROS 2 package.

    Students start with grade, instructors with rubric show and batch. Each command describes its arguments under --help, with
    examples.

    Examples:

      grader grade my_robot.urdf

      grader rubric show lab6

      grader batch submissions.zip --gradebook lab6.db
    """
