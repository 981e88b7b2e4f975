"""The work of each command, without typer and without printing: the command passes the functions that print."""

from collections.abc import Callable
from typing import NamedTuple

from grader.report.screen import Screen

DEFAULT_RUBRIC = "lab6"  # of the command line
Warn = Callable[[str], None]
Progress = Callable[[str], None]  # shows the file that is being read, and nothing for an empty path


class Terminal(NamedTuple):
    """The terminal of an interactive command.

    `ask` prints a prompt and returns the line that is typed, None at the end of the input. `screen` is called before each use,
    because a terminal can be resized.
    """

    show: Callable[[str], None]
    warn: Warn
    screen: Callable[[], Screen]
    ask: Callable[[str], str | None]
    show_progress: Progress
