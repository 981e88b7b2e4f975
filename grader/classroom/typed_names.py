"""What a grader types: a student, a criterion, points.

The search never chooses between several students: a manual mark must not go to the wrong one.
"""

import re
from collections.abc import Mapping, Sequence
from decimal import Context, Decimal
from functools import lru_cache
from typing import Any, TypeVar

from grader.classroom.roster import plain
from grader.errors import InputError
from grader.grading.criterion import Criterion
from grader.grading.rubric import Rubric
from grader.names import did_you_mean
from grader.text import enumerated, format_points, printable, quoted

S = TypeVar("S")  # a Student

_FINEST = Decimal("0.0001")  # points, as in rubrics
_MAX_LISTED = 10
_NUMBER = re.compile(r"\s*[+-]?(?=[.,]?[0-9])[0-9]{0,40}(?:[.,][0-9]{0,40})?(?:[eE][+-]?[0-9]{1,9})?\s*")


class NotCountedError(InputError):
    """A mark for no student or criterion of the class, or above the maximum."""


def find_typed(students: Sequence[S], name: str, advice: str) -> S:
    """Return the only student whom a typed name may mean: an id, login, address or number, or some words of the name.

    Raises InputError: if several students match, it lists them; else similar names; else it ends with `advice`.
    """
    everyone = _clues(tuple(students))
    word = plain(name)
    found: list[Any] = [one for one, ids, words in everyone if word and (word in ids or words.issuperset(word.split()))]
    if len(found) == 1:
        only: S = found[0]
        return only
    if found:
        shown = [f"{one.key!r} ({printable(one.name)})" if one.name else repr(one.key) for one in found]
        raise InputError(
            f"{name!r} is ambiguous: it may be {enumerated(shown, _MAX_LISTED, 'or')}; use one of these ids"
        )
    changed = enumerated([*map(repr, as_number(name, tuple(one.key for one, *_ in everyone)))], _MAX_LISTED, "or")
    some = {word for one, *_ in everyone for word in (one.key, one.login, one.name)}
    guess = f"; did you mean {changed}?" if changed else did_you_mean(name, some) or advice
    raise InputError(f"there is no student {name!r} in the gradebook{guess}")


@lru_cache(maxsize=1)  # a file of marks names many
def _clues(students: tuple[Any, ...]) -> list[tuple[Any, set[str], set[str]]]:
    """Return each student with the ids, and the words of the name."""
    clues = []
    for one in students:
        words = (one.key, one.login, one.sis, one.canvas, one.moodle, one.email, one.email.partition("@")[0])
        ids = {plain(word) for word in (*words, *getattr(one, "aliases", ())) if word}
        clues.append((one, ids, {*plain(one.name or one.key).split()}))
    return clues


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
