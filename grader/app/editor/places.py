"""Where a name is defined, and where it is used."""

from collections.abc import Callable, Collection, Iterator
from pathlib import Path
from typing import NamedTuple, TypeVar

from lsprotocol import types as lsp

from grader.app.editor.look import Look
from grader.app.editor.text_ranges import Lines, TextRanges
from grader.base.errors import InputError
from grader.base.source import Source
from grader.files.reading import read_capped
from grader.files.tree import overlaid

_MAX_ERRORS = 3
_MAX_SAVED = 1024 * 1024  # bytes of a file
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


def _without_lines(look: Look, place: TextPlace, numbers: Collection[int]) -> Look:
    """Return a look at the files where some lines of the file of a place are empty."""
    lines = place.lines.text.split("\n")
    for number in numbers:
        lines[number - 1] = ""
    data = "\n".join(lines).encode("utf-8", "surrogatepass")
    return look.again(overlaid(look.tree, {place.path: data}))


def _lines_with_errors(look: Look, path: str) -> set[int]:
    """Return the lines of a file with errors."""
    errors = [finding.location for finding in look.findings if finding.severity == "error"]
    return {location.line for location in errors if location.path == path}


def readings(look: Look, place: TextPlace, *, keeps_line: bool) -> Iterator[Look]:
    """Yield looks at the files, the first one as they are.

    Where the file of a place has errors, others follow in which it may be read: without the lines
    with errors, and as it was saved.

    Args:
        look: What was read of the files as they are.
        place: The file, and the line that is typed.
        keeps_line: Whether the line of the place itself has to stay as it is.
    """
    yield look
    errors = _lines_with_errors(look, place.path)
    if not errors:
        return
    others = errors - {place.line}
    if not keeps_line:
        yield _without_lines(look, place, [place.line])
    if others and len(others) <= _MAX_ERRORS:
        yield _without_lines(look, place, others if keeps_line else {place.line, *others})
    saved = _saved(place)
    line = place.lines.text.split("\n")[place.line - 1]
    if saved is not None and (not keeps_line or saved.line(place.line) == line):
        data = saved.text.encode("utf-8", "surrogatepass")
        yield look.again(overlaid(look.tree, {place.path: data}))


def _saved(place: TextPlace) -> Source | None:
    """Return the text of the file of a place as it was saved; None where it is the typed one."""
    try:
        data = read_capped(place.root / place.path, _MAX_SAVED)
    except InputError:
        return None
    text = data.decode("utf-8", "replace")
    return Source(place.path, text) if text != place.lines.text else None


def also_where_broken(answer: Callable[[Look, TextPlace], _T]) -> Callable[[Look, TextPlace], _T]:
    """Return what answers also where an error in another line keeps the file from being read."""

    def answer_anyway(look: Look, place: TextPlace) -> _T:
        answers = (answer(reading, place) for reading in readings(look, place, keeps_line=True))
        first = next(answers)
        return first or next((given for given in answers if given), first)

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


def links(look: Look, place: TextPlace) -> list[lsp.DocumentLink]:
    """Return the files of packages that a file names, each where it names it."""
    ranges = place.ranges(look)
    return [
        lsp.DocumentLink(ranges.range(name.location), ranges.uri(name.name))
        for name in look.names.files_named_in(place.path)
    ]


def _located(look: Look, place: TextPlace, *, are_defined: bool) -> list[lsp.Location]:
    name = look.names.at(*place.triple)
    ranges = place.ranges(look)
    located: list[lsp.Location] = []
    for other in look.names.same(name) if name is not None else ():
        at = ranges.place(other.location)
        if (other.role == "definition" or not are_defined) and at not in located:
            located.append(at)
    return located
