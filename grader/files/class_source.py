"""The submissions of a class in a folder, or in a zip as an LMS exports it: each is read in place.

No symlink is followed: whose a file is depends on where it really is.
"""

import os
import tempfile
import weakref
from bisect import bisect_left
from contextlib import AbstractContextManager
from dataclasses import replace
from functools import cached_property
from io import BytesIO
from itertools import islice
from pathlib import Path
from typing import IO, TYPE_CHECKING, NamedTuple

from grader.base.errors import FileError, InputError, MachineError
from grader.base.names import last_part
from grader.base.text import printable_path
from grader.files import limits
from grader.files.archive import (
    ARCHIVE_ERRORS,
    NOT_REGULAR,
    ArchiveMember,
    build_tree,
    error_text,
    read_archive,
    safe_path,
    zip_members,
)
from grader.files.folder import file_at, read_folder
from grader.files.limits import (
    ARCHIVES,
    BUILD_FOLDERS,
    IGNORED_FOLDERS,
    LITTER,
    ignored_part,
    is_generated,
)
from grader.files.opening import NOT_AN_ARCHIVE, archive_kind, outer_tree
from grader.files.reading import open_regular, read_capped, read_error
from grader.files.tree import IS_LINK, Tree, make_tree

if TYPE_CHECKING:
    import hashlib

_NOT_REPORTED = LITTER | (IGNORED_FOLDERS - BUILD_FOLDERS)
_CHUNK = 1024 * 1024
_MAX_FOLDERS = 200_000
_MAX_MEMBERS = 200_000
_MAX_DEPTH = 20  # folders: names below do not tell whose a file is
_IN_MEMORY = 16 * 1024 * 1024


class Children(NamedTuple):
    """The names in one folder, unsorted.

    `refused` are names that are not read, each with its reason.
    """

    folders: list[str]
    files: list[str]
    refused: list[tuple[str, str]]


def _is_litter(name: str) -> bool:
    """Return whether a file is not worth reporting.

    Such a file is hidden, or left by an operating system or a tool.
    """
    return name.startswith(".") or name in _NOT_REPORTED


class ClassDirectory:
    """A folder of many submissions, which is the empty path. Raises InputError.

    Names that are not UTF-8 keep their bytes (os.fsdecode).
    """

    def __init__(self, root: Path) -> None:
        self._root = root
        self._top = os.fspath(root)

    def children(self, folder: str, limit: int | None = None) -> Children:
        """Return the names in a folder, at most `limit`.

        Returns none if it cannot be opened, but raises InputError for the top.
        """
        children = Children([], [], [])
        try:
            with os.scandir(f"{self._top}/{folder}" if folder else self._top) as entries:
                for entry in islice(entries, limit):
                    if not _is_litter(entry.name):
                        _add_entry(entry, children)
        except OSError as error:
            refused = read_error(error, printable_path(folder or self._top))
            if not folder:
                raise refused from None
        return children

    def has(self, path: str) -> bool:
        """Return whether there is a file or folder."""
        return os.path.lexists(f"{self._top}/{path}")

    def is_folder(self, path: str) -> bool:
        """Return whether a path is that of a folder."""
        try:
            return Path(self._root, path).is_dir()
        except OSError as error:
            raise read_error(error, printable_path(path)) from None

    def folder(self, path: str) -> Tree:
        """Return the files below a folder."""
        return read_folder(Path(self._root, path), str(self._root))

    def files(self, named: dict[str, str], name: str) -> Tree:
        """Return some files as one tree with the same ignored files as a folder or archive."""
        paths = {printable_path(inner): path for path, inner in named.items()}
        ignored = {inner: part for inner in paths if (part := ignored_part(inner))}
        files = [
            file_at(Path(self._root, paths[inner]), inner, str(self._root))
            for inner in paths
            if inner not in ignored
        ]
        generated = sorted(inner for inner in ignored if is_generated(inner))
        return make_tree(
            name, files, (), generated=generated, unseen=ignored.values() - ignored.keys()
        )

    def read(self, path: str, limit: int) -> bytes:
        """Return the bytes of one file of at most `limit` bytes."""
        shown = printable_path(last_part(path))
        return read_capped(Path(self._root, path), limit, shown=shown, top=str(self._root))

    def raw(self, path: str) -> IO[bytes]:
        """Open one file, whatever it is."""
        return os.fdopen(open_regular(Path(self._root, path), top=str(self._root)), "rb")

    def archive(self, path: str, digest: "hashlib._Hash") -> Tree | None:
        """Return the files of an archive, whose bytes update the digest.

        Returns None for a file of another kind.
        """
        tree = outer_tree(Path(self._root, path), str(self._root))
        try:
            with self.raw(path) if tree else BytesIO() as file:
                while chunk := file.read(_CHUNK):
                    digest.update(chunk)
        except OSError as error:
            raise read_error(error, printable_path(path)) from None
        return tree


def _add_entry(entry: "os.DirEntry[str]", children: Children) -> None:
    try:
        if entry.is_symlink():
            children.refused.append((entry.name, IS_LINK))
        elif entry.is_dir():
            children.folders.append(entry.name)
        elif entry.is_file():
            children.files.append(entry.name)
        else:
            children.refused.append((entry.name, "is not a regular file"))
    except OSError as error:
        MachineError.check(error, printable_path(entry.name))
        children.refused.append((entry.name, f"cannot be read: {error.strerror}"))


class ClassZip:
    """An open zip of many submissions; paths are those of its `members`, with forward slashes.

    Raises InputError.

    `outside` are the members that lead out of it, and cannot be read.
    """

    def __init__(self, path: Path) -> None:
        self._shown = printable_path(path)
        self.members = {}
        self.outside = []
        try:
            file = path.open("rb")
            weakref.finalize(self, file.close)
            for member in zip_members(file):
                if name := safe_path(member.path):
                    self.members[name] = member
                elif name is None:
                    self.outside.append(printable_path(member.path[:100]))
                if len(self.members) + len(self.outside) > _MAX_MEMBERS:
                    raise FileError(self._shown, f"contains more than {_MAX_MEMBERS} files")
        except ARCHIVE_ERRORS as error:
            raise FileError(
                self._shown, f"cannot be read as an archive: {error_text(error, self._shown)}"
            ) from None
        self._names = sorted(self.members)

    def children(self, folder: str, limit: int | None = None) -> Children:
        """Return the names in a folder, at most `limit`."""
        children = Children([], [], [])
        for name, kind in islice(self._folders.get(folder, {}).items(), limit):
            if kind == "folder":
                children.folders.append(name)
            elif kind == "file":
                children.files.append(name)
            else:
                children.refused.append((name, kind))
        return children

    def has(self, path: str) -> bool:
        """Return whether there is a file or folder."""
        return path in self._folders or path in self.members

    @cached_property
    def _folders(self) -> dict[str, dict[str, str]]:
        """The kinds of the children of each folder, by their names."""
        outside = "has a path that leads out of the archive, and was not read"
        folders = {"": dict.fromkeys(self.outside, outside)}
        for path, member in self.members.items():
            _add_member(path.split("/"), member.kind, folders)
            if len(folders) > _MAX_FOLDERS:
                raise InputError(
                    f"{self._shown} contains more than {_MAX_FOLDERS} folders, the limit"
                )
        return folders

    def folder(self, path: str) -> Tree:
        """Return the files below a folder."""
        start = f"{path}/"
        first, end = (
            bisect_left(self._names, start),
            bisect_left(self._names, f"{path}0"),
        )  # 0 comes after /
        below = {name.removeprefix(start): self.members[name] for name in self._names[first:end]}
        return self._tree(below, last_part(path))

    def files(self, named: dict[str, str], name: str) -> Tree:
        """Return some files as one tree, each under its given name."""
        return self._tree({given: self._member(path) for path, given in named.items()}, name)

    def is_folder(self, path: str) -> bool:
        """Return whether a path is that of a folder, or missing."""
        member = self.members.get(path)
        return not member or member.kind == "folder"

    def read(self, path: str, limit: int) -> bytes:
        """Return the bytes of one file of at most `limit` bytes."""
        tree = self.files({path: last_part(path)}, path)
        for file in tree.files.values():
            return file.read(limit)
        raise InputError(str(tree.ignored[0]) if tree.ignored else f"{path} cannot be read")

    def raw(self, path: str) -> AbstractContextManager[IO[bytes]]:
        """Open one file, whatever it is."""
        return self._member(path).open()

    def archive(self, path: str, digest: "hashlib._Hash") -> Tree | None:
        """Return the files of an archive in it, whose bytes update the digest.

        Returns None for a file of another kind.
        """
        member = self._member(path)
        name = last_part(path)
        if member.kind != "file":
            raise FileError(name, member.reason or NOT_REGULAR)
        if member.size > limits.MAX_ARCHIVE_SIZE:
            raise limits.archive_size_error(name)
        kind = None
        stored = tempfile.SpooledTemporaryFile(max_size=_IN_MEMORY)  # noqa: SIM115  its tree closes it
        try:
            kind = _copy_archive(member, stored, digest)
            if kind is not None:
                return read_archive(stored, kind, path)
        except ARCHIVE_ERRORS as error:
            raise InputError(f"cannot read {name}: {error_text(error, name)}") from None
        finally:
            if kind is None:
                stored.close()
        if path.lower().endswith(ARCHIVES):
            raise FileError(path, NOT_AN_ARCHIVE)
        return None

    def _member(self, path: str) -> ArchiveMember:
        member = self.members.get(path)
        if not member:
            raise FileError(path, f"is not in {self._shown}")
        return member

    def _tree(self, members: dict[str, ArchiveMember], name: str) -> Tree:
        """Return a tree of these members under their new paths, which keeps the zip open."""
        try:
            tree = build_tree(
                [member._replace(path=path) for path, member in members.items()], name
            )
        except ARCHIVE_ERRORS as error:
            raise FileError(name, f"cannot be read: {error_text(error, name)}") from None
        return replace(tree, kept=(self,))


def _copy_archive(member: ArchiveMember, to: IO[bytes], digest: "hashlib._Hash") -> str | None:
    """Copy an archive and update the digest.

    Returns its kind, or None for a file that is not an archive.
    """
    with member.open() as content:
        chunk = content.read(_CHUNK)
        kind = archive_kind(chunk[:512])
        while chunk and kind is not None:
            digest.update(chunk)
            to.write(chunk)
            chunk = content.read(_CHUNK)
    return kind


def _add_member(names: list[str], kind: str, folders: dict[str, dict[str, str]]) -> None:
    """Add a member to the folders around it."""
    folder = ""
    for index, name in enumerate(names[:_MAX_DEPTH]):
        if _is_litter(name):
            return
        child = f"{folder}/{name}" if folder else name
        if index + 1 < len(names) or kind == "folder":
            folders[folder][name] = "folder"
            folders.setdefault(child, {})
        else:
            what = IS_LINK if kind == "link" else "file"
            folders[folder].setdefault(name, what)
        folder = child
