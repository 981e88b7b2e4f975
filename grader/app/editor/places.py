"""Where a name is defined, and where it is used."""

from collections.abc import Callable, Collection
from pathlib import Path
from typing import NamedTuple, TypeVar

from lsprotocol import types as lsp

from grader.app.editor.look import Look
from grader.app.editor.text_ranges import Lines, TextRanges
from grader.files.tree import overlaid

_MAX_ERRORS = 3
_T = TypeVar("_T")


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

    def ranges(self, look: Look) -> TextRanges:
        """Return the ranges in the files of a look."""
        return TextRanges(look, self.root)


def without_lines(look: Look, place: TextPlace, numbers: Collection[int]) -> Look:
    """Return a look at the files where some lines of the file of a place are empty."""
    lines = place.lines.text.split("\n")
    for number in numbers:
        lines[number - 1] = ""
    data = "\n".join(lines).encode("utf-8", "surrogatepass")
    return look.again(overlaid(look.tree, {place.path: data}))


def also_where_broken(answer: Callable[[Look, TextPlace], _T]) -> Callable[[Look, TextPlace], _T]:
    """Return what answers also where an error in another line keeps the file from being read."""

    def answer_anyway(look: Look, place: TextPlace) -> _T:
        given = answer(look, place)
        errors = {
            finding.location.line
            for finding in look.findings
            if finding.severity == "error" and finding.location.path == place.path
        } - {place.line}
        if given or not errors or len(errors) > _MAX_ERRORS:
            return given
        return answer(without_lines(look, place, errors), place)

    return answer_anyway


def definitions(look: Look, place: TextPlace) -> list[lsp.Location]:
    """Return where the name at a place is defined."""
    return _located(look, place, are_defined=True)


def references(look: Look, place: TextPlace) -> list[lsp.Location]:
    """Return where the name at a place is defined and used."""
    return _located(look, place, are_defined=False)


def highlights(look: Look, place: TextPlace) -> list[lsp.DocumentHighlight]:
    """Return where the name at a place is written in its file."""
    name = look.names.at(*place.triple)
    ranges = place.ranges(look)
    marked: dict[tuple[int, int], lsp.DocumentHighlight] = {}
    for other in look.names.same(name) if name is not None else ():
        if other.location.path == place.path:
            is_defined = other.role == "definition"
            kind = lsp.DocumentHighlightKind.Write if is_defined else lsp.DocumentHighlightKind.Read
            at = ranges.range(other.location)
            marked.setdefault((at.start.line, at.start.character), lsp.DocumentHighlight(at, kind))
    return [mark for _, mark in sorted(marked.items())]


def _located(look: Look, place: TextPlace, *, are_defined: bool) -> list[lsp.Location]:
    name = look.names.at(*place.triple)
    ranges = place.ranges(look)
    located: list[lsp.Location] = []
    for other in look.names.same(name) if name is not None else ():
        at = ranges.place(other.location)
        if (other.role == "definition" or not are_defined) and at not in located:
            located.append(at)
    return located
