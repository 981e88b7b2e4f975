"""Where a command's output goes, and how it fails: one clear line on standard error, never a traceback."""

import io
import os
import sys
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING

from grader.errors import InputError
from grader.text import without_commands

if TYPE_CHECKING:
    from rich.console import Console

_DEFAULT_WIDTH = 80


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


def draw(render: Callable[["Console"], None], *, to_file: bool = False) -> str:
    """What a renderer prints, as text: coloured and as wide as standard output takes it, plain for a file."""
    from rich.console import Console  # rich is not needed for JSON

    out = sys.stdout
    is_terminal = not to_file and out is not None and out.isatty()
    encoding = "utf-8" if to_file or out is None else (out.encoding or "utf-8")
    buffer = _Buffer(encoding)
    console = Console(
        file=buffer,
        force_terminal=is_terminal,
        width=_width(is_terminal),
        highlight=False,
        markup=False,
        emoji=False,
        legacy_windows=False,
        no_color=True if os.environ.get("NO_COLOR") else None,
    )
    render(console)
    return without_commands(buffer.getvalue())


class _Buffer(io.StringIO):
    """Collects what is printed, and claims the encoding of where it will go."""

    def __init__(self, encoding: str) -> None:
        super().__init__()
        self._encoding = encoding

    @property
    def encoding(self) -> str:  # type: ignore[override]  # typeshed has it writable
        return self._encoding


def _width(is_terminal: bool) -> int:
    columns = os.environ.get("COLUMNS", "")
    if columns.isdigit() and int(columns) > 0:
        return max(40, min(int(columns), 500))
    if is_terminal:
        with suppress(OSError):
            return max(40, os.get_terminal_size(sys.stdout.fileno()).columns)
    return _DEFAULT_WIDTH


def _silence(descriptor: int) -> None:
    """Keep the interpreter from failing once more on what is left in its buffer at exit."""
    null = os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, descriptor)
