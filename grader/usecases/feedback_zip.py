"""Write the reports of a class into a zip that an LMS gives to its students."""

import tempfile
from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path, PurePosixPath
from typing import NamedTuple

from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.student_grade import StudentGrade
from grader.classroom.lms.feedback_names import ARCHIVES, canvas_upload_name, moodle_folder
from grader.classroom.lms.filling import FillOptions, match_rows
from grader.classroom.lms.grades import LmsGrade
from grader.classroom.lms.moodle import read_worksheet, students_of
from grader.classroom.lms.preflight import Preflight, RowNote
from grader.classroom.run.pool import Processes, processors
from grader.errors import InputError
from grader.files.zip_writing import tar_gz_of, zip_of
from grader.report.formats import Format
from grader.text import counted, named
from grader.usecases.class_hints import HintOptions, search_class_hints
from grader.usecases.class_reports import REPORT_SECONDS, ReportRun, render_reports
from grader.usecases.grade_files import by_reason
from grader.usecases.report_names import file_names, report_names
from grader.usecases.terminal import Terminal


@dataclass(frozen=True, slots=True)
class Feedback:
    """The reports of students, each with the grade, and the students without one, with the reason.

    `name` is that of the file that a student gets, with its ending.
    """

    name: str
    ending: str
    reports: list[tuple[StudentGrade, bytes]]
    without: dict[str, str]


class FeedbackRequest(NamedTuple):
    """The feedback for Moodle or Canvas. `worksheet` is Moodle's, or None; its participants get the reports."""

    lms: str
    kind: Format
    deadline: datetime | None
    worksheet: tuple[bytes, FillOptions] | None


def feedback_zip(grades: Grades, request: FeedbackRequest, terminal: Terminal) -> bytes:
    """Return the zip for the LMS; standard error lists who gets none. Raises InputError if no student gets a report."""
    search_class_hints(grades.book, HintOptions(), terminal, reports=True, statistics=False)
    feedback = _feedback(grades, request, terminal)
    lms, warn = request.lms, terminal.warn
    files = _for_canvas(feedback) if lms == "canvas" else _for_moodle(feedback, request.worksheet)
    if not files:
        why = next(iter(feedback.without.values()), "no student has a result, a final mark or an excuse")
        raise InputError(f"no student would get a report in {lms.title()}: {why}")
    names = {student.key: named(student.key, student.name) for student in grades.book.students()}
    without = (RowNote(0, names[key], why) for key, why in feedback.without.items())
    for line in by_reason("no feedback for", without, most=10):
        warn(line)
    given = [grade for grade, _ in feedback.reports if grade.student.key not in feedback.without]
    if count := sum(bool(grade.why_not_final) and not grade.is_excused for grade in given):
        warn(f"reports of grades that are not final yet: {count}")
    warn(f"feedback: {counted(len(files), 'file')} for {counted(len(given), 'student')}")
    return zip_of(files)


def _feedback(grades: Grades, request: FeedbackRequest, terminal: Terminal) -> Feedback:
    """Return the reports of the students in `report_names`, from other processes: a submission may crash them."""
    names, kind = report_names(grades.book), request.kind
    with (
        tempfile.TemporaryDirectory() as folder,
        Processes(processors(), REPORT_SECONDS) as executor,
        terminal.show_class("writing reports") as show,
    ):
        run = ReportRun(grades.book.path, Path(folder), (kind,), request.deadline, feedback=True)
        without = render_reports(executor, run, names, show)
        written = {key: Path(folder, f"{names[key]}.{kind.ending}") for key in names.keys() - without.keys()}
        reports = {key: path.read_bytes() for key, path in written.items()}
    (name,) = file_names([grades.newest_rubric().id]).values()
    listed = [(grade, reports[grade.student.key]) for grade in grades.all() if grade.student.key in reports]
    return Feedback(f"{name}-feedback.{kind.ending}", f".{kind.ending}", listed, without)


def _for_moodle(feedback: Feedback, worksheet: tuple[bytes, FillOptions] | None) -> dict[str, bytes]:
    """Return the files by their paths: a folder for each participant, numbered as in the gradebook or worksheet."""
    numbers = {grade.student.key: grade.student.moodle for grade, _ in feedback.reports}
    why = "the gradebook has no participant number: pass the grading worksheet with --into"
    if worksheet is not None:
        numbers = _participants([grade for grade, _ in feedback.reports], *worksheet)
        why = "matches no row of the worksheet, or several"
    counts, files = Counter(numbers.values()), dict[str, bytes]()
    for grade, report in feedback.reports:
        number = numbers.get(grade.student.key, "")
        if number and counts[number] == 1:
            files[f"{moodle_folder(grade.student, number)}/{feedback.name}"] = report
        else:
            feedback.without[grade.student.key] = (
                f"another student has the same participant number, {number}" if number else why
            )
    return files


def _participants(found: Sequence[StudentGrade], data: bytes, options: FillOptions) -> dict[str, str]:
    """Return the participant numbers in a worksheet by the student's key."""
    rows = students_of(*read_worksheet(data, options))
    number_of = {row.row: row.student.moodle for row in rows}
    grades = [LmsGrade(one.student, one.total, is_on_roster=one.is_on_roster is not False) for one in found]
    matched = match_rows(rows, grades, Preflight(""))
    return {grade.student.key: number_of[row] for row, grade in matched.items()}


def _for_canvas(feedback: Feedback) -> dict[str, bytes]:
    """Return the files by name; the students of a group's submission share one, which Canvas gives to each of them."""
    submissions: dict[tuple[str, ...], list[tuple[StudentGrade, bytes]]] = defaultdict(list)
    for grade, report in feedback.reports:
        files = tuple(PurePosixPath(path).name for path in grade.files.paths)
        submissions[files or ("", grade.student.key)].append((grade, report))
    named: dict[str, bytes] = {}
    for files, members in submissions.items():
        students = [grade.student for grade, _ in members]
        name, why = canvas_upload_name(files if files[0] else (), students, feedback.ending)
        if len({report for _, report in members}) > 1:
            name, why = "", "the members of the group have different reports, and Canvas gives one to all of them"
        if name:
            named[name] = _pack(name, feedback.name, members[0][1])
        else:
            feedback.without.update((student.key, why) for student in students)
    return named


def _pack(name: str, inside: str, report: bytes) -> bytes:
    """Return a report as the kind of file that its name promises: an archive with it `inside`, or the report itself."""
    if not name.lower().endswith(ARCHIVES):
        return report
    return (zip_of if name.lower().endswith(".zip") else tar_gz_of)({inside: report})
