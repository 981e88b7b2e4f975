"""The result of grading one submission, as plain data that fits a process boundary and a row of the gradebook."""

from collections.abc import Mapping
from decimal import Decimal
from typing import Literal, NamedTuple

from grader.checks.outcome import Status
from grader.grading.rubric import Rubric

Verdict = Literal["graded", "unreadable", "errored", "unchanged"]
UNITS_PER_POINT = 10_000  # the gradebook stores points as integers, so that SQL adds them exactly
STATUS_LETTERS: dict[Status, str] = {"passed": "p", "failed": "f", "skipped": "s", "pending": "?", "errored": "!"}
NOT_GRADED = "-"
SETTLED = "c"  # not passed, but no points lost: failed because of an earlier mistake alone, or adjusted
EARNED = {"p": 1, SETTLED: 1, "f": 0, "s": 0}  # the share of the points, by the letter of a decided criterion


class GradingResult(NamedTuple):
    """The result of one submission. `statuses` has a letter for each criterion of the rubric; points are in ten-thousandths.

    `failures` is JSON, see `Failure`. `undecided` says why most of the undecided automatic points need manual grading; `urdf` and
    `robot` are the hashes of the URDF and of its normal form.
    """

    key: str
    verdict: Verdict
    digest: str
    fingerprint: str
    score: int = 0
    out_of: int = 0
    pending: int = 0
    statuses: str = ""
    failures: str = "[]"
    record: bytes = b""
    reason: str = ""
    undecided: str = ""
    urdf: str = ""
    robot: str = ""


def graded_on(rubric: Rubric, statuses: str) -> tuple[str, ...]:
    """Return the parts that a submission was graded on, given the statuses of its criteria."""
    rows = zip(rubric.criteria, statuses, strict=True)
    graded = {criterion.part for criterion, status in rows if status != NOT_GRADED}
    return tuple(part.id for part in rubric.parts if part.id in graded)


def criterion_points(rubric: Rubric, statuses: str, marks: Mapping[str, Decimal]) -> dict[str, Decimal | None]:
    """Return the points of each criterion: the manual mark, else the automatic points, else None.

    Manual marks of adjusted criteria do not count.
    """
    automatic = (
        criterion.points * EARNED[status] if status in EARNED else None
        for criterion, status in zip(rubric.criteria, statuses, strict=True)
    )
    return {
        criterion.id: points if criterion.adjustment is not None else marks.get(criterion.id, points)
        for criterion, points in zip(rubric.criteria, automatic, strict=True)
    }
