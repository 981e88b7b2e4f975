"""Functions of Python's standard library that are evaluated: of texts, lists and paths. None of them reads a file."""

import posixpath
from collections.abc import Callable
from functools import cache
from itertools import chain
from pathlib import PurePosixPath

from grader.static_python.evaluation import Evaluation, EvaluationStopped, ExitFlow, FunctionTable
from grader.static_python.values import (
    Call,
    ExpressionFails,
    Items,
    PlainFunction,
    QualifiedName,
    Undetermined,
    Unknown,
    Value,
    iterate,
    known,
)

MAX_PATH = 4_096  # characters
PACKAGE_FOLDER = "<package>"  # stands for the name of the package's folder, which the submission does not determine
_ENVIRONMENT = "the environment is known only at run time"
_EXITS = ("sys.exit", "os._exit", "builtins.exit", "builtins.quit")


@cache
def standard_functions(working_folder: str) -> FunctionTable:
    """Return the functions by full name; `working_folder` is where Python runs, as an absolute path."""

    def absolute(path: Value) -> str:
        return posixpath.normpath(posixpath.join(working_folder, path))

    def relative(path: Value, start: Value = ".") -> str:
        return posixpath.relpath(absolute(path), absolute(start))

    own: dict[str, Callable[..., Value]] = {
        "abspath": absolute, "realpath": absolute, "relpath": relative, "join": _join,
        **{name: getattr(posixpath, name) for name in ("dirname", "basename", "normpath", "split", "splitext", "isabs")},
    }  # fmt: skip
    of_paths: dict[str, Callable[..., Value]] = {
        **{f"os.path.{name}": function for name, function in own.items()},
        **{f"pathlib.{name}": _path for name in ("Path", "PurePath", "PosixPath", "PurePosixPath")},
        **{f"pathlib.Path.{name}": lambda path: PurePosixPath(absolute(path)) for name in ("resolve", "absolute")},
        "os.fspath": lambda path: str(_of_path(path)),
        "os.getcwd": lambda: working_folder,
        "pathlib.Path.cwd": lambda: PurePosixPath(working_folder),
    }
    return {**_FUNCTIONS, **{name: PlainFunction(name, run, "path") for name, run in of_paths.items()}}


def _of_path(value: Value) -> Value:
    if not isinstance(value, str | PurePosixPath):
        raise ExpressionFails(f"a path is a string, and this is of the type {type(value).__name__}")
    return value


def _join(first: Value, *parts: Value) -> str:
    if not all(isinstance(value, str | PurePosixPath) for value in (first, *parts)):
        message = "os.path.join takes strings, and one argument is not a string: is a bracket misplaced?"
        raise ExpressionFails(message)
    return _bounded(posixpath.join(first, *parts))


def _path(*parts: Value) -> PurePosixPath:
    return PurePosixPath(_bounded(str(PurePosixPath(*map(_of_path, parts)))))


def _bounded(path: str) -> str:
    if len(path) > MAX_PATH:
        raise Undetermined("a path grows too long")
    return path


def leave(evaluation: Evaluation, call: Call) -> Value:
    """End the program, if nothing can catch it."""
    if evaluation.handlers:
        raise EvaluationStopped("the end of the program, which may be caught, is not evaluated", call.at)
    if call.args and known(call.args[0]) not in (0, None):
        evaluation.error("the file exits here with an error", call.at)
    raise ExitFlow


def _getenv(_: Evaluation, call: Call) -> Value:
    return Unknown(_ENVIRONMENT, call.at)


def _environment(_: Evaluation, call: Call) -> Value:
    raise Undetermined(_ENVIRONMENT, call.at)


def _print(evaluation: Evaluation, call: Call) -> None:
    if not call.kwargs.keys() <= {"file", "end", "sep", "flush"} or not isinstance(
        call.kwargs.get("file"), QualifiedName | None
    ):
        raise EvaluationStopped("this use of print is not evaluated", call.at)
    evaluation.budget.measure(call.args, "holds")


_FUNCTIONS: FunctionTable = {
    **dict.fromkeys(_EXITS, leave),
    **dict.fromkeys(("os.environ.get", "os.getenv"), _getenv),
    "os.environ.__getitem__": _environment,
    "builtins.print": _print,
    "itertools.chain": PlainFunction("chain", lambda *lists: Items(chain(*map(iterate, lists))), "holds"),
    "itertools.chain.from_iterable": PlainFunction(
        "chain.from_iterable", lambda lists: Items(chain.from_iterable(map(iterate, iterate(lists)))), "holds"
    ),
}
