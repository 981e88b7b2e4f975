"""Export the current grades: as CSV, JSON, or into a file of Canvas or Moodle."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from decimal import Decimal
from pathlib import Path
from typing import Any

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.student_grade import StudentGrade
from grader.classroom.lms.canvas import fill_gradebook
from grader.classroom.lms.feedback import FeedbackItem, feedback_html, feedback_items
from grader.classroom.lms.filling import Filled, Preflight, RowNote
from grader.classroom.lms.grades import LmsGrade
from grader.classroom.lms.moodle import fill_worksheet
from grader.classroom.lms.spreadsheet import write_table
from grader.classroom.lms.tables import SIZE_LIMIT
from grader.errors import GraderError
from grader.files.reading import read_capped
from grader.grading.criterion import Criterion
from grader.report.formats import OutputFormat
from grader.text import printable, printable_path
from grader.usecases import Warn
from grader.usecases.class_hints import ProgressDisplay
from grader.usecases.class_summary import class_summary, read_deadline, warn_of_due
from grader.usecases.exit_codes import ExitCode
from grader.usecases.export_pages import export_pages
from grader.usecases.writing import is_same_file, is_stdout, refuse_gradebook, refuse_symlinks, save_bytes

_STUDENT_COLUMNS = (
    "id", "name", "email", "login", "sis", "status", "score", "max_score", "pending", "late_days", "late_points",
)  # fmt: skip
_MAX_NAMED, _MAX_LINES = 3, 50
Cell = str | int | Decimal | None


@dataclass(frozen=True, slots=True)
class ExportRequest:
    """An export: its format, and for an LMS the file to fill in and how."""

    target: str
    gradebook: Path
    into: Path | None
    output: Path | None
    strict: bool
    due: str | None
    column: str
    feedback_column: str
    pending_as_zero: bool
    any_maximum: bool


def export(request: ExportRequest, progress: ProgressDisplay, warn: Warn) -> tuple[bytes, ExitCode]:
    """Export the grades to the output file; return what to print, and the exit code. Raises GraderError."""
    _refuse_files(request)
    if request.target == "html":
        export_pages(request.gradebook, request.output, request.due, progress, warn)
        return b"", ExitCode.PASSED
    with Gradebook(request.gradebook) as book:
        classes = tuple({run.source for run in book.runs()})
        if request.output is not None:
            refuse_symlinks(request.output, classes)
        grades = Grades(book, read_deadline(request.due))
        if request.due:
            warn_of_due(request.due, grades.newest_rubric(), warn)
        if request.into is not None:
            filled = _fill(request, request.into, grades)
            for line in preflight_lines(filled.preflight):
                warn(line)
            if request.strict and not filled.preflight.matches:
                warn("nothing was written, because of --strict: some rows or grades are unmatched")
                return b"", ExitCode.FAILED
            data = filled.data
        elif request.target == "csv":
            data = grades_csv(grades).encode()
        else:
            data = class_summary(grades, OutputFormat.JSON, with_fixes=True).encode()
    if request.output is None:
        return data, ExitCode.PASSED
    save_bytes(request.output, data, classes)
    return b"", ExitCode.PASSED


def _refuse_files(request: ExportRequest) -> None:
    into, output = request.into, request.output
    if (into is None) == (request.target in ("canvas", "moodle")):
        raise GraderError(
            f"export {request.target} fills in a file that the LMS exported: give it with --into"
            if into is None
            else f"export {request.target} does not take --into"
        )
    if output is not None:
        refuse_gradebook(output, request.gradebook)
    if into is not None and (is_stdout(into) if output is None else is_same_file(output, into)):
        raise GraderError(
            f"cannot write {printable_path(into)}: --into reads it, and rows without a grade would be lost; choose another file"
        )


def grades_csv(grades: Grades) -> str:
    """Return a row for each student: the grade, the late penalty, and the points of each criterion that is decided."""
    criteria = grades.criteria
    header = [*_STUDENT_COLUMNS, "total", "not_final_because", *(criterion.id for criterion in criteria), "carried"]
    return write_table(header, (_row(grades, grade, criteria) for grade in grades.all()))


def _row(grades: Grades, grade: StudentGrade, criteria: Sequence[Criterion]) -> list[Cell]:
    student = grade.student
    about: list[Cell] = [student.key, student.name, student.email, student.login, student.sis, grade.verdict]
    if grade.result is None:
        return [*about, *[None] * 6, grade.why_not_final, *[None] * (len(criteria) + 1)]
    numbers: list[Cell] = [grade.score, grade.out_of, grade.pending, grade.late.days, grade.late.points, grade.total]
    points = grades.points(grade)
    decided = (points.get(criterion.id) for criterion in criteria)
    return [*about, *numbers, grade.why_not_final, *decided, ", ".join(grades.carried(grade))]


def lms_grades(grades: Grades, *, feedback: bool, pending_as_zero: bool) -> Iterator[LmsGrade]:
    """Yield each student's grade for an LMS. One that is not final has no total, unless pending points count as zero."""
    for grade in grades.all():
        reason = grade.why_not_final
        is_only_pending = (
            grade.verdict in ("graded", "errored") and not replace(grade, pending=Decimal(0)).why_not_final
        )
        if reason and not (is_only_pending and pending_as_zero):
            yield LmsGrade(grade.student, None, "", reason, grade.is_on_roster is not False)
            continue
        text = _feedback(grades, grade) if feedback else ""
        yield LmsGrade(grade.student, grade.total, text, is_on_roster=grade.is_on_roster is not False)


def _fill(request: ExportRequest, file: Path, grades: Grades) -> Filled:
    """Fill in Moodle's worksheet or Canvas' gradebook. Raises InputError."""
    data = read_capped(file, SIZE_LIMIT, advice="")
    rubric, is_moodle = grades.newest_rubric(), request.target == "moodle"
    rows = list(lms_grades(grades, feedback=is_moodle, pending_as_zero=request.pending_as_zero))
    options: dict[str, Any] = {"column": request.column, "any_maximum": request.any_maximum}
    options |= {"out_of": sum((row.points for row in grades.criteria), Decimal(0)), "shown": printable_path(file)}
    if is_moodle:
        return fill_worksheet(data, rows, feedback_column=request.feedback_column, **options)
    return fill_gradebook(data, rows, rubric_names=(rubric.id, rubric.title), **options)


def _feedback(grades: Grades, grade: StudentGrade) -> str:
    report = grades.report(grade)
    remarks = list(feedback_items(report.results))
    if grade.late.points:
        remarks.append(FeedbackItem("Late penalty", grade.late.points, Decimal(0), grade.late.reason))
    return feedback_html(grade.total, report.max_score, remarks)


def preflight_lines(found: Preflight) -> Iterator[str]:
    """Yield what filling in an LMS file changes, line by line, at most 50 lines of each kind."""
    yield f"column {found.column!r}: {found.filled} filled in, {found.unchanged} already the same"
    yield from _capped(
        "grades that change",
        [f"row {row.row}, {row.who}: was {row.was}, becomes {row.becomes}" for row in found.conflicts],
    )
    yield from _capped("without a grade", _by_reason("without a grade", found.ungraded))
    for kind, rows in (
        ("in the file, but not in the gradebook", found.unknown),
        ("in the gradebook, but not in the file", found.missing),
        ("ambiguous", found.ambiguous),
        ("kept the comment that a person wrote", found.kept_feedback),
    ):
        yield from _capped(
            kind, [f"{kind}: {f'row {row.row}, ' if row.row else ''}{row.who}: {row.why}" for row in rows]
        )
    yield from map(printable, found.warnings)


def _by_reason(kind: str, rows: Sequence[RowNote]) -> list[str]:
    """Return a line for each reason, in the order of the rows: how many have it, and the first of them."""
    names: dict[str, list[str]] = {}
    for row in rows:
        names.setdefault(row.why, []).append(row.who)
    return [f"{kind}, {reason}: {len(students)} ({_listed(students)})" for reason, students in names.items()]


def _listed(names: Sequence[str]) -> str:
    shown = list(names[:_MAX_NAMED])
    more = [f"... and {len(names) - len(shown)} more"] if len(names) > len(shown) else []
    return ("; " if any("," in name for name in shown) else ", ").join([*shown, *more])


def _capped(kind: str, lines: Sequence[str]) -> Iterator[str]:
    yield from map(printable, lines[:_MAX_LINES])
    if len(lines) > _MAX_LINES:
        yield f"{kind}: and {len(lines) - _MAX_LINES} more"
