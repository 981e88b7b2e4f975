"""Syntax errors of XML: edits of one character after which the file can be read."""

import re
from collections.abc import Iterable, Iterator
from itertools import islice

from grader.edits import Proposal, edited
from grader.package.edits.task import proposal
from grader.package.xml_file import XmlFault, XmlFile
from grader.source import Edit, Source

_PLACE = re.compile(r"\b|(?<=\W)(?=\W)")
_TAG = re.compile(r"<(/?)([\w:.-]+)[^<>]*?(/?)>")
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
    for tries in (_closed(source), _lacking(source, lines), (edit for line in lines for edit in _edits(source, line))):
        after = ((edit, edited(source.text, source.path, [edit])) for edit in islice(tries, _MAX_TRIES))
        found = [*islice((edit for edit, text in after if text is not None and _fault(text) is None), _MAX_FOUND)]
        for edit in found:
            yield proposal([edit], f"a syntax error in {what}", f"correct the syntax of {what}")
        if found:
            return


def _closed(source: Source) -> Iterator[Edit]:
    """Yield edits that close the first element which is open where another one is closed, first before a line that is less deep."""
    opened: list[re.Match[str]] = []
    for tag in _TAG.finditer(source.text):
        if not tag[1] and not tag[3]:
            opened.append(tag)
        elif tag[1] and opened and opened[-1][2] != tag[2]:
            break
        elif tag[1] and opened:
            opened.pop()
    else:
        return
    line = source.at(opened[-1].start()).line
    indent = source.line(line)[: source.at(opened[-1].start()).column - 1]
    newline = "\r\n" if "\r\n" in source.text else "\n"
    ends = range(line + 1, source.at(tag.start()).line + 1)
    for number in sorted(ends, key=lambda number: not _is_outside(source.line(number), indent))[:_MAX_LINES]:
        start = source.offset(number, 1)
        yield source.edit(start, start, f"{indent}</{opened[-1][2]}>{newline}")


def _is_outside(line: str, indent: str) -> bool:
    return len(line) - len(line.lstrip()) <= len(indent)


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
        for char in "/" if source.text[at - 1 : at] == "<" else _ADDED:
            yield source.edit(at, at, char)
    for index, char in enumerate(text):
        if char in f"{_ADDED}/,;&":
            yield source.edit(start + index, start + index + 1, "")
    for tag in re.finditer(r"<(\w+)\b[^<>]*(?<!/)>\s*$", text):
        yield source.edit(start + tag.end(), start + tag.end(), f"</{tag[1]}>")
