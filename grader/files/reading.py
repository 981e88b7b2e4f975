"""Read a student's files: regular files, up to a limit, never outside the submission."""

import errno
import os
import stat
import sys
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from itertools import islice
from pathlib import Path
from typing import Any

from grader.base.errors import InputError, MachineError, NotThereError
from grader.base.text import printable_path, size_text
from grader.files.limits import ROBOT_ENDINGS

URDF_LIMIT = 1024 * 1024  # bytes
# O_NONBLOCK: opening a FIFO would block. Anything but a regular file is refused before it is read.
_FLAGS = (
    os.O_RDONLY
    | getattr(os, "O_NONBLOCK", 0)
    | getattr(os, "O_BINARY", 0)
    | getattr(os, "O_CLOEXEC", 0)
)
_FOLDER = os.O_RDONLY | getattr(os, "O_DIRECTORY", 0) | getattr(os, "O_CLOEXEC", 0)
_OPENS_IN_FOLDERS = os.open in os.supports_dir_fd and hasattr(os, "O_NOFOLLOW")
_MAX_SIBLINGS = 1000  # names in a folder that are compared with a missing one
_ADVICE = " for a URDF (--max-size raises it)"


def shipped_folder(*names: str) -> Path:
    """Return a folder that comes with the grader.

    In a wheel it is in the package, in a checkout next to it.
    """
    package = Path(__file__).resolve().parent.parent
    return next(
        filter(Path.is_dir, (package / names[-1], package.parent.joinpath(*names))), package
    )


def read_capped(
    path: Path | str,
    limit: int = URDF_LIMIT,
    *,
    shown: str = "",
    top: str = "",
    advice: str = _ADVICE,
) -> bytes:
    """Return the bytes of a regular file of at most `limit` bytes.

    Raises InputError in one sentence for anything else.

    `shown` is its name in messages (default: the path), and `advice` ends the one about a file that
    is too large. Below the folder `top` no symlink is followed.
    """
    shown = shown or shown_below(path, top)
    return capped(read_start(path, limit + 1, shown, top), limit, shown, advice)


def read_start(path: Path | str, count: int, shown: str = "", top: str = "") -> bytes:
    """Return the first bytes of a regular file.

    The other arguments and errors are those of `read_capped`.
    """
    handle = open_regular(path, shown, top)
    try:
        return _read_handle(handle, count)
    except OSError as error:
        raise read_error(error, shown or shown_below(path, top)) from None
    finally:
        os.close(handle)


def read_error(error: OSError, shown: str) -> InputError:
    """Return the error for a file that cannot be read.

    Raises MachineError if the file is not the cause.
    """
    MachineError.check(error, shown)
    return InputError(f"cannot read {shown}: {error.strerror or error}")


def shown_below(path: Path | str, top: str) -> str:
    """Return a path for messages, relative to the folder `top` if it is below it."""
    return printable_path(os.fspath(path).removeprefix(f"{top}{os.sep}") if top else path)


def open_regular(path: Path | str, shown: str = "", top: str = "") -> int:
    """Return a descriptor of a regular file; raises InputError as `read_start` does."""
    shown = shown or shown_below(path, top)
    try:
        handle = _open_below(top, os.fspath(path)) if top else os.open(path, _FLAGS)
        is_regular = stat.S_ISREG(os.fstat(handle).st_mode)
    except OSError as error:
        if error.errno == errno.ELOOP and top:
            raise InputError(f"{shown} is a symlink, and was not followed") from None
        raise read_error(error, shown) from None
    if not is_regular:
        os.close(handle)
        raise InputError(f"{shown} is not a regular file")
    return handle


def _open_below(top: str, path: str) -> int:
    """Open `path`, which begins with `top`, folder by folder.

    A symlink on it, created at any moment, is an OSError.
    """
    if not _OPENS_IN_FOLDERS:
        return _open_and_verify(top, path)
    start = top.rstrip("/") + "/"
    if not path.startswith(start):
        raise OSError(errno.EPERM, "it is outside of the submission")
    *folders, name = path[len(start) :].split("/")
    at = os.open(start, _FOLDER)
    try:
        for folder in folders:
            inner = os.open(folder, _FOLDER | os.O_NOFOLLOW, dir_fd=at)
            os.close(at)
            at = inner
        return os.open(name, _FLAGS | os.O_NOFOLLOW, dir_fd=at)
    except NotADirectoryError:  # what Linux raises for a symlink in place of a folder
        raise OSError(errno.ELOOP, os.strerror(errno.ELOOP)) from None
    finally:
        os.close(at)


def _open_and_verify(top: str, path: str) -> int:
    """Open a file if the system cannot open it folder by folder (Windows).

    It verifies that no symlink led to it.
    """
    handle = os.open(path, _FLAGS)
    real, plain, inside = map(
        os.path.normcase, (os.path.realpath(path), os.path.normpath(path), os.path.realpath(top))
    )
    is_inside = real.startswith(inside.rstrip(os.sep) + os.sep)
    if real == plain and is_inside and os.path.samestat(Path(real).stat(), os.fstat(handle)):
        return handle
    os.close(handle)
    raise OSError(errno.ELOOP, os.strerror(errno.ELOOP))


def _read_handle(handle: int, count: int) -> bytes:
    """Return at most `count` bytes of an open file. A small file needs no buffer."""
    start = os.read(handle, count)
    if len(start) < count and (more := os.read(handle, count - len(start))):
        with os.fdopen(handle, "rb", closefd=False) as file:
            return start + more + file.read(count - len(start) - len(more))
    return start


def read_standard_input(limit: int = URDF_LIMIT) -> bytes:
    """Return all of standard input, at most `limit` bytes; raises InputError."""
    if sys.stdin is None:
        raise InputError("standard input is closed")
    try:
        return capped(sys.stdin.buffer.read(limit + 1), limit, "standard input")
    except OSError as error:
        raise InputError(f"cannot read standard input: {error.strerror or error}") from None


def hash_bytes(data: bytes) -> str:
    """Return the hash of some bytes, in hexadecimal digits."""
    return str(_sha256()(data).hexdigest())


@cache
def _sha256() -> Callable[[bytes], Any]:
    """Return the interpreter's own SHA-256, as `random` does, unless OpenSSL is loaded.

    Loading that takes long.
    """
    small = (
        () if "hashlib" in sys.modules else ("_sha2", "_sha256")
    )  # of Python 3.12, of Python 3.11
    return import_module(next(filter(find_spec, small), "hashlib")).sha256  # type: ignore[no-any-return]


def not_there(path: Path) -> NotThereError:
    """Return the error for a path that does not exist.

    It has the existing name closest to the path's first wrong part.
    """
    from grader.base.names import closest  # late: most paths are correct

    wrong = path
    while wrong.name and not os.path.lexists(wrong.parent):
        wrong = wrong.parent
    siblings = []
    with suppress(OSError, ValueError):
        siblings = [
            printable_path(sibling.name)
            for sibling in islice(wrong.parent.iterdir(), _MAX_SIBLINGS)
        ]
    guess = closest(printable_path(wrong.name), siblings)
    hint = "" if path.is_absolute() else " (relative to the current folder)"
    if guess is not None:
        right = wrong.parent / guess
        whole = right / path.relative_to(wrong)
        hint = f"; did you mean {printable_path(whole if os.path.lexists(whole) else right)!r}?"
    return NotThereError(printable_path(path), hint)


def advice_for(path: str) -> str:
    """Return the advice about a file that is too large: the limit of a URDF can be raised."""
    return _ADVICE if path.lower().endswith(ROBOT_ENDINGS) else ""


def capped(data: bytes, limit: int, shown: str, advice: str = _ADVICE) -> bytes:
    """Return the bytes that were read of a file.

    Raises InputError if they are more than the limit.
    """
    if len(data) > limit:
        raise InputError(f"{shown} is larger than {size_text(limit)}, the limit{advice}")
    return data
