"""The values of closed expressions, plain ones of bounded size, and the budget to which work with them is charged."""

from collections.abc import Callable, Collection, Iterable
from typing import Any, NoReturn

Value = Any

READING = 500_000  # parts that reading one submission may produce or look at: some 0.5 s
MAX_TEXT = 100_000  # characters
MAX_PARTS = 20_000  # of a value, with all that it contains
MAX_BITS = 4_096  # of an integer
_MAX_KEY = 2**31  # keys that are larger could all have one hash
_MAX_MESSAGE = 1_000  # characters
CHARACTERS, _BITS = 16, 256  # that count as one part
_SCALARS = (str, int, float)
PLAIN: tuple[Any, ...] = (*_SCALARS, type(None), range, list, tuple, dict)


class _ExpressionFailure(Exception):
    def __init__(self, message: str) -> None:
        super().__init__(message[:_MAX_MESSAGE])


class ExpressionFails(_ExpressionFailure):
    """Python certainly raises an error for this expression; the text is a sentence without its end."""


class Undetermined(_ExpressionFailure):
    """The value of an expression cannot be determined statically; the text says why."""


class OutOfBudget(Exception):
    """The budget of a submission is spent: nothing more of it can be expanded or evaluated."""


# No dataclasses: making each one takes 1 ms of the start of every command.


class Budget:
    """The parts of documents, expressions and values that may still be produced or looked at, whatever comes of it.

    They are charged before the work, and counted, so that a result is the same on every machine.
    """

    def __init__(self, limit: int = READING) -> None:
        self.limit = self.left = limit

    @property
    def used(self) -> int:
        """The parts that were charged."""
        return self.limit - self.left

    def charge(self, parts: int, characters: int = 0) -> None:
        """Charge parts and characters. Raises OutOfBudget."""
        self.left -= parts + characters // CHARACTERS
        if self.left < 0:
            raise OutOfBudget(f"reading this takes more work than one submission may use ({self.limit:,} parts)")

    def measure(self, value: Value) -> int:
        """Charge a value and return its size: its parts, each as often as it occurs. Raises Undetermined."""
        if isinstance(value, _SCALARS):
            size = 1 + _size_alone(value)
            self.charge(size)
            return size
        pending, size = [value], 0
        while pending:
            part = pending.pop()
            size += 1 + _size_alone(part)
            inside = _parts(part)
            if size + len(pending) + len(inside) > MAX_PARTS:
                too_large("value")
            self.charge(len(inside))
            pending += inside
        self.charge(size)
        return size

    def checked(self, value: Value) -> Value:
        """Return a value that was produced, once it is charged. Raises Undetermined for one that is too large."""
        if type(value) not in (float, bool):
            self.measure(value)
        return value


def _size_alone(part: Value) -> int:
    """Return the size of a text or number beyond one part. Raises Undetermined for one that is too large."""
    if isinstance(part, str):
        if len(part) > MAX_TEXT:
            too_large("text")
        return len(part) // CHARACTERS
    if isinstance(part, int):
        if part.bit_length() > MAX_BITS:
            too_large("number")
        return part.bit_length() // _BITS
    return 0


def _parts(part: Value) -> Collection[Value]:
    """Return what a value contains. Raises Undetermined for a type that is not supported."""
    match part:
        case list() | tuple() | range():
            return part
        case dict():
            return [*part.keys(), *part.values()]
        case Items():
            return part.values
        case str() | int() | float() | None | ClosedFunction() | Namespace():
            return ()
    raise Undetermined(f"values of the type {type(part).__name__} are not supported")


class ClosedFunction:
    """A function that an expression may call."""

    __slots__ = ("name", "run")

    def __init__(self, name: str, run: Callable[..., Value]) -> None:
        self.name, self.run = name, run


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
    """What is only there to be looped over, such as zip() and the items of a dict; an iterator has its items once."""

    __slots__ = ("is_iterator", "values")

    def __init__(self, values: list[Value], *, is_iterator: bool = True) -> None:
        self.values, self.is_iterator = values, is_iterator

    def __bool__(self) -> bool:
        raise Undetermined("whether an iterator is true is not supported")


class DottedDict(dict[Value, Value]):
    """A dict whose items are also attributes, as xacro makes them of YAML."""


def call_plain(function: Callable[..., Value], *args: Value, **kwargs: Value) -> Value:
    """Return what a function of plain values returns; what it raises is ExpressionFails."""
    try:
        return function(*args, **kwargs)
    except (ExpressionFails, Undetermined, OutOfBudget, RecursionError, MemoryError):
        raise
    except Exception as error:  # noqa: BLE001  whatever Python raises here, it raises for the student's expression
        if not _has_text([*args, *kwargs.values()]):
            raise Undetermined("this use of a function, a namespace or an iterator is not supported") from None
        raise ExpressionFails(f"{type(error).__name__}: {error}") from None


def items_of(value: Value) -> list[Value]:
    """Return what a loop over a value yields; the value is charged."""
    if isinstance(value, Items):
        items = value.values
        value.values = [] if value.is_iterator else items
        return items
    if isinstance(value, PLAIN):
        return list(call_plain(iter, value))
    raise Undetermined("this loop is not supported")


def checked_key(key: Value) -> Value:
    """Return a key of a dict: a text or a number whose hash no other one has. Raises Undetermined for other keys."""
    if not isinstance(key, str) and not (isinstance(key, int) and abs(key) < _MAX_KEY):
        raise Undetermined("a key of a dict that is neither a text nor a small whole number is not supported")
    return key


def str_of(value: Value) -> str:
    """Return str() of a value that is charged; raise Undetermined where it differs between runs, such as an address."""
    if not isinstance(value, _SCALARS) and not (isinstance(value, PLAIN) and _has_text(value)):
        raise Undetermined("the text of this value differs between runs")
    return str(value)


def joined(pieces: Iterable[str]) -> str:
    """Return one text of pieces; raise Undetermined as soon as it is too long."""
    kept: list[str] = []
    length = 0
    for piece in pieces:
        length += len(piece)
        if length > MAX_TEXT:
            too_large("text")
        kept.append(piece)
    return "".join(kept)


def _has_text(value: Value) -> bool:
    """Return whether the text of a value is the same in every run."""
    if isinstance(value, dict):
        value = (*value.keys(), *value.values())
    if isinstance(value, list | tuple):
        return all(map(_has_text, value))
    return not isinstance(value, ClosedFunction | Namespace | Items)


def too_large(what: str) -> NoReturn:
    """Raise Undetermined for a value that grows too large."""
    raise Undetermined(f"a {what} grows too large")
