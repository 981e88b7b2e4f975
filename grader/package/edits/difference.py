"""The lines in which a file differs from the one of the reference: each may be where the mistake is."""

import re
from collections.abc import Iterator
from difflib import SequenceMatcher
from typing import NamedTuple

from grader.edits import Proposal
from grader.package.edits.task import proposal
from grader.source import Edit, Source

_MAX_LINES = 12  # of one difference
_MAX_DIFFERENCES = 12
_WORD = re.compile(r"\w+|\s+|.", re.DOTALL)


class _Line(NamedTuple):
    indent: str
    text: str


def restored(source: Source, wanted: str, what: str) -> Iterator[Proposal]:
    """Yield edits that undo one difference each between a file and the text that it should have, then one that undoes all."""
    own, right = _lines(source.text), _lines(wanted)
    matcher = SequenceMatcher(None, [line.text for line in own], [line.text for line in right], autojunk=False)
    found: list[tuple[Edit, ...]] = []
    for tag, first, last, start, end in matcher.get_opcodes():
        if tag == "equal":
            found += _indented(source, own, right, (first, last, start, end))
        elif max(last - first, end - start) <= _MAX_LINES:
            found += _undone(source, own, right, (first, last, start, end))
    what = what.removeprefix("the ")
    for edits in found[:_MAX_DIFFERENCES]:
        yield proposal(edits, f"a line that differs from the lab's {what}", f"write the line as in the lab's {what}")
    if 1 < len(found) <= _MAX_DIFFERENCES:
        edits = tuple(edit for several in found for edit in several)
        yield proposal(
            edits,
            f"lines that differ from the lab's {what}",
            f"write the lines as in the lab's {what}",
            is_rewrite=True,
        )


def rewritten(source: Source, wanted: str) -> Edit:
    """Return the edit that gives a file the whole text that it should have; a byte-order mark stays."""
    return source.edit(int(source.text.startswith("\ufeff")), len(source.text), wanted)


def _lines(text: str) -> list[_Line]:
    lines = text.removeprefix("\ufeff").split("\n")
    return [_Line(line[: len(line) - len(line.lstrip())], line.strip()) for line in lines]


def _undone(
    source: Source, own: list[_Line], right: list[_Line], span: tuple[int, int, int, int]
) -> Iterator[tuple[Edit, ...]]:
    """Yield the edits for one difference: of each line where they correspond, else of all."""
    first, last, start, end = span
    if last - first == end - start:
        more, less = _shift(own, right, first, start)
        for here, line in zip(range(first, last), right[start:end], strict=True):
            yield (_changed_line(source, here, own[here], more + line.indent.removeprefix(less) + line.text),)
        return
    if not any(line.text for line in (*own[first:last], *right[start:end])):
        return
    newline = "\r\n" if "\r\n" in source.text else "\n"
    more, less = _shift(own, right, first, start)
    new = "".join(
        f"{more + line.indent.removeprefix(less) if line.text else ''}{line.text}{newline}" for line in right[start:end]
    )
    at, until = _start(source, first), _start(source, last)
    if at == len(source.text) and not source.text.endswith("\n"):
        new = newline + new.removesuffix(newline)
    yield (source.edit(at, until, new),)


def _indented(
    source: Source, own: list[_Line], right: list[_Line], span: tuple[int, int, int, int]
) -> Iterator[tuple[Edit, ...]]:
    """Yield the edits of lines that are indented otherwise than the line before them, in comparison with the reference."""
    first, last, start, _ = span
    for index in range(1, last - first):
        here, there = first + index, start + index
        more, less = _shift(own, right, here, there)
        indent = more + right[there].indent.removeprefix(less)
        if own[here].text and own[here].indent != indent:
            at = _start(source, here)
            yield (source.edit(at, at + len(own[here].indent), indent),)


def _shift(own: list[_Line], right: list[_Line], first: int, start: int) -> tuple[str, str]:
    """Return the indentation that lines of the reference get, and the one that they lose, at their place in the file."""
    if first == 0 or start == 0:
        return "", ""
    here, there = own[first - 1].indent, right[start - 1].indent
    return (here.removeprefix(there), "") if here.startswith(there) else ("", there.removeprefix(here))


def _start(source: Source, line: int) -> int:
    """Return the offset of a line, counted from 0."""
    return min(source.offset(line + 1, 1), len(source.text))


def _changed_line(source: Source, number: int, line: _Line, new: str) -> Edit:
    """Return the edit of the words of a line that differ, the smallest that makes it the new one."""
    old_words, new_words = _WORD.findall(line.indent + line.text), _WORD.findall(new)
    head = _common(old_words, new_words)
    tail = _common(old_words[head:][::-1], new_words[head:][::-1])
    start = _start(source, number) + (number == 0 and source.text.startswith("\ufeff"))
    start += len("".join(old_words[:head]))
    old = "".join(old_words[head : len(old_words) - tail])
    return source.edit(start, start + len(old), "".join(new_words[head : len(new_words) - tail]))


def _common(first: list[str], second: list[str]) -> int:
    return next(
        (index for index, (a, b) in enumerate(zip(first, second, strict=False)) if a != b), min(len(first), len(second))
    )
