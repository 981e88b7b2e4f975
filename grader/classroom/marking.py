"""Marks by hand: what a person says of a criterion, kept beside what the checks say, never instead of it."""

from dataclasses import dataclass
from datetime import UTC, datetime
from decimal import Decimal, InvalidOperation
from typing import NamedTuple

from grader.classroom.gradebook import Gradebook
from grader.classroom.known import storable
from grader.classroom.standings import Standing, Standings
from grader.classroom.work import UNITS
from grader.errors import InputError
from grader.grading.report import Result
from grader.grading.rubric import Criterion, Rubric
from grader.robot.names import did_you_mean

_UNIT = Decimal(1) / UNITS
TAKEN_BACK = "-"  # in place of points: what the check says counts again


class Waiting(NamedTuple):
    """A criterion of a student, by their key, that waited for a person when it was looked up."""

    key: str
    criterion: str


@dataclass(frozen=True, slots=True)
class Pending:
    """One criterion of one student that a person still has to decide."""

    standing: Standing
    result: Result


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


def mark(book: Gradebook, standing: Standing, criterion: Criterion, points: Decimal | None, by: str, why: str) -> None:
    """Add a mark to a student's newest result; raises InputError for one who has handed in nothing."""
    if standing.result is None:
        raise InputError(f"{standing.student.key} has handed in nothing that could be marked")
    units = None if points is None else int(points * UNITS)
    at = datetime.now(UTC).isoformat(timespec="seconds")
    row = (standing.id, criterion.id, units, storable(why), storable(by), at, standing.result)
    with book.complaining():
        book.connection.execute("PRAGMA synchronous = FULL")  # a person's word outlives a power cut
    with book.transaction():
        book.connection.execute(
            "INSERT INTO mark (student, criterion, points, comment, author, at, result) VALUES (?, ?, ?, ?, ?, ?, ?)",
            row,
        )


def waiting(standings: Standings, criterion: str = "") -> list[Waiting]:
    """What a person still has to decide, one criterion after the other, so that like is marked beside like.

    Of hand-ins that could not be read nothing is asked: that is not a question of points.
    """
    rubric = standings.newest_rubric()
    return [
        Waiting(str(key), each.id)
        for position, each in enumerate(rubric.criteria)
        if criterion in ("", each.id)
        for (key,) in standings.book.rows(_WAITING, rubric.sha256, position + 1, each.id)
    ]


_WAITING = (
    "SELECT key FROM grade WHERE verdict <> 'unreadable' AND rubric = ? AND substr(signs, ?, 1) = '?' AND NOT EXISTS"
    " (SELECT 1 FROM ruling WHERE ruling.student = grade.id AND ruling.criterion = ?) ORDER BY key"
)


def pending(standings: Standings, waiting: Waiting) -> Pending | None:
    """What is to be decided, as it stands now; None where somebody has decided it meanwhile."""
    standing = standings.find(waiting.key)
    results = standings.report(standing).results
    found = next((each for each in results if each.criterion.id == waiting.criterion and each.is_open), None)
    return Pending(standing, found) if found is not None else None
