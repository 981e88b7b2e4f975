"""The results of Python's glob, pathlib and os.listdir in a package, from the list of its files."""

import re
import warnings
from collections.abc import Callable, Iterable, Iterator
from fnmatch import translate
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

from grader.files.tree import IS_LINK, Tree
from grader.python.budget import Budget
from grader.python.parse import Position
from grader.python.values import Undetermined, Value

# The file system lists a folder, and Python a set, in any order: a result that depends on the order differs between
# these.
ORDERS = ("sorted", "reversed", "rotated")
_MAGIC = re.compile(r"[*?\[]")
_SLASHES = re.compile(r"//+(?=[^/]*[*?\[][^/]*$)")  # those before other names are in the result
_OUTSIDE = "it searches for files outside of the package"
_IGNORED = "it searches an ignored folder"
_UNUSUAL = "a pattern of this kind is not supported"
_COMPILED = "__pycache__"  # its files are made by Python
_MAX_RECORDED = 200  # paths of one search whose position is kept
_MAX_PATTERN = 1_024  # characters


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
        self._links = {*tree.links}
        self.order_matters = False  # whether a search has returned several names
        self.positions: dict[str, Position] = {}  # of the searches that found a path
        self.empty: dict[EmptyGlob, None] = {}  # in the order of the searches
        self._children: dict[str, list[str]] = {}
        self._order = order
        paths = [*tree.files, *tree.folders, *tree.unseen]
        self._paths = sorted([*paths, *(path and f"{path}/" for path in self.folders)])
        for path in sorted(paths):
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
        """Return the names in a folder. Raises Undetermined for an ignored folder."""
        if folder in self._unseen:
            raise Undetermined(_IGNORED)
        found = self._children.get(folder, [])
        self.budget.charge(1 + len(found))
        return found

    def modules(self) -> frozenset[str]:
        """Return the names of the modules and packages beside setup.py, which are imported before any other."""
        files = (name.removesuffix(".py") for name in self._children.get("", ()) if name.endswith(".py"))
        packages = (name for name in self._children.get("", ()) if f"{name}/__init__.py" in self.files)
        return frozenset((*files, *packages)) - {"setup"}

    def real(self, path: str) -> str | None:
        """Return the file or folder at a path, without dots; None where there is nothing. Raises Undetermined."""
        if path.startswith("/"):
            raise Undetermined(_OUTSIDE)
        here = ""
        self.budget.charge(1, len(path))
        for index, part in enumerate(path.split("/")):
            if here not in self.folders or not path:
                return None
            if part == "..":
                if not here:
                    raise Undetermined(_OUTSIDE)
                here = here.rpartition("/")[0]
            elif part not in ("", "."):
                here = f"{here}/{part}" if here else part
            elif index and here not in self.folders:
                return None
            if here in self._links:
                raise Undetermined(f"{here} {IS_LINK}")
        return here if here in self.folders or here in self.files else None

    def glob(self, pattern: str, *, recursive: bool = False, above: str = "") -> list[str]:
        """Return the paths that glob.glob finds, as it writes them. Raises Undetermined.

        `recursive` lets ** match any number of folders; `above` is the absolute path of the tree's root, which precedes
        each path.
        """
        if pattern.startswith("/"):
            raise Undetermined(_OUTSIDE)
        start = above + "./" * pattern.startswith("./")
        parts = _SLASHES.sub("/", pattern.removeprefix("./")).split("/")
        found = self._search(parts, recursive=recursive)
        if recursive and parts[-1] == "**":  # also the folder that it begins in
            found = [*self._search([*parts[:-1], ""]), *self._search([*parts, "*"], recursive=True)]
        return [start + path for path in found if start + path]

    def path_glob(self, folder: str, pattern: str) -> list[str]:
        """Return the paths below a folder that pathlib's glob finds in Python 3.12. Raises Undetermined."""
        parts = [part for part in pattern.split("/") if part not in ("", ".")]
        parts = [part for part, after in pairwise([*parts, ""]) if (part, after) != ("**", "**")]
        odd = any("**" in part and part != "**" for part in parts) or pattern.startswith("/")
        if odd or not parts or pattern.endswith(("/", "/.")):
            raise Undetermined(_UNUSUAL)
        start = self.real(folder)
        if start not in self.folders:
            return []
        folders_only = [""] if parts[-1] == "**" else []
        found = self._search([*parts, *folders_only], recursive=True, hidden=True, folder=start or "")
        return [path.rstrip("/") for path in found]

    def _search(
        self, parts: list[str], *, recursive: bool = False, hidden: bool = False, folder: str = ""
    ) -> list[str]:
        """Return the paths below a folder that consist of such names; with an empty one at the end, those of folders.

        Wildcards match names that begin with a dot only if `hidden`. Raises Undetermined, also for what nobody writes.
        """
        several = recursive and "**" in parts and (parts.count("**") > 1 or any(it.startswith(".") for it in parts))
        if several or "" in parts[:-1] or {".", ".."} & {*parts} or sum(map(len, parts)) > _MAX_PATTERN:
            raise Undetermined(_UNUSUAL)
        self.budget.charge(1 + 2 * len(self._paths))
        place = parts.index("**") if recursive and "**" in parts else None
        pattern = _Pattern([_test(part, hidden=hidden) for part in parts], place)
        start = f"{folder}/" if folder else ""
        if any(pattern.leads_to(names) for names in _below(start, self._unseen)):
            raise Undetermined(_IGNORED)
        return self.ordered(["/".join(names) for names in _below(start, self._paths) if pattern.matches(names)])


class _Pattern(NamedTuple):
    """The tests of the names in a path; the one at `place` is that of any number of folders."""

    tests: list[Callable[[str], object]]
    place: int | None

    def matches(self, names: list[str]) -> bool:
        """Return whether a path matches."""
        tests = self.tests
        if self.place is not None:
            count = len(names) - len(tests) + 1
            tests = [*tests[: self.place], *[tests[self.place]] * count, *tests[self.place + 1 :]]
        return len(tests) == len(names) and all(test(name) for test, name in zip(tests, names, strict=True))

    def leads_to(self, names: list[str]) -> bool:
        """Return whether a search looks into a folder."""
        tests = self.tests[:-1]
        if self.place is not None:
            tests = [*tests[: self.place], *[self.tests[self.place]] * len(names)]
        return len(names) <= len(tests) and all(test(name) for test, name in zip(tests, names, strict=False))


def _below(start: str, paths: Iterable[str]) -> Iterator[list[str]]:
    return (path.removeprefix(start).split("/") for path in paths if path.startswith(start))


@lru_cache(maxsize=256)
def _test(part: str, *, hidden: bool) -> Callable[[str], object]:
    """Return whether a part of a pattern matches a name."""
    if not _MAGIC.search(part):
        return part.__eq__
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of nested sets in brackets
        matches = re.compile(translate(part)).match
    return lambda name: name and (hidden or part[0] == "." or name[0] != ".") and matches(name)
