"""Files that a command writes: each whole or not at all, and none through a symlink that a student has made."""

import os
import stat
import sys
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path

from grader.cli.output import emit
from grader.errors import InputError
from grader.text import printable

CHECKOUTS = ("GITHUB_WORKSPACE", "CI_PROJECT_DIR")  # where GitHub and GitLab say that the repository is checked out
ROBOTS = (".urdf", ".xacro")
_BESIDE = ("-wal", "-shm", "-journal")  # what has been written, but is not in the gradebook's own file yet
_MAX_LINKS = 40  # on the way to one file, as Linux has it


def save(path: Path, text: str, submissions: Sequence[Path | str] = (), mode: int | None = None) -> None:
    """Write a file so that it is there whole or not at all; raises InputError.

    A symlink is followed unless it is in one of the submissions. What is no regular file, such as a pipe or device, is written
    to as it is. `mode` are the permissions of a new file, unless they are those of a file that is replaced.
    """
    save_bytes(path, text.encode("utf-8", "backslashreplace"), submissions, mode)


def save_bytes(path: Path, data: bytes, submissions: Sequence[Path | str] = (), mode: int | None = None) -> None:
    """As `save`, for what is no text."""
    refuse_links(path, submissions)
    try:
        if is_output(path):  # also where that leads to a file: what is printed goes there as well
            emit(data)
        elif path.exists() and not path.is_file():
            with path.open("wb") as file:
                file.write(data)
        else:
            _replace(Path(os.path.realpath(path)), data, mode)
    except (OSError, ValueError) as error:
        if isinstance(error, FileNotFoundError) and not path.parent.exists():
            raise no_folder(path) from None
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise InputError(f"cannot write {path}: {reason}") from None


def clear(path: Path) -> int | None:
    """Remove the regular file that an earlier run has left in a place to write to, if there is one; return its permissions.

    What refuses the next run then leaves no report in its place. Raises InputError where it cannot be removed.
    """
    if is_output(path):
        return None
    target = Path(os.path.realpath(path))
    try:
        mode = target.lstat().st_mode
        if not stat.S_ISREG(mode):
            return None
        target.unlink()
    except (FileNotFoundError, NotADirectoryError, ValueError):  # what keeps it from being written is told then
        return None
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror}") from None
    return stat.S_IMODE(mode)


def refuse_links(path: Path, submissions: Sequence[Path | str] = ()) -> None:
    """Raise InputError where a path leads over a symlink that a student may have made.

    Those are the ones in a submission: in its folder, or in the folder of a URDF on its own, or in the repository that a CI job
    has checked out.
    """
    folders = set(_folders(submissions))
    for link in _links(path):
        if not folders.isdisjoint(link.parents):
            shown = printable(str(path))
            raise InputError(
                f"cannot write {shown}: {printable(str(link))} is a symlink in the submission (name a file outside of it)"
            )


def _folders(submissions: Sequence[Path | str]) -> Iterator[Path]:
    """The real folders whose content is a student's."""
    checkouts = [Path(os.environ[name]) for name in CHECKOUTS if os.environ.get(name)]
    for each in (*map(Path, submissions), *checkouts):
        real = Path(os.path.realpath(each))
        folder = real.parent if each.suffix.lower() in ROBOTS and not real.is_dir() else real
        if folder != Path(folder.anchor):
            yield folder


def _links(path: Path) -> Iterator[Path]:
    """Each symlink on the way to a file, the file itself included, as a path with no symlink before its last name."""
    way = path.absolute()
    here, rest, count = Path(way.anchor), list(reversed(way.parts[1:])), 0
    while rest and count <= _MAX_LINKS:
        name = rest.pop()
        there = here.parent if name == ".." else here / name
        try:
            target = there.readlink()
        except (OSError, ValueError):  # no symlink, or not there
            here = there
            continue
        yield there
        count += 1
        here = Path(target.anchor) if target.anchor else here
        rest += reversed(target.parts[1:] if target.anchor else target.parts)


def not_over(path: Path, gradebook: Path) -> None:
    """Raises InputError where a file that is to be written is the gradebook, or one that SQLite keeps beside it."""
    book = Path(os.path.realpath(gradebook))
    for each in (book, *(book.with_name(book.name + ending) for ending in _BESIDE)):
        if is_same(path, each):
            raise InputError(f"cannot write {path}: it would replace the gradebook, and all marks by hand in it")


def is_same(path: Path, other: Path) -> bool:
    """Whether two paths lead to one file, also by symlinks or hard links, or to one that is not there yet."""
    try:
        return os.path.realpath(path) == os.path.realpath(other) or path.samefile(other)
    except (OSError, ValueError):  # one of them is not there
        return False


def no_folder(path: Path) -> InputError:
    """What to say of a file that cannot be written, because the folder that it names is not there."""
    folder = printable(str(path.parent))
    return InputError(f"cannot write {printable(str(path))}: there is no folder {folder} (mkdir -p {folder} makes it)")


def is_output(path: Path) -> bool:
    """Whether a path is standard output, as /dev/stdout is."""
    try:
        return sys.stdout is not None and os.path.samestat(path.stat(), os.fstat(sys.stdout.fileno()))
    except (OSError, ValueError):
        return False


def _replace(target: Path, data: bytes, mode: int | None) -> None:
    # A name that nobody can foretell, and no symlink is followed: nothing can be there to be written through.
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
