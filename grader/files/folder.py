"""A folder as a file tree: nothing outside of it is read, whatever its symlinks point to."""

import errno
import os
import stat
from contextlib import suppress
from functools import partial
from itertools import islice
from operator import attrgetter
from pathlib import Path
from typing import IO

from grader.base.errors import FileError, MachineError
from grader.base.text import printable_path
from grader.files import limits
from grader.files.limits import (
    BUILD_FOLDERS,
    IGNORED_FOLDERS,
    ignored_part,
    is_generated,
    is_setting,
    may_have_settings,
)
from grader.files.reading import (
    advice_for,
    open_regular,
    read_capped,
    read_error,
    read_start,
    shown_below,
)
from grader.files.tree import IS_LINK, File, IgnoredFile, Tree, keep_small, make_tree

_MAX_GENERATED = 10_000  # files of builds that are looked through for those of packages


def read_folder(folder: Path, top: str = "") -> Tree:
    """Return the files of a folder. Raises InputError if it cannot be read or contains too many.

    Below `top`, a folder around it, no symlink on its path is followed; by default the folder
    itself is trusted.

    Symlinks, folders that cannot be opened, and anything that is neither file nor folder are
    ignored and named. Folders of builds and tools, virtual environments and hidden files are
    ignored silently.
    """
    walk = _Walk(folder, top)
    walk.run()
    return make_tree(
        walk.name,
        walk.files,
        walk.folders,
        sorted(walk.ignored),
        sorted(walk.generated),
        walk.unseen,
        settings=partial(_find_settings, walk.top),
    )


class _Walk:
    """Walks through a folder."""

    def __init__(self, folder: Path, top: str) -> None:
        self._folder = folder
        self._shown = shown_below(folder, top)
        self.top = os.path.realpath(folder)
        self.name = printable_path(Path(self.top).name or "submission")
        self._trusted = os.path.realpath(top) if top else self.top
        if top and self.top != os.path.normpath(
            f"{self._trusted}{os.fspath(folder).removeprefix(top)}"
        ):
            raise FileError(printable_path(folder.name), IS_LINK)
        self._count = 0
        self.files: list[File] = []
        self.folders: list[str] = []
        self.ignored: list[IgnoredFile] = []
        self.generated: list[str] = []
        self.unseen: list[str] = []

    def run(self) -> None:
        """Add everything below the folder."""
        waiting = [""]
        while waiting:
            where = waiting.pop()
            for entry in self._entries(where):
                self._count += 1
                if self._count > limits.MAX_FILES:
                    raise limits.files_limit_error(self._shown)
                path = f"{where}/{entry.name}" if where else entry.name
                shown = printable_path(path)
                if not self._is_ignored(entry, path, shown) and self._add(entry, path, shown):
                    waiting.append(path)

    def _is_ignored(self, entry: "os.DirEntry[str]", path: str, shown: str) -> bool:
        if entry.name not in IGNORED_FOLDERS and not ignored_part(shown):
            return False
        if entry.is_dir(follow_symlinks=False):
            self.unseen.append(shown)
        if entry.name in BUILD_FOLDERS and not entry.is_symlink():
            self.generated += _generated_files(self._folder, path)
        return True

    def _add(self, entry: "os.DirEntry[str]", path: str, shown: str) -> bool:
        """Add a file, or name an ignored one; return True for a folder to enter."""
        if entry.is_symlink():
            self.ignored.append(IgnoredFile(shown, IS_LINK, is_closed=True))
            self.unseen.append(shown)
        elif entry.is_dir():
            if os.path.lexists(entry.path + "/pyvenv.cfg"):
                return False
            self.folders.append(shown)
            return True
        elif entry.is_file():
            place = f"{self.top}/{path}"
            self.files.append(
                File(
                    shown,
                    _size(entry, shown),
                    keep_small(partial(_read_file, place, shown, self._trusted)),
                    partial(_open_file, place, shown, self._trusted),
                )
            )
        else:
            self._ignore(shown, "is not a regular file, and was not read")
        return False

    def _ignore(self, path: str, reason: str) -> None:
        self.ignored.append(IgnoredFile(path, reason))

    def _entries(self, where: str) -> list["os.DirEntry[str]"]:
        try:
            with os.scandir(f"{self._folder}/{where}") as entries:
                return sorted(islice(entries, limits.MAX_FILES + 1), key=attrgetter("name"))
        except OSError as error:
            if not where:
                raise read_error(error, self._shown) from None
            if error.errno != errno.ENOTCONN:  # a mount of something else, which has ended
                MachineError.check(error, printable_path(where))
            self._ignore(
                printable_path(where), f"is a folder that cannot be opened: {error.strerror}"
            )
            return []


def _size(entry: "os.DirEntry[str]", shown: str) -> int:
    """Return the size of a file; 0 if it has just been removed."""
    try:
        return entry.stat().st_size
    except OSError as error:
        MachineError.check(error, shown)
        return 0


def file_at(path: Path, name: str, top: str) -> File:
    """Return a single file under its name in a submission.

    Raises InputError if it is a symlink or missing.

    Below the folder `top` no symlink is followed.
    """
    try:
        status = path.lstat()
    except OSError as error:
        raise read_error(error, name) from None
    if stat.S_ISLNK(status.st_mode):
        raise FileError(name, IS_LINK)
    place = os.fspath(path)
    read = partial(_read_file, place, name, top)
    opened = partial(_open_file, place, name, top)
    return File(name, status.st_size, read, opened)


def _generated_files(folder: Path, path: str) -> list[str]:
    """Return the files of packages below a build folder.

    They are named in the report, never read.
    """
    generated = []
    seen = 0
    with suppress(RecursionError):  # os.walk raises it for folders nested a thousand deep
        for where, folders, names in os.walk(folder / path):
            folders.sort()
            seen += len(names) + len(folders)
            if seen > _MAX_GENERATED:
                break
            copies = (f"{where}/{name}" for name in names if is_generated("build/" + name))
            generated += [printable_path(os.path.relpath(copy, folder)) for copy in copies]
    return generated


def _find_settings(top: str) -> list[File]:
    """Return the hidden files of a folder that say how packages are built.

    No symlink is followed.
    """
    settings = []
    waiting = [""]
    seen = 0
    while waiting:
        where = waiting.pop()
        with suppress(OSError), os.scandir(f"{top}/{where}") as entries:
            for entry in sorted(islice(entries, limits.MAX_FILES), key=attrgetter("name")):
                seen += 1
                path = f"{where}/{entry.name}" if where else entry.name
                if entry.is_dir(follow_symlinks=False) and may_have_settings(path):
                    waiting.append(path)
                elif is_setting(path) and entry.is_file(follow_symlinks=False):
                    shown = printable_path(path)
                    read = partial(_read_file, f"{top}/{path}", shown, top)
                    settings.append(File(shown, entry.stat(follow_symlinks=False).st_size, read))
        if seen > limits.MAX_FILES:
            break
    return settings


def _open_file(path: str, shown: str, top: str) -> IO[bytes]:
    return os.fdopen(open_regular(path, shown, top), "rb")


def _read_file(path: str, shown: str, top: str, limit: int, *, first: bool = False) -> bytes:
    """Return the bytes of a file.

    Messages use its name in the submission, so they are the same on every machine.
    """
    if first:
        return read_start(path, limit, shown, top)
    return read_capped(path, limit, shown=shown, top=top, advice=advice_for(shown))
