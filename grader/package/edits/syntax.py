"""Syntax errors of Python: a search over edits of one token near the parser's error, or else of several."""

import re
from collections.abc import Iterator
from itertools import islice
from keyword import kwlist

from grader.edits import Proposal, composed, edited
from grader.names import closest
from grader.package.edits.python_file import PythonFile, Token
from grader.package.edits.task import proposal
from grader.source import Edit, Source
from grader.static_python.parse import SyntaxFault

_CLOSING = {"(": ")", "[": "]", "{": "}"}
_OPENING = {closing: opening for opening, closing in _CLOSING.items()}
_QUOTES = str.maketrans("“”„‘’‚", "\"\"\"'''")
_BETWEEN = ",:=.("
_LINE_END = re.compile(r"[\s,:]*(#.*)?$")
_MAX_TRIES = 160  # edits that are parsed
_MAX_FOUND = 8
_MAX_ENDS = 40  # places for a bracket or a quote
_MAX_DEPTH = 3  # errors in one file


def repaired(file: PythonFile, what: str) -> Iterator[Proposal]:
    """Yield edits after which Python can read a file, the most plausible first."""
    for edits in islice(_repairs(file, _MAX_DEPTH), _MAX_FOUND):
        yield proposal(edits, "syntax", "", what)


def _repairs(file: PythonFile, depth: int) -> Iterator[tuple[Edit, ...]]:
    fault = file.parsed
    if not isinstance(fault, SyntaxFault):
        return
    furthest: tuple[int, Edit, PythonFile] | None = None
    some = False
    for edit in islice(dict.fromkeys(_edits(file, fault)), _MAX_TRIES):
        after = PythonFile(Source(file.source.path, edited(file.text, file.source.path, [edit]) or ""))
        if not isinstance(after.parsed, SyntaxFault):
            some = True
            yield (edit,)
        elif furthest is None or after.parsed.location.line > furthest[0]:
            furthest = after.parsed.location.line, edit, after
    if not some and depth > 1 and furthest is not None and furthest[0] > fault.location.line:
        for rest in islice(_repairs(furthest[2], depth - 1), 2):
            yield composed(file.text, file.source.path, [furthest[1]], rest)


def _edits(file: PythonFile, fault: SyntaxFault) -> Iterator[Edit]:
    """Yield edits of one token: of quotes and brackets that have no other one, then what is missing between two tokens."""
    if (plain := file.text.translate(_QUOTES)) != file.text:
        changed = [index for index, pair in enumerate(zip(file.text, plain, strict=True)) if pair[0] != pair[1]]
        yield file.source.edit(changed[0], changed[-1] + 1, plain[changed[0] : changed[-1] + 1])
    at = file.source.offset(fault.location.line, fault.location.column)
    lone = [token for token in file.tokens if token.kind == "op" and token.text in ("'", '"')]
    for token in lone[:1]:
        line = file.source.at(token.start).line
        near = [other for other in file.tokens if file.source.at(other.start).line == line]
        ends = dict.fromkeys(place for other in near for place in (other.start, other.end))
        for place in sorted(
            ends, key=lambda place: abs(place - token.start) if place < token.start else len(file.text) - place
        )[:_MAX_ENDS]:
            yield file.source.edit(place, place, token.text)
    yield from _brackets(file)
    lines = (fault.location.line, fault.location.line - 1)
    near = [token for token in file.tokens if file.source.at(token.start).line in lines]
    near.sort(key=lambda token: min(abs(token.start - at), abs(token.end - at)))
    for token in near:
        guess = (
            closest(token.text, kwlist)
            if token.kind == "name" and token.text not in kwlist and len(token.text) > 1
            else None
        )
        if guess is not None:
            yield file.source.edit(token.start, token.end, guess)
    yield from _indents(file, lines)
    for token in near:
        yield from (file.source.edit(token.end, token.end, char) for char in _BETWEEN)
        if token.kind == "op":
            yield file.source.edit(token.start, token.end, "")


def _brackets(file: PythonFile) -> Iterator[Edit]:
    """Yield edits that close the bracket which is open where another one is closed, or open, change or remove that one."""
    opened: list[Token] = []
    last: Token | None = None
    for token in file.tokens:
        if token.text in _CLOSING:
            opened.append(token)
        elif token.text in _OPENING:
            if not opened or _CLOSING[opened[-1].text] != token.text:
                last = token
                break
            opened.pop()
    end = last.end if last is not None else len(file.text)
    if opened:
        closing = _CLOSING[opened[-1].text]
        inside = [token for token in file.tokens if opened[-1].end <= token.end <= end]
        for token in sorted(inside[::-1], key=lambda token: not _is_open(file, token))[:_MAX_ENDS]:
            for place in dict.fromkeys(
                (token.start, token.end) if token.text in (",", ":", last and last.text) else (token.end,)
            ):
                if not file.text[place : place + 1].isalnum() and opened[-1].end <= place:
                    yield file.source.edit(place, place, closing)
        if last is not None:
            yield file.source.edit(last.start, last.end, closing)
    if last is not None:
        line = file.source.at(last.start).line
        yield file.source.edit(last.start, last.end, "")
        for token in [
            token for token in file.tokens if token.start < last.start and line - file.source.at(token.start).line < 2
        ][::-1]:
            for place in (token.end, token.start):
                yield file.source.edit(place, place, _OPENING[last.text])
    elif opened:
        yield file.source.edit(opened[-1].start, opened[-1].end, "")


def _is_open(file: PythonFile, last: Token) -> bool:
    """Return whether a token is the last one of a line that opens a bracket and does not close it."""
    line, after = file.source.at(last.start).line, file.source.at(last.end).column - 1
    text = file.source.line(line).partition("#")[0]
    balance = sum((char in _CLOSING) - (char in _OPENING) for char in text)
    return balance > 0 and bool(_LINE_END.match(text, after)) and not text.rstrip().endswith(tuple(_CLOSING))


def _indents(file: PythonFile, lines: tuple[int, ...]) -> Iterator[Edit]:
    """Yield edits that indent a line as the lines around it."""
    for number in lines:
        text = file.source.line(number)
        indent = text[: len(text) - len(text.lstrip())]
        above = next((it for it in range(number - 1, 0, -1) if file.source.line(it).strip()), 0)
        around = [file.source.line(it) for it in (above, number + 1) if it]
        others = [it[: len(it) - len(it.lstrip())] for it in around]
        for other in dict.fromkeys([*others, *(f"{it}    " for it in others[:1])]):
            if text.strip() and other != indent:
                start = file.source.offset(number, 1)
                yield file.source.edit(start, start + len(indent), other)
