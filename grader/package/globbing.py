"""The results of Python's glob, pathlib and os.listdir in a package, from the list of its files."""

import posixpath
import re
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fnmatch import translate
from functools import lru_cache
from itertools import chain
from typing import NamedTuple

from grader.files.tree import Tree
from grader.static_python.budget import Budget
from grader.static_python.parse import Position
from grader.static_python.values import Value

# The file system lists a folder, and Python a set, in any order: a result that depends on the order differs between
# these.
ORDERS = ("sorted", "reversed", "rotated")
_MAGIC = re.compile(r"[*?\[]")
_OUTSIDE = "it searches for files outside of the package"
_COMPILED = "__pycache__"  # its files are made by Python
_MAX_FOUND = 20_000
_MAX_RECORDED = 200  # paths of one search whose position is kept
_MAX_PATTERN = 1_024
_MAX_PARTS = 50


class SearchError(Exception):
    """A search that the list of a package's files does not answer."""


class EmptyGlob(NamedTuple):
    """A pattern that matches no file."""

    pattern: str
    at: Position


class PackageListing:
    """The folders of a file tree, listed in one of the possible orders. Paths are relative to the tree's root."""

    def __init__(self, tree: Tree, budget: Budget | None = None, order: str = ORDERS[0]) -> None:
        self.tree = tree
        self.budget = budget or Budget()
        self.files = tree.files
        self.folders = tree.folders | tree.unseen | {""}
        self._unseen = {path for path in tree.unseen if path.rpartition("/")[2] != _COMPILED}
        self.order_matters = False  # whether a search has returned several names
        self.positions: dict[str, Position] = {}  # of the searches that found a path
        self.empty: dict[EmptyGlob, None] = {}  # in the order of the searches
        self._children: dict[str, list[str]] = {}
        self._order = order
        for path in sorted([*tree.files, *tree.folders, *tree.unseen]):
            folder, _, name = path.rpartition("/")
            self._children.setdefault(folder, []).append(name)
        self._children = {folder: self.ordered(names) for folder, names in self._children.items()}

    def ordered(self, values: list[Value]) -> list[Value]:
        """Return sorted values in this order."""
        match self._order:
            case "reversed":
                return values[::-1]
            case "rotated":
                return [*values[1:], *values[:1]]
        return values

    def record(self, pattern: str, found: list[Value], at: Position) -> list[Value]:
        """Keep the position of a search for each path that it found, up to a limit, and return the paths."""
        self.positions |= dict.fromkeys(map(str, found[:_MAX_RECORDED]), at)
        if not found:
            self.empty[EmptyGlob(pattern, at)] = None
        return found

    def names(self, folder: str) -> list[str]:
        """Return the names in a folder. Raises SearchError for an ignored folder."""
        if folder in self._unseen:
            raise SearchError("it searches an ignored folder")
        found = self._children.get(folder, [])
        self.budget.charge(1 + len(found))
        return found

    def modules(self) -> frozenset[str]:
        """Return the names of the modules and packages beside setup.py, which are imported before any other."""
        files = (name.removesuffix(".py") for name in self._children.get("", ()) if name.endswith(".py"))
        packages = (name for name in self._children.get("", ()) if f"{name}/__init__.py" in self.files)
        return frozenset((*files, *packages)) - {"setup"}

    def real(self, path: str) -> str | None:
        """Return the file or folder at a path, without dots; None where there is nothing. Raises SearchError."""
        if path.startswith("/"):
            raise SearchError(_OUTSIDE)
        here = ""
        self.budget.charge(1, len(path))
        for index, part in enumerate(path.split("/")):
            if here not in self.folders or not path:
                return None
            if part == "..":
                if not here:
                    raise SearchError(_OUTSIDE)
                here = here.rpartition("/")[0]
            elif part not in ("", "."):
                here = f"{here}/{part}" if here else part
            elif index and here not in self.folders:
                return None
        return here if here in self.folders or here in self.files else None

    def glob(self, pattern: str, *, recursive: bool = False, above: str = "") -> list[str]:
        """Return the paths that glob.glob finds, as it writes them. Raises SearchError.

        `recursive` lets ** match any number of folders; `above` is the absolute path of the tree's root, which precedes
        each path.
        """
        if pattern.startswith("/"):
            raise SearchError(_OUTSIDE)
        if len(pattern) > _MAX_PATTERN or pattern.count("/") > _MAX_PARTS:
            raise SearchError("the pattern is too long")
        found = _GlobSearch(self, recursive).find(pattern, folders_only=False)
        return [above + path for path in dict.fromkeys(found) if above or path]

    def path_glob(self, folder: str, pattern: str) -> list[str]:
        """Return the paths below a folder that pathlib's glob finds in Python 3.12. Raises SearchError."""
        parts = [part for part in pattern.split("/") if part not in ("", ".")]
        odd = any("**" in part and part != "**" for part in parts) or ".." in parts or pattern.startswith("/")
        if odd or not parts or pattern.endswith(("/", "/.")) or len(parts) > _MAX_PARTS or len(pattern) > _MAX_PATTERN:
            raise SearchError("a pattern of this kind is not supported")
        start = self.real(folder)
        found = [""] if start in self.folders else []
        for index, part in enumerate(parts):
            last = index == len(parts) - 1
            steps = (self._path_step(_join(start or "", path), path, part, last=last) for path in found)
            found = _limit(list(dict.fromkeys(chain.from_iterable(steps))))
        return found

    def _path_step(self, real: str, path: str, part: str, *, last: bool) -> list[str]:
        """Return what one part of a pathlib pattern matches in a folder."""
        if part == "**":
            folders = _GlobSearch(self, hidden=True).descendants(real, folders_only=True)
            return [path, *(_join(path, folder) for folder in folders)]
        matches = _matcher(part) if _MAGIC.search(part) else part.__eq__
        names = [name for name in self.names(real) if matches(name)]
        return [_join(path, name) for name in names if last or _join(real, name) in self.folders]


@dataclass(frozen=True, slots=True)
class _GlobSearch:
    """One call of glob.glob, with the algorithm of Python's own."""

    listing: PackageListing
    recursive: bool = False
    hidden: bool = False  # whether wildcards match names that begin with a dot, as in pathlib

    def find(self, pattern: str, *, folders_only: bool) -> list[str]:
        """Return the paths that match a pattern; only folders for the part before the last one."""
        folder, last = posixpath.split(pattern)
        if not _MAGIC.search(pattern):
            return [pattern] if self._real(pattern if last else folder, is_folder=not last) is not None else []
        folders = [folder]
        if folder and folder != pattern and _MAGIC.search(folder):
            folders = self.find(folder, folders_only=True)
        found: list[str] = []
        for path in dict.fromkeys(folders):
            found += [posixpath.join(path, name) for name in self._in_folder(path, last, folders_only=folders_only)]
            self.listing.budget.charge(len(found) // 16)
            _limit(found)
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
            yield from self.descendants(real, folders_only=folders_only)
        else:
            matches = _matcher(part)
            yield from (name for name in self._visible(real, folders_only, part.startswith(".")) if matches(name))

    def descendants(self, folder: str, *, folders_only: bool) -> Iterator[str]:
        """Yield the paths below a folder, relative to it."""
        pending = [("", folder)]
        while pending:
            path, real = pending.pop()
            for name in self._visible(real, folders_only, dotted=False):
                yield _join(path, name)
                if _join(real, name) in self.listing.folders:
                    pending.append((_join(path, name), _join(real, name)))

    def _visible(self, folder: str, folders_only: bool, dotted: bool) -> list[str]:
        names = [name for name in self.listing.names(folder) if dotted or self.hidden or not name.startswith(".")]
        return [name for name in names if _join(folder, name) in self.listing.folders] if folders_only else names

    def _real(self, path: str, *, is_folder: bool = False) -> str | None:
        real = self.listing.real(path or ".")
        return real if not is_folder or real in self.listing.folders else None


def _join(folder: str, name: str) -> str:
    return f"{folder}/{name}" if folder and name else folder or name


def _limit(found: list[str]) -> list[str]:
    if len(found) > _MAX_FOUND:
        raise SearchError("it finds too many files")
    return found


@lru_cache(maxsize=256)
def _matcher(part: str) -> Callable[[str], object]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of nested sets in brackets
        return re.compile(translate(part)).match
