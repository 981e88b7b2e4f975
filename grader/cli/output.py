"""Where a command's output goes, and how it fails: one clear line on standard error, never a traceback."""

import io
import os
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from grader.errors import InputError
from grader.report.text import printable, without_commands

if TYPE_CHECKING:
    from rich.console import Console

_DEFAULT_WIDTH = 80
_BESIDE = ("-wal", "-shm", "-journal")  # what has been written, but is not in the gradebook's own file yet


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


def not_over(path: Path, gradebook: Path) -> None:
    """Raises InputError where a file that is to be written is the gradebook, or one that SQLite keeps beside it."""
    book = Path(os.path.realpath(gradebook))
    for each in (book, *(book.with_name(book.name + ending) for ending in _BESIDE)):
        if Path(os.path.realpath(path)) == each or is_same(path, each):
            raise InputError(f"cannot write {path}: it would replace the gradebook, and all marks by hand in it")


def is_same(path: Path, other: Path) -> bool:
    """Whether two paths lead to one file, which is there."""
    try:
        return path.samefile(other)
    except OSError:  # one of them is not there
        return False


def save(path: Path, text: str) -> None:
    """Write a file so that it is there whole or not at all; raises InputError.

    A link is followed. What is no regular file, such as a pipe or device, is written to as it is.
    """
    save_bytes(path, text.encode("utf-8", "backslashreplace"))


def save_bytes(path: Path, data: bytes) -> None:
    """As `save`, for what is no text."""
    try:
        if _is_output(path):  # also where that leads to a file: what is printed goes there as well
            emit(data)
        elif path.exists() and not path.is_file():
            with path.open("wb") as file:
                file.write(data)
        else:
            _replace(Path(os.path.realpath(path)), data)
    except (OSError, ValueError) as error:
        if isinstance(error, FileNotFoundError) and not path.parent.exists():
            raise no_folder(path) from None
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise InputError(f"cannot write {path}: {reason}") from None


def _is_output(path: Path) -> bool:
    """Whether a path is standard output, as /dev/stdout is."""
    try:
        return sys.stdout is not None and os.path.samestat(path.stat(), os.fstat(sys.stdout.fileno()))
    except (OSError, ValueError):
        return False


def no_folder(path: Path) -> InputError:
    """What to say of a file that cannot be written, because the folder that it names is not there."""
    folder = printable(str(path.parent))
    return InputError(f"cannot write {printable(str(path))}: there is no folder {folder} (mkdir -p {folder} makes it)")


def _replace(target: Path, data: bytes) -> None:
    temporary = target.with_name(f".{target.name}.{os.getpid()}.tmp")
    try:
        temporary.write_bytes(data)
        if target.exists():
            temporary.chmod(target.stat().st_mode & 0o7777)
        temporary.replace(target)
    except OSError:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)
        raise


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
