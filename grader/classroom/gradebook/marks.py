"""Marks by hand: what a person says of a criterion, kept beside what the checks say, never instead of it."""

from dataclasses import dataclass
from datetime import UTC, datetime
from decimal import Decimal, InvalidOperation
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades, StudentGrade
from grader.classroom.gradebook.result import UNITS_PER_POINT
from grader.classroom.gradebook.stored import storable
from grader.errors import InputError
from grader.grading.report import Result
from grader.grading.rubric import Criterion, Rubric
from grader.names import did_you_mean

_UNIT = Decimal(1) / UNITS_PER_POINT
TAKEN_BACK = "-"  # in place of points: what the check says counts again


class Mark(NamedTuple):
    """A mark in the gradebook: points (None where it took an earlier mark back), who gave it (empty without `--by`), why and when."""

    id: int
    points: Decimal | None
    by: str
    comment: str
    at: str


class NewerMarkError(Exception):
    """Somebody has marked a criterion since it was shown."""

    def __init__(self, mark: Mark) -> None:
        super().__init__()
        self.mark = mark


class QueuedCriterion(NamedTuple):
    """A criterion of a student, by their key, that waited for a person when it was looked up."""

    key: str
    criterion: str


@dataclass(frozen=True, slots=True)
class PendingCriterion:
    """One criterion of one student that a person still has to decide; `newest` is the id of its newest mark, 0 if it has none."""

    standing: StudentGrade
    result: Result
    newest: int = 0


def read_points(text: str, criterion: Criterion) -> Decimal | None:
    """Points that a person gives, None for `-`, which takes a mark back; raises InputError, which says what there may be."""
    if text.strip() == TAKEN_BACK:
        return None
    most = format(criterion.points.normalize(), "f") if criterion.points else "0"
    try:
        points = Decimal(text.strip().replace(",", "."))
    except InvalidOperation:
        points = Decimal("NaN")
    if points.is_finite() and not 0 <= points <= criterion.points:
        raise InputError(f"{criterion.id} is worth 0 to {most} points, not {text.strip()}")
    if not points.is_finite() or points != points.quantize(_UNIT):
        raise InputError(f"points are a number from 0 to {most}, with at most 4 decimals, not {text!r}")
    return points


def criterion_of(rubric: Rubric, name: str) -> Criterion:
    """The criterion of this id; raises InputError."""
    known = {criterion.id: criterion for criterion in rubric.criteria}
    if name not in known:
        guess = did_you_mean(name, known)
        raise InputError(f"the rubric {rubric.id} has no criterion {name!r}{guess} ({rubric.shown_by} lists them)")
    return known[name]


def mark(
    book: Gradebook,
    standing: StudentGrade,
    criterion: Criterion,
    points: Decimal | None,
    by: str,
    why: str,
    *,
    shown: int | None = None,
) -> Mark | None:
    """Add a mark to a student's newest result; return the mark that was the newest one before, if there was one.

    `by` is the name that reports show; the account is kept for the audit only. `shown` is the id of the newest mark that the
    person has seen, 0 for none: where there is a newer one nothing is written, and NewerMarkError holds it. Without `shown`
    the mark is added whatever is there. Raises InputError for a student who has handed in nothing.
    """
    if standing.result is None:
        raise InputError(f"{standing.student.key} has handed in nothing that could be marked")
    units = None if points is None else int(points * UNITS_PER_POINT)
    at = datetime.now(UTC).isoformat(timespec="seconds")
    name = storable(by)
    row = (standing.id, criterion.id, units, storable(why), name or storable(account()), name, at, standing.result)
    with book.complaining():
        book.connection.execute("PRAGMA synchronous = FULL")  # a person's word outlives a power cut
    with book.transaction():
        before = newest_mark(book, standing.id, criterion.id)
        if before is not None and shown is not None and before.id != shown:
            raise NewerMarkError(before)
        book.connection.execute(
            "INSERT INTO mark (student, criterion, points, comment, author, signed, at, result)"
            " VALUES (?, ?, ?, ?, ?, ?, ?, ?)",
            row,
        )
    return before


def newest_mark(book: Gradebook, student: int, criterion: str) -> Mark | None:
    """Return the newest mark of a student's criterion, also one that took an earlier one back."""
    query = (
        "SELECT id, points, signed, comment, at FROM mark WHERE student = ? AND criterion = ? ORDER BY id DESC LIMIT 1"
    )
    for identity, units, signed, comment, at in list(book.rows(query, student, criterion)):
        return Mark(identity, None if units is None else Decimal(units) / UNITS_PER_POINT, signed, comment, at)
    return None


def account() -> str:
    """Return the account of who is at the keyboard, as the system knows it."""
    import getpass

    try:
        return getpass.getuser()
    except (OSError, KeyError, ImportError):  # as in a container without accounts
        return ""


def manual_grading_queue(standings: Grades, criterion: str = "") -> list[QueuedCriterion]:
    """What a person still has to decide, one criterion after the other, so that like is marked beside like.

    Of hand-ins that could not be read nothing is asked: that is not a question of points.
    """
    rubric = standings.newest_rubric()
    return [
        QueuedCriterion(str(key), each.id)
        for position, each in enumerate(rubric.criteria)
        if criterion in ("", each.id)
        for (key,) in standings.book.rows(_WAITING, rubric.sha256, position + 1, each.id)
    ]


_WAITING = (
    "SELECT key FROM grade WHERE verdict <> 'unreadable' AND rubric = ? AND substr(signs, ?, 1) = '?' AND NOT EXISTS"
    " (SELECT 1 FROM ruling WHERE ruling.student = grade.id AND ruling.criterion = ?) ORDER BY key"
)


def pending_criterion(standings: Grades, queued: QueuedCriterion) -> PendingCriterion | None:
    """What is to be decided, as it stands now; None where somebody has decided it meanwhile."""
    standing = standings.find(queued.key)
    newest = newest_mark(
        standings.book, standing.id, queued.criterion
    )  # first, so that no later one is taken for shown
    results = standings.report(standing).results
    found = next((each for each in results if each.criterion.id == queued.criterion and each.is_open), None)
    return PendingCriterion(standing, found, newest.id if newest is not None else 0) if found is not None else None
