"""The members of an archive, and what the links among them lead to: nothing outside of it."""

from bisect import bisect_left
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from typing import IO, NamedTuple

from grader.files.tree import MOST_FILES, clean, too_many

LONGEST_NAME = 4096  # characters of a name, and of what a link points to
_DEEPEST = 200
_MOST_LINKS = 40  # in a chain
_MOST_STEPS = 500_000  # for all links of an archive


Opener = Callable[[], AbstractContextManager[IO[bytes]]]


class Member(NamedTuple):
    """One entry. `reason` says why one of kind other is not read; `open` gives what is in a file.

    `target` is where a link points to: from its own folder, or, if it is hard, from the top.
    """

    path: str
    kind: str  # file, folder, link or other
    size: int
    open: Opener
    target: str = ""
    is_hard: bool = False
    reason: str = ""


class Links:
    """What the links in an archive lead to: a file, or the files of a folder, which stand below the link, too."""

    def __init__(self, found: Mapping[str, Member], folders: set[str], name: str) -> None:
        self._found = found
        self._real = folders
        self._name = name
        self._paths = sorted(path for path, member in found.items() if member.kind == "file")
        self._left = _MOST_STEPS
        self.files: dict[str, str] = {}  # paths by way of a link, with the real ones
        self.folders: set[str] = set()

    def follow(self, path: str) -> bool:
        """Take in what a link leads to; False where that is not in the archive."""
        real = self._end(path)
        if real is None:
            return False
        if real in self._real:
            self._copy(real, path)
        else:
            self.files[path] = real
        return True

    def _copy(self, folder: str, link: str) -> None:
        """The files of a folder once more below a link to it, if the link is not itself in the folder."""
        start = folder + "/"
        if link.startswith(start):
            return
        self.folders.add(link)
        for index in range(bisect_left(self._paths, start), len(self._paths)):
            path = self._paths[index]
            if not path.startswith(start):
                break
            self.files[f"{link}/{path.removeprefix(start)}"] = path
            if len(self.files) > MOST_FILES:
                raise too_many(self._name)

    def _end(self, path: str) -> str | None:
        """The file or folder at the end of a chain of links; None outside of the archive and in a circle."""
        steps: list[str] = []
        waiting = path.split("/")[::-1]
        links = 0
        while waiting:
            step = clean(waiting.pop())
            self._left -= 1
            if (step == ".." and not steps) or len(steps) > _DEEPEST or self._left < 0:
                return None
            if step in ("", ".", ".."):
                steps = steps[:-1] if step == ".." else steps
                continue
            steps.append(step)
            member = self._found.get("/".join(steps))
            if member is not None and member.kind == "link":
                links += 1
                if links > _MOST_LINKS or member.target.startswith("/") or len(member.target) > LONGEST_NAME:
                    return None
                steps = steps[:-1] if not member.is_hard else []
                waiting += member.target.split("/")[::-1]
        real = "/".join(steps)
        return real if real in self._real or (real in self._found and self._found[real].kind == "file") else None
