"""A folder with the submissions of a class. No symlink is followed: whose a file is depends on where it really is."""

import os
from io import BytesIO
from itertools import islice
from pathlib import Path
from typing import IO, TYPE_CHECKING

from grader.errors import MachineError
from grader.files.children import Children, is_litter
from grader.files.folder import file_at, read_folder
from grader.files.names import ignored_part, is_generated
from grader.files.opening import outer_tree
from grader.files.reading import open_regular, read_capped, read_error
from grader.files.tree import IS_LINK, Tree, make_tree
from grader.text import printable_path

if TYPE_CHECKING:
    import hashlib

_CHUNK = 1024 * 1024


class ClassDirectory:
    """A folder of many submissions, which is the empty path. Raises InputError.

    Names that are not UTF-8 keep their bytes (os.fsdecode).
    """

    def __init__(self, root: Path) -> None:
        self._root, self._top = root, os.fspath(root)

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

    def has(self, path: str) -> bool:
        """Return whether there is a file or folder."""
        return os.path.lexists(f"{self._top}/{path}")

    def is_folder(self, path: str) -> bool:
        """Return whether a path is that of a folder."""
        return Path(self._root, path).is_dir()

    def folder(self, path: str) -> Tree:
        """Return the files below a folder."""
        return read_folder(Path(self._root, path), str(self._root))

    def files(self, named: dict[str, str], name: str) -> Tree:
        """Return some files as one tree with the same ignored files as a folder or archive."""
        paths = {printable_path(inner): path for path, inner in named.items()}
        ignored = {inner: part for inner in paths if (part := ignored_part(inner))}
        files = [
            file_at(Path(self._root, paths[inner]), inner, str(self._root)) for inner in paths if inner not in ignored
        ]
        generated = sorted(inner for inner in ignored if is_generated(inner))
        return make_tree(name, files, (), generated=generated, unseen=ignored.values() - ignored.keys())

    def read(self, path: str, limit: int) -> bytes:
        """Return the bytes of one file of at most `limit` bytes."""
        shown = printable_path(path.rpartition("/")[2])
        return read_capped(Path(self._root, path), limit, shown=shown, top=str(self._root))

    def raw(self, path: str) -> IO[bytes]:
        """Open one file, whatever it is."""
        return os.fdopen(open_regular(Path(self._root, path), top=str(self._root)), "rb")

    def archive(self, path: str, digest: "hashlib._Hash") -> Tree | None:
        """Return the files of an archive, whose bytes update the digest; None for a file of another kind."""
        tree = outer_tree(Path(self._root, path), str(self._root))
        try:
            with self.raw(path) if tree is not None else BytesIO() as file:
                while chunk := file.read(_CHUNK):
                    digest.update(chunk)
        except OSError as error:
            raise read_error(error, printable_path(path)) from None
        return tree


def _add(entry: "os.DirEntry[str]", found: Children) -> None:
    try:
        if entry.is_symlink():
            found.refused.append((entry.name, IS_LINK))
        elif entry.is_dir():
            found.folders.append(entry.name)
        elif entry.is_file():
            found.files.append(entry.name)
        else:
            found.refused.append((entry.name, "is not a regular file"))
    except OSError as error:
        MachineError.check(error, printable_path(entry.name))
        found.refused.append((entry.name, f"cannot be read: {error.strerror}"))
