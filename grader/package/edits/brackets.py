"""Brackets of Python that do not fit: edits that add the one that is missing, or remove the one that is too many."""

import re
from collections.abc import Iterator

from grader.package.edits.python_file import PythonFile, Token
from grader.source import Edit

_CLOSING = {"(": ")", "[": "]", "{": "}"}
_MAX_ENDS = 12  # lines that may lack a bracket
_FUNCTIONS = ("glob", "join", "open", "str", "find_packages", "Node", "setup", "LaunchDescription")
_CALLED = re.compile(r"(\w+)(?=[(\[])")
_WORD = re.compile(r"\w+")


def unbalanced(file: PythonFile, line: int) -> Iterator[Edit]:
    """Yield edits that add the bracket that a line lacks: one that is closed and not opened, or the reverse."""
    start, text = file.source.offset(line, 1), file.source.line(line).partition("#")[0]
    balance = sum((char in _CLOSING) - (char in _CLOSING.values()) for char in text)
    if balance < 0:
        yield from _surplus(file, start, text)
    elif balance > 0:
        for match in reversed([*re.finditer(r"['\"\w)\]}](?=[\s,)\]}]|$)", text)]):
            for char in ")]":
                yield file.source.edit(start + match.end(), start + match.end(), char)


def _surplus(file: PythonFile, start: int, text: str) -> Iterator[Edit]:
    """Yield edits of a line with a bracket that is closed and not opened: open it, first where a call lacks it, or remove one."""
    words, others = [*_WORD.finditer(text)], {*_WORD.findall(file.text)}
    known = {*_FUNCTIONS, *_CALLED.findall(file.text)}
    places = [word.end() for word in words if text[word.end() : word.end() + 1] in ("'", '"')]
    places += [
        word.start() + size
        for word in words
        for size in range(2, len(word[0]))
        if word[0][:size] in known or {word[0][:size], word[0][size:]} <= others
    ]
    yield from (file.source.edit(start + place, start + place, "(") for place in places)
    for index in reversed(range(len(text))):
        if text[index] in _CLOSING.values() and text[index + 1 : index + 2] != text[index]:
            yield file.source.edit(start + index, start + index + 1, "")
    for place in [*(word.end() for word in words), *(it.start() for it in re.finditer(r"(?<=[=(\[, ])['\"\w]", text))]:
        for char in "(" if place and text[place - 1].isalnum() else "([{":
            yield file.source.edit(start + place, start + place, char)


def unmatched(file: PythonFile) -> Iterator[Edit]:
    """Yield edits that close a bracket that is open where another one is closed, or remove or change the other one."""
    opened: list[Token] = []
    for token in file.tokens:
        if token.text in _CLOSING:
            opened.append(token)
        elif token.text in _CLOSING.values():
            if opened and _CLOSING[opened[-1].text] == token.text:
                opened.pop()
                continue
            if opened:
                yield from _closed(file, opened[-1], token.start)
                yield file.source.edit(token.start, token.end, _CLOSING[opened[-1].text])
            yield file.source.edit(token.start, token.end, "")
            return
    if opened:
        yield from _closed(file, opened[-1], len(file.text))


def _closed(file: PythonFile, opening: Token, end: int) -> Iterator[Edit]:
    """Yield edits that close a bracket at the end of a line before an offset, before the comma there; the last lines first."""
    tokens = [token for token in file.tokens if opening.end <= token.end <= end]
    ends = [
        one for one, other in zip(tokens, [*tokens[1:], None], strict=False)
        if other is None or "\n" in file.text[one.end : other.start] or other.start >= end
    ]  # fmt: skip
    unbalanced = [token for token in ends if _is_open(file, token)]
    for token in dict.fromkeys(unbalanced[::-1] + ends[:0:-1][:_MAX_ENDS] + ends[:1]):
        for place in (token.start, token.end) if token.text in (",", ":") else (token.end, token.start):
            if opening.end <= place:
                yield file.source.edit(place, place, _CLOSING[opening.text])


def _is_open(file: PythonFile, last: Token) -> bool:
    """Return whether the line of a token opens a bracket that it does not close, and the next line is not deeper."""
    number = file.source.at(last.start).line
    line, after = file.source.line(number), file.source.line(number + 1)
    balance = sum((char in _CLOSING) - (char in _CLOSING.values()) for char in line.partition("#")[0])
    return balance > 0 and len(after) - len(after.lstrip()) <= len(line) - len(line.lstrip())
