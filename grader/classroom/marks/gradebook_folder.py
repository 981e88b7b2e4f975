"""The folder of a gradebook.

Here are the files in it, how it is recognised, who may write it, and its settings in `class.toml`.

The settings are what a later run needs to grade the class again.
"""

import errno
import json
import os
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, fields
from datetime import datetime
from pathlib import Path
from tempfile import TemporaryFile
from typing import Any

import tomli

from grader.base.errors import InputError
from grader.base.grouping import Strings, StringsByName
from grader.base.names import did_you_mean
from grader.base.text import printable, printable_path, shell_quoted
from grader.classroom.roster.lateness import read_time
from grader.files.reading import URDF_LIMIT, read_capped

RESULTS = "results.jsonl"
GRADES = "grades.csv"
ROSTER = "roster.csv"
RUBRIC = "rubric"
MARKS = "marks"
REPORTS = "reports"
CLASS_FILE = "class.toml"
_LOCK = ".lock"
_WINDOWS_LOCK_AT = 1 << 30  # beyond the end of the file: others cannot read what is locked
_NO_LOCKS = {errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP, errno.ENOTSUP}
_MAX_SIZE = 1024 * 1024  # bytes of the settings
_HEAD = (
    "# What `grader batch` needs to grade this class again. An option of the command replaces "
    "what is here.\n"
)
_ARGUMENTS = "arguments"


def is_gradebook(folder: Path) -> bool:
    """Return whether a folder is a gradebook."""
    return (folder / CLASS_FILE).is_file()


def check_gradebook(folder: Path) -> None:
    """Raise InputError if a path is not a gradebook."""
    shown = printable_path(folder)
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{shown} is a file: a gradebook is a folder")
    if not folder.is_dir():
        raise InputError(
            f"there is no gradebook {shown}: `grader batch PATH --gradebook "
            f"{shell_quoted(folder)}` makes it"
        )
    if not is_gradebook(folder):
        raise InputError(f"{shown} is not a gradebook: it has no {CLASS_FILE}")


def check_free(folder: Path) -> None:
    """Raise InputError unless a path is a gradebook, an empty folder, or absent."""
    is_begun = is_gradebook(folder) or (folder / _LOCK).exists()  # a first run may have been killed
    if folder.is_dir() and not is_begun and any(folder.iterdir()):
        raise InputError(
            f"{printable_path(folder)} is not empty and not a gradebook: name another folder"
        )
    if folder.exists() and not folder.is_dir():
        check_gradebook(folder)


def check_roster(folder: Path, settings: "ClassSettings") -> None:
    """Raise InputError if the copy of the roster is no longer there.

    Without it nobody would be missing.
    """
    file = folder / ROSTER
    if settings.roster_hash and not file.exists():
        command = f"`grader batch --roster CSV --gradebook {shell_quoted(folder)}`"
        raise InputError(
            f"{printable_path(file)} is gone: restore it, or name the roster again with {command}"
        )


def make_gradebook(folder: Path) -> None:
    """Make the folders of a gradebook, unless they exist; only its owner can read them.

    Raises InputError.
    """
    check_free(folder)
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        (folder / _LOCK).touch(0o600)
        (folder / MARKS).mkdir(mode=0o700, exist_ok=True)
    except OSError as error:
        raise InputError(
            f"cannot make the gradebook {printable_path(folder)}: {error.strerror}"
        ) from None


def lock(handle: int, *, wait: bool = True) -> bool:
    """Lock an open file until it is closed; return False where the file system has no locks.

    Raises OSError if another process has locked it, without `wait`.
    """
    try:
        if sys.platform == "win32":
            import msvcrt

            os.lseek(handle, _WINDOWS_LOCK_AT, os.SEEK_SET)
            msvcrt.locking(handle, msvcrt.LK_LOCK if wait else msvcrt.LK_NBLCK, 1)
        else:
            import fcntl

            fcntl.flock(handle, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
    except OSError as error:
        if error.errno in _NO_LOCKS:
            return False
        raise
    return True


def warn_without_locks(folder: Path, warn: Callable[[str], None]) -> None:
    """Say what is not protected, if the file system of a gradebook has no locks."""
    has_locks = True
    with suppress(OSError), TemporaryFile(dir=folder) as file:  # which no other program locks
        has_locks = lock(file.fileno(), wait=False)
    if not has_locks:
        warn(
            f"{printable_path(folder)} is on a file system without locks: nothing prevents that "
            "two programs write marks or grades at the same time, so use one at a time"
        )


@contextmanager
def batch_lock(folder: Path) -> Iterator[None]:
    """Hold the lock of a run over a class; raise InputError while another run holds it.

    It ends with the process. Where the file system has no locks, nothing is held.
    """
    try:
        file = os.fdopen(os.open(folder / _LOCK, os.O_RDWR | os.O_CREAT, 0o600), "r+b")
    except OSError as error:
        raise InputError(
            f"cannot write to the gradebook {printable_path(folder)}: {error.strerror}"
        ) from None
    with file:
        try:
            lock(file.fileno(), wait=False)
        except OSError:
            raise InputError(
                f"another `grader batch` writes to {printable_path(folder)}: wait until it "
                "has ended"
            ) from None
        yield


@dataclass(frozen=True, slots=True)
class ClassSettings:
    """The inputs and settings of a class. Paths are relative to the gradebook."""

    submissions: Strings = ()
    layout: str = "auto"
    assignment: str = ""  # of nbgrader
    ignore: Strings = ()  # names of entries that are no student's
    due: str = ""  # the deadline in ISO 8601
    parts: Strings = ()  # the ids of those to grade; without any all
    max_size: int = URDF_LIMIT  # bytes
    rubric: str = ""  # the copy of the rubric
    rubric_id: str = ""  # known even if an edit breaks the copy
    rubric_hash: str = ""  # of the copy as it was made: another one means that somebody edited it
    roster_hash: str = ""  # of the copy as it was made
    handed_out: Strings = ()  # hashes of work of the course, which is no equal work
    arguments: StringsByName = field(default_factory=dict)  # of xacro

    def roots(self, folder: Path) -> tuple[Path, ...]:
        """Return the real paths of the submissions."""
        return tuple((folder / path).resolve() for path in self.submissions)

    def deadline(self, folder: Path) -> datetime | None:
        """Return the deadline. Raises InputError."""
        if self.due:
            return read_time(self.due, f"{printable_path(folder / CLASS_FILE)}: ")
        return None


def relative(path: Path, folder: Path) -> str:
    """Return a path as seen from a folder, with forward slashes; absolute on another drive."""
    try:
        return os.path.relpath(path.resolve(), folder.resolve()).replace(os.sep, "/")
    except ValueError:
        return str(path.resolve())


def read_settings(folder: Path) -> ClassSettings:
    """Return the settings in a gradebook. Raises InputError with the first mistake in the file."""
    file = folder / CLASS_FILE
    shown = printable_path(file)
    try:
        data = tomli.loads(read_capped(file, _MAX_SIZE, advice="").decode())
    except (UnicodeDecodeError, tomli.TOMLDecodeError) as error:
        raise InputError(f"{shown} is not TOML: {printable(str(error))}") from None
    if not data:
        raise InputError(
            f"{shown} is empty: restore it, or delete it and run `grader batch` with the options "
            "of the class"
        )
    types = {one.name: type(getattr(ClassSettings(), one.name)) for one in fields(ClassSettings)}
    for key, value in data.items():
        if key not in types:
            raise InputError(
                f"{shown} has an unknown key {printable(key)!r}{did_you_mean(key, types)}"
            )
        wanted = list if types[key] is tuple else types[key]
        parts: Iterable[object] = ()
        if isinstance(value, list):
            parts = value
        elif isinstance(value, dict):
            parts = value.values()
        if type(value) is not wanted or not all(isinstance(part, str) for part in parts):
            names = {
                list: "a list of texts",
                dict: "a table of texts",
                int: "a number",
                str: "a text",
            }
            raise InputError(f"{shown}: {key} should be {names[wanted]}")
    given: dict[str, Any] = {
        key: tuple(value) if isinstance(value, list) else value for key, value in data.items()
    }
    return ClassSettings(**given)


def settings_text(settings: ClassSettings) -> str:
    """Return the settings as TOML; `read_settings` returns the same."""
    values = {
        one.name: getattr(settings, one.name) for one in fields(settings) if one.name != _ARGUMENTS
    }
    lines = [f"{key} = {_toml_value(value)}\n" for key, value in values.items()]
    if settings.arguments:
        lines.append(f"\n[{_ARGUMENTS}]\n")
        lines += [
            f"{_toml_value(key)} = {_toml_value(value)}\n"
            for key, value in sorted(settings.arguments.items())
        ]
    return "".join((_HEAD, *lines))


def _toml_value(value: object) -> str:
    """Return a value in TOML.

    Its texts and lists of texts are those of JSON but for the character DEL.
    """
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
