"""Watch a submission and its rubric for changes that a grading would read."""

import os
import time
from collections.abc import Callable, Collection, Iterator
from contextlib import suppress
from math import inf
from pathlib import Path
from typing import NamedTuple

from watchfiles import Change, watch

from grader.errors import InputError
from grader.files.folder import is_looked_at
from grader.text import printable_path

_POLL = 100  # milliseconds between two checks for changes that cause no event
_STEP, _DEBOUNCE = 50, 400  # milliseconds: changes within a step of each other are one, up to the debounce time
_RECHECK = 1.5  # seconds: without events, watchfiles misses the second change within one second
_Stamp = tuple[int, ...] | None


class Watched(NamedTuple):
    """A submission, its rubric if that is a file, the real paths of the reports that are written, and files read besides."""

    path: Path
    rubric: Path | None = None
    own: frozenset[str] = frozenset()
    besides: Collection[Path] = ()


class _Target(NamedTuple):
    """The folders to watch, and the files in them if the submission is a file: editors replace a file by a new one.

    `stamps` distinguish a folder from another one of the same name, because no event reports the replacement.
    """

    folders: tuple[str, ...]
    files: frozenset[str]
    stamps: tuple[_Stamp, ...]

    def remains(self, change: tuple[Change, str]) -> bool:
        """Return whether the watched folders exist after a change."""
        return change[0] is not Change.deleted or change[1] not in self.folders

    def contains(self, path: str) -> bool:
        """Return whether a grading reads this path."""
        if self.files:
            return path in self.files
        inside = os.path.relpath(path, self.folders[0]).replace(os.sep, "/")
        return is_looked_at(Path(self.folders[0]), inside)


def changes(watched: Watched) -> Iterator[bool]:
    """Yield at once and after every change, without end: True if a file changed for certain.

    Raises:
        InputError: The submission cannot be watched.
    """
    seen: tuple[_Target, dict[str, _Stamp], _Stamp] | None = None
    before: object = None
    existed = True
    recheck_at = inf
    for has_changed in _wake_ups(watched):
        target = _target(watched)
        # Stamps of the files as well; of the rubric's folder only this file matters.
        now = target, _stamps(target), _file_stamp(watched.rubric)
        if now not in (seen, before) and not has_changed:  # it may be half written: check once more
            before = now
            continue
        exists = os.path.lexists(watched.path)
        is_certain = now != seen or (has_changed and not target.files)
        if (is_certain and (exists or existed)) or time.monotonic() > recheck_at:  # not if it is still missing
            recheck_at = inf if target.files or not is_certain else time.monotonic() + _RECHECK
            # A file that was read for the first time may have changed since: grade again, but do not report a change.
            is_wider = seen is not None and bool(seen[1]) and seen[1].items() < now[1].items() and now[2] == seen[2]
            yield is_certain and not is_wider
        seen, existed = now, exists


def _wake_ups(watched: Watched) -> Iterator[bool]:
    """Yield several times a second whether something may have changed; True whenever watching starts anew."""
    while True:
        target = _target(watched)
        is_new = True
        try:
            for has_changed in _events(target, watched):
                if _target(watched) != target:
                    break
                yield has_changed or is_new
                is_new = False
        except FileNotFoundError:  # the folder does not exist, or was deleted this moment
            time.sleep(_POLL / 1000)
            yield False


def _events(target: _Target, watched: Watched) -> Iterator[bool]:
    """Watch a target until its folders are gone. Raises FileNotFoundError if they do not exist."""
    is_watching = False
    try:
        for found in watch(
            *target.folders,
            watch_filter=_filter(target, watched),
            recursive=not target.files,
            debounce=_DEBOUNCE,
            step=_STEP,
            rust_timeout=_POLL,
            yield_on_timeout=True,
            ignore_permission_denied=True,
        ):
            if not all(map(target.remains, found)):
                return
            is_watching = True
            yield bool(found)
    except RuntimeError as error:
        if not is_watching:
            shown = printable_path(watched.path)
            advice = "set WATCHFILES_FORCE_POLLING=1 in the environment to poll instead"
            raise InputError(f"cannot watch {shown}: {error}; {advice}") from None
        # watchfiles fails so on a file name that is not UTF-8.


def _filter(target: _Target, watched: Watched) -> Callable[[Change, str], bool]:
    excluded = watched.own | ({os.path.realpath(watched.rubric)} if watched.rubric is not None else set())
    return lambda change, path: (
        not target.remains((change, path)) or (target.contains(path) and os.path.realpath(path) not in excluded)
    )


def _stamps(target: _Target) -> dict[str, _Stamp]:
    return {file: _file_stamp(Path(file)) for file in target.files}


def _target(watched: Watched) -> _Target:
    path = watched.path
    real = Path(os.path.realpath(path))
    if real.is_dir():
        return _Target((str(real),), frozenset(), (_folder_stamp(real),))
    files = {real, Path(os.path.realpath(path.parent), path.name), *watched.besides}  # a symlink and its target
    folders = sorted({file.parent for file in files})
    return _Target(tuple(map(str, folders)), frozenset(map(str, files)), tuple(map(_folder_stamp, folders)))


def _folder_stamp(folder: Path) -> _Stamp:
    """Return what identifies a folder and its permissions."""
    with suppress(OSError):
        status = folder.stat()
        return status.st_dev, status.st_ino, status.st_mode
    return None


def _file_stamp(file: Path | None) -> _Stamp:
    """Return what changes whenever a file is written."""
    with suppress(OSError):
        status = file.stat() if file is not None else None
        return status and (status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns, status.st_ctime_ns)
    return None
