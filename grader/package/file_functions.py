"""Functions that search a package for files, as setup.py calls them: evaluated on the list of the package's files."""

import posixpath
import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import PurePosixPath

from grader.files.names import ignored_part
from grader.package.globbing import PackageListing, SearchError
from grader.static_python.evaluation import Evaluation, EvaluationStopped, FunctionTable
from grader.static_python.operators import WalkFolders
from grader.static_python.parse import Position
from grader.static_python.values import Call, Unknown, Value, distinct, items_of, path_text, unknown_in

WRITING = "builtins.open(w)"  # the name of a call that opens a file to write into it
_OUTSIDE = "it reads files outside of the package"
_GLOB_OPTIONS = {"pathname", "root_dir", "recursive", "include_hidden"}


def file_functions(listing: PackageListing, root: str) -> FunctionTable:
    """Return the functions by full name; `root` is the absolute path that represents the package's folder."""
    folder = _PackageFolder(listing, root)
    functions: dict[str, Callable[[Evaluation, Call], Value]] = {
        "builtins.set": folder.set,
        "builtins.frozenset": folder.set,
        "glob.glob": folder.glob,
        "glob.iglob": folder.glob,
        "glob.escape": folder.escape,
        "os.listdir": folder.listdir,
        "os.walk": folder.walk,
        "os.chdir": folder.chdir,
        "builtins.open": folder.open,
        "pathlib.Path.iterdir": folder.iterdir,
        "pathlib.Path.glob": folder.path_glob,
        "pathlib.Path.rglob": partial(folder.path_glob, prefix="**/"),
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
    """Evaluate a search, count its steps and record whether the order of files in a folder, or of a set, matters."""
    before = listing.names_read
    try:
        found = function(evaluation, call)
    except SearchError as error:
        return Unknown(str(error), call.at)
    finally:
        evaluation.step((listing.names_read - before) // 10)
    if isinstance(found, list):
        steps = [names for step in found if isinstance(step, tuple) for names in step[1:]]  # of os.walk
        listing.order_matters |= any(len(names) > 1 for names in (found, *steps))
    return found


@dataclass(frozen=True, slots=True)
class _PackageFolder:
    """The package's folder, as the functions see it."""

    listing: PackageListing
    root: str

    def inside(self, value: Value) -> str:
        """Return a path or pattern relative to the package's folder. Raises SearchError."""
        text = path_text(value)
        if text == self.root:
            return "."
        if text is not None and text.startswith(self.root + "/"):
            text = text.removeprefix(self.root).lstrip("/") or "."
        if text is None or text.startswith("/"):
            unknown = unknown_in(value)
            raise SearchError(_OUTSIDE if unknown is None else unknown.reason)
        return text

    def real(self, value: Value) -> str | None:
        """Return the file or folder at a path; None where there is nothing. Raises SearchError."""
        path = self.inside(value)
        real = self.listing.real(path)
        if real is None and ignored_part(posixpath.normpath(path)):
            raise SearchError(f"{path} is an ignored file")
        return real

    def set(self, _: Evaluation, call: Call) -> Value:
        items = items_of(call.args[0]) if call.args else []
        unknown = call.unknown("the items of this value are known only at run time")
        return self.listing.ordered(distinct(items)) if items is not None else unknown

    def glob(self, evaluation: Evaluation, call: Call) -> Value:
        pattern, start = call.argument(0, "pathname"), call.kwargs.get("root_dir")
        options = [call.kwargs.get(name, False) for name in ("recursive", "include_hidden")]
        if isinstance(pattern, PurePosixPath):
            evaluation.error("glob takes a string, and this is a path: write str(...) around it", call.at)
        unknown = unknown_in([pattern, start, *options])
        plain = isinstance(start, str | PurePosixPath | None)
        plain &= all(isinstance(value, int | None) for value in options)
        is_supported = plain and call.kwargs.keys() <= _GLOB_OPTIONS and len(call.args) <= 1
        if unknown or not is_supported or not isinstance(pattern, str):
            return unknown or Unknown("this search for files is not supported", call.at)
        if pattern == self.root:
            return [pattern]
        above = self.root + "/" if pattern.startswith(self.root + "/") else ""
        folder = "" if start is None or above else self.inside(start)
        pattern = pattern.removeprefix(above)
        recursive, hidden = map(bool, options)
        found = self.listing.glob(pattern, recursive=recursive, hidden=hidden, start=folder, above=above)
        return self.listing.record(posixpath.join(folder, pattern), found, call.at)

    def escape(self, _: Evaluation, call: Call) -> Value:
        if len(call.args) == 1 and isinstance(call.args[0], str):
            return re.sub(r"([*?\[])", r"[\1]", call.args[0])
        return call.unknown("the pattern is known only at run time")

    def path_glob(self, _: Evaluation, call: Call, prefix: str = "") -> Value:
        pattern = call.argument(1, "pattern")
        is_supported = call.kwargs.keys() <= {"pattern"} and len(call.args) + len(call.kwargs) == 2
        if not isinstance(pattern, str) or not is_supported:
            return call.unknown("this search for files is not supported")
        folder = self.inside(call.args[0])
        found = [call.args[0] / path for path in self.listing.path_glob(folder, prefix + pattern)]
        return self.listing.record(str(PurePosixPath(folder) / pattern), found, call.at)

    def test(self, answer: Callable[[str | None], bool], _: Evaluation, call: Call) -> Value:
        if len(call.args) != 1 or call.kwargs:
            return call.unknown("this test of a path is not supported")
        return answer(self.real(call.args[0]))

    def listdir(self, evaluation: Evaluation, call: Call) -> Value:
        path = call.argument(0, "path")
        return self._names(evaluation, "." if path is None else path, call.at)

    def iterdir(self, evaluation: Evaluation, call: Call) -> Value:
        return [call.args[0] / name for name in self._names(evaluation, call.args[0], call.at)]

    def walk(self, _: Evaluation, call: Call) -> Value:
        if len(call.args) != 1 or not call.kwargs.keys() <= {"topdown", "followlinks"}:
            return call.unknown("this walk through folders is not supported")
        real = self.real(call.args[0])
        steps: list[Value] = []
        pending = [(real, str(call.args[0]))] if real is not None and real in self.listing.folders else []
        while pending:
            folder, spelled = pending.pop()
            paths = {name: f"{folder}/{name}" if folder else name for name in self.listing.names(folder)}
            folders = [name for name, path in paths.items() if path in self.listing.folders]
            steps.append((spelled, WalkFolders(folders), [name for name in paths if name not in folders]))
            pending += [(paths[name], posixpath.join(spelled, name)) for name in reversed(folders)]
        return steps

    def chdir(self, _: Evaluation, call: Call) -> Value:
        try:
            stays = len(call.args) == 1 and self.real(call.args[0]) == ""
        except SearchError:
            stays = False
        if not stays:
            raise EvaluationStopped("a change of the working folder is not supported")

    def open(self, evaluation: Evaluation, call: Call) -> Value:
        opened = Call("builtins.open", call.args, call.kwargs, call.at)
        path, mode = call.argument(0, "file"), call.argument(1, "mode")
        if mode is not None and (not isinstance(mode, str) or set(mode) & set("wax+")):
            evaluation.calls.append(Call(WRITING, call.args, call.kwargs, call.at))
            evaluation.may_have_failed = True
            return opened
        try:
            real = self.real(path)
        except SearchError:
            evaluation.may_have_failed = True
            return opened
        if real is None:
            evaluation.error(f"there is no file {str(path)!r}", call.at, FileNotFoundError)
        elif real in self.listing.folders:
            evaluation.error(f"{str(path)!r} is a folder, not a file", call.at, IsADirectoryError)
        return opened

    def _names(self, evaluation: Evaluation, path: Value, at: Position) -> list[Value]:
        """Return the names in a folder; it is an error if there is none."""
        real = self.real(path)
        if real in self.listing.folders:
            return list(self.listing.names(real or ""))
        if real is None:
            evaluation.error(f"there is no folder {str(path)!r}", at, FileNotFoundError)
        else:
            evaluation.error(f"{str(path)!r} is a file, not a folder", at, NotADirectoryError)
        return []
