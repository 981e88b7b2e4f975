"""Properties of abstract values: size, items, truth and text. Limits keep the evaluation of any file short."""

from pathlib import PurePosixPath

from grader.static_python.values import Function, Unknown, Value

MAX_ITEMS = 20_000  # of a list or dict
MAX_TEXT = 100_000  # characters
MAX_PATH = 4_096  # characters
PACKAGE_FOLDER = "<package>"  # stands for the name of the package's folder, which the submission does not determine


def size(value: Value) -> int:
    """Return about how many parts a value has: how many steps an operation with it costs."""
    pending, count = [value], 0
    while pending and count < MAX_ITEMS:
        item = pending.pop()
        if isinstance(item, list | tuple | dict):
            count += len(item)
            if len(item) < MAX_ITEMS:
                pending += item.values() if isinstance(item, dict) else item
        elif isinstance(item, str):
            count += len(item) // 32
    return count


def items_of(value: Value) -> list[Value] | None:
    """Return what a loop over a value yields; None where this is unknown."""
    if isinstance(value, list | tuple | dict) or (isinstance(value, str) and len(value) < MAX_ITEMS):
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
    """Return the values of a set, without duplicates. Their order is not that of the set, which differs between runs."""
    plain = all(isinstance(value, str | int | float | PurePosixPath | None) for value in values)
    return list(dict.fromkeys(values)) if plain else values


def names_package_folder(path: str) -> bool:
    """Return whether a text contains the stand-in for the name of the package's folder, other than as the root of a path."""
    return PACKAGE_FOLDER in path.removeprefix(f"/{PACKAGE_FOLDER}")


def path_text(value: Value) -> str | None:
    """Return the text of a path or string; None for other values."""
    return str(value) if isinstance(value, str | PurePosixPath) else None
