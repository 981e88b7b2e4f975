"""Operators, comparisons and subscripts of abstract values, and changes of lists and dicts."""

import ast
import operator
from collections.abc import Callable
from contextlib import suppress
from pathlib import PurePosixPath
from typing import Any

from grader.static_python.evaluation import Evaluation, EvaluationStopped
from grader.static_python.parse import Position
from grader.static_python.values import (
    MAX_ITEMS,
    MAX_PATH,
    MAX_TEXT,
    UNKNOWN_KEYS,
    Call,
    QualifiedName,
    Unknown,
    Value,
    as_text,
    items_of,
    names_package_folder,
    size,
)

_TYPE_NAMES: dict[type, str] = {
    str: "a string", list: "a list", tuple: "a tuple", dict: "a dict", type(None): "None", PurePosixPath: "a path",
    int: "a number", float: "a number",
}  # fmt: skip
_RUN_TIME = "its value is known only at run time"
# The operators that are run, and the types of both operands for which they are.
_OPERATORS: dict[type[ast.operator], tuple[Callable[[Any, Any], Any], tuple[Any, ...]]] = {
    ast.Add: (operator.add, (str, tuple, int | float)),
    ast.Div: (operator.truediv, ()),
    ast.Mod: (operator.mod, ()),
    ast.BitOr: (operator.or_, (dict,)),
}
_NOT_ADDED = (str, list, tuple, dict, type(None), PurePosixPath)  # of two types, Python adds none of these
_COMPARISONS: dict[type[ast.cmpop], Callable[[Any, Any], bool]] = {
    ast.Eq: operator.eq, ast.NotEq: operator.ne, ast.Is: operator.is_, ast.IsNot: operator.is_not,
    ast.In: lambda left, right: left in right, ast.NotIn: lambda left, right: left not in right,
    ast.Lt: operator.lt, ast.LtE: operator.le, ast.Gt: operator.gt, ast.GtE: operator.ge,
}  # fmt: skip


class WalkFolders(list[Value]):
    """A list of folders from os.walk: a change of it changes where the walk continues."""


def operate(evaluation: Evaluation, op: ast.operator, left: Value, right: Value, at: Position) -> Value:
    """Return the value of a binary operator; an unknown operand has its own operators."""
    evaluation.step(sum(len(value) for value in (left, right) if isinstance(value, str)) // 32)
    match op, left, right:
        case ast.Add(), list(), list() | Call():
            joined = list(left)
            extend(evaluation, joined, right, at)
            return joined
        case ast.Add(), Call(), list():
            return [Unknown("the added value is known only at run time", at), *right]
        case ast.Div(), Call(), _:
            return Call("truediv", [left, right], {}, at)
        case ast.Mod(), str(), _:  # str has its own %, which would write out an unknown value
            return right if isinstance(right, Unknown) else _percent_format(left, right, at)
        case ast.Div(), (str() | PurePosixPath()), (str() | PurePosixPath()) if not type(left) is type(right) is str:
            return join_path([left, right], at)
    return _of_plain_values(evaluation, op, left, right, at)


def _of_plain_values(evaluation: Evaluation, op: ast.operator, left: Value, right: Value, at: Position) -> Value:
    function, types = _OPERATORS.get(type(op), (None, ()))
    kind = next((it for it in types if isinstance(left, it) and isinstance(right, it)), None)
    if function is not None and kind is not None:
        if isinstance(left, str | tuple) and len(left) + len(right) > (MAX_TEXT if kind is str else MAX_ITEMS):
            return Unknown("a value grows too long", at)
        try:
            return function(left, right)
        except OverflowError:
            return Unknown("a number is too large", at)
    if isinstance(op, ast.Add) and isinstance(left, _NOT_ADDED) and isinstance(right, _NOT_ADDED):
        evaluation.error(f"Python cannot add {type_name(right)} to {type_name(left)}", at)
    unknown = [value for value in (left, right) if isinstance(value, Unknown)]
    if function is not None and unknown:
        with suppress(TypeError):
            return function(left, right)
    return unknown[0] if unknown else Unknown("this operation is not supported", at)


def type_name(value: Value) -> str:
    """Return the type of a plain value for a message: "a string"; an empty text for other values."""
    return next((name for kind, name in _TYPE_NAMES.items() if isinstance(value, kind)), "")


def compare(evaluation: Evaluation, op: ast.cmpop, left: Value, right: Value, at: Position) -> Value:
    """Return the value of a comparison; only plain values are compared."""
    cost = size([left, right])
    evaluation.step(cost // 64)
    supported = cost < MAX_ITEMS and _is_plain(left) and _is_plain(right)
    supported &= not isinstance(right, dict) or isinstance(left, str | int | float | PurePosixPath | None)
    match op:
        case ast.Is() | ast.IsNot():
            supported &= left is None or right is None
        case ast.In() | ast.NotIn():
            supported &= isinstance(right, list | tuple | dict) or (isinstance(left, str) and isinstance(right, str))
        case ast.Lt() | ast.LtE() | ast.Gt() | ast.GtE():
            supported &= isinstance(left, int) and isinstance(right, int)
    return _COMPARISONS[type(op)](left, right) if supported else Unknown(_RUN_TIME, at)


def subscript(evaluation: Evaluation, owner: Value, key: Value, at: Position) -> Value:
    """Return the value of owner[key]; the key may be a slice."""
    if isinstance(key, slice):
        whole = isinstance(owner, str) or (isinstance(owner, list | tuple) and are_known(evaluation, owner))
        if whole and all(bound is None or type(bound) is int for bound in (key.start, key.stop, key.step)):
            evaluation.step(len(owner) // 32)
            return owner[key] if key.step != 0 else Unknown("the step of a slice is 0", at)
        return Unknown("this slice is not supported", at)
    evaluation.may_have_failed = True
    if isinstance(owner, QualifiedName):
        return Call(f"{owner.name}[]", [key], {}, at)
    if not isinstance(owner, list | tuple) or are_known(evaluation, owner):
        try:
            if isinstance(owner, str | list | tuple | dict) and isinstance(key, str | int):
                return owner[key]  # type: ignore[index]
        except (LookupError, TypeError):
            pass
    return Unknown("the item at this index is known only at run time", at)


def join_path(parts: list[Value], at: Position) -> Value:
    """Return the path that is joined from texts and paths."""
    if sum(len(str(part)) for part in parts) > MAX_PATH:
        return Unknown("a path grows too long", at)
    return PurePosixPath(*parts)


def extend(evaluation: Evaluation, target: list[Value], value: Value, at: Position) -> None:
    """Extend a list; an unknown part of it stays at its index."""
    items = items_of(value)
    evaluation.step(len(items or ()) // 64)
    if items is None:
        target.append(value if isinstance(value, Unknown) else Unknown("the added value is known only at run time", at))
    elif evaluation.uncertainty is not None:
        target += [evaluation.uncertainty] * bool(items)
    elif isinstance(target, WalkFolders):
        forget(target, Unknown("the walk is changed", at))
    elif len(target) + len(items) > MAX_ITEMS:
        target.append(Unknown("a list grows too long", at))
    else:
        target += items


def store(evaluation: Evaluation, container: Value, key: Value, value: Value, at: Position) -> None:
    """Set an item of a dict or list; where it is unknown which, forget all of them."""
    if isinstance(container, dict) and isinstance(key, str | int) and len(container) < MAX_ITEMS:
        container[key] = value
    elif isinstance(container, list) and isinstance(key, int) and are_known(evaluation, container):
        if -len(container) <= key < len(container):
            container[key] = value
    else:
        forget(container, Unknown("this assignment to an item is not supported", at))


def remove(evaluation: Evaluation, container: Value, key: Value, unknown: Unknown) -> None:
    """Delete an item of a dict or list; where it is unknown which, forget all of them for the reason in `unknown`."""
    match container:
        case list() if isinstance(key, int) and not isinstance(container, WalkFolders):
            is_known = -len(container) <= key < len(container) and are_known(evaluation, container)
        case dict():
            is_known = isinstance(key, str | int) and key in container and UNKNOWN_KEYS not in container
        case _:
            is_known = False
    if is_known and evaluation.uncertainty is None:
        del container[key]
    else:
        forget(container, unknown)


def forget(container: Value, unknown: Unknown) -> None:
    """Make the items of a list or dict unknown, because it is changed in a way that is not supported."""
    match container:
        case WalkFolders():
            raise EvaluationStopped("os.walk whose list of folders is changed is not supported")
        case list():
            container[:] = [unknown]
        case dict():
            container.update(dict.fromkeys([*container, UNKNOWN_KEYS], unknown))


def are_known(evaluation: Evaluation, items: "list[Value] | tuple[Value, ...]") -> bool:
    """Return whether every item of a list is known, so that each is at its index."""
    evaluation.step(len(items) // 64)
    return not any(isinstance(item, Unknown) for item in items)


def _percent_format(template: str, value: Value, at: Position) -> Value:
    """Return the value of template % value, with %s only."""
    texts = [as_text(item) for item in (value if isinstance(value, tuple) else [value])]
    pieces = template.replace("%%", "\0").split("%s")
    length = len(template) + sum(len(text or "") for text in texts)
    odd = "\0" in template or any("%" in piece for piece in pieces)
    if len(pieces) != len(texts) + 1 or None in texts or odd or length > MAX_TEXT:
        return Unknown("a format of this kind is not supported", at)
    filled = [piece + (text or "") for piece, text in zip(pieces, [*texts, ""], strict=True)]
    return "".join(filled).replace("\0", "%")


def _is_plain(value: Value) -> bool:
    if isinstance(value, list | tuple | dict):
        return all(map(_is_plain, value.values() if isinstance(value, dict) else value))
    if isinstance(value, str | PurePosixPath) and names_package_folder(str(value)):
        return False
    return value is None or isinstance(value, str | int | float | PurePosixPath)
