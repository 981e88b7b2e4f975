"""Match the rows of a grade file with students: ids decide over names, and nothing is guessed."""

from collections import defaultdict
from collections.abc import Sequence
from decimal import Decimal
from typing import NamedTuple

from grader.classroom.roster import Student, plain


class ClassGrade(NamedTuple):
    """A student's grade: without a total `why_open` says why; `comment` is HTML from `comment_html`."""

    student: Student
    total: Decimal | None = None
    is_excused: bool = False
    why_open: str = ""
    comment: str = ""


def match_rows(rows: Sequence[Student], students: Sequence[Student], lms: str) -> dict[int, int]:
    """Return the student of each row that fits only one, whom no other row fits."""
    theirs, ours = [_clues(row, lms) for row in rows], [_clues(student, lms) for student in students]
    students_of, rows_of = _fitting(theirs, ours), _fitting(ours, theirs)
    return {row: some[0] for row, some in enumerate(students_of) if [rows_of[at] for at in some] == [[row]]}


def _clues(student: Student, lms: str) -> list[set[str]]:
    """Return what identifies a student, the most reliable first: the id in the LMS, other ids, the name.

    Of a student who is not on the roster it is the id in the LMS alone, for who submits chooses the names.
    """
    words = (student.key, student.login, student.sis, student.email), (student.name,)
    kinds = [(getattr(student, lms.lower(), ""),), *(words if student.is_on_roster else ((), ()))]
    return [{*map(plain, kind)} - {""} for kind in kinds]


def _fitting(some: Sequence[list[set[str]]], others: Sequence[list[set[str]]]) -> list[list[int]]:
    """Return for each of some the others with its most reliable clue that is known, and no other id in the LMS."""
    having = defaultdict[tuple[int, str], set[int]](set)
    for at, clues in enumerate(others):
        for kind, words in enumerate(clues):
            for word in words:
                having[kind, word].add(at)
    found = []
    for clues in some:
        kinds = (set[int]().union(*(having[kind, word] for word in words)) for kind, words in enumerate(clues))
        fitting = sorted(next(filter(None, kinds), ()))
        found.append([at for at in fitting if clues[0] == others[at][0] or not (clues[0] and others[at][0])])
    return found
