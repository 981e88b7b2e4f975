"""Syntax errors of XML: edits of one character after which the file can be read."""

import re
from collections.abc import Iterator
from itertools import islice

from grader.edits import Proposal, edited
from grader.package.edits.task import proposal
from grader.package.xml_file import XmlFault, XmlFile
from grader.source import Edit, Source

_PLACE = re.compile(r"\b|(?<=\W)(?=\W)")
_ADDED = "\"<>/='"
_MAX_LINES = 6  # before the error that are looked at
_MAX_TRIES = 1500
_MAX_FOUND = 6


def repaired(source: Source, what: str) -> Iterator[Proposal]:
    """Yield edits of one character or one tag after which a file is XML, those nearest to the error first."""
    fault = _fault(source.text)
    if fault is None:
        return
    line = fault.location.line
    tries = (edit for number in range(line, max(line - _MAX_LINES, 0), -1) for edit in _edits(source, number))
    after = ((edit, edited(source.text, source.path, [edit])) for edit in islice(tries, _MAX_TRIES))
    for edit in islice((edit for edit, text in after if text is not None and _fault(text) is None), _MAX_FOUND):
        yield proposal([edit], f"a syntax error in {what}", f"correct the syntax of {what}")


def _fault(text: str) -> XmlFault | None:
    try:
        XmlFile(text.encode("utf-8", "surrogateescape"), Source("", text))
    except XmlFault as fault:
        return fault
    return None


def _edits(source: Source, number: int) -> Iterator[Edit]:
    start, text = source.offset(number, 1), source.line(number)
    for place in _PLACE.finditer(text):
        at = start + place.start()
        for char in _ADDED:
            yield source.edit(at, at, char)
    for index, char in enumerate(text):
        if char in f"{_ADDED},;&":
            yield source.edit(start + index, start + index + 1, "")
    for tag in re.finditer(r"<(\w+)\b[^<>]*(?<!/)>\s*$", text):
        yield source.edit(start + tag.end(), start + tag.end(), f"</{tag[1]}>")
