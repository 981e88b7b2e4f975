"""Everyone's current grades as other programs take them: plain CSV, Canvas' gradebook, Moodle's worksheet."""

from collections.abc import Iterator
from decimal import Decimal
from pathlib import Path
from typing import NamedTuple

from grader.classroom.lms.canvas import fill_gradebook
from grader.classroom.lms.feedback import Remark, feedback_html
from grader.classroom.lms.grades import Grade
from grader.classroom.lms.moodle import fill_worksheet
from grader.classroom.lms.preflight import Filled, Preflight
from grader.classroom.lms.spreadsheet import write_table
from grader.classroom.lms.tables import SIZE_LIMIT
from grader.classroom.standings import Standing, Standings
from grader.grading.report import Ruling
from grader.grading.rubric import Rubric
from grader.report.text import printable
from grader.submission.files import printable_path, read_capped

_ABOUT = ("id", "name", "email", "login", "sis", "status", "score", "max_score", "pending", "late_days", "late_points")
Cell = str | int | Decimal | None


def grades_csv(standings: Standings) -> str:
    """A row for everyone: the grade, what being late costs, and the points of each criterion, empty where nobody has decided."""
    rubric = standings.newest_rubric()
    header = [*_ABOUT, "total", "not_final_because", *(criterion.id for criterion in rubric.criteria)]
    return write_table(header, (_row(standings, each, rubric) for each in standings.all()))


def _row(standings: Standings, standing: Standing, rubric: Rubric) -> list[Cell]:
    student = standing.student
    about: list[Cell] = [student.key, student.name, student.email, student.login, student.sis, standing.verdict]
    if standing.result is None:
        return [*about, *[None] * 6, standing.why_not_final, *[None] * len(rubric.criteria)]
    grade: list[Cell] = [standing.score, standing.out_of, standing.pending, standing.late.days, standing.late.points]
    points = standings.points(standing)
    return [*about, *grade, standing.total, standing.why_not_final, *(points.get(each.id) for each in rubric.criteria)]


def lms_grades(standings: Standings, *, feedback: bool, pending_as_zero: bool) -> Iterator[Grade]:
    """Everyone's grade for an LMS. One that is not final has no total, unless what still waits counts as nothing."""
    for standing in standings.all():
        reason = standing.why_not_final
        waits_only = standing.verdict in ("graded", "errored") and not standing.faults and standing.pending > 0
        if reason and not (waits_only and pending_as_zero):
            yield Grade(standing.student, None, "", reason)
            continue
        text = _feedback(standings, standing) if feedback else ""
        yield Grade(standing.student, standing.total, text)


class Filling(NamedTuple):
    """An LMS's file, and how it is to be filled."""

    file: Path
    column: str
    feedback_column: str
    pending_as_zero: bool


def fill(is_moodle: bool, standings: Standings, filling: Filling) -> Filled:
    """Fill Moodle's worksheet, or Canvas' gradebook; raises InputError."""
    data = read_capped(filling.file, SIZE_LIMIT, advice="")
    shown, rubric = printable_path(filling.file), standings.newest_rubric()
    grades = list(lms_grades(standings, feedback=is_moodle, pending_as_zero=filling.pending_as_zero))
    if is_moodle:
        columns = {"column": filling.column, "feedback_column": filling.feedback_column}
        return fill_worksheet(data, grades, out_of=rubric.points, shown=shown, **columns)
    wanted = (rubric.id, rubric.title)
    return fill_gradebook(data, grades, out_of=rubric.points, wanted=wanted, column=filling.column, shown=shown)


def _feedback(standings: Standings, standing: Standing) -> str:
    report = standings.report(standing)
    remarks = [
        Remark(each.criterion.title, each.points, each.criterion.points, _said(each.outcome.message, each.ruling))
        for each in report.results
        if each.points < each.criterion.points or (each.ruling is not None and each.ruling.comment)
    ]
    if standing.late.points:
        remarks.append(Remark("Handed in late", standing.late.points, Decimal(0), standing.late.words))
    return feedback_html(standing.total, report.max_score, remarks)


def _said(message: str, ruling: Ruling | None) -> str:
    return message if ruling is None else ruling.comment


def preflight_lines(found: Preflight) -> Iterator[str]:
    """What filling an LMS file does, in lines for a person."""
    yield f"column {found.column!r}: {found.filled} filled, {found.unchanged} the same already"
    for conflict in found.conflicts:
        yield printable(f"row {conflict.row}, {conflict.who}: was {conflict.was}, becomes {conflict.becomes}")
    for what, left in (
        ("without a grade", found.ungraded),
        ("in the file, but not in the gradebook", found.unknown),
        ("in the gradebook, but not in the file", found.missing),
        ("could be several", found.ambiguous),
        ("comment of a person, kept", found.kept_feedback),
    ):
        for each in left:
            row = f"row {each.row}, " if each.row else ""
            yield printable(f"{what}: {row}{each.who}: {each.why}")
    yield from map(printable, found.warnings)
