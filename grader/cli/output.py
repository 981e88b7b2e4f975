"""Standard output and standard error of the commands."""

import os
import sys
from contextlib import suppress

from grader.report.screen import Screen, columns
from grader.text import printable, without_commands
from grader.usecases.writing import write_stdout


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


def ask(prompt: str) -> str | None:
    """Print a prompt and return the line that is typed; None at the end of the input."""
    write_stdout(prompt)
    try:
        return input()
    except (EOFError, RuntimeError):  # the latter if standard input is closed
        return None


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
