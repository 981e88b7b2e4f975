"""Edits that make a file well-formed XML where xacro refuses it, though everything in it can be read."""

from collections.abc import Iterator

from grader import markup
from grader.source import Correction, Source
from grader.xacro.nodes import MISPLACED

_NAMESPACE = ' xmlns:xacro="http://www.ros.org/wiki/xacro"'
_UNDECLARED = "the prefix xacro, which is not declared"
_NOT_FIRST = "the XML declaration, which is not at the start"


def well_formed(source: Source) -> Iterator[Correction]:
    """Yield the edits that declare the prefix xacro, and that put the declaration of XML at the start of the file."""
    text = source.text
    if "xmlns:xacro" not in text and "xacro:" in text:
        _, start = source.element(0)
        end = markup.name_end(text, start)
        edit = source.edit(start, end, text[start:end] + _NAMESPACE)
        yield Correction((edit,), _UNDECLARED, "declare the prefix xacro")
    found = MISPLACED.search(text)
    before = text[: found.start()].removeprefix("\ufeff") if found is not None else ""
    if found is not None and before:
        newline = "\r\n" if "\r\n" in text else "\n"
        moved = found[0] if before.isspace() else f"{found[0]}{newline}{before.rstrip()}"
        edit = source.edit(found.start() - len(before), found.end(), moved)
        yield Correction((edit,), _NOT_FIRST, "move the XML declaration to the start")
