"""Grade a class into its gradebook, and write its grades and reports."""

import gc
from collections.abc import Iterable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from datetime import UTC, datetime
from math import isfinite
from pathlib import Path

from grader import __version__
from grader.classroom import gradebook_folder as names
from grader.classroom.batch import Batch
from grader.classroom.batch_worker import ClassContext
from grader.classroom.gradebook import Gradebook, grade_table
from grader.classroom.results import Results, ResultsWriter, Run, digest_of
from grader.classroom.student_grade import StudentGrade
from grader.classroom.submissions import Intake, read_class
from grader.classroom.tables import write_table
from grader.classroom.workers.pool import Processes, processors
from grader.classroom.workers.queue import Progress
from grader.commands.class_figures import warn_of_ignored
from grader.commands.class_inputs import ClassInputs, ClassRequest, keep_inputs, read_inputs
from grader.commands.class_reports import ReportRun, refuse_report_folder, write_reports
from grader.commands.terminal import Terminal
from grader.commands.writing import refuse_symlinks, save
from grader.errors import InputError
from grader.files.reading import sha256_of
from grader.report.class_terminal import ClassTable
from grader.report.formats import Format, OutputFormat
from grader.report.screen import draw
from grader.text import counted, enumerated, first_lines, format_points, printable, printable_path

_MAX_LINES, _MAX_NAMED = 10, 5
_LEAST_SECONDS = 15.0  # in which hints are searched, and a few reports written
_PRIVATE = 0o600


def grade_class(request: ClassRequest, terminal: Terminal) -> str:
    """Grade a class and return its table. Raises InputError and RubricError."""
    gc.freeze()  # loaded modules are not garbage
    gc.set_threshold(50_000)
    gc.enable()  # unlike other commands, this one may run for long
    if not isfinite(request.timeout):
        raise InputError(f"--timeout takes a number of seconds, not {request.timeout}")
    warn, inputs = terminal.warn, read_inputs(request, terminal.warn)
    folder, rubric, settings = inputs.folder, inputs.rubric, inputs.settings
    if request.due and rubric.late is None:
        no_late = f"because the rubric {rubric.id} has no [late]: only the days late are shown"
        warn(f"--due has no effect on grades, {no_late}")
    if request.reports is not None:
        refuse_report_folder(request.reports, inputs.roots)
    intake = read_class(
        inputs.near_roots, inputs.roster, settings.layout, settings.assignment, rubric.id, rubric.folders
    )
    warn(f"{counted(len(intake.submissions), 'submission')}, layout {intake.layout}")
    for lines in (intake.notes, intake.unmatched, [f"ignored: {line}" for line in intake.ignored]):
        for line in first_lines(lines, _MAX_LINES):
            warn(printable(line))
    refuse_symlinks(folder, inputs.roots)
    names.make_gradebook(folder)
    with names.batch_lock(folder):
        results = Results(folder / names.RESULTS)
        _check_same_class(folder, results, intake)
        inputs = keep_inputs(inputs, request, warn)
        table, done = _grade(request, inputs, results, intake, terminal)
    if formats := tuple(request.report_format or [Format.TERMINAL] * (request.reports is not None)):
        run = ReportRun(folder, request.reports or folder / names.REPORTS, formats, request.answers)
        write_reports(run, terminal, request.jobs, max(request.timeout, _LEAST_SECONDS))
    if request.output_format is OutputFormat.JSON:
        from grader.report.class_json import render_class_json

        return render_class_json(Gradebook(folder), done)
    return draw(table.print, terminal.screen())


def _grade(
    request: ClassRequest, inputs: ClassInputs, results: Results, intake: Intake, terminal: Terminal
) -> tuple[ClassTable, Progress]:
    """Grade what has no current result, append the run, and write the grades of the class."""
    folder, rubric, settings = inputs.folder, inputs.rubric, inputs.settings
    roots, arguments = tuple(map(str, inputs.roots)), dict(settings.arguments)
    shared = ClassContext(roots, rubric.data, str(rubric.path.resolve()), settings.max_size, settings.parts, arguments)
    copies = sorted(path for path in (folder / names.RUBRIC).rglob("*") if path.is_file())  # with the reference
    reference = sha256_of(repr([(path.relative_to(folder).as_posix(), path.read_bytes()) for path in copies]).encode())
    options = settings.parts, sorted(arguments.items()), settings.max_size
    context = digest_of(rubric.sha256, reference, *options, __version__)
    present = dict.fromkeys(one.student.key for one in intake.submissions)
    with ResultsWriter(folder / names.RESULTS, results.end) as writer:
        done = _batch(request, inputs, Batch(results, writer, shared, context), intake, terminal)
        time = datetime.now(UTC).isoformat(timespec="milliseconds")
        run = Run(results.next_run, time, __version__, rubric.sha256, context, present, sorted(intake.unclear))
        book, table = Gradebook(folder, run=run), ClassTable(rubric, verbose=request.verbose)
        totals: dict[str, str | None] = {}
        others: dict[str, str] = {}

        def passing() -> Iterator[StudentGrade]:
            for grade in book:
                table.add(grade)
                total = format_points(grade.published) if grade.published is not None else None
                if grade.student.key in present:
                    totals[grade.student.key] = total
                elif total is not None:
                    others[grade.student.key] = total
                yield grade

        write_grades(book, passing())
        writer.append(run._replace(totals=totals, others=others).line)
        writer.sync()
    warn_of_ignored(book, terminal.warn)
    return table, done


def _batch(request: ClassRequest, inputs: ClassInputs, batch: Batch, intake: Intake, terminal: Terminal) -> Progress:
    """Grade what has no current result, and say how many that were."""
    with _executor(request, inputs) as (executor, workers), terminal.show_class("grading") as show:
        try:
            done = batch.grade(intake.submissions, executor, workers, show, force=request.force)
        except BaseException:
            graded = f"{batch.progress.done} of {batch.progress.total} have a result, which is kept"
            terminal.warn(f"stopped: {graded}; rerun the same command to resume")
            raise
    errored = f" ({done.errored} errored)" if done.errored else ""
    terminal.warn(f"{done.graded} graded{errored}, {done.unchanged} unchanged")
    return done


@contextmanager
def _executor(request: ClassRequest, inputs: ClassInputs) -> Iterator[tuple[Executor, int]]:
    """Open what runs the tasks; yield it with the number of tasks at a time."""
    if request.cluster is None:
        with Processes(workers := request.jobs or processors(), request.timeout) as local:
            yield local, workers
        return
    from grader.classroom.workers.cluster import Cluster

    with Cluster(request.cluster, request.timeout, inputs.roots) as remote:
        yield remote, remote.workers


def write_grades(book: Gradebook, grades: Iterable[StudentGrade] | None = None) -> None:
    """Write the grades of a class, by default the current ones, into its gradebook. Raises InputError."""
    table = write_table(*grade_table(book, book if grades is None else grades))
    save(book.folder / names.GRADES, table, book.settings.roots(book.folder), _PRIVATE)


def _check_same_class(folder: Path, results: Results, intake: Intake) -> None:
    """Raise InputError if most of the students who submitted in the last run are missing."""
    recorded = results.runs[-1].totals if results.runs else {}
    here = intake.unclear | {one.student.key for one in intake.submissions}
    missing = sorted(recorded.keys() - here)
    if 2 * len(missing) > len(recorded):
        raise InputError(
            f"{printable_path(folder)} is the gradebook of another class, or a section is missing: "
            f"{counted(len(missing), 'student')} of {len(recorded)} have no submission now "
            f"({printable(enumerated(missing, _MAX_NAMED))}); name the paths of all sections, or another --gradebook"
        )
