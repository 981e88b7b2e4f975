"""Where a name is defined, and where it is used."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from lsprotocol import types as lsp

from grader.app.editor.look import Look
from grader.app.editor.names_at import NamePlace, name_at, places_of
from grader.app.editor.text_ranges import Lines, TextRanges
from grader.ros.workspace.names import Definition, Use


class TextPlace(NamedTuple):
    """A place in a file that an editor asks about; line and column count from 1, columns in
    characters.
    """

    root: Path  # of the files
    path: str
    lines: Lines
    line: int
    column: int

    def name(self, look: Look) -> NamePlace | None:
        """Return the name there."""
        return name_at(look, self.path, self.line, self.column)

    def ranges(self, look: Look) -> TextRanges:
        """Return the ranges in the files of a look."""
        return TextRanges(look, self.root)


def definitions(look: Look, place: TextPlace) -> list[lsp.Location]:
    """Return where the name at a place is defined."""
    return [*_located(look, place, (Definition,))]


def references(look: Look, place: TextPlace) -> list[lsp.Location]:
    """Return where the name at a place is defined and used."""
    return [*_located(look, place, (Definition, Use))]


def _located(look: Look, place: TextPlace, kinds: tuple[type, ...]) -> Iterator[lsp.Location]:
    found = place.name(look)
    if found is None:
        return
    ranges = place.ranges(look)
    facts = [fact for fact in look.names.same(found.fact) if isinstance(fact, kinds)]
    seen: Sequence[lsp.Location] = []
    for other in places_of(look, facts):
        at = ranges.place(other.written or other.whole)
        if at not in seen:
            seen = [*seen, at]
            yield at
