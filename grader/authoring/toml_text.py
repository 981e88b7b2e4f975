"""TOML as a person would write it: short numbers, one table in a line, a long one in lines of its own."""

import json
import re
from collections.abc import Iterator, Mapping
from typing import Any

WIDTH = 120  # columns
_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")


def assignment(key: str, value: Any) -> str:
    """Return a line that sets a key."""
    return f"{_key(key)} = {literal(value)}"


def table(path: str, values: Mapping[str, Any]) -> Iterator[str]:
    """Yield the lines of a table of a criterion: in one line, or else under a heading, with its own tables after it."""
    key = path.rpartition(".")[2]
    line = assignment(key, values)
    if len(line) <= WIDTH:
        yield line
        return
    yield from ("", f"[{path}]")
    inner = {name: value for name, value in values.items() if isinstance(value, Mapping)}
    for name, value in values.items():
        if name not in inner:
            yield from wrapped(name, value)
    for name, value in inner.items():
        yield from ("", f"[{path}.{_key(name)}]")
        for deeper, item in value.items():
            yield from wrapped(deeper, item)


def literal(value: Any) -> str:
    """Return a value as TOML, in one line."""
    match value:
        case bool():
            return str(value).lower()
        case float():
            return _number(value)
        case int():
            return str(value)
        case str():
            return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
        case Mapping():
            return f"{{ {', '.join(assignment(key, item) for key, item in value.items())} }}"
    return f"[{', '.join(map(literal, value))}]"


def wrapped(key: str, value: Any) -> Iterator[str]:
    """Yield a line that sets a key, or, of a list that is too long for one, a line for each item."""
    line = assignment(key, value)
    if len(line) <= WIDTH or not isinstance(value, list):
        yield line
        return
    yield f"{_key(key)} = ["
    yield from (f"    {literal(item)}," for item in value)
    yield "]"


def _number(value: float) -> str:
    text = repr(value)
    return text if "e" not in text else f"{value:.15f}".rstrip("0") if 1e-15 < abs(value) < 1 else text


def _key(key: str) -> str:
    return key if _BARE_KEY.fullmatch(key) else literal(key)
