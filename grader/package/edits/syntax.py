"""Syntax errors of Python: a search over edits of one token near the parser's error."""

from collections.abc import Iterator, Sequence
from itertools import islice

from grader.edits import Proposal, edited
from grader.package.edits.python_file import PythonFile
from grader.package.edits.task import change
from grader.source import Edit, Source
from grader.static_python.parse import SyntaxFault

_BRACKETS = ("()", "[]", "{}")
_QUOTES = str.maketrans("“”„‘’‚", "\"\"\"'''")
_MAX_TRIES, _MAX_PARSED = 250, 512 * 1024  # edits that are parsed, and characters
_MAX_FOUND = 10


def repaired(file: PythonFile, what: str) -> Iterator[Proposal]:
    """Yield edits of one token after which Python can read a file, the nearest to the error first."""
    fault = file.parsed
    if not isinstance(fault, SyntaxFault):
        return
    tries = min(_MAX_TRIES, _MAX_PARSED // len(file.text))
    found = (change([edit], "syntax", "", what) for edit in dict.fromkeys(islice(_edits(file, fault), tries)))
    yield from islice((it for it in found if _is_read(file, it)), _MAX_FOUND)


def _is_read(file: PythonFile, repair: Proposal) -> bool:
    after = edited(file.text, file.source.path, repair.edits)
    return after is not None and not isinstance(PythonFile(Source(file.source.path, after)).parsed, SyntaxFault)


def _edits(file: PythonFile, fault: SyntaxFault) -> Iterator[Edit]:
    """Yield edits of one token, the nearest to the error first: lone quotes and brackets, indentation, then others."""
    source, last = file.source, fault.location.line
    at = source.offset(last, fault.location.column)
    if (plain := file.text.translate(_QUOTES)) != file.text:
        changed = [index for index, char in enumerate(file.text) if char != plain[index]]
        yield source.edit(changed[0], changed[-1] + 1, plain[changed[0] : changed[-1] + 1])
    odd = _unpaired([token.text for token in file.tokens if token.kind == "op"])
    tokens = sorted(file.tokens, key=lambda it: min(abs(it.start - at), abs(it.end - at)))
    near = [token for token in tokens if source.at(token.start).line in (last, last - 1)]
    for token in near:
        if token.text in odd and token.kind == "op":
            yield from (source.edit(token.start, token.end, char) for char in ("", *odd))
    for token in tokens if odd else ():
        for place in (token.end, token.start):
            yield from (source.edit(place, place, char) for char in odd)
    yield from _indents(file, (last, last - 1))
    for token in near:
        yield from (source.edit(token.end, token.end, char) for char in ",:=.([])")


def _unpaired(ops: Sequence[str]) -> list[str]:
    """Return the quotes that are tokens of their own, and the brackets that are not all paired."""
    unpaired = [pair for pair in _BRACKETS if ops.count(pair[0]) != ops.count(pair[1])]
    return [char for char in "'\"" if char in ops] + list("".join(unpaired))


def _indents(file: PythonFile, lines: tuple[int, ...]) -> Iterator[Edit]:
    """Yield edits that indent a line as the lines around it."""
    for number in lines:
        text, start = file.source.line(number), file.source.offset(number, 1)
        around = [file.source.line(other) for other in (number - 1, number - 2, number + 1)]
        indents = [line[: len(line) - len(line.lstrip())] for line in around if line.strip()]
        for indent in dict.fromkeys(indents):
            yield file.source.edit(start, start + len(text) - len(text.lstrip()), indent)
