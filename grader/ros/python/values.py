"""The values of Python expressions.

They are Python's own, and stand-ins for functions, iterators and what is not evaluated.

What is not known raises Undetermined where it is needed: `known`, `iterate` and `charge_str` are
the ways to a value.
"""

import ast
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from io import StringIO
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any, Literal, NoReturn

from grader.base.grouping import are_texts
from grader.base.text import last_part
from grader.ros.known.python_names import shared_message

if TYPE_CHECKING:
    from grader.ros.python.parse import Position


# A plain value is a str, number, bool, None, list, tuple, dict, range, StringIO (a file) or
# PurePosixPath.
Value = Any

MAX_TEXT = 100_000  # characters
MAX_PARTS = 20_000  # of a value, with all that it contains
MAX_BITS = 4_096  # of an integer
_MAX_MESSAGE = 1_000  # characters
_MAX_CANDIDATES = 64  # of a value; of one with more, none is kept
_MAX_KEY = 2**31  # keys that are larger could all have one hash
_EMPTY: dict[str, str] = {}
VIEWS: tuple[Any, ...] = (type(_EMPTY.keys()), type(_EMPTY.values()), type(_EMPTY.items()))
SCALARS = (str, int, float)
PLAIN: tuple[Any, ...] = (
    *SCALARS,
    type(None),
    range,
    list,
    tuple,
    dict,
    PurePosixPath,
    StringIO,
    *VIEWS,
)


OBJECT = " object>"  # ends the text of an object that has no text of its own


class EvaluationSignal(Exception):
    """What ends the evaluation of an expression or action, and is no error of the grader's own.

    `at` is the place that it is about; None for that of the expression.
    """

    follows_error = False

    def __init__(self, message: str = "", at: "Position | None" = None) -> None:
        super().__init__(message[:_MAX_MESSAGE])
        self.at = at

    def as_unknown(self, at: "Position") -> "Unknown":
        """Return the value of the expression at this place, which is not known for this reason."""
        return Unknown(str(self), self.at or at, follows_error=self.follows_error)


Lacking = Literal["", "value", "declaration"]


class EvaluationFails(EvaluationSignal):
    """Python, xacro or launch certainly raises an error here.

    The text is a sentence without its end. `kind` is Python's class of the error, if it is known.
    """

    lacks: Lacking = ""  # what another launch file, or the user, may give
    argument: str = ""  # that a function does not have

    def __init__(
        self,
        message: str = "",
        at: "Position | None" = None,
        kind: type[BaseException] | None = None,
    ) -> None:
        super().__init__(message, at)
        self.kind = kind


class UnknownArgument(EvaluationFails):
    """A function is given an argument that it does not have."""

    def __init__(self, message: str, at: "Position | None", argument: str) -> None:
        super().__init__(message, at)
        self.argument = argument


class MissingValue(EvaluationFails):
    """A launch argument without default is given no value."""

    lacks = "value"


class MissingDeclaration(EvaluationFails):
    """A launch configuration is used that nothing sets."""

    lacks = "declaration"


class Undetermined(EvaluationSignal):
    """A value, or whether there is an error, cannot be determined statically; the text says why.

    With `is_final`, nothing that follows in the file can be determined either: what is not
    evaluated may do anything. With `follows_error`, an error that is recorded already certainly
    stops Python before it needs the value.
    """

    def __init__(
        self,
        message: str,
        at: "Position | None" = None,
        *,
        is_final: bool = False,
        follows_error: bool = False,
    ) -> None:
        super().__init__(message, at)
        self.is_final = is_final
        self.follows_error = follows_error


# These are no dataclasses: making one takes 1 ms of the start of every command.


class Unknown:
    """A value that is not known, and why.

    With `follows_error`, an error that is recorded already certainly stops Python before it has the
    value.
    """

    is_text = False  # whether it certainly is a text
    candidates: tuple[Value, ...] = ()  # the values of which it is one, if it is anything

    def __init__(self, reason: str, at: "Position", *, follows_error: bool = False) -> None:
        self.reason = reason
        self.at = at
        self.follows_error = follows_error

    def as_signal(self, at: "Position | None" = None) -> Undetermined:
        """Return the signal that the value is needed at this place."""
        return Undetermined(self.reason, at, follows_error=self.follows_error)

    def attribute(self, name: str, at: "Position") -> "Value":
        """Return an attribute of it, at this place."""
        return UnknownAttribute(self, name, at)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Unknown) and (self.reason, self.at) == (other.reason, other.at)

    def __hash__(self) -> int:
        return hash((self.reason, self.at))


class InertValue(Unknown):
    """What a function returns that certainly changes nothing, and whose methods do not either."""


def one_of(values: Sequence[Value], reason: str, at: "Position") -> Unknown:
    """Return a value that is one of several; if only one is given, it may not be there."""
    unknown, candidates = Unknown(reason, at), {}  # by identity: each once
    for value in values:
        is_open = isinstance(value, Unknown) and value.candidates
        for candidate in value.candidates if is_open else (value,):
            candidates[id(candidate)] = candidate
    unknown.is_text = are_texts(candidates.values())
    if len(candidates) <= _MAX_CANDIDATES:
        unknown.candidates = tuple(candidates.values())
    return unknown


class ClassBody(Unknown):
    """A class of the file, which is not evaluated, but for the names that its body assigns."""

    def __init__(self, names: Mapping[str, "Value"], at: "Position") -> None:
        super().__init__("a class is not evaluated", at)
        self.names = names

    def attribute(self, name: str, at: "Position") -> "Value":
        """Return what the body assigns to a name, if it is plain."""
        value = self.names.get(name)
        return value if isinstance(value, PLAIN) else super().attribute(name, at)


class UnknownAttribute(Unknown):
    """An attribute of a value that is not known: anything, or a method, if it is called."""

    def __init__(self, owner: Unknown, name: str, at: "Position") -> None:
        super().__init__(owner.reason, at, follows_error=owner.follows_error)
        self.owner = owner
        self.name = name


class QualifiedName:
    """A module, or something in one, by its full name: os.path.join.

    With `is_defined` False, the file uses the name without defining or importing it, which is an
    error that is recorded already.
    """

    def __init__(self, name: str, *, is_defined: bool = True) -> None:
        self.name = name
        self.is_defined = is_defined


class BoundMethod:
    """A method of a value, which is not called yet.

    `node` is the expression in the file that gives it.
    """

    def __init__(self, owner: Value, name: str, node: ast.expr | None = None) -> None:
        self.owner = owner
        self.name = name
        self.node = node


class Call:
    """A call that is recorded, by the full name of what is called; it is its own result."""

    def __init__(
        self,
        name: str,
        args: list[Value],
        kwargs: dict[str, Value],
        at: "Position",
        owner: "Call | None" = None,
    ) -> None:
        """`owner` is the call whose result it is a method of."""
        self.name, self.args, self.kwargs, self.at, self.owner = name, args, kwargs, at, owner
        # where the arguments with names are written, of a call in the file
        self.places: dict[str, Position] = {}
        self.is_object = False  # whether it makes an object without operators and a text of its own
        self.method_calls: list[Call] = []  # the recorded ones, of its own result

    def __repr__(self) -> str:
        """Return the same text in every run, where Python shows an address."""
        return f"<{self.name} object>"

    @property
    def short(self) -> str:
        """The name without its module."""
        return last_part(self.name)

    def argument(self, position: int, *names: str) -> Value:
        """Return an argument by its position or by one of its names; None where it is missing."""
        for name in names:
            if name in self.kwargs:
                return self.kwargs[name]
        if position < len(self.args):
            return self.args[position]
        return None


class Function:
    """A function or lambda of the file.

    `body` evaluates it in a scope; `local` are the names that its body binds.
    """

    def __init__(
        self,
        parameters: ast.arguments,
        scope: "Scope",
        defaults: dict[str, Value],
        body: Callable[["Scope"], Value],
        at: "Position",
        local: frozenset[str] = frozenset(),
    ) -> None:
        self.parameters = parameters
        self.scope = scope
        self.defaults = defaults
        self.body = body
        self.at = at
        self.local = local


class Scope:
    """The names that are bound in a scope, and the scope around it.

    The names in `local` are bound here sooner or later, and nowhere else until then.
    """

    def __init__(
        self,
        names: dict[str, Value],
        outer: "Scope | None" = None,
        local: frozenset[str] = frozenset(),
    ) -> None:
        self.names = names
        self.outer = outer
        self.local = local
        self.returned: list[Value] = []  # by branches of which it is not known whether they run

    def find(self, name: str) -> Value:
        """Return the value of a name.

        Raises KeyError, or EvaluationFails for one that is bound later.
        """
        scope: Scope | None = self
        while scope:
            if name in scope.names:
                return scope.names[name]
            if name in scope.local:
                raise EvaluationFails(f"the name {name!r} is used before it has a value")
            scope = scope.outer
        raise KeyError(name)


class InnerScope(Scope):
    """The names that a comprehension binds."""


class PlainFunction:
    """A function that an expression may call.

    It is Python's own, or takes and returns what Python's own does.

    `kind` is "plain" for one whose arguments are wholly known; "holds" for one that only passes on
    what a list contains, known or not; "applies" for such a one that calls functions, by the one
    that it is given first; "path" for one whose result may begin with the stand-in of a folder,
    "text" for one that may contain it.
    """

    __slots__ = ("kind", "name", "run")

    def __init__(self, name: str, run: Callable[..., Value], kind: str = "plain") -> None:
        self.name = name
        self.run = run
        self.kind = kind


# The functions that are evaluated, by their full names; each of the second kind takes the
# evaluation and its call.
FunctionTable = Mapping[str, "PlainFunction | Callable[[Any, Call], Value]"]


class Namespace:
    """Names that are reached with a dot: math.pi. `find` raises EvaluationFails for other names."""

    __slots__ = ("find", "name")

    def __init__(self, name: str, find: Callable[[str], Value]) -> None:
        self.name = name
        self.find = find


class Items:
    """An iterator, such as zip(), map() and a generator.

    It is Python's own, so it yields each item once.
    """

    __slots__ = ("iterator",)

    def __init__(self, items: Iterable[Value]) -> None:
        self.iterator = iter(items)


Items.__name__ = "iterator"  # as Python's messages name it


class DottedDict(dict[Value, Value]):
    """A dict whose items are also attributes, as xacro makes them of YAML."""


OPAQUE = (Unknown, QualifiedName, BoundMethod, Call, Function, PlainFunction, Namespace, Items)


def list_parts(part: Value) -> Collection[Value]:
    """Return what a value contains."""
    if isinstance(part, dict):
        return [*part.keys(), *part.values()]
    if isinstance(part, list | tuple | range | set):
        return part
    if isinstance(part, VIEWS):
        return list(part)
    return ()


def too_large(what: str) -> NoReturn:
    """Raise Undetermined for a value that grows too large."""
    raise Undetermined(f"a {what} grows too large")


def call_plain(function: Callable[..., Value], *args: Value, **kwargs: Value) -> Value:
    """Return what a function of plain values returns; what it raises is EvaluationFails."""
    try:
        return function(*args, **kwargs)
    except (EvaluationSignal, RecursionError, MemoryError):
        raise
    except Exception as error:  # noqa: BLE001  whatever Python raises here, it raises for the student's expression
        if not _has_text([*args, *kwargs.values()]):
            raise Undetermined(
                "this use of a function, a namespace or an iterator is not supported"
            ) from None
        message = error.args[0] if isinstance(error, KeyError) and error.args else error
        text = f"{type(error).__name__}: {shared_message(str(message))}"
        raise EvaluationFails(text, kind=type(error)) from None


def iterate(value: Value) -> Iterator[Value]:
    """Return what a loop over a value yields, one by one."""
    if isinstance(value, Items):
        return value.iterator
    if isinstance(value, PLAIN) or (callable(value) and not isinstance(value, OPAQUE)):
        iterator: Iterator[Value] = call_plain(iter, value)
        return iterator
    return refuse(value, "this loop is not supported")


def refuse(value: Value, message: str) -> NoReturn:
    """Raise Undetermined for a value that is not known, or not supported."""
    if isinstance(value, Unknown):
        raise value.as_signal(value.at)
    raise Undetermined(explain_unknown(value) or message, getattr(value, "at", None))


def unknown_after_error(at: "Position") -> Unknown:
    """Return the value of an expression that certainly raises an error."""
    return Unknown("Python raises an error before", at, follows_error=True)


def list_items(value: Value) -> list[Value]:
    """Return what a loop over a value yields, all of it known. Raises Undetermined."""
    items = list(iterate(value))
    if isinstance(value, Items):
        for item in items:
            known(item)
    return items


def known(value: Value) -> Value:
    """Return a value if all of it is known. Raises Undetermined."""
    unknown = unknown_in(value)
    if unknown or isinstance(value, OPAQUE):
        refuse(unknown or value, "this value is not supported")
    return value


def explain_unknown(value: Value) -> str:
    """Return why a value is not known; nothing for a plain one."""
    match value:
        case Unknown(reason=reason):
            return str(reason)
        case Call(is_object=True):
            return f"the value of {value.short}(...) is not evaluated"
        case Call(name=name) | QualifiedName(name=name) | BoundMethod(name=name):
            return f"the value of {name} is not evaluated"
        case Function():
            return "this use of a function is not supported"
    return ""


def unknown_in(value: Value) -> Unknown | None:
    """Return the first unknown value in a value."""
    pending = [value]
    seen = set()
    while pending:
        item = pending.pop()
        if isinstance(item, Unknown):
            return item
        if isinstance(item, list | tuple | dict) and id(item) not in seen:
            seen.add(id(item))
            pending += reversed(list(item.values()) if isinstance(item, dict) else list(item))
    return None


def checked_key(key: Value) -> Value:
    """Return a key of a dict: a text or a number whose hash no other one has.

    Raises Undetermined for other keys.
    """
    if not isinstance(key, str) and not (isinstance(key, int) and abs(key) < _MAX_KEY):
        raise Undetermined(
            "a key of a dict that is neither a text nor a small whole number is not supported"
        )
    return key


def charge_str(value: Value) -> str:
    """Return str() of a value that is charged.

    Raises Undetermined where it differs between runs, such as an address.
    """
    if is_object(value):
        return f"<{value.short}{OBJECT}"
    if not isinstance(value, (*SCALARS, PurePosixPath)) and not (
        isinstance(value, PLAIN) and _has_text(value)
    ):
        raise Undetermined("the text of this value differs between runs")
    return str(value)


def is_object(value: Value) -> bool:
    """Return whether a value is an object without operators.

    Such an object is true, and equal to itself alone.
    """
    return isinstance(value, Call) and value.is_object


def _has_text(value: Value) -> bool:
    """Return whether the text of a value is the same in every run."""
    if isinstance(value, dict):
        value = (*value.keys(), *value.values())
    if isinstance(value, list | tuple):
        return all(map(_has_text, value))
    return isinstance(value, Items) or not isinstance(
        value, (*OPAQUE, StringIO, PurePosixPath, *VIEWS)
    )


def path_text(value: Value) -> str | None:
    """Return the text of a path or string; None for other values."""
    if isinstance(value, str | PurePosixPath):
        return str(value)
    return None
