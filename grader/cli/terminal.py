"""The terminal that commands are given."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING

from grader.cli.output import TransientLine, ask, screen, warn
from grader.usecases import Terminal
from grader.usecases.writing import write_stdout

if TYPE_CHECKING:
    from grader.classroom.run.batch import Progress


def class_progress(work: str) -> AbstractContextManager[Callable[["Progress"], None]]:
    """Show the progress of a pass over a class."""
    from grader.cli.progress import progress_display  # late: most commands have none

    return progress_display(work)


TERMINAL = Terminal(write_stdout, warn, screen, ask, TransientLine().show, class_progress)
