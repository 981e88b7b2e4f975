"""What is known of the values of Python expressions, and what a loop over one yields."""

from collections.abc import Callable, Iterator
from io import StringIO
from pathlib import PurePosixPath
from typing import NoReturn

from grader.python.values import (
    OPAQUE,
    PLAIN,
    SCALARS,
    VIEWS,
    BoundMethod,
    Call,
    EvaluationFails,
    EvaluationSignal,
    Function,
    Items,
    QualifiedName,
    Undetermined,
    Unknown,
    Value,
)

_MAX_KEY = 2**31  # keys that are larger could all have one hash


_REPEATED = (list, tuple, dict)


def call_plain(function: Callable[..., Value], *args: Value, **kwargs: Value) -> Value:
    """Return what a function of plain values returns; what it raises is EvaluationFails."""
    try:
        return function(*args, **kwargs)
    except (EvaluationSignal, RecursionError, MemoryError):
        raise
    except Exception as error:  # noqa: BLE001  whatever Python raises here, it raises for the student's expression
        if not has_text([*args, *kwargs.values()]):
            raise Undetermined("this use of a function, a namespace or an iterator is not supported") from None
        message = error.args[0] if isinstance(error, KeyError) and error.args else error
        raise EvaluationFails(f"{type(error).__name__}: {message}") from None


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
    return isinstance(value, Items) or not isinstance(value, (*OPAQUE, StringIO, PurePosixPath, *VIEWS))


def path_text(value: Value) -> str | None:
    """Return the text of a path or string; None for other values."""
    return str(value) if isinstance(value, str | PurePosixPath) else None
