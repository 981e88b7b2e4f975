"""Texts that may make a regular expression slow, by its own syntax tree: parts of it, repeated.

A part that can be repeated without end is repeated, after what comes before it; so is what begins a match and never
ends one.
"""

import re
from collections.abc import Callable, Iterable, Iterator
from re import _constants as op  # type: ignore[attr-defined]
from re import _parser  # type: ignore[attr-defined]
from typing import Any

_REPEATS = (op.MAX_REPEAT, op.MIN_REPEAT, op.POSSESSIVE_REPEAT)
_LETTERS = "a0 _-.:/\"'<>(){}[]=,#$*\\\n\tA"  # of a class, the first few that are in it
_OF_A_CLASS = 3
_MANY = 8  # a part that may be repeated more often than this is repeated without end
_MOST = 60  # texts of a pattern


def pumped(pattern: "re.Pattern[Any]", size: int) -> list[str]:
    """Return texts of about a size, each of one part that is repeated; the same for each size."""
    text = pattern.pattern
    flags = pattern.flags & ~re.UNICODE if isinstance(text, bytes) else pattern.flags
    tree = _parser.parse(text, flags & ~re.DEBUG)
    units = dict.fromkeys(_units(tree, pattern.flags))
    texts = []
    for before, unit in [*units][:_MOST]:
        texts.append(before + unit * (size // len(unit)) + "\x01")
    return texts


def _units(tree: Any, flags: int) -> Iterator[tuple[str, str]]:
    """Yield what comes before a part, and the part."""
    whole = _sample(tree, flags)
    for unit in (whole, whole[:-1]):
        if unit:
            yield "", unit
    for before, body in _repeated(tree, flags, ""):
        for unit in body:
            yield before, unit
            yield "", unit
            if before:
                yield "", before
                yield "", before + unit


def _repeated(tree: Iterable[Any], flags: int, before: str) -> Iterator[tuple[str, list[str]]]:
    """Yield what comes before each part that is repeated, and what the part may be."""
    for kind, value in tree:
        for inner in _inner(kind, value):
            yield from _repeated(inner, flags, before)
        if kind in _REPEATS and value[1] > _MANY:
            yield before, _samples(value[2], flags)
        before += _sample([(kind, value)], flags)


def _inner(kind: Any, value: Any) -> list[Any]:
    """Return the parts of a part."""
    if kind in _REPEATS:
        return [value[2]]
    if kind is op.BRANCH:
        return [*value[1]]
    if kind is op.SUBPATTERN:
        return [value[3]]
    if kind is op.ATOMIC_GROUP:
        return [value]
    if kind in (op.ASSERT, op.ASSERT_NOT):
        return [value[1]]
    return []


def _samples(tree: Any, flags: int) -> list[str]:
    """Return some texts that a part matches: of a class several letters, of a choice each branch."""
    if len(tree) == 1:
        [(kind, value)] = tree
        if kind in (op.IN, op.ANY, op.NOT_LITERAL):
            return _letters(kind, value, flags)[:_OF_A_CLASS]
        if kind is op.BRANCH:
            return [text for branch in value[1] for text in _samples(branch, flags)]
        if kind is op.SUBPATTERN:
            return _samples(value[3], flags)
    return [text for text in (_sample(tree, flags),) if text]


def _sample(tree: Iterable[Any], flags: int) -> str:
    """Return a short text that a part matches, but for what it looks back or ahead at."""
    pieces = []
    for kind, value in tree:
        if kind is op.LITERAL:
            pieces.append(chr(value))
        elif kind in (op.IN, op.ANY, op.NOT_LITERAL):
            pieces += _letters(kind, value, flags)[:1]
        elif kind is op.BRANCH:
            pieces.append(_sample(value[1][0], flags))
        elif kind in _REPEATS:
            pieces.append(_sample(value[2], flags) * max(value[0], 0))
        elif kind in (op.SUBPATTERN, op.ATOMIC_GROUP):
            pieces.append(_sample(_inner(kind, value)[0], flags))
    return "".join(pieces)


def _letters(kind: Any, value: Any, flags: int) -> list[str]:
    """Return letters that a class contains."""
    letters = []
    for letter in _LETTERS:
        if kind is op.ANY:
            matches = letter != "\n" or bool(flags & re.DOTALL)
        elif kind is op.NOT_LITERAL:
            matches = ord(letter) != value
        else:
            matches = _is_in(letter, value)
        if matches:
            letters.append(letter)
    for what, given in value if kind is op.IN else ():
        if what is op.LITERAL and len(letters) < _OF_A_CLASS:
            letters.append(chr(given))
        elif what is op.RANGE and len(letters) < _OF_A_CLASS:
            letters.append(chr(given[0]))
    return letters


_CATEGORIES: dict[Any, Callable[[str], bool]] = {
    op.CATEGORY_DIGIT: str.isdigit,
    op.CATEGORY_SPACE: str.isspace,
    op.CATEGORY_WORD: lambda letter: letter.isalnum() or letter == "_",
}


def _is_in(letter: str, members: Iterable[Any]) -> bool:
    is_negated, is_listed = False, False
    for what, given in members:
        if what is op.NEGATE:
            is_negated = True
        elif what is op.LITERAL:
            is_listed |= ord(letter) == given
        elif what is op.RANGE:
            is_listed |= given[0] <= ord(letter) <= given[1]
        elif what is op.CATEGORY:
            name = str(given).replace("NOT_", "")
            test = next(test for known, test in _CATEGORIES.items() if str(known) == name)
            is_listed |= test(letter) != ("NOT_" in str(given))
    return is_listed != is_negated
