"""Export the current grades.

They go into CSV, JSON, pages or a file of an LMS, and the reports become feedback for an LMS.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from decimal import ROUND_FLOOR, Decimal
from pathlib import Path
from tempfile import TemporaryDirectory
from zipfile import is_zipfile

from grader.base.errors import GraderError, InputError
from grader.base.grouping import StringsByName
from grader.base.text import (
    counted,
    enumerated,
    format_points,
    people_text,
    printable,
    printable_path,
)
from grader.classroom.gradebook.gradebook import Gradebook, grade_table
from grader.classroom.gradebook.student_grade import Reason, StudentGrade
from grader.classroom.lms.feedback import (
    NamesInZip,
    canvas_names,
    comment_html,
    lost_points,
    moodle_names,
    write_feedback,
)
from grader.classroom.lms.fill import Filled, FillOptions, PublishedGrade, by_reason, fill
from grader.classroom.lms.forms import FORMS
from grader.classroom.marks import gradebook_folder as names
from grader.classroom.reports.class_figures import record_run, warn_of_ignored
from grader.classroom.roster.typed_names import find_typed
from grader.classroom.spreadsheet import SPREADSHEET, write_spreadsheet
from grader.classroom.tables import SIZE_LIMIT, write_table
from grader.files.reading import read_capped, read_start
from grader.report.formats import Format
from grader.report.invocation import ExitCode
from grader.report.writing import (
    Terminal,
    is_same_file,
    is_stdout,
    make_folder,
    refuse_symlinks,
    save_bytes,
)
from grader.report.written_files import refuse_other_file

_DOUBTS = (
    Reason.OLDER_MARKS,
    Reason.EARLY_MARK,
    Reason.UNKNOWN_TIME,
)  # about grades that are exported
_SPREADSHEETS = (SPREADSHEET, ".xls", ".ods")
_BOM = b"\xef\xbb\xbf"  # by which Excel recognises UTF-8
# The targets of each option that not all targets take.
_TARGETS = {
    "--into": tuple(FORMS),
    "--feedback": ("moodle", "canvas"),
    "--excel": ("csv",),
    "--for": ("csv", *FORMS),
}


@dataclass(frozen=True, slots=True)
class ExportRequest:
    """The options of `grader export`."""

    target: str  # csv, json, html or an LMS
    gradebook: Path
    into: Path | None = None  # the file of the LMS to fill in
    # the file or folder to write; default: standard output, or the gradebook
    output: Path | None = None
    strict: bool = False  # whether nothing is written if something is unmatched or does not count
    column: str = ""  # the title of the grade's column
    pending_as_zero: bool = False  # whether points that need manual grading count as zero
    any_maximum: bool = False  # whether the maximum of the LMS may be another one
    only: bool = False  # whether the columns of other assignments are omitted
    students: Sequence[str] = ()  # whose grades are released, as typed; all, if there are none
    excel: bool = False  # whether Excel opens the CSV with a double click
    feedback: Path | None = None  # the zip of reports to write
    feedback_format: str = "html"


def export(request: ExportRequest, terminal: Terminal) -> tuple[bytes, ExitCode]:
    """Export the grades to the output file; return what to print, and the exit code.

    Raises GraderError.
    """
    _refuse_options(request)
    book = Gradebook(request.gradebook)
    roots = book.roots
    if request.target == "html":
        from grader.classroom.reports import class_reports  # it loads what runs processes

        folder = request.output or book.folder / names.REPORTS
        if request.output:
            class_reports.refuse_report_folder(folder, roots)
        class_reports.write_reports(
            class_reports.ReportRun(book.folder, folder, (Format.HTML,)), terminal
        )
        return b"", ExitCode.PASSED
    _refuse_paths(request, book, roots)
    request = replace(request, students=_find_released(request, book))
    warn_of_ignored(book, terminal.warn)
    exported = _exported(request, book, terminal)
    doubts = [
        (why, one.student.label, detail)
        for one in _released_grades(request, book)
        for why, detail in one.concerns.items()
        if why in _DOUBTS or (why is Reason.DAMAGED and not request.into)
    ]
    for line in by_reason(doubts):
        terminal.warn(line)
    is_doubtful = any(why is not Reason.OLDER_MARKS for why, _, _ in doubts)
    if request.strict and (book.marks.ignored or is_doubtful or not exported.is_complete):
        why = (
            "rows or students are unmatched, marks or times are in doubt, or the LMS would "
            "refuse a grade"
        )
        terminal.warn(f"nothing was written, because of --strict: {why}")
        return b"", ExitCode.FAILED
    record_run(book.folder, terminal.warn)
    if request.feedback:
        zipped = _feedback(request, book, exported.numbers, terminal)
        if zipped:
            save_bytes(request.feedback, zipped, roots)
    if not request.output:
        return exported.data, ExitCode.PASSED
    save_bytes(request.output, exported.data, roots)
    return b"", ExitCode.PASSED


def _find_released(request: ExportRequest, book: Gradebook) -> Sequence[str]:
    """Return the keys of the students whose grades are released. Raises InputError."""
    if not request.students:
        return tuple(book.keys)
    students = [grade.student for grade in book]
    advice = "; `grades.csv` lists all students"
    return tuple(find_typed(students, name, advice).key for name in request.students)


def _released_grades(request: ExportRequest, book: Gradebook) -> Iterator[StudentGrade]:
    """Yield the grades that are released."""
    released = {*request.students}
    return (grade for grade in book if grade.student.key in released)


def _refuse_paths(request: ExportRequest, book: Gradebook, roots: Sequence[Path]) -> None:
    """Raise InputError for an output in the gradebook, or one that leads through a symlink.

    Also raise it for a file in a submission that the grader did not write.
    """
    header = None
    if request.into and request.into.is_file():
        header = read_start(request.into, SIZE_LIMIT).partition(b"\n")[0]
    for option, path in (("--output", request.output), ("--feedback", request.feedback)):
        if not path:
            continue
        refuse_symlinks(path, roots)
        refuse_other_file(option, path, roots, header)
        if book.folder.resolve() in path.resolve().parents:
            raise InputError(
                f"cannot write {printable_path(path)}: the gradebook is written by its own commands"
            )


def _exported(request: ExportRequest, book: Gradebook, terminal: Terminal) -> Filled:
    """Return the exported file, empty if only feedback is asked for."""
    if request.target == "csv":
        table = grade_table(book, _released_grades(request, book), is_exported=True)
        if request.output and request.output.suffix.lower() == SPREADSHEET:
            return Filled(write_spreadsheet(*table))
        data = write_table(*table).encode()
        return Filled(_BOM + data if request.excel else data)
    if request.target == "json":
        from grader.classroom.reports.class_json import render_class_json

        return Filled(render_class_json(book).encode())
    if not request.into:
        return Filled()
    form = FORMS[request.target]
    options = FillOptions(
        out_of=book.maximum,
        names=(book.rubric.title, book.rubric.id),
        column=request.column,
        any_maximum=request.any_maximum,
        only=request.only,
        shown=printable_path(request.into),
    )
    has_comment = "comment" in form.columns
    grades = [_class_grade(book, grade, request, has_comment=has_comment) for grade in book]
    filled = fill(read_capped(request.into, SIZE_LIMIT, advice=""), grades, form, options)
    for line in filled.lines:
        terminal.warn(line)
    zeros = [
        grade.student.label
        for grade in _released_grades(request, book)
        if _is_open_zero(grade, request) and not grade.total
    ]
    if zeros:
        terminal.warn(printable(f"0 points, because of --pending-as-zero: {people_text(zeros)}"))
    return filled


def _class_grade(
    book: Gradebook, grade: StudentGrade, request: ExportRequest, *, has_comment: bool
) -> PublishedGrade:
    """Return a grade as it is published.

    Points that need manual grading count as zero with --pending-as-zero.
    """
    if grade.student.key not in request.students:
        return PublishedGrade(grade.student, None, why_open="is not released")
    total = grade.total if _is_open_zero(grade, request) else grade.published
    comment = ""
    if has_comment and total is not None:
        comment = _comment(book, grade, total, has_open_zeros=_is_open_zero(grade, request))
    return PublishedGrade(grade.student, total, grade.is_excused, grade.why_open, comment)


def _is_open_zero(grade: StudentGrade, request: ExportRequest) -> bool:
    """Return whether points that need manual grading count as zero."""
    return request.pending_as_zero and grade.obstacle is Reason.PENDING


def _comment(book: Gradebook, grade: StudentGrade, total: Decimal, *, has_open_zeros: bool) -> str:
    """Return what a student reads of a grade in the LMS."""
    from grader.classroom.reports import class_reports

    report = class_reports.make_report(book, grade, has_hints=False)
    lost = () if grade.has_final else lost_points(report.results, has_open_zeros=has_open_zeros)
    exported = format_points(total.quantize(Decimal("0.01"), ROUND_FLOOR))
    opening = f"Grade: {exported} of {format_points(book.maximum)} points."
    return comment_html(opening, [*lost, *class_reports.list_notes(grade, report)])


def _feedback(
    request: ExportRequest, book: Gradebook, numbers: StringsByName, terminal: Terminal
) -> bytes:
    """Return the zip of the reports, named as the LMS gives them to its students.

    `numbers` are of --into.

    The reports for which the LMS has no way are written into the gradebook.
    """
    from grader.classroom.reports import class_reports

    kind = Format(request.feedback_format)
    report_name = f"report.{kind.ending}"
    released = _released_grades(request, book)
    grades = [grade for grade in released if grade.stored or grade.has_final]
    names_in_zip, without = _names_in_zip(request, grades, numbers, report_name)
    reports_folder = book.folder / names.REPORTS
    files = class_reports.file_names([grade.student.key for grade in grades])
    reports = {}
    with TemporaryDirectory() as folder:
        run = class_reports.ReportRun(book.folder, Path(folder), (kind,))
        lost = class_reports.render_reports(run, files, terminal)
        for key, file in files.items():
            if key not in lost:
                reports[key] = Path(folder, f"{file}.{kind.ending}").read_bytes()
    if without:
        make_folder(reports_folder)
    for key, why in without.items():
        if key in reports:
            save_bytes(reports_folder / f"{files[key]}.{kind.ending}", reports.pop(key))
            without[key] = f"{why}; see {printable_path(reports_folder)}"
    zipped, different = write_feedback(reports, names_in_zip, report_name)
    people = {grade.student.key: grade.student.label for grade in grades}
    missing = {**without, **lost, **different}
    for line in by_reason(("without feedback", people[key], missing[key]) for key in missing):
        terminal.warn(line)
    count = len(reports) - len(different)
    shown = printable_path(request.feedback or Path())
    terminal.warn(f"{counted(count, 'report')} in {shown}" if count else f"{shown} is not written")
    return zipped if count else b""


def _names_in_zip(
    request: ExportRequest, grades: Sequence[StudentGrade], numbers: StringsByName, report: str
) -> NamesInZip:
    """Return the names of the reports for the LMS by student, and why a student has none."""
    if request.target == "canvas":
        submissions = []
        for grade in grades:
            paths = grade.stored.paths if grade.stored else ()
            submissions.append((grade.student, paths))
        return canvas_names(submissions, report)
    students = [grade.student for grade in grades]
    if request.into:  # its rows have the numbers of this assignment
        students = [student._replace(moodle=numbers.get(student.key, "")) for student in students]
    return moodle_names(students, report)


def _refuse_options(request: ExportRequest) -> None:
    """Raise GraderError for an option that the target does not take.

    A file that must not be replaced raises it, too.
    """
    into = request.into
    output = request.output
    feedback = request.feedback
    given = {
        "--into": into,
        "--feedback": feedback,
        "--excel": request.excel,
        "--for": request.students,
    }
    for option, targets in _TARGETS.items():
        if given[option] and request.target not in targets:
            raise GraderError(
                f"export {request.target} takes no {option}: it is for {enumerated(targets)}"
            )
    _refuse_spreadsheet(request)
    if request.target in FORMS and not into and (output or not feedback):
        raise GraderError(
            f"export {request.target} fills in a file that the LMS exported: give it with --into"
        )
    if into:
        is_replaced = is_stdout(into) if not output else is_same_file(output, into)
        if is_replaced:
            why = "--into reads it, and rows without a grade would be lost"
            raise GraderError(f"cannot write {printable_path(into)}: {why}; choose another file")
    if feedback:
        _refuse_feedback(feedback)


def _refuse_spreadsheet(request: ExportRequest) -> None:
    """Raise GraderError for a file whose ending is that of a spreadsheet that is not written."""
    output = request.output
    written = ".csv or .xlsx" if request.target == "csv" else "no spreadsheet"
    ending = output.suffix.lower() if output and request.target != "html" else ""
    if output and ending in _SPREADSHEETS and ending not in written:
        raise GraderError(
            f"cannot write {printable_path(output)}: export {request.target} writes {written}; "
            "choose another file"
        )


def _refuse_feedback(feedback: Path) -> None:
    """Raise InputError for a file of feedback that must not be replaced."""
    is_no_zip = feedback.exists() and not is_zipfile(feedback)
    if is_no_zip or feedback.is_symlink():
        raise InputError(
            f"cannot write {printable_path(feedback)}: it is a symlink, or exists and is no "
            "zip; name another file"
        )
