"""The places where the end tag of a macro may be missing."""

import re
from typing import NamedTuple

from grader.base import markup
from grader.base.grouping import Span
from grader.base.patterns import on_use
from grader.base.slips import Slip, Slips
from grader.base.source import Source

_MAX_PLACES = 15
_TAG = on_use(
    r"(?s)<!--.*?(?:-->|\Z)|<!\[CDATA\[.*?(?:\]\]>|\Z)|<\?.*?(?:\?>|\Z)|<(?P<end>/?)(?P<name>[\w:.-]+)"
)


class _Open(NamedTuple):
    """An element that is open, with the ends of the children that it has so far."""

    name: str
    start: int
    children: list[Span]  # the offsets of each child


def macro_end_slips(source: Source) -> tuple[Slip, ...]:
    """Return the places where the one macro that is not closed may end; none if all are.

    A macro ends before it is called.
    """
    unclosed = _find_unclosed(source.text)
    if len(unclosed) != 1:
        return ()
    return tuple(_end_after_children(source, unclosed[0]))


def _find_unclosed(text: str) -> list[_Open]:
    """Return the macros that are open where an element around them ends."""
    opened = []
    unclosed = []
    for match in _TAG.finditer(text):
        name = match["name"]
        if not name:
            continue
        if not match["end"]:
            end, is_empty = markup.head_end(text, match.start())
            if not is_empty:
                opened.append(_Open(name, match.start(), []))
            elif opened:
                opened[-1].children.append((match.start(), end))
            continue
        while opened and opened[-1].name != name and opened[-1].name == "xacro:macro":
            unclosed.append(opened.pop())
        if not opened or opened[-1].name != name:
            return []  # something else is wrong
        closed = opened.pop()
        if opened:
            end = text.find(">", match.start()) + 1
            opened[-1].children.append((closed.start, end))
    return unclosed


def _end_after_children(source: Source, macro: _Open) -> Slips:
    """Yield the slips that end a macro after one of its children."""
    text = source.text
    named = markup.attribute(text, macro.start, "name")
    if not named:
        return
    name = text[slice(*named.value)]
    call = re.compile(rf"<xacro:{re.escape(name.removeprefix('xacro:'))}(?![\w:.-])")
    newline = "\r\n" if "\r\n" in text else "\n"
    indent = markup.indentation(text, macro.start)
    reaction = f"xacro finds no end of the macro {name}"
    for start, end in macro.children[:_MAX_PLACES]:
        if call.search(text, start, end):
            return
        line = text.count("\n", 0, end) + 1
        edit = source.edit(end, end, f"{newline}{indent}</xacro:macro>")
        assumption = f"the macro {name} ends after line {line}"
        yield Slip((edit,), reaction, assumption, source.at(macro.start), is_refused=True)
