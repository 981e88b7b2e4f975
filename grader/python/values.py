"""The values of Python expressions: Python's own, and stand-ins for functions, iterators and what is not evaluated."""

import ast
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from functools import cached_property
from io import StringIO
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any, NoReturn, dataclass_transform

if TYPE_CHECKING:
    from grader.python.parse import Position

# A plain value is a str, number, bool, None, list, tuple, dict, range, StringIO (a file) or PurePosixPath.
Value = Any

MAX_TEXT = 100_000  # characters
MAX_PARTS = 20_000  # of a value, with all that it contains
MAX_BITS = 4_096  # of an integer
_MAX_MESSAGE = 1_000  # characters
_EMPTY: dict[str, str] = {}
VIEWS: tuple[Any, ...] = (type(_EMPTY.keys()), type(_EMPTY.values()), type(_EMPTY.items()))
SCALARS = (str, int, float)
PLAIN: tuple[Any, ...] = (*SCALARS, type(None), range, list, tuple, dict, PurePosixPath, StringIO, *VIEWS)


class EvaluationSignal(Exception):
    """What ends the evaluation of an expression or action, and is no error of the grader's own.

    `at` is the place that it is about; None for that of the expression.
    """

    def __init__(self, message: str = "", at: "Position | None" = None) -> None:
        super().__init__(message[:_MAX_MESSAGE])
        self.at = at


class EvaluationFails(EvaluationSignal):
    """Python, xacro or launch certainly raises an error here; the text is a sentence without its end."""


class Undetermined(EvaluationSignal):
    """A value, or whether there is an error, cannot be determined statically; the text says why.

    With `is_final`, nothing that follows in the file can be determined either: what is not evaluated may do anything.
    """

    def __init__(self, message: str, at: "Position | None" = None, *, is_final: bool = False) -> None:
        super().__init__(message, at)
        self.is_final = is_final


@dataclass_transform(eq_default=False)
class Record:
    """A class with an attribute for each annotation, as a dataclass has them, but made in no time.

    Making a dataclass takes 1 ms of the start of every command.
    """

    def __init__(self, *values: Any, **named: Any) -> None:
        for name, value in zip(type(self).__annotations__, values, strict=False):
            setattr(self, name, value)
        for name, value in named.items():
            setattr(self, name, value)


class Unknown(Record):
    """A value that is not known, and why."""

    reason: str
    at: "Position"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Unknown) and (self.reason, self.at) == (other.reason, other.at)

    def __hash__(self) -> int:
        return hash((self.reason, self.at))


class QualifiedName(Record):
    """A module, or something in one, by its full name: os.path.join."""

    name: str


class BoundMethod(Record):
    """A method of a value, which is not called yet."""

    owner: Value
    name: str


class Call(Record):
    """A call that is recorded, by the full name of what is called; it is its own result.

    `owner` is the call whose result it is a method of.
    """

    name: str
    args: list[Value]
    kwargs: dict[str, Value]
    at: "Position"
    owner: "Call | None" = None

    @cached_property
    def method_calls(self) -> "list[Call]":
        """The recorded methods that were called on its own result."""
        return []

    def argument(self, position: int, *names: str) -> Value:
        """Return an argument by its position or by one of its names; None where it is missing."""
        for name in names:
            if name in self.kwargs:
                return self.kwargs[name]
        return self.args[position] if position < len(self.args) else None


class Function(Record):
    """A function or lambda of the file. `body` evaluates it in a scope; `local` are the names that its body binds."""

    parameters: ast.arguments
    scope: "Scope"
    defaults: dict[str, Value]
    body: Callable[["Scope"], Value]
    at: "Position"
    local: frozenset[str] = frozenset()


class Scope(Record):
    """The names that are bound in a scope, and the scope around it.

    The names in `local` are bound here sooner or later, and nowhere else until then.
    """

    names: dict[str, Value]
    outer: "Scope | None" = None
    local: frozenset[str] = frozenset()

    def find(self, name: str) -> Value:
        """Return the value of a name; raise KeyError, or EvaluationFails for one that is bound later."""
        scope: Scope | None = self
        while scope is not None:
            if name in scope.names:
                return scope.names[name]
            if name in scope.local:
                raise EvaluationFails(f"the name {name!r} is used before it has a value")
            scope = scope.outer
        raise KeyError(name)


class PlainFunction:
    """A function that an expression may call. It is Python's own, or takes and returns what Python's own does.

    `kind` is "plain" for one whose arguments are wholly known; "holds" for one that only passes on what a list
    contains, known or not; "applies" for such a one that calls functions, by the one that it is given first; "path" for
    one whose result may begin with the stand-in of a folder, "text" for one that may contain it. `own` is Python's own
    function, where `run` stands for one.
    """

    __slots__ = ("kind", "name", "own", "run")

    def __init__(
        self, name: str, run: Callable[..., Value], kind: str = "plain", own: Callable[..., Value] | None = None
    ) -> None:
        self.name, self.run, self.kind, self.own = name, run, kind, own


# The functions that are evaluated, by their full names; each of the second kind takes the evaluation and its call.
FunctionTable = Mapping[str, "PlainFunction | Callable[[Any, Call], Value]"]


class Namespace:
    """Names that are reached with a dot: math.pi. `find` raises EvaluationFails for other names."""

    __slots__ = ("find", "name")

    def __init__(self, name: str, find: Callable[[str], Value]) -> None:
        self.name, self.find = name, find


class Items:
    """An iterator, such as zip(), map() and a generator: Python's own, so it yields each item once."""

    __slots__ = ("iterator",)

    def __init__(self, items: Iterable[Value]) -> None:
        self.iterator: Iterator[Value] = iter(items)


Items.__name__ = "iterator"  # as Python's messages name it


class DottedDict(dict[Value, Value]):
    """A dict whose items are also attributes, as xacro makes them of YAML."""


OPAQUE = (Unknown, QualifiedName, BoundMethod, Call, Function, PlainFunction, Namespace, Items)


def parts_of(part: Value) -> Collection[Value]:
    """Return what a value contains."""
    if isinstance(part, dict):
        return [*part.keys(), *part.values()]
    return part if isinstance(part, list | tuple | range) else [*part] if isinstance(part, VIEWS) else ()


def too_large(what: str) -> NoReturn:
    """Raise Undetermined for a value that grows too large."""
    raise Undetermined(f"a {what} grows too large")
