"""Grade a class into a gradebook, and write its reports and grades."""

import gc
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from datetime import datetime
from math import isfinite
from pathlib import Path

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.hints import remove_hints
from grader.classroom.intake.intake import Intake
from grader.classroom.intake.reading import read_class
from grader.classroom.run.batch import Batch, RunSettings
from grader.classroom.run.class_check import check_roster
from grader.classroom.run.pool import Processes, processors
from grader.classroom.run.progress import Progress
from grader.errors import InputError
from grader.report.formats import Format, OutputFormat
from grader.text import counted, first_lines, printable, printable_path
from grader.usecases.class_hints import HintOptions, search_class_hints
from grader.usecases.class_inputs import deadline_of, handed_out_hashes, roster_of, rubric_of, warn_of_parts
from grader.usecases.class_summary import SummaryRequest, class_summary, warn_of_due
from grader.usecases.rubrics import files_of
from grader.usecases.terminal import Terminal, Warn, one_total
from grader.usecases.writing import missing_folder, refuse_gradebook, refuse_inputs, refuse_symlinks, save

_MAX_LINES = 10
_UNREADABLE = "SELECT count(*) FROM grade WHERE verdict = 'unreadable' AND NOT is_gone AND source = ?"


@dataclass(frozen=True, slots=True)
class ClassRequest:
    """A class to grade, and the files to write besides the gradebook. `timeout` is in seconds, `max_size` in bytes.

    `output_format` is that of the summary. Without a `rubric` it is that of the last run into the gradebook.
    `ignore_file` are robots that the course handed out.
    """

    path: Path
    gradebook: Path
    rubric: str | None
    jobs: int | None
    timeout: float
    roster: Path | None
    layout: str
    assignment: str
    due: str | None
    force: bool
    cluster: str | None
    add: bool
    max_size: int
    answers: Path | None
    part: tuple[str, ...]
    ignore_file: tuple[Path, ...]
    reports: Path | None
    report_format: tuple[Format, ...]
    csv: Path | None
    verbose: bool
    output_format: OutputFormat

    @property
    def root(self) -> Path:
        """The absolute path of the class."""
        return self.path.resolve()


def grade_class(request: ClassRequest, terminal: Terminal) -> str:
    """Grade a class and return its summary. Raises InputError and RubricError."""
    warn = terminal.warn
    gc.enable()  # unlike other commands, this one may run for long
    if not isfinite(request.timeout):
        raise InputError(f"--timeout takes a number of seconds, not {request.timeout}")
    rubric = rubric_of(request.rubric, request.gradebook, request.answers, warn)
    for name in request.part:
        rubric.part(name)
    deadline = deadline_of(request.due, request.gradebook, warn)
    warn_of_due(request.due, rubric, warn)
    handed_out = tuple(handed_out_hashes(request.ignore_file, rubric))
    roster = roster_of(request.roster, request.gradebook, warn)
    _refuse_targets(request)
    intake = read_class(request.path, roster, request.layout, request.assignment, rubric.id, rubric.folders)
    _warn_of_intake(intake, warn)
    if request.roster is not None and not request.add:
        check_roster(intake)
    settings = RunSettings(
        root=str(request.root),
        layout=intake.layout,
        force=request.force,
        roster=roster,
        deadline=deadline.isoformat() if deadline is not None else "",
        add=request.add,
        max_size=request.max_size,
        parts=request.part,
        handed_out=handed_out,
    )
    with Gradebook(request.gradebook, create=True) as book:
        warn_of_parts(book, request.part, rubric, warn)
        with one_total(terminal, len(intake)) if request.reports else nullcontext(terminal) as one:
            with _executor(request) as (executor, workers), one.show_class("grading") as show:
                batch = Batch(book, rubric, settings, executor, workers, show)
                done = _run(batch, intake, warn)
            _warn_lines(batch.notes, warn)
            errored = f" ({done.errored} errored)" if done.errored else ""
            ((unread,),) = book.rows(_UNREADABLE, str(request.root))
            unread = f" ({unread} could not be graded)" if unread and done.unchanged else ""
            warn(f"{done.graded} graded{errored}, {done.unchanged} unchanged{unread}")
            with_fixes = _search_hints(request, book, one)
            _write_files(request, book, deadline, one)
        summary = SummaryRequest(request.output_format, with_fixes, request.verbose)
        return class_summary(Grades(book, deadline), summary, terminal.screen(), done)


def _write_files(request: ClassRequest, book: Gradebook, deadline: datetime | None, terminal: Terminal) -> None:
    """Write the students' reports and the grades."""
    if request.reports is not None:
        from grader.usecases.class_reports import REPORT_SECONDS, ReportRun, write_reports  # late: few runs write them

        run = ReportRun(request.gradebook, request.reports, request.report_format, deadline)
        workers = Processes(request.jobs or processors(), REPORT_SECONDS)
        with workers, terminal.show_class("writing reports") as show:
            write_reports(workers, run, terminal.warn, show)
    if request.csv is not None:
        from grader.usecases.grade_files import grades_csv

        save(request.csv, grades_csv(Grades(book, deadline)), (request.root,))


def _search_hints(request: ClassRequest, book: Gradebook, terminal: Terminal) -> bool:
    """Search the hints of reports and of the class; return whether all were searched that statistics need."""
    if request.force:
        remove_hints(book)
    options = HintOptions(request.jobs, request.timeout)
    is_json, reports = request.output_format is OutputFormat.JSON, request.reports is not None
    statistics = is_json or (reports and Format.HTML in request.report_format)
    search_class_hints(book, options, terminal, reports=reports, statistics=statistics)
    return is_json


@contextmanager
def _executor(request: ClassRequest) -> Iterator[tuple[Executor, int]]:
    """Open what runs the tasks; yield it with the number of tasks at a time."""
    if request.cluster is None:
        with Processes(workers := request.jobs or processors(), request.timeout) as local:
            yield local, workers
        return
    from grader.classroom.run.cluster import Cluster

    with Cluster(request.cluster, request.timeout, request.root) as remote:
        yield remote, remote.workers


def _run(batch: Batch, intake: Intake, warn: Warn) -> Progress:
    """Grade new and changed submissions; after an interruption, report which results are kept."""
    try:
        return batch.grade(intake)
    except BaseException:
        if batch.has_begun:
            graded = f"{batch.progress.done} of {len(intake)} have a result, which is kept"
            warn(f"stopped: {graded}; rerun the same command to resume")
        raise


def _warn_of_intake(intake: Intake, warn: Warn) -> None:
    """Say how many submissions there are, which are unmatched, and which files are ignored."""
    warn(f"{counted(len(intake), 'submission')}, layout {intake.layout}")
    unmatched = [f"unmatched: {key} is not on the roster" for key in intake.unmatched]
    for lines in (intake.notes, unmatched, [f"ignored: {line}" for line in intake.ignored]):
        _warn_lines(lines, warn)


def _warn_lines(lines: Sequence[str], warn: Warn) -> None:
    for line in first_lines(lines, _MAX_LINES):
        warn(printable(line))


def _refuse_targets(request: ClassRequest) -> None:
    """Raise InputError for files that cannot be written in the end, or would be submissions in the next run."""
    reports, csv, root = request.reports, request.csv, request.root
    for path in filter(None, (request.gradebook, csv)):
        refuse_symlinks(path, (root,))
    if reports is not None:
        from grader.usecases.class_reports import refuse_report_folder

        refuse_report_folder(reports, request.report_format, (root,))
    if csv is not None and not csv.resolve().parent.is_dir():
        raise missing_folder(csv)
    if csv is not None:
        refuse_gradebook(csv, request.gradebook)
        _refuse_inputs(csv, request)


def _refuse_inputs(csv: Path, request: ClassRequest) -> None:
    """Raise InputError if the grades would replace a file that the command reads, or be in the class folder."""
    roster = [request.roster] if request.roster is not None else []
    refuse_inputs("--csv", csv, [*roster, *files_of(request.rubric or "", request.answers), *request.ignore_file])
    if request.root in (csv.resolve(), *csv.resolve().parents):
        raise InputError(
            f"cannot write {printable_path(csv)}: the next run would take it for a submission; "
            "choose a file outside of the class"
        )
