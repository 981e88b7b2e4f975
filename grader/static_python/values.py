"""Abstract values: what an expression evaluates to without being run. A plain Python value, or a stand-in for another one."""

import ast
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from grader.static_python.positions import START, Position

UNKNOWN_KEYS = "**"  # the key of an entry that represents unknown keys, in a dict and among keyword arguments

_MAX_SEARCHED = 20_000  # parts of a value

# A plain value is a str, number, bool, None, list, tuple, dict or PurePosixPath; a set is a list without duplicates.
Value = Any


@dataclass(frozen=True, slots=True)
class Unknown:
    """A value that cannot be determined statically, and the reason. An operation with it is unknown for the same reason."""

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
    """A call of something by its full name; as a value, the result of a call that is not evaluated.

    `owner` is the call whose result it is a method of; `method_calls` are the methods that were called on its own result.
    `uncertainty` is set where the call may not be reached.
    """

    name: str
    args: list[Value]
    kwargs: dict[str, Value]
    at: Position
    owner: "Call | None" = None
    method_calls: list["Call"] = field(default_factory=list)
    uncertainty: Unknown | None = None

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
    """The names that are bound in a scope, and the scope around it.

    `declared` has the scopes of names that are global or nonlocal here; `is_loop` marks the scope of a comprehension.
    """

    names: dict[str, Value] = field(default_factory=dict)
    outer: "Scope | None" = None
    declared: "dict[str, Scope]" = field(default_factory=dict)
    is_loop: bool = False

    def find(self, name: str) -> Value:
        """Return the value of a name; raises KeyError."""
        scope: Scope | None = self.declared.get(name, self)
        while scope is not None:
            if name in scope.names:
                return scope.names[name]
            scope = scope.outer
        raise KeyError(name)

    def bind(self, name: str, value: Value) -> None:
        """Give a name a value, in the scope that it belongs to."""
        self.declared.get(name, self).names[name] = value

    def holder(self, name: str) -> "Scope":
        """Return the nearest scope around this one that binds a name, else the outermost."""
        scope = self
        while scope.outer is not None:
            scope = scope.outer
            if name in scope.names:
                break
        return scope


def unknown_in(value: Value) -> Unknown | None:
    """Return the first unknown value in a value, and an unknown value for one that is too large to search."""
    pending, seen, count = [value], set[int](), 0
    while pending:
        item = pending.pop()
        if isinstance(item, Unknown):
            return item
        if isinstance(item, list | tuple | dict) and id(item) not in seen:
            seen.add(id(item))
            count += len(item)
            if count > _MAX_SEARCHED:
                return Unknown("a value is too large to evaluate", START)
            pending += reversed(item.values() if isinstance(item, dict) else item)
    return None
