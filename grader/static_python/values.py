"""What the expressions of a followed Python file come to: plain values, or stand-ins for what only a run would tell."""

import ast
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

_MOST_SEEN = 20_000

# A plain value is a text, number, bool, None, list, tuple, dict, set or PurePosixPath, or one of the stand-ins below.
Value = Any


class Spot(NamedTuple):
    """Where an expression stands; line and column count from 1, columns in characters."""

    line: int
    column: int


@dataclass(frozen=True, slots=True)
class Unknown:
    """A value that cannot be told without running the file, and the reason."""

    reason: str
    at: Spot


@dataclass(frozen=True, slots=True)
class Named:
    """A module, or something in one, by its full name: os.path.join."""

    name: str


@dataclass(frozen=True, slots=True)
class Bound:
    """An attribute of a value that is about to be called: the join of ', '.join(names)."""

    owner: Value
    name: str


@dataclass(eq=False, slots=True)
class Made:
    """What a call of something outside the file gives: its full name and its arguments.

    `owner` is what it is a method of; `calls` are the methods that were called on it since.
    """

    name: str
    args: list[Value]
    kwargs: dict[str, Value]
    at: Spot
    owner: Value = None
    calls: list["Made"] = field(default_factory=list)

    def argument(self, position: int, *names: str) -> Value:
        """An argument by its position or by one of its names; None where it is not given."""
        for name in names:
            if name in self.kwargs:
                return self.kwargs[name]
        return self.args[position] if position < len(self.args) else None


@dataclass(eq=False, slots=True)
class Function:
    """A function that the file defines, the scope that it was defined in, and the defaults of its parameters."""

    node: ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda
    scope: "Scope"
    defaults: dict[str, Value] = field(default_factory=dict)


@dataclass(eq=False, slots=True)
class Scope:
    """The names that are known at some point, and those around them.

    `declared` has the scopes of names that are global or nonlocal here; `is_loop` marks the inside of a comprehension.
    """

    names: dict[str, Value] = field(default_factory=dict)
    outer: "Scope | None" = None
    declared: "dict[str, Scope]" = field(default_factory=dict)
    is_loop: bool = False

    def find(self, name: str) -> Value:
        """The value of a name; raises KeyError."""
        scope: Scope | None = self.declared.get(name, self)
        while scope is not None:
            if name in scope.names:
                return scope.names[name]
            scope = scope.outer
        raise KeyError(name)

    def bind(self, name: str, value: Value) -> None:
        """Give a name a value, where it belongs."""
        self.declared.get(name, self).names[name] = value

    def holder(self, name: str) -> "Scope":
        """The nearest scope around this one that has a name, else the outermost."""
        scope = self
        while scope.outer is not None:
            scope = scope.outer
            if name in scope.names:
                break
        return scope


class Steering(list[Value]):
    """A list of folders that os.walk has given: a change of it would change where the walk goes on."""


class TooHard(Exception):
    """The file does something after which nothing more is told of it."""


class Fault(NamedTuple):
    """Something that stops Python when it comes to this place: a name that is not defined, an import that fails."""

    message: str
    at: Spot


class Choice(NamedTuple):
    """The keyword arguments of a call, unpacked: what is known of them, and whether that is all."""

    known: Mapping[str, Value]
    complete: bool


def unknown_in(value: Value) -> Unknown | None:
    """The first thing in a value that cannot be told; of a value that is too large to look through, that it is."""
    waiting, seen, count = [value], set[int](), 0
    while waiting:
        each = waiting.pop()
        if isinstance(each, Unknown):
            return each
        if isinstance(each, list | tuple | dict) and id(each) not in seen:
            seen.add(id(each))
            count += len(each)
            if count > _MOST_SEEN:
                return Unknown("it is too large to follow", Spot(1, 1))
            waiting += reversed(each.values() if isinstance(each, dict) else each)
    return None


def size(value: Value) -> int:
    """About how many parts a value has, which tells how long it takes to work with it."""
    waiting, count = [value], 0
    while waiting and count < _MOST_SEEN:
        each = waiting.pop()
        if isinstance(each, list | tuple | dict):
            count += len(each)
            if len(each) < _MOST_SEEN:
                waiting += each.values() if isinstance(each, dict) else each
        elif isinstance(each, str):
            count += len(each) // 32
    return count


def at(node: ast.AST) -> Spot:
    """Where a node stands; without one, the file's beginning."""
    return Spot(getattr(node, "lineno", 1), getattr(node, "col_offset", 0) + 1)
