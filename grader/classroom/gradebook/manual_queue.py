"""What needs manual grading in a class, and the marks and comments that it has so far."""

import re
from collections.abc import Collection
from dataclasses import dataclass
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.marks import Mark, newest_mark, newest_second
from grader.classroom.gradebook.result import storable
from grader.classroom.gradebook.student_grade import StudentGrade
from grader.classroom.matching import plain_group, plain_name
from grader.errors import InputError
from grader.grading.pictures import content_of, is_empty
from grader.grading.report import ManualMark, Result
from grader.text import enumerated

COMMENT_NUMBER = re.compile(r"#([0-9]{1,9})")  # how a person refers to an earlier comment
FILES = "\0"  # begins the content of an item that is not the words of an answer
_MAX_NAMED = 6
_STUDENTS = "SELECT key, section, marker FROM student"


class QueuedCriterion(NamedTuple):
    """A student's key and a criterion that needed manual grading when the queue was made."""

    key: str
    criterion: str


class ReviewScope(NamedTuple):
    """What a review shows: one criterion, one section, or with `mine` the students whose marker is `by`.

    `by` is the name that reports show. With `second`, second opinions are given on items that others have marked or
    that need manual grading; the marks of others are hidden. With `anonymous`, students have numbers instead of names.
    """

    criterion: str = ""
    by: str = ""
    section: str = ""
    mine: bool = False
    second: bool = False
    anonymous: bool = False


EVERYTHING = ReviewScope()


class QueuedMember(NamedTuple):
    """A student of an item, with the newest mark, which may withdraw an earlier one, and a `number` if anonymous."""

    grade: StudentGrade
    mark: Mark | None
    number: int | None = None

    @property
    def is_open(self) -> bool:
        """Return whether there are no points."""
        return self.mark is None or self.mark.points is None


@dataclass(frozen=True, slots=True)
class QueuedResult:
    """A queued criterion in its current state, with its newest mark; with `is_second` those of a second opinion.

    `content` is what results have in common that one mark serves, empty if there is nothing to read; `others` are the
    other students that are marked with this one.
    """

    first: QueuedMember
    result: Result
    is_second: bool = False
    content: str = ""
    others: tuple[QueuedMember, ...] = ()

    @property
    def members(self) -> tuple[QueuedMember, ...]:
        """All students that one mark serves."""
        return (self.first, *self.others)

    @property
    def grade(self) -> StudentGrade:
        """The grade of the first student, whose result is shown."""
        return self.first.grade

    @property
    def is_empty_group(self) -> bool:
        """Return whether it has several students without an answer."""
        return bool(self.others) and not self.content

    @property
    def newest(self) -> int:
        """The id of the newest mark of all members, 0 if there is none."""
        return max(one.mark.id if one.mark is not None else 0 for one in self.members)

    @property
    def is_open(self) -> bool:
        """Return whether a member still needs a mark, or a second opinion."""
        is_first_open = self.first.is_open if self.is_second else self.result.is_open
        return is_first_open or any(one.is_open for one in self.others)


_QUEUED = (
    "SELECT key FROM grade WHERE verdict <> 'unreadable' AND rubric = ?1 AND final IS NULL AND NOT is_excused AND "
)
_MARKED = "EXISTS (SELECT 1 FROM manual_mark WHERE student = grade.id AND criterion = ?3"
_IS_PENDING = "EXISTS (SELECT 1 FROM outcome WHERE result = grade.result AND position = ?2 AND status = 'pending')"
_OPEN = f"{_IS_PENDING} AND NOT {_MARKED}) AND ?4 = ?4 ORDER BY key"
# Items that another person has marked or that need manual grading, without a second opinion of this grader.
_OPEN_FOR_SECOND = f"""({_IS_PENDING} OR {_MARKED})) AND NOT {_MARKED} AND grader_name = ?4) AND NOT EXISTS (
    SELECT 1 FROM second_mark WHERE student = grade.id AND criterion = ?3 AND grader_name = ?4 AND points IS NOT NULL
    AND second_mark.digest = grade.digest
) ORDER BY key"""


def manual_grading_queue(grades: Grades, scope: ReviewScope = EVERYTHING) -> list[QueuedCriterion]:
    """Return what needs manual grading, one criterion after the other.

    Unreadable submissions are omitted: they need a fix, not points. So are students with a final mark or an excuse.
    Raises InputError for a section or marker that no student has.
    """
    rubric, students = grades.newest_rubric(), _students_of(grades.book, scope)
    query = _QUEUED + (_OPEN_FOR_SECOND if scope.second else _OPEN)
    return [
        QueuedCriterion(str(key), row.id)
        for row in rubric.criteria
        if scope.criterion in ("", row.id) and row.adjustment is None
        for (key,) in grades.book.rows(query, rubric.sha256, row.position, row.id, storable(scope.by))
        if key in students
    ]


def _students_of(book: Gradebook, scope: ReviewScope) -> set[str]:
    """Return the keys of the students in the section, and of the marker. Raises InputError if there is none."""
    rows = [(str(key), str(section), str(marker)) for key, section, marker in book.rows(_STUDENTS)]
    for column, wanted, plain in ((1, scope.section, plain_group), (2, scope.by if scope.mine else "", plain_name)):
        found = [row for row in rows if plain(row[column]) == plain(wanted)]
        if wanted and not found:
            name = ("section", "marker")[column - 1]
            known = sorted({row[column] for row in rows if row[column]})
            names = f"; the roster has {enumerated([repr(one) for one in known], _MAX_NAMED)}" if known else ""
            raise InputError(f"no student has the {name} {wanted!r} in the roster{names}")
        rows = found if wanted else rows
    return {row[0] for row in rows}


def queued_results(
    grades: Grades, grade: StudentGrade, criteria: Collection[str], scope: ReviewScope = EVERYTHING
) -> list[QueuedResult]:
    """Return queued criteria of a student in their current state, without those that are no longer graded."""
    if grade.result is None:
        return []
    # Before the report, so that no later mark counts as shown.
    members = {name: QueuedMember(grade, newest_of(grades.book, grade, name, scope)) for name in criteria}
    report = grades.report(grade)
    return [
        QueuedResult(
            member := members[result.criterion.id],
            _blind(result, member.mark) if scope.second else result,
            scope.second,
            content_of(result, report) or ("" if is_empty(result, report) else FILES + grade.files.digest),
        )
        for result in report.results
        if result.criterion.id in members
    ]


def newest_of(book: Gradebook, grade: StudentGrade, criterion: str, scope: ReviewScope) -> Mark | None:
    """Return the newest mark of a criterion, or the newest second opinion of this grader."""
    if scope.second:
        return newest_second(book, grade, criterion, scope.by)
    return newest_mark(book, grade.id, criterion)


def _blind(result: Result, own: Mark | None) -> Result:
    """Return a result with the second opinion of this grader instead of what others have marked."""
    points = own.points if own is not None else None
    given = ManualMark(points, own.by, own.comment) if own is not None and points is not None else None
    return result._replace(manual_mark=given, comment=None)


def reusable_comments(book: Gradebook, criterion: str, most: int, *, second: bool = False) -> list[str]:
    """Return the different comments of a criterion's marks, or of its second opinions, the most frequent first."""
    table = "second_mark" if second else "current_mark"
    query = f"SELECT comment FROM {table} WHERE criterion = ? AND comment <> '' GROUP BY comment"
    rows = book.rows(f"{query} ORDER BY count(*) DESC, min(id) LIMIT ?", criterion, most)
    return [str(comment) for (comment,) in rows]


def numbered_comments(book: Gradebook, criterion: str, *, second: bool = False) -> dict[int, str]:
    """Return all comments ever given on a criterion, or in second opinions on it, in the order of their first use.

    The numbers from 1 never change, because no mark is ever deleted.
    """
    query = "SELECT comment FROM mark WHERE criterion = ? AND comment <> '' AND (kind = 'second') = ? GROUP BY comment"
    rows = book.rows(f"{query} ORDER BY min(id)", criterion, second)
    return {number: str(comment) for number, (comment,) in enumerate(rows, 1)}
