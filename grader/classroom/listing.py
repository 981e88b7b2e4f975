"""The names in a class folder, or in a zip that an LMS has exported. Nothing is extracted.

Symlinks are not followed: whose a file is depends on where it really is.
"""

import os
from collections.abc import Iterable
from contextlib import suppress
from itertools import islice
from pathlib import Path
from typing import NamedTuple

from grader.errors import InputError, MachineError
from grader.files.members import ARCHIVE_ERRORS, ArchiveMember, error_text, safe_path, zip_members
from grader.files.names import BUILD_FOLDERS, IGNORED_FOLDERS, LITTER
from grader.files.reading import read_error, read_start
from grader.text import printable_path

MAX_MEMBERS = 200_000  # of a zip
_MAX_DEPTH = 20  # folders in a zip: names below do not tell whose a file is
_LITTER = LITTER | (IGNORED_FOLDERS - BUILD_FOLDERS)


class Children(NamedTuple):
    """The names in one folder, unsorted. `refused` are names that are not read, each with its reason."""

    folders: list[str]
    files: list[str]
    refused: list[tuple[str, str]]


def is_litter(name: str) -> bool:
    """Return whether a file is not worth reporting: hidden, or left by an operating system or a tool."""
    return name.startswith(".") or name in _LITTER


class FolderListing:
    """A class folder on disk, which is the empty path. Names that are not UTF-8 keep their bytes (os.fsdecode)."""

    def __init__(self, top: Path) -> None:
        self._top = os.fspath(top)

    def children(self, folder: str, limit: int | None = None) -> Children:
        """Return the names in a folder, at most `limit`; none if it cannot be opened, but InputError for the top."""
        found = Children([], [], [])
        try:
            with os.scandir(f"{self._top}/{folder}" if folder else self._top) as entries:
                for entry in islice(entries, limit):
                    if not is_litter(entry.name):
                        _add(entry, found)
        except OSError as error:
            refused = read_error(error, printable_path(folder or self._top))
            if not folder:
                raise refused from None
        return found

    def is_gradebook(self, folder: str) -> bool:
        """Return whether a folder is a gradebook."""
        top = Path(self._top, folder)
        return (top / "class.toml").is_file() and ((top / "results.jsonl").is_file() or (top / "marks").is_dir())

    def first(self, folder: str) -> str | None:
        """Return one name in a folder; None if it is empty or cannot be opened."""
        try:
            with os.scandir(f"{self._top}/{folder}") as entries:
                return next((entry.name for entry in entries if not is_litter(entry.name)), None)
        except OSError as error:
            MachineError.check(error, printable_path(folder))
            return None

    def starts(self, paths: Iterable[str], count: int) -> dict[str, bytes]:
        """Return the first bytes of those files that can be read and are not symlinks."""
        starts: dict[str, bytes] = {}
        for path in paths:
            with suppress(InputError):
                starts[path] = read_start(f"{self._top}/{path}", count, top=self._top)
        return starts


def _add(entry: "os.DirEntry[str]", found: Children) -> None:
    try:
        if entry.is_symlink():
            found.refused.append((entry.name, "is a symlink, and was not followed"))
        elif entry.is_dir():
            found.folders.append(entry.name)
        elif entry.is_file():
            found.files.append(entry.name)
        else:
            found.refused.append((entry.name, "is not a regular file"))
    except OSError as error:
        MachineError.check(error, printable_path(entry.name))
        found.refused.append((entry.name, f"cannot be read: {error.strerror}"))


class ZipListing:
    """A class zip. A path in it is a member's name as `safe_path` writes it: decoded, printable, without `..`."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._folders: dict[str, dict[str, str]] = {"": {}}  # of each folder the kinds of its children by name
        try:
            with path.open("rb") as file:
                for count, member in enumerate(zip_members(file)):
                    if count >= MAX_MEMBERS or len(self._folders) > MAX_MEMBERS:
                        raise InputError(f"{printable_path(path)} contains more than {MAX_MEMBERS} files, the limit")
                    self._add(member)
        except ARCHIVE_ERRORS as error:
            shown = printable_path(path)
            raise InputError(f"{shown} cannot be read as a zip: {error_text(error, shown)}") from None

    def _add(self, member: ArchiveMember) -> None:
        path = safe_path(member.path)
        if path is None:
            shown = printable_path(member.path[:100])
            self._folders[""][shown] = "has a path that leads out of the archive, and was not read"
            return
        names = path.split("/") if path else []
        folder = ""
        for index, name in enumerate(names[:_MAX_DEPTH]):
            if is_litter(name):
                return
            child = f"{folder}/{name}" if folder else name
            if index + 1 < len(names) or member.kind == "folder":
                self._folders[folder][name] = "folder"
                self._folders.setdefault(child, {})
            else:
                kind = "is a symlink in an archive, and was not followed" if member.kind == "link" else "file"
                self._folders[folder].setdefault(name, kind)
            folder = child

    def children(self, folder: str, limit: int | None = None) -> Children:
        """Return the names in a folder."""
        names = list(islice(self._folders.get(folder, {}).items(), limit))
        return Children(
            [name for name, kind in names if kind == "folder"],
            [name for name, kind in names if kind == "file"],
            [(name, kind) for name, kind in names if kind not in ("folder", "file")],
        )

    def is_gradebook(self, folder: str) -> bool:
        """Return whether a folder is a gradebook."""
        names = self._folders.get(folder, {})
        return names.get("class.toml") == "file" and not {"results.jsonl", "marks"}.isdisjoint(names)

    def first(self, folder: str) -> str | None:
        """Return one name in a folder."""
        return next(iter(self._folders.get(folder, ())), None)

    def starts(self, paths: Iterable[str], count: int) -> dict[str, bytes]:
        """Return the first bytes of those files that can be read."""
        wanted = set(paths)
        starts: dict[str, bytes] = {}
        with self._path.open("rb") as file:
            for member in zip_members(file) if wanted else ():
                path = safe_path(member.path)
                if path in wanted and member.kind == "file":
                    try:
                        with member.open() as opened:
                            starts[path] = opened.read(count)
                    except ARCHIVE_ERRORS as error:
                        MachineError.check(error, path)
        return starts


ClassListing = FolderListing | ZipListing
