"""The name at a place of a text: what it means, and where else it is written."""

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from grader.app.editor.look import Look, fact_key
from grader.base.extents import ended
from grader.base.source import Location, Source
from grader.ros.workspace.names import Definition, Use

_NAME = r"(?<![\w.-]){}(?![\w-]|\.\w)"


class NamePlace(NamedTuple):
    """A place at which a file writes a name."""

    fact: Definition | Use
    whole: Location  # of the value, attribute or tag around it
    written: Location | None  # of the name in it; None where it is made of parts


def name_at(look: Look, path: str, line: int, column: int) -> NamePlace | None:
    """Return the name at a place of a file, the shortest of several; None where there is none.

    Line and column count from 1, columns in characters.
    """
    found: list[NamePlace] = []
    for place in places_of(look, look.names.in_file(path)):
        if _holds(place.written or place.whole, line, column):
            found.append(place)
    return min(found, key=_length, default=None)


def places_of(look: Look, facts: Sequence[Definition | Use]) -> Iterator[NamePlace]:
    """Yield where files write names, each place once."""
    seen: set[tuple[object, ...]] = set()
    for fact in facts:
        whole = ended(fact.location, look.opened.source)
        source = look.opened.source(whole.path)
        written = _written(source, whole, fact.name) if source is not None else None
        key = (*fact_key(fact), (written or whole)[:3])
        if key not in seen:
            seen.add(key)
            yield NamePlace(fact, whole, written)


def _written(source: Source, whole: Location, name: str) -> Location | None:
    """Return where a text writes a name: at a place, or else once in the element that begins
    there.
    """
    start = source.offset(whole.line, whole.column)
    end = source.offset(whole.end_line, whole.end_column)
    pattern = re.compile(_NAME.format(re.escape(name)))
    found = [*pattern.finditer(source.text, start, end)]
    if not found:
        return None
    at, after = source.at(found[-1].start()), source.at(found[-1].end())
    return at._replace(end_line=after.line, end_column=after.column)


def _holds(place: Location, line: int, column: int) -> bool:
    start, end = (place.line, place.column), (place.end_line, place.end_column)
    return start <= (line, column) <= end


def _length(place: NamePlace) -> tuple[int, int]:
    at = place.written or place.whole
    return at.end_line - at.line, at.end_column - at.column
