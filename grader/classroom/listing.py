"""The names in a class folder, or in a zip that an LMS has exported. Nothing is extracted.

Symlinks are not followed: whose a file is depends on where it really is.
"""

import os
from contextlib import suppress
from itertools import islice
from pathlib import Path
from typing import NamedTuple

from grader.errors import InputError, MachineError
from grader.files.class_zip import ClassZip
from grader.files.members import ARCHIVE_ERRORS
from grader.files.names import BUILD_FOLDERS, IGNORED_FOLDERS, LITTER
from grader.files.opening import archive_kind
from grader.files.reading import not_there, read_error, read_start
from grader.text import printable_path

MAX_FOLDERS = 200_000  # of a zip
_MAX_DEPTH = 20  # folders in a zip: names below do not tell whose a file is
_LITTER = LITTER | (IGNORED_FOLDERS - BUILD_FOLDERS)


class Children(NamedTuple):
    """The names in one folder, unsorted. `refused` are names that are not read, each with its reason."""

    folders: list[str]
    files: list[str]
    refused: list[tuple[str, str]]


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
                    if not _is_litter(entry.name):
                        _add(entry, found)
        except OSError as error:
            refused = read_error(error, printable_path(folder or self._top))
            if not folder:
                raise refused from None
        return found

    def has(self, path: str) -> bool:
        """Return whether there is a file or folder."""
        return os.path.lexists(f"{self._top}/{path}")

    def start(self, path: str, count: int) -> bytes:
        """Return the first bytes of a file; none if it cannot be read."""
        with suppress(InputError):
            return read_start(f"{self._top}/{path}", count, top=self._top)
        return b""


def _is_litter(name: str) -> bool:
    """Return whether a file is not worth reporting: hidden, or left by an operating system or a tool."""
    return name.startswith(".") or name in _LITTER


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
        self._zip = ClassZip(path)
        # Of each folder the kinds of its children by name.
        self._folders: dict[str, dict[str, str]] = {
            "": dict.fromkeys(self._zip.outside, "has a path that leads out of the archive, and was not read")
        }
        for name, member in self._zip.members.items():
            self._add(name.split("/"), member.kind)
            if len(self._folders) > MAX_FOLDERS:
                raise InputError(f"{printable_path(path)} contains more than {MAX_FOLDERS} folders, the limit")

    def _add(self, names: list[str], member: str) -> None:
        folder = ""
        for index, name in enumerate(names[:_MAX_DEPTH]):
            if _is_litter(name):
                return
            child = f"{folder}/{name}" if folder else name
            if index + 1 < len(names) or member == "folder":
                self._folders[folder][name] = "folder"
                self._folders.setdefault(child, {})
            else:
                kind = "is a symlink in an archive, and was not followed" if member == "link" else "file"
                self._folders[folder].setdefault(name, kind)
            folder = child

    def children(self, folder: str, limit: int | None = None) -> Children:
        """Return the names in a folder."""
        found = Children([], [], [])
        for name, kind in islice(self._folders.get(folder, {}).items(), limit):
            if kind in ("folder", "file"):
                (found.folders if kind == "folder" else found.files).append(name)
            else:
                found.refused.append((name, kind))
        return found

    def has(self, path: str) -> bool:
        """Return whether there is a file or folder."""
        return path in self._folders or path in self._zip.members

    def start(self, path: str, count: int) -> bytes:
        """Return the first bytes of a file; none if it cannot be read."""
        try:
            with self._zip.raw(path) as opened:
                return opened.read(count)
        except (InputError, *ARCHIVE_ERRORS) as error:
            MachineError.check(error, path)
            return b""


ClassListing = FolderListing | ZipListing


def listing_of(path: Path) -> ClassListing:
    """Return the listing of a class folder or zip; raises InputError if it is neither."""
    shown = printable_path(path)
    try:
        if path.is_dir():
            return FolderListing(path)
        exists = os.path.lexists(path)
    except (OSError, ValueError) as error:
        raise InputError(f"cannot read {shown}: {error}") from None
    if not exists:
        raise not_there(path)
    if archive_kind(read_start(path, 512)) != "zip":
        raise InputError(
            f"{shown} is neither a folder nor a zip: name the folder that holds the class's submissions"
            " (`grader grade` grades a single one)"
        )
    return ZipListing(path)


def is_gradebook(listing: ClassListing, folder: str) -> bool:
    """Return whether a folder is a gradebook of the grader, and no submission."""
    return listing.has(f"{folder}/class.toml") and any(
        listing.has(f"{folder}/{name}") for name in ("results.jsonl", "marks")
    )
