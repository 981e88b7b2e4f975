"""Attributes and methods of plain values (strings, lists, dicts, paths): most are Python's own, on bounded values."""

import re
from contextlib import suppress
from pathlib import PurePosixPath
from typing import Any

from grader.static_python.evaluation import Evaluation
from grader.static_python.imports import CONSTANTS, attribute_error
from grader.static_python.operators import WalkFolders, extend, forget
from grader.static_python.parse import Position
from grader.static_python.path_methods import part_of_path, path_method
from grader.static_python.values import (
    MAX_ITEMS,
    MAX_TEXT,
    UNKNOWN_KEYS,
    BoundMethod,
    Call,
    QualifiedName,
    Unknown,
    Value,
    as_text,
    names_package_folder,
    unknown_in,
)

_TEXT_METHODS = frozenset(
    {"strip", "lstrip", "rstrip", "lower", "upper", "title", "capitalize", "removeprefix", "removesuffix", "startswith",
     "endswith", "split", "rsplit", "splitlines", "partition", "rpartition", "count", "find", "isdigit"}
)  # fmt: skip
_LIST_METHODS = ("reverse", "clear", "count", "index", "remove", "pop")


def attribute(evaluation: Evaluation, owner: Value, name: str, at: Position) -> Value:
    """Return the value of an attribute; a method is returned as a BoundMethod."""
    match owner:
        case Unknown():
            return owner
        case QualifiedName(name="?glob"):  # used without an import: an attribute shows that the module is meant
            return QualifiedName(f"glob.{name}")
        case QualifiedName(name="glob.glob") if name in ("glob", "iglob"):
            message = f"glob is a function here, so glob.{name} is not defined: write glob(...)"
            evaluation.error(message, at, AttributeError)
            return owner
        case QualifiedName(name=module):
            full = f"{module}.{name}"
            error = attribute_error(module, name) if full not in evaluation.functions else None
            if error is not None:
                evaluation.error(error, at, AttributeError)
            return CONSTANTS.get(full, QualifiedName(full))
        case PurePosixPath() if name in ("name", "stem", "suffix", "parent", "parents", "parts"):
            return part_of_path(owner, name, at)
        case _:
            return BoundMethod(owner, name)


def call_method(evaluation: Evaluation, owner: Value, name: str, call: Call) -> Value:
    """Return the value of a method of a plain value; Unknown for a method that is not supported."""
    unknown = unknown_in([*call.args, *call.kwargs.values()]) if not isinstance(owner, list | dict) else None
    if unknown is not None:
        return unknown
    match owner:
        case str():
            evaluation.step(len(owner) // 32)
            return _text(owner, name, call)
        case list():
            evaluation.step(len(owner) // 64 if name not in ("append", "extend") else 0)
            return _list(evaluation, owner, name, call)
        case dict():
            evaluation.step(len(owner) // 64)
            return _dict(evaluation, owner, name, call)
        case PurePosixPath():
            return path_method(evaluation, owner, name, call)
        case _:
            return Unknown(f"the method {name} of this value is not supported", call.at)


def sort_items(evaluation: Evaluation, items: list[Value], call: Call) -> list[Value]:
    """Return a list in the order that sorted, or its own sort, gives it."""
    evaluation.step(len(items) // 16)
    key, is_reversed = call.kwargs.get("key"), call.kwargs.get("reverse", False)
    keys = [item if key is None else evaluation.apply(key, item, call.at) for item in items]
    comparable = any(all(isinstance(value, kind) for value in keys) for kind in (str, PurePosixPath, int))
    if unknown_in(items) is not None or not comparable or not isinstance(is_reversed, int):
        return items if len(items) < 2 else [Unknown("the order of this list is known only at run time", call.at)]
    order = sorted(range(len(items)), key=keys.__getitem__, reverse=bool(is_reversed))
    return [items[index] for index in order]


def _text(text: str, name: str, call: Call) -> Value:
    unknown = Unknown(f"this use of the string method {name} is not supported", call.at)
    if names_package_folder(text):
        return unknown
    match name, call.args:
        case "join", [list() | tuple() as items]:
            parts = [item for item in items if isinstance(item, str)]
            fits = sum(map(len, parts)) + len(text) * len(parts) <= MAX_TEXT
            return text.join(parts) if len(parts) == len(items) and fits else unknown
        case "format", _:
            return _format(text, call, unknown)
        case "replace", [str() as old, str() as new]:
            return text.replace(old, new) if len(text) + (text.count(old) + 1) * len(new) <= MAX_TEXT else unknown
    result: Any = unknown
    if name in _TEXT_METHODS and not call.kwargs:
        with suppress(TypeError, ValueError, OverflowError):
            result = getattr(text, name)(*call.args)
    if isinstance(result, list | tuple):
        return list(result) if len(result) <= MAX_ITEMS else unknown
    return result


def _format(text: str, call: Call, unknown: Unknown) -> Value:
    """Return text.format(...), for fields that are names or numbers."""
    fields: dict[str, str | None] = {str(index): as_text(value) for index, value in enumerate(call.args)}
    fields |= {key: as_text(value) for key, value in call.kwargs.items()}
    automatic = iter(range(len(call.args)))
    used = [key or str(next(automatic, -1)) for key in re.findall(r"\{(\w*)\}", text)]
    texts = [value for key in used if (value := fields.get(key)) is not None]
    plain = re.split(r"\{\w*\}", text)
    if len(texts) != len(used) or "{{" in text or "}}" in text or "{" in "".join(plain):
        return unknown
    filled = "".join(piece for pair in zip(plain, [*texts, ""], strict=True) for piece in pair)
    return filled if len(filled) <= MAX_TEXT else unknown


def _list(evaluation: Evaluation, items: list[Value], name: str, call: Call) -> Value:
    evaluation.may_have_failed = True
    is_known = evaluation.uncertainty is None and not any(isinstance(item, Unknown) for item in items)
    if isinstance(items, WalkFolders) and name not in ("copy", "index", "count"):
        forget(items, Unknown(f"this use of the list method {name} is not supported", call.at))
    match name, call.args:
        case "copy", []:
            return list(items)
        case "append", [value] if len(items) < MAX_ITEMS:
            items.append(evaluation.uncertainty or value)
        case "insert", [int() as index, value] if len(items) < MAX_ITEMS:
            items.insert(max(-MAX_ITEMS, min(index, MAX_ITEMS)), evaluation.uncertainty or value)
        case "extend", [value]:
            extend(evaluation, items, value, call.at)
        case "sort", [] if is_known:
            items[:] = sort_items(evaluation, items, call)
        case _:
            return _list_method(items, name, call, is_known=is_known)
    return None


def _list_method(items: list[Value], name: str, call: Call, *, is_known: bool) -> Value:
    """Return the value of a list's own method; one that is not run may have changed the list."""
    unknown = Unknown(f"this use of the list method {name} is not supported", call.at)
    if is_known and name in _LIST_METHODS and all(isinstance(value, str | int | PurePosixPath) for value in call.args):
        with suppress(TypeError, ValueError, IndexError, OverflowError):
            return getattr(items, name)(*call.args)
    if name not in ("index", "count"):
        forget(items, unknown)
    return unknown


def _dict(evaluation: Evaluation, table: dict[Any, Value], name: str, call: Call) -> Value:
    evaluation.may_have_failed = True
    is_complete = UNKNOWN_KEYS not in table
    if name in ("items", "keys", "values") and not call.args:
        return list(getattr(table, name)())
    match name, call.args:
        case "setdefault", [str() | int() as key, value]:
            return table.setdefault(key, evaluation.uncertainty or value)
        case "update", ([] | [dict()]) if len(table) + sum(map(len, call.args)) < MAX_ITEMS:
            added = {**(call.args[0] if call.args else {}), **call.kwargs}
            return table.update({key: evaluation.uncertainty or value for key, value in added.items()})
        case ("copy", []) | ("get", [str() | int(), *_]) if is_complete or name == "copy":
            return getattr(table, name)(*call.args[:2])
        case ("clear", []) | ("pop", [str() | int(), *_]) if is_complete and evaluation.uncertainty is None:
            with suppress(KeyError):
                return getattr(table, name)(*call.args[:2])
    unknown = Unknown(f"this use of the dict method {name} is not supported", call.at)
    if name != "get":
        forget(table, unknown)
    return unknown
