"""grader grade --watch: grade again whenever a file changes, and show last what changed in the report."""

import gc
import os
import time
from collections.abc import Collection, Iterable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from rich.console import Console
from rich.text import Text

from grader.errors import GraderError, InputError, MachineError, RubricError
from grader.files.folder import is_looked_at
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
_Stamp = tuple[int, ...] | None
# The report that was shown last, and all of its text, whatever the terminal's width.
_Shown = tuple[Report, str]


def watch(request: GradeRequest, terminal: Terminal) -> ExitCode:
    """Grade now and after every change, until Ctrl-C; return the exit code of the last grading.

    A submission or rubric that cannot be read is reported, and graded again after the next change.

    Raises:
        GraderError: What no change of a file corrects: wrong usage, an unknown rubric, standard output that is closed,
            a report that cannot be saved.
    """
    besides: set[Path] = set()
    changes = _changes(request, besides)
    modes = remove_reports(request.saves, files_of(request.rubric, request.answers), request.path)
    _ = request.threshold  # refuse a wrong one at once
    gc.enable()  # unlike other commands, this one may run for hours
    code: ExitCode | None = None
    last: _Shown | None = None
    last_error = ""
    terminal.warn(f"watching {printable_path(request.path)}; stop with Ctrl-C")
    try:
        for has_changed in changes:
            try:
                result = grade_submission(request, terminal.warn, terminal.show_file)
            except (InputError, MachineError, RubricError) as error:
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


def _changes(request: GradeRequest, besides: set[Path]) -> Iterator[bool]:
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
    rubric = _rubric_file(request)
    own = frozenset(os.path.realpath(file) for _, file in request.saves)
    return file_changes(Watched(Path(request.path), rubric, own, besides))


def _rubric_file(request: GradeRequest) -> Path | None:
    """Return the rubric's file, None for a shipped rubric. Raises GraderError for an unknown rubric or part."""
    file = find_rubric(request.rubric)
    if file not in shipped_rubrics().values():
        return file
    requested_rubric(request)
    return None


def _show_error(path: str, error: GraderError, warn: Warn) -> None:
    if not os.path.lexists(path):
        warn(f"{printable_path(path)} does not exist: waiting until it does")
        return
    for line in str(error).split("\n"):
        warn(line)


def _show(report: Report, last: _Shown | None, terminal: Terminal, *, verbose: bool, has_changed: bool) -> _Shown:
    """Show the whole report, then what changed; of a report that is the same, one line at most."""
    shown = report, render(report, Format.TERMINAL, verbose=True)
    if last is not None and shown[1] == last[1]:
        if has_changed:
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


class Watched(NamedTuple):
    """A submission, its rubric if that is a file, the real paths of the reports written, and files read besides."""

    path: Path
    rubric: Path | None = None
    own: frozenset[str] = frozenset()
    besides: Collection[Path] = ()


def file_changes(watched: Watched) -> Iterator[bool]:
    """Yield at once and after every change, without end: True if a file changed for certain."""
    seen: dict[str, _Stamp] | None = None
    before: dict[str, _Stamp] = {}
    while True:
        start = time.monotonic()
        now = _stamps(watched)
        if seen is None or before == now != seen:  # what changed since the last look may be half written
            # A file that was read for the first time may have changed since: grade again, but do not report a change.
            new = now.keys() - (seen or {}).keys()
            yield seen is None or not (seen.items() < now.items() and new <= set(map(str, watched.besides)))
            seen = now
        before = now
        time.sleep(max(_POLL, _SHARE * (time.monotonic() - start)))


def _stamps(watched: Watched) -> dict[str, _Stamp]:
    """Return the stamps of folders and files that exist: a folder's identifies it, a file's changes when written."""
    root = Path(os.path.realpath(watched.path))
    files: Iterable[Path] = _files(root) if root.is_dir() else (watched.path, *watched.besides)
    rubric = () if watched.rubric is None else (watched.rubric,)
    found = {str(file): _stamp(file) for file in (*files, *rubric) if os.path.realpath(file) not in watched.own}
    return {file: stamp for file, stamp in found.items() if stamp is not None}


def _files(root: Path) -> Iterator[Path]:
    """Yield the folders and files in a folder that a grading looks at."""
    yield root
    with suppress(RecursionError):  # os.walk raises it for folders nested a thousand deep
        for where, folders, files in os.walk(root):
            inside = os.path.relpath(where, root)
            folders[:] = [name for name in folders if _is_looked_at(root, f"{inside}/{name}/file")]
            names = (*folders, *(name for name in files if _is_looked_at(root, f"{inside}/{name}")))
            yield from (Path(where, name) for name in names)


def _is_looked_at(root: Path, path: str) -> bool:
    return is_looked_at(root, path.removeprefix("./"))


def _stamp(path: Path) -> _Stamp:
    with suppress(OSError):
        status = path.stat()
        known = status.st_dev, status.st_ino, status.st_mode
        # A folder changes with each report that is written into it.
        return known if path.is_dir() else (*known, status.st_size, status.st_mtime_ns, status.st_ctime_ns)
    return None
