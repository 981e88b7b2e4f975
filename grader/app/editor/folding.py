"""What an editor can fold in a file: elements of XML, and what is indented."""

import re
from collections.abc import Iterator

from lsprotocol.types import FoldingRange, FoldingRangeKind

from grader.base.patterns import on_use
from grader.base.text import indent_of

_XML = (".urdf", ".xacro", ".xml", ".sdf", ".srdf", ".world", ".launch")
_TAG = on_use(
    r"<!--.*?(?:-->|\Z)|<(?P<end>/?)(?P<name>[\w:.-]++)(?:\"[^\"<]*+\"|'[^'<]*+'|[^<>\"'])*+>",
    re.DOTALL,
)
_MOST = 5_000


def folding_ranges(path: str, text: str) -> list[FoldingRange] | None:
    """Return what can be folded in a text; None for a file of which an editor knows it itself."""
    if path.endswith(_XML):
        return list(_of_elements(text))[:_MOST]
    if path.endswith((".yaml", ".yml", ".rviz", ".py")):
        return list(_of_indents(text))[:_MOST]
    return None


def _of_elements(text: str) -> Iterator[FoldingRange]:
    """Yield the elements and comments that have several lines, also of a broken file."""
    lines = _Lines(text)
    opened: list[tuple[str, int]] = []
    for tag in _TAG.finditer(text):
        first = lines.number(tag.start())
        last = lines.number(tag.end() - 1)
        name = tag["name"]
        if name is None:
            yield from _range(first, last, FoldingRangeKind.Comment)
        elif tag["end"]:
            names = [opened_name for opened_name, _ in opened]
            if name in names:
                number = len(names) - 1 - names[::-1].index(name)
                yield from _range(opened[number][1], first - 1)
                del opened[number:]
        elif tag[0].endswith("/>"):
            yield from _range(first, last)
        else:
            opened.append((name, first))


def _of_indents(text: str) -> Iterator[FoldingRange]:
    """Yield the lines that are followed by others with more blanks before them."""
    opened: list[tuple[int, int]] = []
    last = -1
    for number, line in enumerate(text.split("\n")):
        words = line.strip()
        if not words or words.startswith("#"):
            continue
        indent = len(indent_of(line))
        while opened and opened[-1][0] >= indent:
            yield from _range(opened.pop()[1], last)
        opened.append((indent, number))
        last = number
    for _, number in reversed(opened):
        yield from _range(number, last)


def _range(first: int, last: int, kind: FoldingRangeKind | None = None) -> Iterator[FoldingRange]:
    if last > first:
        yield FoldingRange(first, last, kind=kind)


class _Lines:
    """The numbers of lines of offsets that are asked for in their order."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._offset = 0
        self._number = 0

    def number(self, offset: int) -> int:
        """Return the number of the line of an offset, from 0."""
        if offset < self._offset:
            return self._text.count("\n", 0, offset)
        self._number += self._text.count("\n", self._offset, offset)
        self._offset = offset
        return self._number
