"""A zip or tar as a file tree, read where it is: nothing is unpacked to a place with a name.

Bounded in members, size, ratio and nesting. A name that leads out, a device or a link to elsewhere is ignored and
named.
"""

import io
import tempfile
import weakref
from bisect import bisect_left
from collections.abc import Iterable, Iterator, Mapping
from contextlib import ExitStack
from functools import partial
from typing import IO

from grader.errors import FileError, InputError
from grader.files import limits
from grader.files.members import ARCHIVE_ERRORS, MAX_NAME_LENGTH, ArchiveMember, error_text, safe_path, zip_members
from grader.files.names import ignored_part, is_generated
from grader.files.reading import advice_for, capped
from grader.files.tar_members import COMPRESSED_KINDS, compressed_members, tar_members
from grader.files.tree import File, IgnoredFile, Tree, folders_above, keep_small, make_tree, parents
from grader.text import printable_path

_IN_MEMORY = 16 * 1024 * 1024  # bytes
_MAX_DEPTH = 200  # folders above what a link leads to
_MAX_LINKS = 40  # in a chain
_MAX_STEPS = 500_000  # for all links of an archive


def read_archive(file: IO[bytes], kind: str, name: str, allowance: limits.Allowance | None = None) -> Tree:
    """Return the files in an archive. `file` is closed with the tree, or at once if it cannot be read (InputError)."""
    allowance = allowance or limits.Allowance()
    with ExitStack() as opened:
        opened.callback(file.close)
        if kind in ("7z", "rar"):
            raise FileError(name, f"is a {kind} archive, which is not supported: submit a .zip or .tar.gz")
        try:
            size = file.seek(0, io.SEEK_END)
            file.seek(0)
            if size > limits.MAX_ARCHIVE_SIZE:
                raise limits.archive_size_error(name)
            limit = max(limits.HARMLESS_SIZE, limits.MAX_RATIO * size)
            if kind in COMPRESSED_KINDS:
                stored = opened.enter_context(tempfile.SpooledTemporaryFile(max_size=_IN_MEMORY))
                members = compressed_members(file, kind, stored, name, limit, allowance)
            else:
                members = zip_members(file) if kind == "zip" else tar_members(file)
            tree = tree_of(members, name, limit)
        except ARCHIVE_ERRORS as error:
            raise FileError(name, f"cannot be read as an archive: {error_text(error, name)}") from None
        sizes = (member.size for member in tree.files.values())
        allowance.spend(name, unpacked=sum(size for size in sizes if size <= limits.MAX_FILE_SIZE))
        weakref.finalize(tree, opened.pop_all().close)
    return tree


def tree_of(members: Iterable[ArchiveMember], name: str, limit: int = limits.MAX_UNPACKED_SIZE) -> Tree:
    """Return the file tree that the members of an archive make; raises InputError if they are too many or too large."""
    found: dict[str, ArchiveMember] = {}
    ignored: list[IgnoredFile] = []
    generated: set[str] = set()
    unseen: set[str] = set()
    for member in _check_limits(members, name, min(limit, limits.MAX_UNPACKED_SIZE)):
        path = _path(member)
        if isinstance(path, IgnoredFile):
            ignored.append(path)
        elif part := ignored_part(path):
            generated |= {path} if is_generated(path) and member.kind == "file" else set()
            unseen |= {part} - {path}
        elif path:
            found[path] = member
    if environments := {path.rpartition("/")[0] for path in found if path.endswith("/pyvenv.cfg")}:
        found = {path: member for path, member in found.items() if environments.isdisjoint(parents(path))}
    folders = {path for path, member in found.items() if member.kind == "folder"} | folders_above(found, name)
    links = _Links(found, folders, name)
    ignored += _follow(links, found)
    members_at = {path: found[real] for path, real in links.files.items()}
    members_at |= {path: member for path, member in found.items() if member.kind == "file"}
    files = [File(path, member.size, keep_small(partial(_read, member, path))) for path, member in members_at.items()]
    return make_tree(name, files, folders | links.folders, sorted(ignored), sorted(generated), unseen)


def _follow(links: "_Links", found: Mapping[str, ArchiveMember]) -> Iterator[IgnoredFile]:
    """Follow the links of an archive; yield the members that cannot be read, and the links that lead nowhere."""
    for path, member in found.items():
        if member.reason:
            yield IgnoredFile(path, member.reason)
        elif member.kind == "link" and not links.add(path):
            yield IgnoredFile(path, "is a link that leads nowhere in the archive, and was not followed")


def _path(member: ArchiveMember) -> str | IgnoredFile:
    """Return the path of a member in the tree, or why it is not read."""
    if len(member.path) > MAX_NAME_LENGTH:
        shown = f"{printable_path(member.path[:40])}..."
        return IgnoredFile(shown, "has a name that is too long, and was not read")
    path = safe_path(member.path)
    if path is None:
        reason = "has a name that leads out of the archive, and was not read"
        return IgnoredFile(printable_path(member.path), reason)
    return path


def _check_limits(members: Iterable[ArchiveMember], name: str, limit: int) -> list[ArchiveMember]:
    """Return the members; raises InputError for too many, or too much in those that are not ignored for their size."""
    listed: list[ArchiveMember] = []
    total = 0
    for member in members:
        listed.append(member)
        total += member.size if member.size <= limits.MAX_FILE_SIZE else 0
        if len(listed) > limits.MAX_FILES:
            raise limits.files_limit_error(name)
        if total > limit:
            raise limits.unpacked_limit_error(name, limit)
    return listed


def _read(member: ArchiveMember, path: str, limit: int, *, first: bool = False) -> bytes:
    try:
        with member.open() as file:
            data = file.read(limit if first else limit + 1)
    except ARCHIVE_ERRORS as error:
        raise InputError(f"cannot read {path}: {error_text(error, path)}") from None
    return capped(data, limit, path, advice_for(path))


class _Links:
    """The files and folders that links of an archive lead to; the files of a folder are below the link, too."""

    def __init__(self, members: Mapping[str, ArchiveMember], folders: set[str], name: str) -> None:
        self._members, self._real_folders, self._name = members, folders, name
        self._paths = sorted(path for path, member in members.items() if member.kind == "file")
        self._steps_left = _MAX_STEPS
        self.files: dict[str, str] = {}  # paths by way of a link, with the real ones
        self.folders: set[str] = set()

    def add(self, path: str) -> bool:
        """Add what a link leads to, unless that is a folder around it; False where it is not in the archive."""
        real = self._resolve(path)
        if real is None:
            return False
        if real not in self._real_folders:
            self.files[path] = real
        elif not path.startswith(f"{real}/"):
            self.folders.add(path)
            first, end = bisect_left(self._paths, f"{real}/"), bisect_left(self._paths, f"{real}0")  # 0 comes after /
            self.files |= {path + file.removeprefix(real): file for file in self._paths[first:end]}
            if len(self.files) > limits.MAX_FILES:
                raise limits.files_limit_error(self._name)
        return True

    def _resolve(self, path: str) -> str | None:
        """Return the file or folder at the end of a chain of links; None outside of the archive and in a circle."""
        steps: list[str] = []
        waiting = path.split("/")[::-1]
        links = 0
        while waiting:
            step = printable_path(waiting.pop())
            self._steps_left -= 1
            if (step == ".." and not steps) or len(steps) > _MAX_DEPTH or self._steps_left < 0:
                return None
            if step in ("", ".", ".."):
                steps = steps[:-1] if step == ".." else steps
                continue
            steps.append(step)
            member = self._members.get("/".join(steps))
            if member is not None and member.kind == "link":
                links += 1
                if links > _MAX_LINKS or member.target.startswith("/") or len(member.target) > MAX_NAME_LENGTH:
                    return None
                steps = steps[:-1] if not member.is_hard else []
                waiting += member.target.split("/")[::-1]
        real = "/".join(steps)
        is_file = real in self._members and self._members[real].kind == "file"
        return real if is_file or real in self._real_folders else None
