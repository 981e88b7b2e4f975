"""Write a report for each student of a class, and the class's page beside reports in HTML."""

import re
import unicodedata
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache, partial
from itertools import starmap
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple
from urllib.parse import quote

from grader import __version__
from grader.base.errors import InputError, MachineError, RubricError
from grader.base.patterns import on_use
from grader.base.text import (
    by_name,
    counted,
    counted_points,
    enumerated,
    format_points,
    named,
    printable,
    printable_path,
    without_commands,
)
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.student_grade import Reason, StudentGrade
from grader.classroom.marks import gradebook_folder as names
from grader.classroom.reports.kept_reports import KeptReports, WrittenReport
from grader.classroom.results.results import StoredResult, hash_values
from grader.classroom.run.preloading import PRELOAD
from grader.files.reading import hash_bytes
from grader.lab.checks.outcome import Outcome
from grader.lab.grading.grade import grade as grade_opened
from grader.lab.grading.report import Grade, Report, Result
from grader.lab.submission.submission import Submission
from grader.report.formats import Format, render
from grader.report.writing import Terminal, make_folder, refuse_symlinks, save
from grader.ros.api import Absent
from grader.workers.pool import Processes, WorkerError, processors
from grader.workers.queue import Progress, Queue

if TYPE_CHECKING:
    from grader.report.drawing.still import Still

# No device of Windows, no class's page, and nothing that ends like a name with a digest.
_SAFE = on_use(
    r"(?i)(?!(?:con|prn|aux|nul|com\d|lpt\d)(?:\.|$)|index$|.*-[0-9a-f]{64}$)[\w=][\w.@+=,'()-]{0,39}(?<!\.)"
)
_CLASS_PAGE = "index.html"
_TASK_SIZE = 4  # reports
_SECONDS = 60.0  # in which hints are searched, and a few reports written
_NOTHING = Outcome("skipped", "not graded, because nothing was submitted")
_SUBMIT_AGAIN = "Nothing could be graded: pack the files as .zip or .tar.gz, and submit them again."
_MOVED = (
    "The submission has moved or changed since it was graded, so this report has no details: "
    "run `grader batch` again."
)
_TextOf = Mapping[str, str]  # by the key of a student


class ReportRun(NamedTuple):
    """The reports to write of a gradebook."""

    gradebook: Path
    folder: Path  # to write into
    formats: Sequence[Format]
    answers: Path | None = None  # the model answers
    class_page: str = ""  # its address as seen from a report, if it is written
    time: str = ""  # of the newest run: workers read the gradebook once for it


class _Done(NamedTuple):
    """A report that was written, or why it was not; with the hints that were searched for it."""

    key: str  # of the student
    why_lost: str = ""
    hints: str = ""  # their key
    new_hints: Mapping[str, Mapping[str, Any]] = {}
    is_final: bool = False  # whether it would be the same in the next run
    still: "Still" = ()  # the small picture of the robot for the class's page


class _ReportTask(NamedTuple):
    """A report to write: the student and the name of the file.

    The report has no hints if their search was lost.
    """

    key: str
    name: str
    has_hints: bool = True


def make_report(
    book: Gradebook,
    grade: StudentGrade,
    *,
    has_hints: bool = True,
    kept: KeptReports | None = None,
) -> Report:
    """Return the report on a student's submission, with the marks, the grade and notes.

    There is a note for a final mark, an excuse, a comment, a late penalty, and who graded if a
    person did. Without notes, the report is the same as that of `grader grade`. A submission that
    has changed since has its points only. Hints that are `kept` are not searched again.
    """
    if grade.stored:
        kept = kept or KeptReports(book.folder)
        again = _graded_again(book, grade, grade.stored, kept if has_hints else None)
        report, _ = book.with_marks(again, grade.stored)
    else:
        results = tuple(Result(criterion, _NOTHING) for criterion in book.criteria)
        nothing = Submission(grade.student.key, Absent(), is_single=False)
        report = Report(nothing, book.rubric, book.settings.parts, results)
    counting = None
    has_marks = any(result.manual_mark for result in report.results)
    if has_marks or grade.has_final or grade.late.points:
        counting = Grade(grade.total, grade.late.points, grade.final_points is not None)
    notes = (*report.notes, *list_notes(grade, report))
    return report._replace(notes=notes, grade=counting, student=grade.student.shown_name)


def list_notes(grade: StudentGrade, report: Report) -> Iterator[str]:
    """Yield the sentences about a whole submission.

    They are on the mark, the excuse or the comment of the whole, graders, and lateness.
    """
    mark = grade.final
    late = grade.late
    if mark:
        by = by_name(mark.by)
        what = f"Excused{by}." if grade.is_excused else f"Comment{by}:"
        if mark.points is not None:
            points = counted_points(mark.points)
            what = (
                f"Final mark: {points}, given{by or ' manually'} instead of the sum of the "
                "criteria."
            )
        yield " ".join((what, *mark.comment.split()))
    people = {row.manual_mark.by for row in report.results if row.manual_mark}
    if people and not grade.has_final:
        is_automatic = any(not (row.manual_mark or row.is_open) for row in report.results)
        graders = by_name(enumerated(sorted(filter(None, people))))
        yield f"Graded {'automatically, and manually' if is_automatic else 'manually'}{graders}."
    if late.points and grade.total is not None:
        points = format_points(-late.points)
        total = format_points(grade.total)
        yield f"{late.reason}: the late penalty is {points} points, the grade is {total}"
    elif late.reason:
        yield late.reason


def _graded_again(
    book: Gradebook, grade: StudentGrade, stored: StoredResult, kept: KeptReports | None
) -> Report:
    """Return the report on a submission as it was graded.

    It has its details if the submission is still there, and hints if what is kept of them is given.
    """
    submission = book.reopened(stored) if stored.verdict != "errored" else None
    if not submission:
        report = book.report(stored)
        if stored.verdict == "graded":
            return report._replace(notes=(_MOVED,))
        if Reason.UNREADABLE in grade.concerns:
            return report._replace(notes=(f"{stored.reason}. {_SUBMIT_AGAIN}",))
        return report
    report = grade_opened(book.rubric, submission, book.settings.parts, is_one_of_class=True)
    if not kept or book.rubric.hints == "none" or not report.has_failures:
        return report
    return kept.with_hints(report, submission, hash_values(stored.context, book.rubric.sha256))


def refuse_report_folder(folder: Path, submissions: Sequence[Path]) -> None:
    """Raise InputError if reports cannot be written to a folder.

    It is raised, too, if the next run would read the folder as a submission.
    """
    refuse_symlinks(folder, submissions)
    cannot = f"cannot write files to {printable_path(folder)}"
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{cannot}: it is not a folder")
    if not {folder.resolve(), *folder.resolve().parents}.isdisjoint(submissions):
        why = (
            "the next run would take them for a submission; choose a folder outside of the "
            "class folder"
        )
        raise InputError(f"{cannot}: {why}")


def _keep(
    kept: KeptReports,
    done: Mapping[str, _Done],
    paths: Mapping[str, Sequence[Path]],
    shown: _TextOf,
) -> dict[str, Mapping[str, Any]]:
    """Keep what is known of the reports that were written, by their paths.

    Return the hints that were searched for them.
    """
    new_hints = dict[str, Mapping[str, Any]]()
    for key, one in done.items():
        new_hints |= one.new_hints
        for path in paths[key]:
            kept.written.pop(str(path), None)
            if one.is_final:
                data = hash_bytes(path.read_bytes())
                kept.written[str(path)] = WrittenReport(shown[key], data, one.hints, one.still)
    return new_hints


def write_reports(
    run: ReportRun, terminal: Terminal, jobs: int | None = None, timeout: float = _SECONDS
) -> None:
    """Write a report for each student who has a result, a final mark or an excuse.

    In HTML, also write the class's page.

    Raises InputError and RubricError, which concern all reports.
    """
    make_folder(run.folder)
    book = Gradebook(run.gradebook)
    kept = KeptReports(run.gradebook)
    grades = [grade for grade in book if grade.stored or grade.has_final]
    files = file_names([grade.student.key for grade in grades])
    run = run._replace(time=book.run.time)
    if Format.HTML in run.formats:
        run = run._replace(class_page=_path_of_class_page(run))
    paths = {key: _list_paths(run, name) for key, name in files.items()}
    context = _context(book, run)
    shown = {grade.student.key: _shown_in(book, grade, context) for grade in grades}
    changed = {}
    for key in _find_outdated(kept, shown, paths):
        changed[key] = files[key]
    done = _render_reports(run, changed, terminal, jobs, timeout) if changed else {}
    if done:
        kept.save(_keep(kept, done, paths, shown), book.roots)
    lost = {key: one.why_lost for key, one in done.items() if one.why_lost}
    if Format.HTML in run.formats:
        pages = {}
        first_paths = {}
        for key, name in files.items():
            if key not in lost:
                pages[key] = name
                first_paths[key] = str(paths[key][0])
        _place_class_page(book, run, pages, _collect_stills(done, kept, first_paths))
    _tell_written(book, run, len(files) - len(lost), lost, terminal)


def _path_of_class_page(run: ReportRun) -> str:
    """Return the path of the class's page from the reports.

    It is beside them, but in the gradebook above those in its own folder.
    """
    is_in_gradebook = run.folder == run.gradebook / names.REPORTS
    return f"../{_CLASS_PAGE}" if is_in_gradebook else _CLASS_PAGE


def _find_outdated(
    kept: KeptReports, shown: _TextOf, paths: Mapping[str, Sequence[Path]]
) -> list[str]:
    """Return the students whose reports do not show what they should."""
    outdated = []
    for key, what_is_shown in shown.items():
        if not all(kept.is_current(path, what_is_shown) for path in paths[key]):
            outdated.append(key)
    return outdated


def _collect_stills(
    done: Mapping[str, _Done], kept: KeptReports, paths: _TextOf
) -> "dict[str, Still]":
    """Return the small pictures of students' robots, of new and of older reports."""
    stills = {}
    for key, path in paths.items():
        stills[key] = done[key].still if key in done else kept.written[path].still
    return stills


def _place_class_page(
    book: Gradebook, run: ReportRun, files: _TextOf, stills: Mapping[str, "Still"]
) -> None:
    """Write the class's page beside the reports, or in the gradebook above its own folder."""
    if run.folder == run.gradebook / names.REPORTS:
        pages = {key: f"{names.REPORTS}/{name}" for key, name in files.items()}
        write_class_page(book, run.gradebook, pages, stills)
    else:
        write_class_page(book, run.folder, files, stills)


def _tell_written(
    book: Gradebook, run: ReportRun, count: int, lost: _TextOf, terminal: Terminal
) -> None:
    """Print how many reports were written, and why others were not."""
    terminal.warn(f"{counted(count, 'report')} written to {printable_path(run.folder)}")
    for key, why in lost.items():
        who = named(key, book.grade(key).student.name)
        terminal.warn(printable(f"no report for {who}: {why}"))


def _list_paths(run: ReportRun, name: str) -> list[Path]:
    """Return the paths of the files of a student's report."""
    return [run.folder.resolve() / f"{name}.{kind.ending}" for kind in run.formats]


def _context(book: Gradebook, run: ReportRun) -> str:
    """Return the hash of all that reports depend on besides the students and their submissions."""
    answers = run.answers.read_bytes() if run.answers else b""
    files = sorted(path for path in (book.folder / names.RUBRIC).rglob("*") if path.is_file())
    rubric = [(str(path), hash_bytes(path.read_bytes())) for path in files]
    return hash_values(__version__, run.class_page, answers, rubric)


def _shown_in(book: Gradebook, grade: StudentGrade, context: str) -> str:
    """Return the hash of all that the report on a student shows."""
    by_people = []
    for result in grade.report.results:
        if result.manual_mark or result.comment:
            by_people.append((result.criterion.id, result.manual_mark, result.comment))
    stored = grade.stored
    is_there = False
    if stored:
        is_there = book.is_unchanged(stored)
        stored = stored._replace(run=0)
    facts = grade.student, stored, is_there, grade.late, grade.final, by_people
    return hash_values(context, *facts)


def render_reports(run: ReportRun, files: _TextOf, terminal: Terminal) -> dict[str, str]:
    """Write the reports of students, by their file names; return who has none, and why.

    Raises as `write_reports`.
    """
    done = _render_reports(run, files, terminal)
    return {key: one.why_lost for key, one in done.items() if one.why_lost}


def _render_reports(
    run: ReportRun,
    files: _TextOf,
    terminal: Terminal,
    jobs: int | None = None,
    timeout: float = _SECONDS,
) -> dict[str, _Done]:
    """Write the reports of students, by their file names; return what became of each."""
    _opened_gradebook.cache_clear()  # where the workers are in this process
    written = {}
    workers = jobs or processors()
    write = partial(_write_some, run)
    tasks = list(starmap(_ReportTask, files.items()))
    with (
        Processes(workers, timeout, preload=PRELOAD) as executor,
        terminal.show_class("writing reports") as show,
    ):
        show(Progress(len(files)))
        queue = Queue(executor, workers, write, _without_hints, _not_written, _TASK_SIZE)
        for results in queue.results(tasks):
            for one in results:
                written[one.key] = one
            show(Progress(len(files), graded=len(written)))
    return {key: written[key] for key in files}


def _without_hints(task: _ReportTask, _: WorkerError) -> _ReportTask | None:
    """Return a lost task without the search for hints, which may be the cause."""
    return task._replace(has_hints=False) if task.has_hints else None


def _not_written(task: _ReportTask, error: Exception) -> _Done:
    """Return that a student has no report, and why."""
    if isinstance(error, InputError | RubricError):
        raise error
    if isinstance(error, WorkerError | MachineError):
        return _Done(task.key, str(error))
    return _Done(task.key, f"the grader itself failed: {type(error).__name__}: {error}")


def _write_some(run: ReportRun, tasks: Sequence[_ReportTask]) -> list[_Done]:
    """Write the reports of some students, in a worker; return what became of them."""
    book, kept = _opened_gradebook(run)
    done = []
    for task in tasks:
        kept.used = ""
        kept.is_lost = not task.has_hints
        report = make_report(book, book.grade(task.key), has_hints=task.has_hints, kept=kept)
        report = report._replace(class_page=run.class_page)
        for kind in run.formats:
            save(Path(run.folder, f"{task.name}.{kind.ending}"), render(report, kind))
        # Also those of an earlier task, which may have failed to write its report.
        new = {kept.used: kept.new[kept.used]} if kept.used in kept.new else {}
        still = _draw_report(report) if Format.HTML in run.formats else ()
        done.append(_Done(task.key, "", kept.used, new, not kept.is_lost, still))
    return done


def _draw_report(report: Report) -> "Still":
    """Return the small picture of the robot of a report."""
    from grader.report.drawing.graded_picture import (
        draw_report,  # late: only the class's page needs numpy
    )
    from grader.report.drawing.still import draw_still

    picture = draw_report(report)
    return draw_still(picture.scene) if picture else ()


@lru_cache(maxsize=1)
def _opened_gradebook(run: ReportRun) -> tuple[Gradebook, KeptReports]:
    folder = run.gradebook.absolute()  # no report names a rubric by its place in a gradebook
    return Gradebook(folder, answers=run.answers), KeptReports(folder)


def file_names(keys: Sequence[str]) -> dict[str, str]:
    """Return a file name without ending for each key.

    It is valid on every system, and unique without regard to case.

    A key that is not a valid name, or that differs from another one only in case, gets its digest
    appended.
    """
    folds = {key: unicodedata.normalize("NFC", key).casefold() for key in keys}
    counts = Counter(folds.values())
    return {
        key: key if _SAFE.fullmatch(key) and counts[folds[key]] == 1 else _with_digest(key)
        for key in keys
    }


def _with_digest(key: str) -> str:
    readable = re.sub(r"[^\w-]+", "_", unicodedata.normalize("NFC", key))[:30].strip(" .-") or "_"
    return f"{readable}-{hash_bytes(key.encode('utf-8', 'surrogateescape'))}"


def write_class_page(
    book: Gradebook, folder: Path, pages: _TextOf, stills: Mapping[str, "Still"] = {}
) -> None:
    """Write the class's page into a folder.

    It has links to the pages of students, by their names from there, and small pictures of
    their robots.
    """
    from grader.classroom.gradebook.statistics import statistics
    from grader.classroom.reports.class_page import render_class_page

    grades = list(book)
    links = {key: quote(f"{name}.{Format.HTML.ending}") for key, name in pages.items()}
    page = render_class_page(book, grades, statistics(book, grades), links, stills)
    save(folder / _CLASS_PAGE, without_commands(page))
