"""A zip or tar as a file tree, read where it is: nothing is unpacked to a place with a name.

Bounded in members, size, ratio and nesting. A name that leads out, a device or a link to elsewhere is ignored and named.
"""

import io
import tempfile
import weakref
from collections.abc import Iterable
from functools import partial
from typing import IO

from grader.errors import FileError, InputError
from grader.files import limits
from grader.files.ignore_rules import ignored_part, is_generated
from grader.files.links import Links
from grader.files.members import ARCHIVE_ERRORS, MAX_NAME_LENGTH, ArchiveMember, error_text, safe_path
from grader.files.reading import advice_for, capped
from grader.files.tar_members import COMPRESSED_KINDS, compressed_members, tar_members
from grader.files.tree import File, IgnoredFile, Tree, folders_above, make_tree, parents
from grader.files.zip_members import zip_members
from grader.text import printable_path

_IN_MEMORY = 16 * 1024 * 1024  # bytes


def read_archive(file: IO[bytes], kind: str, name: str, allowance: limits.Allowance | None = None) -> Tree:
    """Return the files in an archive. `file` is closed with the tree, or at once where it cannot be read (InputError)."""
    opened = [file]
    allowance = allowance or limits.Allowance()
    try:
        limit = max(limits.HARMLESS_SIZE, limits.MAX_RATIO * _checked_size(file, kind, name))
        if kind in COMPRESSED_KINDS:
            stored = tempfile.SpooledTemporaryFile(max_size=_IN_MEMORY)  # noqa: SIM115  it lives as long as the tree
            opened.append(stored)
            members = compressed_members(file, kind, stored, name, limit, allowance)
        else:
            members = zip_members(file) if kind == "zip" else tar_members(file)
        tree = tree_of(members, name, limit)
        readable = (file.size for file in tree.files.values() if file.size <= limits.MAX_FILE_SIZE)
        allowance.spend(name, unpacked=sum(readable))
    except (*ARCHIVE_ERRORS, InputError) as error:
        _close(opened)
        if isinstance(error, InputError):
            raise
        raise FileError(name, f"cannot be read as an archive: {error_text(error)}") from None
    weakref.finalize(tree, _close, opened)
    return tree


def _checked_size(file: IO[bytes], kind: str, name: str) -> int:
    if kind in ("7z", "rar"):
        raise FileError(name, f"is a {kind} archive, which is not supported: submit a .zip or .tar.gz")
    size = file.seek(0, io.SEEK_END)
    file.seek(0)
    if size > limits.MAX_ARCHIVE_SIZE:
        raise limits.too_large(name)
    return size


def _close(files: list[IO[bytes]]) -> None:
    for file in files:
        file.close()


def tree_of(members: Iterable[ArchiveMember], name: str, limit: int = limits.MAX_UNPACKED_SIZE) -> Tree:
    """Return the file tree that the members of an archive make; raises InputError for too many, and for too much in them."""
    found: dict[str, ArchiveMember] = {}
    ignored: list[IgnoredFile] = []
    generated: set[str] = set()
    unseen: set[str] = set()
    for member in _bounded(members, name, min(limit, limits.MAX_UNPACKED_SIZE)):
        path = safe_path(member.path) if len(member.path) <= MAX_NAME_LENGTH else None
        if len(member.path) > MAX_NAME_LENGTH:
            shown = f"{printable_path(member.path[:40])}..."
            ignored.append(IgnoredFile(shown, "has a name that is too long, and was not read"))
        elif path is None:
            reason = "has a name that leads out of the archive, and was not read"
            ignored.append(IgnoredFile(printable_path(member.path), reason))
        elif part := ignored_part(path):
            generated |= {path} if is_generated(path) and member.kind == "file" else set()
            unseen |= {part} - {path}
        elif path:
            found[path] = member
    environments = {path.rpartition("/")[0] for path in found if path.endswith("/pyvenv.cfg")}
    if environments:
        found = {path: member for path, member in found.items() if environments.isdisjoint(parents(path))}
    folders = {path for path, member in found.items() if member.kind == "folder"} | folders_above(found, name)
    links = Links(found, folders, name)
    for path, member in found.items():
        if member.reason:
            ignored.append(IgnoredFile(path, member.reason))
        elif member.kind == "link" and not links.add(path):
            ignored.append(IgnoredFile(path, "is a link that leads nowhere in the archive, and was not followed"))
    real = {path: path for path, member in found.items() if member.kind == "file"}
    files = [
        File(path, found[at].size, partial(_read, found[at], path)) for path, at in {**links.files, **real}.items()
    ]
    return make_tree(name, files, folders | links.folders, sorted(ignored), sorted(generated), unseen)


def _bounded(members: Iterable[ArchiveMember], name: str, limit: int) -> list[ArchiveMember]:
    """Return the members; raises InputError for too many, or too much in those that are not ignored for their size."""
    listed: list[ArchiveMember] = []
    total = 0
    for member in members:
        listed.append(member)
        total += member.size if member.size <= limits.MAX_FILE_SIZE else 0
        if len(listed) > limits.MAX_FILES:
            raise limits.too_many(name)
        if total > limit:
            raise limits.too_much(name, limit)
    return listed


def _read(member: ArchiveMember, path: str, limit: int, *, first: bool = False) -> bytes:
    try:
        with member.open() as file:
            data = file.read(limit if first else limit + 1)
    except ARCHIVE_ERRORS as error:
        raise InputError(f"cannot read {path}: {error_text(error)}") from None
    return capped(data, limit, path, advice_for(path))
