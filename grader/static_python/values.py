"""Abstract values, plain Python values or stand-ins that expressions evaluate to: their size, items, truth and text."""

import ast
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import PurePosixPath
from typing import Any

from grader.static_python.parse import START, Position

# The key of an entry that stands for keys that are not known, in a dict and among keyword arguments.
UNKNOWN_KEYS = "**"
_MAX_SEARCHED = 20_000  # parts of a value

# A plain value is a str, number, bool, None, list, tuple, dict or PurePosixPath; a set is a list without duplicates.
Value = Any


@dataclass(frozen=True, slots=True)
class Unknown:
    """A value that cannot be determined statically, and why. An operation with it is unknown for the same reason."""

    reason: str
    at: Position

    def __add__(self, right: Value) -> Value:
        return [self, *right] if isinstance(right, list) else self

    def __radd__(self, left: Value) -> Value:
        return [*left, self] if isinstance(left, list) else self

    def _with(self, _: Value) -> "Unknown":
        return self

    __truediv__ = __rtruediv__ = __mod__ = __or__ = __ror__ = _with


@dataclass(frozen=True, slots=True)
class QualifiedName:
    """A module, or something in one that is not evaluated, by its full name: os.path.join."""

    name: str


@dataclass(frozen=True, slots=True)
class BoundMethod:
    """A method of a value, about to be called: the join of ', '.join(names)."""

    owner: Value
    name: str


@dataclass(eq=False, slots=True)
class Call:
    """A call of something by its full name; as a value, the result of a call that is not evaluated."""

    name: str
    args: list[Value]
    kwargs: dict[str, Value]
    at: Position
    owner: "Call | None" = None  # the call whose result it is a method of
    method_calls: list["Call"] = field(default_factory=list)  # the methods that were called on its own result
    uncertainty: Unknown | None = None  # set where the call may not be reached

    def argument(self, position: int, *names: str) -> Value:
        """Return an argument by its position or by one of its names; None where it is missing."""
        for name in names:
            if name in self.kwargs:
                return self.kwargs[name]
        return self.args[position] if position < len(self.args) else None

    def unknown(self, reason: str) -> Unknown:
        """Return the first argument that is unknown, else an unknown result with this reason."""
        return unknown_in(self.args) or Unknown(reason, self.at)


@dataclass(eq=False, slots=True)
class Function:
    """A function or lambda of the file. `body` evaluates it in a scope, for a call at a position."""

    parameters: ast.arguments
    scope: "Scope"
    defaults: dict[str, Value]
    body: Callable[["Scope", Position], Value]
    at: Position


@dataclass(eq=False, slots=True)
class Scope:
    """The names that are bound in a scope, and the scope around it."""

    names: dict[str, Value] = field(default_factory=dict)
    outer: "Scope | None" = None
    declared: "dict[str, Scope]" = field(default_factory=dict)  # the scopes of names that are global or nonlocal here
    is_loop: bool = False  # the scope of a comprehension

    def find(self, name: str) -> Value:
        """Return the value of a name; raises KeyError."""
        scope = self.declared.get(name, self)
        while name not in scope.names and scope.outer is not None:
            scope = scope.outer
        return scope.names[name]

    def bind(self, name: str, value: Value) -> None:
        """Give a name a value, in the scope that it belongs to."""
        self.declared.get(name, self).names[name] = value

    def holder(self, name: str) -> "Scope":
        """Return the nearest scope around this one that binds a name, else the outermost."""
        scope = self.outer or self
        while name not in scope.names and scope.outer is not None:
            scope = scope.outer
        return scope


_COLLECTION = (list, tuple, dict)  # each use of `list | tuple | dict` would make a union


def unknown_in(value: Value) -> Unknown | None:
    """Return the first unknown value in a value, and an unknown value for one that is too large to search."""
    pending, seen, count = [value], set[int](), 0
    while pending:
        item = pending.pop()
        if isinstance(item, Unknown):
            return item
        if isinstance(item, _COLLECTION) and id(item) not in seen:
            seen.add(id(item))
            count += len(item)
            if count > _MAX_SEARCHED:
                return Unknown("a value is too large to evaluate", START)
            pending += reversed(item.values() if isinstance(item, dict) else item)
    return None


MAX_ITEMS = 20_000  # of a list or dict
MAX_TEXT = 100_000  # characters
MAX_PATH = 4_096  # characters
PACKAGE_FOLDER = "<package>"  # stands for the name of the package's folder, which the submission does not determine


def size(value: Value) -> int:
    """Return about how many parts a value has: how many steps an operation with it costs."""
    pending, count = [value], 0
    while pending and count < MAX_ITEMS:
        item = pending.pop()
        if isinstance(item, _COLLECTION):
            count += len(item)
            if len(item) < MAX_ITEMS:
                pending += item.values() if isinstance(item, dict) else item
        elif isinstance(item, str):
            count += len(item) // 32
    return count


def items_of(value: Value) -> list[Value] | None:
    """Return what a loop over a value yields; None where this is unknown."""
    if isinstance(value, _COLLECTION) or (isinstance(value, str) and len(value) < MAX_ITEMS):
        return list(value)
    return None


def truth(value: Value) -> bool | None:
    """Return whether a condition holds; None where this is known only at run time."""
    match value:
        case [*items] if items and all(isinstance(item, Unknown) for item in items):
            return None
        case {"**": _}:
            return None
        case None | str() | int() | float() | list() | tuple() | dict():
            return bool(value)
    return True if isinstance(value, PurePosixPath | Function) else None


def as_text(value: Value) -> str | None:
    """Return str() of a plain value; None of others."""
    if isinstance(value, int) and value.bit_length() > 1000:
        return None  # Python itself refuses to write the longest
    return str(value) if isinstance(value, str | int | float | PurePosixPath | None) else None


def distinct(values: list[Value]) -> list[Value]:
    """Return the values of a set, without duplicates. Their order is not the set's, which differs between runs."""
    plain = all(isinstance(value, str | int | float | PurePosixPath | None) for value in values)
    return list(dict.fromkeys(values)) if plain else values


def names_package_folder(path: str) -> bool:
    """Return whether a text contains the stand-in for the name of the package's folder, but not as a path's root."""
    return PACKAGE_FOLDER in path.removeprefix(f"/{PACKAGE_FOLDER}")


def path_text(value: Value) -> str | None:
    """Return the text of a path or string; None for other values."""
    return str(value) if isinstance(value, str | PurePosixPath) else None
