"""The names in a class zip, as an LMS exports it. Nothing is extracted."""

from collections.abc import Iterable
from pathlib import Path

from grader.classroom.intake.listing import Children, is_litter
from grader.errors import InputError
from grader.files.members import ARCHIVE_ERRORS, ArchiveMember, error_text, safe_path
from grader.files.zip_members import zip_members
from grader.text import printable_path

MAX_MEMBERS = 200_000
_MAX_DEPTH = 20  # folders: names below do not identify the owner of a file


class ZipListing:
    """A class zip. A path in it is a member's name as `safe_path` writes it: decoded, printable, without `..`."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._folders: dict[str, dict[str, str]] = {"": {}}  # of each folder the kinds of its children by name
        try:
            with path.open("rb") as file:
                for count, member in enumerate(zip_members(file)):
                    if count >= MAX_MEMBERS or len(self._folders) > MAX_MEMBERS:
                        raise InputError(f"{printable_path(path)} contains more than {MAX_MEMBERS} files, the limit")
                    self._add(member)
        except ARCHIVE_ERRORS as error:
            raise InputError(f"{printable_path(path)} cannot be read as a zip: {error_text(error)}") from None

    def _add(self, member: ArchiveMember) -> None:
        path = safe_path(member.path)
        if path is None:
            shown = printable_path(member.path[:100])
            self._folders[""][shown] = "has a path that leads out of the archive, and was not read"
            return
        names = path.split("/") if path else []
        folder = ""
        for index, name in enumerate(names[:_MAX_DEPTH]):
            if is_litter(name):
                return
            child = f"{folder}/{name}" if folder else name
            if index + 1 < len(names) or member.kind == "folder":
                self._folders[folder][name] = "folder"
                self._folders.setdefault(child, {})
            else:
                kind = "is a symlink in an archive, and was not followed" if member.kind == "link" else "file"
                self._folders[folder].setdefault(name, kind)
            folder = child

    def children(self, folder: str, limit: int | None = None) -> Children:
        """Return the names in a folder."""
        found = Children([], [], [])
        for count, (name, kind) in enumerate(self._folders.get(folder, {}).items()):
            if count == limit:
                break
            match kind:
                case "folder":
                    found.folders.append(name)
                case "file":
                    found.files.append(name)
                case _:
                    found.refused.append((name, kind))
        return found

    def first(self, folder: str) -> str | None:
        """Return one name in a folder."""
        return next(iter(self._folders.get(folder, ())), None)

    def starts(self, paths: Iterable[str], count: int) -> dict[str, bytes]:
        """Return the first bytes of those files that can be read."""
        wanted = set(paths)
        starts: dict[str, bytes] = {}
        if not wanted:
            return starts
        with self._path.open("rb") as file:
            for member in zip_members(file):
                path = safe_path(member.path)
                if path in wanted and member.kind == "file":
                    try:
                        with member.open() as opened:
                            starts[path] = opened.read(count)
                    except ARCHIVE_ERRORS:
                        continue
        return starts
