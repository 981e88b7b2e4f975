"""Write files and standard output: a file is replaced as a whole or not at all."""

import os
import stat
import sys
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from grader.errors import InputError
from grader.usecases.targets import is_stdout, missing_folder, refuse_symlinks


def write_stdout(text: str | bytes) -> None:
    """Write to standard output; bytes unchanged, text in its encoding. Raises InputError if it is closed."""
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
        # The interpreter flushes the stream once more at exit, and would fail again.
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
        raise InputError(f"cannot write the report: standard output: {error.strerror}") from None


def save(path: Path, text: str, submissions: Sequence[Path | str] = (), mode: int | None = None) -> None:
    """Write a text file in UTF-8, as `save_bytes` does."""
    save_bytes(path, text.encode("utf-8", "backslashreplace"), submissions, mode)


def save_bytes(path: Path, data: bytes, submissions: Sequence[Path | str] = (), mode: int | None = None) -> None:
    """Write a file atomically. A path that is not a regular file, such as a pipe or a device, is written to directly.

    Args:
        path: The file. A symlink is followed unless it is in one of the submissions.
        data: Its content.
        submissions: Folders and files that students made.
        mode: Permissions of a new file; a file that is replaced keeps its own.

    Raises:
        InputError: The file cannot be written.
    """
    refuse_symlinks(path, submissions)
    try:
        if is_stdout(path):  # also if that is redirected to a file: printed text goes there as well
            write_stdout(data)
        elif path.exists() and not path.is_file():
            with path.open("wb") as file:
                file.write(data)
        else:
            _replace(Path(os.path.realpath(path)), data, mode)
    except (OSError, ValueError) as error:
        if isinstance(error, FileNotFoundError) and not path.parent.exists():
            raise missing_folder(path) from None
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise InputError(f"cannot write {path}: {reason}") from None


def remove_previous(path: Path) -> int | None:
    """Remove the regular file of an earlier run and return its permissions; None if there is none.

    A run that fails later then leaves no old report. Raises InputError if the file cannot be removed.
    """
    if is_stdout(path):
        return None
    target = Path(os.path.realpath(path))
    try:
        mode = target.lstat().st_mode
        if not stat.S_ISREG(mode):
            return None
        target.unlink()
    except (FileNotFoundError, NotADirectoryError, ValueError):  # `save` reports why it cannot be written
        return None
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror}") from None
    return stat.S_IMODE(mode)


def _replace(target: Path, data: bytes, mode: int | None) -> None:
    # An unpredictable name, created exclusively: no student can prepare a file or symlink there.
    temporary = target.with_name(f".{os.urandom(8).hex()}.tmp")
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_BINARY", 0)
    try:
        with os.fdopen(os.open(temporary, flags, 0o666), "wb") as file:
            file.write(data)
        if target.exists():
            mode = stat.S_IMODE(target.stat().st_mode)
        if mode is not None:
            temporary.chmod(mode)
        temporary.replace(target)
    except OSError:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)
        raise
