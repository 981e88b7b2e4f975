"""What lies in a class folder: names only. No symlink is followed: whose a file is depends on where it really lies."""

import os
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple, Protocol

from grader.errors import InputError
from grader.files.reading import read_start
from grader.text import printable_path

_SILENT = frozenset({"__MACOSX", "__pycache__", "node_modules", "site-packages", "Thumbs.db", "desktop.ini", "Icon\r"})
_LINK = "is a symlink, and was not followed"
_NO_FILE = "is not a regular file"


class Children(NamedTuple):
    """The names in one folder, in no order. `refused` are those not to be looked at, each with its reason."""

    folders: list[str]
    files: list[str]
    refused: list[tuple[str, str]]


class Listing(Protocol):
    """A class folder or archive. Paths are relative to its top, with forward slashes; the top itself is the empty path."""

    def children(self, folder: str, most: int | None = None) -> Children:
        """What is in a folder, or the first `most` of it; nothing where it cannot be opened."""

    def first(self, folder: str) -> str | None:
        """Some name in a folder; None where it holds nothing or cannot be opened."""

    def starts(self, paths: Iterable[str], count: int) -> dict[str, bytes]:
        """The first bytes of some files, of those that can be read."""


def is_silent(name: str) -> bool:
    """Whether a name is that of litter which nobody wants to hear of: hidden, or left by an operating system."""
    return name.startswith(".") or name in _SILENT


class FolderListing:
    """A class folder on disk. Names that are no UTF-8 keep their bytes as os.fsdecode writes them."""

    def __init__(self, top: Path) -> None:
        self._top = os.fspath(top)

    def children(self, folder: str, most: int | None = None) -> Children:
        """What is in a folder; InputError where it is the top and cannot be opened."""
        found = Children([], [], [])
        try:
            with os.scandir(f"{self._top}/{folder}" if folder else self._top) as entries:
                for count, entry in enumerate(entries):
                    if count == most:
                        break
                    if not is_silent(entry.name):
                        self._take(entry, found)
        except OSError as error:
            if not folder:
                raise InputError(f"cannot read {printable_path(self._top)}: {error.strerror}") from None
        return found

    def first(self, folder: str) -> str | None:
        """Some name in a folder; None where it holds nothing or cannot be opened."""
        try:
            with os.scandir(f"{self._top}/{folder}") as entries:
                for entry in entries:
                    if not is_silent(entry.name):
                        return entry.name
        except OSError:
            pass
        return None

    def _take(self, entry: "os.DirEntry[str]", found: Children) -> None:
        try:
            if entry.is_symlink():
                found.refused.append((entry.name, _LINK))
            elif entry.is_dir():
                found.folders.append(entry.name)
            elif entry.is_file():
                found.files.append(entry.name)
            else:
                found.refused.append((entry.name, _NO_FILE))
        except OSError as error:
            found.refused.append((entry.name, f"cannot be read: {error.strerror}"))

    def starts(self, paths: Iterable[str], count: int) -> dict[str, bytes]:
        """The first bytes of some files, of those that can be read and are no symlinks."""
        starts: dict[str, bytes] = {}
        for path in paths:
            with suppress(InputError):
                starts[path] = read_start(f"{self._top}/{path}", count, top=self._top)
        return starts
