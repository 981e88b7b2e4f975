"""The targets of symlinks and hard links in an archive: nothing outside of it."""

from bisect import bisect_left
from collections.abc import Mapping

from grader.files import limits
from grader.files.members import MAX_NAME_LENGTH, ArchiveMember
from grader.text import printable_path

_MAX_DEPTH = 200  # folders
_MAX_LINKS = 40  # in a chain
_MAX_STEPS = 500_000  # for all links of an archive


class Links:
    """The files and folders that links of an archive lead to; the files of a folder are below the link, too."""

    def __init__(self, members: Mapping[str, ArchiveMember], folders: set[str], name: str) -> None:
        self._members = members
        self._real_folders = folders
        self._name = name
        self._paths = sorted(path for path, member in members.items() if member.kind == "file")
        self._steps_left = _MAX_STEPS
        self.files: dict[str, str] = {}  # paths through a symlink, with the real ones
        self.folders: set[str] = set()

    def add(self, path: str) -> bool:
        """Add what a link leads to; False where that is not in the archive."""
        real = self._resolve(path)
        if real is None:
            return False
        if real in self._real_folders:
            self._add_folder(real, path)
        else:
            self.files[path] = real
        return True

    def _add_folder(self, folder: str, link: str) -> None:
        """Add the files of a folder below a link to it, unless the link is itself in the folder."""
        start = folder + "/"
        if link.startswith(start):
            return
        self.folders.add(link)
        for index in range(bisect_left(self._paths, start), len(self._paths)):
            path = self._paths[index]
            if not path.startswith(start):
                break
            self.files[f"{link}/{path.removeprefix(start)}"] = path
            if len(self.files) > limits.MAX_FILES:
                raise limits.too_many(self._name)

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
