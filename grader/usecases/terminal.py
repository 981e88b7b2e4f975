"""What a use case prints with, and reads a line: the command passes it."""

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from grader.report.screen import Screen

if TYPE_CHECKING:
    from grader.classroom.run.progress import Progress

Warn = Callable[[str], None]
_PASSES = ("grading", "searching hints", "writing reports")
ShowFile = Callable[[str], None]  # shows the file that is being read, and nothing for an empty path
# Shows the progress of a pass over a class, whose work is named.
ShowClass = Callable[[str], AbstractContextManager[Callable[["Progress"], None]]]


class Terminal(NamedTuple):
    """The terminal of a command.

    `ask` prints a prompt and returns the line that is typed, None at the end of the input. `screen` is called before
    each use, because a terminal can be resized.
    """

    print: Callable[[str], None]
    warn: Warn
    screen: Callable[[], Screen]
    ask: Callable[[str], str | None]
    show_file: ShowFile
    show_class: ShowClass


@contextmanager
def one_total(terminal: Terminal, size: int) -> Iterator[Terminal]:
    """Yield a terminal that shows the passes over a class of some size as one; a pass that is not needed is done."""
    with terminal.show_class("grading and reports") as show:

        def part(work: str) -> AbstractContextManager[Callable[["Progress"], None]]:
            end, total = size * (_PASSES.index(work) + 1), size * len(_PASSES)
            return nullcontext(lambda one: show(replace(one, total=total, graded=one.graded + end - one.total)))

        yield terminal._replace(show_class=part)
