"""Who in an LMS file is which student of ours: by the surest key that both sides know, and never by a guess."""

import re
import unicodedata
from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from grader.classroom.lms.grades import Grade
from grader.classroom.lms.preflight import Left
from grader.classroom.students import Student

Keys = tuple[frozenset[str], ...]
"""What someone is known by, the surest first: for each step the spellings that count, none where it is not known."""


@dataclass(frozen=True, slots=True)
class Person:
    """Someone in an LMS file: the number of their row, what messages call them, and what they are known by."""

    row: int
    who: str
    keys: Keys


@dataclass(frozen=True, slots=True)
class Join:
    """The grades by row number, and what found no partner or more than one."""

    matched: dict[int, Grade]
    unknown: tuple[Left, ...]
    missing: tuple[Left, ...]
    ambiguous: tuple[Left, ...]


def join(people: Sequence[Person], grades: Sequence[Grade], keys_of: Callable[[Student], Keys]) -> Join:
    """Each row's grade. At every step a pair counts only if neither of the two has another partner there, matched or not.

    The first step is the system's own number for a user: where both sides know it and it differs, nothing weaker joins them.
    """
    ours = [keys_of(grade.student) for grade in grades]
    rows, students = set(range(len(people))), set(range(len(grades)))
    matched: dict[int, Grade] = {}
    ambiguous: list[Left] = []
    for step in range(max(map(len, ours), default=0)):
        settled = _settled(_pairs(people, ours, step), rows, students)
        for row, (partners, is_sure) in settled.items():
            if is_sure:
                matched[people[row].row] = grades[partners[0]]
            else:
                ambiguous.append(_ambiguous(people[row], [grades[each].who for each in partners]))
        rows -= settled.keys()
        students -= {student for partners, _ in settled.values() for student in partners}
    unknown = [people[row] for row in sorted(rows)]
    missing = [grades[each] for each in sorted(students) if grades[each].total is not None]
    return Join(
        matched,
        tuple(Left(each.row, each.who, "nobody of ours has this number, address or name") for each in unknown),
        tuple(Left(0, each.who, "has a grade, but no row in the file") for each in missing),
        tuple(sorted(ambiguous, key=lambda left: left.row)),
    )


def _settled(pairs: Sequence[tuple[int, int]], rows: set[int], students: set[int]) -> dict[int, tuple[list[int], bool]]:
    """The open rows that have a partner among the open students: all their partners, and whether it can only be the one."""
    by_row, by_student = _partners(pairs), _partners([(student, row) for row, student in pairs])
    return {
        row: (partners, len(partners) == 1 and len(by_student[partners[0]]) == 1)
        for row, partners in by_row.items()
        if row in rows and not students.isdisjoint(partners)
    }


def _pairs(people: Sequence[Person], ours: Sequence[Keys], step: int) -> list[tuple[int, int]]:
    """The rows and students who share a key of one step, and whose first keys do not contradict it."""
    known: dict[str, set[int]] = defaultdict(set)
    for student, keys in enumerate(ours):
        for key in keys[step]:
            known[key].add(student)
    pairs = {
        (row, student)
        for row, person in enumerate(people)
        for key in person.keys[step]
        for student in known.get(key, ())
    }
    return sorted(pair for pair in pairs if not _contradict(people[pair[0]].keys[0], ours[pair[1]][0]))


def _contradict(left: frozenset[str], right: frozenset[str]) -> bool:
    return bool(left and right and left.isdisjoint(right))


def _partners(pairs: Sequence[tuple[int, int]]) -> dict[int, list[int]]:
    found: dict[int, list[int]] = defaultdict(list)
    for left, right in pairs:
        found[left].append(right)
    return found


def _ambiguous(person: Person, names: Sequence[str]) -> Left:
    if len(names) == 1:
        return Left(person.row, person.who, f"{names[0]!r} could be this row or another one")
    return Left(person.row, person.who, "could be any of " + ", ".join(map(repr, names[:5])))


def spellings(*texts: str) -> frozenset[str]:
    """Numbers, logins and addresses as they are compared: without regard to case and to the spaces around them."""
    return frozenset(each.strip().casefold() for each in texts) - {""}


def full_names(text: str) -> frozenset[str]:
    """A name in the orders that it may be written in: "Doe, Jane" is also "Jane Doe"."""
    words = " ".join(unicodedata.normalize("NFKC", text).casefold().split())
    last, comma, first = (each.strip() for each in words.partition(","))
    return spellings(f"{last} {first}", f"{first} {last}") if comma else spellings(words)


def run_together(text: str) -> frozenset[str]:
    """A name as it stands in the file names of Canvas' bulk download: "Doe, Jane" as doejane; also as janedoe."""
    return spellings(*(re.sub(r"[\W_]", "", name) for name in full_names(text)))
