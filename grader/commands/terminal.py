"""What a use case prints with: the command passes it."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, NamedTuple

from grader.report.screen import Screen

if TYPE_CHECKING:
    from grader.classroom.workers.queue import Progress

Warn = Callable[[str], None]
# Shows the progress of a pass over a class, whose work is named.
ShowClass = Callable[[str], AbstractContextManager[Callable[["Progress"], None]]]


class Terminal(NamedTuple):
    """The terminal of a command.

    `screen` is called before each use, because a terminal can be resized.
    """

    print: Callable[[str], None]
    warn: Warn
    screen: Callable[[], Screen]
    show_class: ShowClass
