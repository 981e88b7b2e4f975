"""The result of grading one submission, as plain data that fits a process boundary and the rows of the gradebook."""

import json
import zlib
from collections.abc import Container, Mapping
from decimal import Decimal
from math import isfinite
from typing import Literal, NamedTuple

from grader.checks.manual import MANUAL_CHECKS
from grader.checks.outcome import Outcome
from grader.grading.record import to_record
from grader.grading.report import Report, Result
from grader.grading.rubric import Rubric
from grader.text import cut

GradingVerdict = Literal["graded", "unreadable", "errored", "unchanged"]
UNITS_PER_POINT = 10_000  # the gradebook stores points as integers, so that SQL adds them exactly
_MAX_RECORD = 64 * 1024**2  # bytes
_MAX_CAUSE = 200  # characters
_DIGITS = 6  # of a measured value
_LEVEL = 3  # of zlib: with a dictionary, as fast as level 1 and a third smaller


OutcomeRow = tuple[int, str, int | None, str, str | None]


class StoredOutcome(NamedTuple):
    """A criterion that did not pass. The fields are columns of the table `outcome`; points are in ten-thousandths."""

    position: int
    status: str
    points: int | None = None
    cause: str = ""
    measured: str | None = None


class GradingResult(NamedTuple):
    """The result of one submission; points are in ten-thousandths. `outcomes` lacks the criteria that passed.

    `outcomes` are plain tuples, which are sent to another process much faster. `parts` are ids between spaces. `urdf`
    and `robot` are the hashes of the URDF and of its normal form, `forms` other forms of the work as JSON.
    """

    key: str
    verdict: GradingVerdict
    digest: str
    fingerprint: str
    parts: str = ""
    score: int = 0
    out_of: int = 0
    pending: int = 0
    outcomes: tuple[OutcomeRow, ...] = ()
    record: bytes = b""
    reason: str = ""
    urdf: str = ""
    robot: str = ""
    forms: str = ""

    def with_report(self, report: Report, dictionary: bytes) -> "GradingResult":
        """Return the result with the points and outcomes of a report, which is compressed with a dictionary."""
        graded = {result.criterion.part for result in report.results}
        return self._replace(
            parts=parts_text(report.rubric, graded),
            score=units_of(report.score),
            out_of=units_of(report.max_score),
            pending=units_of(report.pending),
            outcomes=_outcomes(report),
            record=compressed(to_record(report).encode(), dictionary),
        )


def parts_text(rubric: Rubric, ids: Container[str]) -> str:
    """Return the ids of parts as the gradebook stores them: between spaces, in the order of the rubric."""
    return " ".join(part.id for part in rubric.parts if part.id in ids)


def storable(text: str) -> str:
    """Return text that SQLite can store: lone surrogates are written as escapes."""
    return text.encode("utf-8", "backslashreplace").decode()


def units_of(points: Decimal) -> int:
    """Return points in ten-thousandths."""
    return int(points * UNITS_PER_POINT)


def points_from_units(units: int) -> Decimal:
    """Return ten-thousandths as points."""
    return Decimal(units) / UNITS_PER_POINT


def compressed(record: bytes, dictionary: bytes) -> bytes:
    """Return a compressed record; `decompressed` needs the same dictionary, empty for none."""
    packer = zlib.compressobj(_LEVEL, zdict=dictionary)
    return packer.compress(record) + packer.flush()


def decompressed(data: bytes, dictionary: bytes) -> str:
    """Return a record that was compressed with a dictionary; raises ValueError for one that is damaged."""
    unpacker = zlib.decompressobj(zdict=dictionary)
    try:
        record = unpacker.decompress(data, _MAX_RECORD)
    except zlib.error:
        raise ValueError from None
    if not unpacker.eof:
        raise ValueError
    return record.decode()


def criterion_points(
    rubric: Rubric, outcomes: Mapping[int, StoredOutcome], marks: Mapping[str, Decimal]
) -> dict[str, Decimal | None]:
    """Return the points of each criterion: the manual mark, else the automatic points, else None.

    Manual marks of adjusted criteria do not count.
    """
    points: dict[str, Decimal | None] = {}
    for row in rubric.criteria:
        outcome = outcomes.get(row.position)
        if row.id in marks and row.adjustment is None:
            points[row.id] = marks[row.id]
        elif outcome is None:
            points[row.id] = row.points
        else:
            points[row.id] = points_from_units(outcome.points) if outcome.points is not None else None
    return points


def _outcomes(report: Report) -> tuple[OutcomeRow, ...]:
    rows = [_outcome(result) for result in report.results if result.outcome.status != "passed"]
    if len(report.results) < len(report.rubric.criteria):
        graded = {result.criterion.id for result in report.results}
        rows += [(row.position, "ungraded", None, "", None) for row in report.rubric.criteria if row.id not in graded]
    return tuple(rows)


def _outcome(result: Result) -> OutcomeRow:
    criterion, outcome = result.criterion, result.outcome
    status, position = outcome.status, criterion.position
    if result.is_adjusted or result.carried:
        return position, "adjusted" if result.is_adjusted else "carried", units_of(result.points), "", None
    if status == "failed":
        return position, status, 0, _cause(outcome.mistake or outcome.message), _measurement(outcome)
    if status == "pending" and criterion.check.function not in MANUAL_CHECKS:
        return position, status, None, _cause(outcome.mistake or f"{criterion.check.name} could not be decided"), None
    return position, status, 0 if status == "skipped" else None, "", None


def _cause(words: str) -> str:
    return storable(cut(words, _MAX_CAUSE))


def _measurement(outcome: Outcome) -> str | None:
    """Return the measured and the expected numbers with the tolerance as JSON; None if no numbers were compared."""
    measured, expected = _numbers(outcome.measured), _numbers(outcome.expected)
    if outcome.tolerance is None or not measured:
        return None
    compared = {"numbers": (*measured, *expected), "tolerance": outcome.tolerance, "unit": outcome.unit or ""}
    return json.dumps(compared)


def _numbers(value: object) -> tuple[float, ...]:
    """Return a measured number or numbers, rounded; empty for anything else."""
    values = value if isinstance(value, tuple) else (value,)
    numbers = tuple(round(item, _DIGITS) for item in values if isinstance(item, float | int) and isfinite(item))
    return numbers if len(numbers) == len(values) else ()
