"""Problems and locations as JSON, in a report and in an inspection."""

from collections.abc import Iterable

from grader.base.extents import ended
from grader.base.problems import Problem
from grader.base.source import SourceOf
from grader.report.json_data import COUNT, PLACE, TEXT, JsonObject, Many, each, nullable

# The end is the place after the last character; where it is not known, that of the start.
_EXTENT = {**PLACE, **each(COUNT, "end_line end_column")}
_CALL = JsonObject(
    {
        "macro": (TEXT, lambda call: call[0]),
        "location": (JsonObject(_EXTENT), lambda call: call[1]),
    }
)
LOCATION = JsonObject({**_EXTENT, "calls": Many(_CALL)}, ("calls",))
PROBLEM = JsonObject(
    {
        "code": {"type": "string", "pattern": "^[A-Z]+[0-9]{3}$"},
        "rule": (nullable(TEXT), lambda problem: problem.rule or None),
        "severity": {"enum": ["error", "warning", "note"]},
        "message": TEXT,
        "location": LOCATION,
    }
)


def problems_with_ends(problems: Iterable[Problem], source_of: SourceOf) -> tuple[Problem, ...]:
    """Return problems whose locations have their ends."""
    with_ends = []
    for problem in problems:
        with_ends.append(problem._replace(location=ended(problem.location, source_of)))
    return tuple(with_ends)
