"""What searches of a setup.py find in its package.

The searches are those of glob, pathlib, os and setuptools. They find files in the list of its
files.
"""

import re
import warnings
from bisect import bisect_left
from collections.abc import Callable, Iterable, Iterator
from fnmatch import fnmatchcase, translate
from functools import lru_cache, partial
from io import StringIO
from itertools import pairwise
from pathlib import PurePosixPath
from posixpath import join, normpath

from grader.base.errors import InputError
from grader.base.names import last_part
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.files.limits import ignored_part
from grader.files.tree import IS_LINK, Tree
from grader.ros.python.budget import Budget
from grader.ros.python.evaluation import Evaluation
from grader.ros.python.parse import Position
from grader.ros.python.values import (
    Call,
    EvaluationFails,
    FunctionTable,
    Items,
    Undetermined,
    Unknown,
    Value,
    known,
    path_text,
)

_Paths = list[str]

# The file system lists a folder, and Python a set, in any order: a result that depends on the order
# differs between these.
ORDERS = ("sorted", "reversed", "rotated")
_MAGIC = on_use(r"[*?\[]")
_SLASHES = on_use(r"(?<!/)//++(?=[^/]*[*?\[][^/]*$)")  # those before other names are in the result
_OUTSIDE = "it searches for files outside of the package"
_IGNORED = "it searches an ignored folder"
_UNUSUAL = "a pattern of this kind is not supported"
_COMPILED = "__pycache__"  # its files are made by Python
_MAX_RECORDED = 200  # paths of one search whose position is kept
_MAX_PATTERN = 1_024  # characters
_READS_OUTSIDE = "it reads files outside of the package"
_GLOB_OPTIONS = ("pathname", "recursive", "root_dir", "include_hidden", "dir_fd")
_MAX_READ = 128 * 1024  # bytes


class EmptyGlob(Named):
    """A pattern that matches no file."""

    pattern: str
    at: Position


def _below(folder: str, name: str) -> str:
    """Return the path of a name in a folder. Raises Undetermined for one outside of the tree."""
    if name != "..":
        return join(folder, name)
    if not folder:
        raise Undetermined(_OUTSIDE)
    return folder.rpartition("/")[0]


def _parts_of_pattern(pattern: str) -> _Paths:
    """Return the parts of a pattern of pathlib. Raises Undetermined for one that nobody writes."""
    if pattern.startswith("/") or pattern.endswith(("/", "/.")):
        raise Undetermined(_UNUSUAL)
    parts = [part for part in pattern.split("/") if part not in ("", ".")]
    parts = [part for part, after in pairwise([*parts, ""]) if (part, after) != ("**", "**")]
    if not parts or any("**" in part and part != "**" for part in parts):
        raise Undetermined(_UNUSUAL)
    return parts


class PackageListing:
    """The folders of a file tree, listed in one of the possible orders.

    Paths are relative to the tree's root.
    """

    def __init__(self, tree: Tree, budget: Budget | None = None, order: str = ORDERS[0]) -> None:
        self.tree = tree
        self.budget = budget or Budget()
        self.files = tree.files
        self.folders = tree.folders | tree.unseen | {""}
        self._unseen = {path for path in tree.unseen if last_part(path) != _COMPILED}
        self._links = {*tree.links}
        self.order_matters = False  # whether a search has returned several names
        self.positions: dict[str, Position] = {}  # of the searches that found a path
        self.empty: dict[EmptyGlob, None] = {}  # in the order of the searches
        self._children: dict[str, _Paths] = {}
        self._order = order
        paths = [*tree.files, *tree.folders, *tree.unseen]
        self._file_paths = sorted(tree.files)
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
                return values[1:] + values[:1]
        return values

    def record(self, pattern: str, paths: list[Value], at: Position) -> list[Value]:
        """Keep the position of a search for each path that it found, and return the paths.

        Positions are kept up to a limit.
        """
        self.positions |= dict.fromkeys(map(str, paths[:_MAX_RECORDED]), at)
        if not paths:
            self.empty[EmptyGlob(pattern, at)] = None
        return paths

    def names(self, folder: str) -> _Paths:
        """Return the names in a folder. Raises Undetermined for an ignored folder."""
        if folder in self._unseen:
            raise Undetermined(_IGNORED)
        names_in_folder = self._children.get(folder, [])
        self.budget.charge(1 + len(names_in_folder))
        return names_in_folder

    def files_below(self, folder: str) -> _Paths:
        """Return the paths of the files in a folder and in the folders of it."""
        first = 0
        last = len(self._file_paths)
        if folder:
            first = bisect_left(self._file_paths, f"{folder}/")
            last = bisect_left(self._file_paths, f"{folder}0")  # the character after the slash
        self.budget.charge(1 + 2 * (last - first))
        return self._file_paths[first:last]

    def modules(self) -> frozenset[str]:
        """Return the names of the modules and packages beside setup.py.

        They are imported before any other.
        """
        files = (
            name.removesuffix(".py") for name in self._children.get("", ()) if name.endswith(".py")
        )
        packages = (
            name for name in self._children.get("", ()) if f"{name}/__init__.py" in self.files
        )
        return frozenset((*files, *packages)) - {"setup"}

    def real(self, path: str) -> str | None:
        """Return the file or folder at a path, without dots.

        The result is None where there is nothing. Raises Undetermined.
        """
        if path.startswith("/"):
            raise Undetermined(_OUTSIDE)
        here = ""
        self.budget.charge(1, len(path))
        for index, part in enumerate(path.split("/")):
            if here not in self.folders or not path:
                return None
            if part not in ("", "."):
                here = _below(here, part)
            elif index and here not in self.folders:
                return None
            if here in self._links:
                raise Undetermined(f"{here} {IS_LINK}")
        if here in self.folders or here in self.files:
            return here
        return None

    def glob(self, pattern: str, *, recursive: bool = False, above: str = "") -> _Paths:
        """Return the paths that glob.glob finds, as it writes them. Raises Undetermined.

        `recursive` lets ** match any number of folders; `above` is the absolute path of the tree's
        root, which precedes each path.
        """
        if pattern.startswith("/"):
            raise Undetermined(_OUTSIDE)
        start = f"{above}./" if pattern.startswith("./") else above
        parts = _SLASHES.sub("/", pattern.removeprefix("./")).split("/")
        paths = self._search(parts, recursive=recursive)
        if recursive and parts[-1] == "**":  # also the folder that it begins in
            paths = self._search([*parts[:-1], ""]) + self._search([*parts, "*"], recursive=True)
        return [start + path for path in paths if start + path]

    def path_glob(self, folder: str, pattern: str) -> _Paths:
        """Return the paths below a folder that pathlib's glob finds in Python 3.12.

        Raises Undetermined.
        """
        parts = _parts_of_pattern(pattern)
        start = self.real(folder)
        if start not in self.folders:
            return []
        folders_only = [""] if parts[-1] == "**" else []
        paths = self._search(parts + folders_only, recursive=True, hidden=True, folder=start or "")
        return [path.rstrip("/") for path in paths]

    def _search(
        self, parts: _Paths, *, recursive: bool = False, hidden: bool = False, folder: str = ""
    ) -> _Paths:
        """Return the paths below a folder that consist of such names.

        With an empty name at the end, they are those of folders.

        Wildcards match names that begin with a dot only if `hidden`. Raises Undetermined, also for
        what nobody writes.
        """
        if _is_unusual(parts, recursive=recursive):
            raise Undetermined(_UNUSUAL)
        self.budget.charge(1 + 2 * len(self._paths))
        place = parts.index("**") if recursive and "**" in parts else None
        pattern = _Pattern([_name_test(part, hidden=hidden) for part in parts], place)
        start = f"{folder}/" if folder else ""
        if any(pattern.leads_to(names) for names in _names_below(start, self._unseen)):
            raise Undetermined(_IGNORED)
        fitting = filter(pattern.matches, _names_below(start, self._paths))
        return self.ordered(["/".join(names) for names in fitting])


def _is_unusual(parts: _Paths, *, recursive: bool) -> bool:
    """Return whether a pattern is one that nobody writes, so that it is not evaluated."""
    is_hidden = any(part.startswith(".") for part in parts)
    if recursive and "**" in parts and (is_hidden or parts.count("**") > 1):
        return True
    if "" in parts[:-1] or "." in parts or ".." in parts:
        return True
    return sum(map(len, parts)) > _MAX_PATTERN


class _Pattern(Named):
    """The tests of the names in a path; the one at `place` is that of any number of folders."""

    tests: list[Callable[[str], object]]
    place: int | None

    def matches(self, names: _Paths) -> bool:
        """Return whether a path matches."""
        tests = self.tests
        if self.place is not None:
            count = len(names) - len(tests) + 1
            tests = [*tests[: self.place], *[tests[self.place]] * count, *tests[self.place + 1 :]]
        return len(tests) == len(names) and all(
            test(name) for test, name in zip(tests, names, strict=True)
        )

    def leads_to(self, names: _Paths) -> bool:
        """Return whether a search looks into a folder."""
        tests = self.tests[:-1]
        if self.place is not None:
            tests = tests[: self.place] + [self.tests[self.place]] * len(names)
        return len(names) <= len(tests) and all(
            test(name) for test, name in zip(tests, names, strict=False)
        )


def _names_below(start: str, paths: Iterable[str]) -> Iterator[_Paths]:
    """Yield the names in each path below a folder."""
    return (path.removeprefix(start).split("/") for path in paths if path.startswith(start))


@lru_cache(maxsize=256)
def _name_test(part: str, *, hidden: bool) -> Callable[[str], object]:
    """Return whether a part of a pattern matches a name."""
    if not _MAGIC.search(part):
        return part.__eq__
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of nested sets in brackets
        matches = re.compile(translate(part)).match
    return lambda name: name and (hidden or part[0] == "." or name[0] != ".") and matches(name)


def file_functions(listing: PackageListing, root: str) -> FunctionTable:
    """Return the functions by full name.

    `root` is the absolute path that represents the package's folder.
    """
    folder = _PackageFolder(listing, root)
    functions: dict[str, Callable[[Evaluation, Call], Value]] = {
        "glob.glob": folder.glob,
        "glob.iglob": folder.iglob,
        "os.listdir": folder.listdir,
        "os.path.getsize": folder.getsize,
        "os.walk": folder.walk,
        "builtins.open": folder.open,
        "io.open": folder.open,
        "pathlib.Path.open": folder.open,
        "pathlib.Path.read_text": folder.read_text,
        "pathlib.Path.iterdir": folder.iterdir,
        "pathlib.Path.glob": folder.path_glob,
        "pathlib.Path.rglob": partial(folder.path_glob, prefix="**/"),
        "setuptools.find_packages": partial(_find_packages, listing),
        "setuptools.find_namespace_packages": partial(_find_packages, listing),
    }
    exists = partial(folder.test, lambda path: path is not None)
    is_file = partial(folder.test, lambda path: path in listing.files)
    is_folder = partial(folder.test, lambda path: path in listing.folders)
    functions |= {
        "pathlib.Path.exists": exists,
        "pathlib.Path.is_file": is_file,
        "pathlib.Path.is_dir": is_folder,
        "os.path.exists": exists,
        "os.path.isfile": is_file,
        "os.path.isdir": is_folder,
    }
    return {
        name: partial(_evaluate_search, function, listing) for name, function in functions.items()
    }


def _evaluate_search(
    function: Callable[[Evaluation, Call], Value],
    listing: PackageListing,
    evaluation: Evaluation,
    call: Call,
) -> Value:
    """Evaluate a search, charge it and record whether the order of files in a folder matters."""
    known([call.args, list(call.kwargs.values())])
    result = function(evaluation, call)
    listing.order_matters |= isinstance(result, list) and len(result) > 1
    return result


class _PackageFolder(Named):
    """The package's folder, as the functions see it."""

    listing: PackageListing
    root: str

    def inside(self, value: Value) -> str:
        """Return a path or pattern relative to the package's folder. Raises Undetermined."""
        text = path_text(value)
        if text == self.root:
            return "."
        if text is not None and text.startswith(self.root + "/"):
            text = text.removeprefix(self.root).lstrip("/") or "."
        if text is None or text.startswith("/"):
            raise Undetermined(_READS_OUTSIDE)
        return text

    def real(self, value: Value) -> str | None:
        """Return the file or folder at a path; None where there is nothing. Raises Undetermined."""
        path = self.inside(value)
        real = self.listing.real(path)
        if real is None and ignored_part(normpath(path)):
            raise Undetermined(f"{path} is an ignored file")
        return real

    def glob(self, _: Evaluation, call: Call) -> Value:
        pattern = call.argument(0, "pathname")
        recursive = call.kwargs.get("recursive", False)
        if isinstance(pattern, PurePosixPath):
            raise EvaluationFails(
                "glob takes a string, and this is a path: write str(...) around it"
            )
        if (
            not call.kwargs.keys() <= {*_GLOB_OPTIONS}
            or len(call.args) + ("pathname" in call.kwargs) != 1
        ):
            raise EvaluationFails(
                "glob takes one pattern, and the options recursive, root_dir and include_hidden"
            )
        if not isinstance(pattern, str):
            raise EvaluationFails(
                f"glob takes a string, and this is of the type {type(pattern).__name__}"
            )
        if call.kwargs.keys() & {*_GLOB_OPTIONS[2:]}:
            raise Undetermined("these options of glob are not evaluated")
        if pattern == self.root:
            return [pattern]
        above = self.root + "/" if pattern.startswith(self.root + "/") else ""
        pattern = pattern.removeprefix(above)
        try:
            paths = self.listing.glob(pattern, recursive=bool(recursive), above=above)
        except Undetermined as error:  # glob raises no error of its own
            return Unknown(str(error), call.at)
        return self.listing.record(pattern, paths, call.at)

    def iglob(self, evaluation: Evaluation, call: Call) -> Value:
        paths = self.glob(evaluation, call)
        if isinstance(paths, list):
            return Items(paths)
        return paths

    def path_glob(self, _: Evaluation, call: Call, prefix: str = "") -> Value:
        pattern = call.argument(1, "pattern")
        is_supported = call.kwargs.keys() <= {"pattern"} and len(call.args) + len(call.kwargs) == 2
        if not isinstance(pattern, str) or not is_supported:
            raise Undetermined("this search for files is not supported")
        folder = self.inside(call.args[0])
        paths = [call.args[0] / path for path in self.listing.path_glob(folder, prefix + pattern)]
        self.listing.order_matters |= len(paths) > 1
        return Items(self.listing.record(str(PurePosixPath(folder) / pattern), paths, call.at))

    def test(self, answer: Callable[[str | None], bool], _: Evaluation, call: Call) -> Value:
        if len(call.args) != 1 or call.kwargs:
            raise Undetermined("this test of a path is not supported")
        return answer(self.real(call.args[0]))

    def listdir(self, _: Evaluation, call: Call) -> Value:
        path = call.argument(0, "path")
        return self._names("." if path is None else path)

    def getsize(self, _: Evaluation, call: Call) -> Value:
        path = call.argument(0, "filename")
        real = self.real(path)
        if real is None:
            raise EvaluationFails(f"there is no file {str(path)!r}", kind=FileNotFoundError)
        file = self.listing.files.get(real)
        return Unknown("the size of a folder is not known", call.at) if not file else file.size

    def iterdir(self, _: Evaluation, call: Call) -> Value:
        paths = [call.args[0] / name for name in self._names(call.args[0])]
        self.listing.order_matters |= len(paths) > 1
        return Items(paths)

    def walk(self, evaluation: Evaluation, call: Call) -> Value:
        if len(call.args) != 1 or not call.kwargs.keys() <= {"followlinks"}:
            raise Undetermined("this walk through folders is not supported")
        return Items(self._steps(evaluation, self.real(call.args[0]), str(call.args[0])))

    def _steps(self, evaluation: Evaluation, real: str | None, spelled: str) -> Iterator[Value]:
        """Yield the steps of os.walk.

        The caller may change the list of folders before the next step.
        """
        if real is None or real not in self.listing.folders:
            return
        evaluation.budget.charge(10)
        names = self.listing.names(real)
        self.listing.order_matters |= len(names) > 1
        paths = {name: join(real, name) for name in names}
        folders = [name for name, path in paths.items() if path in self.listing.folders]
        yield (spelled, folders, [name for name in paths if name not in folders])
        for name in folders:
            yield from self._steps(evaluation, self.real(join(real, name)), join(spelled, name))

    def open(self, evaluation: Evaluation, call: Call) -> Value:
        path = call.argument(0, "file")
        mode = call.argument(1, "mode")
        others = call.kwargs.keys() - {"file", "mode", "encoding"}
        if mode not in (None, "r", "rt") or others or len(call.args) > 2:
            reason = "a file that is opened to write into it, or by other options, is not evaluated"
            raise Undetermined(reason, call.at, is_final=True)
        real = self.real(path)
        if real is None:
            raise EvaluationFails(f"there is no file {str(path)!r}", kind=FileNotFoundError)
        if real in self.listing.folders:
            raise EvaluationFails(f"{str(path)!r} is a folder, not a file", kind=IsADirectoryError)
        try:
            text = self.listing.files[real].read(_MAX_READ).decode()
        except (InputError, UnicodeDecodeError):
            raise Undetermined(f"the text of {real} cannot be read") from None
        evaluation.budget.charge(1, len(text))
        return StringIO(text.replace("\r\n", "\n").replace("\r", "\n"))

    def read_text(self, evaluation: Evaluation, call: Call) -> Value:
        if not call.kwargs.keys() <= {"encoding"} or len(call.args) != 1:
            raise Undetermined("this use of read_text is not supported")
        return self.open(evaluation, call).read()

    def _names(self, path: Value) -> list[Value]:
        """Return the names in a folder; it is an error if there is none."""
        real = self.real(path)
        if real in self.listing.folders:
            return list(self.listing.names(real or ""))
        if real is None:
            raise EvaluationFails(f"there is no folder {str(path)!r}", kind=FileNotFoundError)
        raise EvaluationFails(f"{str(path)!r} is a file, not a folder", kind=NotADirectoryError)


def _find_packages(listing: PackageListing, _: Evaluation, call: Call) -> Value:
    """Return the folders with an __init__.py; those without need other rules."""
    where = call.argument(0, "where")
    exclude = call.argument(1, "exclude")
    include = call.argument(2, "include")
    if exclude is None:
        exclude = ()
    if include is None:
        include = ["*"]
    is_known = where in (None, ".", "./") and call.kwargs.keys() <= {"where", "exclude", "include"}
    is_listed = isinstance(exclude, list | tuple) and isinstance(include, list | tuple)
    if not is_known or "namespace" in call.name or not is_listed:
        return Unknown("which packages there are is not evaluated", call.at)
    return [
        name
        for name in _package_names(listing, "")
        if _matches_any(name, include) and not _matches_any(name, exclude)
    ]


def _package_names(listing: PackageListing, folder: str) -> Iterator[str]:
    for name in listing.names(folder):
        path = join(folder, name)
        if "." not in name and f"{path}/__init__.py" in listing.files:
            yield path.replace("/", ".")
            yield from _package_names(listing, path)


def _matches_any(name: str, patterns: Value) -> bool:
    return any(isinstance(pattern, str) and fnmatchcase(name, pattern) for pattern in patterns)
