"""The members of an archive, as zip and tar give them alike, and those of a zip."""

import lzma
import stat
import struct
import tarfile
import zipfile
import zlib
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from functools import partial
from typing import IO, Any, Literal, NamedTuple

from grader.errors import MachineError
from grader.text import printable_path

MAX_NAME_LENGTH = 4096  # characters
NOT_REGULAR = "is not a regular file, and was not read"
# What the standard library raises for archives that are damaged or hostile.
ARCHIVE_ERRORS = (
    zipfile.BadZipFile,
    tarfile.TarError,
    zlib.error,
    lzma.LZMAError,
    EOFError,
    NotImplementedError,
    RuntimeError,  # zipfile raises it for a missing password
    ValueError,
    OverflowError,
    MemoryError,
    OSError,
    LookupError,
    struct.error,
)

_MAX_DIRECTORY_SIZE = 16 * 1024 * 1024  # bytes of a zip's table of contents
_ENCRYPTED = 0x1  # flag bits of a member
_UTF8 = 0x800
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)  # the others unpack without a bound, or are not known at all

Opener = Callable[[], AbstractContextManager[IO[bytes]]]


class ArchiveMember(NamedTuple):
    """One entry of an archive. `reason` says why one of kind other is not read; `open` gives the content of a file."""

    path: str
    kind: Literal["file", "folder", "link", "other"]
    size: int
    open: Opener
    reason: str = ""


def safe_path(name: str) -> str | None:
    """Return a member's name as a printable path inside the archive; empty for its root; None where it leads out."""
    plain = name.replace("\\", "/")
    if plain.startswith("/") or plain[1:2] == ":" or ".." in plain.split("/"):
        return None
    return printable_path("/".join(part for part in plain.split("/") if part not in ("", ".")))


def error_text(error: BaseException, shown: str) -> str:
    """Return what an error of an archive says, fit for a message; raises MachineError if that is not the cause."""
    MachineError.check(error, shown)
    return printable_path(" ".join(str(error).split())[:200]) or type(error).__name__


def zip_members(file: IO[bytes]) -> Iterator[ArchiveMember]:
    """Yield the members of a zip, which stays open for them."""
    bounded: Any = _BoundedReader(file)
    archive = zipfile.ZipFile(bounded)
    archive.fp = file  # the bound is for the table of contents only
    for info in archive.infolist():
        yield _member(archive, info)


def _member(archive: zipfile.ZipFile, info: zipfile.ZipInfo) -> ArchiveMember:
    name, mode = _name(info), info.external_attr >> 16
    opened = partial(archive.open, info)
    if name.endswith(("/", "\\")):
        return ArchiveMember(name, "folder", 0, opened)
    reason = ""
    if info.flag_bits & _ENCRYPTED:
        reason = "is encrypted, and was not read"
    elif info.compress_type not in _METHODS:
        reason = "is compressed with a method other than deflate, and was not read"
    elif stat.S_ISLNK(mode):
        return ArchiveMember(name, "link", 0, opened)
    elif stat.S_IFMT(mode) not in (0, stat.S_IFREG, stat.S_IFDIR):
        reason = NOT_REGULAR
    return ArchiveMember(name, "other" if reason else "file", info.file_size, opened, reason=reason)


def _name(info: zipfile.ZipInfo) -> str:
    """Return a member's name: many programs write UTF-8 without declaring it."""
    if info.flag_bits & _UTF8:
        return info.filename
    try:
        return info.orig_filename.encode("cp437").decode("utf-8")
    except (UnicodeEncodeError, UnicodeDecodeError):
        return info.filename


class _BoundedReader:
    """A file that refuses to be read in pieces larger than a table of contents may be."""

    def __init__(self, file: IO[bytes]) -> None:
        self._read, self.seek, self.tell = file.read, file.seek, file.tell

    def read(self, size: int = -1) -> bytes:
        """Return the next bytes."""
        if size > _MAX_DIRECTORY_SIZE:
            raise zipfile.BadZipFile("its central directory is too long")
        return self._read(size)
