"""The work of each command, without typer and without printing: the command passes the functions that print."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, NamedTuple

from grader.report.screen import Screen

if TYPE_CHECKING:
    from grader.classroom.run.batch import Progress as ClassProgress

DEFAULT_RUBRIC = "lab6"  # of the command line
Warn = Callable[[str], None]
Progress = Callable[[str], None]  # shows the file that is being read, and nothing for an empty path
# Shows the progress of a pass over a class, whose work is named.
ProgressDisplay = Callable[[str], AbstractContextManager[Callable[["ClassProgress"], None]]]


class Terminal(NamedTuple):
    """The terminal of a command.

    `ask` prints a prompt and returns the line that is typed, None at the end of the input. `screen` is called before
    each use, because a terminal can be resized.
    """

    show: Callable[[str], None]
    warn: Warn
    screen: Callable[[], Screen]
    ask: Callable[[str], str | None]
    show_progress: Progress
    class_progress: ProgressDisplay
