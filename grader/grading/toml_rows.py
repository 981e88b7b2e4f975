"""Read the tables of a rubric: values are converted, and every mistake is collected with the path of its key."""

import re
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

from grader.checks.toml_types import TomlType, WrongValue, simple_type
from grader.grading.toml_file import TomlPath
from grader.names import did_you_mean
from grader.text import cut

_MAX_GUESSES = 50  # searches for a similar name in one rubric: each takes its time
_MAX_SHOWN = 40  # characters of a value
_MAX_BITS = 1000  # of a whole number that is written out
_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")

TomlRow = dict[str, Any]
_NOTHING: Mapping[str, Any] = {}


class KeyTable(NamedTuple):
    """A table of the rubric: what one is called, and its keys."""

    name: str
    keys: Mapping[str, TomlType]
    required: tuple[str, ...] = ()

    @property
    def schema(self) -> dict[str, Any]:
        """The JSON Schema of the table."""
        return {
            "type": "object",
            "properties": {key: dict(value.schema) for key, value in self.keys.items()},
            "required": list(self.required),
            "additionalProperties": False,
        }

    @property
    def rows(self) -> TomlType:
        """The type of several such tables."""
        schema = {"type": "array", "items": self.schema, "minItems": 1}
        return simple_type(f"one or more [[{self.name}]] tables", schema, _are_tables)

    @property
    def one_or_more(self) -> TomlType:
        """The type of one such table, or several."""
        schema = {**self.schema, **self.rows.schema, "type": ["object", "array"]}
        return simple_type("a table, or several", schema, lambda value: isinstance(value, dict) or _are_tables(value))


def _are_tables(value: Any) -> bool:
    return isinstance(value, list) and value != [] and all(isinstance(item, dict) for item in value)


class TomlRowReader:
    """Reads tables; `complaints` are the mistakes so far."""

    def __init__(self) -> None:
        self.complaints: list[tuple[TomlPath, str]] = []
        self._guesses = _MAX_GUESSES

    def row(self, where: TomlPath, row: TomlRow, table: KeyTable, defaults: Mapping[str, Any] = _NOTHING) -> TomlRow:
        """Return the valid values of a table, converted; complain of the others and of missing ones."""
        parsed: TomlRow = {**defaults}
        for key, value in row.items():
            if key not in table.keys:
                hint = self.guess(key, table.keys) or f"; it has: {', '.join(table.keys)}"
                self.complain((*where, key), f"a {table.name} has no key {key!r}{hint}")
                continue
            try:
                parsed[key] = table.keys[key].parse(value)
            except WrongValue as error:
                self.complain((*where, key), f"{key} must be {error}, not {shorten_value(value)}")
        for key in table.required:
            if key not in row and key not in defaults:
                self.complain(where, f"this {table.name} has no {key}")
        return parsed

    def guess(self, name: str, known: Iterable[str]) -> str:
        """Return which known name a misspelt one may mean, as a clause; empty if none is similar."""
        self._guesses -= 1
        return did_you_mean(name, known) if self._guesses >= 0 else ""

    def complain(self, where: TomlPath, message: str) -> None:
        """Add a mistake in the value of a key."""
        self.complaints.append((where, message))


def shorten_value(value: Any) -> str:
    """Return a value of TOML in a few characters."""
    return cut(toml_literal(value), _MAX_SHOWN)


def toml_literal(value: Any) -> str:
    """Return a value as TOML, in one line."""
    match value:
        case bool():
            text = str(value).lower()
        case float():
            text = repr(value)
            text = f"{value:.15f}".rstrip("0") if "e" in text and 1e-15 < abs(value) < 1 else text
        case str():
            import json  # late: for a rubric with a mistake, or a new one

            text = json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
        case Mapping():
            text = f"{{ {', '.join(assignment(key, item) for key, item in value.items())} }}" if value else "{}"
        case list() | tuple():
            text = f"[{', '.join(map(toml_literal, value))}]"
        case int() if value.bit_length() > _MAX_BITS:  # Python refuses to write numbers of thousands of digits
            text = "a number with too many digits"
        case _:
            text = str(value)
    return text


def assignment(key: str, value: Any) -> str:
    """Return a line that sets a key."""
    return f"{key if _BARE_KEY.fullmatch(key) else toml_literal(key)} = {toml_literal(value)}"
