"""Parse and validate a rubric of a course once for all commands that the tests run in one process."""

import sys
from collections.abc import Callable
from pathlib import Path

from grader.lab.rubric import rubric, validation

_LONG = range(5_000, 100_000)  # bytes: what takes long, and is the same in many tests
_read: Callable[[bytes, Path], validation.Validation] = vars(rubric)["_validate"].__wrapped__
_VALIDATED: dict[tuple[object, ...], validation.Validation] = {}


def validated_once(data: bytes, path: Path) -> validation.Validation:
    """Return the valid content of a rubric; raise RubricError."""
    if len(data) not in _LONG:
        return _read(data, path)
    key = (
        data,
        vars(validation)["find_check"],
        *sys.path,
    )  # plug-ins that a test installs, and checks that it replaces
    if key not in _VALIDATED:
        _VALIDATED[key] = _read(data, path)
    return _VALIDATED[key]
