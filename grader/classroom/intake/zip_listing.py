"""What lies in a zip of a class, as an LMS gives it: names only. Nothing is unpacked."""

from collections.abc import Iterable
from pathlib import Path

from grader.classroom.intake.listing import Children, is_silent
from grader.errors import InputError
from grader.files.members import ARCHIVE_ERRORS, ArchiveMember, error_text, safe_path
from grader.files.zip_members import zip_members
from grader.text import printable_path

MAX_MEMBERS = 200_000
_DEEPEST = 20  # folders: what lies deeper does not tell who handed in


class ZipListing:
    """A zip of a class. A path in it is a member's name as `safe_path` writes it: decoded, printable, without ways out."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._folders: dict[str, dict[str, str]] = {"": {}}  # of each folder the kinds of its children by name
        try:
            with path.open("rb") as file:
                for count, member in enumerate(zip_members(file)):
                    if count >= MAX_MEMBERS or len(self._folders) > MAX_MEMBERS:
                        raise InputError(f"{printable_path(path)} holds more than {MAX_MEMBERS} files")
                    self._enter(member)
        except ARCHIVE_ERRORS as error:
            raise InputError(f"{printable_path(path)} cannot be read as a zip: {error_text(error)}") from None

    def _enter(self, member: ArchiveMember) -> None:
        place = safe_path(member.path)
        if place is None:
            shown = printable_path(member.path[:100])
            self._folders[""][shown] = "has a name that leads out of the archive, and was not read"
            return
        steps = place.split("/") if place else []
        where = ""
        for index, step in enumerate(steps[:_DEEPEST]):
            if is_silent(step):
                return
            here = f"{where}/{step}" if where else step
            if index + 1 < len(steps) or member.kind == "folder":
                self._folders[where][step] = "folder"
                self._folders.setdefault(here, {})
            else:
                kind = "is a symlink in an archive, and was not followed" if member.kind == "link" else "file"
                self._folders[where].setdefault(step, kind)
            where = here

    def children(self, folder: str, most: int | None = None) -> Children:
        """What is in a folder of the zip."""
        found = Children([], [], [])
        for count, (name, kind) in enumerate(self._folders.get(folder, {}).items()):
            if count == most:
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
        """Some name in a folder of the zip."""
        return next(iter(self._folders.get(folder, ())), None)

    def starts(self, paths: Iterable[str], count: int) -> dict[str, bytes]:
        """The first bytes of some files, of those that can be read."""
        wanted = set(paths)
        starts: dict[str, bytes] = {}
        if not wanted:
            return starts
        with self._path.open("rb") as file:
            for member in zip_members(file):
                place = safe_path(member.path)
                if place in wanted and member.kind == "file":
                    try:
                        with member.open() as opened:
                            starts[place] = opened.read(count)
                    except ARCHIVE_ERRORS:
                        continue
        return starts
