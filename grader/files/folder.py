"""A folder as a tree of files: nothing outside of it is read, whatever its links point to."""

import os
import stat
from contextlib import suppress
from functools import partial
from itertools import islice
from pathlib import Path

from grader.errors import InputError
from grader.files.reading import advice_for, capped, read_start, shown_below
from grader.files.tree import (
    BUILT,
    IGNORED,
    MOST_FILES,
    File,
    Tree,
    clean,
    is_generated,
    is_ignored,
    make_tree,
    parents,
    too_many,
)
from grader.text import printable_path

_MOST_GENERATED = 10_000


def read_folder(folder: Path, top: str = "") -> Tree:
    """The files of a folder. Raises InputError where it cannot be read or holds far too many.

    Below `top`, a folder around it, no symlink is followed to get to it; by default it is trusted itself.

    Left out, and named: links that lead out of it or nowhere, folders that cannot be opened, and what is neither file nor
    folder. Left out in silence: folders of builds and tools, virtual environments, hidden files.
    """
    walk = _Walk(folder, top)
    walk.enter("", linked=False)
    name = printable_path(folder.resolve().name or "submission")
    return make_tree(name, walk.files, walk.folders, sorted(walk.left_out), sorted(walk.generated), walk.unseen)


class _Walk:
    """Goes through a folder. A folder that links lead to is entered once by its own path, and once by a link."""

    def __init__(self, folder: Path, top: str) -> None:
        self._folder = folder
        self._shown = shown_below(folder, top)
        self._top = os.path.realpath(folder)
        self._trusted = os.path.realpath(top) if top else self._top
        if top and self._top != os.path.normpath(f"{self._trusted}{os.fspath(folder).removeprefix(top)}"):
            raise InputError(f"{printable_path(folder.name)} is a symlink, and was not followed")
        self._count = 0
        self._by_link: set[str] = set()
        self.files: list[File] = []
        self.folders: list[str] = []
        self.left_out: list[str] = []
        self.generated: list[str] = []
        self.unseen: list[str] = []

    def enter(self, start: str, *, linked: bool) -> None:
        """Take in what is below a folder."""
        waiting = [start]
        links: list[str] = []
        while waiting:
            where = waiting.pop()
            real_folder = os.path.realpath(self._folder / where) if linked else f"{self._top}/{where}".rstrip("/")
            for entry in self._entries(where):
                self._count += 1
                if self._count > MOST_FILES:
                    raise too_many(self._shown)
                path = f"{where}/{entry.name}" if where else entry.name
                if not self._is_ignored(entry, path) and self._take(entry, path, real_folder):
                    (links if entry.is_symlink() else waiting).append(path)
        for path in links:
            real = os.path.realpath(self._folder / path)
            if not linked and real not in self._by_link:
                self._by_link.add(real)
                self.folders.append(clean(path))
                self.enter(path, linked=True)

    def _is_ignored(self, entry: "os.DirEntry[str]", path: str) -> bool:
        if entry.name not in IGNORED and not is_ignored(clean(path)):
            return False
        if entry.is_dir(follow_symlinks=False):
            self.unseen.append(clean(path))
        if entry.name in BUILT and not entry.is_symlink():
            self.generated += _generated(self._folder, path)
        return True

    def _take(self, entry: "os.DirEntry[str]", path: str, real_folder: str) -> bool:
        """Take in a file, or say what is left out; True for a folder that is to be entered."""
        shown = clean(path)
        try:
            real = os.path.realpath(entry.path) if entry.is_symlink() else ""
            is_folder, is_file = entry.is_dir(), entry.is_file()
        except OSError:  # such as a link to itself
            real, is_folder, is_file = "", False, False
        if real and real != self._top and not real.startswith(self._top.rstrip(os.sep) + os.sep):
            self.left_out.append(f"{shown} is a link that leads out of the submission, and was not followed")
        elif is_folder:
            in_itself = real and f"{self._top}/{path}".startswith(real + "/")
            if in_itself or os.path.lexists(entry.path + "/pyvenv.cfg"):
                return False
            if not entry.is_symlink():
                self.folders.append(shown)
            return True
        elif is_file:
            place = real or f"{real_folder}/{entry.name}"
            self.files.append(File(shown, _size(entry), partial(_read, place, shown, self._trusted)))
        elif entry.is_symlink() and not Path(entry.path).exists():
            self.left_out.append(f"{shown} is a link that leads nowhere, and was not followed")
        else:
            self.left_out.append(f"{shown} is not a regular file, and was not read")
        return False

    def _entries(self, where: str) -> list["os.DirEntry[str]"]:
        try:
            with os.scandir(self._folder / where) as found:
                return sorted(islice(found, MOST_FILES + 1), key=lambda each: each.name)
        except OSError as error:
            if not where:
                raise InputError(f"cannot read {self._shown}: {error.strerror}") from None
            self.left_out.append(f"{clean(where)} is a folder that cannot be opened: {error.strerror}")
            return []


def is_looked_at(folder: Path, path: str) -> bool:
    """Whether `read_folder` takes in what stands at a path, relative to the folder, or would if something stood there."""
    steps = path.split("/")
    if not IGNORED.isdisjoint(steps) or is_ignored(clean(path)):
        return False
    return not any(os.path.lexists(folder / above / "pyvenv.cfg") for above in parents(path))


def file_at(path: Path, name: str, top: str) -> File:
    """A file on its own, as it is called in a submission; raises InputError where it is a symlink or cannot be found.

    Below the folder `top` no symlink is followed.
    """
    try:
        status = path.lstat()
    except OSError as error:
        raise InputError(f"cannot read {name}: {error.strerror}") from None
    if stat.S_ISLNK(status.st_mode):
        raise InputError(f"{name} is a symlink, and was not followed")
    return File(name, status.st_size, partial(_read, os.fspath(path), name, top))


def _generated(folder: Path, path: str) -> list[str]:
    """URDFs below a folder that a build has made: named in the report, never read."""
    found: list[str] = []
    seen = 0
    with suppress(RecursionError):  # which os.walk raises where folders are nested a thousand deep
        for where, folders, names in os.walk(folder / path):
            folders.sort()
            seen += len(names) + len(folders)
            if seen > _MOST_GENERATED:
                break
            found += [
                clean(os.path.relpath(f"{where}/{name}", folder)) for name in names if is_generated("build/" + name)
            ]
    return found


def _read(path: str, shown: str, top: str, limit: int, *, first: bool = False) -> bytes:
    """The bytes of a file; messages name it as the submission does, so that they are the same on every machine."""
    start = read_start(path, limit if first else limit + 1, shown, top)
    return start if first else capped(start, limit, shown, advice_for(shown))


def _size(entry: "os.DirEntry[str]") -> int:
    try:
        status = entry.stat()
    except OSError:
        return 0
    return status.st_size if stat.S_ISREG(status.st_mode) else 0
