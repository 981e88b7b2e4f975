"""What the commands print on: standard output, and standard error with the progress of a batch."""

import os
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING

from grader.report.screen import Screen, columns
from grader.text import printable, without_commands
from grader.usecases.terminal import Terminal
from grader.usecases.writing import write_stdout

if TYPE_CHECKING:
    from rich.progress import Progress as Bar

    from grader.workers.progress import Progress

_LINE_SECONDS = 10.0


def screen() -> Screen:
    """Return the width and encoding of standard output, and whether it is a terminal."""
    out = sys.stdout
    is_terminal = out is not None and out.isatty()
    width = columns()
    if is_terminal:
        with suppress(OSError):
            width = columns(os.get_terminal_size(out.fileno()).columns)
    return Screen(width, (out.encoding if out is not None else "") or "utf-8", is_terminal)


def warn(message: str) -> None:
    """Write a line to standard error."""
    write_stderr(without_commands(f"grader: {message}") + "\n")


def write_stderr(text: str) -> None:
    """Write to standard error, if it is open."""
    if sys.stderr is not None:
        with suppress(OSError):
            sys.stderr.write(text)
            sys.stderr.flush()


class TransientLine:
    """A line on standard error that the next text replaces; nothing unless that is a terminal."""

    def __init__(self) -> None:
        self._width = 0

    def show(self, path: str) -> None:
        """Show which file is being read; for an empty path remove the line."""
        if sys.stderr is None or not sys.stderr.isatty():
            return
        text = f"grader: reading {printable(path)}"[: columns() - 1] if path else ""
        if text or self._width:
            write_stderr(without_commands(f"\r{' ' * self._width}\r{text}"))
        self._width = len(text)


@contextmanager
def show_class(work: str) -> Iterator[Callable[["Progress"], None]]:
    """Show the progress of a pass over a class, whose work is named; yields the function that receives it.

    It is a bar on a terminal, else a line every ten seconds.
    """
    began = last_line = time.monotonic()

    def print_line(progress: "Progress") -> None:
        nonlocal last_line
        now = time.monotonic()
        if now - last_line > _LINE_SECONDS:
            last_line = now
            warn(_line(progress, now - began))

    if sys.stderr is None or not sys.stderr.isatty():
        yield print_line
        return
    with _bar() as bar:
        task = bar.add_task(work, total=None, rate="", found="", visible=False)  # until the total is known

        def move(progress: "Progress") -> None:
            rate = f"{progress.done / max(1e-3, time.monotonic() - began):.0f}/s"
            bar.update(
                task,
                total=progress.total,
                completed=progress.done,
                rate=rate,
                found=", ".join(_faults(progress)),
                visible=True,
                refresh=not progress.done,  # a short pass would end before its start is drawn
            )

        yield move


def _bar() -> "Bar":
    from rich import progress
    from rich.console import Console
    from rich.table import Column

    shown = (
        progress.TextColumn("{task.description}"),
        progress.BarColumn(None, table_column=Column(ratio=1)),  # the space that the other columns leave
        progress.MofNCompleteColumn(),
        progress.TextColumn("{task.fields[rate]}"),
        progress.TimeRemainingColumn(),
        progress.TextColumn("{task.fields[found]}"),
    )
    return progress.Progress(*shown, console=Console(stderr=True), transient=True, expand=True)


def _faults(progress: "Progress") -> list[str]:
    """Return how many are errored and unreadable: 80 columns have no room for more beside the bar."""
    return _counts((progress.errored, "errored"), (progress.unreadable, "unreadable"))


def _counts(*counts: tuple[int, str]) -> list[str]:
    return [f"{count} {status}" for count, status in counts if count]


def _line(progress: "Progress", seconds: float) -> str:
    rate = progress.done / seconds if seconds else 0.0
    left = (progress.total - progress.done) / rate if rate else 0.0
    counts = ", ".join([*_faults(progress), *_counts((progress.unchanged, "unchanged"))])
    time_left = f"{left:.0f} s" if left < 100 else f"{left / 60:.0f} min"
    return f"{progress.done} of {progress.total}, {rate:.0f}/s, {time_left} left{f' ({counts})' if counts else ''}"


TERMINAL = Terminal(write_stdout, warn, screen, TransientLine().show, show_class)
