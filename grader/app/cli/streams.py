"""What the commands print on: standard output, and standard error with the progress of a batch."""

import os
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING

from grader.base.text import without_commands
from grader.report.screen import Screen, columns
from grader.report.writing import Terminal, write_stdout

if TYPE_CHECKING:
    from grader.workers.queue import Progress

_LINE_SECONDS, _TERMINAL_SECONDS = 10.0, 0.1


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


@contextmanager
def show_class(work: str) -> Iterator[Callable[["Progress"], None]]:
    """Show the progress of a pass over a class, whose work is named; yields the function that
    receives it.

    It is one line that changes on a terminal, else a line every ten seconds.
    """
    began = last_line = time.monotonic()
    is_terminal = sys.stderr is not None and sys.stderr.isatty()
    pause = _TERMINAL_SECONDS if is_terminal else _LINE_SECONDS
    width = 0

    def replace(text: str) -> None:
        nonlocal width
        write_stderr(without_commands(f"\r{' ' * width}\r{text}"))
        width = len(text)

    def show(progress: "Progress") -> None:
        nonlocal last_line
        now = time.monotonic()
        if now - last_line > pause or (is_terminal and not progress.done):
            last_line = now
            text = _progress_line(progress, now - began)
            if is_terminal:
                replace(f"{work}: {text}"[: columns() - 1])
            else:
                warn(text)

    try:
        yield show
    finally:
        if width:
            replace("")


def _progress_line(progress: "Progress", seconds: float) -> str:
    if not (progress.done and seconds):  # nothing tells the time left
        return f"{progress.done} of {progress.total}"
    rate = progress.done / seconds
    left = (progress.total - progress.done) / rate
    kinds = (progress.errored, "errored"), (progress.unreadable, "unreadable")
    counts = ", ".join(f"{count} {kind}" for count, kind in kinds if count)
    time_left = f"{left:.0f} s" if left < 100 else f"{left / 60:.0f} min"
    return (
        f"{progress.done} of {progress.total}, {rate:.0f}/s, {time_left} "
        f"left{f' ({counts})' if counts else ''}"
    )


TERMINAL = Terminal(write_stdout, warn, screen, show_class)
