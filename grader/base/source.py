"""Locations in the text of a file, line and column of a tag or of one of its attributes."""

import re
from bisect import bisect_right
from collections.abc import Callable
from functools import cached_property
from itertools import accumulate
from typing import Literal, NamedTuple

from grader.base.records import Named

_BYTES_OF_SHORT_FILE = 4096
# In text that an XML parser has accepted, `<` and a name outside comments and CDATA opens a tag.
_START_TAG = r"(?s)<!--.*?(?:-->|\Z)|<!\[CDATA\[.*?(?:\]\]>|\Z)|<(?![/!?])"


class Location(NamedTuple):
    """A location in a file of the submission; line and column count from 1, columns in characters.

    A character is a code point: neither a byte, as Python counts the columns of its syntax, nor a
    unit of UTF-16, as editors do. `calls` are the macro calls of xacro that led to it, outermost
    first: the name of each macro, and where it is called. The end is the place after the last
    character of the name, value or tag that is meant; it is 0 until `extents.ended` is asked for
    it, because most places are never shown.
    """

    path: str
    line: int
    column: int
    calls: "tuple[tuple[str, Location], ...]" = ()
    end_line: int = 0
    end_column: int = 0

    @property
    def file_and_line(self) -> str:
        """The path with the number of the line."""
        return f"{self.path}:{self.line}"


class Edit(Named):
    """A change of the text of one file: `old`, at a place, becomes `new`.

    Nothing else changes.

    Line and column count from 1, as in a Location. With `renamed`, the file
    gets this path instead.
    """

    path: str
    line: int
    column: int
    old: str
    new: str
    renamed: str = ""

    @property
    def location(self) -> Location:
        """Where it begins."""
        return Location(self.path, self.line, self.column)


Edits = tuple[Edit, ...]

# How sure a proven edit is. "one of several": an edit of another place gains as much, is as
# plausible and not larger. "preferred": the best of those that were tried.
Certainty = Literal["preferred", "one of several"]


class Source:
    """The text of one file, in which locations are computed on demand: most never are."""

    is_expanded = False  # whether xacro made its elements of other texts

    def __init__(self, path: str, text: str, tags: list[int] | None = None) -> None:
        """`tags` holds the offset of each start tag in document order.

        Without it the text must be well-formed XML.
        """
        self.path = path
        self.text = text
        self._given_tags = tags

    @classmethod
    def decoded(cls, path: str, data: bytes) -> "Source":
        """Return the text of a file in UTF-8, in which other bytes are replaced."""
        return cls(path, data.decode("utf-8", "replace"))

    @cached_property
    def _lines(self) -> list[int]:
        return list(accumulate((len(line) + 1 for line in self.text.split("\n")), initial=0))

    @cached_property
    def _tags(self) -> list[int]:
        tags = re.finditer(_START_TAG, self.text)
        return self._given_tags or [match.start() for match in tags if len(match[0]) == 1]

    def at(self, offset: int) -> Location:
        """Return the location of a character offset."""
        line = bisect_right(self._lines, offset)
        start = self._lines[line - 1]
        if line == 1 and offset > 0 and self.text.startswith("\ufeff"):
            start = 1  # editors do not show a byte-order mark
        return Location(self.path, line, offset - start + 1)

    def tag(self, index: int, attribute: str | None = None) -> Location:
        """Return the location of the start tag with this index in document order.

        With an attribute that the tag has, it is the location of the attribute.
        """
        start = self._tags[index]
        return self.at(start if attribute is None else self._attribute(start, attribute))

    def next_tag(self, index: int, name: str) -> int:
        """Return the index of the first start tag of this name after another one.

        Returns the index of the other one if there is none.
        """
        opening = re.compile(rf"<\s*{re.escape(name)}(?![^\s=/>])")
        others = range(index + 1, len(self._tags))
        return next(
            (other for other in others if opening.match(self.text, self._tags[other])), index
        )

    def line(self, number: int) -> str:
        """Return the text of a line, counted from 1, without its line break."""
        if not 0 < number < len(self._lines):
            return ""
        return (
            self.text[self._lines[number - 1] : self._lines[number] - 1]
            .rstrip("\r")
            .removeprefix("\ufeff")
        )

    def _attribute(self, start: int, name: str) -> int:
        from grader.base import markup  # late: its patterns are for a fault

        written = markup.attribute(self.text, start, name)
        return written.start if written else start

    @property
    def cost(self) -> int:
        """How much longer this takes to read than a short file, as a number of readings of that."""
        return len(self.text) // _BYTES_OF_SHORT_FILE

    def offset(self, line: int, column: int) -> int:
        """Return the character offset of a line and column, the inverse of `at`."""
        start = self._lines[line - 1] if 0 < line <= len(self._lines) else len(self.text)
        if line == 1 and self.text.startswith("\ufeff"):
            start += 1
        return start + column - 1

    def start_offset(self, at: Location | Edit) -> int:
        """Return the character offset of a location, or of what an edit replaces."""
        return self.offset(at.line, at.column)

    def edit(self, start: int, end: int, new: str) -> Edit:
        """Return the edit that replaces the text between two offsets."""
        place = self.at(start)
        return Edit(place.path, place.line, place.column, self.text[start:end], new)

    def element(self, tag: int) -> "tuple[Source, int]":
        """Return the text that the element with this index was written in.

        Also return the offset of its start tag.
        """
        return self, self._tags[tag]


SourceOf = Callable[[str], Source | None]  # returns the text of a file by its path


class Base(Named):
    """The location of a submission in a repository.

    It is the folder of its paths with a slash, or the archive around them.

    With `is_outside` it is in no repository. `here` is what comes before its paths in the current
    folder.
    """

    folder: str = ""
    archive: str = ""
    is_outside: bool = False
    here: str = ""


class LazyLocation(NamedTuple):
    """The place of an element or attribute, computed on demand.

    Most are never computed.

    `tag` counts the element's start tag in document order, from 0. With `inside` the first element
    of this name in it is meant. Where an element holds one, it takes no part in comparison:
    elements are compared by what they are.
    """

    source: Source
    tag: int
    attribute: str | None = None
    inside: str | None = None

    def resolve(self) -> Location:
        """Return the location of the attribute if the element has it, else of the tag."""
        tag = self.tag if self.inside is None else self.source.next_tag(self.tag, self.inside)
        return self.source.tag(tag, self.attribute)


def place(
    element: LazyLocation | None, attribute: str | None = None, inside: str | None = None
) -> LazyLocation | None:
    """Return the place of an element that was read from the file.

    It may also be the place of one of its attributes, or of an element inside.
    """
    if element:
        return LazyLocation(element.source, element.tag, attribute, inside)
    return None
