"""What Python's glob, pathlib and os.listdir find in a package, answered from the list of its files."""

import posixpath
import re
import warnings
from collections.abc import Callable, Iterator
from fnmatch import translate
from functools import lru_cache

from grader.files.tree import Tree

# A folder's names come in any order: what depends on it differs between these.
ORDERS = ("sorted", "reversed", "rotated")
_MAGIC = re.compile(r"[*?\[]")
_OUTSIDE = "it looks for files outside of the package"
_COMPILED = "__pycache__"  # what is in it was never written by anyone
_MAX_FOUND = 20_000
_MAX_PATTERN = 1_024
_MAX_PARTS = 50


class BeyondError(Exception):
    """What is looked for cannot be told from the list of a package's files."""


class Listing:
    """The folders of a tree with what is in them, named in one of the possible orders.

    Paths are relative to the tree's root. `names_read` counts the names that were gone through so far.
    """

    def __init__(self, tree: Tree, order: str = ORDERS[0]) -> None:
        self.files = tree.files
        self.folders = tree.folders | tree.unseen | {""}
        self._unseen = {path for path in tree.unseen if path.rpartition("/")[2] != _COMPILED}
        self.names_read = 0
        self.order_matters = False  # whether a search has returned several names
        self._children: dict[str, list[str]] = {}
        for path in sorted([*tree.files, *tree.folders, *tree.unseen], reverse=order == "reversed"):
            folder, _, name = path.rpartition("/")
            self._children.setdefault(folder, []).append(name)
        if order == "rotated":
            self._children = {folder: [*names[1:], names[0]] for folder, names in self._children.items()}

    def names(self, folder: str) -> list[str]:
        """The names of what is in a folder. Raises BeyondError for one that was not looked into."""
        if folder in self._unseen:
            raise BeyondError("it looks into a folder that is not looked at here")
        found = self._children.get(folder, [])
        self.names_read += 1 + len(found)
        return found

    def real(self, path: str) -> str | None:
        """The file or folder that a path leads to, without dots; None where there is nothing. Raises BeyondError."""
        if path.startswith("/"):
            raise BeyondError(_OUTSIDE)
        here = ""
        for index, part in enumerate(path.split("/")):
            if here not in self.folders or not path:
                return None
            if part == "..":
                if not here:
                    raise BeyondError(_OUTSIDE)
                here = here.rpartition("/")[0]
            elif part not in ("", "."):
                here = f"{here}/{part}" if here else part
            elif index and here not in self.folders:
                return None
        return here if here in self.folders or here in self.files else None

    def glob(
        self, pattern: str, *, recursive: bool = False, hidden: bool = False, start: str = "", above: str = ""
    ) -> list[str]:
        """The paths that glob.glob finds, spelt as it spells them. Raises BeyondError.

        `recursive` lets ** stand for any number of folders, `hidden` takes names that begin with a dot, too; `start` is the
        folder that is looked in; `above` is what stands before the tree's root in a full path, and so before each path.
        """
        if pattern.startswith("/"):
            raise BeyondError(_OUTSIDE)
        if len(pattern) > _MAX_PATTERN or pattern.count("/") > _MAX_PARTS:
            raise BeyondError("the pattern is too long to follow")
        found = _Search(self, start, recursive=recursive, hidden=hidden).find(pattern, folders_only=False)
        return [above + path for path in dict.fromkeys(found) if above or path]

    def path_glob(self, folder: str, pattern: str) -> list[str]:
        """The paths below a folder that pathlib's glob finds there, as Python 3.12 does. Raises BeyondError."""
        parts = [part for part in pattern.split("/") if part not in ("", ".")]
        odd = any("**" in part and part != "**" for part in parts) or ".." in parts or pattern.startswith("/")
        if odd or not parts or pattern.endswith(("/", "/.")) or len(parts) > _MAX_PARTS or len(pattern) > _MAX_PATTERN:
            raise BeyondError("a pattern of this kind is not followed")
        start = self.real(folder)
        found = [""] if start in self.folders else []
        for index, part in enumerate(parts):
            step: list[str] = []
            for path in found:
                step += self._path_step(_join(start or "", path), path, part, last=index == len(parts) - 1)
            found = _bounded(list(dict.fromkeys(step)))
        return found

    def below(self, folder: str) -> list[str]:
        """The folders below a folder, relative to it."""
        found: list[str] = []
        waiting = [folder]
        start = len(folder) + 1 if folder else 0
        while waiting:
            here = waiting.pop()
            inner = [path for name in self.names(here) if (path := _join(here, name)) in self.folders]
            waiting += inner
            found += [path[start:] for path in inner]
        return found

    def _path_step(self, real: str, path: str, part: str, *, last: bool) -> list[str]:
        """What one part of a pattern of pathlib's finds in a folder."""
        if part == "**":
            return [path, *(_join(path, each) for each in self.below(real))]
        fits = _matcher(part) if _MAGIC.search(part) else part.__eq__
        names = [name for name in self.names(real) if fits(name)]
        return [_join(path, name) for name in names if last or _join(real, name) in self.folders]


class _Search:
    """One call of glob.glob, step by step as Python's own goes; paths are spelt from the start of the search."""

    def __init__(self, listing: Listing, start: str, *, recursive: bool, hidden: bool) -> None:
        self.listing = listing
        self.start = start
        self.recursive = recursive
        self.hidden = hidden

    def find(self, pattern: str, *, folders_only: bool) -> list[str]:
        """What a pattern, or the folders in front of its last part, finds."""
        folder, last = posixpath.split(pattern)
        if not _MAGIC.search(pattern):
            return [pattern] if self._real(pattern if last else folder, is_folder=not last) is not None else []
        folders = [folder]
        if folder and folder != pattern and _MAGIC.search(folder):
            folders = self.find(folder, folders_only=True)
        found: list[str] = []
        for each in dict.fromkeys(folders):
            found += [posixpath.join(each, name) for name in self._in_folder(each, last, folders_only=folders_only)]
            _bounded(found)
        return found

    def _in_folder(self, folder: str, part: str, *, folders_only: bool) -> Iterator[str]:
        real = self._real(folder, is_folder=True)
        if real is None:
            return
        if not _MAGIC.search(part):
            if not part or self._real(posixpath.join(folder, part)) is not None:
                yield part
        elif part == "**" and self.recursive:
            yield ""
            yield from self._everything(real, folders_only=folders_only)
        else:
            fits = _matcher(part)
            yield from (name for name in self._seen(real, folders_only, part.startswith(".")) if fits(name))

    def _everything(self, folder: str, *, folders_only: bool) -> Iterator[str]:
        waiting = [("", folder)]
        while waiting:
            path, real = waiting.pop()
            for name in self._seen(real, folders_only, dotted=False):
                yield _join(path, name)
                if _join(real, name) in self.listing.folders:
                    waiting.append((_join(path, name), _join(real, name)))

    def _seen(self, folder: str, folders_only: bool, dotted: bool) -> list[str]:
        names = [name for name in self.listing.names(folder) if dotted or self.hidden or name[0] != "."]
        return [name for name in names if _join(folder, name) in self.listing.folders] if folders_only else names

    def _real(self, path: str, *, is_folder: bool = False) -> str | None:
        start = self.listing.real(self.start) if self.start else ""
        if start not in self.listing.folders:
            return None
        real = self.listing.real(posixpath.join(self.start, path) or ".")
        return real if not is_folder or real in self.listing.folders else None


def _join(folder: str, name: str) -> str:
    return f"{folder}/{name}" if folder and name else folder or name


def _bounded(found: list[str]) -> list[str]:
    if len(found) > _MAX_FOUND:
        raise BeyondError("it finds too many files to follow")
    return found


@lru_cache(maxsize=256)
def _matcher(part: str) -> Callable[[str], object]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of a set in brackets that looks as if it held another one
        return re.compile(translate(part)).match
