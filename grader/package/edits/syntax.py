"""Syntax errors of Python: edits of one token after which Python can read the file, or else of several."""

import re
from collections.abc import Iterator
from itertools import islice

from grader.edits import Proposal, composed, edited
from grader.names import closest
from grader.package.edits.brackets import unbalanced, unmatched
from grader.package.edits.python_file import PythonFile, Token
from grader.package.edits.task import proposal
from grader.source import Edit, Source
from grader.static_python.parse import SyntaxFault

_NAMES = {",": "comma", ":": "colon", "'": "quote", '"': "quote", "=": "equals sign", ".": "dot"}
_CLOSING = {"(": ")", "[": "]", "{": "}"}
_MAX_TRIES = 120  # edits that are parsed
_MAX_FOUND = 6
_MAX_DEPTH = 3  # errors in one file
_QUOTES = str.maketrans("“”„‘’‚", "\"\"\"'''")
_KEYWORDS = (
    "import",
    "from",
    "def",
    "return",
    "with",
    "open",
    "as",
    "for",
    "in",
    "if",
    "else",
    "not",
    "class",
    "lambda",
)
_BLOCK = re.compile(r"\s*(def|with|if|elif|else|for|while|class|try|except|finally)\b")
_LINE_END = re.compile(r"[\s,;:)\]}+]*(#.*)?$")


def repaired(file: PythonFile, what: str) -> Iterator[Proposal]:
    """Yield edits after which Python can read a file, the most plausible first."""
    for edits in islice(_repairs(file, _MAX_DEPTH), _MAX_FOUND):
        yield proposal(edits, f"a syntax error in {what}", _action(edits, what))


def _action(edits: tuple[Edit, ...], what: str) -> str:
    first = edits[0]
    if len(edits) == 1 and not first.old.strip() and len(first.new.strip()) == 1:
        name = _NAMES.get(first.new.strip(), "bracket")
        return f"add the missing {name} in {what}"
    return f"correct the syntax of {what}"


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
    """Yield edits of one token that are plausible for an error, the most plausible first."""
    if (plain := file.text.translate(_QUOTES)) != file.text:
        yield from _plain_quotes(file, plain)
    line = fault.location.line
    yield from _keywords(file, line)
    yield from _colons(file, (line, line - 1))
    odd = next((number for number in range(1, line) if _is_odd(file.source.line(number))), line)
    for number in dict.fromkeys((line, odd)):
        yield from _quotes(file, number)
    for number in (line, line - 1):
        yield from unbalanced(file, number)
    yield from missing_commas(file)
    yield from unmatched(file)
    yield from _indents(file, line)
    for number in (line, line - 1):
        yield from _operators(file, number)


def _is_odd(text: str) -> bool:
    """Return whether a line has a quote that is not closed."""
    return not text.lstrip().startswith("#") and any(text.count(quote) % 2 for quote in "'\"")


def _plain_quotes(file: PythonFile, plain: str) -> Iterator[Edit]:
    changed = [index for index, pair in enumerate(zip(file.text, plain, strict=True)) if pair[0] != pair[1]]
    yield file.source.edit(changed[0], changed[-1] + 1, plain[changed[0] : changed[-1] + 1])


def _keywords(file: PythonFile, line: int) -> Iterator[Edit]:
    for token in file.tokens:
        if (
            token.kind == "name"
            and token.text not in _KEYWORDS
            and file.source.at(token.start).line in (line, line - 1)
        ):
            guess = closest(token.text, _KEYWORDS) if len(token.text) > 1 else None
            if guess is not None:
                yield file.source.edit(token.start, token.end, guess)


def _colons(file: PythonFile, lines: tuple[int, ...]) -> Iterator[Edit]:
    for number in lines:
        text = file.source.line(number).partition("#")[0].rstrip()
        if _BLOCK.match(text) and not text.endswith(":"):
            end = file.source.offset(number, len(text) + 1)
            yield file.source.edit(end, end, ":")


def _quotes(file: PythonFile, line: int) -> Iterator[Edit]:
    """Yield edits that add the quote that is missing at the start or the end of a string, first next to a word."""
    text = file.source.line(line)
    for quote in "'\"":
        if text.count(quote) % 2:
            beside = rf"(?<=[\s(\[,{{=])(?=[\w./*-]+{quote})|(?<={quote})[\w./*-]+(?=[,)\]}}:])"
            end = _LINE_END.search(text)
            ends = range(end.start() if end is not None else len(text), len(text) + 1)
            words = re.finditer(r"(?<=[\s=(\[,{])(?=\w)|(?<=\w)(?=[,)\]}])", text)
            near = [match.end() for match in re.finditer(beside, text)]
            for place in dict.fromkeys([*near, *ends, *(match.end() for match in words)]):
                at = file.source.offset(line, place + 1)
                yield file.source.edit(at, at, quote)


def _operators(file: PythonFile, line: int) -> Iterator[Edit]:
    """Yield edits that add what is missing between two words of a line: a comma, an equals sign, a dot, a bracket."""
    start, text = file.source.offset(line, 1), file.source.line(line).partition("#")[0]
    for match in re.finditer(r"(?<=[\w'\")\]])\s*(?=['\"(\[\w])", text):
        for char in ",=.(":
            yield file.source.edit(start + match.start(), start + match.start(), char)


def missing_commas(file: PythonFile) -> Iterator[Edit]:
    """Yield edits that add a comma between two items of a list or of arguments."""
    depth = 0
    for before, after in zip(file.tokens, file.tokens[1:], strict=False):
        depth += (before.text in _CLOSING) - (before.text in _CLOSING.values())
        between = file.text[before.end : after.start]
        if depth > 0 and _ends(before) and _starts(after):
            both = before.kind == after.kind == "string"
            if "\n" in between or both or (before.text in (")", "]", "}") and (after.kind != "op" or between)):
                yield file.source.edit(before.end, before.end, ",")


def _ends(token: Token) -> bool:
    return token.kind in ("string", "name") or token.text in _CLOSING.values()


def _starts(token: Token) -> bool:
    words = ("if", "else", "for", "in", "and", "or", "not", "is", "as")
    return token.kind == "string" or token.text in _CLOSING or (token.kind == "name" and token.text not in words)


def _indents(file: PythonFile, line: int) -> Iterator[Edit]:
    """Yield edits that indent a line as the lines around it."""
    for number in (line, line - 1):
        text = file.source.line(number)
        indent = text[: len(text) - len(text.lstrip())]
        above = next((it for it in range(number - 1, 0, -1) if file.source.line(it).strip()), 0)
        around = [file.source.line(it) for it in (above, number + 1) if it]
        others = [it[: len(it) - len(it.lstrip())] for it in around]
        for other in dict.fromkeys([*others, *(f"{it}    " for it in others[:1])]):
            if text.strip() and other != indent:
                start = file.source.offset(number, 1)
                yield file.source.edit(start, start + len(indent), other)
