"""The values of closed expressions: plain Python values of bounded size, functions and namespaces of the allow-list."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, NoReturn

Value = Any

MAX_TEXT = 100_000  # characters
MAX_ITEMS = 20_000  # of a value, with all that it contains
MAX_BITS = 4_096  # of an integer
_VIEWS: tuple[Any, ...] = (type({}.keys()), type({}.values()), type({}.items()))
_ITERATOR: Any = type(iter([]))
SETS = (set, frozenset)
CONTAINERS: tuple[Any, ...] = (list, tuple, *SETS, dict, *_VIEWS)
PLAIN: tuple[Any, ...] = (str, int, float, complex, type(None), range, *CONTAINERS)


class ExpressionFails(Exception):
    """Python certainly raises an error for this expression; the text is a sentence without its end."""


class Undetermined(Exception):
    """The value of an expression cannot be determined statically; the text says why."""


@dataclass(frozen=True, slots=True)
class Function:
    """A function that an expression may call."""

    name: str
    run: Callable[..., Value]


@dataclass(frozen=True, slots=True)
class Namespace:
    """Names that are reached with a dot: math.pi. `find` raises ExpressionFails for other names."""

    name: str
    find: Callable[[str], Value]


class DottedDict(dict[Value, Value]):
    """A dict whose items are also attributes, as xacro makes them of YAML."""


def check_size(value: Value) -> int:
    """Return how many parts a value has, each as often as it occurs; raise Undetermined if that is too many."""
    pending, count = [value], 0
    while pending:
        part = pending.pop()
        count += 1
        if isinstance(part, str):
            if len(part) > MAX_TEXT:
                too_large("text")
            count += len(part) // 32
        elif isinstance(part, CONTAINERS):
            if count + len(part) > MAX_ITEMS:
                too_large("list")
            pending += [*part.keys(), *part.values()] if isinstance(part, dict) else part
        elif isinstance(part, int) and part.bit_length() > MAX_BITS:
            too_large("number")
        elif isinstance(part, range) and part[MAX_ITEMS:]:
            too_large("range")
        if count > MAX_ITEMS:
            too_large("value")
    return count


def run(function: Callable[..., Value], *args: Value, **kwargs: Value) -> Value:
    """Return what a function of plain values returns; what it raises is ExpressionFails."""
    try:
        return function(*args, **kwargs)
    except (ExpressionFails, Undetermined, RecursionError, MemoryError):
        raise
    except Exception as error:  # noqa: BLE001  whatever Python raises here, it raises for the student's expression
        given = [*args, *kwargs.values()]
        if any(isinstance(value, Namespace) for value in given):
            raise Undetermined("this use of a namespace is not supported") from None
        message = str(error) if _has_text(given) else "unsupported value"
        raise ExpressionFails(f"{type(error).__name__}: {message}") from None


def items_of(value: Value) -> Iterator[Value]:
    """Return an iterator over what a loop over a value yields."""
    if isinstance(value, _ITERATOR):
        return value  # type: ignore[no-any-return]
    if isinstance(value, PLAIN):
        check_size(value)
        if isinstance(value, SETS) and len(value) > 1:
            raise Undetermined("the order of a set differs between runs")
        return iter(list(run(iter, value)))
    raise Undetermined("this loop is not supported")


def text_of(value: Value) -> str:
    """Return str() of a value."""
    check_text(value)
    return str(value)


def check_text(value: Value) -> None:
    """Raise Undetermined for a value whose text is too long, or differs between runs: the order of a set, an address."""
    check_size(value)
    if not isinstance(value, PLAIN) or not _has_text(value):
        raise Undetermined("the text of this value differs between runs")


def _has_text(value: Value) -> bool:
    """Return whether the text of a value is the same in every run."""
    if isinstance(value, dict):
        return all(map(_has_text, (*value.keys(), *value.values())))
    if isinstance(value, CONTAINERS):
        return not (isinstance(value, SETS) and len(value) > 1) and all(map(_has_text, value))
    return not isinstance(value, Function | Namespace | _ITERATOR)


def too_large(what: str) -> NoReturn:
    """Raise Undetermined for a value that grows too large."""
    raise Undetermined(f"a {what} grows too large")
