"""grader grade --watch: grade again whenever a file changes, and show last what changed in the report."""

import gc
import os
import time
from collections.abc import Collection, Iterable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path

from rich.console import Console
from rich.text import Text

from grader.errors import GraderError, InputError, MachineError, RubricError
from grader.files.folder import read_folder
from grader.grading.report import Report
from grader.grading.rubric import find_rubric, shipped_rubrics
from grader.report.comparison import comparison_lines, unchanged_line
from grader.report.console import wrapped
from grader.report.formats import Format, render
from grader.report.screen import draw
from grader.text import printable_path
from grader.usecases.exit_codes import ExitCode
from grader.usecases.grade import GradeRequest, grade_submission, remove_reports, requested_rubric, save_reports
from grader.usecases.rubrics import files_of
from grader.usecases.terminal import Terminal, Warn

_POLL = 0.1  # seconds between two looks
_SHARE = 10  # a look at many files is followed by a pause of this many times its own time
Stamps = dict[str, tuple[int, ...] | None]
# The report that was shown last, and all of its text, whatever the terminal's width.
_Shown = tuple[Report, str]


def watch(request: GradeRequest, terminal: Terminal) -> ExitCode:
    """Grade now and after every change, until Ctrl-C; return the exit code of the last grading.

    A submission or rubric that cannot be read is reported, and graded again after the next change.

    Raises:
        GraderError: What no change of a file corrects: wrong usage, an unknown rubric, standard output that is closed,
            a report that cannot be saved.
    """
    watched = _watched(request)
    modes = remove_reports(request.saves, files_of(request.rubric, request.answers), request.path)
    _ = request.threshold  # refuse a wrong one at once
    gc.enable()  # unlike other commands, this one may run for hours
    code: ExitCode | None = None
    last: _Shown | None = None
    terminal.warn(f"watching {printable_path(request.path)}; stop with Ctrl-C")
    try:
        for besides in changes(watched, frozenset(os.path.realpath(file) for _, file in request.saves)):
            try:
                result = grade_submission(request, terminal.warn, terminal.show_file)
            except (InputError, MachineError, RubricError) as error:
                code = ExitCode.NOT_GRADED
                _show_error(request.path, error, terminal.warn)
                continue
            code, besides[:] = result.exit_code, result.besides
            save_reports(request, result, modes)
            last = _show(result.report, last, terminal, verbose=request.verbose)
    except KeyboardInterrupt:
        if code is None:  # during the first grading
            raise
    return ExitCode.NOT_GRADED if code is None else code


def _watched(request: GradeRequest) -> list[Path]:
    """Return what is watched: the submission, and a rubric that is no shipped one. Raises GraderError."""
    if request.path in ("", "-"):
        raise GraderError("--watch takes a file or folder: standard input is read only once")
    if request.format is not Format.TERMINAL:
        raise GraderError(
            f"--watch prints in the format terminal only: use --save {request.format.value}=FILE instead of --format"
        )
    if request.fix is not None:
        raise GraderError("--watch writes no fix: use --fix without it")
    file = find_rubric(request.rubric)
    if file not in shipped_rubrics().values():
        return [Path(request.path), file]
    requested_rubric(request)  # an unknown part
    return [Path(request.path)]


def _show_error(path: str, error: GraderError, warn: Warn) -> None:
    if not os.path.lexists(path):
        warn(f"{printable_path(path)} does not exist: waiting until it does")
        return
    for line in str(error).split("\n"):
        warn(line)


def _show(report: Report, last: _Shown | None, terminal: Terminal, *, verbose: bool) -> _Shown:
    """Show the whole report, then what changed; of a report that is the same, one line."""
    shown = report, render(report, Format.TERMINAL, verbose=True)
    if last is not None and shown[1] == last[1]:
        terminal.print(f"{unchanged_line(report)}\n")
        return shown
    screen = terminal.screen()
    lines = comparison_lines(last[0], report) if last is not None else []
    changes = draw(lambda console: _print_lines(lines, console), screen) if lines else ""
    terminal.print(render(report, Format.TERMINAL, screen=screen, verbose=verbose) + changes)
    return shown


def _print_lines(lines: list[str], console: Console) -> None:
    console.print()
    for line in lines:
        wrapped(console, Text(line, style="bold"), 0)


def changes(watched: Sequence[Path], own: Collection[str] = ()) -> Iterator[list[Path]]:
    """Yield at once and after every change of the watched files and folders, without end.

    What is yielded is a list for the files that were read besides, which are watched from then on. `own` are the real
    paths of files that do not count: the reports that are written.
    """
    besides: list[Path] = []
    seen: Stamps | None = None
    before: Stamps = {}
    while True:
        start = time.monotonic()
        now = stamps([*watched, *besides], own)
        if seen is None or before == now != seen:  # what changed since the last look may be half written
            yield besides
            seen = {**stamps(besides, own), **now}
        before = now
        time.sleep(max(_POLL, _SHARE * (time.monotonic() - start)))


def stamps(paths: Iterable[Path], own: Collection[str] = ()) -> Stamps:
    """Return what identifies each file and its content; of a folder, each file and folder that a grading looks at."""
    found: Stamps = {}
    for path in paths:
        names: Iterable[str] = ()
        try:
            tree = read_folder(path) if path.is_dir() else None
            names = (*tree.files, *tree.folders) if tree is not None else ()
        except (InputError, MachineError) as error:
            found[str(error)] = None
        files = (path, *(path / name for name in names))
        found |= {str(file): _stamp(file) for file in files if os.path.realpath(file) not in own}
    return found


def _stamp(path: Path) -> tuple[int, ...] | None:
    with suppress(OSError, ValueError):
        status = path.stat()
        known = status.st_dev, status.st_ino, status.st_mode
        # A folder changes with each report that is written into it.
        return known if path.is_dir() else (*known, status.st_size, status.st_mtime_ns, status.st_ctime_ns)
    return None
