"""The grades of a gradebook and the rows of an LMS file brought together: only pairs that cannot be anybody else's."""

from collections.abc import Sequence
from dataclasses import dataclass

from grader.classroom.lms.grades import LmsGrade
from grader.classroom.lms.preflight import RowNote
from grader.classroom.matching import OF_RECORDS, Clues, Match, People, clues_of, numbers_of
from grader.classroom.students import Student

_MAX_NAMED = 5


@dataclass(frozen=True, slots=True)
class LmsStudent:
    """Somebody in an LMS file: the number of the row, what messages call them, and what the row says of them."""

    row: int
    who: str
    student: Student
    aliases: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Matches:
    """The grades by row number, and what has no match or more than one."""

    matched: dict[int, LmsGrade]
    unknown: tuple[RowNote, ...]
    missing: tuple[RowNote, ...]
    ambiguous: tuple[RowNote, ...]


def join(people: Sequence[LmsStudent], grades: Sequence[LmsGrade]) -> Matches:
    """Each row's grade. A pair counts only if each of the two finds the other and nobody else.

    A submission that is not on the roster is matched by the numbers of the LMS only: its name is what a student wrote.
    """
    rows = People(clues_of(each.student, each.aliases) for each in people)
    ours = People(_clues(each) for each in grades)
    row_of = [rows.find(clues, OF_RECORDS) for clues in ours.clues]
    grade_of = [ours.find(clues, OF_RECORDS) for clues in rows.clues]
    pairs = {row: found.only for row, found in enumerate(grade_of) if found.only is not None}
    matched = {row: grade for row, grade in pairs.items() if row_of[grade].only == row}
    unclear = {
        row: found for row, found in enumerate(grade_of) if row not in matched and _is_unclear(row, found, row_of)
    }
    left = (
        set(range(len(grades))) - set(matched.values()) - {each for found in unclear.values() for each in found.people}
    )
    return Matches(
        {people[row].row: grades[grade] for row, grade in matched.items()},
        tuple(
            RowNote(each.row, each.who, "no student of the gradebook has this number, address or name")
            for row, each in enumerate(people)
            if row not in matched and row not in unclear
        ),
        tuple(
            RowNote(0, grades[each].who, "has a grade, but no row in the file")
            for each in sorted(left)
            if grades[each].total is not None
        ),
        tuple(_ambiguous(people[row], [grades[each].who for each in found.people]) for row, found in unclear.items()),
    )


def _clues(grade: LmsGrade) -> Clues:
    return clues_of(grade.student) if grade.is_on_roster else numbers_of(grade.student)


def _is_unclear(row: int, found: Match, row_of: Sequence[Match]) -> bool:
    """Whether a row may be of several students, or one student's who may have another row as well."""
    return len(found.people) > 1 or any(row in row_of[each].people for each in found.people)


def _ambiguous(person: LmsStudent, names: Sequence[str]) -> RowNote:
    if len(names) == 1:
        return RowNote(person.row, person.who, f"{names[0]!r} could be this row or another one")
    return RowNote(person.row, person.who, "could be any of " + ", ".join(map(repr, names[:_MAX_NAMED])))
