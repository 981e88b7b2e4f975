"""Functions of Python's standard library that are evaluated: of texts, lists and paths. None of them reads a file."""

import posixpath
from collections.abc import Callable
from functools import cache, partial
from pathlib import PurePosixPath
from typing import Any

from grader.static_python.evaluation import Evaluation, FunctionTable
from grader.static_python.methods import sort_items
from grader.static_python.operators import extend
from grader.static_python.values import (
    MAX_ITEMS,
    MAX_PATH,
    Call,
    Unknown,
    Value,
    as_text,
    distinct,
    items_of,
    names_package_folder,
    path_text,
    truth,
    unknown_in,
)

_MAX_NUMBER = 10**9


@cache
def standard_functions(working_folder: str) -> FunctionTable:
    """Return the functions by full name; `working_folder` is where Python runs, as an absolute path."""

    def absolute(path: str) -> str:
        return posixpath.normpath(posixpath.join(working_folder, path))

    def relative(path: str, start: str = ".") -> str:
        return posixpath.relpath(absolute(path), absolute(start))

    own = {"abspath": absolute, "realpath": absolute, "relpath": relative}
    names = ("dirname", "basename", "normpath", "split", "splitext", "isabs")
    return {
        **_FUNCTIONS,
        **{f"os.path.{name}": partial(_of_path, getattr(posixpath, name)) for name in names},
        **{f"os.path.{name}": partial(_of_path, function) for name, function in own.items()},
        "os.getcwd": lambda *_: working_folder,
        "pathlib.Path.cwd": lambda *_: PurePosixPath(working_folder),
    }


def _of_path(function: Callable[..., Value], _: Evaluation, call: Call) -> Value:
    """Run a function of os.path. The name of the package's folder is not known, so no result may depend on it."""
    try:
        found = function(*map(path_text, (*call.args, *call.kwargs.values())))
    except TypeError:  # a value that is no path is None
        return call.unknown("the path is known only at run time")
    if any(names_package_folder(part) for part in (found if isinstance(found, tuple) else [str(found)])):
        return Unknown("the name of the package's folder is not known", call.at)
    return found


def _join(evaluation: Evaluation, call: Call) -> Value:
    if any(isinstance(value, list | tuple | dict | int | float | None) for value in call.args):
        evaluation.error(
            "os.path.join takes strings, and one argument is not a string: is a bracket misplaced?", call.at
        )
    paths = [path for value in call.args if (path := path_text(value)) is not None]
    if paths and len(paths) == len(call.args) and sum(map(len, paths)) <= MAX_PATH:
        return posixpath.join(*paths)
    if unknown_in(call.args) is None and any(isinstance(value, Call) for value in call.args):
        return Call("os.path.join", call.args, call.kwargs, call.at)
    return call.unknown("the path is known only at run time")


def _path(evaluation: Evaluation, call: Call) -> Value:
    path = _join(evaluation, call) if call.args else "."
    return PurePosixPath(path) if isinstance(path, str) else path


def _text(_: Evaluation, call: Call) -> Value:
    value = call.args[0] if len(call.args) == 1 else []
    text = value if isinstance(value, Call) else as_text(value)
    return text if text is not None else call.unknown("the text is known only at run time")


def _of_items(function: Callable[[Evaluation, list[Value], Call], Value], evaluation: Evaluation, call: Call) -> Value:
    """Run a function of the items of its first argument."""
    items = items_of(call.args[0]) if call.args else []
    if items is None:
        return call.unknown("the items of this value are known only at run time")
    return function(evaluation, items, call)


def _join_items(evaluation: Evaluation, items: list[Value], call: Call) -> Value:
    joined: list[Value] = []
    for value in items:
        extend(evaluation, joined, value, call.at)
    return joined


def _enumerate(_: Evaluation, items: list[Value], call: Call) -> Value:
    start = call.args[1] if len(call.args) > 1 else call.kwargs.get("start", 0)
    return (
        list(enumerate(items, start)) if type(start) is int else call.unknown("the numbers are known only at run time")
    )


def _sum(evaluation: Evaluation, call: Call) -> Value:
    items = items_of(call.args[0]) if call.args else []
    if (len(call.args) == 2 and isinstance(call.args[1], list)) or (items and isinstance(items[0], list)):
        return _of_items(_join_items, evaluation, call)
    return call.unknown("a sum of this kind is not supported")


def _zip(_: Evaluation, call: Call) -> Value:
    lists = [items for value in call.args if (items := items_of(value)) is not None]
    if len(lists) < len(call.args):
        return call.unknown("the items of this value are known only at run time")
    return list(zip(*lists, strict=False))


def _dict(_: Evaluation, call: Call) -> Value:
    if not call.args:
        return dict(call.kwargs)
    if len(call.args) == 1 and isinstance(call.args[0], dict):
        return {**call.args[0], **call.kwargs}
    return call.unknown("a dict of this kind is not supported")


def _len(_: Evaluation, call: Call) -> Value:
    items = items_of(call.args[0]) if call.args else []
    is_known = items is not None and not unknown_in(items)
    return len(items or ()) if is_known else call.unknown("the length is known only at run time")


def _bool(_: Evaluation, call: Call) -> Value:
    value = truth(call.args[0]) if len(call.args) == 1 else None
    return value if value is not None else call.unknown("the value is known only at run time")


def _map(evaluation: Evaluation, call: Call) -> Value:
    items = items_of(call.args[1]) if len(call.args) == 2 else None
    if items is None:
        return call.unknown("a map of this kind is not supported")
    return [evaluation.apply(call.args[0], item, call.at) for item in items]


def _filter(evaluation: Evaluation, call: Call) -> Value:
    items = items_of(call.args[1]) if len(call.args) == 2 else None
    if items is None:
        return call.unknown("a filter of this kind is not supported")
    function = call.args[0]
    kept = [truth(item if function is None else evaluation.apply(function, item, call.at)) for item in items]
    if None in kept:
        return Unknown("which items pass the filter is known only at run time", call.at)
    return [item for item, is_kept in zip(items, kept, strict=True) if is_kept]


def _range(evaluation: Evaluation, call: Call) -> Value:
    bounds = [value for value in call.args if type(value) is int and abs(value) <= _MAX_NUMBER]
    if len(bounds) != len(call.args) or not 1 <= len(bounds) <= 3 or (len(bounds) == 3 and bounds[2] == 0):
        return call.unknown("a range of this kind is not supported")
    numbers = range(*bounds)
    evaluation.step(min(len(numbers), MAX_ITEMS) // 16)
    return list(numbers) if len(numbers) <= MAX_ITEMS else Unknown("the range is too long", call.at)


def _set(_: Evaluation, items: list[Value], call: Call) -> Value:
    values = distinct(items)
    return values if len(values) < 2 else Unknown("the order of a set differs between runs", call.at)


_OF_ITEMS: dict[tuple[str, ...], Callable[[Evaluation, list[Value], Call], Any]] = {
    ("builtins.list", "builtins.tuple", "builtins.iter"): lambda _, items, __: items,
    ("builtins.set", "builtins.frozenset"): _set,
    ("builtins.reversed",): lambda _, items, __: items[::-1],
    ("builtins.enumerate",): _enumerate,
    ("builtins.sorted",): sort_items,
    ("itertools.chain.from_iterable",): _join_items,
}
_FUNCTIONS: FunctionTable = {
    **{name: partial(_of_items, run) for names, run in _OF_ITEMS.items() for name in names},
    **dict.fromkeys(("builtins.str", "os.fspath"), _text),
    **{f"pathlib.{name}": _path for name in ("Path", "PurePath", "PosixPath", "PurePosixPath")},
    "os.path.join": _join,
    "builtins.dict": _dict,
    "builtins.len": _len,
    "builtins.bool": _bool,
    "builtins.print": lambda *_: None,
    "builtins.map": _map,
    "builtins.filter": _filter,
    "builtins.zip": _zip,
    "builtins.range": _range,
    "builtins.sum": _sum,
    "itertools.chain": lambda evaluation, call: _join_items(evaluation, call.args, call),
}
