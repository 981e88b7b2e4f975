"""Write a report for each student of a class, from the gradebook, and the class's page beside reports in HTML."""

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from datetime import datetime
from functools import partial
from pathlib import Path

from grader.checks.outcome import Outcome
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.remarks import remarks_of
from grader.classroom.gradebook.student_grade import StudentGrade
from grader.classroom.run.pool import WorkerError, processors
from grader.classroom.run.progress import Progress
from grader.classroom.run.queue import Queue
from grader.errors import InputError, MachineError, RubricError
from grader.grading.graded_submission import Grade, GradedSubmission
from grader.grading.report import Report, Result
from grader.report.formats import Format, render
from grader.text import counted, enumerated, format_points, printable, printable_path
from grader.usecases.class_page import write_class_page
from grader.usecases.report_names import CLASS_PAGE, INDEX, report_names, update_index
from grader.usecases.saves import address
from grader.usecases.terminal import Warn
from grader.usecases.writing import make_folder, refuse_symlinks, save

_TASK_SIZE = 50  # reports
_MAX_NAMED = 3
REPORT_SECONDS = 600.0  # for a task that writes a few dozen reports


@dataclass(frozen=True, slots=True)
class ReportRun:
    """The reports to write from a gradebook into a folder; `feedback` adds who graded."""

    book: Path
    folder: Path
    formats: tuple[Format, ...]
    deadline: datetime | None = None
    feedback: bool = False


def report_of(grades: Grades, grade: StudentGrade, *, feedback: bool = False) -> Report:
    """Return the report on a student's newest submission, with the grade and notes.

    There is a note for a final mark, an excuse, a comment and a late penalty. Another one says who graded if a person
    did, and always in `feedback`. Without notes, the report is the same as that of `grader grade`. Without a
    submission, it has notes, but no points.
    """
    report = grades.report(grade) if grade.result is not None else _nothing_submitted(grades, grade)
    note = grade.late.reason
    if grade.late.points:
        penalty = format_points(-grade.late.points)
        note += f": the late penalty is {penalty} points, the grade is {format_points(grade.total)}"
    remarks = remarks_of(grades, grade)
    graded = remarks.graded if feedback or remarks.graders.is_manual else []
    is_changed = grade.has_final or grade.late.points or any(result.manual_mark for result in report.results)
    counting = Grade(None if grade.is_excused else grade.total, grade.late.points, grade.final is not None)
    notes = (*report.notes, *remarks.notes, *graded, *([note] if note else []))
    return report._replace(notes=notes, grade=counting if is_changed else None)


def _nothing_submitted(grades: Grades, grade: StudentGrade) -> Report:
    outcome = Outcome("skipped", "not graded, because nothing was submitted")
    results = tuple(Result(criterion, outcome) for criterion in grades.criteria)
    return Report(GradedSubmission(grade.student.key), grades.newest_rubric(), grades.parts, results)


def refuse_report_folder(folder: Path, formats: Sequence[Format], submissions: Sequence[Path]) -> None:
    """Raise InputError if reports cannot be written to a folder, or the next run would read it as a submission."""
    shown = printable_path(folder)
    refuse_symlinks(folder, submissions)
    if folder.exists() and not folder.is_dir():
        raise InputError(f"cannot write files to {shown}: it is not a folder")
    for submitted in submissions:
        if folder.resolve() == submitted or submitted in folder.resolve().parents:
            raise InputError(
                f"cannot write files to {shown}: the next run would take them for a submission; "
                "choose a folder outside of the class folder"
            )
    if Format.HTML in formats and (folder / CLASS_PAGE).exists() and not (folder / INDEX).exists():
        page = printable_path(folder / CLASS_PAGE)
        raise InputError(f"cannot write {page}: it exists, and grader did not write it; choose another folder")


def write_reports(executor: Executor, run: ReportRun, warn: Warn, show: Callable[[Progress], None]) -> None:
    """Write a report for each student in `report_names`; in HTML also the class's page. Raises InputError."""
    make_folder(run.folder)
    with Gradebook(run.book) as opened:
        names = report_names(opened)
    earlier = update_index(run.folder, names)
    lost = render_reports(executor, run, names, show)
    if Format.HTML in run.formats:
        there = {key: names[key] for key in names if key not in lost}
        write_class_page(executor, run.book, run.folder, there, run.deadline)
    shown = printable_path(run.folder)
    warn(f"{counted(len(names) - len(lost), 'report')} written to {shown}")
    for key, why in lost.items():
        warn(printable(f"no report for {key}: {why}"))
    if earlier:
        reports = f"{counted(len(earlier), 'report')} of students who are not in the gradebook"
        warn(f"{shown} also has {reports}: {printable(enumerated(earlier, _MAX_NAMED))}")


def render_reports(
    executor: Executor, run: ReportRun, names: dict[str, str], show: Callable[[Progress], None]
) -> dict[str, str]:
    """Write the reports of students, by their file names; return who has none, and why.

    Raises InputError and RubricError, which concern all reports.
    """
    progress = Progress(len(names))
    show(progress)
    lost: dict[str, str] = {}
    queue = Queue(executor, processors(), partial(_write_some, run), _give_up, _TASK_SIZE)
    for results in queue.all(names.items()):
        lost |= {key: why for key, why in results if why}
        progress = replace(progress, graded=progress.graded + len(results))
        show(progress)
    return {key: lost[key] for key in names if key in lost}


def _give_up(named: tuple[str, str], error: Exception) -> tuple[str, str]:
    """Return the student without a report, and why."""
    if isinstance(error, InputError | RubricError):
        raise error
    fault = f"the grader itself failed: {type(error).__name__}: {error}"
    return named[0], str(error) if isinstance(error, WorkerError | MachineError) else fault


def _write_some(run: ReportRun, named: Sequence[tuple[str, str]]) -> list[tuple[str, str]]:
    """Write the reports of students, given with their file names in the order of the keys; return the students."""
    names = dict(named)
    with Gradebook(run.book) as opened:
        grades = Grades(opened, run.deadline)
        for grade in list(grades.between(min(names), max(names))):
            name = names.get(grade.student.key)
            if name is not None:
                report = report_of(grades, grade, feedback=run.feedback)
                picture = address(f"{name}.{Format.SVG.ending}") if Format.SVG in run.formats else ""
                for kind in run.formats:
                    save(Path(run.folder, f"{name}.{kind.ending}"), render(report, kind, picture=picture))
    return [(key, "") for key in names]
