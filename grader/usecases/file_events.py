"""Watch a submission and its rubric: the stamps of all files that a grading would read are compared several times a second."""

import os
import time
from collections.abc import Collection, Iterable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from grader.files.folder import is_looked_at

_POLL = 0.1  # seconds between two looks
_SHARE = 10  # a look at many files is followed by a pause of this many times its own time
_Stamp = tuple[int, ...] | None


class Watched(NamedTuple):
    """A submission, its rubric if that is a file, the real paths of the reports that are written, and files read besides."""

    path: Path
    rubric: Path | None = None
    own: frozenset[str] = frozenset()
    besides: Collection[Path] = ()


def changes(watched: Watched) -> Iterator[bool]:
    """Yield at once and after every change, without end: True if a file changed for certain."""
    seen: dict[str, _Stamp] | None = None
    before: dict[str, _Stamp] = {}
    while True:
        start = time.monotonic()
        now = _stamps(watched)
        if seen is None or before == now != seen:  # what changed since the last look may be half written
            # A file that was read for the first time may have changed since: grade again, but do not report a change.
            new = now.keys() - (seen or {}).keys()
            yield seen is None or not (seen.items() < now.items() and new <= set(map(str, watched.besides)))
            seen = now
        before = now
        time.sleep(max(_POLL, _SHARE * (time.monotonic() - start)))


def _stamps(watched: Watched) -> dict[str, _Stamp]:
    """Return what identifies each folder, and what changes whenever a file is written; nothing of files that do not exist."""
    root = Path(os.path.realpath(watched.path))
    files: Iterable[Path] = _files(root) if root.is_dir() else (watched.path, *watched.besides)
    rubric = () if watched.rubric is None else (watched.rubric,)
    found = {str(file): _stamp(file) for file in (*files, *rubric) if os.path.realpath(file) not in watched.own}
    return {file: stamp for file, stamp in found.items() if stamp is not None}


def _files(root: Path) -> Iterator[Path]:
    """Yield the folders and files in a folder that a grading looks at."""
    yield root
    with suppress(RecursionError):  # os.walk raises it for folders nested a thousand deep
        for where, folders, files in os.walk(root):
            inside = os.path.relpath(where, root)
            folders[:] = [name for name in folders if _is_looked_at(root, f"{inside}/{name}/file")]
            names = (*folders, *(name for name in files if _is_looked_at(root, f"{inside}/{name}")))
            yield from (Path(where, name) for name in names)


def _is_looked_at(root: Path, path: str) -> bool:
    return is_looked_at(root, path.removeprefix("./"))


def _stamp(path: Path) -> _Stamp:
    with suppress(OSError):
        status = path.stat()
        known = status.st_dev, status.st_ino, status.st_mode
        # A folder changes with each report that is written into it.
        return known if path.is_dir() else (*known, status.st_size, status.st_mtime_ns, status.st_ctime_ns)
    return None
