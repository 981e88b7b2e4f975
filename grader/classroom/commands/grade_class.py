"""Grade a class into its gradebook, and write its grades and reports.

The inputs are the options of the command, else what the gradebook has of the last run; it gets
copies of them.
"""

import gc
import os
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from math import isfinite
from pathlib import Path
from typing import Any

from grader import __version__
from grader.base.errors import GraderError, InputError
from grader.base.grouping import known_values
from grader.base.text import (
    MAX_NAMED,
    counted,
    enumerated,
    first_lines,
    printable,
    printable_path,
    shell_quoted,
)
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades_file import write_grades
from grader.classroom.gradebook.student_grade import StudentGrade
from grader.classroom.intake.submissions import Intake, read_class
from grader.classroom.lms.forms import FORMS
from grader.classroom.marks import gradebook_folder as names
from grader.classroom.marks.gradebook_folder import (
    CLASS_FILE,
    ClassSettings,
    read_settings,
    relative,
    settings_text,
)
from grader.classroom.reports.class_figures import append_run, warn_of_ignored
from grader.classroom.reports.class_reports import ReportRun, refuse_report_folder, write_reports
from grader.classroom.reports.class_terminal import ClassTable
from grader.classroom.results.equal_work import hash_handed_out
from grader.classroom.results.results import (
    Results,
    ResultsWriter,
    Run,
    hash_values,
    time_of_run,
)
from grader.classroom.roster.lateness import read_time, time_text
from grader.classroom.roster.roster import Roster, read_roster
from grader.classroom.run.batch_run import Batch
from grader.classroom.run.batch_worker import ClassContext, reference_hashes
from grader.classroom.run.preloading import PRELOAD
from grader.classroom.tables import SIZE_LIMIT
from grader.files.reading import hash_bytes, read_capped
from grader.lab.rubric.rubric import Rubric, load_rubric
from grader.lab.rubric.rubric_files import DEFAULT_RUBRIC, list_files
from grader.lab.submission.opening import open_submission
from grader.report.formats import Format, OutputFormat
from grader.report.invocation import read_arguments
from grader.report.screen import draw
from grader.report.writing import Terminal, Warn, refuse_symlinks, save, save_bytes
from grader.workers.pool import Processes, processors
from grader.workers.queue import Progress

_MAX_LINES = 10
_LEAST_SECONDS = 15.0  # in which hints are searched, and a few reports written
_PRIVATE = 0o600
_FORMAT = 3  # of results: those of another one are graded again
_Paths = Sequence[Path]


@dataclass(frozen=True, slots=True)
class ClassRequest:
    """The options of `grader batch`.

    Up to `max_size`, None stands for what the gradebook keeps of the last run; it does not keep the
    others.
    """

    paths: _Paths | None  # the class folders or zips
    gradebook: Path | None
    rubric: str | None  # an id or a file
    usual_rubric: str  # of a new gradebook, if no other one is named
    roster: Path | None
    due: str | None  # the deadline
    layout: str | None
    assignment: str | None  # of nbgrader
    ignore: Sequence[str] | None  # names of entries that are no student's
    part: Sequence[str] | None  # the ids of the parts to grade
    arg: Sequence[str] | None  # NAME=VALUE, of xacro
    ignore_file: _Paths | None  # starter files
    max_size: int | None  # of a URDF, in bytes
    jobs: int | None  # worker processes
    timeout: float  # for a submission, in seconds of processor time
    force: bool  # whether unchanged submissions are graded again
    cluster: str | None  # the address of a Dask scheduler
    reports: Path | None  # the folder to write reports into
    report_format: Sequence[Format] | None
    answers: Path | None  # the model answers
    verbose: bool  # whether the table lists all students
    output_format: OutputFormat


@dataclass(frozen=True, slots=True)
class _ClassInputs:
    """What a run reads: the gradebook and its settings, the rubric as it was named, the roster."""

    folder: Path
    settings: ClassSettings
    rubric: Rubric
    roster: Roster | None

    @property
    def roots(self) -> _Paths:
        """The absolute paths of the submissions."""
        return self.settings.roots(self.folder)

    @property
    def near_roots(self) -> _Paths:
        """The same, relative to the current folder if they are in it."""
        here = Path.cwd()
        return tuple(
            root.relative_to(here) if root.is_relative_to(here) else root for root in self.roots
        )


def _refuse_other_rubric(folder: Path, settings: ClassSettings, rubric: Rubric) -> None:
    """Raise InputError if a gradebook is that of another rubric."""
    if settings.rubric_id not in ("", rubric.id):
        raise InputError(
            f"{printable_path(folder)} is the gradebook of {settings.rubric_id}, not of "
            f"{rubric.id}: name another folder"
        )


def _read_inputs(options: ClassRequest, warn: Warn) -> _ClassInputs:
    """Return the inputs of a run; raise InputError and RubricError. Nothing is written."""
    usual = load_rubric(options.usual_rubric)
    named_rubric = load_rubric(options.rubric) if options.rubric is not None else None
    folder = options.gradebook or Path(f"{(named_rubric or usual).id}-grades")
    is_new = not names.is_gradebook(folder)
    names.check_free(folder)
    settings = ClassSettings() if is_new else read_settings(folder)
    rubric = usual
    if named_rubric:
        rubric = named_rubric
        _refuse_other_rubric(folder, settings, rubric)
    elif not is_new:
        rubric = load_rubric(folder / settings.rubric)
        if options.usual_rubric != DEFAULT_RUBRIC and usual.id != rubric.id:
            warn(
                f"{printable_path(folder)} keeps its rubric {rubric.id}, not {usual.id}: "
                "name it with --rubric"
            )
    if not (options.paths or settings.submissions):
        raise InputError("name the PATH of the submissions, a folder or the zip of an LMS")
    last_due = settings.deadline(folder) if options.due is None else None
    if last_due is not None:
        time = time_text(last_due, last_due.tzinfo)
        warn(f"deadline of the last run: {time} (--due changes it)")
    roster = _read_roster(options.roster, folder, settings)
    inputs = _ClassInputs(folder, _updated(options, settings, folder, rubric), rubric, roster)
    if not options.paths:
        _check_roots(inputs.near_roots)
    return inputs


def _read_roster(file: Path | None, folder: Path, settings: ClassSettings) -> Roster | None:
    """Return the roster in a file, else that of the gradebook, if it has one."""
    if not file:
        names.check_roster(folder, settings)
        file = folder / names.ROSTER
        if not file.exists():
            return None
    return read_roster(_read_csv(file), printable_path(file))


def _check_roots(roots: Iterable[Path]) -> None:
    """Raise InputError if class folders of the last run are gone."""
    gone = [printable_path(root) for root in roots if not root.exists()]
    if gone:
        raise InputError(
            f"{enumerated(gone)} of the last run cannot be found: name the new PATH; of "
            "several sections, name all"
        )


def _updated(
    options: ClassRequest, settings: ClassSettings, folder: Path, rubric: Rubric
) -> ClassSettings:
    """Return the settings with the options of the command."""
    for name in options.part or ():
        rubric.part(name)
    paths = tuple(relative(path, folder) for path in options.paths or ())
    if {*paths} <= {*settings.submissions}:
        paths = ()  # a section alone: the others stay
    settings = replace(settings, **_changes_by_options(options, paths))
    if options.ignore_file or not settings.handed_out:
        handed_out = [
            *_handed_out(options.ignore_file or (), rubric),
            *reference_hashes(rubric.data, str(rubric.path)),
        ]
        settings = replace(settings, handed_out=tuple(handed_out))
    return settings


def _changes_by_options(options: ClassRequest, paths: Sequence[str]) -> dict[str, Any]:
    """Return the settings that the options of the command give, by their names."""
    given = {  # None where the option is not given
        "due": read_time(options.due).isoformat() if options.due else None,
        "layout": options.layout,
        "assignment": options.assignment,
        "ignore": tuple(options.ignore or ()) or None,
        "parts": tuple(options.part or ()) or None,
        "arguments": read_arguments(options.arg or ()) or None,
        "max_size": options.max_size,
        "submissions": paths or None,
    }
    return known_values(given)


def _handed_out(files: _Paths, rubric: Rubric) -> Iterator[str]:
    """Yield the hashes of the work that the course handed out.

    Raises InputError for a file without any.
    """
    for path in files:
        hashes = hash_handed_out(open_submission(str(path), rubric.lab), rubric)
        if not hashes:
            raise InputError(f"--ignore-file {printable_path(path)}: there is no URDF in it")
        yield from hashes


def _keep_inputs(inputs: _ClassInputs, options: ClassRequest, warn: Warn) -> _ClassInputs:
    """Write the settings and the copies of the roster and the rubric into the gradebook.

    Raises InputError.
    """
    folder = inputs.folder
    settings = inputs.settings
    rubric = inputs.rubric
    if options.roster:
        roster = _read_csv(options.roster)
        copy = folder / names.ROSTER
        roster_hash = hash_bytes(roster)
        _warn_of_edits(copy, (settings.roster_hash, roster_hash), options.roster, warn)
        save_bytes(copy, roster, inputs.roots, _PRIVATE)
        settings = replace(settings, roster_hash=roster_hash)
    if options.rubric is not None or not settings.rubric:
        known = (settings.rubric_hash, rubric.sha256)
        _warn_of_edits(folder / settings.rubric, known, rubric.path, warn)
        settings = replace(
            settings,
            rubric=_copy_rubric(folder, rubric),
            rubric_id=rubric.id,
            rubric_hash=rubric.sha256,
        )
    if not (folder / CLASS_FILE).exists() or settings != read_settings(folder):
        save(folder / CLASS_FILE, settings_text(settings), inputs.roots, _PRIVATE)
    return replace(inputs, settings=settings, rubric=load_rubric(folder / settings.rubric))


def _warn_of_edits(file: Path, known: Sequence[str], new: Path, warn: Warn) -> None:
    """Say that a copy which a person has edited is replaced."""
    if file.is_file() and hash_bytes(_read_csv(file)) not in known:
        warn(f"{printable_path(file)} was edited: it is replaced by {printable_path(new)}")


def _read_csv(file: Path) -> bytes:
    return read_capped(file, SIZE_LIMIT, advice="")


def _copy_rubric(folder: Path, rubric: Rubric) -> str:
    """Copy a rubric and its reference into a gradebook, placed to each other as before.

    Return where it is.
    """
    target = folder / names.RUBRIC
    rubric_file = rubric.path.resolve()
    is_movable = not Path(rubric.reference).is_absolute()
    sources = []
    for file in list_files(str(rubric.path)):
        is_copied = file.name != rubric.answers and file.exists()
        if is_copied and (is_movable or file == rubric.path):
            sources.append(file.resolve())
    base = Path(os.path.commonpath([file.parent for file in sources]))
    copies = {}
    for source in sources:
        for path in (source, *source.rglob("*")):
            if path.is_file() and path.parent.name != "__pycache__":
                copies[target / path.relative_to(base)] = path
    copy = target / rubric_file.relative_to(base)
    copies.pop(copy, None)
    copies[copy] = rubric_file  # last: when all that it needs is there
    try:
        for place, path in copies.items():
            place.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
            save_bytes(place, path.read_bytes(), (), _PRIVATE)
        for path in target.rglob("*"):
            if path.is_file() and path not in copies:
                path.unlink()
    except OSError as error:
        raise InputError(f"cannot write {printable_path(target)}: {error.strerror}") from None
    return copy.relative_to(folder).as_posix()


def grade_class(request: ClassRequest, terminal: Terminal) -> str:
    """Grade a class and return its table. Raises InputError and RubricError."""
    gc.freeze()  # loaded modules are not garbage
    gc.set_threshold(50_000)
    gc.enable()  # unlike other commands, this one may run for long
    if not isfinite(request.timeout):
        raise InputError(f"--timeout takes a number of seconds, not {request.timeout}")
    inputs = _read_inputs(request, terminal.warn)
    folder = inputs.folder
    rubric = inputs.rubric
    if request.due and not rubric.late:
        terminal.warn(
            f"--due has no effect on grades, because the rubric {rubric.id} has no [late]: only "
            "the days late are shown"
        )
    if request.reports:
        refuse_report_folder(request.reports, inputs.roots)
    intake = _read_class(inputs, terminal.warn)
    refuse_symlinks(folder, inputs.roots)
    names.make_gradebook(folder)
    names.warn_without_locks(folder, terminal.warn)
    with names.batch_lock(folder):
        results = Results(folder / names.RESULTS)
        _check_same_class(folder, results, intake)
        if results.runs and results.runs[-1].rubric != rubric.sha256:
            # An old rubric that an edit broke raises: then its grades are not compared.
            with suppress(GraderError):
                results = append_run(Gradebook(folder)) or results
        inputs = _keep_inputs(inputs, request, terminal.warn)
        table, done = _grade(request, inputs, results, intake, terminal)
    formats = tuple(request.report_format or ())
    if request.reports and not formats:
        formats = (Format.TERMINAL,)
    if formats:
        run = ReportRun(folder, request.reports or folder / names.REPORTS, formats, request.answers)
        write_reports(run, terminal, request.jobs, max(request.timeout, _LEAST_SECONDS))
    if request.output_format is OutputFormat.JSON:
        from grader.classroom.reports.class_json import render_class_json

        return render_class_json(Gradebook(folder), done)
    table.ending = _ending(folder, table, intake.layout)
    return draw(table.print, terminal.screen())


def _read_class(inputs: _ClassInputs, warn: Warn) -> Intake:
    """Return the submissions of the class, and say what was found."""
    settings = inputs.settings
    rubric = inputs.rubric
    intake = read_class(
        inputs.near_roots,
        inputs.roster,
        settings.layout,
        settings.assignment,
        rubric.id,
        rubric.folders,
        settings.ignore,
        inputs.folder,
    )
    works = {(submission.root, submission.paths) for submission in intake.submissions}
    warn(f"{counted(len(works), 'submission')}, layout {intake.layout}")
    ignored = [f"ignored: {line}" for line in intake.ignored]
    for lines in (intake.notes, intake.unmatched, ignored):
        for line in first_lines(lines, _MAX_LINES):
            warn(printable(line))
    return intake


def _ending(folder: Path, table: ClassTable, layout: str) -> str:
    """Return where the grades are, how many students need attention, and the next command."""
    gradebooks = [file.parent.resolve() for file in Path().glob(f"*/{CLASS_FILE}")]
    lms = layout if layout in FORMS else "csv"
    command = "grader review" if table.open else f"grader export {lms}"
    if gradebooks != [folder.resolve()]:
        command += f" --gradebook {shell_quoted(folder)}"
    parts = [f"grades: {printable_path(folder / names.GRADES)}"]
    if table.attention == 1:
        parts.append("1 needs attention")
    elif table.attention:
        parts.append(f"{table.attention} need attention")
    return " · ".join([*parts, f"next: {command}"])


def _grade(
    request: ClassRequest,
    inputs: _ClassInputs,
    results: Results,
    intake: Intake,
    terminal: Terminal,
) -> tuple[ClassTable, Progress]:
    """Grade what has no current result, append the run, and write the grades of the class."""
    folder = inputs.folder
    rubric = inputs.rubric
    settings = inputs.settings
    shared = ClassContext(
        tuple(map(str, inputs.roots)),
        rubric.data,
        str(rubric.path.resolve()),
        settings.max_size,
        settings.parts,
        dict(settings.arguments),
        request.timeout,
    )
    context = _context(inputs)
    present = dict.fromkeys(submission.student.key for submission in intake.submissions)
    with ResultsWriter(folder / names.RESULTS, results.end) as writer:
        batch = Batch(results, writer, shared, context)
        done = _batch(request, inputs, batch, intake, terminal)
        run = Run(
            results.next_run,
            time_of_run(),
            __version__,
            rubric.sha256,
            context,
            present,
            sorted(intake.unclear),
        )
        book = Gradebook(folder, run=run)
        table = ClassTable(rubric.title, book.maximum, verbose=request.verbose)
        recorded = {}
        timeouts = {}

        def passing() -> Iterator[StudentGrade]:
            for grade in book:
                table.add(grade)
                recorded[grade.student.key] = book.run_grade(grade)
                if grade.stored and grade.stored.timeout:
                    timeouts[grade.student.key] = grade.stored.timeout
                yield grade

        write_grades(book, passing())
        writer.append(book.run_with(recorded)._replace(written=sorted(batch.written)).line)
        writer.sync()
    warn_of_ignored(book, terminal.warn)
    if timeouts:
        shown = printable(enumerated(sorted(timeouts), MAX_NAMED))
        seconds = 2 * max(timeouts.values())
        again = f"grader batch --gradebook {shell_quoted(folder)} --timeout {seconds:g}"
        terminal.warn(f"not graded again, because it takes too long: {shown}; `{again}` tries it")
    return table, done


def _context(inputs: _ClassInputs) -> str:
    """Return the hash of all that results depend on besides the submissions."""
    folder = inputs.folder
    settings = inputs.settings
    # The copy of the rubric has the reference with it.
    files = sorted(path for path in (folder / names.RUBRIC).rglob("*") if path.is_file())
    contents = [(path.relative_to(folder).as_posix(), path.read_bytes()) for path in files]
    options = settings.parts, sorted(settings.arguments.items()), settings.max_size
    reference = hash_bytes(repr(contents).encode())
    return hash_values(inputs.rubric.sha256, reference, *options, __version__, _FORMAT)


def _batch(
    request: ClassRequest, inputs: _ClassInputs, batch: Batch, intake: Intake, terminal: Terminal
) -> Progress:
    """Grade what has no current result, and say how many that were."""
    with _executor(request, inputs) as (executor, workers), terminal.show_class("grading") as show:
        try:
            done = batch.grade(intake.submissions, executor, workers, show, force=request.force)
        except BaseException:
            graded = f"{batch.kept} of {batch.progress.total} have a result, which is kept"
            terminal.warn(f"stopped: {graded}; rerun the same command to resume")
            raise
    errored = f" ({done.errored} errored)" if done.errored else ""
    unreadable = f", {done.unreadable} unreadable" if done.unreadable else ""
    graded = f"{done.graded - done.unreadable} graded{errored}{unreadable}"
    terminal.warn(f"{graded}, {done.unchanged} unchanged")
    return done


@contextmanager
def _executor(request: ClassRequest, inputs: _ClassInputs) -> Iterator[tuple[Executor, int]]:
    """Open what runs the tasks; yield it with the number of tasks at a time."""
    if request.cluster is None:
        workers = request.jobs or processors()
        with Processes(workers, request.timeout, preload=PRELOAD) as local:
            yield local, workers
        return
    from grader.workers.cluster import Cluster

    with Cluster(request.cluster, request.timeout, inputs.roots, PRELOAD) as remote:
        yield remote, remote.workers


def _check_same_class(folder: Path, results: Results, intake: Intake) -> None:
    """Raise InputError if most of the students who submitted in the last run are missing."""
    recorded = results.runs[-1].totals if results.runs else {}
    here = intake.unclear | {one.student.key for one in intake.submissions}
    missing = sorted(recorded.keys() - here)
    if 2 * len(missing) > len(recorded):
        raise InputError(
            f"{printable_path(folder)} is the gradebook of another class, or a section is missing: "
            f"{counted(len(missing), 'student')} of {len(recorded)} have no submission now "
            f"({printable(enumerated(missing, MAX_NAMED))}); name the paths of all "
            "sections, or another --gradebook"
        )
