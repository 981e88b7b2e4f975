"""Standard output and standard error of the commands."""

import os
import sys
from contextlib import suppress

from grader.report.screen import Screen, columns
from grader.text import without_commands


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
