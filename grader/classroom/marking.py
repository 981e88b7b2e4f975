"""Marks by hand: what a person says of a criterion, kept beside what the checks say, never instead of it."""

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from decimal import Decimal, InvalidOperation

from grader.classroom.gradebook import Gradebook
from grader.classroom.standings import Standing, Standings
from grader.classroom.work import UNITS
from grader.errors import InputError
from grader.grading.report import Result
from grader.grading.rubric import Criterion, Rubric
from grader.robot.names import did_you_mean

TAKEN_BACK = "-"  # in place of points: what the check says counts again


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
    if not points.is_finite() or points * UNITS % 1:
        raise InputError(f"points are a number from 0 to {most}, with at most 4 decimals, not {text!r}")
    if not 0 <= points <= criterion.points:
        raise InputError(f"{criterion.id} is worth 0 to {most} points, not {text.strip()}")
    return points


def criterion_of(rubric: Rubric, name: str) -> Criterion:
    """The criterion of this id; raises InputError."""
    known = {criterion.id: criterion for criterion in rubric.criteria}
    if name not in known:
        raise InputError(f"the rubric {rubric.id} has no criterion {name!r}{did_you_mean(name, known)}")
    return known[name]


def mark(book: Gradebook, standing: Standing, criterion: Criterion, points: Decimal | None, by: str, why: str) -> None:
    """Add a mark to a student's newest result; raises InputError for one who has handed in nothing."""
    if standing.result is None:
        raise InputError(f"{standing.student.key} has handed in nothing that could be marked")
    units = None if points is None else int(points * UNITS)
    row = (standing.id, criterion.id, units, why, by, datetime.now(UTC).isoformat(timespec="seconds"), standing.result)
    with book.complaining():
        book.connection.execute("PRAGMA synchronous = FULL")  # a person's word outlives a power cut
    with book.transaction():
        book.connection.execute(
            "INSERT INTO mark (student, criterion, points, comment, author, at, result) VALUES (?, ?, ?, ?, ?, ?, ?)",
            row,
        )


def pending(standings: Standings, criterion: str = "") -> Iterator[Pending]:
    """What a person still has to decide, one criterion after the other, so that like is marked beside like.

    Of hand-ins that could not be graded at all nothing is asked: that is not a question of points.
    """
    rubric = standings.newest_rubric()
    for position, each in enumerate(rubric.criteria):
        if criterion in ("", each.id):
            yield from _pending_of(standings, rubric, position)


def _pending_of(standings: Standings, rubric: Rubric, position: int) -> Iterator[Pending]:
    name = rubric.criteria[position].id
    query = (
        "SELECT key FROM grade WHERE verdict = 'graded' AND rubric = ? AND substr(signs, ?, 1) = '?' AND NOT EXISTS"
        " (SELECT 1 FROM ruling WHERE ruling.student = grade.id AND ruling.criterion = ?) ORDER BY key"
    )
    keys = [str(row[0]) for row in standings.book.rows(query, rubric.sha256, position + 1, name)]
    for key in keys:
        standing = standings.find(key)
        found = next((each for each in standings.report(standing).results if each.criterion.id == name), None)
        if found is not None and found.is_open:  # nobody has decided it meanwhile
            yield Pending(standing, found)
