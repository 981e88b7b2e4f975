"""Export the current grades: as CSV, JSON or pages, into a file of an LMS, and the reports as feedback for an LMS."""

from collections.abc import Iterator
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path
from zipfile import is_zipfile

from grader.classroom import folder as names
from grader.classroom.grade_table import export_table
from grader.classroom.grades import Class, StudentGrade
from grader.classroom.lms.comments import CommentItem, comment_html, comment_items
from grader.classroom.lms.feedback_zip import canvas_names, moodle_names, write_feedback
from grader.classroom.lms.fill import fill, participants
from grader.classroom.lms.forms import FORMS
from grader.classroom.lms.grade_file import FillOptions
from grader.classroom.lms.owners import ClassGrade
from grader.classroom.tables import SIZE_LIMIT, write_table
from grader.errors import GraderError, InputError
from grader.files.reading import read_capped
from grader.report.formats import Format, render
from grader.text import enumerated, first_lines, people_text, printable, printable_path
from grader.usecases.class_reports import ReportRun, refuse_report_folder, report_of, write_reports
from grader.usecases.exit_codes import ExitCode
from grader.usecases.terminal import Terminal
from grader.usecases.writing import is_same_file, is_stdout, refuse_symlinks, save_bytes

_BOM = b"\xef\xbb\xbf"  # by which Excel recognises UTF-8
# The targets of each option that not all targets take.
_TARGETS = {"--into": tuple(FORMS), "--feedback": ("moodle", "canvas"), "--excel": ("csv",)}
_TARGETS["--only"] = tuple(name for name in FORMS if name != "moodle")  # whose worksheet has one assignment
_MAX_LINES, _MAX_NAMED = 20, 5


@dataclass(frozen=True, slots=True)
class ExportRequest:
    """An export: its format, and for an LMS the file to fill in and how, and the zip of feedback to write."""

    target: str
    gradebook: Path
    into: Path | None = None
    output: Path | None = None
    strict: bool = False
    column: str = ""
    feedback_column: str = ""
    pending_as_zero: bool = False
    any_maximum: bool = False
    only: bool = False
    excel: bool = False
    feedback: Path | None = None
    feedback_format: str = "html"

    @property
    def outputs(self) -> list[Path]:
        """The files to write."""
        return [path for path in (self.output, self.feedback) if path is not None]


def export(request: ExportRequest, terminal: Terminal) -> tuple[bytes, ExitCode]:
    """Export the grades to the output file; return what to print, and the exit code. Raises GraderError."""
    _refuse_options(request)
    _refuse_files(request)
    book = Class(request.gradebook)
    roots = book.settings.roots(book.folder)
    if request.target == "html":
        folder = request.output or book.folder / names.REPORTS
        if request.output is not None:
            refuse_report_folder(folder, (Format.HTML,), roots)
        write_reports(ReportRun(book.folder, folder, (Format.HTML,)), terminal)
        return b"", ExitCode.PASSED
    for path in request.outputs:
        refuse_symlinks(path, roots)
        if book.folder.resolve() in path.resolve().parents:
            raise InputError(f"cannot write {printable_path(path)}: the gradebook is written by its own commands")
    for line in first_lines(book.marks.ignored, _MAX_LINES):
        terminal.warn(line)
    data, is_complete = _data(request, book, terminal)
    if request.strict and (book.marks.ignored or not is_complete):
        terminal.warn("nothing was written, because of --strict: marks do not count, or some rows or students are unmatched")
        return b"", ExitCode.FAILED
    if request.feedback is not None:
        save_bytes(request.feedback, _feedback(request, book, terminal), roots)
    if request.output is None:
        return data, ExitCode.PASSED
    save_bytes(request.output, data, roots)
    return b"", ExitCode.PASSED


def _data(request: ExportRequest, book: Class, terminal: Terminal) -> tuple[bytes, bool]:
    """Return the exported file, empty if only feedback is asked for, and whether everybody is in it."""
    if request.target == "csv":
        return (_BOM if request.excel else b"") + write_table(*export_table(book, book)).encode(), True
    if request.target == "json":
        from grader.report.class_json import render_class_json

        return render_class_json(book).encode(), True
    if request.into is None:
        return b"", True
    form = FORMS[request.target]
    has_comments = "comment" in form.columns
    grades = [_class_grade(book, one, request, has_comment=has_comments) for one in book]
    filled = fill(read_capped(request.into, SIZE_LIMIT, advice=""), grades, form, _options(request, book))
    for line in filled.lines:
        terminal.warn(line)
    return filled.data, filled.is_complete


def _class_grade(book: Class, grade: StudentGrade, request: ExportRequest, *, has_comment: bool = False) -> ClassGrade:
    """Return a grade as it is published; points that need manual grading count as zero with --pending-as-zero."""
    is_open = bool(grade.why_open) and not grade.is_excused
    is_only_pending = is_open and grade.pending and grade.total is not None and grade.why_open.endswith("manual grading")
    total = grade.total if not is_open or (request.pending_as_zero and is_only_pending) else None
    total = None if grade.is_excused else total
    comment = _comment(book, grade) if has_comment and total is not None else ""
    return ClassGrade(grade.student, total, grade.is_excused, grade.why_open, comment)


def _comment(book: Class, grade: StudentGrade) -> str:
    report = report_of(book, grade, has_hints=False) if grade.graded is not None else None
    items = list(comment_items(report.results)) if report is not None and not grade.has_final else []
    if grade.late.points:
        items.append(CommentItem("Late", grade.late.points, Decimal(0), grade.late.reason))
    if grade.final is not None and grade.final.comment:
        items.append(CommentItem("Comment", message=grade.final.comment))
    is_manual = grade.has_final or (report is not None and any(one.manual_mark for one in report.results))
    most = sum((row.maximum for row in book.criteria), Decimal(0))
    graded = "manually" if grade.has_final else "automatically, and manually" if is_manual else "automatically"
    return comment_html(grade.total or Decimal(0), most, items, graded)


def _options(request: ExportRequest, book: Class) -> FillOptions:
    return FillOptions(
        sum((row.maximum for row in book.criteria), Decimal(0)),
        (book.rubric.title, book.rubric.id),
        request.column,
        request.feedback_column,
        request.any_maximum,
        request.only,
        printable_path(request.into) if request.into is not None else "",
    )


def _feedback(request: ExportRequest, book: Class, terminal: Terminal) -> bytes:
    """Return the zip of the reports, named as the LMS gives them to its students."""
    kind = Format(request.feedback_format)
    name = f"report.{kind.ending}"
    grades = {one.student.key: one for one in book if one.graded is not None or one.has_final}
    if request.target == "moodle":
        numbers = None
        if request.into is not None:
            data = read_capped(request.into, SIZE_LIMIT, advice="")
            known = [_class_grade(book, one, request) for one in grades.values()]
            numbers = participants(data, known, FORMS["moodle"], _options(request, book))
        names, without = moodle_names([one.student for one in grades.values()], name, numbers)
    else:
        paths = {key: one.graded.paths if one.graded is not None else () for key, one in grades.items()}
        names, without = canvas_names(((grades[key].student, paths[key]) for key in grades), name)
    reports = {key: render(report_of(book, grades[key], feedback=True), kind).encode() for key in names}
    zipped, left = write_feedback(reports, names, name)
    for line in first_lines([*_reasons({**without, **left})], _MAX_LINES):
        terminal.warn(printable(line))
    terminal.warn(f"{len(names) - len(left)} reports in {printable_path(request.feedback or Path())}")
    return zipped


def _reasons(without: dict[str, str]) -> Iterator[str]:
    """Yield a line for each reason why students have no feedback."""
    by_reason: dict[str, list[str]] = {}
    for key, why in without.items():
        by_reason.setdefault(why, []).append(key)
    yield from (f"no feedback for {people_text(keys, _MAX_NAMED)}: {why}" for why, keys in by_reason.items())


def _refuse_options(request: ExportRequest) -> None:
    given = {"--into": request.into, "--feedback": request.feedback, "--excel": request.excel, "--only": request.only}
    for option, targets in _TARGETS.items():
        if given[option] and request.target not in targets:
            verb = "do" if len(targets) > 1 else "does"
            raise GraderError(f"export {request.target} does not take {option}; {enumerated(targets)} {verb}")
    if request.target in FORMS and request.into is None and request.feedback is None:
        raise GraderError(f"export {request.target} fills in a file that the LMS exported: give it with --into")
    if request.target in FORMS and request.into is None and request.output is not None:
        raise GraderError("--output is the filled file of the LMS, which needs --into; --feedback names the zip")


def _refuse_files(request: ExportRequest) -> None:
    into, output, feedback = request.into, request.output, request.feedback
    if into is not None and (is_stdout(into) if output is None else is_same_file(output, into)):
        raise GraderError(
            f"cannot write {printable_path(into)}: --into reads it, and rows without a grade would be lost; "
            "choose another file"
        )
    if feedback is None:
        return
    shown = printable_path(feedback)
    if feedback.is_symlink() or feedback.is_dir():
        raise InputError(f"cannot write {shown}: it is a {'symlink' if feedback.is_symlink() else 'folder'}")
    if any(other is not None and is_same_file(feedback, other) for other in (into, output)):
        raise GraderError(f"cannot write {shown}: it is also the file of --into or --output")
    if feedback.is_file() and not is_zipfile(feedback):
        raise InputError(f"cannot write {shown}: it exists and is not a zip; name another file")
