"""Which paths a command may write to: none through a symlink of a submission, and not the gradebook."""

import os
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from grader.errors import InputError
from grader.text import printable

CHECKOUTS = ("GITHUB_WORKSPACE", "CI_PROJECT_DIR")  # the repository that GitHub Actions and GitLab CI checked out
ROBOT_FILES = (".urdf", ".xacro")
_SQLITE_FILES = ("", "-wal", "-shm", "-journal")  # SQLite keeps recent changes in files next to the gradebook
_MAX_SYMLINKS = 40  # in one path, as in Linux


def refuse_symlinks(path: Path, submissions: Sequence[Path | str] = ()) -> None:
    """Raise InputError if a path leads through a symlink that a student may have made.

    These are the symlinks in the folder of a submission, or next to a URDF, or in the repository that a CI job checked out.
    """
    folders = set(_student_folders(submissions))
    for symlink in _symlinks(path):
        if not folders.isdisjoint(symlink.parents):
            shown = printable(str(symlink))
            raise InputError(
                f"cannot write {printable(str(path))}: {shown} is a symlink in the submission; choose a file outside of it"
            )


def _student_folders(submissions: Sequence[Path | str]) -> Iterator[Path]:
    """Yield the real folders in which students can make symlinks."""
    checkouts = [Path(os.environ[name]) for name in CHECKOUTS if os.environ.get(name)]
    for path in (*map(Path, submissions), *checkouts):
        real = Path(os.path.realpath(path))
        folder = real.parent if path.suffix.lower() in ROBOT_FILES and not real.is_dir() else real
        if folder != Path(folder.anchor):
            yield folder


def _symlinks(path: Path) -> Iterator[Path]:
    """Yield every symlink on the way to a file, and the file if it is one; the parents of each are no symlinks."""
    absolute = path.absolute()
    here, rest, count = Path(absolute.anchor), list(reversed(absolute.parts[1:])), 0
    while rest and count <= _MAX_SYMLINKS:
        name = rest.pop()
        there = here.parent if name == ".." else here / name
        try:
            target = there.readlink()
        except (OSError, ValueError):  # not a symlink, or it does not exist
            here = there
            continue
        yield there
        count += 1
        here = Path(target.anchor) if target.anchor else here
        rest += reversed(target.parts[1:] if target.anchor else target.parts)


def refuse_gradebook(path: Path, gradebook: Path) -> None:
    """Raise InputError if a file to write is the gradebook, or one of the files that SQLite keeps next to it."""
    book = Path(os.path.realpath(gradebook))
    if any(is_same_file(path, book.with_name(book.name + ending)) for ending in _SQLITE_FILES):
        raise InputError(f"cannot write {path}: this would overwrite the gradebook and all its manual marks")


def is_same_file(path: Path, other: Path) -> bool:
    """Return whether two paths lead to one file, by symlinks or hard links as well; it need not exist yet."""
    try:
        return os.path.realpath(path) == os.path.realpath(other) or path.samefile(other)
    except (OSError, ValueError):  # one of them does not exist
        return False


def is_stdout(path: Path) -> bool:
    """Return whether a path is standard output, such as /dev/stdout."""
    try:
        return sys.stdout is not None and os.path.samestat(path.stat(), os.fstat(sys.stdout.fileno()))
    except (OSError, ValueError):
        return False


def missing_folder(path: Path) -> InputError:
    """Return the error for a file whose folder does not exist."""
    folder = printable(str(path.parent))
    return InputError(
        f"cannot write {printable(str(path))}: there is no folder {folder} (create it with `mkdir -p {folder}`)"
    )
