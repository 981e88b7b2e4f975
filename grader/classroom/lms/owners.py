"""Find out whose the rows of a grade file are: ids decide over names, and nothing is guessed."""

from collections import defaultdict
from collections.abc import Sequence
from decimal import Decimal
from typing import NamedTuple

from grader.classroom.lms.grade_file import StudentRow
from grader.classroom.roster import Student, plain
from grader.text import named, people_text

UNKNOWN = "in the file, but not in the class"
MISSING = "in the class, but not in the file"
AMBIGUOUS = "ambiguous"
_MAX_NAMED = 5
_Clues = tuple[frozenset[str], ...]  # the id in the LMS, other ids, the name


class ClassGrade(NamedTuple):
    """A student's grade: without a total `why_open` says why; `comment` is HTML from `comment_html`."""

    student: Student
    total: Decimal | None = None
    is_excused: bool = False
    why_open: str = ""
    comment: str = ""


class Note(NamedTuple):
    """What is to be known of a row or student; `kind` begins the message."""

    kind: str
    who: str
    why: str


def match_rows(
    rows: Sequence[StudentRow], grades: Sequence[ClassGrade], lms: str
) -> tuple[dict[int, ClassGrade], list[Note]]:
    """Return the grades by row number, of rows and students that fit each other only, and a note on each other one."""
    theirs = [_clues(row.student, lms) for row in rows]
    ours = [_clues(grade.student, lms) for grade in grades]
    grades_of, rows_of = _fitting(theirs, ours), _fitting(ours, theirs)
    names = [named(grade.student.key, grade.student.name) for grade in grades]
    found, notes, claimed = dict[int, ClassGrade](), list[Note](), set[int]()
    for index, row in enumerate(rows):
        some = [at for at in grades_of[index] if len(grades_of[index]) > 1 or index in rows_of[at]]
        claimed.update(some)
        if [rows_of[at] for at in some] == [[index]]:
            found[row.row.number] = grades[some[0]]
        elif some:
            could = people_text([names[at] for at in some], _MAX_NAMED)
            why = f"could be {could}" if some[1:] else f"{could} could be this row or another one"
            notes.append(Note(AMBIGUOUS, row.who, why))
        elif not row.is_test:
            notes.append(Note(UNKNOWN, row.who, "no student of the class matches this id, address or name"))
    for at, grade in enumerate(grades):
        if at not in claimed and (grade.total is not None or grade.is_excused):
            what = "is excused" if grade.is_excused else "has a grade"
            notes.append(Note(MISSING, names[at], f"{what}, but no row in the file"))
    return found, notes


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
