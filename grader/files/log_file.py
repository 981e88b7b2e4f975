"""Read the end of a log: of a file, of the files of a folder, or of a pipe that is passed on."""

import os
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from grader.base.errors import InputError
from grader.base.text import printable_path
from grader.files.reading import not_there, open_regular, read_error

_CHUNK = 64 * 1024  # bytes
_MAX_FILES = 200  # of a folder
_ENDINGS = (".log",)  # of ~/.ros/log; colcon's files are below log/latest_build
_OF_BUILD = "stderr.log"  # has what stdout_stderr.log and streams.log repeat


def read_log(path: str, limit: int) -> bytes:
    """Return the last bytes of a log file, or of the log files of a folder. Raises InputError."""
    place = Path(path)
    if not os.path.lexists(place):
        raise not_there(place)
    if not place.is_dir():
        return _last_bytes(place, limit)
    files = _log_files(place)
    if not files:
        raise InputError(f"{printable_path(path)} has no log file (*.log)")
    parts = []
    for file in files:
        with suppress(InputError):  # a file that cannot be read hides no other one
            parts.append(_last_bytes(file, limit))
    return b"\n".join(parts)[-limit:]


def _log_files(folder: Path) -> list[Path]:
    """Return the log files of a folder: launch.log last, of a build what went to standard error."""
    files = []
    for top, folders, names in os.walk(folder):
        folders.sort()
        files += [Path(top, name) for name in sorted(names) if name.endswith(_ENDINGS)]
        if len(files) > _MAX_FILES:
            break
    of_build = [file for file in files if file.name == _OF_BUILD]
    chosen = of_build or sorted(files, key=lambda file: file.name == "launch.log")
    return chosen[:_MAX_FILES]


def _last_bytes(path: Path, limit: int) -> bytes:
    handle = open_regular(path)
    try:
        with os.fdopen(handle, "rb") as file:
            size = file.seek(0, os.SEEK_END)
            file.seek(max(0, size - limit))
            return file.read(limit)
    except OSError as error:
        raise read_error(error, printable_path(path)) from None


def read_piped_log(limit: int, pass_on: Callable[[bytes], None]) -> bytes:
    """Return the last bytes of standard input, which are passed on as they come.

    Ctrl-C, which reaches the program before the pipe as well, ends the reading. Raises InputError.
    """
    if sys.stdin is None:
        raise InputError("standard input is closed")
    last = bytearray()
    try:
        while chunk := sys.stdin.buffer.read1(_CHUNK):  # type: ignore[union-attr]
            last += chunk  # first: Ctrl-C may come at any moment
            del last[:-limit]
            pass_on(chunk)
    except KeyboardInterrupt:
        pass
    except OSError as error:
        raise InputError(f"cannot read standard input: {error.strerror or error}") from None
    return bytes(last)
