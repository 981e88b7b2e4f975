"""What a grader types: a student, a criterion, points.

The search never chooses between several students: a manual mark must not go to the wrong one.
"""

import re
from collections.abc import Collection, Sequence
from decimal import Context, Decimal
from functools import lru_cache
from typing import NamedTuple

from grader.base.errors import InputError
from grader.base.names import did_you_mean
from grader.base.patterns import on_use
from grader.base.text import enumerated, format_points, printable, quoted
from grader.classroom.roster.roster import Student, plain
from grader.lab.rubric.criterion import Criterion
from grader.lab.rubric.rubric import Rubric

_FINEST = Decimal("0.0001")  # points, as in rubrics
_MAX_LISTED = 10
_NUMBER = on_use(
    r"\s*[+-]?(?=[.,]?[0-9])[0-9]{0,40}(?:[.,][0-9]{0,40})?(?:[eE][+-]?[0-9]{1,9})?\s*"
)


class NotCountedError(InputError):
    """A mark for no student or criterion of the class, or above the maximum."""


def find_typed(students: Sequence[Student], name: str, advice: str) -> Student:
    """Return the only student whom a typed name may mean.

    It is an id, address, number or whole name; else a login, or some words of the name.

    Raises InputError: if several students match, it lists them; else similar names; else it ends
    with `advice`.
    """
    word = plain(name)
    words_of_name = word.split() or [""]
    exact = []
    similar = []
    for clues in _clues(tuple(students)):
        if word in clues.exact:
            exact.append(clues.student)
        elif word in clues.logins or clues.words.issuperset(words_of_name):
            similar.append(clues.student)
    fitting = exact or similar
    if len(fitting) == 1:
        return fitting[0]
    if fitting:
        names = [f" ({printable(student.name)})" if student.name else "" for student in fitting]
        labels = [
            f"{student.key!r}{own_name}" for student, own_name in zip(fitting, names, strict=True)
        ]
        raise InputError(
            f"{name!r} is ambiguous: it may be {enumerated(labels, _MAX_LISTED, 'or')}; use "
            "one of these ids"
        )
    raise InputError(
        f"there is no student {name!r} in the gradebook{_guess(students, name) or advice}"
    )


def _guess(students: Sequence[Student], name: str) -> str:
    """Return the question which student was meant; empty if none has a similar name."""
    keys = tuple(student.key for student in students)
    changed = enumerated(map(repr, as_number(name, keys)), _MAX_LISTED, "or")
    if changed:
        return f"; did you mean {changed}?"
    digits = re.sub(r"\D", "", name)  # with another digit, it is the id of another student
    candidates = set()
    for student in students:
        for word in (student.key, student.login, student.name):
            if re.sub(r"\D", "", word) == digits:
                candidates.add(word)
    return did_you_mean(name, candidates)


class _Clues(NamedTuple):
    """What may be typed for a student."""

    student: Student
    exact: set[str]  # the ids of the roster, the address and the whole name
    logins: set[str]
    words: set[str]  # of the name


@lru_cache(maxsize=1)  # a file of marks names many
def _clues(students: Sequence[Student]) -> list[_Clues]:
    """Return what may be typed for each student."""
    clues = []
    for student in students:
        user = student.email.partition("@")[0]
        ids = (student.key, student.sis, student.canvas, student.moodle)
        exact = {plain(word) for word in (*ids, student.email, student.name)}
        logins = {plain(word) for word in (student.login, user, *student.aliases)}
        words = set(plain(student.shown_name).split())
        clues.append(_Clues(student, exact - {""}, logins - {""}, words))
    return clues


def known(noun: str, cell: str, names: Collection[str]) -> str:
    """Return the student or criterion in a cell.

    Raises NotCountedError, or InputError for a changed cell.
    """
    if cell in names:
        return cell
    if not cell:
        raise InputError(f"the row names no {noun}")
    if changed := as_number(cell, tuple(names)):
        meant = enumerated(map(repr, changed), _MAX_LISTED, "or")
        raise InputError(f"{noun} {cell!r} may be {meant}, changed by a spreadsheet: correct it")
    raise NotCountedError(f"there is no {noun} {quoted(cell)}")


def as_number(cell: str, names: Sequence[str]) -> list[str]:
    """Return the names that a spreadsheet may have changed into a number.

    For example, it changes 0012 into 12, and 123456 into 1.2E+05.
    """
    if (number := number_in(cell)) is None:
        return []
    rounded = Context(prec=len(number.as_tuple().digits), traps=[])
    return [
        name for name, value in _numbers(names) if name != cell and rounded.plus(value) == number
    ]


@lru_cache(maxsize=2)
def _numbers(names: Sequence[str]) -> list[tuple[str, Decimal]]:
    return [(name, number) for name in names if (number := number_in(name)) is not None]


def number_in(text: str) -> Decimal | None:
    """Return the number in a text, with a decimal point or comma, or None."""
    if _NUMBER.fullmatch(text):
        return Decimal(text.replace(",", "."))
    return None


def read_points(text: str, name: str, most: Decimal) -> Decimal:
    """Return the points in a text, from 0 to `most`.

    Raises InputError, which names what they are for and the range.
    """
    points = number_in(text)
    text = text.strip()
    if points is not None and not 0 <= points <= most:
        kind = NotCountedError if points > most else InputError
        raise kind(f"{name} is worth 0 to {format_points(most)} points, not {text}")
    if points is None or points != points.quantize(_FINEST):
        raise InputError(
            f"points are a number from 0 to {format_points(most)}, with at most 4 decimals, "
            f"not {text!r}"
        )
    return abs(points)  # -0 is 0


def find_criterion(rubric: Rubric, name: str) -> Criterion:
    """Return the criterion with this id; raises InputError."""
    criteria = {criterion.id: criterion for criterion in rubric.criteria}
    if name not in criteria:
        guess = did_you_mean(name, criteria)
        raise InputError(
            f"the rubric {rubric.id} has no criterion {name!r}{guess} (`{rubric.shown_by}` "
            "lists them)"
        )
    return criteria[name]
