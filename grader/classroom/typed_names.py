"""What a grader types: a student, a criterion, points.

A student is found by id, login, address, number, full name, or some words of a name. The search never chooses
between several students: a manual mark must not go to the wrong one.
"""

import re
import unicodedata
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from decimal import Decimal, InvalidOperation
from functools import lru_cache

from grader.classroom.matching import LMS_IDS, Clue, People, claims_of, clues_of, plain_name
from grader.classroom.students import Student
from grader.errors import InputError
from grader.grading.criterion import Criterion
from grader.grading.rubric import Rubric
from grader.names import did_you_mean
from grader.text import format_points, printable

_FINEST = Decimal("0.0001")  # points, as the gradebook stores them
_TYPED = (*LMS_IDS, Clue.ANY_CASE, Clue.LOCAL_PART, Clue.NAME)
_MAX_LISTED = 10
_MAX_SUGGESTED_FROM = 5_000  # students whose names are compared with a misspelt one
_WORD = re.compile(r"[^\s\-]+")  # of a name: Ash-Birch is two
_LETTERS = str.maketrans({"ø": "o", "ł": "l", "đ": "d", "ð": "d", "þ": "th", "æ": "ae", "œ": "oe", "ı": "i"})
_UMLAUTS = str.maketrans({"ä": "ae", "ö": "oe", "ü": "ue", "ø": "oe", "å": "aa"})


def find_typed(students: Sequence[Student], name: str, advice: str) -> Student:
    """Return the only student whom a typed name may mean.

    Raises InputError: if several students match, it lists them; else similar names; else it ends with `advice`.
    """
    people = _people(tuple(students))
    found = [students[index] for index in _find_people(people, name)]
    if len(found) == 1:
        return found[0]
    if found:
        raise InputError(f"{name!r} is ambiguous: it may be {_students_text(found)}; use one of these ids")
    guess = ""
    # Names that differ in accents: Muller and Mueller are similar to Müller.
    if similar := [students[index] for index in sorted(_with_words(people, name, without_accents))]:
        guess = f"; did you mean {'' if len(similar) == 1 else 'one of '}{_students_text(similar)}?"
    some = students[:_MAX_SUGGESTED_FROM]
    guess = guess or did_you_mean(name, {word for one in some for word in (one.key, one.login, one.name)})
    raise InputError(f"there is no student {name!r} in the gradebook{guess or advice}")


@lru_cache(maxsize=1)  # a file of marks names many
def _people(students: tuple[Student, ...]) -> People:
    return People(clues_of(one if one.name else replace(one, name=one.key)) for one in students)


def _find_people(people: People, name: str) -> list[int]:
    """Return the positions of all people whom a typed name may mean, in any case."""
    claims = {**claims_of(Student(name, name)), Clue.CANVAS: (name,), Clue.MOODLE: (name,)}
    matches = (people.find({kind: claims.get(kind, ())}, (kind,)) for kind in _TYPED)
    found = {index for match in matches for index in match.people}
    return sorted(found | _with_words(people, name, lambda word: (word,)))


def _with_words(people: People, name: str, spellings: Callable[[str], Iterable[str]]) -> set[int]:
    """Return the positions of people whose name has all words of a name, in one of the spellings of both."""
    wanted = [set(spellings(word)) for word in _WORD.findall(plain_name(name))]
    found = set()
    for index, clues in enumerate(people.clues) if wanted else ():
        for plain in clues.get(Clue.NAME, ()):
            words = {word for part in _WORD.findall(plain) for word in spellings(part)}
            if not any(map(words.isdisjoint, wanted)):
                found.add(index)
    return found


def without_accents(word: str) -> tuple[str, ...]:
    """Return a normalised word without accents, and with an umlaut as two letters: muller and mueller."""
    composed = unicodedata.normalize("NFC", word)
    written_out = (composed.translate(_LETTERS), composed.translate(_UMLAUTS).translate(_LETTERS))
    return tuple(
        "".join(letter for letter in unicodedata.normalize("NFKD", text) if not unicodedata.combining(letter))
        for text in written_out
    )


def _students_text(students: Sequence[Student]) -> str:
    """Return the ids and names of students, at most _MAX_LISTED."""
    shown = [f"{one.key!r} ({printable(one.name)})" if one.name else repr(one.key) for one in students]
    more = len(shown) - _MAX_LISTED
    return f"{', '.join(shown[:_MAX_LISTED])}{f' and {more} more' if more > 0 else ''}"


def read_points(text: str, name: str, most: Decimal) -> Decimal:
    """Return the points in a text, from 0 to `most`; raises InputError, which names what they are for and the range."""
    text = text.strip()
    try:
        points = Decimal("NaN" if "_" in text else text.replace(",", "."))
    except InvalidOperation:
        points = Decimal("NaN")
    if points.is_finite() and not 0 <= points <= most:
        raise InputError(f"{name} is worth 0 to {format_points(most)} points, not {text}")
    if not points.is_finite() or points != points.quantize(_FINEST):
        raise InputError(f"points are a number from 0 to {format_points(most)}, with at most 4 decimals, not {text!r}")
    return points


def criterion_of(rubric: Rubric, name: str) -> Criterion:
    """Return the criterion with this id; raises InputError."""
    criteria = {criterion.id: criterion for criterion in rubric.criteria}
    if name not in criteria:
        guess = did_you_mean(name, criteria)
        raise InputError(f"the rubric {rubric.id} has no criterion {name!r}{guess} (`{rubric.shown_by}` lists them)")
    return criteria[name]
