"""Match the grades of a gradebook with the rows of an LMS file: only pairs that are unambiguous in both directions."""

from collections.abc import Sequence
from dataclasses import dataclass

from grader.classroom.lms.grades import LmsGrade
from grader.classroom.lms.preflight import Preflight, RowNote
from grader.classroom.matching import OF_RECORDS, People, clues_of, numbers_of
from grader.classroom.students import Student

_MAX_NAMED = 5


@dataclass(frozen=True, slots=True)
class LmsStudent:
    """A student in an LMS file: the number of the row, the name in messages, and the data in the row."""

    row: int
    who: str
    student: Student
    aliases: tuple[str, ...] = ()


def match_rows(students: Sequence[LmsStudent], grades: Sequence[LmsGrade], preflight: Preflight) -> dict[int, LmsGrade]:
    """Return the grades by row number, and report the others in `preflight`.

    A submission that is not on the roster is matched by LMS ids only: its name was written by a student.
    """
    rows = People(clues_of(student.student, student.aliases) for student in students)
    ours = People(clues_of(grade.student) if grade.is_on_roster else numbers_of(grade.student) for grade in grades)
    row_of = [rows.find(clues, OF_RECORDS) for clues in ours.clues]
    found: dict[int, LmsGrade] = {}
    left = set(range(len(grades)))
    for index, clues in enumerate(rows.clues):
        student, match = students[index], ours.find(clues, OF_RECORDS)
        if match.only is not None and row_of[match.only].only == index:
            found[student.row] = grades[match.only]
            left.discard(match.only)
        elif len(match.people) > 1 or any(index in row_of[grade].people for grade in match.people):
            left.difference_update(match.people)
            names = [repr(grades[grade].who) for grade in match.people[:_MAX_NAMED]]
            could_be = f"could be any of {', '.join(names)}"
            why = could_be if len(match.people) > 1 else f"{names[0]} could be this row or another one"
            preflight.ambiguous.append(RowNote(student.row, student.who, why))
        else:
            why = "no student of the gradebook has this id, address or name"
            preflight.unknown.append(RowNote(student.row, student.who, why))
    preflight.missing += (
        RowNote(0, grades[index].who, "has a grade, but no row in the file")
        for index in sorted(left)
        if grades[index].total is not None
    )
    return found
