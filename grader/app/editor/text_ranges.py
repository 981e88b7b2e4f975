"""Ranges of text as editors count them: lines from 0, columns in units of UTF-16 from 0."""

from collections.abc import Iterable
from pathlib import Path

from lsprotocol import types as lsp
from pygls.uris import from_fs_path

from grader.app.editor.look import Look
from grader.base.extents import ended
from grader.base.source import Edit, Location, Source


class Lines:
    """The lines of a text, with places in them converted in both ways."""

    def __init__(self, source: Source) -> None:
        self._source = source

    @property
    def text(self) -> str:
        """The whole text."""
        return self._source.text

    def position(self, line: int, column: int) -> lsp.Position:
        """Return the position of a line and column, which count from 1, columns in characters."""
        text = self._source.line(line)
        before = text[: max(column, 1) - 1]
        return lsp.Position(max(line, 1) - 1, _units(before))

    def make_position(self, offset: int) -> lsp.Position:
        """Return the position of a character offset."""
        place = self._source.at(offset)
        return self.position(place.line, place.column)

    def place(self, position: lsp.Position) -> tuple[int, int]:
        """Return the line and column, from 1 and in characters, of a position."""
        line = position.line + 1
        data = self._source.line(line).encode("utf-16-le", "surrogatepass")
        before = data[: 2 * position.character].decode("utf-16-le", "replace")
        return line, len(before) + 1

    def range(self, location: Location) -> lsp.Range:
        """Return the range of a location with its end; without one that of the rest of its line."""
        start = self.position(location.line, location.column)
        end = self.position(location.end_line, location.end_column)
        if (end.line, end.character) <= (start.line, start.character):
            text = self._source.line(location.line).rstrip()
            end = lsp.Position(start.line, max(start.character, _units(text)))
        return lsp.Range(start, end)

    def offset(self, line: int, column: int) -> int:
        """Return the character offset of a line and column."""
        return self._source.offset(line, column)


class TextRanges:
    """Ranges in the files of a look."""

    def __init__(self, look: Look, root: Path) -> None:
        self._look = look
        self._root = root
        self._lines: dict[str, Lines] = {}

    def lines(self, path: str) -> Lines:
        """Return the lines of a file."""
        if path not in self._lines:
            self._lines[path] = Lines(self._look.opened.source(path) or Source(path, ""))
        return self._lines[path]

    def range(self, location: Location) -> lsp.Range:
        """Return the range of what is at a location."""
        whole = location
        if not whole.end_line:
            whole = ended(location, self._look.opened.source)
        return self.lines(location.path).range(whole)

    def uri(self, path: str) -> str:
        """Return the address of a file."""
        return from_fs_path(str(self._root / path)) or ""

    def place(self, location: Location) -> lsp.Location:
        """Return a location as editors write it."""
        return lsp.Location(self.uri(location.path), self.range(location))

    def workspace_edit(self, edits: Iterable[Edit]) -> lsp.WorkspaceEdit:
        """Return edits as editors write them."""
        changes: dict[str, list[lsp.TextEdit]] = {}
        for edit in edits:
            lines = self.lines(edit.path)
            start = lines.offset(edit.line, edit.column)
            end = lines.make_position(start + len(edit.old))
            extent = lsp.Range(lines.make_position(start), end)
            changes.setdefault(self.uri(edit.path), []).append(lsp.TextEdit(extent, edit.new))
        return lsp.WorkspaceEdit(changes=dict(changes))


def _units(text: str) -> int:
    """Return the length of a text in units of UTF-16."""
    return len(text.encode("utf-16-le", "surrogatepass")) // 2
