"""Syntax errors of XML: edits of one character after which the file can be read."""

import re
from collections.abc import Iterable, Iterator
from itertools import islice

from grader.edits import Proposal, edited
from grader.package.edits.task import proposal
from grader.package.xml_file import XmlFault, XmlFile
from grader.source import Edit, Source

_PLACE = re.compile(r"\b|(?<=\W)(?=\W)")
_BEFORE = re.compile(r"(?=/)|(?<![<\w/])(?=\w)")  # where a tag may begin
_ADDED = "\"<>/='"
_MAX_LINES = 6  # before the error that are looked at
_MAX_TRIES = 1500
_MAX_FOUND = 6


def repaired(source: Source, what: str) -> Iterator[Proposal]:
    """Yield edits of one character or one tag after which a file is XML: in lines that lack a character, else near the error."""
    fault = _fault(source.text)
    if fault is None:
        return
    lines = range(fault.location.line, max(fault.location.line - _MAX_LINES, 0), -1)
    for tries in (_lacking(source, lines), (edit for line in lines for edit in _edits(source, line))):
        after = ((edit, edited(source.text, source.path, [edit])) for edit in islice(tries, _MAX_TRIES))
        found = [*islice((edit for edit, text in after if text is not None and _fault(text) is None), _MAX_FOUND)]
        for edit in found:
            yield proposal([edit], f"a syntax error in {what}", f"correct the syntax of {what}")
        if found:
            return


def _lacking(source: Source, lines: Iterable[int]) -> Iterator[Edit]:
    """Yield edits that add the character which lines lack: a quote, or one of < and >."""
    for number in lines:
        start, text = source.offset(number, 1), source.line(number)
        opened, closed = text.count("<"), text.count(">")
        added = '"' * (text.count('"') % 2) + ">" * (opened > closed) + "<" * (opened < closed)
        for char in added:
            places = _BEFORE if char == "<" else _PLACE
            yield from (source.edit(start + it.start(), start + it.start(), char) for it in places.finditer(text))


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
