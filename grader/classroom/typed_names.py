"""What a grader types: a student, a criterion, points.

A student is found by id, login, address, number, full name, or some words of a name. The search never chooses
between several students: a manual mark must not go to the wrong one.
"""

import re
import unicodedata
from collections.abc import Iterable, Mapping, Sequence
from decimal import Context, Decimal
from functools import lru_cache
from typing import Any, TypeVar

from grader.errors import InputError
from grader.grading.criterion import Criterion
from grader.grading.rubric import Rubric
from grader.names import did_you_mean
from grader.text import enumerated, format_points, printable, quoted

S = TypeVar("S")  # a Student

_FINEST = Decimal("0.0001")  # points, as in rubrics
_MAX_LISTED = 10
_NUMBER = re.compile(r"\s*[+-]?(?=[.,]?[0-9])[0-9]{0,40}(?:[.,][0-9]{0,40})?(?:[eE][+-]?[0-9]{1,9})?\s*")
_WORD = re.compile(r"[^\s\-_,]+")  # of a name: Ash-Birch is two
_IGNORED = str.maketrans("", "", "&<>\"`|':\\/\u200e\u200f")  # an LMS removes them from names; marks of direction
_LETTERS = str.maketrans({"ø": "o", "ł": "l", "đ": "d", "ð": "d", "þ": "th", "æ": "ae", "œ": "oe", "ı": "i"})
_UMLAUTS = str.maketrans({"ä": "ae", "ö": "oe", "ü": "ue", "ø": "oe", "å": "aa"})


class NotCountedError(InputError):
    """A mark for no student or criterion of the class, or above the maximum."""


def find_typed(students: Sequence[S], name: str, advice: str) -> S:
    """Return the only student whom a typed name may mean.

    Raises InputError: if several students match, it lists them; else similar names; else it ends with `advice`.
    """
    everyone = _clues(tuple(students))
    word, wanted = same_case(name), _words(name)
    found: list[S] = [one for one, ids, words in everyone if word in ids or (wanted and wanted <= words)]
    if len(found) == 1:
        return found[0]
    if found:
        raise InputError(f"{name!r} is ambiguous: it may be {_listed(found)}; use one of these ids")
    changed = as_number(name, tuple(one.key for one, *_ in everyone))
    ways = [without_accents(word) for word in wanted]  # Muller and Mueller are similar to Müller
    similar = [one for one, _, words in everyone if one.key in changed or (ways and _has_all(words, ways))]
    guess = f"; did you mean {'one of ' * (len(similar) > 1)}{_listed(similar)}?" if similar else ""
    some = {word for one, *_ in everyone for word in (one.key, one.login, one.name)}
    raise InputError(f"there is no student {name!r} in the gradebook{guess or did_you_mean(name, some) or advice}")


@lru_cache(maxsize=1)  # a file of marks names many
def _clues(students: tuple[Any, ...]) -> list[tuple[Any, set[str], set[str]]]:
    """Return each student with the ids, and the words of the name."""
    clues = []
    for one in students:
        words = (one.key, one.login, one.sis, one.canvas, one.moodle, one.email, one.email.partition("@")[0])
        ids = {same_case(word) for word in (*words, *getattr(one, "aliases", ())) if word}
        clues.append((one, ids, _words(one.name or one.key)))
    return clues


def _has_all(words: Iterable[str], wanted: Iterable[Sequence[str]]) -> bool:
    known = {way for word in words for way in without_accents(word)}
    return not any(map(known.isdisjoint, wanted))


def _listed(students: Sequence[Any]) -> str:
    """Return the ids and names of students, at most _MAX_LISTED."""
    shown = [f"{one.key!r} ({printable(one.name)})" if one.name else repr(one.key) for one in students[:_MAX_LISTED]]
    more = len(students) - len(shown)
    return ", ".join(shown) + (f" and {more} more" if more else "")


def same_case(word: str) -> str:
    """Normalise an id or a word: compatible characters, case, spaces and the encoding of accents."""
    return " ".join(unicodedata.normalize("NFKC", unicodedata.normalize("NFKC", word).casefold()).split())


def _words(name: str) -> set[str]:
    return {*_WORD.findall(same_case(name).translate(_IGNORED))}


def without_accents(word: str) -> tuple[str, ...]:
    """Return a normalised word without accents, and with an umlaut as two letters: muller and mueller."""
    composed = unicodedata.normalize("NFC", word)
    written_out = (composed.translate(_LETTERS), composed.translate(_UMLAUTS).translate(_LETTERS))
    return tuple(
        "".join(letter for letter in unicodedata.normalize("NFKD", text) if not unicodedata.combining(letter))
        for text in written_out
    )


def known(noun: str, cell: str, names: Mapping[str, Any]) -> str:
    """Return the student or criterion in a cell; raises NotCountedError, or InputError for a changed cell."""
    if not cell:
        raise InputError(f"the row names no {noun}")
    if cell not in names and (changed := as_number(cell, tuple(names))):
        meant = enumerated([*map(repr, changed)], 10, "or")
        raise InputError(f"{noun} {cell!r} may be {meant}, changed by a spreadsheet: correct it")
    if cell not in names:
        raise NotCountedError(f"there is no {noun} {quoted(cell)}")
    return cell


def as_number(cell: str, names: tuple[str, ...]) -> list[str]:
    """Return the names that a spreadsheet may have changed into a number: 0012 into 12, 123456 into 1.2E+05."""
    if (number := number_in(cell)) is None:
        return []
    rounded = Context(prec=len(number.as_tuple().digits), traps=[])
    return [name for name, value in _numbers(names) if name != cell and rounded.plus(value) == number]


@lru_cache(maxsize=2)
def _numbers(names: tuple[str, ...]) -> list[tuple[str, Decimal]]:
    return [(name, number) for name in names if (number := number_in(name)) is not None]


def number_in(text: str) -> Decimal | None:
    """Return the number in a text, with a decimal point or comma, or None."""
    return Decimal(text.replace(",", ".")) if _NUMBER.fullmatch(text) else None


def read_points(text: str, name: str, most: Decimal) -> Decimal:
    """Return the points in a text, from 0 to `most`; raises InputError, which names what they are for and the range."""
    points, text = number_in(text), text.strip()
    if points is not None and not 0 <= points <= most:
        kind = NotCountedError if points > most else InputError
        raise kind(f"{name} is worth 0 to {format_points(most)} points, not {text}")
    if points is None or points != points.quantize(_FINEST):
        raise InputError(f"points are a number from 0 to {format_points(most)}, with at most 4 decimals, not {text!r}")
    return abs(points)  # -0 is 0


def criterion_of(rubric: Rubric, name: str) -> Criterion:
    """Return the criterion with this id; raises InputError."""
    criteria = {criterion.id: criterion for criterion in rubric.criteria}
    if name not in criteria:
        guess = did_you_mean(name, criteria)
        raise InputError(f"the rubric {rubric.id} has no criterion {name!r}{guess} (`{rubric.shown_by}` lists them)")
    return criteria[name]
