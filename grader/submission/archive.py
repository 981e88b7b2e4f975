"""A zip or tar as a tree of files, read where it is: nothing is unpacked to a place with a name.

Bounded in members, size, ratio and nesting. A name that leads out, a device or a link to elsewhere is left out and named.
"""

import bz2
import gzip
import io
import lzma
import stat
import tarfile
import tempfile
import weakref
import zipfile
import zlib
from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager
from functools import partial
from typing import IO, NamedTuple

from grader.errors import InputError
from grader.submission.files import capped
from grader.submission.tree import MOST_FILES, File, Tree, clean, is_generated, is_ignored, make_tree, parents, too_many

ARCHIVE_LIMIT = 512 * 1024 * 1024  # bytes of an archive, and of what is in it
_DIRECTORY_LIMIT = 16 * 1024 * 1024  # bytes of a zip's table of contents
_MOST_RATIO = 200  # what is in an archive, as a multiple of its own size
_HARMLESS = 32 * 1024 * 1024  # bytes that are taken in whatever the ratio
_IN_MEMORY = 16 * 1024 * 1024
_CHUNK = 1024 * 1024
_DAMAGED = (
    zipfile.BadZipFile,
    tarfile.TarError,
    zlib.error,
    lzma.LZMAError,
    EOFError,
    NotImplementedError,
    RuntimeError,  # zipfile's word for a missing password
    ValueError,
    OverflowError,
    MemoryError,
    OSError,
)


_COMPRESSED = ("gz", "bz2", "xz")


class _Member(NamedTuple):
    """One entry: `target` is where a link points to, `open` gives what is in a file."""

    path: str
    kind: str  # file, folder, link or other
    size: int
    target: str
    open: Callable[[], AbstractContextManager[IO[bytes]]]


def read_archive(file: IO[bytes], kind: str, name: str) -> Tree:
    """The files in an archive. `file` is closed when the tree is gone, or at once where it cannot be read (InputError)."""
    opened = [file]
    try:
        size = _checked_size(file, kind, name)
        if kind in _COMPRESSED:
            opened.append(tempfile.SpooledTemporaryFile(max_size=_IN_MEMORY))  # noqa: SIM115  it lives as long as the tree
            _decompress(file, kind, opened[1], max(_HARMLESS, min(ARCHIVE_LIMIT, _MOST_RATIO * size)), name)
        members = _zip_members(file) if kind == "zip" else _tar_members(opened[-1])
        tree = _tree(members, size, name)
    except _DAMAGED as error:
        _close(opened)
        raise InputError(f"{name} cannot be read as an archive: {_words(error)}") from None
    except InputError:
        _close(opened)
        raise
    weakref.finalize(tree, _close, opened)
    return tree


def _checked_size(file: IO[bytes], kind: str, name: str) -> int:
    if kind in ("7z", "rar"):
        raise InputError(f"{name} is a {kind} archive, which is not read: hand in a .zip or .tar.gz")
    size = file.seek(0, io.SEEK_END)
    file.seek(0)
    if size > ARCHIVE_LIMIT:
        raise InputError(f"{name} is larger than {ARCHIVE_LIMIT} bytes, the limit for an archive")
    return size


def _close(files: list[IO[bytes]]) -> None:
    for file in files:
        file.close()


def _tree(members: Iterable[_Member], size: int, name: str) -> Tree:
    found: dict[str, _Member] = {}
    left_out: list[str] = []
    generated: list[str] = []
    total = 0
    for count, member in enumerate(members, 1):
        if count > MOST_FILES:
            raise too_many(name)
        total += member.size
        if total > ARCHIVE_LIMIT or (total > _HARMLESS and total > _MOST_RATIO * max(size, 1)):
            raise InputError(f"{name} would unpack to far more than anyone hands in, and was not read")
        path = _inside(member.path)
        if path is None:
            left_out.append(f"{clean(member.path)} has a name that leads out of the archive, and was not read")
        elif path and is_ignored(path):
            if is_generated(path):
                generated.append(path)
        elif path:
            found[path] = member
    environments = {path.rpartition("/")[0] for path in found if path.endswith("/pyvenv.cfg")}
    files: list[File] = []
    for path in found:
        if environments and not environments.isdisjoint(parents(path)):
            continue
        real = _follow(path, found)
        if real is None:
            left_out.append(f"{path} is a link that leads nowhere in the archive, and was not followed")
        elif real.kind == "file":
            files.append(File(path, real.size, partial(_read, real, path)))
        elif real.kind == "other":
            left_out.append(f"{path} is not a regular file, and was not read")
    folders = [path for path, member in found.items() if member.kind == "folder"]
    return make_tree(name, files, folders, sorted(left_out), sorted(generated))


def _inside(path: str) -> str | None:
    """A member's name as a path inside the archive; empty for its root; None where it leads out."""
    plain = path.replace("\\", "/")
    if plain.startswith("/") or plain[1:2] == ":" or ".." in plain.split("/"):
        return None
    return clean("/".join(part for part in plain.split("/") if part not in ("", ".")))


def _follow(path: str, found: dict[str, _Member]) -> _Member | None:
    """The member that a link leads to in the end, or the member itself."""
    member = found.get(path)
    for _ in range(8):
        if member is None or member.kind != "link":
            return member
        steps: list[str] = [] if member.target.startswith("\0") else path.split("/")[:-1]
        for step in member.target.removeprefix("\0").split("/"):
            if step == "..":
                if not steps:
                    return None
                steps.pop()
            elif step not in ("", "."):
                steps.append(step)
        path = "/".join(steps)
        member = None if member.target.startswith("/") else found.get(path)
    return None


def _read(member: _Member, path: str, limit: int, *, first: bool = False) -> bytes:
    try:
        with member.open() as file:
            data = file.read(limit if first else limit + 1)
    except _DAMAGED as error:
        raise InputError(f"cannot read {path}: {_words(error)}") from None
    return capped(data, limit, path)


def _zip_members(file: IO[bytes]) -> Iterator[_Member]:
    archive = zipfile.ZipFile(_Bounded(file))
    for info in archive.infolist():
        mode = info.external_attr >> 16
        kind = "folder" if info.is_dir() else "file"
        target = ""
        if stat.S_ISLNK(mode):
            kind, target = "link", archive.open(info).read(4096).decode("utf-8", "replace")
        elif mode and not stat.S_ISREG(mode) and not stat.S_ISDIR(mode) and stat.S_IFMT(mode):
            kind = "other"
        yield _Member(_zip_name(info), kind, info.file_size, target, partial(archive.open, info))


def _zip_name(info: zipfile.ZipInfo) -> str:
    """A member's name: where it is not declared as UTF-8, it often is all the same."""
    if info.flag_bits & 0x800:
        return info.filename
    try:
        return info.orig_filename.encode("cp437").decode("utf-8")
    except (UnicodeEncodeError, UnicodeDecodeError):
        return info.filename


def _tar_members(file: IO[bytes]) -> Iterator[_Member]:
    archive = tarfile.open(fileobj=file, mode="r:")  # noqa: SIM115  it is read from as long as its tree lives
    offset = -1
    while (info := archive.next()) is not None:
        if archive.offset <= offset or info.size < 0:
            raise tarfile.TarError("it leads back to its own beginning")
        offset = archive.offset
        kind = "file" if info.isfile() else "folder" if info.isdir() else "other"
        target = ""
        if info.issym() or info.islnk():
            kind, target = "link", ("" if info.issym() else "\0") + info.linkname
        yield _Member(info.name, kind, info.size, target, partial(_open_tar, archive, info))


def _open_tar(archive: tarfile.TarFile, info: tarfile.TarInfo) -> IO[bytes]:
    file = archive.extractfile(info)
    return file if file is not None else io.BytesIO()


def _unpacking(file: IO[bytes], kind: str) -> gzip.GzipFile | bz2.BZ2File | lzma.LZMAFile:
    match kind:
        case "gz":
            return gzip.GzipFile(fileobj=file)
        case "bz2":
            return bz2.BZ2File(file)
        case _:
            return lzma.LZMAFile(file)


def _decompress(file: IO[bytes], kind: str, plain: IO[bytes], limit: int, name: str) -> None:
    """Unpack a compressed tar into a file that is in memory or, where it is large, has no name."""
    with _unpacking(file, kind) as source:
        while chunk := source.read(_CHUNK):
            plain.write(chunk)
            if plain.tell() > limit:
                raise InputError(f"{name} would unpack to far more than anyone hands in, and was not read")
    plain.seek(0)


class _Bounded(io.RawIOBase):
    """A file that refuses to be read in pieces as large as no table of contents of a zip is."""

    def __init__(self, file: IO[bytes]) -> None:
        self._file = file

    def read(self, size: int = -1) -> bytes:
        if size > _DIRECTORY_LIMIT:
            raise zipfile.BadZipFile("its table of contents is far too long")
        return self._file.read(size)

    def seek(self, offset: int, whence: int = 0) -> int:
        return self._file.seek(offset, whence)

    def tell(self) -> int:
        return self._file.tell()

    def seekable(self) -> bool:
        return True

    def readable(self) -> bool:
        return True


def _words(error: BaseException) -> str:
    text = " ".join(str(error).split())
    return clean(text[:200]) or type(error).__name__
