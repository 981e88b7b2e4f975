"""The members of a tar: a plain one is read in place, a compressed one is copied to a temporary file."""

import bz2
import gzip
import io
import lzma
import shutil
import tarfile
from collections.abc import Iterator
from functools import partial
from typing import IO, Any

from grader.files import limits
from grader.files.members import NOT_REGULAR, ArchiveMember, Opener

_CHUNK = 1024 * 1024  # bytes
_BACKWARD = "it refers to an earlier position"

_DECOMPRESSORS: dict[str, Any] = {"gz": gzip.open, "bz2": bz2.open, "xz": lzma.open}
COMPRESSED_KINDS = frozenset(_DECOMPRESSORS)


def tar_members(file: IO[bytes]) -> Iterator[ArchiveMember]:
    """Yield the members of a plain tar, which stays open for them."""
    for archive, info in _headers(file):
        yield _member(info, partial(_open, archive, info))


def compressed_members(
    file: IO[bytes], kind: str, stored: IO[bytes], name: str, limit: int, allowance: limits.Allowance
) -> Iterator[ArchiveMember]:
    """Yield the members of a compressed tar, decompressed once: files within the limit are appended to `stored`."""
    total = 0
    with _DECOMPRESSORS[kind](file) as source:
        stream = _Stream(source, name, limit, allowance)
        for archive, info in _headers(stream):
            member = _member(info, partial(_slice, stored, stored.tell(), info.size))
            if member.kind == "file" and member.size <= limits.MAX_FILE_SIZE:
                total += member.size
                if total > limits.MAX_UNPACKED_SIZE:  # a sparse file is larger than its decompressed data
                    raise limits.unpacked_limit_error(name, limits.MAX_UNPACKED_SIZE)
                if info.issparse():
                    with _open(archive, info) as content:
                        shutil.copyfileobj(content, stored, _CHUNK)
                else:  # a file object for each of 50,000 files would take a second
                    stream.copy(info.size, stored)
            yield member
        while stream.read(_CHUNK):  # damage after the last file is found as well
            pass


def _headers(file: Any) -> Iterator[tuple[tarfile.TarFile, tarfile.TarInfo]]:
    archive = tarfile.open(fileobj=file, mode="r:")  # noqa: SIM115  it is read from as long as its tree lives
    offset = -1
    while (info := archive.next()) is not None:
        if archive.offset <= offset or info.size < 0:
            raise tarfile.TarError(_BACKWARD)
        offset = archive.offset
        yield archive, info


def _member(info: tarfile.TarInfo, opened: Opener) -> ArchiveMember:
    if info.issym() or info.islnk():
        return ArchiveMember(info.name, "link", 0, opened, info.linkname, is_hard=info.islnk())
    if info.isfile():
        return ArchiveMember(info.name, "file", info.size, opened)
    if info.isdir():
        return ArchiveMember(info.name, "folder", 0, opened)
    return ArchiveMember(info.name, "other", 0, opened, reason=NOT_REGULAR)


def _open(archive: tarfile.TarFile, info: tarfile.TarInfo) -> IO[bytes]:
    return archive.extractfile(info) or io.BytesIO()


class _Stream:
    """The decompressed bytes of a tar, up to a limit; they are read once, from beginning to end."""

    def __init__(self, source: IO[bytes], name: str, limit: int, allowance: limits.Allowance) -> None:
        self._source, self._name, self._limit, self._allowance = source, name, limit, allowance
        self._position = 0

    def read(self, size: int = -1) -> bytes:
        """Return the next bytes; raises FileError beyond the limit."""
        data = self._source.read(size)
        self._position += len(data)
        self._allowance.spend(self._name, streamed=len(data))
        if self._position > self._limit:
            raise limits.unpacked_limit_error(self._name, self._limit)
        return data

    def copy(self, size: int, to: IO[bytes] | None = None) -> None:
        """Copy so many bytes, or skip them."""
        while size > 0:
            data = self.read(min(size, _CHUNK))
            if not data:
                raise EOFError("it ends too early")
            size -= len(data)
            if to is not None:
                to.write(data)

    def seek(self, offset: int, whence: int = 0) -> int:
        """Skip to an offset further on."""
        if whence or offset < self._position:
            raise tarfile.TarError(_BACKWARD)
        self.copy(offset - self._position)
        return self._position

    def tell(self) -> int:
        """Return the offset."""
        return self._position


def _slice(file: IO[bytes], start: int, size: int) -> IO[bytes]:
    return io.BufferedReader(_Slice(file, start, size))


class _Slice(io.RawIOBase):
    """A range of bytes of a file, as a file."""

    def __init__(self, file: IO[bytes], start: int, size: int) -> None:
        self._file, self._position, self._left = file, start, size

    def readinto(self, buffer: Any) -> int:
        self._file.seek(self._position)
        data = self._file.read(min(len(buffer), self._left))
        buffer[: len(data)] = data
        self._position += len(data)
        self._left -= len(data)
        return len(data)

    def readable(self) -> bool:
        return True
