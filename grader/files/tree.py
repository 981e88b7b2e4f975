"""The file tree of a submission: a folder or an archive looks the same from here on."""

import io
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from typing import IO, Protocol

from grader.base.errors import FileError, InputError
from grader.base.grouping import Strings, distinct
from grader.base.records import Named, Record
from grader.base.text import quoted_end, size_text
from grader.files import limits
from grader.files.limits import ignored_part

IS_LINK = "is a symlink, and was not followed"
_SMALL = 4096  # bytes


class _ContentReader(Protocol):
    """Gives the bytes of a file.

    These are at most `limit` bytes (InputError beyond), or only the first `limit` of them.
    """

    def __call__(self, limit: int, *, first: bool = False) -> bytes:
        """Return the bytes."""


def keep_small(read: _ContentReader) -> _ContentReader:
    """Return a reader that keeps the bytes of a small file.

    A search looks into it before it is read.
    """
    whole = b""

    def content(limit: int, *, first: bool = False) -> bytes:
        nonlocal whole
        if whole and len(whole) < limit:
            return whole
        data = read(limit, first=first)
        whole = data if len(data) < min(limit, _SMALL) else b""
        return data

    return content


class IgnoredFile(Named):
    """A file or folder that is not read, and why: `is encrypted`.

    With `is_closed`, it may contain what has to be graded.
    """

    path: str
    reason: str
    is_closed: bool = False

    def __str__(self) -> str:
        return f"{quoted_end(self.path)} {self.reason}"


class File(Named):
    """One regular file.

    `path` is relative to the submission, with forward slashes, and printable.
    """

    path: str
    size: int
    read: _ContentReader
    open: Callable[[], IO[bytes]] | None = None  # for files that may be larger than others

    def stream(self) -> IO[bytes]:
        """Return the file opened for reading; raises InputError."""
        if self.open is not None:
            return self.open()
        return io.BytesIO(self.read(limits.MAX_FILE_SIZE))

    @property
    def name(self) -> str:
        """The last part of its path."""
        return self.path.rpartition("/")[2]

    @property
    def suffix(self) -> str:
        """The ending of its name, in lower case: .png."""
        name = self.name
        dot = name.rfind(".")
        if 0 < dot < len(name) - 1:
            return name[dot:].lower()
        return ""


class Tree(Record):
    """The files of a submission, and its folders."""

    name: str
    files: Mapping[str, File]  # by path, in alphabetical order
    folders: frozenset[str]  # empty ones included
    ignored: tuple[IgnoredFile, ...] = ()
    generated: Strings = ()  # the paths of files of packages that a build has copied
    unseen: frozenset[str] = frozenset()  # folders and links that were not looked into
    kept: tuple[object, ...] = ()  # the archives that have to stay open
    settings: Callable[[], Iterable[File]] = tuple  # hidden files that say how packages are built

    @property
    def unopened(self) -> tuple[IgnoredFile, ...]:
        """The archives and links in it that were not opened."""
        return tuple(file for file in self.ignored if file.is_closed)

    @property
    def links(self) -> list[str]:
        """The paths of the links in it, which are not followed."""
        return [path for path in sorted(self.unseen) if not ignored_part(f"{path}/")]

    def read(self, path: str, limit: int) -> bytes | None:
        """Return the bytes of a file.

        Returns None where there is none, or none that can be read within a limit.
        """
        if path not in self.files:
            return None
        try:
            return self.files[path].read(limit)
        except InputError:
            return None

    def only(self, belongs: Callable[[str], bool]) -> "Tree":
        """Return the tree of only the files, folders and notes whose paths belong.

        A folder's path ends in a slash.
        """
        files = {path: file for path, file in self.files.items() if belongs(path)}
        folders = frozenset(path for path in self.folders if belongs(f"{path}/"))
        unseen = frozenset(path for path in self.unseen if belongs(f"{path}/"))
        ignored = tuple(file for file in self.ignored if belongs(file.path))
        return Tree(
            self.name,
            files,
            folders,
            ignored,
            tuple(filter(belongs, self.generated)),
            unseen,
            (self,),
        )

    def below(self, folder: str) -> "Tree":
        """Return the files of one folder as a separate tree; their paths are relative to it."""
        if not folder:
            return self
        start = folder + "/"

        def inside(paths: Iterable[str]) -> dict[str, str]:
            return {path.removeprefix(start): path for path in paths if path.startswith(start)}

        contained = {inner: self.files[path] for inner, path in inside(self.files).items()}
        files = {inner: file._replace(path=inner) for inner, file in contained.items()}
        folders = frozenset(inside(self.folders))
        unseen = frozenset(inside(self.unseen))
        return Tree(folder.rpartition("/")[2], files, folders, unseen=unseen, kept=(self,))


def make_tree(
    name: str,
    files: Iterable[File],
    folders: Iterable[str],
    ignored: Iterable[IgnoredFile] = (),
    generated: Iterable[str] = (),
    unseen: Iterable[str] = (),
    kept: tuple[object, ...] = (),
    settings: Callable[[], Iterable[File]] = tuple,
) -> Tree:
    """Return a tree of these files; folders that only their paths name are added.

    Raises InputError for too many.

    A file that is too large is ignored: it is named, and never read.
    """
    by_path = {file.path: file for file in sorted(files, key=lambda file: file.path)}
    large = [_too_large(file) for file in by_path.values() if file.size > limits.MAX_FILE_SIZE]
    by_path |= {
        file.path: by_path[file.path]._replace(read=partial(_refuse, file)) for file in large
    }
    large = [file for file in large if not _is_streamed(by_path[file.path])]
    named = frozenset(folders)
    everything = named | _folders_above([*by_path, *named], name)
    ignored = distinct([*ignored, *large])
    return Tree(
        name,
        by_path,
        everything,
        ignored,
        tuple(generated),
        frozenset(unseen) - everything,
        kept,
        settings,
    )


def _too_large(file: File) -> IgnoredFile:
    limit = f"{size_text(limits.MAX_FILE_SIZE)}, the limit for one file"
    if limits.is_recording(file.path):
        size = limits.MAX_RECORDING_SIZE if file.open else limits.MAX_UNPACKED_SIZE
        limit = f"{size_text(size)}, the limit for a recording"
    return IgnoredFile(
        file.path, f"({file.size / 1e6:.0f} MB) is larger than {limit}, and was ignored"
    )


def _is_streamed(file: File) -> bool:
    is_small = file.size <= limits.MAX_RECORDING_SIZE
    return file.open is not None and limits.is_recording(file.path) and is_small


def _refuse(file: IgnoredFile, limit: int, *, first: bool = False) -> bytes:
    del limit, first
    raise FileError(file.path, file.reason)


def _folders_above(paths: Iterable[str], name: str) -> set[str]:
    """Return every folder that one of these paths is in; raises InputError for too many."""
    above = set()
    for path in paths:
        for parent in parents(path):
            if parent in above:  # and with it those above it
                break
            above.add(parent)
        if len(above) > limits.MAX_FILES:
            raise limits.files_limit_error(name)
    return above


def parents(path: str) -> Iterator[str]:
    """Yield the folders that a path is in, the nearest first."""
    while path := path.rpartition("/")[0]:
        yield path


def overlaid(tree: Tree, files: Mapping[str, bytes | None]) -> Tree:
    """Return a file tree with other content of some files; None for one that is no longer there."""
    kept = [file for path, file in tree.files.items() if path not in files]
    new = [_make_file(path, data) for path, data in files.items() if data is not None]
    return make_tree(
        tree.name, kept + new, tree.folders, tree.ignored, tree.generated, tree.unseen, (tree,)
    )


def _make_file(path: str, data: bytes) -> File:
    def read(limit: int, *, first: bool = False) -> bytes:
        if not first and len(data) > limit:
            raise InputError(f"{path} is larger than {size_text(limit)}")
        return data[:limit]

    return File(path, len(data), read)
