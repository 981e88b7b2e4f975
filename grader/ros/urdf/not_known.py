"""Parts of a robot of which a value is missing or cannot be read: the rest is as it is written.

ROS 2 drops such an element. Reading the value raises MissingElement, whose name is its place: the
first criterion that needs it fails, and later ones are not deducted for it.
"""

from collections.abc import Mapping
from functools import partial
from typing import Any, TypeVar

from grader.base.errors import MissingElement
from grader.base.source import Location

_Part = TypeVar("_Part", bound=tuple[Any, ...])


def missing_value(reason: str, at: Location) -> MissingElement:
    """Return why a value is not known, which is the same for all that need it."""
    name = f"{at.path}:{at.line}:{at.column}"
    return MissingElement("value", name, message=reason, location=at, costs_once=True)


def with_unknown(part: _Part, unknown: Mapping[str, MissingElement]) -> _Part:
    """Return a view of a part of which some fields are not known; a copy of it is the part."""
    if not unknown:
        return part
    kind = type(part)
    members: dict[str, Any] = {"__reduce__": lambda view: (kind, tuple(view))}
    for name, error in unknown.items():
        members[name] = property(partial(_raise_error, error))
    if hasattr(kind, "is_empty"):
        members["is_empty"] = False
    view: _Part = tuple.__new__(type(kind.__name__, (kind,), members), part)
    return view


def _raise_error(error: MissingElement, _: object) -> Any:
    raise error.with_traceback(None)
