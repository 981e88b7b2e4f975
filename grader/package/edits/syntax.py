"""Syntax errors of Python: a search over edits of one token near the parser's error, or else of several."""

from collections.abc import Iterator
from itertools import islice
from keyword import kwlist

from grader.edits import Proposal, composed, edited
from grader.names import closest
from grader.package.edits.python_file import PythonFile
from grader.package.edits.task import change
from grader.source import Edit, Source
from grader.static_python.parse import SyntaxFault

_BRACKETS = {"(": ")", "[": "]", "{": "}"}
_QUOTES = str.maketrans("“”„‘’‚", "\"\"\"'''")
_MAX_TRIES, _MAX_PARSED = 250, 512 * 1024  # edits that are parsed, and characters
_MAX_FOUND = 10
_MAX_DEPTH = 3  # errors in one file


def repaired(file: PythonFile, what: str) -> Iterator[Proposal]:
    """Yield edits after which Python can read a file, the most plausible first."""
    for edits in islice(_repairs(file, _MAX_DEPTH), _MAX_FOUND):
        yield change(edits, "syntax", "", what)


def _repairs(file: PythonFile, depth: int) -> Iterator[tuple[Edit, ...]]:
    fault = file.parsed
    if not isinstance(fault, SyntaxFault):
        return
    furthest: tuple[int, Edit, PythonFile] | None = None
    some = False
    tries = min(_MAX_TRIES, _MAX_PARSED // len(file.text))
    for edit in dict.fromkeys(islice(_edits(file, fault), tries)):
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
    """Yield edits of one token, the nearest to the error first, in lines with a lone quote or bracket before the others."""
    source, at = file.source, file.source.offset(fault.location.line, fault.location.column)
    if (plain := file.text.translate(_QUOTES)) != file.text:
        changed = [index for index, char in enumerate(file.text) if char != plain[index]]
        yield source.edit(changed[0], changed[-1] + 1, plain[changed[0] : changed[-1] + 1])
    tokens = [(token, source.at(token.start).line) for token in file.tokens]
    ops = [token.text for token in file.tokens if token.kind == "op"]
    odd = [char for char in "'\"" if char in ops]
    odd += [char for pair in _BRACKETS.items() for char in pair if ops.count(pair[0]) != ops.count(pair[1])]
    balance: dict[int, int] = {}
    for token, line in tokens:
        is_lone = token.kind == "op" and token.text in odd
        balance[line] = balance.get(line, 0) + is_lone * (-1 if token.text in _BRACKETS.values() else 1)
    last = fault.location.line
    tokens.sort(key=lambda it: (not balance[it[1]], abs(it[1] - last), min(abs(it[0].start - at), abs(it[0].end - at))))
    near = [token for token, line in tokens if line in (last, last - 1)]
    for token, line in tokens if odd else ():
        if token.text in odd and token.kind == "op" and line in (last, last - 1):
            yield from (source.edit(token.start, token.end, char) for char in ("", *odd))
    for token, _ in tokens if odd else ():
        for place in (token.end, token.start):
            yield from (source.edit(place, place, char) for char in odd)
    yield from _indents(file, (last, last - 1))
    for token in near:
        guess = closest(token.text, kwlist) if token.kind == "name" and token.text not in kwlist else None
        if guess is not None:
            yield source.edit(token.start, token.end, guess)
        yield from (source.edit(token.end, token.end, char) for char in ",:=.([])")
        if token.kind == "op":
            yield from (source.edit(token.start, token.end, char) for char in ("", *_BRACKETS.values()))


def _indents(file: PythonFile, lines: tuple[int, ...]) -> Iterator[Edit]:
    """Yield edits that indent a line as the lines around it."""
    for number in lines:
        text, start = file.source.line(number), file.source.offset(number, 1)
        around = [file.source.line(other) for other in (number - 1, number - 2, number + 1)]
        indents = [line[: len(line) - len(line.lstrip())] for line in around if line.strip()]
        for indent in dict.fromkeys((*indents, *(f"{it}    " for it in indents[:1]))):
            yield file.source.edit(start, start + len(text) - len(text.lstrip()), indent)
