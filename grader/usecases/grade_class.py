"""A run over a class: taken in, graded, told; reports and grades written."""

import gc
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager
from math import isfinite
from pathlib import Path
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.lateness import read_time
from grader.classroom.intake.intake import Intake, read_class
from grader.classroom.intake.roster import Roster, roster_from_json
from grader.classroom.intake.roster_file import read_roster
from grader.classroom.run.batch import Batch, Progress, RunSettings
from grader.classroom.run.pool import Processes, processors
from grader.classroom.run.worker import PRELOAD, prepare
from grader.cli.class_text import class_text
from grader.cli.options import ClassFormat
from grader.cli.output import complain, emit
from grader.cli.progress import ProgressDisplay
from grader.errors import InputError
from grader.grading.answers import load_with_answers
from grader.grading.rubric import Rubric
from grader.report.formats import Format
from grader.text import printable, printable_path
from grader.usecases.class_reports import write_reports
from grader.usecases.export import grades_csv
from grader.usecases.writing import no_folder, not_over, refuse_links, save

_MOST_TOLD = 10
_REPORTING = 600.0  # seconds that a few dozen reports may take


class Wanted(NamedTuple):
    """What is to come of a run beside the gradebook."""

    reports: Path | None
    report_formats: tuple[Format, ...]
    csv: Path | None
    output: ClassFormat


def grade_class(
    path: Path,
    gradebook: Path,
    rubric: str,
    wanted: Wanted,
    *,
    jobs: int | None,
    timeout: float,
    roster: Path | None,
    layout: str,
    assignment: str,
    due: str | None,
    force: bool,
    cluster: str | None,
    add: bool,
    max_size: int,
) -> None:
    """Grade a class into a gradebook, and write what is wanted of it. Raises InputError and RubricError."""
    gc.enable()  # unlike other commands this one may run for long
    if not isfinite(timeout):
        raise InputError(f"--timeout takes a number of seconds, not {timeout}")
    rules = load_with_answers(rubric)  # for the gradebook, so that `review` has them on any machine
    deadline = read_time(due) if due else None
    known = _roster(roster, gradebook)
    root = path.resolve()
    _check(wanted, gradebook, root)
    intake = read_class(path, known, layout, assignment, rules.id)
    _tell(intake)
    with Gradebook(gradebook, create=True) as book:
        with _executor(cluster, jobs, timeout, root) as (executor, workers):
            told = deadline.isoformat() if deadline is not None else ""
            settings = RunSettings(str(root), intake.layout, len(intake), workers, force, known, told, add, max_size)
            done = _run(book, rules, intake, settings, executor)
        if wanted.reports is not None:
            with _processes(jobs, _REPORTING) as local:
                count = write_reports(local, gradebook, wanted.reports, wanted.report_formats, deadline)
            complain(f"{count} reports are in {printable_path(wanted.reports)}")
        if wanted.csv is not None:
            save(wanted.csv, grades_csv(Grades(book, deadline)), (root,))
        emit(class_text(Grades(book, deadline), wanted.output, done))


def _roster(file: Path | None, gradebook: Path) -> Roster | None:
    """The roster, or the one that an earlier run into this gradebook was given; with the LMS's numbers that the gradebook knows."""
    roster = read_roster(file) if file is not None else None
    if not gradebook.exists():
        return roster
    with Gradebook(gradebook) as book:
        roster = roster or roster_from_json(book.roster_entries())
        return roster.with_lms_numbers(book.students()) if roster is not None else None


@contextmanager
def _executor(cluster: str | None, jobs: int | None, timeout: float, root: Path) -> "Iterator[tuple[Executor, int]]":
    """Who does the work, and how many tasks at once."""
    if cluster is None:
        with _processes(jobs, timeout) as local:
            yield local, jobs or processors()
        return
    from grader.classroom.run.cluster import Cluster

    with Cluster(cluster, timeout, root) as far:
        yield far, far.workers


def _processes(jobs: int | None, timeout: float) -> "Executor":
    return Processes(jobs or processors(), timeout, prepare, preload=PRELOAD)


def _run(
    book: "Gradebook", rules: "Rubric", intake: "Intake", settings: "RunSettings", executor: "Executor"
) -> "Progress":
    """Grade what is new; where it is interrupted, say what is kept."""
    with ProgressDisplay() as display:
        run = Batch(book, rules, settings, executor, display.show)
        try:
            done = run.grade(intake)
        except BaseException:
            if run.has_begun:
                done_so_far = f"{run.progress.done} of {len(intake)} have a result, which is kept"
                complain(f"stopped: {done_so_far}; the same command goes on")
            raise
    _tell_lines(run.notes)
    lost = f", {done.errored} of them errored" if done.errored else ""
    complain(f"{done.graded} graded{lost}, {done.unchanged} unchanged since they were")
    return done


def _tell(intake: "Intake") -> None:
    """Say how the class was taken in, and what was left out."""
    complain(f"{len(intake)} hand-in{'' if len(intake) == 1 else 's'}, laid out as {intake.layout}")
    unmatched = [f"{key} is not on the roster" for key in intake.unmatched]
    for lines in (intake.notes, unmatched, [f"left out: {line}" for line in intake.ignored]):
        _tell_lines(lines)


def _tell_lines(lines: Sequence[str]) -> None:
    for line in lines[:_MOST_TOLD]:
        complain(printable(line))
    if len(lines) > _MOST_TOLD:
        complain(f"... and {len(lines) - _MOST_TOLD} more")


def _check(wanted: Wanted, gradebook: Path, root: Path) -> None:
    """Refuse what could not be written in the end, or would be taken for a hand-in the next time; raises InputError."""
    reports, csv = wanted.reports, wanted.csv
    for each in filter(None, (gradebook, reports, csv)):
        refuse_links(each, (root,))
    if reports is not None and reports.exists() and not reports.is_dir():
        raise InputError(f"{printable_path(reports)} is no folder that reports could be written to")
    if reports is not None and (reports.resolve() == root or root in reports.resolve().parents):
        raise InputError(f"{printable_path(reports)} is in the class folder, where it would be taken for a hand-in")
    if csv is not None and not csv.resolve().parent.is_dir():
        raise no_folder(csv)
    if csv is not None:
        not_over(csv, gradebook)
