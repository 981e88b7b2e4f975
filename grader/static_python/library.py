"""Functions of Python's standard library that are evaluated: of texts, lists and paths. None of them reads a file."""

import posixpath
from collections.abc import Callable
from functools import cache
from itertools import chain
from pathlib import PurePosixPath

from grader.static_python import values as py
from grader.static_python.evaluation import FunctionTable
from grader.static_python.knowledge import iterate

MAX_PATH = 4_096  # characters
PACKAGE_FOLDER = "<package>"  # stands for the name of the package's folder, which the submission does not determine
_OWN = ("dirname", "basename", "normpath", "split", "splitext", "isabs")


@cache
def standard_functions(working_folder: str) -> FunctionTable:
    """Return the functions by full name; `working_folder` is where Python runs, as an absolute path."""

    def absolute(path: py.Value) -> str:
        return posixpath.normpath(posixpath.join(working_folder, path))

    def relative(path: py.Value, start: py.Value = ".") -> str:
        return posixpath.relpath(absolute(path) if path else path, absolute(start))

    own: dict[str, Callable[..., py.Value]] = {
        "abspath": absolute, "realpath": absolute, "relpath": relative, "join": _join,
        **{name: getattr(posixpath, name) for name in _OWN},
    }  # fmt: skip
    of_paths: dict[str, Callable[..., py.Value]] = {
        **{f"os.path.{name}": function for name, function in own.items()},
        **{f"pathlib.{name}": _path for name in ("Path", "PurePath", "PosixPath", "PurePosixPath")},
        **{f"pathlib.Path.{name}": lambda path: PurePosixPath(absolute(path)) for name in ("resolve", "absolute")},
        "os.getcwd": lambda: working_folder,
        "pathlib.Path.cwd": lambda: PurePosixPath(working_folder),
    }
    return {**_FUNCTIONS, **{name: py.PlainFunction(name, run, "path") for name, run in of_paths.items()}}


def _of_path(value: py.Value) -> py.Value:
    if not isinstance(value, str | PurePosixPath):
        raise py.ExpressionFails(f"a path is a string, and this is of the type {type(value).__name__}")
    return value


def _join(first: py.Value, *parts: py.Value) -> str:
    if not all(isinstance(value, str | PurePosixPath) for value in (first, *parts)):
        message = "os.path.join takes strings, and one argument is not a string: is a bracket misplaced?"
        raise py.ExpressionFails(message)
    return _bounded(posixpath.join(first, *parts))


def _path(*parts: py.Value) -> PurePosixPath:
    return PurePosixPath(_bounded(str(PurePosixPath(*map(_of_path, parts)))))


def _bounded(path: str) -> str:
    if len(path) > MAX_PATH:
        raise py.Undetermined("a path grows too long")
    return path


def _no_print(*_: py.Value, sep: str = "", end: str = "", file: py.Value = None, flush: bool = False) -> None:
    """Print nothing."""
    del sep, end, file, flush


_FUNCTIONS: FunctionTable = {
    "builtins.print": py.PlainFunction("print", _no_print, "holds"),
    "itertools.chain": py.PlainFunction("chain", lambda *lists: py.Items(chain(*map(iterate, lists))), "holds"),
    "itertools.chain.from_iterable": py.PlainFunction(
        "chain.from_iterable", lambda lists: py.Items(chain.from_iterable(map(iterate, iterate(lists)))), "holds"
    ),
}
