"""A zip or tar as a tree of files, read where it is: nothing is unpacked to a place with a name.

Bounded in members, size, ratio and nesting. A name that leads out, a device or a link to elsewhere is left out and named.
"""

import bz2
import gzip
import io
import lzma
import shutil
import stat
import struct
import tarfile
import tempfile
import weakref
import zipfile
import zlib
from collections.abc import Iterable, Iterator
from functools import partial
from typing import IO, Any

from grader.errors import InputError
from grader.files.members import LONGEST_NAME, Links, Member, Opener
from grader.files.reading import MAX_FILE_SIZE, advice_for, capped
from grader.files.tree import (
    MOST_FILES,
    File,
    Tree,
    clean,
    folders_above,
    ignored_folder,
    is_generated,
    is_ignored,
    make_tree,
    parents,
    too_many,
)

MAX_ARCHIVE_SIZE = 1024 * 1024 * 1024  # bytes of an archive, and of what is decompressed to read it
ARCHIVE_LIMIT = 512 * 1024 * 1024  # bytes of the files in it, without those that are ignored because they are too large
_DIRECTORY_LIMIT = 16 * 1024 * 1024  # bytes of a zip's table of contents
_MOST_RATIO = 200  # what is in an archive, as a multiple of its own size
_HARMLESS = 32 * 1024 * 1024  # bytes that are taken in whatever the ratio
_IN_MEMORY = 16 * 1024 * 1024
_CHUNK = 1024 * 1024
DAMAGED = (
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
    LookupError,
    struct.error,
)
_MOST_ARCHIVES = 20  # in an archive or folder
_ENCRYPTED = 0x1  # a zip's flag
_READ = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)  # the others unpack without a bound, or are not known at all
_NO_FILE = "is not a regular file, and was not read"


_COMPRESSED = ("gz", "bz2", "xz")


class Allowance:
    """How many bytes an archive may unpack to, together with the archives in it.

    `streamed` counts what is decompressed: a compressed tar has to be, files that are ignored included.
    """

    def __init__(self) -> None:
        self.left = ARCHIVE_LIMIT
        self.streamed = MAX_ARCHIVE_SIZE
        self.archives = _MOST_ARCHIVES

    def spend(self, count: int, name: str) -> None:
        """Use up some of it; raises InputError where there is not enough."""
        self.left -= count
        if self.left < 0:
            raise too_much(name, ARCHIVE_LIMIT)

    def stream(self, count: int, name: str) -> None:
        """Use up some of what may be decompressed; raises InputError where there is not enough."""
        self.streamed -= count
        if self.streamed < 0:
            raise too_much(name, MAX_ARCHIVE_SIZE)


def read_archive(file: IO[bytes], kind: str, name: str, allowance: Allowance | None = None) -> Tree:
    """The files in an archive. `file` is closed when the tree is gone, or at once where it cannot be read (InputError)."""
    opened = [file]
    allowance = allowance or Allowance()
    try:
        limit = max(_HARMLESS, _MOST_RATIO * _checked_size(file, kind, name))
        if kind in _COMPRESSED:
            stored = tempfile.SpooledTemporaryFile(max_size=_IN_MEMORY)  # noqa: SIM115  it lives as long as the tree
            opened.append(stored)
            members = _streamed_members(file, kind, stored, name, limit, allowance)
        else:
            members = zip_members(file) if kind == "zip" else _tar_members(file)
        tree = tree_of(bounded(members, name, limit), name)
        allowance.spend(sum(each.size for each in tree.files.values() if each.size <= MAX_FILE_SIZE), name)
    except DAMAGED as error:
        _close(opened)
        raise InputError(f"{name} cannot be read as an archive: {words_of(error)}") from None
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
    if size > MAX_ARCHIVE_SIZE:
        raise InputError(f"{name} is larger than {MAX_ARCHIVE_SIZE} bytes, the limit for an archive")
    return size


def _close(files: list[IO[bytes]]) -> None:
    for file in files:
        file.close()


def bounded(members: Iterable[Member], name: str, limit: int) -> list[Member]:
    """The members of an archive: no more of them, and not more in them, than there may be.

    Those that are ignored because they are too large do not count.
    """
    listed: list[Member] = []
    total = 0
    for member in members:
        listed.append(member)
        total += member.size if member.size <= MAX_FILE_SIZE else 0
        if len(listed) > MOST_FILES:
            raise too_many(name)
        if total > min(limit, ARCHIVE_LIMIT):
            raise too_much(name, min(limit, ARCHIVE_LIMIT))
    return listed


def too_much(name: str, limit: int) -> InputError:
    """What to say of an archive that would unpack to more than a limit."""
    ratio = f", {_MOST_RATIO} times its own size" if _HARMLESS < limit < ARCHIVE_LIMIT else ""
    return InputError(
        f"{name} would unpack to more than {limit} bytes, the limit for an archive{ratio}, and was not read"
    )


def tree_of(members: Iterable[Member], name: str) -> Tree:
    """The tree that the members of an archive make."""
    found: dict[str, Member] = {}
    left_out: list[str] = []
    generated: set[str] = set()
    unseen: set[str] = set()
    for member in members:
        path = inside(member.path) if len(member.path) <= LONGEST_NAME else None
        if len(member.path) > LONGEST_NAME:
            left_out.append(f"{clean(member.path[:40])}... has a name that is far too long, and was not read")
        elif path is None:
            left_out.append(f"{clean(member.path)} has a name that leads out of the archive, and was not read")
        elif path and is_ignored(path):
            generated |= {path} if is_generated(path) and member.kind == "file" else set()
            unseen |= {folder} if (folder := ignored_folder(path)) is not None else set()
        elif path:
            found[path] = member
    environments = {path.rpartition("/")[0] for path in found if path.endswith("/pyvenv.cfg")}
    if environments:
        found = {path: member for path, member in found.items() if environments.isdisjoint(parents(path))}
    folders = {path for path, member in found.items() if member.kind == "folder"} | folders_above(found, name)
    linked = Links(found, folders, name)
    for path, member in found.items():
        if member.reason:
            left_out.append(f"{path} {member.reason}")
        elif member.kind == "link" and not linked.follow(path):
            left_out.append(f"{path} is a link that leads nowhere in the archive, and was not followed")
    real = {path: path for path, member in found.items() if member.kind == "file"}
    files = [
        File(path, found[at].size, partial(_read, found[at], path)) for path, at in {**linked.files, **real}.items()
    ]
    return make_tree(name, files, folders | linked.folders, sorted(left_out), sorted(generated), unseen)


def inside(path: str) -> str | None:
    """A member's name as a path inside the archive; empty for its root; None where it leads out."""
    plain = path.replace("\\", "/")
    if plain.startswith("/") or plain[1:2] == ":" or ".." in plain.split("/"):
        return None
    return clean("/".join(part for part in plain.split("/") if part not in ("", ".")))


def _read(member: Member, path: str, limit: int, *, first: bool = False) -> bytes:
    try:
        with member.open() as file:
            data = file.read(limit if first else limit + 1)
    except DAMAGED as error:
        raise InputError(f"cannot read {path}: {words_of(error)}") from None
    return capped(data, limit, path, advice_for(path))


def zip_members(file: IO[bytes]) -> Iterator[Member]:
    """The members of a zip, which stays open for them."""
    bounded = _Bounded(file)
    archive = zipfile.ZipFile(bounded)
    bounded.most = None
    for info in archive.infolist():
        mode = info.external_attr >> 16
        name = _zip_name(info)
        member = Member(name, "file", info.file_size, partial(archive.open, info))
        if name.endswith(("/", "\\")):
            member = member._replace(kind="folder", size=0)
        elif info.flag_bits & _ENCRYPTED:
            member = member._replace(kind="other", reason="is encrypted, and was not read")
        elif info.compress_type not in _READ:
            member = member._replace(kind="other", reason="is compressed in a way that is not read")
        elif stat.S_ISLNK(mode):
            member = member._replace(kind="link", size=0, target=_zip_link(archive, info))
        elif stat.S_IFMT(mode) not in (0, stat.S_IFREG, stat.S_IFDIR):
            member = member._replace(kind="other", reason=_NO_FILE)
        yield member


def _zip_link(archive: zipfile.ZipFile, info: zipfile.ZipInfo) -> str:
    """What a link points to, which is what is in it; of one that cannot be read nowhere."""
    try:
        with archive.open(info) as file:
            return file.read(LONGEST_NAME).decode("utf-8", "replace")
    except DAMAGED:
        return "/"


def _zip_name(info: zipfile.ZipInfo) -> str:
    """A member's name: where it is not declared as UTF-8, it often is all the same."""
    if info.flag_bits & 0x800:
        return info.filename
    try:
        return info.orig_filename.encode("cp437").decode("utf-8")
    except (UnicodeEncodeError, UnicodeDecodeError):
        return info.filename


def _tar_members(file: IO[bytes]) -> Iterator[Member]:
    for archive, info in _tar_headers(file):
        yield _tar_member(info, partial(_open_tar, archive, info))


def _tar_headers(file: Any) -> Iterator[tuple[tarfile.TarFile, tarfile.TarInfo]]:
    archive = tarfile.open(fileobj=file, mode="r:")  # noqa: SIM115  it is read from as long as its tree lives
    offset = -1
    while (info := archive.next()) is not None:
        if archive.offset <= offset or info.size < 0:
            raise tarfile.TarError("it leads back to its own beginning")
        offset = archive.offset
        yield archive, info


def _tar_member(info: tarfile.TarInfo, opened: Opener) -> Member:
    member = Member(info.name, "file", info.size, opened)
    if info.isdir():
        return member._replace(kind="folder", size=0)
    if info.issym() or info.islnk():
        return member._replace(kind="link", size=0, target=info.linkname, is_hard=info.islnk())
    return member if info.isfile() else member._replace(kind="other", size=0, reason=_NO_FILE)


def _open_tar(archive: tarfile.TarFile, info: tarfile.TarInfo) -> IO[bytes]:
    file = archive.extractfile(info)
    return file if file is not None else io.BytesIO()


_Unpacking = gzip.GzipFile | bz2.BZ2File | lzma.LZMAFile


def _unpacking(file: IO[bytes], kind: str) -> _Unpacking:
    match kind:
        case "gz":
            return gzip.GzipFile(fileobj=file, mode="rb")
        case "bz2":
            return bz2.BZ2File(file)
        case _:
            return lzma.LZMAFile(file)


def _streamed_members(
    file: IO[bytes], kind: str, stored: IO[bytes], name: str, limit: int, allowance: Allowance
) -> Iterator[Member]:
    """The members of a compressed tar, decompressed once: files that are not too large are stored one behind the other."""
    total = 0
    with _unpacking(file, kind) as source:
        counted = _Counted(source, name, limit, allowance)
        for archive, info in _tar_headers(counted):
            member = _tar_member(info, partial(_piece, stored, stored.tell(), info.size))
            if member.kind == "file" and member.size <= MAX_FILE_SIZE:
                total += member.size
                if total > ARCHIVE_LIMIT:  # a sparse file is larger than what is decompressed for it
                    raise too_much(name, ARCHIVE_LIMIT)
                if info.issparse():
                    with _open_tar(archive, info) as content:
                        shutil.copyfileobj(content, stored, _CHUNK)
                else:  # a file object for each of 50,000 files would take a second
                    counted.copy(info.size, stored)
            yield member
        while counted.read(_CHUNK):  # a fault behind the last file is a fault all the same
            pass


class _Counted(io.RawIOBase):
    """What a compressed tar is decompressed to, up to a limit; it is read from its beginning to its end, once."""

    def __init__(self, source: _Unpacking, name: str, limit: int, allowance: Allowance) -> None:
        self._source, self._name, self._limit, self._allowance = source, name, limit, allowance
        self._at = 0

    def read(self, size: int = -1) -> bytes:
        data = self._source.read(size)
        self._at += len(data)
        self._allowance.stream(len(data), self._name)
        if self._at > self._limit:
            raise too_much(self._name, self._limit)
        return data

    def copy(self, size: int, to: IO[bytes] | None = None) -> None:
        """Copy so many bytes, or pass over them."""
        while size > 0:
            data = self.read(min(size, _CHUNK))
            if not data:
                raise EOFError("it ends too early")
            size -= len(data)
            if to is not None:
                to.write(data)

    def seek(self, offset: int, whence: int = 0) -> int:
        if whence or offset < self._at:
            raise tarfile.TarError("it leads back to its own beginning")
        self.copy(offset - self._at)
        return self._at

    def tell(self) -> int:
        return self._at

    def readable(self) -> bool:
        return True


def _piece(file: IO[bytes], start: int, size: int) -> IO[bytes]:
    return io.BufferedReader(_Piece(file, start, size))


class _Piece(io.RawIOBase):
    """Some bytes of a file as a file of their own."""

    def __init__(self, file: IO[bytes], start: int, size: int) -> None:
        self._file, self._at, self._left = file, start, size

    def readinto(self, buffer: Any) -> int:
        self._file.seek(self._at)
        data = self._file.read(min(len(buffer), self._left))
        buffer[: len(data)] = data
        self._at += len(data)
        self._left -= len(data)
        return len(data)

    def readable(self) -> bool:
        return True


class _Bounded(io.RawIOBase):
    """A file that refuses to be read in pieces of more than `most` bytes: no table of contents of a zip is as long."""

    def __init__(self, file: IO[bytes]) -> None:
        self._file = file
        self.most: int | None = _DIRECTORY_LIMIT

    def read(self, size: int = -1) -> bytes:
        if self.most is not None and size > self.most:
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


def words_of(error: BaseException) -> str:
    """What an error says, fit for a message."""
    text = " ".join(str(error).split())
    return clean(text[:200]) or type(error).__name__
