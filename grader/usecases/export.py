"""Export the current grades: as CSV or JSON, into a file of an LMS, and the reports as feedback for an LMS."""

from dataclasses import dataclass
from datetime import datetime
from decimal import Decimal
from pathlib import Path
from zipfile import is_zipfile

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.lms.filling import FillOptions
from grader.classroom.run.pool import Processes, processors
from grader.classroom.tables import SIZE_LIMIT
from grader.errors import GraderError, InputError
from grader.files.reading import read_capped
from grader.report.formats import Format, OutputFormat
from grader.text import enumerated, printable_path
from grader.usecases.class_hints import HintOptions, search_class_hints
from grader.usecases.class_reports import REPORT_SECONDS, ReportRun, refuse_report_folder, write_reports
from grader.usecases.class_summary import SummaryRequest, class_summary, read_deadline, warn_of_due
from grader.usecases.exit_codes import ExitCode
from grader.usecases.feedback_zip import FeedbackRequest, feedback_zip
from grader.usecases.grade_files import FILLERS, fill_lms_file, grades_csv, preflight_lines
from grader.usecases.terminal import Terminal, Warn
from grader.usecases.writing import is_same_file, is_stdout, refuse_gradebook, refuse_symlinks, save_bytes

_BOM = b"\xef\xbb\xbf"  # by which Excel recognises UTF-8
# The targets of each option that not all targets take.
_TARGETS = {"--into": tuple(FILLERS), "--feedback": ("moodle", "canvas"), "--excel": ("csv",)}
_TARGETS["--only"] = tuple(name for name in FILLERS if name != "moodle")  # whose worksheet has one assignment


@dataclass(frozen=True, slots=True)
class ExportRequest:
    """An export: its format, and for an LMS the file to fill in and how, and the zip of feedback to write."""

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
    only: bool = False
    excel: bool = False
    feedback: Path | None = None
    feedback_format: str = "markdown"

    @property
    def outputs(self) -> list[Path]:
        """The files to write."""
        return [path for path in (self.output, self.feedback) if path is not None]


def export(request: ExportRequest, terminal: Terminal) -> tuple[bytes, ExitCode]:
    """Export the grades to the output file; return what to print, and the exit code. Raises GraderError."""
    _refuse_options(request)
    _refuse_files(request)
    deadline = read_deadline(request.due)
    if request.target == "html":
        _export_pages(request, terminal)
        return b"", ExitCode.PASSED
    with Gradebook(request.gradebook) as book:
        classes = tuple({run.source for run in book.runs()})
        for path in request.outputs:
            refuse_symlinks(path, classes)
        grades = Grades(book, deadline)
        if request.due:
            warn_of_due(request.due, grades.newest_rubric(), terminal.warn)
        data = _data(request, grades, terminal.warn)
        if data is None:
            terminal.warn("nothing was written, because of --strict: some rows or students are unmatched")
            return b"", ExitCode.FAILED
        if request.feedback is not None:
            save_bytes(request.feedback, _feedback(request, grades, deadline, terminal), classes)
    if request.output is None:
        return data, ExitCode.PASSED
    save_bytes(request.output, data, classes)
    return b"", ExitCode.PASSED


def _data(request: ExportRequest, grades: Grades, warn: Warn) -> bytes | None:
    """Return the exported file, empty if only feedback is asked for; None if --strict forbids writing it."""
    if request.target == "csv":
        return (_BOM if request.excel else b"") + grades_csv(grades).encode()
    if request.target == "json":
        return class_summary(grades, SummaryRequest(OutputFormat.JSON, with_fixes=True)).encode()
    if request.into is None:
        return b""
    options = _options(request, request.into, grades)
    filled = fill_lms_file(request.target, request.into, grades, options, pending_as_zero=request.pending_as_zero)
    for line in preflight_lines(filled.preflight):
        warn(line)
    return filled.data if filled.preflight.matches or not request.strict else None


def _options(request: ExportRequest, file: Path, grades: Grades) -> FillOptions:
    rubric = grades.newest_rubric()
    return FillOptions(
        sum((row.maximum for row in grades.criteria), Decimal(0)),
        (rubric.id, rubric.title),
        request.column,
        request.feedback_column,
        request.any_maximum,
        request.only,
        printable_path(file),
    )


def _feedback(request: ExportRequest, grades: Grades, deadline: datetime | None, terminal: Terminal) -> bytes:
    into = request.into if request.target == "moodle" else None
    worksheet = (read_capped(into, SIZE_LIMIT, advice=""), _options(request, into, grades)) if into else None
    asked = FeedbackRequest(request.target, Format(request.feedback_format), deadline, worksheet)
    return feedback_zip(grades, asked, terminal)


def _refuse_options(request: ExportRequest) -> None:
    given = {"--into": request.into, "--feedback": request.feedback, "--excel": request.excel, "--only": request.only}
    for option, targets in _TARGETS.items():
        if given[option] and request.target not in targets:
            verb = "do" if len(targets) > 1 else "does"
            raise GraderError(f"export {request.target} does not take {option}; {enumerated(targets)} {verb}")
    if request.target in FILLERS and request.into is None and request.feedback is None:
        raise GraderError(f"export {request.target} fills in a file that the LMS exported: give it with --into")
    if request.into is None and request.output is not None and request.feedback is not None:
        raise GraderError("--output is the filled file of the LMS, which needs --into; --feedback names the zip")


def _refuse_files(request: ExportRequest) -> None:
    into, output, feedback = request.into, request.output, request.feedback
    for path in request.outputs:
        refuse_gradebook(path, request.gradebook)
    if into is not None and (is_stdout(into) if output is None else is_same_file(output, into)):
        raise GraderError(
            f"cannot write {printable_path(into)}: --into reads it, and rows without a grade would be lost; "
            "choose another file"
        )
    if feedback is not None and (feedback.is_symlink() or feedback.is_dir()):
        raise InputError(
            f"cannot write {printable_path(feedback)}: it is a {'symlink' if feedback.is_symlink() else 'folder'}"
        )
    for other in filter(None, (into, output)):
        if feedback is not None and is_same_file(feedback, other):
            raise GraderError(f"cannot write {printable_path(feedback)}: it is also the file of --into or --output")
    if feedback is not None and feedback.is_file() and not is_zipfile(feedback):
        raise InputError(f"cannot write {printable_path(feedback)}: it exists and is not a zip; name another file")


def _export_pages(request: ExportRequest, terminal: Terminal) -> None:
    """Write a page for each student, and the class's page, into a folder. Raises GraderError."""
    folder = request.output
    if folder is None:
        raise GraderError("export html writes a folder of pages: name it with --output DIR")
    deadline = read_deadline(request.due)
    with Gradebook(request.gradebook) as book:
        refuse_report_folder(folder, (Format.HTML,), sorted({Path(run.source) for run in book.runs()}))
        if request.due:
            warn_of_due(request.due, Grades(book).newest_rubric(), terminal.warn)
        search_class_hints(book, HintOptions(), terminal, reports=True, statistics=True)
    run = ReportRun(request.gradebook, folder, (Format.HTML,), deadline)
    with Processes(processors(), REPORT_SECONDS) as executor, terminal.show_class("writing pages") as show:
        write_reports(executor, run, terminal.warn, show)
