"""Find out whose the rows of a grade file are: ids decide over names, and nothing is guessed."""

from collections import defaultdict
from collections.abc import Sequence
from decimal import Decimal
from typing import NamedTuple

from grader.classroom.roster import Student, plain

_Clues = tuple[frozenset[str], ...]  # the id in the LMS, other ids, the name


class ClassGrade(NamedTuple):
    """A student's grade: without a total `why_open` says why; `comment` is HTML from `comment_html`."""

    student: Student
    total: Decimal | None = None
    is_excused: bool = False
    why_open: str = ""
    comment: str = ""


def match_rows(
    rows: Sequence[Student], students: Sequence[Student], lms: str
) -> tuple[dict[int, int], dict[int, list[int]]]:
    """Return the student of each row that fits only one, and no other row does; of other rows who it could be."""
    theirs, ours = [_clues(row, lms) for row in rows], [_clues(student, lms) for student in students]
    students_of, rows_of = _fitting(theirs, ours), _fitting(ours, theirs)
    found = {row: some[0] for row, some in enumerate(students_of) if some and [rows_of[at] for at in some] == [[row]]}
    free = {*range(len(students))} - {*found.values()}
    return found, {row: [at for at in some if at in free] for row, some in enumerate(students_of) if row not in found}


def _clues(student: Student, lms: str) -> _Clues:
    """Return what identifies a student; without a place on the roster the id in the LMS alone, for names are chosen."""
    kinds: list[Sequence[str]] = [(getattr(student, lms.lower(), ""),), (), ()]
    if student.is_on_roster:
        kinds[1:] = (student.key, student.login, student.sis, student.email), (student.name,)
    return tuple(frozenset(map(plain, words)) - {""} for words in kinds)


def _fitting(some: Sequence[_Clues], others: Sequence[_Clues]) -> list[list[int]]:
    """Return for each of some the others with its most reliable clue that is known, and no other id in the LMS."""
    having = defaultdict[tuple[int, str], list[int]](list)
    for at, clues in enumerate(others):
        for kind, words in enumerate(clues):
            for word in words:
                having[kind, word].append(at)
    found = []
    for clues in some:
        kinds = ({at for word in words for at in having.get((kind, word), ())} for kind, words in enumerate(clues))
        fitting = next(filter(None, kinds), set[int]())
        found.append([at for at in sorted(fitting) if not (clues[0] and others[at][0] and clues[0] != others[at][0])])
    return found
