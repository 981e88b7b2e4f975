"""Operators and comparisons of a followed file."""

import ast
from pathlib import PurePosixPath
from typing import TYPE_CHECKING

from grader.static_python import methods
from grader.static_python.containers import MOST_ITEMS, MOST_TEXT, extend
from grader.static_python.values import Made, Spot, Unknown, Value, size

if TYPE_CHECKING:
    from grader.static_python.machine import Machine

KINDS = {
    str: "a text",
    list: "a list",
    tuple: "a tuple",
    dict: "a dict",
    type(None): "None",
    PurePosixPath: "a path",
}


def operate(machine: "Machine", op: ast.operator, left: Value, right: Value, spot: Spot) -> Value:
    """The value of a sum, of a path with / or of a text with %; a list keeps what is known of it."""
    machine.step(sum(len(value) for value in (left, right) if isinstance(value, str)) // 32)
    match op, left, right:
        case ast.Add(), str(), str():
            return left + right if len(left) + len(right) <= MOST_TEXT else Unknown("it grows too long", spot)
        case ast.Add(), int() | float(), int() | float():
            try:
                return left + right
            except OverflowError:
                return Unknown("the number is too large", spot)
        case ast.Add(), tuple(), tuple():
            return (*left, *right) if len(left) + len(right) <= MOST_ITEMS else Unknown("it grows too long", spot)
        case ast.Add(), list(), list() | Unknown() | Made():
            joined = list(left)
            extend(machine, joined, right, spot)
            return joined
        case ast.Add(), _, list() if isinstance(left, Unknown | Made):
            return [left if isinstance(left, Unknown) else Unknown("what is added here is not followed", spot), *right]
        case (
            ast.Add(),
            str() | list() | tuple() | dict() | None | PurePosixPath(),
            str() | list() | tuple() | dict() | None | PurePosixPath(),
        ):
            machine.fault(f"Python cannot add {KINDS[type(right)]} to {KINDS[type(left)]}", spot)
        case ast.Div(), (str() | PurePosixPath()), (str() | PurePosixPath()) if not (
            isinstance(left, str) and isinstance(right, str)
        ):
            return methods.path_of([left, right], spot)
        case ast.Div(), Made(), _:
            return Made("truediv", [left, right], {}, spot)
        case ast.Mod(), str(), _ if not isinstance(right, Unknown):
            return methods.percent(left, right, spot)
        case ast.BitOr(), dict(), dict():
            return left | right
    for value in (left, right):
        if isinstance(value, Unknown):
            return value
    return Unknown("an operation of this kind is not followed", spot)


def compare(machine: "Machine", op: ast.cmpop, left: Value, right: Value, spot: Spot) -> Value:
    """The value of a comparison of two plain values."""
    unknown = Unknown("it is told only by a run", spot)
    cost = size([left, right])
    machine.step(cost // 64)
    if cost >= MOST_ITEMS or not _is_plain(left) or not _is_plain(right):
        return unknown
    if isinstance(right, dict) and not isinstance(left, str | int | float | PurePosixPath | None):
        return unknown
    match op:
        case ast.Eq():
            return left == right
        case ast.NotEq():
            return left != right
        case ast.Is():
            return left is right if right is None or left is None else unknown
        case ast.IsNot():
            return left is not right if right is None or left is None else unknown
        case ast.In() if isinstance(right, list | tuple | dict) or (isinstance(left, str) and isinstance(right, str)):
            return left in right
        case ast.NotIn() if isinstance(right, list | tuple | dict) or (
            isinstance(left, str) and isinstance(right, str)
        ):
            return left not in right
        case ast.Lt() | ast.LtE() | ast.Gt() | ast.GtE() if isinstance(left, int) and isinstance(right, int):
            less, equal = left < right, left == right
            match op:
                case ast.Lt():
                    return less
                case ast.LtE():
                    return less or equal
                case ast.Gt():
                    return not less and not equal
                case _:
                    return not less
        case _:
            return unknown


def _is_plain(value: Value) -> bool:
    if isinstance(value, list | tuple | dict):
        return all(map(_is_plain, value.values() if isinstance(value, dict) else value))
    if isinstance(value, str | PurePosixPath) and methods.names_the_folder(str(value)):
        return False
    return value is None or isinstance(value, str | int | float | PurePosixPath)
