"""The members of a zip."""

import stat
import zipfile
from collections.abc import Iterator
from functools import partial
from typing import IO, Any

from grader.files.members import ARCHIVE_ERRORS, MAX_NAME_LENGTH, NOT_REGULAR, ArchiveMember

_MAX_DIRECTORY_SIZE = 16 * 1024 * 1024  # bytes of a zip's table of contents
_ENCRYPTED = 0x1  # flag bits of a member
_UTF8 = 0x800
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)  # the others unpack without a limit, or are unknown


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
    if info.flag_bits & _ENCRYPTED:
        return ArchiveMember(name, "other", info.file_size, opened, reason="is encrypted, and was not read")
    if info.compress_type not in _METHODS:
        reason = "is compressed with a method other than deflate, and was not read"
        return ArchiveMember(name, "other", info.file_size, opened, reason=reason)
    if stat.S_ISLNK(mode):
        return ArchiveMember(name, "link", 0, opened, target=_target(archive, info))
    if stat.S_IFMT(mode) not in (0, stat.S_IFREG, stat.S_IFDIR):
        return ArchiveMember(name, "other", info.file_size, opened, reason=NOT_REGULAR)
    return ArchiveMember(name, "file", info.file_size, opened)


def _target(archive: zipfile.ZipFile, info: zipfile.ZipInfo) -> str:
    """Return where a symlink points to, which is its content; `/` (outside) where that cannot be read."""
    try:
        with archive.open(info) as file:
            return file.read(MAX_NAME_LENGTH).decode("utf-8", "replace")
    except ARCHIVE_ERRORS:
        return "/"


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
