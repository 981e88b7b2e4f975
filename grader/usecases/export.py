"""Everyone's current grades as other programs take them: plain CSV, Canvas' gradebook, Moodle's worksheet."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from decimal import Decimal
from pathlib import Path
from typing import NamedTuple

from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.student_grade import StudentGrade
from grader.classroom.lms.canvas import fill_gradebook
from grader.classroom.lms.feedback import FeedbackItem, feedback_html, feedback_items
from grader.classroom.lms.grades import LmsGrade
from grader.classroom.lms.moodle import fill_worksheet
from grader.classroom.lms.preflight import Filled, Preflight, RowNote
from grader.classroom.lms.spreadsheet import write_table
from grader.classroom.lms.tables import SIZE_LIMIT
from grader.files.reading import read_capped
from grader.grading.rubric import Rubric
from grader.text import printable, printable_path

_ABOUT = ("id", "name", "email", "login", "sis", "status", "score", "max_score", "pending", "late_days", "late_points")
_MOST_NAMED, _MOST_LINES = 3, 50
Cell = str | int | Decimal | None


def grades_csv(standings: Grades) -> str:
    """A row for everyone: the grade, what being late costs, and the points of each criterion, empty where nobody has decided."""
    rubric = standings.newest_rubric()
    header = [*_ABOUT, "total", "not_final_because", *(criterion.id for criterion in rubric.criteria)]
    return write_table(header, (_row(standings, each, rubric) for each in standings.all()))


def _row(standings: Grades, standing: StudentGrade, rubric: Rubric) -> list[Cell]:
    student = standing.student
    about: list[Cell] = [student.key, student.name, student.email, student.login, student.sis, standing.verdict]
    if standing.result is None:
        return [*about, *[None] * 6, standing.why_not_final, *[None] * len(rubric.criteria)]
    grade: list[Cell] = [standing.score, standing.out_of, standing.pending, standing.late.days, standing.late.points]
    points = standings.points(standing)
    return [*about, *grade, standing.total, standing.why_not_final, *(points.get(each.id) for each in rubric.criteria)]


def lms_grades(standings: Grades, *, feedback: bool, pending_as_zero: bool) -> Iterator[LmsGrade]:
    """Everyone's grade for an LMS. One that is not final has no total, unless what still waits counts as nothing."""
    for standing in standings.all():
        reason = standing.why_not_final
        waits_only = (
            standing.verdict in ("graded", "errored") and not replace(standing, pending=Decimal(0)).why_not_final
        )
        if reason and not (waits_only and pending_as_zero):
            yield LmsGrade(standing.student, None, "", reason, standing.is_on_roster is not False)
            continue
        text = _feedback(standings, standing) if feedback else ""
        yield LmsGrade(standing.student, standing.total, text, is_on_roster=standing.is_on_roster is not False)


class Filling(NamedTuple):
    """An LMS's file, and how it is to be filled."""

    file: Path
    column: str
    feedback_column: str
    pending_as_zero: bool
    any_maximum: bool


def fill(is_moodle: bool, standings: Grades, filling: Filling) -> Filled:
    """Fill Moodle's worksheet, or Canvas' gradebook; raises InputError."""
    data = read_capped(filling.file, SIZE_LIMIT, advice="")
    shown, rubric = printable_path(filling.file), standings.newest_rubric()
    grades = list(lms_grades(standings, feedback=is_moodle, pending_as_zero=filling.pending_as_zero))
    out_of, column, any_maximum = rubric.points, filling.column, filling.any_maximum
    if is_moodle:
        return fill_worksheet(
            data,
            grades,
            out_of=out_of,
            column=column,
            feedback_column=filling.feedback_column,
            any_maximum=any_maximum,
            shown=shown,
        )
    wanted = (rubric.id, rubric.title)
    return fill_gradebook(
        data, grades, out_of=out_of, rubric_names=wanted, column=column, any_maximum=any_maximum, shown=shown
    )


def _feedback(standings: Grades, standing: StudentGrade) -> str:
    report = standings.report(standing)
    remarks = list(feedback_items(report.results))
    if standing.late.points:
        remarks.append(FeedbackItem("Handed in late", standing.late.points, Decimal(0), standing.late.reason))
    return feedback_html(standing.total, report.max_score, remarks)


def preflight_lines(found: Preflight) -> Iterator[str]:
    """What filling an LMS file does, in lines for a person; no kind of them floods the screen."""
    yield f"column {found.column!r}: {found.filled} filled, {found.unchanged} the same already"
    yield from _capped(
        "grades that were others",
        [f"row {each.row}, {each.who}: was {each.was}, becomes {each.becomes}" for each in found.conflicts],
    )
    yield from _capped("without a grade", _by_reason("without a grade", found.ungraded))
    for what, left in (
        ("in the file, but not in the gradebook", found.unknown),
        ("in the gradebook, but not in the file", found.missing),
        ("could be several", found.ambiguous),
        ("comment of a person, kept", found.kept_feedback),
    ):
        rows = [f"row {each.row}, " if each.row else "" for each in left]
        yield from _capped(what, [f"{what}: {row}{each.who}: {each.why}" for row, each in zip(rows, left, strict=True)])
    yield from map(printable, found.warnings)


def _by_reason(what: str, left: Sequence[RowNote]) -> list[str]:
    """A line for each reason, in the order of the rows, with how many it holds for and the first of them."""
    names: dict[str, list[str]] = {}
    for each in left:
        names.setdefault(each.why, []).append(each.who)
    return [f"{what}, {why}: {len(whose)} ({_listed(whose)})" for why, whose in names.items()]


def _listed(names: Sequence[str]) -> str:
    shown = list(names[:_MOST_NAMED])
    more = [f"... and {len(names) - len(shown)} more"] if len(names) > len(shown) else []
    return ("; " if any("," in name for name in shown) else ", ").join([*shown, *more])


def _capped(what: str, lines: Sequence[str]) -> Iterator[str]:
    yield from map(printable, lines[:_MOST_LINES])
    if len(lines) > _MOST_LINES:
        yield f"{what}: and {len(lines) - _MOST_LINES} more"
