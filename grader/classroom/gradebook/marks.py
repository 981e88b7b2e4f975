"""Manual marks: the points that a person gives for a criterion, stored in addition to the automatic points."""

from dataclasses import dataclass
from datetime import UTC, datetime
from decimal import Decimal, InvalidOperation
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.result import UNITS_PER_POINT
from grader.classroom.gradebook.stored import storable
from grader.classroom.gradebook.student_grade import StudentGrade
from grader.errors import InputError
from grader.grading.report import Result
from grader.grading.rubric import Criterion, Rubric
from grader.names import did_you_mean
from grader.text import format_points

TAKE_BACK = "-"  # in place of points: the automatic result counts again


class Mark(NamedTuple):
    """A mark in the gradebook: points (None if it takes an earlier mark back), who gave it (empty without `--by`), why and when."""

    id: int
    points: Decimal | None
    by: str
    comment: str
    at: str


class AddedMark(NamedTuple):
    """The id of a new mark, and the newest mark before it, if there is one."""

    id: int
    before: Mark | None


class NewerMarkError(Exception):
    """Somebody has marked the criterion since it was shown."""

    def __init__(self, mark: Mark) -> None:
        super().__init__()
        self.mark = mark


class QueuedCriterion(NamedTuple):
    """A student's key and a criterion that needed manual grading when the queue was made."""

    key: str
    criterion: str


@dataclass(frozen=True, slots=True)
class QueuedResult:
    """A queued criterion in its current state, with its newest mark, which may take an earlier one back."""

    grade: StudentGrade
    result: Result
    mark: Mark | None = None

    @property
    def newest(self) -> int:
        """The id of the newest mark, 0 if there is none."""
        return self.mark.id if self.mark is not None else 0


def read_points(text: str, criterion: Criterion) -> Decimal | None:
    """Return the points in a text, None for `-`, which takes a mark back; raises InputError, which names the range."""
    if text.strip() == TAKE_BACK:
        return None
    maximum = format_points(criterion.points)
    try:
        points = Decimal(text.strip().replace(",", "."))
    except InvalidOperation:
        points = Decimal("NaN")
    if points.is_finite() and not 0 <= points <= criterion.points:
        raise InputError(f"{criterion.id} is worth 0 to {maximum} points, not {text.strip()}")
    if not points.is_finite() or points != points.quantize(Decimal(1) / UNITS_PER_POINT):
        raise InputError(f"points are a number from 0 to {maximum}, with at most 4 decimals, not {text!r}")
    return points


def criterion_of(rubric: Rubric, name: str) -> Criterion:
    """Return the criterion with this id; raises InputError."""
    criteria = {criterion.id: criterion for criterion in rubric.criteria}
    if name not in criteria:
        guess = did_you_mean(name, criteria)
        raise InputError(f"the rubric {rubric.id} has no criterion {name!r}{guess} (`{rubric.shown_by}` lists them)")
    return criteria[name]


def mark(
    book: Gradebook,
    grade: StudentGrade,
    criterion: Criterion,
    points: Decimal | None,
    by: str,
    why: str,
    *,
    shown: int | None = None,
    author: str = "",
) -> AddedMark:
    """Add a mark to a student's newest result.

    `points` are None to take the newest mark back; `by` is the name that reports show, `why` the comment. `shown` is the id of the
    newest mark that the person has seen, 0 for none: if there is a newer one, nothing is written and NewerMarkError holds it.
    `author` is the name for the audit, if it differs from `by`. Raises InputError for a student who has submitted nothing.
    """
    if grade.result is None:
        raise InputError(f"{grade.student.key} has submitted nothing that could be marked")
    units = None if points is None else int(points * UNITS_PER_POINT)
    at = datetime.now(UTC).isoformat(timespec="seconds")
    name = storable(by)
    row = (
        grade.id,
        criterion.id,
        units,
        storable(why),
        storable(author) or name or storable(account()),
        name,
        at,
        grade.result,
    )
    with book.input_errors():
        book.connection.execute("PRAGMA synchronous = FULL")  # a manual mark must survive a power cut
    with book.transaction():
        before = newest_mark(book, grade.id, criterion.id)
        if before is not None and shown is not None and before.id != shown:
            raise NewerMarkError(before)
        columns = "student, criterion, points, comment, author, grader_name, at, result"
        added = book.connection.execute(f"INSERT INTO mark ({columns}) VALUES (?, ?, ?, ?, ?, ?, ?, ?)", row)
    return AddedMark(int(added.lastrowid or 0), before)


def newest_mark(book: Gradebook, student: int, criterion: str) -> Mark | None:
    """Return the newest mark of a student's criterion, also one that takes an earlier one back."""
    query = "SELECT id, points, grader_name, comment, at FROM mark WHERE student = ? AND criterion = ?"
    row = book.first(f"{query} ORDER BY id DESC LIMIT 1", student, criterion)
    if row is None:
        return None
    identity, units, by, comment, at = row
    return Mark(identity, None if units is None else Decimal(units) / UNITS_PER_POINT, by, comment, at)


def account() -> str:
    """Return the name of the user account, or an empty string."""
    import getpass

    try:
        return getpass.getuser()
    except (OSError, KeyError, ImportError):  # as in a container without accounts
        return ""


def manual_grading_queue(grades: Grades, criterion: str = "") -> list[QueuedCriterion]:
    """Return what needs manual grading, one criterion after the other, so that similar answers are adjacent.

    Unreadable submissions are not in it: they need a fix, not points.
    """
    rubric = grades.newest_rubric()
    query = (
        "SELECT key FROM grade WHERE verdict <> 'unreadable' AND rubric = ? AND substr(statuses, ?, 1) = '?' AND NOT EXISTS"
        " (SELECT 1 FROM manual_mark WHERE student = grade.id AND criterion = ?) ORDER BY key"
    )
    return [
        QueuedCriterion(str(key), row.id)
        for position, row in enumerate(rubric.criteria)
        if criterion in ("", row.id)
        for (key,) in grades.book.rows(query, rubric.sha256, position + 1, row.id)
    ]


def queued_result(grades: Grades, queued: QueuedCriterion) -> QueuedResult | None:
    """Return a queued criterion in its current state; None if it is no longer graded."""
    grade = grades.find(queued.key)
    # Before the report, so that no later mark counts as shown.
    newest = newest_mark(grades.book, grade.id, queued.criterion)
    for result in grades.report(grade).results:
        if result.criterion.id == queued.criterion:
            return QueuedResult(grade, result, newest)
    return None


def reusable_comments(book: Gradebook, criterion: str, most: int) -> list[str]:
    """Return the comments of a criterion's marks, without duplicates, the most frequent first."""
    query = "SELECT comment FROM manual_mark WHERE criterion = ? AND comment <> '' GROUP BY comment"
    rows = book.rows(f"{query} ORDER BY count(*) DESC, min(id) LIMIT ?", criterion, most)
    return [str(comment) for (comment,) in rows]
