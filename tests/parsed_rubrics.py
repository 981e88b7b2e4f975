"""Parse and validate a rubric of a course once for all commands that the tests run in one process."""

import sys
from pathlib import Path
from typing import Any, NamedTuple

from grader.grading import validation
from grader.grading.toml_file import read_toml

_LONG = range(5_000, 100_000)  # bytes: what takes long, and is the same in many tests


class _Parsed(NamedTuple):
    text: str
    table: dict[str, Any]
    validation: validation.Validation


_PARSED: dict[tuple[object, ...], _Parsed] = {}  # never emptied, so that a table's identity stays its own


def read_toml_once(data: bytes, path: Path) -> tuple[str, dict[str, Any]]:
    """Return the text and the table of a TOML file, as `read_toml` does."""
    if len(data) not in _LONG:
        return read_toml(data, path)
    key = data, vars(validation)["find_check"], *sys.path  # plug-ins that a test installs, and checks that it replaces
    if key not in _PARSED:
        text, table = read_toml(data, path)
        _PARSED[key] = _Parsed(text, table, validation.Validation(table))
    return _PARSED[key][:2]


def validate_once(table: dict[str, Any]) -> validation.Validation:
    """Return the validation of a table."""
    known = (parsed.validation for parsed in _PARSED.values() if parsed.table is table)
    return next(known, None) or validation.Validation(table)
