"""Where commands write: the terminal, standard output, and files.

Files are replaced as a whole or not at all.

No file is written through a symlink of a submission, and none over the gradebook.
"""

import errno
import os
import stat
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

from grader.base.errors import InputError
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.text import printable, printable_path
from grader.files.limits import ROBOT_ENDINGS
from grader.report.screen import Screen

if TYPE_CHECKING:
    from grader.workers.queue import Progress


Warn = Callable[[str], None]
# Shows the progress of a pass over a class, whose work is named.
_ShowClass = Callable[[str], AbstractContextManager[Callable[["Progress"], None]]]
CHECKOUTS = (
    "GITHUB_WORKSPACE",
    "CI_PROJECT_DIR",
)  # the repository that GitHub Actions and GitLab CI checked out
_TEMPORARY = on_use(
    r"\.[0-9a-f]{16}(?:-([0-9]+))?\.tmp"
)  # with the number of the process that writes it
_MAX_SYMLINKS = 40  # in one path, as in Linux


class Terminal(Named):
    """What a command prints with; the command line passes it."""

    print: Callable[[str], None]
    warn: Warn
    screen: Callable[[], Screen]  # called before each use, because a terminal can be resized
    show_class: _ShowClass


def write_stdout(text: str | bytes) -> None:
    """Write to standard output; bytes unchanged, text in its encoding.

    Raises InputError if it is closed.
    """
    stream = sys.stdout
    if stream is None:
        raise InputError("cannot write the report: standard output is closed")
    try:
        if hasattr(stream, "buffer"):
            stream.flush()
            encoding = stream.encoding or "utf-8"
            stream.buffer.write(
                text if isinstance(text, bytes) else text.encode(encoding, "backslashreplace")
            )
        else:
            stream.write(text if isinstance(text, str) else text.decode())
        stream.flush()
    except OSError as error:
        # The interpreter flushes the stream once more at exit, and would fail again.
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
        raise InputError(f"cannot write the report: standard output: {error.strerror}") from None


def save(
    path: Path, text: str, submissions: Sequence[Path | str] = (), mode: int | None = None
) -> None:
    """Write a text file in UTF-8, as `save_bytes` does."""
    save_bytes(path, text.encode("utf-8", "backslashreplace"), submissions, mode)


def save_bytes(
    path: Path, data: bytes, submissions: Sequence[Path | str] = (), mode: int | None = None
) -> None:
    """Write a file atomically, as `save_all` does; a new one gets the permissions `mode`."""
    save_all({path: data}, submissions, mode)


def save_all(
    files: Mapping[Path, bytes], submissions: Sequence[Path | str] = (), mode: int | None = None
) -> None:
    """Write files, each atomically, and none before all are written beside their places.

    A path that is not a regular file, such as a pipe or a device, is written to directly, and
    refused if it would have to wait, as a FIFO that nothing reads. A symlink is followed unless it
    is in one of the submissions, which are folders and files that students made. A new file gets
    the permissions `mode`; one that is replaced keeps its own. Raises InputError if a file cannot
    be written: then none has changed.
    """
    temporaries = {}
    streams = {}
    try:
        for path, data in files.items():
            with _as_input_error(path):
                refuse_symlinks(path, submissions)
                if is_stdout(path):
                    continue
                if path.is_file() or not path.exists():
                    target = Path(os.path.realpath(path))
                    temporaries[path] = _write_beside(target, data, mode)
                else:
                    streams[path] = _open_stream(path)
        for path, data in files.items():
            with _as_input_error(path):
                if path in temporaries:
                    temporaries[path].replace(os.path.realpath(path))
                elif path in streams:
                    with streams[path] as stream:
                        stream.write(data)
                else:  # also if that is redirected to a file: printed text goes there as well
                    write_stdout(data)
    finally:
        for stream in streams.values():
            with suppress(OSError):
                stream.close()
        for temporary in temporaries.values():
            with suppress(OSError):
                temporary.unlink(missing_ok=True)


@contextmanager
def _as_input_error(path: Path) -> Iterator[None]:
    """Raise InputError for a file that cannot be written."""
    try:
        yield
    except (OSError, ValueError) as error:
        if isinstance(error, FileNotFoundError) and not path.parent.exists():
            raise missing_folder(path) from None
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise InputError(f"cannot write {path}: {reason}") from None


def _open_stream(path: Path) -> BinaryIO:
    """Open a pipe or a device to write to it. Raises OSError for a FIFO that nothing reads."""
    try:
        handle = os.open(path, os.O_WRONLY | getattr(os, "O_NONBLOCK", 0))
    except OSError as error:
        if error.errno == errno.ENXIO:
            error.strerror = "no program reads this pipe"
        raise
    os.set_blocking(handle, True)
    return os.fdopen(handle, "wb")


def make_folder(folder: Path) -> None:
    """Make a folder and those above it, unless it exists. Raises InputError."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(
            f"cannot make the folder {printable_path(folder)}: {error.strerror}"
        ) from None


def _write_beside(target: Path, data: bytes, mode: int | None) -> Path:
    """Write a file that is to replace another one beside it, and return its path.

    It has the other's permissions.
    """
    _remove_strays(target.parent)
    # An unpredictable name, created exclusively: no student can prepare a file or symlink there.
    temporary = target.with_name(f".{os.urandom(8).hex()}-{os.getpid()}.tmp")
    flags = (
        os.O_WRONLY
        | os.O_CREAT
        | os.O_EXCL
        | getattr(os, "O_NOFOLLOW", 0)
        | getattr(os, "O_BINARY", 0)
    )
    try:
        with os.fdopen(os.open(temporary, flags, 0o666), "wb") as file:
            file.write(data)
            file.flush()
            _sync(file.fileno())
        if target.exists():
            mode = stat.S_IMODE(target.stat().st_mode)
        if mode is not None:
            temporary.chmod(mode)
    except OSError:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)
        raise
    return temporary


@cache  # a folder of reports is not listed for each of them
def _remove_strays(folder: Path) -> None:
    """Remove the files that writers which were killed have left in a folder."""
    for path in folder.glob(".*.tmp"):
        if (match := _TEMPORARY.fullmatch(path.name)) and not _is_running(int(match[1] or 0)):
            with suppress(OSError):
                path.unlink()


def _is_running(process: int) -> bool:
    """Return whether a process with a number may be running."""
    if sys.platform == "win32":  # there os.kill ends it
        return True
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except OSError:  # it is somebody else's
        pass
    return process > 0


def _sync(handle: int) -> None:
    """Write a file to the disk: else it may be empty under its new name after a power failure."""
    try:
        os.fsync(handle)
    except OSError as error:
        if error.errno not in (
            errno.EINVAL,
            errno.ENOTSUP,
        ):  # some file systems, such as those of FUSE, cannot
            raise


def refuse_symlinks(path: Path, submissions: Sequence[Path | str] = ()) -> None:
    """Raise InputError if a path leads through a symlink that a student may have made.

    These are the symlinks in the folder of a submission, or beside a URDF, or in the repository
    that a CI job checked out.
    """
    folders = set(_student_folders(submissions))
    for symlink in _symlinks(path):
        if not folders.isdisjoint(symlink.parents):
            shown = printable(str(symlink))
            raise InputError(
                f"cannot write {printable(str(path))}: {shown} is a symlink in the submission; "
                "choose a file outside of it"
            )


def _student_folders(submissions: Sequence[Path | str]) -> Iterator[Path]:
    """Yield the real folders in which students can make symlinks."""
    checkouts = [Path(os.environ[name]) for name in CHECKOUTS if os.environ.get(name)]
    for path in (*map(Path, submissions), *checkouts):
        real = Path(os.path.realpath(path))
        folder = real.parent if path.suffix.lower() in ROBOT_ENDINGS and not real.is_dir() else real
        if folder != Path(folder.anchor):
            yield folder


def _symlinks(path: Path) -> Iterator[Path]:
    """Yield every symlink on the way to a file, and the file if it is one.

    The parents of each are no symlinks.
    """
    absolute = path.absolute()
    here = Path(absolute.anchor)
    rest = list(reversed(absolute.parts[1:]))
    count = 0
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


def refuse_inputs(option: str, path: Path, inputs: Iterable[Path]) -> None:
    """Raise InputError if a file that an option names is one of the inputs.

    Also raise it if the file exists in an input that is a folder.
    """
    real = Path(os.path.realpath(path))
    for input_path in inputs:
        if is_same_file(path, input_path) or (
            real.exists() and Path(os.path.realpath(input_path)) in real.parents
        ):
            shown = printable_path(path)
            raise InputError(
                f"cannot write {shown}: the command also reads or writes it; name another "
                f"file for {option}"
            )


def is_same_file(path: Path, other: Path) -> bool:
    """Return whether two paths lead to one file, by symlinks or hard links as well.

    It need not exist yet.
    """
    try:
        return os.path.realpath(path) == os.path.realpath(other) or path.samefile(other)
    except (OSError, ValueError):  # one of them does not exist
        return False


def is_stdout(path: Path) -> bool:
    """Return whether a path is standard output, such as /dev/stdout."""
    try:
        return sys.stdout is not None and os.path.samestat(
            path.stat(), os.fstat(sys.stdout.fileno())
        )
    except (OSError, ValueError):
        return False


def missing_folder(path: Path) -> InputError:
    """Return the error for a file whose folder does not exist."""
    folder = printable(str(path.parent))
    return InputError(
        f"cannot write {printable(str(path))}: there is no folder {folder} (create it with "
        f"`mkdir -p {folder}`)"
    )
