"""Functions that search a package for files or packages, as setup.py calls them: evaluated on the list of its files."""

import posixpath
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import partial
from io import StringIO
from pathlib import PurePosixPath

from grader.errors import InputError
from grader.files.names import ignored_part
from grader.package.globbing import PackageListing
from grader.python.evaluation import Evaluation
from grader.python.values import (
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

_OUTSIDE = "it reads files outside of the package"
_GLOB_OPTIONS = ("pathname", "recursive", "root_dir", "include_hidden", "dir_fd")
_MAX_READ = 128 * 1024  # bytes


def file_functions(listing: PackageListing, root: str) -> FunctionTable:
    """Return the functions by full name; `root` is the absolute path that represents the package's folder."""
    folder = _PackageFolder(listing, root)
    functions: dict[str, Callable[[Evaluation, Call], Value]] = {
        "glob.glob": folder.glob,
        "glob.iglob": folder.iglob,
        "os.listdir": folder.listdir,
        "os.walk": folder.walk,
        **dict.fromkeys(("builtins.open", "io.open"), folder.open),
        "pathlib.Path.open": folder.open,
        "pathlib.Path.read_text": folder.read_text,
        "pathlib.Path.iterdir": folder.iterdir,
        "pathlib.Path.glob": folder.path_glob,
        "pathlib.Path.rglob": partial(folder.path_glob, prefix="**/"),
        "setuptools.find_packages": partial(_find_packages, listing),
        "setuptools.find_namespace_packages": partial(_find_packages, listing),
    }
    tests: dict[str, Callable[[str | None], bool]] = {
        "exists": lambda path: path is not None,
        "is_file": lambda path: path in listing.files,
        "is_dir": lambda path: path in listing.folders,
    }
    for name, test in tests.items():
        functions[f"pathlib.Path.{name}"] = partial(folder.test, test)
        functions[f"os.path.{name.replace('_', '')}"] = partial(folder.test, test)
    return {name: partial(_evaluate, function, listing) for name, function in functions.items()}


def _evaluate(
    function: Callable[[Evaluation, Call], Value], listing: PackageListing, evaluation: Evaluation, call: Call
) -> Value:
    """Evaluate a search, charge it and record whether the order of files in a folder matters."""
    known([call.args, [*call.kwargs.values()]])
    found = function(evaluation, call)
    listing.order_matters |= isinstance(found, list) and len(found) > 1
    return found


@dataclass(frozen=True, slots=True)
class _PackageFolder:
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
            raise Undetermined(_OUTSIDE)
        return text

    def real(self, value: Value) -> str | None:
        """Return the file or folder at a path; None where there is nothing. Raises Undetermined."""
        path = self.inside(value)
        real = self.listing.real(path)
        if real is None and ignored_part(posixpath.normpath(path)):
            raise Undetermined(f"{path} is an ignored file")
        return real

    def glob(self, _: Evaluation, call: Call) -> Value:
        pattern, recursive = call.argument(0, "pathname"), call.kwargs.get("recursive", False)
        if isinstance(pattern, PurePosixPath):
            raise EvaluationFails("glob takes a string, and this is a path: write str(...) around it")
        if not call.kwargs.keys() <= {*_GLOB_OPTIONS} or len(call.args) + ("pathname" in call.kwargs) != 1:
            raise EvaluationFails("glob takes one pattern, and the options recursive, root_dir and include_hidden")
        if not isinstance(pattern, str):
            raise EvaluationFails(f"glob takes a string, and this is of the type {type(pattern).__name__}")
        if call.kwargs.keys() & {*_GLOB_OPTIONS[2:]}:
            raise Undetermined("these options of glob are not evaluated")
        if pattern == self.root:
            return [pattern]
        above = self.root + "/" if pattern.startswith(self.root + "/") else ""
        pattern = pattern.removeprefix(above)
        try:
            found = self.listing.glob(pattern, recursive=bool(recursive), above=above)
        except Undetermined as error:  # glob raises no error of its own
            return Unknown(str(error), call.at)
        return self.listing.record(pattern, found, call.at)

    def iglob(self, evaluation: Evaluation, call: Call) -> Value:
        found = self.glob(evaluation, call)
        return Items(found) if isinstance(found, list) else found

    def path_glob(self, _: Evaluation, call: Call, prefix: str = "") -> Value:
        pattern = call.argument(1, "pattern")
        is_supported = call.kwargs.keys() <= {"pattern"} and len(call.args) + len(call.kwargs) == 2
        if not isinstance(pattern, str) or not is_supported:
            raise Undetermined("this search for files is not supported")
        folder = self.inside(call.args[0])
        found = [call.args[0] / path for path in self.listing.path_glob(folder, prefix + pattern)]
        self.listing.order_matters |= len(found) > 1
        return Items(self.listing.record(str(PurePosixPath(folder) / pattern), found, call.at))

    def test(self, answer: Callable[[str | None], bool], _: Evaluation, call: Call) -> Value:
        if len(call.args) != 1 or call.kwargs:
            raise Undetermined("this test of a path is not supported")
        return answer(self.real(call.args[0]))

    def listdir(self, _: Evaluation, call: Call) -> Value:
        path = call.argument(0, "path")
        return self._names("." if path is None else path)

    def iterdir(self, _: Evaluation, call: Call) -> Value:
        found = [call.args[0] / name for name in self._names(call.args[0])]
        self.listing.order_matters |= len(found) > 1
        return Items(found)

    def walk(self, evaluation: Evaluation, call: Call) -> Value:
        if len(call.args) != 1 or not call.kwargs.keys() <= {"followlinks"}:
            raise Undetermined("this walk through folders is not supported")
        return Items(self._steps(evaluation, self.real(call.args[0]), str(call.args[0])))

    def _steps(self, evaluation: Evaluation, real: str | None, spelled: str) -> Iterator[Value]:
        """Yield the steps of os.walk: the caller may change the list of folders before the next step."""
        if real is None or real not in self.listing.folders:
            return
        evaluation.budget.charge(10)
        names = self.listing.names(real)
        self.listing.order_matters |= len(names) > 1
        paths = {name: _below(real, name) for name in names}
        folders = [name for name, path in paths.items() if path in self.listing.folders]
        yield (spelled, folders, [name for name in paths if name not in folders])
        for name in folders:
            yield from self._steps(evaluation, self.real(_below(real, name)), posixpath.join(spelled, name))

    def open(self, evaluation: Evaluation, call: Call) -> Value:
        path, mode = call.argument(0, "file"), call.argument(1, "mode")
        others = call.kwargs.keys() - {"file", "mode", "encoding"}
        if mode not in (None, "r", "rt") or others or len(call.args) > 2:
            reason = "a file that is opened to write into it, or by other options, is not evaluated"
            raise Undetermined(reason, call.at, is_final=True)
        real = self.real(path)
        if real is None:
            raise EvaluationFails(f"there is no file {str(path)!r}")
        if real in self.listing.folders:
            raise EvaluationFails(f"{str(path)!r} is a folder, not a file")
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
            raise EvaluationFails(f"there is no folder {str(path)!r}")
        raise EvaluationFails(f"{str(path)!r} is a file, not a folder")


def _find_packages(listing: PackageListing, _: Evaluation, call: Call) -> Value:
    """Return the folders with an __init__.py; those without need other rules."""
    where, exclude, include = (call.argument(place, name) for place, name in enumerate(("where", "exclude", "include")))
    exclude, include = () if exclude is None else exclude, ["*"] if include is None else include
    is_known = where in (None, ".", "./") and call.kwargs.keys() <= {"where", "exclude", "include"}
    is_listed = isinstance(exclude, list | tuple) and isinstance(include, list | tuple)
    if not is_known or "namespace" in call.name or not is_listed:
        return Unknown("which packages there are is not evaluated", call.at)
    return [name for name in _packages(listing, "") if _fits(name, include) and not _fits(name, exclude)]


def _packages(listing: PackageListing, folder: str) -> Iterator[str]:
    for name in listing.names(folder):
        path = _below(folder, name)
        if "." not in name and f"{path}/__init__.py" in listing.files:
            yield path.replace("/", ".")
            yield from _packages(listing, path)


def _below(folder: str, name: str) -> str:
    """Return the path of a name in a folder, which may be the package's, empty."""
    return f"{folder}/{name}" if folder else name


def _fits(name: str, patterns: Value) -> bool:
    return any(isinstance(pattern, str) and fnmatchcase(name, pattern) for pattern in patterns)
