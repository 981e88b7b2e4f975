"""Attributes and methods of paths: pathlib's own, or the functions that stand in for the file system."""

from pathlib import PurePosixPath

from grader.static_python.evaluation import Evaluation
from grader.static_python.operators import join_path
from grader.static_python.parse import Position
from grader.static_python.values import PACKAGE_FOLDER, Call, Unknown, Value

_MAX_PARTS = 100  # of a path
_MAX_NAME = 255  # characters of a file name
_WRITES = ("mkdir", "rename", "replace", "rmdir", "symlink_to", "touch", "unlink", "write_bytes", "write_text")


def part_of_path(path: PurePosixPath, name: str, at: Position) -> Value:
    """Return the value of an attribute that is a part of a path."""
    value = getattr(path, name)
    if name in ("name", "stem", "parts") and PACKAGE_FOLDER in str(value):
        return Unknown("the name of the package's folder is not known", at)
    if name in ("parents", "parts") and len(path.parts) > _MAX_PARTS:
        return Unknown("a path is too long", at)
    return list(value) if name == "parents" else value


def path_method(evaluation: Evaluation, path: PurePosixPath, name: str, call: Call) -> Value:
    """Return the value of a method of a path."""
    texts = [value for value in call.args if isinstance(value, str | PurePosixPath)]
    match name, texts:
        case (("as_posix" | "__str__" | "__fspath__"), []):
            return str(path)
        case "expanduser", []:
            is_home = str(path).startswith("~")
            return Unknown("the home folder is known only at run time", call.at) if is_home else path
        case "joinpath", _ if len(texts) == len(call.args):
            return join_path([path, *texts], call.at)
        case (("with_name" | "with_suffix" | "with_stem" | "relative_to"), [value]) if len(str(value)) <= _MAX_NAME:
            try:
                return getattr(path, name)(value)
            except (ValueError, TypeError):
                return Unknown(f"the path method {name} fails here", call.at)
    return _by_function(evaluation, path, name, call)


def _by_function(evaluation: Evaluation, path: PurePosixPath, name: str, call: Call) -> Value:
    """Return the value of a method that asks the file system, by the function for it."""
    given = Call(f"pathlib.Path.{name}", [path, *call.args], call.kwargs, call.at)
    absolute, opener = (evaluation.functions.get(it) for it in ("os.path.abspath", "builtins.open"))
    evaluate = evaluation.functions.get(given.name)
    if name in ("resolve", "absolute") and not call.args:
        found = absolute(evaluation, Call("", [str(path)], {}, call.at)) if absolute is not None else None
        return PurePosixPath(found) if isinstance(found, str) else path
    if name in ("read_text", "open"):
        before = ["r", -1] if name == "read_text" and call.args else []  # it takes no mode and no size of a buffer
        opened = Call("builtins.open", [str(path), *before, *call.args], {}, call.at)
        if opener is not None:
            opened.kwargs = call.kwargs
            opened = opener(evaluation, opened)
        is_read = name == "read_text" and isinstance(opened, Call)
        return Call("builtins.open.read", [], {}, call.at, opened) if is_read else opened
    if evaluate is not None:
        return evaluate(evaluation, given)
    if name in _WRITES:
        evaluation.calls.append(given)
    evaluation.may_have_failed = True
    return Unknown(f"the path method {name} is not supported", call.at)
