"""Functions of Python's own that can be followed: of texts, lists and paths. None of them looks at a file."""

import posixpath
from collections.abc import Callable
from pathlib import PurePosixPath
from typing import TYPE_CHECKING

from grader.static_python import containers, methods
from grader.static_python.values import Function, Made, Spot, Unknown, Value, unknown_in

if TYPE_CHECKING:
    from grader.static_python.machine import Library, Machine

_MOST_PATH = 4_096
_MOST_NUMBER = 10**9


def plain_functions(working_folder: str) -> "Library":
    """The functions by full name; `working_folder` is where Python runs, as an absolute path."""

    def absolute(_: "Machine", args: list[Value], __: dict[str, Value], spot: Spot) -> Value:
        path = _path_text(args[0]) if args else None
        if path is None:
            return unknown_in(args) or Unknown("this path is not followed", spot)
        return posixpath.normpath(posixpath.join(working_folder, path))

    paths: dict[str, Callable[..., Value]] = {
        "join": _joined,
        "dirname": _of_path(posixpath.dirname),
        "basename": _of_path(posixpath.basename),
        "normpath": _of_path(posixpath.normpath),
        "split": _of_path(posixpath.split),
        "splitext": _of_path(posixpath.splitext),
        "isabs": _of_path(posixpath.isabs),
        "abspath": absolute,
        "realpath": absolute,
        "relpath": _relative(working_folder),
    }
    named: dict[str, Callable[..., Value]] = {f"os.path.{name}": function for name, function in paths.items()}
    named |= {
        "os.getcwd": lambda *_: working_folder,
        "os.fspath": _text,
        "pathlib.Path": _path,
        "pathlib.PurePath": _path,
        "pathlib.PosixPath": _path,
        "pathlib.PurePosixPath": _path,
        "pathlib.Path.cwd": lambda *_: PurePosixPath(working_folder),
        "builtins.str": _text,
        "builtins.list": _listed,
        "builtins.tuple": _listed,
        "builtins.sorted": _sorted,
        "builtins.set": _set,
        "builtins.frozenset": _set,
        "builtins.reversed": _reversed,
        "builtins.iter": _listed,
        "builtins.dict": _dict,
        "builtins.len": _length,
        "builtins.bool": lambda _, args, __, spot: _boolean(args, spot),
        "builtins.print": lambda *_: None,
        "builtins.map": _map,
        "builtins.filter": _filter,
        "builtins.enumerate": lambda _, args, __, spot: _paired(list(enumerate(_items(args) or [])), args, spot),
        "builtins.zip": _zip,
        "builtins.range": _range,
        "builtins.sum": _sum,
        "itertools.chain": _chain,
        "itertools.chain.from_iterable": lambda m, args, k, spot: _chain(m, _items(args) or [None], k, spot),
    }
    return named


def _path_text(value: Value) -> str | None:
    return str(value) if isinstance(value, str | PurePosixPath) else None


def _of_path(function: Callable[[str], Value]) -> Callable[..., Value]:
    def follow(_: "Machine", args: list[Value], __: dict[str, Value], spot: Spot) -> Value:
        path = _path_text(args[0]) if len(args) == 1 else None
        found = function(path) if path is not None else None
        if any(methods.names_the_folder(each) for each in (found if isinstance(found, tuple) else [str(found)])):
            return Unknown("the name of the package's folder is told only by a run", spot)
        return found if path is not None else unknown_in(args) or Unknown("this path is not followed", spot)

    return follow


def _relative(working_folder: str) -> Callable[..., Value]:
    def follow(_: "Machine", args: list[Value], kwargs: dict[str, Value], spot: Spot) -> Value:
        texts = [_path_text(each) for each in [*args, *kwargs.values()]]
        known = [posixpath.join(working_folder, each) for each in texts if each is not None]
        if not known or len(known) != len(texts) or len(known) > 2:
            return unknown_in(args) or Unknown("this path is not followed", spot)
        found = posixpath.relpath(known[0], known[1] if len(known) == 2 else working_folder)
        if methods.names_the_folder(found):
            return Unknown("the name of the package's folder is told only by a run", spot)
        return found

    return follow


def _joined(machine: "Machine", args: list[Value], kwargs: dict[str, Value], spot: Spot) -> Value:
    if any(isinstance(each, list | tuple | dict | int | float | None) for each in args):
        machine.fault("os.path.join takes texts, and this is something else: is a bracket misplaced?", spot)
    texts = [_path_text(each) for each in args]
    known = [each for each in texts if each is not None]
    if not known or len(known) != len(texts) or sum(map(len, known)) > _MOST_PATH:
        unknown = unknown_in(args)
        if unknown is None and any(isinstance(each, Made) for each in args):
            return Made("os.path.join", args, kwargs, spot)
        return unknown or Unknown("this path is not followed", spot)
    return posixpath.join(*known)


def _path(machine: "Machine", args: list[Value], kwargs: dict[str, Value], spot: Spot) -> Value:
    made = _joined(machine, args, kwargs, spot) if args else "."
    return PurePosixPath(made) if isinstance(made, str) else made


def _text(_: "Machine", args: list[Value], __: dict[str, Value], spot: Spot) -> Value:
    text = methods.as_text(args[0]) if len(args) == 1 else None
    if text is None and len(args) == 1 and isinstance(args[0], Made):
        return args[0]
    return text if text is not None else unknown_in(args) or Unknown("this is not followed as a text", spot)


def _items(args: list[Value]) -> list[Value] | None:
    return containers.items_of(args[0]) if args else []


def _listed(_: "Machine", args: list[Value], __: dict[str, Value], spot: Spot) -> Value:
    items = _items(args)
    return items if items is not None else unknown_in(args) or Unknown("what is in this list is not followed", spot)


def _set(machine: "Machine", args: list[Value], kwargs: dict[str, Value], spot: Spot) -> Value:
    items = _listed(machine, args, kwargs, spot)
    return containers.distinct(items) if isinstance(items, list) else items


def _sorted(machine: "Machine", args: list[Value], kwargs: dict[str, Value], spot: Spot) -> Value:
    items = _listed(machine, args, kwargs, spot)
    return in_order(machine, items, kwargs, spot) if isinstance(items, list) else items


def _reversed(machine: "Machine", args: list[Value], kwargs: dict[str, Value], spot: Spot) -> Value:
    items = _listed(machine, args, kwargs, spot)
    return items[::-1] if isinstance(items, list) else items


def in_order(machine: "Machine", items: list[Value], kwargs: dict[str, Value], spot: Spot) -> Value:
    """A list as it is sorted by what is given to sorted or to a list's sort."""
    machine.step(len(items) // 16)
    key, is_reversed = kwargs.get("key"), kwargs.get("reverse", False)
    keys = [each if key is None else _applied(machine, key, each, spot) for each in items]
    comparable = any(all(isinstance(each, kind) for each in keys) for kind in (str, PurePosixPath, int))
    if unknown_in(items) is not None or not comparable or not isinstance(is_reversed, int):
        return items if len(items) < 2 else [Unknown("the order of this list is not followed", spot)]
    order = sorted(range(len(items)), key=keys.__getitem__, reverse=bool(is_reversed))
    return [items[index] for index in order]


def _paired(pairs: list[Value], args: list[Value], spot: Spot) -> Value:
    return pairs if _items(args) is not None else Unknown("what is in this list is not followed", spot)


def _zip(_: "Machine", args: list[Value], __: dict[str, Value], spot: Spot) -> Value:
    lists = [containers.items_of(each) for each in args]
    known = [each for each in lists if each is not None]
    return list(zip(*known, strict=False)) if len(known) == len(lists) else Unknown("this list is not followed", spot)


def _dict(_: "Machine", args: list[Value], kwargs: dict[str, Value], spot: Spot) -> Value:
    if not args:
        return dict(kwargs)
    if len(args) == 1 and isinstance(args[0], dict):
        return {**args[0], **kwargs}
    return unknown_in(args) or Unknown("what is in this dict is not followed", spot)


def _length(_: "Machine", args: list[Value], __: dict[str, Value], spot: Spot) -> Value:
    items = _items(args)
    return len(items) if items is not None and not unknown_in(items) else Unknown("its length is not followed", spot)


def _boolean(args: list[Value], spot: Spot) -> Value:
    known = containers.truth(args[0]) if len(args) == 1 else None
    return known if known is not None else Unknown("it is told only by a run", spot)


def _map(machine: "Machine", args: list[Value], _: dict[str, Value], spot: Spot) -> Value:
    items = containers.items_of(args[1]) if len(args) == 2 else None
    if items is None:
        return Unknown("this map is not followed", spot)
    return [_applied(machine, args[0], item, spot) for item in items]


def _filter(machine: "Machine", args: list[Value], _: dict[str, Value], spot: Spot) -> Value:
    items = containers.items_of(args[1]) if len(args) == 2 else None
    if items is None:
        return Unknown("this filter is not followed", spot)
    kept = [
        (item, containers.truth(item if args[0] is None else _applied(machine, args[0], item, spot))) for item in items
    ]
    if any(known is None for _, known in kept):
        return Unknown("this filter is told only by a run", spot)
    return [item for item, known in kept if known]


def _applied(machine: "Machine", function: Value, item: Value, spot: Spot) -> Value:
    machine.step()
    if isinstance(function, Function):
        return machine.call_function(function, [item], {}, spot)
    known = machine.library.get(getattr(function, "name", ""))
    return known(machine, [item], {}, spot) if known is not None else Unknown("this function is not followed", spot)


def _range(machine: "Machine", args: list[Value], __: dict[str, Value], spot: Spot) -> Value:
    numbers = [each for each in args if type(each) is int]
    if len(numbers) != len(args) or not 1 <= len(args) <= 3 or (len(args) == 3 and args[2] == 0):
        return Unknown("this range is not followed", spot)
    if any(abs(each) > _MOST_NUMBER for each in numbers):
        return Unknown("this range is not followed", spot)
    made = range(*numbers)
    machine.step(min(len(made), containers.MOST_ITEMS) // 16)
    return list(made) if len(made) <= containers.MOST_ITEMS else Unknown("this range is too long to follow", spot)


def _sum(machine: "Machine", args: list[Value], _: dict[str, Value], spot: Spot) -> Value:
    items = _items(args)
    if items is None:
        return Unknown("this sum is not followed", spot)
    if (len(args) == 2 and isinstance(args[1], list)) or (items and isinstance(items[0], list)):
        return _chain(machine, items, {}, spot)
    return Unknown("this sum is not followed", spot)


def _chain(machine: "Machine", args: list[Value], _: dict[str, Value], spot: Spot) -> Value:
    joined: list[Value] = []
    for each in args:
        containers.extend(machine, joined, each, spot)
    return joined
