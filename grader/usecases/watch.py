"""grader grade --watch: grade again whenever a file changes, and show last what changed in the report."""

import gc
import os
from collections.abc import Iterator
from pathlib import Path

from rich.console import Console
from rich.text import Text

from grader.errors import GraderError, InputError, RubricError
from grader.grading.report import Report
from grader.grading.rubric import find_rubric, shipped_rubrics
from grader.report.comparison import applied_hints, comparison_lines, hinted_texts, unchanged_line
from grader.report.console import wrapped
from grader.report.formats import Format, render
from grader.report.screen import draw
from grader.text import printable_path
from grader.usecases import Terminal, Warn
from grader.usecases.exit_codes import ExitCode
from grader.usecases.file_events import Watched, changes
from grader.usecases.grade import GradeRequest, grade_submission, remove_reports, requested_rubric, save_reports

# The report that was shown last, all of its text, whatever the terminal's width, and the texts of files that its hints change.
_Shown = tuple[Report, str, dict[str, str]]


def watch(request: GradeRequest, terminal: Terminal) -> ExitCode:
    """Grade now and after every change, until Ctrl-C; return the exit code of the last grading.

    A submission or rubric that cannot be read is reported, and graded again after the next change.

    Raises:
        GraderError: What no change of a file corrects: wrong usage, an unknown rubric, standard output that is closed, a report
            that cannot be saved.
    """
    besides: set[Path] = set()
    changes = _changes(request, besides, terminal.warn)
    modes = remove_reports(request.saves, request.rubric, request.path)
    _ = request.threshold  # refuse a wrong one at once
    gc.enable()  # unlike other commands, this one may run for hours
    code: ExitCode | None = None
    last: _Shown | None = None
    last_error = ""
    terminal.warn(f"watching {printable_path(request.path)}; stop with Ctrl-C")
    try:
        for has_changed in changes:
            try:
                result = grade_submission(request, terminal.warn, terminal.show_progress)
            except (InputError, RubricError) as error:
                code = ExitCode.NOT_GRADED
                if has_changed or str(error) != last_error:
                    _show_error(request.path, error, terminal.warn)
                last_error = str(error)
                continue
            code, last_error = result.exit_code, ""
            besides.clear()
            besides.update(result.besides)
            save_reports(request, result, modes)
            last = _show(result.report, last, terminal, verbose=request.verbose, has_changed=has_changed)
    except KeyboardInterrupt:
        if code is None:  # during the first grading
            raise
    return ExitCode.NOT_GRADED if code is None else code


def _changes(request: GradeRequest, besides: set[Path], warn: Warn) -> Iterator[bool]:
    """Return an iterator that yields before each grading, whether a file has changed. Raises GraderError.

    `besides` has the files that the last grading read besides a single one.
    """
    if request.path in ("", "-"):
        raise GraderError("--watch takes a file or folder: standard input is read only once")
    if request.format is not Format.TERMINAL:
        raise GraderError(
            f"--watch prints in the format terminal only: use --save {request.format.value}=FILE instead of --format"
        )
    if request.fix is not None:
        raise GraderError("--watch writes no fix: use --fix without it")
    rubric = _rubric_file(request, warn)
    own = frozenset(os.path.realpath(file) for _, file in request.saves)
    return changes(Watched(Path(request.path), rubric, own, besides))


def _rubric_file(request: GradeRequest, warn: Warn) -> Path | None:
    """Return the rubric's file, None for a shipped rubric. Raises GraderError for an unknown rubric or part."""
    file = find_rubric(request.rubric)
    if file not in shipped_rubrics().values():
        return file
    requested_rubric(request, warn)
    return None


def _show_error(path: str, error: GraderError, warn: Warn) -> None:
    if not os.path.lexists(path):
        warn(f"{printable_path(path)} does not exist: waiting until it does")
        return
    for line in str(error).split("\n"):
        warn(line)


def _show(report: Report, last: _Shown | None, terminal: Terminal, *, verbose: bool, has_changed: bool) -> _Shown:
    """Show the whole report, then what changed; of a report that is the same, one line at most."""
    shown = report, render(report, Format.TERMINAL, verbose=True), hinted_texts(report)
    if last is not None and shown[1] == last[1]:
        if has_changed:
            terminal.show(f"{unchanged_line(report)}\n")
        return shown
    screen = terminal.screen()
    lines = [*comparison_lines(last[0], report), *applied_hints(last[0], last[2], report)] if last is not None else []
    changes = draw(lambda console: _print_lines(lines, console), screen) if lines else ""
    terminal.show(render(report, Format.TERMINAL, screen=screen, verbose=verbose) + changes)
    return shown


def _print_lines(lines: list[str], console: Console) -> None:
    console.print()
    for line in lines:
        wrapped(console, Text(line, style="bold"), 0)
