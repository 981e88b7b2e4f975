"""Write the reports of a class into a zip that an LMS gives to its students."""

import tempfile
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from datetime import datetime
from pathlib import Path

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.student_grade import StudentGrade
from grader.classroom.lms.feedback_names import ZIP, canvas_name, moodle_folder
from grader.classroom.lms.filling import FillOptions, Preflight, match_rows
from grader.classroom.lms.grades import LmsGrade
from grader.classroom.lms.moodle import read_worksheet, students_of
from grader.classroom.run.pool import Processes, processors
from grader.errors import InputError
from grader.files.zip_writing import zip_of
from grader.report.formats import Format, render
from grader.text import counted, first_lines, printable
from grader.usecases import Warn
from grader.usecases.class_hints import HintOptions, ProgressDisplay, search_class_hints
from grader.usecases.class_reports import REPORT_SECONDS, render_reports, report_of
from grader.usecases.report_names import file_names

_MAX_LISTED = 50  # students without a file


class Feedback:
    """The reports of the students who have a result or a final mark, and the students who get none, with the reason."""

    def __init__(self, grades: Grades, kind: Format, due: datetime | None, progress: ProgressDisplay) -> None:
        self.grades = [grade for grade in grades.all() if grade.result is not None or grade.final is not None]
        self.name = f"{file_names([grades.newest_rubric().id]).popitem()[1]}-feedback.{kind.ending}"
        self.ending = f".{kind.ending}"
        self.without: dict[str, str] = {}
        self._reports = self._rendered(grades, kind, due, progress)

    def __iter__(self) -> Iterator[tuple[StudentGrade, bytes]]:
        return (
            (grade, self._reports[grade.student.key]) for grade in self.grades if grade.student.key in self._reports
        )

    def _rendered(
        self, grades: Grades, kind: Format, due: datetime | None, progress: ProgressDisplay
    ) -> dict[str, bytes]:
        """Return the reports by student; those with a submission come from other processes, which a submission may crash."""
        rendered = {
            grade.student.key: render(report_of(grades, grade), kind).encode("utf-8", "backslashreplace")
            for grade in self.grades
            if grade.result is None
        }
        names = {grade.student.key: str(number) for number, grade in enumerate(self.grades) if grade.result is not None}
        with (
            tempfile.TemporaryDirectory() as folder,
            Processes(processors(), REPORT_SECONDS) as executor,
            progress("writing reports") as show,
        ):
            self.without = render_reports(executor, grades.book.path, Path(folder), (kind,), due, names, show)
            for key in names.keys() - self.without.keys():
                rendered[key] = Path(folder, f"{names[key]}.{kind.ending}").read_bytes()
        return rendered


def feedback_zip(
    lms: str,
    book: Gradebook,
    grades: Grades,
    kind: Format,
    due: datetime | None,
    worksheet: tuple[bytes, FillOptions] | None,
    progress: ProgressDisplay,
    warn: Warn,
) -> bytes:
    """Return the zip for Moodle or Canvas; standard error lists who gets no report. Raises InputError if nobody does.

    `worksheet` is Moodle's, if it is given: its participants get the reports.
    """
    search_class_hints(book, HintOptions(), progress, warn, reports=True, statistics=False)
    feedback = Feedback(grades, kind, due, progress)
    files = _for_canvas(feedback) if lms == "canvas" else _for_moodle(feedback, worksheet)
    if not files:
        why = next(iter(feedback.without.values()), "no student has a result or a final mark")
        raise InputError(f"no report can be given to a student in {lms.title()}: {why}")
    for line in first_lines([f"no feedback for {key}: {why}" for key, why in feedback.without.items()], _MAX_LISTED):
        warn(printable(line))
    open_grades = sum(bool(grade.why_not_final) and not grade.is_excused for grade, _ in feedback)
    if open_grades:
        warn(f"{counted(open_grades, 'report')} of grades that are not final yet")
    warn(
        f"feedback: {counted(len(files), 'file')} for {counted(len(feedback.grades) - len(feedback.without), 'student')}"
    )
    return zip_of(files)


def _for_moodle(feedback: Feedback, worksheet: tuple[bytes, FillOptions] | None) -> dict[str, bytes]:
    """Return the files by their paths: a folder for each participant, whose number is in the gradebook or in the worksheet."""
    numbers = {grade.student.key: grade.student.moodle for grade in feedback.grades}
    why = "the gradebook has no participant number: pass the grading worksheet with --into"
    if worksheet is not None:
        numbers, why = _participants(feedback.grades, *worksheet), "has no row in the worksheet, or an ambiguous one"
    counts, files = Counter(numbers.values()), dict[str, bytes]()
    for grade, report in feedback:
        number = numbers.get(grade.student.key, "")
        if number and counts[number] == 1:
            files[f"{moodle_folder(grade.student, number)}/{feedback.name}"] = report
        else:
            feedback.without[grade.student.key] = (
                f"another student has participant number {number} too" if number else why
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
    """Return the files by their names; the students of a group's submission have one, because Canvas gives it to each of them."""
    submissions: dict[tuple[str, ...], list[tuple[StudentGrade, bytes]]] = defaultdict(list)
    for grade, report in feedback:
        submissions[grade.files.paths or ("", grade.student.key)].append((grade, report))
    files: dict[str, bytes] = {}
    for paths, members in submissions.items():
        students = [grade.student for grade, _ in members]
        name, why = canvas_name(filter(None, paths) if paths[0] else (), students, feedback.ending)
        if len({report for _, report in members}) > 1:
            name, why = "", "the members of the group have different reports, and Canvas gives one to all of them"
        if name:
            report = members[0][1]
            files[name] = zip_of({feedback.name: report}) if name.lower().endswith(ZIP) else report
        else:
            feedback.without |= {student.key: why for student in students}
    return files
