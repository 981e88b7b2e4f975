"""Methods of plain values: texts, lists, dicts and paths."""

import re
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any

from grader.static_python.values import Made, Spot, Steering, Unknown, Value, unknown_in

if TYPE_CHECKING:
    from grader.static_python.machine import Machine

FOLDER = "<package>"
_MOST_TEXT = 100_000
_MOST_PATH = 4_096
_MOST_PARTS = 100
_MOST_PART = 255
_MOST_PIECES = 20_000
_WRITES = ("mkdir", "rename", "replace", "rmdir", "symlink_to", "touch", "unlink", "write_bytes", "write_text")
_TEXT_METHODS = frozenset(
    {"strip", "lstrip", "rstrip", "lower", "upper", "title", "capitalize", "removeprefix", "removesuffix", "startswith",
     "endswith", "split", "rsplit", "splitlines", "partition", "rpartition", "count", "find", "isdigit"}
)  # fmt: skip


def as_text(value: Value) -> str | None:
    """What str() makes of a plain value; None of others."""
    if isinstance(value, int) and value.bit_length() > 1000:
        return None  # Python itself refuses to write the longest
    if isinstance(value, str | int | float | PurePosixPath | None):
        return str(value)
    return None


def path_of(parts: list[Value], spot: Spot) -> Value:
    """The path that is joined from texts and paths."""
    if sum(len(str(part)) for part in parts) > _MOST_PATH:
        return Unknown("the path grows too long", spot)
    return PurePosixPath(*parts)


def names_the_folder(path: str) -> bool:
    """Whether a text holds the stand-in for the name of the package's folder, which is not known."""
    return FOLDER in path.removeprefix(f"/{FOLDER}")


def percent(template: str, value: Value, spot: Spot) -> Value:
    """A text with %s in it, filled."""
    values = list(value) if isinstance(value, tuple) else [value]
    texts = [as_text(each) for each in values]
    pieces = template.replace("%%", "\0").split("%s")
    long = len(template) + sum(len(each or "") for each in texts) > _MOST_TEXT
    odd = "\0" in template or any("%" in piece for piece in pieces)
    if len(pieces) != len(texts) + 1 or None in texts or odd or long:
        return Unknown("a formatted text of this kind is not followed", spot)
    filled = [piece + (text or "") for piece, text in zip(pieces, [*texts, ""], strict=True)]
    return "".join(filled).replace("\0", "%")


def call(machine: "Machine", owner: Value, name: str, args: list[Value], kwargs: dict[str, Value], spot: Spot) -> Value:
    """The value of a method of a plain value; Unknown for methods that are not followed."""
    unknown = unknown_in([*args, *kwargs.values()]) if not isinstance(owner, list | dict) else None
    if unknown is not None:
        return unknown
    result: Value = None
    match owner:
        case str():
            machine.step(len(owner) // 32)
            result = _text(owner, name, args, kwargs, spot)
        case list():
            machine.step(len(owner) // 64 if name not in ("append", "extend") else 0)
            result = _list(machine, owner, name, args, kwargs, spot)
        case dict():
            machine.step(len(owner) // 64)
            result = _dict(machine, owner, name, args, kwargs, spot)
        case PurePosixPath():
            result = _path(machine, owner, name, args, kwargs, spot)
        case _:
            result = Unknown(f"the method {name} of this is not followed", spot)
    return result


def path_attribute(path: PurePosixPath, name: str) -> Value:
    """An attribute of a path; what is no plain attribute is a method about to be called."""
    from grader.static_python.values import Bound

    match name:
        case "name" | "stem" | "parts" if FOLDER in str(getattr(path, name)):
            return Unknown("the name of the package's folder is told only by a run", Spot(1, 1))
        case "parents" | "parts" if len(path.parts) > _MOST_PARTS:
            return Unknown("the path is too long", Spot(1, 1))
        case "name" | "stem" | "suffix":
            return getattr(path, name)
        case "parent":
            return path.parent
        case "parents":
            return list(path.parents)
        case "parts":
            return path.parts
        case _:
            return Bound(path, name)


def _text(text: str, name: str, args: list[Value], kwargs: dict[str, Value], spot: Spot) -> Value:
    unknown = Unknown(f"the text method {name} is not followed here", spot)
    if names_the_folder(text):
        return unknown
    if name == "join" and len(args) == 1 and isinstance(args[0], list | tuple):
        parts = [each for each in args[0] if isinstance(each, str)]
        fits = sum(map(len, parts)) + len(text) * len(parts) <= _MOST_TEXT
        return text.join(parts) if len(parts) == len(args[0]) and fits else unknown
    if name == "format":
        return _format(text, args, kwargs, unknown)
    if name == "replace" and len(args) == 2 and all(isinstance(each, str) for each in args):
        grown = len(text) + (text.count(args[0]) + 1) * len(args[1])
        return text.replace(args[0], args[1]) if grown <= _MOST_TEXT else unknown
    if name in _TEXT_METHODS and not kwargs:
        try:
            result: Any = getattr(text, name)(*args)
        except (TypeError, ValueError, OverflowError):
            return unknown
        if isinstance(result, list | tuple) and len(result) > _MOST_PIECES:
            return unknown
        return list(result) if isinstance(result, list | tuple) else result
    return unknown


def _format(text: str, args: list[Value], kwargs: dict[str, Value], unknown: Unknown) -> Value:
    named: dict[str, str | None] = {str(index): as_text(value) for index, value in enumerate(args)}
    named |= {key: as_text(value) for key, value in kwargs.items()}
    automatic = iter(range(len(args)))
    missing = False

    def fill(match: re.Match[str]) -> str:
        nonlocal missing
        key = match[1] or str(next(automatic, -1))
        value = named.get(key)
        missing |= value is None
        return value or ""

    if "{{" in text or "}}" in text:
        return unknown
    filled = re.sub(r"\{(\w*)\}", fill, text)
    return unknown if missing or "{" in re.sub(r"\{\w*\}", "", text) or len(filled) > _MOST_TEXT else filled


def _list(
    machine: "Machine", items: list[Value], name: str, args: list[Value], kwargs: dict[str, Value], spot: Spot
) -> Value:
    from grader.static_python.containers import MOST_ITEMS, extend, lose
    from grader.static_python.library import in_order

    machine.may_fail()
    known = machine.unsure is None and not any(isinstance(each, Unknown) for each in items)
    if isinstance(items, Steering) and name not in ("copy", "index", "count"):
        name = "steer"
    match name, args:
        case "append", [value]:
            if len(items) < MOST_ITEMS:
                items.append(machine.unsure or value)
            return None
        case "extend", [value]:
            extend(machine, items, value, spot)
            return None
        case "insert", [int() as index, value] if len(items) < MOST_ITEMS:
            items.insert(max(-MOST_ITEMS, min(index, MOST_ITEMS)), machine.unsure or value)
            return None
        case "copy", []:
            return list(items)
        case "sort", [] if known and isinstance(ordered := in_order(machine, items, kwargs, spot), list):
            items[:] = ordered
            return None
        case "reverse", [] if known:
            items.reverse()
            return None
        case (("index" | "count"), [str() as value]) if known and (value in items or name == "count"):
            return items.index(value) if name == "index" else items.count(value)
        case "remove", [str() | PurePosixPath() as value] if known and value in items:
            items.remove(value)
            return None
        case "pop", ([] | [int()]) if known and -len(items) <= (args[0] if args else -1) < len(items):
            return items.pop(*args)
        case "clear", [] if known:
            items.clear()
            return None
        case (("index" | "count"), _):
            return Unknown(f"the list method {name} is not followed here", spot)
        case _:
            unknown = Unknown(f"the list method {name} is not followed here", spot)
            lose(items, unknown)
            return unknown


def _dict(
    machine: "Machine", table: dict[Any, Value], name: str, args: list[Value], kwargs: dict[str, Value], spot: Spot
) -> Value:
    from grader.static_python.containers import lose

    known = machine.unsure is None and "**" not in table
    unknown = Unknown(f"the dict method {name} is not followed here", spot)
    machine.may_fail()
    match name, args:
        case "items", []:
            return list(table.items())
        case "keys", []:
            return list(table)
        case "values", []:
            return list(table.values())
        case "copy", []:
            return dict(table)
        case "get", _ if "**" in table:
            return unknown
        case "get", [str() | int() as key, *default]:
            return table.get(key, default[0] if default else None)
        case "setdefault", [str() | int() as key, value]:
            return table.setdefault(key, machine.unsure or value)
        case "update", [dict() as other] if len(table) + len(other) < 20_000:
            table.update({key: machine.unsure or value for key, value in {**other, **kwargs}.items()})
            return None
        case "update", [] if len(table) < 20_000:
            table.update({key: machine.unsure or value for key, value in kwargs.items()})
            return None
        case "pop", [str() | int() as key, *default] if known and (key in table or default):
            return table.pop(key, *default[:1])
        case "clear", [] if known:
            table.clear()
            return None
        case _:
            lose(table, unknown)
            return unknown


def _path(
    machine: "Machine", path: PurePosixPath, name: str, args: list[Value], kwargs: dict[str, Value], spot: Spot
) -> Value:
    texts = [each for each in args if isinstance(each, str | PurePosixPath)]
    match name, texts:
        case (("as_posix" | "__str__" | "__fspath__"), []):
            return str(path)
        case "expanduser", _ if str(path).startswith("~"):
            return Unknown("whose home folder is meant is told only by a run", spot)
        case (("resolve" | "absolute" | "expanduser"), []):
            known = machine.library.get("os.path.abspath")
            made = known(machine, [str(path)], {}, spot) if known is not None and name != "expanduser" else None
            return PurePosixPath(made) if isinstance(made, str) else path
        case "joinpath", _ if len(texts) == len(args):
            return path_of([path, *texts], spot)
        case (("with_name" | "with_suffix" | "with_stem"), [str() as text]) if len(text) <= _MOST_PART:
            try:
                return getattr(path, name)(text)
            except ValueError:
                return Unknown("this path cannot be changed so", spot)
        case "relative_to", [other]:
            try:
                return path.relative_to(other)
            except ValueError:
                return Unknown("this path is not below that one", spot)
        case (("read_text" | "open"), _):
            known = machine.library.get("builtins.open")
            given = [str(path), *args] if name == "open" else [str(path)]
            opened = Made("builtins.open", given, {}, spot) if known is None else known(machine, given, kwargs, spot)
            if not isinstance(opened, Made):
                return opened
            return Made("builtins.open.read", [], {}, spot, opened) if name == "read_text" else opened
        case _:
            known = machine.library.get(f"pathlib.Path.{name}")
            if known is not None:
                return known(machine, [path, *args], kwargs, spot)
            if name in _WRITES:
                machine.made.append(Made(f"pathlib.Path.{name}", [path, *args], kwargs, spot))
            machine.may_fail()
            return Unknown(f"the path method {name} is not followed", spot)
