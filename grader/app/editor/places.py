"""Where a name is defined, and where it is used."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple, TypeVar

from lsprotocol.types import DocumentHighlight, DocumentHighlightKind, DocumentLink, Location

from grader.app.editor.look import Look
from grader.app.editor.text_ranges import Lines, TextRanges

_T = TypeVar("_T")
_Locations = list[Location]


class TextPlace(NamedTuple):
    """A place in a file that an editor asks about.

    Line and column count from 1, columns in characters.
    """

    root: Path  # of the files
    path: str
    lines: Lines
    line: int
    column: int

    @property
    def triple(self) -> tuple[str, int, int]:
        """The file, the line and the column."""
        return self.path, self.line, self.column

    @property
    def text_line(self) -> str:
        """The text of the line."""
        return self.lines.text.split("\n")[self.line - 1]

    def ranges(self, look: Look) -> TextRanges:
        """Return the ranges in the files of a look."""
        return TextRanges(look, self.root)


def readings(look: Look, place: TextPlace, *, keeps_line: bool) -> Iterator[Look]:
    """Yield looks at the files, the first one as they are.

    Where the file of a place has errors, the last look in which it had none follows.

    Args:
        look: What was read of the files as they are.
        place: The file, and the line that is typed.
        keeps_line: Whether the line of the place itself has to be the same there.
    """
    yield look
    clean = look.find_clean(place.path)
    if not clean or clean is look:
        return
    source = clean.opened.source(place.path)
    line = place.text_line
    if not keeps_line or (source and source.line(place.line) == line):
        yield clean


def also_where_broken(answer: Callable[[Look, TextPlace], _T]) -> Callable[[Look, TextPlace], _T]:
    """Return what answers also where an error in another line keeps the file from being read."""

    def answer_anyway(look: Look, place: TextPlace) -> _T:
        answers = (answer(reading, place) for reading in readings(look, place, keeps_line=True))
        first = next(answers)
        return first or next((given for given in answers if given), first)

    return answer_anyway


def definitions(look: Look, place: TextPlace) -> _Locations:
    """Return where the name at a place is defined."""
    return _located(look, place, are_defined=True)


def references(look: Look, place: TextPlace) -> _Locations:
    """Return where the name at a place is defined and used."""
    return _located(look, place, are_defined=False)


def highlights(look: Look, place: TextPlace) -> list[DocumentHighlight]:
    """Return where the name at a place is written in its file."""
    name = look.names.at(*place.triple)
    ranges = place.ranges(look)
    marked: dict[tuple[int, int], DocumentHighlight] = {}
    for other in look.names.same(name) if name else ():
        if other.location.path == place.path:
            is_defined = other.role == "definition"
            kind = DocumentHighlightKind.Write if is_defined else DocumentHighlightKind.Read
            at = ranges.range(other.location)
            marked.setdefault((at.start.line, at.start.character), DocumentHighlight(at, kind))
    return [mark for _, mark in sorted(marked.items())]


def links(look: Look, place: TextPlace) -> list[DocumentLink]:
    """Return the files of packages that a file names, each where it names it."""
    ranges = place.ranges(look)
    return [
        DocumentLink(ranges.range(name.location), ranges.uri(name.name))
        for name in look.names.files_named_in(place.path)
    ]


def _located(look: Look, place: TextPlace, *, are_defined: bool) -> _Locations:
    name = look.names.at(*place.triple)
    ranges = place.ranges(look)
    located = []
    for other in look.names.same(name) if name else ():
        at = ranges.place(other.location)
        if (other.role == "definition" or not are_defined) and at not in located:
            located.append(at)
    return located
