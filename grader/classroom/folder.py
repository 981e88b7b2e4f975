"""A gradebook is a folder of plain files: what it holds, how it is recognised, who may write it."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from grader.classroom.mark_files import lock
from grader.classroom.settings import CLASS_FILE
from grader.errors import InputError
from grader.text import printable_path, shell_quoted

RESULTS, GRADES, ROSTER = "results.jsonl", "grades.csv", "roster.csv"
RUBRIC, MARKS, REPORTS = "rubric", "marks", "reports"
_LOCK = ".lock"


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
            f"there is no gradebook {shown}: `grader batch PATH --gradebook {shell_quoted(folder)}` makes it"
        )
    if not is_gradebook(folder):
        raise InputError(f"{shown} is not a gradebook: it has no {CLASS_FILE}")


def check_free(folder: Path) -> None:
    """Raise InputError unless a path is a gradebook, an empty folder, or absent."""
    is_begun = is_gradebook(folder) or (folder / _LOCK).exists()  # a first run may have been killed
    if folder.is_dir() and not is_begun and any(folder.iterdir()):
        raise InputError(f"{printable_path(folder)} is not empty and not a gradebook: name another folder")
    if folder.exists() and not folder.is_dir():
        check_gradebook(folder)


def make_gradebook(folder: Path) -> None:
    """Make the folders of a gradebook, unless they exist; only its owner can read them. Raises InputError."""
    check_free(folder)
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        (folder / _LOCK).touch(0o600)
        (folder / MARKS).mkdir(mode=0o700, exist_ok=True)
    except OSError as error:
        raise InputError(f"cannot make the gradebook {printable_path(folder)}: {error.strerror}") from None


@contextmanager
def batch_lock(folder: Path) -> Iterator[None]:
    """Hold the lock of a run over a class; raise InputError while another run holds it. It ends with the process."""
    try:
        file = os.fdopen(os.open(folder / _LOCK, os.O_RDWR | os.O_CREAT, 0o600), "r+b")
    except OSError as error:
        raise InputError(f"cannot write to the gradebook {printable_path(folder)}: {error.strerror}") from None
    with file:
        try:
            lock(file.fileno(), wait=False)
        except OSError:
            raise InputError(
                f"another `grader batch` writes to {printable_path(folder)}: wait until it has ended"
            ) from None
        yield
