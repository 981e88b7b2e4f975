"""When to grade again: whenever something has changed that a grading would read."""

import os
import time
from collections.abc import Callable, Iterator
from math import inf
from pathlib import Path
from typing import NamedTuple

from watchfiles import Change, watch

from grader.errors import InputError
from grader.files.folder import is_looked_at
from grader.text import printable_path

_NAP = 100  # milliseconds between two looks at what no event tells of
_QUIET, _LONGEST = 50, 400  # changes that follow each other this closely, in milliseconds, are one; but not for longer
_ONCE_MORE = 1.5  # seconds: where there are no events, the second change in one second is not seen
_Mark = tuple[int, ...] | None


class Watched(NamedTuple):
    """What is graded, the rubric where it is a file, and the real paths of what the grader writes itself."""

    path: Path
    rubric: Path | None = None
    own: frozenset[str] = frozenset()


class _Place(NamedTuple):
    """Where to listen: in a folder to all that is graded, for a file in its folder, as editors put a new file in its place.

    `marks` tell a folder from another one that is put in its place, of which no event tells.
    """

    folders: tuple[str, ...]
    files: frozenset[str]
    marks: tuple[_Mark, ...]

    def lasts(self, change: tuple[Change, str]) -> bool:
        """Whether after a change there is still something to be heard: not where the folder itself was taken away."""
        return change[0] is not Change.deleted or change[1] not in self.folders

    def counts(self, path: str) -> bool:
        """Whether what is graded may change with this path."""
        if self.files:
            return path in self.files
        inside = os.path.relpath(path, self.folders[0]).replace(os.sep, "/")
        return is_looked_at(Path(self.folders[0]), inside)


def rounds(watched: Watched) -> Iterator[bool]:
    """Once at once, and then each time that it is to be graded, without end: whether something has changed for sure.

    Raises InputError where nothing can be watched.
    """
    seen: object = None
    before: object = None
    was_there = True
    again = inf
    for has_changed in _wakes(watched):
        place = _place(watched.path)
        # A file is looked at, too, and of the rubric's folder this one file is all that is of interest.
        now = place, _file_mark(watched.path if place.files else None), _file_mark(watched.rubric)
        if now not in (seen, before) and not has_changed:  # it may be half written: look once more
            before = now
            continue
        is_there = os.path.lexists(watched.path)
        is_sure = now != seen or (has_changed and not place.files)
        if (is_sure and (is_there or was_there)) or time.monotonic() > again:  # what is still missing is no news
            again = inf if place.files or not is_sure else time.monotonic() + _ONCE_MORE
            yield is_sure
        seen, was_there = now, is_there


def _wakes(watched: Watched) -> Iterator[bool]:
    """Several times a second: whether something may have changed, which is so each time that listening begins anew."""
    while True:
        place = _place(watched.path)
        is_new = True
        try:
            for has_changed in _events(place, watched):
                if _place(watched.path) != place:
                    break
                yield has_changed or is_new
                is_new = False
        except FileNotFoundError:  # the folder is not there, or was taken away this moment
            time.sleep(_NAP / 1000)
            yield False


def _events(place: _Place, watched: Watched) -> Iterator[bool]:
    """Listen in a place until there is no more to be heard; raises FileNotFoundError where it is not there."""
    is_listening = False
    try:
        for changes in watch(
            *place.folders,
            watch_filter=_filter(place, watched),
            recursive=not place.files,
            debounce=_LONGEST,
            step=_QUIET,
            rust_timeout=_NAP,
            yield_on_timeout=True,
            ignore_permission_denied=True,
        ):
            if not all(map(place.lasts, changes)):
                return
            is_listening = True
            yield bool(changes)
    except RuntimeError as error:
        if not is_listening:
            shown = printable_path(watched.path)
            advice = "with WATCHFILES_FORCE_POLLING=1 in the environment it is looked at instead"
            raise InputError(f"cannot watch {shown}: {error}; {advice}") from None
        # There was a file with a name that is no UTF-8.


def _filter(place: _Place, watched: Watched) -> Callable[[Change, str], bool]:
    apart = watched.own | ({os.path.realpath(watched.rubric)} if watched.rubric is not None else set())
    return lambda change, path: (
        not place.lasts((change, path)) or (place.counts(path) and os.path.realpath(path) not in apart)
    )


def _place(path: Path) -> _Place:
    real = Path(os.path.realpath(path))
    if real.is_dir():
        return _Place((str(real),), frozenset(), (_mark(real),))
    files = {real, Path(os.path.realpath(path.parent), path.name)}  # a link, and what it leads to
    folders = sorted({each.parent for each in files})
    return _Place(tuple(map(str, folders)), frozenset(map(str, files)), tuple(map(_mark, folders)))


def _mark(folder: Path) -> _Mark:
    """What tells a folder from others, and whether it may be read."""
    try:
        status = folder.stat()
    except OSError:
        return None
    return status.st_dev, status.st_ino, status.st_mode


def _file_mark(file: Path | None) -> _Mark:
    """What a file changes with each time that it is written."""
    try:
        status = file.stat() if file is not None else None
    except OSError:
        return None
    if status is None:
        return None
    return status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns, status.st_ctime_ns
