"""Where a command's output goes, and how it fails: one clear line on standard error, never a traceback."""

import os
import sys
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING

from grader.errors import InputError
from grader.report.screen import Screen, columns, draw
from grader.text import without_commands

if TYPE_CHECKING:
    from rich.console import Console


def emit(text: str | bytes) -> None:
    """Write a report to standard output, whole or not at all; raises InputError where it is closed."""
    stream = sys.stdout
    if stream is None:
        raise InputError("cannot write the report: standard output is closed")
    try:
        if hasattr(stream, "buffer"):
            stream.flush()
            encoding = stream.encoding or "utf-8"
            stream.buffer.write(text if isinstance(text, bytes) else text.encode(encoding, "backslashreplace"))
        else:
            stream.write(text if isinstance(text, str) else text.decode())
        stream.flush()
    except OSError as error:
        _silence(stream.fileno())
        raise InputError(f"cannot write the report: standard output: {error.strerror}") from None


def complain(message: str) -> None:
    """Write one line to standard error, if there is one."""
    if sys.stderr is not None:
        with suppress(OSError):
            print(without_commands(f"grader: {message}"), file=sys.stderr, flush=True)


def screen() -> Screen:
    """Return what standard output shows: its width, its encoding, and whether it is a terminal."""
    out = sys.stdout
    is_terminal = out is not None and out.isatty()
    size = columns()
    if is_terminal:
        with suppress(OSError):
            size = columns(os.get_terminal_size(out.fileno()).columns)
    return Screen(size, (out.encoding if out is not None else "") or "utf-8", is_terminal)


def show(render: Callable[["Console"], None]) -> None:
    """Write what a renderer prints to standard output, as wide and as colourful as that is."""
    emit(draw(render, screen()))


def _silence(descriptor: int) -> None:
    """Keep the interpreter from failing once more on what is left in its buffer at exit."""
    null = os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, descriptor)
