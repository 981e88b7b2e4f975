"""Findings as annotations of files: GitHub's workflow commands."""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from grader.base.extents import ended
from grader.base.grouping import StringsByName
from grader.base.problems import Severity
from grader.base.source import Base, Location, SourceOf
from grader.base.text import printable, without_tag_commands
from grader.report.locations import archive_around, location_text

_MAX_ANNOTATIONS = 10  # of each type
_MAX_MESSAGE = 4000  # characters
_COMMANDS = {"error": "error", "warning": "warning", "note": "notice"}


class Annotation(NamedTuple):
    """One thing to fix."""

    # what a mistake costs and its criteria, the id of a criterion, or the code of a problem
    title: str
    level: Severity
    text: str  # printable, of several lines
    place: Mapping[str, str] = {}  # without any the whole submission is meant


def limited_annotations(annotations: Sequence[Annotation], notices: int) -> Iterator[str]:
    """Yield at most as many annotations of each type as GitHub shows, besides some notices."""
    for level, name in _COMMANDS.items():
        some = [finding for finding in annotations if finding.level == level]
        room = _MAX_ANNOTATIONS - notices * (level == "note")
        listed = some if len(some) <= room else [*some[: room - 1], _rest_finding(some[room - 1 :])]
        yield from (command(name, one.place, one.title, one.text) for one in listed)


def annotation_place(where: Location | None, source_of: SourceOf, base: Base) -> StringsByName:
    """Return the properties of an annotation at a location.

    The location is as seen from the root of the repository; without one, they are empty.
    """
    if not where or base.is_outside:  # a file of the repository may have the same path
        return {}
    if archive := base.archive or archive_around(where.path):
        return {"file": printable(archive if base.archive else base.folder + archive)}
    where = ended(where, source_of)
    file = printable(base.folder + where.path)
    end_line = str(where.end_line)
    place = {"file": file, "line": str(where.line), "endLine": end_line}
    if where.end_line == where.line:  # GitHub takes the columns of a single line only
        place["col"] = str(where.column)
        place["endColumn"] = str(max(where.column, where.end_column - 1))
    return place


def annotation_text(lines: list[str], where: Location | None, base: Base) -> str:
    """Return the lines, and the location where lines cannot show it.

    That is in a macro, or not in a file of the repository.
    """
    if where and (base.archive or base.is_outside or archive_around(where.path) or where.calls):
        lines = [*lines, f"In {location_text(where)}."]
    return "\n".join(lines)


def _rest_finding(annotations: Sequence[Annotation]) -> Annotation:
    text = "\n".join(
        ("See the report for:", *dict.fromkeys(finding.title for finding in annotations))
    )
    return annotations[0]._replace(title=f"{len(annotations)} more", text=text, place={})


def command(name: str, place: StringsByName, title: str, text: str) -> str:
    """Return one annotation of printable text, with a line break at its end.

    It is an `error`, `warning` or `notice`.
    """
    properties = [*place.items(), ("title", title)]
    listed = ",".join(
        f"{key}={_data(value).replace(':', '%3A').replace(',', '%2C')}" for key, value in properties
    )
    message = text if len(text) <= _MAX_MESSAGE else f"{text[:_MAX_MESSAGE]}..."
    return without_tag_commands(f"::{name} {listed}::{_data(message)}\n")


def _data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")
