"""The names in a class folder. Symlinks are not followed: the owner of a file depends on its real path."""

import os
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple, Protocol

from grader.errors import InputError
from grader.files.reading import read_start
from grader.text import printable_path

_LITTER = frozenset({"__MACOSX", "__pycache__", "node_modules", "site-packages", "Thumbs.db", "desktop.ini", "Icon\r"})


class Children(NamedTuple):
    """The names in one folder, unsorted. `refused` are names that are not read, each with its reason."""

    folders: list[str]
    files: list[str]
    refused: list[tuple[str, str]]


class ClassListing(Protocol):
    """A class folder or zip. Paths are relative to its top, with forward slashes; the top itself is the empty path."""

    def children(self, folder: str, limit: int | None = None) -> Children:
        """Return the names in a folder, or the first `limit`; nothing if it cannot be opened."""

    def first(self, folder: str) -> str | None:
        """Return one name in a folder; None if it is empty or cannot be opened."""

    def starts(self, paths: Iterable[str], count: int) -> dict[str, bytes]:
        """Return the first bytes of those files that can be read."""


def is_litter(name: str) -> bool:
    """Return whether a file is not worth reporting: hidden, or left by an operating system or a tool."""
    return name.startswith(".") or name in _LITTER


class FolderListing:
    """A class folder on disk. Names that are not UTF-8 keep their bytes as os.fsdecode writes them."""

    def __init__(self, top: Path) -> None:
        self._top = os.fspath(top)

    def children(self, folder: str, limit: int | None = None) -> Children:
        """Return the names in a folder; raises InputError if it is the top and cannot be opened."""
        found = Children([], [], [])
        try:
            with os.scandir(f"{self._top}/{folder}" if folder else self._top) as entries:
                for count, entry in enumerate(entries):
                    if count == limit:
                        break
                    if not is_litter(entry.name):
                        _add(entry, found)
        except OSError as error:
            if not folder:
                raise InputError(f"cannot read {printable_path(self._top)}: {error.strerror}") from None
        return found

    def first(self, folder: str) -> str | None:
        """Return one name in a folder; None if it is empty or cannot be opened."""
        try:
            with os.scandir(f"{self._top}/{folder}") as entries:
                return next((entry.name for entry in entries if not is_litter(entry.name)), None)
        except OSError:
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
        found.refused.append((entry.name, f"cannot be read: {error.strerror}"))
