"""A zip or tar as a file tree, read where it is: nothing is unpacked to a place with a name.

It is bounded in members, size, ratio and nesting. A name that leads out, a device or a link is
ignored and named.
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
from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, ExitStack
from dataclasses import dataclass, field
from functools import partial
from typing import IO, Any, Literal, NamedTuple

from grader.base.errors import FileError, InputError, MachineError
from grader.base.text import printable_path
from grader.files import limits
from grader.files.limits import ignored_part, is_generated, is_recording, is_setting
from grader.files.reading import advice_for, capped
from grader.files.tree import IS_LINK, File, IgnoredFile, Tree, keep_small, make_tree, parents

_File = IO[bytes]

_MAX_NAME_LENGTH = 4096  # characters
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
_METHODS = (
    zipfile.ZIP_STORED,
    zipfile.ZIP_DEFLATED,
)  # the others unpack without a bound, or are not known at all
_Opener = Callable[[], AbstractContextManager[IO[bytes]]]
_IN_MEMORY = 16 * 1024 * 1024  # bytes
_CHUNK = 1024 * 1024  # bytes
_DECOMPRESSORS: dict[str, Any] = {"gz": gzip.open, "bz2": bz2.open, "xz": lzma.open}


def read_archive(
    file: _File, kind: str, name: str, allowance: limits.Allowance | None = None
) -> Tree:
    """Return the files in an archive.

    `file` is closed with the tree, or at once if it cannot be read (InputError).
    """
    allowance = allowance or limits.Allowance()
    with ExitStack() as opened:
        opened.callback(file.close)
        if kind in ("7z", "rar"):
            raise FileError(
                name, f"is a {kind} archive, which is not supported: submit a .zip or .tar.gz"
            )
        try:
            size = file.seek(0, io.SEEK_END)
            file.seek(0)
            if size > limits.MAX_ARCHIVE_SIZE:
                raise limits.archive_size_error(name)
            limit = max(limits.HARMLESS_SIZE, limits.MAX_RATIO * size)
            if kind in _DECOMPRESSORS:
                stored = opened.enter_context(tempfile.SpooledTemporaryFile(max_size=_IN_MEMORY))
                _decompress(_DECOMPRESSORS[kind](file), stored, name, limit, allowance)
                file = stored
            tree = build_tree(
                zip_members(file) if kind == "zip" else _tar_members(file), name, limit
            )
        except ARCHIVE_ERRORS as error:
            raise FileError(
                name, f"cannot be read as an archive: {error_text(error, name)}"
            ) from None
        sizes = (member.size for member in tree.files.values())
        allowance.spend(name, unpacked=sum(size for size in sizes if size <= limits.MAX_FILE_SIZE))
        weakref.finalize(tree, opened.pop_all().close)
    return tree


def _decompress(
    source: _File, to: _File, name: str, limit: int, allowance: limits.Allowance
) -> None:
    """Decompress a tar up to a limit."""
    total = 0
    while chunk := source.read(_CHUNK):
        total += len(chunk)
        allowance.spend(name, streamed=len(chunk))
        if total > limit:
            raise limits.unpacked_limit_error(name, limit)
        to.write(chunk)
    to.seek(0)


class ArchiveMember(NamedTuple):
    """One entry of an archive.

    `reason` says why one of kind other is not read; `open` gives the content of a file.
    """

    path: str
    kind: Literal["file", "folder", "link", "other"]
    size: int
    open: _Opener
    reason: str = ""


@dataclass(slots=True)
class _SortedMembers:
    """The members of an archive by what becomes of them."""

    kept: dict[str, ArchiveMember] = field(default_factory=dict)
    ignored: list[IgnoredFile] = field(default_factory=list)
    generated: set[str] = field(default_factory=set)
    unseen: set[str] = field(default_factory=set)
    settings: list[File] = field(default_factory=list)

    def add(self, member: ArchiveMember) -> None:
        """Add a member: it is kept, ignored, or only its path counts."""
        path = _path_in_tree(member)
        if isinstance(path, IgnoredFile):
            self.ignored.append(path)
        elif part := ignored_part(path):
            self._add_ignored(member, path, part)
        elif path:
            self.kept[path] = member

    def _add_ignored(self, member: ArchiveMember, path: str, part: str) -> None:
        if is_setting(path) and member.kind == "file":
            self.settings.append(_make_file(member, path))
        if is_generated(path) and member.kind == "file":
            self.generated.add(path)
        self.unseen |= {part} - {path}

    def remove_environments(self) -> None:
        """Remove what is in virtual environments of Python."""
        environments = {
            path.rpartition("/")[0] for path in self.kept if path.endswith("/pyvenv.cfg")
        }
        if environments:
            self.kept = {
                path: member
                for path, member in self.kept.items()
                if environments.isdisjoint(parents(path))
            }

    def list_paths(self, kind: str) -> list[str]:
        """Return the paths of the members of a kind that are kept."""
        return [path for path, member in self.kept.items() if member.kind == kind]


def build_tree(
    members: Iterable[ArchiveMember], name: str, limit: int = limits.MAX_UNPACKED_SIZE
) -> Tree:
    """Return the file tree that the members of an archive make.

    Raises InputError if they are too many or too large.
    """
    entries = _SortedMembers()
    for member in _check_limits(members, name, min(limit, limits.MAX_UNPACKED_SIZE)):
        entries.add(member)
    entries.remove_environments()
    kept = entries.kept
    ignored = entries.ignored
    files = [_make_file(kept[path], path) for path in entries.list_paths("file")]
    ignored += [IgnoredFile(path, member.reason) for path, member in kept.items() if member.reason]
    links = entries.list_paths("link")
    ignored += [IgnoredFile(path, IS_LINK, is_closed=True) for path in links]
    return make_tree(
        name,
        files,
        entries.list_paths("folder"),
        sorted(ignored),
        sorted(entries.generated),
        [*entries.unseen, *links],
        settings=lambda: entries.settings,
    )


def _make_file(member: ArchiveMember, path: str) -> File:
    opened = None
    if is_recording(path) and member.size <= limits.MAX_UNPACKED_SIZE:
        opened = partial(_unpack_member, member, path)
    return File(path, member.size, keep_small(partial(_read_member, member, path)), opened)


def _path_in_tree(member: ArchiveMember) -> str | IgnoredFile:
    """Return the path of a member in the tree, or why it is not read."""
    if len(member.path) > _MAX_NAME_LENGTH:
        shown = f"{printable_path(member.path[:40])}..."
        return IgnoredFile(shown, "has a name that is too long, and was not read")
    path = safe_path(member.path)
    if path is None:
        reason = "has a name that leads out of the archive, and was not read"
        return IgnoredFile(printable_path(member.path), reason)
    return path


def _check_limits(members: Iterable[ArchiveMember], name: str, limit: int) -> list[ArchiveMember]:
    """Return the members of an archive that is within the limits.

    Raises InputError for too many, or too much in those that are not ignored for their size.
    """
    listed = []
    total = 0
    for member in members:
        listed.append(member)
        total += member.size if member.size <= limits.MAX_FILE_SIZE else 0
        if len(listed) > limits.MAX_FILES:
            raise limits.files_limit_error(name)
        if total > limit:
            raise limits.unpacked_limit_error(name, limit)
    return listed


def _read_member(member: ArchiveMember, path: str, limit: int, *, first: bool = False) -> bytes:
    try:
        with member.open() as file:
            data = file.read(limit if first else limit + 1)
    except ARCHIVE_ERRORS as error:
        raise InputError(f"cannot read {path}: {error_text(error, path)}") from None
    return capped(data, limit, path, advice_for(path))


def _unpack_member(member: ArchiveMember, path: str) -> _File:
    """Return a member as a temporary file, which is gone when it is closed."""
    stored = tempfile.TemporaryFile()  # noqa: SIM115  its reader closes it
    try:
        with member.open() as file:
            shutil.copyfileobj(file, stored, _CHUNK)
    except ARCHIVE_ERRORS as error:
        stored.close()
        raise InputError(f"cannot read {path}: {error_text(error, path)}") from None
    stored.seek(0)
    return stored


def zip_members(file: _File) -> Iterator[ArchiveMember]:
    """Yield the members of a zip, which stays open for them."""
    bounded = _BoundedReader(file)
    archive = zipfile.ZipFile(bounded)
    archive.fp = file  # the bound is for the table of contents only
    for info in archive.infolist():
        yield _zip_member(archive, info)


def _zip_member(archive: zipfile.ZipFile, info: zipfile.ZipInfo) -> ArchiveMember:
    name = _zip_name(info)
    mode = info.external_attr >> 16
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


def _zip_name(info: zipfile.ZipInfo) -> str:
    """Return a member's name: many programs write UTF-8 without declaring it."""
    if info.flag_bits & _UTF8:
        return info.filename
    try:
        return info.orig_filename.encode("cp437").decode("utf-8")
    except (UnicodeEncodeError, UnicodeDecodeError):
        return info.filename


class _BoundedReader:
    """A file that refuses to be read in pieces larger than a table of contents may be."""

    def __init__(self, file: _File) -> None:
        self._read = file.read
        self.seek = file.seek
        self.tell = file.tell

    def read(self, size: int = -1) -> bytes:
        """Return the next bytes."""
        if size > _MAX_DIRECTORY_SIZE:
            raise zipfile.BadZipFile("its central directory is too long")
        return self._read(size)


def _tar_members(file: _File) -> Iterator[ArchiveMember]:
    """Yield the members of a tar, which stays open for them."""
    archive = tarfile.open(fileobj=file, mode="r:")  # noqa: SIM115  it is read from as long as its tree lives
    offset = -1
    while (info := archive.next()) is not None:
        if archive.offset <= offset or info.size < 0:
            raise tarfile.TarError("it refers to an earlier position")
        offset = archive.offset
        opened = partial(_open_tar_member, archive, info)
        if info.isfile():
            yield ArchiveMember(info.name, "file", info.size, opened)
        elif info.issym() or info.islnk():
            yield ArchiveMember(info.name, "link", 0, opened)
        else:
            reason = "" if info.isdir() else NOT_REGULAR
            yield ArchiveMember(info.name, "other" if reason else "folder", 0, opened, reason)


def _open_tar_member(archive: tarfile.TarFile, info: tarfile.TarInfo) -> _File:
    return archive.extractfile(info) or io.BytesIO()


def safe_path(name: str) -> str | None:
    """Return a member's name as a printable path inside the archive.

    It is empty for the root of the archive, and None for a name that leads out of it.
    """
    plain = name.replace("\\", "/")
    if plain.startswith("/") or plain[1:2] == ":" or ".." in plain.split("/"):
        return None
    return printable_path("/".join(part for part in plain.split("/") if part not in ("", ".")))


def error_text(error: BaseException, shown: str) -> str:
    """Return what an error of an archive says, fit for a message.

    Raises MachineError if that is not the cause.
    """
    MachineError.check(error, shown)
    return printable_path(" ".join(str(error).split())[:200]) or type(error).__name__
