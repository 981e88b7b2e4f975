"""Where things stand in the text of a file: line and column of a tag or of one of its attributes."""

import re
from bisect import bisect_right
from dataclasses import dataclass
from itertools import accumulate
from typing import NamedTuple

# In text that an XML parser has accepted, `<` and a name outside comments and CDATA opens a tag.
_START_TAG = re.compile(r"<!--.*?-->|<!\[CDATA\[.*?\]\]>|<(?![/!?])", re.DOTALL)
_TAG_NAME = re.compile(r"<\s*[^\s=/>]*")
_ATTRIBUTE = re.compile(r"""\s*([^\s=/>"']+)\s*=\s*(?:"[^"]*"|'[^']*')""")


@dataclass(frozen=True, slots=True)
class Location:
    """A place in a file of the submission; line and column count from 1, columns in characters."""

    path: str
    line: int
    column: int


class Source:
    """The text of one file. Places are worked out when they are asked for: most never are."""

    __slots__ = ("_lines", "_tags", "path", "text")

    def __init__(self, path: str, text: str, tags: list[int] | None = None) -> None:
        """`tags` holds the offset of each start tag in document order; without it the text must be well-formed XML."""
        self.path = path
        self.text = text
        self._tags = tags
        self._lines: list[int] | None = None

    def at(self, offset: int) -> Location:
        """The place of a character offset."""
        if self._lines is None:
            lengths = (len(line) for line in self.text.split("\n"))
            self._lines = list(accumulate((length + 1 for length in lengths), initial=0))
        line = bisect_right(self._lines, offset)
        start = self._lines[line - 1]
        if line == 1 and offset > 0 and self.text.startswith("\ufeff"):
            start = 1  # editors do not show a byte-order mark
        return Location(self.path, line, offset - start + 1)

    def tag(self, index: int, attribute: str | None = None) -> Location:
        """The place of the start tag with this index in document order, or of an attribute in it if it is there."""
        if self._tags is None:
            self._tags = [match.start() for match in _START_TAG.finditer(self.text) if len(match[0]) == 1]
        start = self._tags[index]
        return self.at(start if attribute is None else self._attribute(start, attribute))

    def below(self, index: int, name: str) -> int:
        """The index of the first start tag of this name behind another one; that one where there is none."""
        self.tag(index)
        opening = re.compile(rf"<\s*{re.escape(name)}(?![^\s=/>])")
        tags = self._tags or []
        return next((each for each in range(index + 1, len(tags)) if opening.match(self.text, tags[each])), index)

    def line(self, number: int) -> str:
        """The text of a line, counted from 1, without its end."""
        lines = self.text.split("\n", number)
        return lines[number - 1].rstrip("\r").removeprefix("\ufeff") if 0 < number <= len(lines) else ""

    def _attribute(self, start: int, name: str) -> int:
        name_end = _TAG_NAME.match(self.text, start)
        position = name_end.end() if name_end else start
        while found := _ATTRIBUTE.match(self.text, position):
            if found[1] == name:
                return found.start(1)
            position = found.end()
        return start


class Mark(NamedTuple):
    """An element's place in a source, worked out on demand; `tag` counts its start tag in document order, from 0."""

    source: Source
    tag: int

    def below(self, name: str) -> "Mark":
        """The first element of this name that follows: one that is known to be inside."""
        return Mark(self.source, self.source.below(self.tag, name))

    def location(self, attribute: str | None = None) -> Location:
        """The place of the tag, or of one of its attributes."""
        return self.source.tag(self.tag, attribute)


class Spot(NamedTuple):
    """An element or one of its attributes, whose place is worked out on demand."""

    mark: Mark
    attribute: str | None = None
    inside: str | None = None  # the name of an element in it that is meant instead

    def location(self) -> Location:
        """The place of the attribute if it is there, else of the tag."""
        mark = self.mark if self.inside is None else self.mark.below(self.inside)
        return mark.location(self.attribute)
