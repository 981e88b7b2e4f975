"""The slips for which Python cannot read a file.

A comma, a colon, a bracket or a quote is missing, or a keyword is misspelt.
"""

import ast
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import islice
from keyword import kwlist

from grader.base.grouping import group_values
from grader.base.names import closest, near
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.slips import Slip
from grader.base.source import Edit, Location
from grader.base.text import cut, indent_of, quoted
from grader.ros.python.parse import Code, SyntaxFault, parse

_Lines = list[str]

_MAX_SLIPS = 5  # in one file
_MAX_BYTES = 32 * 1024  # of a file: what may be meant is tried by reading it again
_MAX_LINES = 40  # over which a bracket is searched
_MAX_LENGTH = 1_000  # characters of a line
_MAX_TRIED = 50  # changes of one kind
_MAX_SHOWN = 60
_MAX_MOVED = 2  # columns of an indentation
_CLOSING = {"(": ")", "[": "]", "{": "}"}
_QUOTES = str.maketrans("“”„‘’‚´\N{NO-BREAK SPACE}", "\"\"\"'''' ")
_TOKEN = on_use(r"""[rRbBfFuU]*(?:"[^"\n]*"|'[^'\n]*')|\w+|[^\w\s]""")
_OPENED = on_use(r"'([(\[{])'(?: was never closed| on line (\d+)|$)")
_TRAILING = on_use(r"(?<![\s,)\]}:])[\s,)\]}:]*+$")
_COMMENT = on_use(r"""((?:[^#'"]|"[^"]*"|'[^']*')*?)(\s*(?:\#.*)?)$""")


_Way = Callable[[SyntaxFault, list[str]], Iterator["_Change"]]


class _Change(Named):
    """A line as it may be meant."""

    line: int  # from 0
    text: str


_Changes = Iterator[_Change]


def python_slips(data: bytes, path: str) -> list[Slip]:
    """Return what Python refuses in a file, each with the change of one line.

    They are in the order in which Python meets them; after each change it reads on. Returns nothing
    where a line may mean several things.
    """
    if len(data) > _MAX_BYTES:
        return []
    slips: list[Slip] = []
    parsed = parse(data, path)
    if not isinstance(parsed, SyntaxFault) or not parsed.is_certain:
        return []
    lines = parsed.source.text.split("\n")
    while isinstance(parsed, SyntaxFault) and len(slips) < _MAX_SLIPS:
        change = _meant(parsed, lines, path)
        if not change:
            return []
        slips.append(_slip(parsed, lines[change.line], change, path))
        lines[change.line] = change.text
        parsed = _parsed(lines, path)
    if isinstance(parsed, SyntaxFault) or len({slip.location.line for slip in slips}) < len(slips):
        return []
    return slips


def _slip(fault: SyntaxFault, written: str, change: _Change, path: str) -> Slip:
    """Return the slip of a line."""
    line = change.line + 1
    start = 0
    while start < min(len(written), len(change.text)) and written[start] == change.text[start]:
        start += 1
    texts = [text.strip() for text in (written, change.text)]
    if cut(texts[0], _MAX_SHOWN) == cut(texts[1], _MAX_SHOWN):
        texts = [text[max(0, start - _MAX_SHOWN // 2) :].strip() for text in (written, change.text)]
    assumption = " is read as ".join(quoted(cut(text, _MAX_SHOWN)) for text in texts)
    if written.strip() == change.text.strip():
        blanks = [len(text) - len(text.lstrip()) for text in (written, change.text)]
        assumption = f"the indentation of {blanks[0]} blanks is read as {blanks[1]}"
    edit = Edit(path, line, 1, written, change.text)
    reaction = f"Python cannot read the file: {fault.message}"
    return Slip((edit,), reaction, assumption, Location(path, line, start + 1), is_refused=True)


def _parsed(lines: Sequence[str], path: str) -> Code | SyntaxFault:
    return parse("\n".join(lines).encode("utf-8", "surrogateescape"), path)


def _meant(fault: SyntaxFault, lines: _Lines, path: str) -> _Change | None:
    """Return the change of a line after which Python reads the file, or at least reads on.

    Returns None if different ones do.
    """
    for message, way in _WAYS:
        if not message.search(fault.message):
            continue
        read = _readable_changes(fault, lines, path, islice(way(fault, lines), _MAX_TRIED))
        complete = [change for tree, change in read.items() if tree]
        if len(complete) == 1:
            return complete[0]
        if complete:
            return None
        if read:
            return read[""]
    return None


def _readable_changes(
    fault: SyntaxFault, lines: _Lines, path: str, changes: Iterable[_Change]
) -> dict[str, _Change]:
    """Return the changes after which Python reads the file, by what it is then.

    The key of one after which Python only reads on is empty.
    """
    read: dict[str, _Change] = {}
    for change in changes:
        after = list(lines)
        after[change.line] = change.text
        parsed = _parsed(after, path)
        if isinstance(parsed, Code):
            read.setdefault(ast.dump(parsed.tree), change)
        elif parsed.location.line > fault.location.line and parsed.reason != fault.reason:
            read.setdefault("", change)
    return read


def _code_and_rest(line: str) -> tuple[str, str]:
    """Return a line up to its comment, and the rest."""
    match = _COMMENT.match(line) if len(line) <= _MAX_LENGTH else None
    return (match[1], match[2]) if match else (line, "")


def _with_plain_quotes(fault: SyntaxFault, lines: _Lines) -> _Changes:
    index = fault.location.line - 1
    plain = lines[index].translate(_QUOTES)
    if plain != lines[index]:
        yield _Change(index, plain)


def _with_keyword(fault: SyntaxFault, lines: _Lines) -> _Changes:
    """Yield the line with a word as the keyword that it is near: improt, form, retrun."""
    index = fault.location.line - 1
    line = lines[index]
    if len(line) > _MAX_LENGTH:
        return
    for match in re.finditer(r"(?<![\w.'\"])[A-Za-z]{2,}(?![\w.'\"])", line):
        word = match[0]
        meant = None
        if word not in kwlist:
            meant = near(word, kwlist) or closest(word, kwlist, is_clear=True)
        if meant is not None:
            yield _Change(index, line[: match.start()] + meant + line[match.end() :])


def _with_quote(fault: SyntaxFault, lines: _Lines) -> _Changes:
    """Yield the line with a quote that is missing.

    The quote ends its text, before what follows a text, or begins it.
    """
    index = fault.location.line - 1
    column = fault.location.column - 1
    line = lines[index]
    quote = line[column : column + 1]
    if quote not in ("'", '"'):
        return
    end = _TRAILING.search(line)
    if end and end.start() > column:
        yield _Change(index, line[: end.start()] + quote + line[end.start() :])
    word = re.search(r"[\w./*-]+$", line[:column][-_MAX_LENGTH:])
    if word:
        start = column - len(word[0])
        yield _Change(index, line[:start] + quote + line[start:])


def _with_colon(fault: SyntaxFault, lines: _Lines) -> _Changes:
    index = fault.location.line - 1
    code, rest = _code_and_rest(lines[index])
    if re.match(r"\s*(?:def|class|if|elif|else|for|while|with|try|except|finally)\b", code):
        if code.endswith((";", ",")):
            code = code[:-1]
        yield _Change(index, f"{code}:{rest}")


def _with_comma(fault: SyntaxFault, lines: _Lines) -> _Changes:
    """Yield a comma at the end of the line or of the one before, or between two of its words.

    The comma may also stand for a semicolon or a point.
    """
    index = fault.location.line - 1
    for at in (index, index - 1):
        if at < 0:
            continue
        code, rest = _code_and_rest(lines[at])
        if code.strip() and not code.endswith((",", "(", "[", "{", ":")):
            yield _Change(at, f"{code.rstrip(';.')},{rest}")
    # The first of two expressions begins here, and may end in a later line.
    for at, later in enumerate(lines[index + 1 : index + _MAX_LINES], index + 1):
        code, rest = _code_and_rest(later)
        if code.endswith((")", "]", "}")):
            yield _Change(at, f"{code},{rest}")
    line = lines[index]
    column = max(fault.location.column - 1, 0)
    if len(line) <= _MAX_LENGTH:
        before = line[:column]
        is_inside = len(re.findall(r"[(\[{]", before)) > len(re.findall(r"[)\]}]", before))
        if is_inside and before.endswith(" "):
            yield _Change(index, f"{before.rstrip()}, {line[column:]}")
        for match in _TOKEN.finditer(line, column):
            after = line[match.end() :]
            if after[:1] == " ":
                yield _Change(index, f"{line[: match.end()]},{after}")


def _with_bracket_in_line(fault: SyntaxFault, lines: _Lines) -> _Changes:
    """Yield the line with a bracket removed, inserted or doubled.

    It is without a bracket that is too much, with the one that another one needs before it, or with
    one of its own doubled.
    """
    index = fault.location.line - 1
    column = fault.location.column - 1
    line = lines[index]
    if line[column : column + 1] in (")", "]", "}"):
        yield _Change(index, line[:column] + line[column + 1 :])
    mismatched = re.search(r"does not match opening parenthesis '([(\[{])'", fault.message)
    if mismatched:
        yield _Change(index, line[:column] + _CLOSING[mismatched[1]] + line[column:])
    for match in re.finditer(r"[)\]}]", line[:_MAX_LENGTH]):
        yield _Change(index, line[: match.end()] + match[0] + line[match.end() :])


def _with_bracket_at_end(fault: SyntaxFault, lines: _Lines) -> _Changes:
    """Yield a line with a bracket at its end.

    The lines are from that where one is opened to the first that ends what is indented below it.
    """
    index = fault.location.line - 1
    first = max(index - 1, 0)
    last = index + 1
    brackets = ")]}"
    opened = _OPENED.search(fault.message)
    if opened:
        brackets = _CLOSING[opened[1]]
        first = int(opened[2]) - 1 if opened[2] else index
        last = index + _MAX_LINES
    indentation = len(_indentation(lines[first]))
    for at in range(first, min(last, len(lines))):
        code, rest = _code_and_rest(lines[at])
        for bracket in brackets if code.strip() else ():
            comma = "," if code.endswith(",") else ""
            yield _Change(at, f"{code.removesuffix(',')}{bracket}{comma}{rest}")
        following = next((line for line in lines[at + 1 :] if line.strip()), "")
        is_inside = len(_indentation(following)) > indentation
        if opened and not is_inside and following.lstrip()[:1] not in (")", "]", "}"):
            return


def _with_indentation(fault: SyntaxFault, lines: _Lines) -> _Changes:
    """Yield the line with the indentation of the lines before that is nearest to its own."""
    index = fault.location.line - 1
    indentation = _indentation(lines[index])
    others = {_indentation(line) for line in lines[:index] if line.strip()} | {""}
    by_distance = group_values((abs(len(other) - len(indentation)), other) for other in others)
    nearest = by_distance[min(by_distance)]
    if len(nearest) == 1 and min(by_distance) <= _MAX_MOVED:
        yield _Change(index, nearest[0] + lines[index].lstrip())


def _indentation(line: str) -> str:
    return indent_of(line)


def _with_pair(fault: SyntaxFault, lines: _Lines) -> _Changes:
    """Yield a colon for the = of a dictionary, or for the one that lacks."""
    index = fault.location.line - 1
    line = lines[index]
    if len(line) > _MAX_LENGTH:
        return
    for match in re.finditer(r"""(?:(['"])\s*=\s*|(?<=\{)(['"]\w+['"])\s+(?=\w))""", line):
        key = match[1] or match[2]
        yield _Change(index, f"{line[: match.start()]}{key}: {line[match.end() :]}")


# What is tried for a message of Python, in this order.
_WAYS = (
    (re.compile("invalid"), _with_plain_quotes),
    (re.compile("unterminated string"), _with_quote),
    (re.compile("expected ':'|invalid syntax"), _with_colon),
    (re.compile("dictionary|invalid syntax|cannot assign"), _with_pair),
    (re.compile("comma|invalid syntax"), _with_comma),
    (re.compile("invalid syntax|expected"), _with_keyword),
    (re.compile("closed|match|invalid syntax|comma|follows"), _with_bracket_at_end),
    (re.compile("closed|match|invalid syntax|comma"), _with_bracket_in_line),
    (re.compile("indent"), _with_indentation),
)
