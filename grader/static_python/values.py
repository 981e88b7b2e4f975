"""The values of Python expressions: Python's own, and stand-ins for functions, iterators and what is not evaluated."""

import ast
from collections.abc import Callable, Collection, Iterable, Iterator
from functools import cached_property
from io import StringIO
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any, NoReturn, dataclass_transform

if TYPE_CHECKING:
    from grader.static_python.parse import Position

# A plain value is a str, number, bool, None, list, tuple, dict, range, StringIO (a file) or PurePosixPath.
Value = Any

MAX_TEXT = 100_000  # characters
MAX_PARTS = 20_000  # of a value, with all that it contains
MAX_BITS = 4_096  # of an integer
UNKNOWN_KEYS = "**"  # among keyword arguments, the entry that stands for keys that are not known
_MAX_KEY = 2**31  # keys that are larger could all have one hash
_MAX_MESSAGE = 1_000  # characters
_EMPTY: dict[str, str] = {}
_VIEWS: tuple[Any, ...] = (type(_EMPTY.keys()), type(_EMPTY.values()), type(_EMPTY.items()))
SCALARS = (str, int, float)
PLAIN: tuple[Any, ...] = (*SCALARS, type(None), range, list, tuple, dict, PurePosixPath, StringIO, *_VIEWS)


class EvaluationSignal(Exception):
    """What ends the evaluation of an expression, and is no error of the grader's own."""

    def __init__(self, message: str = "") -> None:
        super().__init__(message[:_MAX_MESSAGE])


class ExpressionFails(EvaluationSignal):
    """Python certainly raises an error for this expression; the text is a sentence without its end."""

    def __init__(self, message: str, kind: type[BaseException] = TypeError) -> None:
        super().__init__(message)
        self.kind = kind


class Undetermined(EvaluationSignal):
    """The value of an expression cannot be determined statically; the text says why, and `at` where, if it is known."""

    def __init__(self, message: str, at: "Position | None" = None) -> None:
        super().__init__(message)
        self.at = at


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
        """Return the value of a name; raise KeyError, or ExpressionFails for one that is bound later."""
        scope: Scope | None = self
        while scope is not None:
            if name in scope.names:
                return scope.names[name]
            if name in scope.local:
                raise ExpressionFails(f"the name {name!r} is used before it has a value", UnboundLocalError)
            scope = scope.outer
        raise KeyError(name)


class PlainFunction:
    """A function that an expression may call. It is Python's own, or takes and returns what Python's own does.

    `kind` is "plain" for one whose arguments are wholly known; "holds" for one that only passes on what a list
    contains, known or not; "applies" for such a one that calls functions, by the one that it is given first; "path" for
    one whose result may begin with the stand-in of a folder, "text" for one that may contain it.
    """

    __slots__ = ("kind", "name", "run")

    def __init__(self, name: str, run: Callable[..., Value], kind: str = "plain") -> None:
        self.name, self.run, self.kind = name, run, kind


class Namespace:
    """Names that are reached with a dot: math.pi. `find` raises ExpressionFails for other names.

    Like a dict, it is false if it has no names.
    """

    __slots__ = ("find", "has_names", "name")

    def __init__(self, name: str, find: Callable[[str], Value], has_names: Callable[[], bool] = lambda: True) -> None:
        self.name, self.find, self.has_names = name, find, has_names

    def __bool__(self) -> bool:
        return self.has_names()


class Items:
    """An iterator, such as zip(), map() and a generator: Python's own, so it yields each item once."""

    __slots__ = ("iterator",)

    def __init__(self, items: Iterable[Value]) -> None:
        self.iterator: Iterator[Value] = iter(items)


Items.__name__ = "iterator"  # as Python's messages name it


class DottedDict(dict[Value, Value]):
    """A dict whose items are also attributes, as xacro makes them of YAML."""


OPAQUE = (Unknown, QualifiedName, BoundMethod, Call, Function, PlainFunction, Namespace, Items)
_REPEATED = (list, tuple, dict)


def call_plain(function: Callable[..., Value], *args: Value, **kwargs: Value) -> Value:
    """Return what a function of plain values returns; what it raises is ExpressionFails."""
    try:
        return function(*args, **kwargs)
    except (EvaluationSignal, RecursionError, MemoryError):
        raise
    except Exception as error:  # noqa: BLE001  whatever Python raises here, it raises for the student's expression
        if not has_text([*args, *kwargs.values()]):
            raise Undetermined("this use of a function, a namespace or an iterator is not supported") from None
        message = error.args[0] if isinstance(error, KeyError) and error.args else error
        raise ExpressionFails(f"{type(error).__name__}: {message}", type(error)) from None


def iterate(value: Value) -> Iterator[Value]:
    """Return what a loop over a value yields, one by one."""
    if isinstance(value, Items):
        return value.iterator
    if isinstance(value, PLAIN) or (callable(value) and not isinstance(value, OPAQUE)):
        found: Iterator[Value] = call_plain(iter, value)
        return found
    return refuse(value, "this loop is not supported")


def refuse(value: Value, message: str) -> NoReturn:
    """Raise Undetermined for a value that is not known, or not supported."""
    raise Undetermined(reason_of(value) or message, getattr(value, "at", None))


def items_of(value: Value) -> list[Value]:
    """Return what a loop over a value yields, all of it known. Raises Undetermined."""
    items = list(iterate(value))
    for item in items if isinstance(value, Items) else ():
        known(item)
    return items


def known(value: Value) -> Value:
    """Return a value if all of it is known. Raises Undetermined."""
    unknown = unknown_in(value)
    if unknown is not None or isinstance(value, OPAQUE):
        refuse(unknown or value, "this value is not supported")
    return value


def reason_of(value: Value) -> str:
    """Return why a value is not known; nothing for a plain one."""
    match value:
        case Unknown(reason=reason):
            return str(reason)
        case Call(name=name) | QualifiedName(name=name) | BoundMethod(name=name):
            return f"the value of {name} is not evaluated"
        case Function():
            return "this use of a function is not supported"
    return ""


def unknown_in(value: Value) -> Unknown | None:
    """Return the first unknown value in a value."""
    pending, seen = [value], set[int]()
    while pending:
        item = pending.pop()
        if isinstance(item, Unknown):
            return item
        if isinstance(item, _REPEATED) and id(item) not in seen:
            seen.add(id(item))
            pending += reversed([*item.values()] if isinstance(item, dict) else [*item])
    return None


def parts_of(part: Value) -> Collection[Value]:
    """Return what a value contains."""
    if isinstance(part, dict):
        return [*part.keys(), *part.values()]
    return part if isinstance(part, list | tuple | range) else [*part] if isinstance(part, _VIEWS) else ()


def checked_key(key: Value) -> Value:
    """Return a key of a dict: a text or a number whose hash no other one has. Raises Undetermined for other keys."""
    if not isinstance(key, str) and not (isinstance(key, int) and abs(key) < _MAX_KEY):
        raise Undetermined("a key of a dict that is neither a text nor a small whole number is not supported")
    return key


def str_of(value: Value) -> str:
    """Return str() of a value that is charged; raise Undetermined where it differs between runs, such as an address."""
    if not isinstance(value, (*SCALARS, PurePosixPath)) and not (isinstance(value, PLAIN) and has_text(value)):
        raise Undetermined("the text of this value differs between runs")
    return str(value)


def has_text(value: Value) -> bool:
    """Return whether the text of a value is the same in every run."""
    if isinstance(value, dict):
        value = (*value.keys(), *value.values())
    if isinstance(value, list | tuple):
        return all(map(has_text, value))
    return isinstance(value, Items) or not isinstance(value, (*OPAQUE, StringIO, PurePosixPath, *_VIEWS))


def too_large(what: str) -> NoReturn:
    """Raise Undetermined for a value that grows too large."""
    raise Undetermined(f"a {what} grows too large")


def path_text(value: Value) -> str | None:
    """Return the text of a path or string; None for other values."""
    return str(value) if isinstance(value, str | PurePosixPath) else None


def as_text(value: Value) -> str | None:
    """Return str() of a plain value; None of others."""
    if isinstance(value, int) and value.bit_length() > 1000:
        return None  # Python itself refuses to write the longest
    return str(value) if isinstance(value, str | int | float | PurePosixPath | None) else None
