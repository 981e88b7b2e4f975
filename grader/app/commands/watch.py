"""grader grade --watch: grade again whenever a file changes, and show last what changed in the
report.
"""

import gc
import os
import time
from collections.abc import Collection, Iterable, Iterator, Sequence
from contextlib import suppress
from decimal import Decimal
from pathlib import Path

from rich.console import Console
from rich.text import Text

from grader.app.grading import (
    MAX_NAMED_CRITERIA,
    GradeRequest,
    check_saves,
    grade_submission,
    requested_rubric,
    save_reports,
)
from grader.base.errors import GraderError, InputError, MachineError, RubricError
from grader.base.text import enumerated, format_points, printable, printable_path, signed_points
from grader.files.folder import read_folder
from grader.lab.grading.report import Report, Result
from grader.lab.rubric.rubric import find_rubric, shipped_rubrics
from grader.lab.rubric.rubric_files import files_of
from grader.report.criteria import alike
from grader.report.formats import Format, render
from grader.report.screen import Screen, draw
from grader.report.writers.terminal import Page
from grader.report.writing import Terminal

_POLL = 0.1  # seconds between two looks
_SHARE = 10  # a look at many files is followed by a pause of this many times its own time
_CHANGES = {
    "passed": "now passed",
    "failed": "now failed",
    "skipped": "now skipped",
    "pending": "now needs manual grading",
    "errored": "now errored",
}
_Stamps = dict[str, tuple[int, ...] | None]


def watch(request: GradeRequest, terminal: Terminal) -> None:
    """Grade now and after every change, until Ctrl-C, which raises KeyboardInterrupt.

    A submission or rubric that cannot be read is reported, and graded again after the next change.

    Raises:
        GraderError: What no change of a file corrects: wrong usage, an unknown rubric, standard
            output that is closed, a report that cannot be saved.
    """
    saves = request.saves
    watched = _watched(request)
    rubric = files_of(request.rubric, request.answers) if saves else ()
    check_saves(saves, rubric, request.path)
    _ = request.threshold  # refuse a wrong one at once
    gc.enable()  # unlike other commands, this one may run for hours
    last: Report | None = None
    terminal.warn(f"watching {printable_path(request.path)}; stop with Ctrl-C")
    for besides in _changes(watched, frozenset(os.path.realpath(file) for _, file in saves)):
        try:
            result = grade_submission(request, terminal.warn)
        except (InputError, MachineError, RubricError) as error:
            for line in str(error).split("\n"):
                terminal.warn(line)
            continue
        besides[:] = result.besides
        save_reports(request, result)
        _show(result.report, last, terminal, verbose=request.verbose)
        last = result.report


def _watched(request: GradeRequest) -> list[Path]:
    """Return what is watched: the submission, and a rubric that is no shipped one. Raises
    GraderError.
    """
    if request.path in ("", "-"):
        raise GraderError("--watch takes a file or folder: standard input is read only once")
    if request.output_format is not Format.TERMINAL:
        raise GraderError(
            "--watch prints in the format terminal only: use --save "
            f"{request.output_format}=FILE instead of --format"
        )
    if request.fix is not None:
        raise GraderError("--watch writes no fix: use --fix without it")
    file = find_rubric(request.rubric)
    if file not in shipped_rubrics().values():
        return [Path(request.path), file]
    requested_rubric(request)  # an unknown part
    return [Path(request.path)]


def _show(report: Report, last: Report | None, terminal: Terminal, *, verbose: bool) -> None:
    """Show a rule with the time below an earlier report, the whole report, then what changed."""
    screen = terminal.screen()
    text = render(report, Format.TERMINAL, screen=screen, verbose=verbose)
    if last is not None:
        lines = [Text(line, "bold") for line in comparison_lines(last, report)]
        rule = f"-- {time.strftime('%H:%M:%S')} ".ljust(screen.width, "-")
        text = _drawn([Text(rule, "dim")], screen) + text + _drawn([Text(), *lines], screen)
    terminal.print(text)


def _drawn(rows: list[Text], screen: Screen) -> str:
    """Return rows of text as the screen shows them."""

    def print_rows(console: Console) -> None:
        page = Page(console, [])
        for row in rows:
            page.inset(row, indent=0)
        page.print()

    return draw(print_rows, screen)


def comparison_lines(before: Report, after: Report) -> list[str]:
    """Return the change of the score, then the criteria that changed, those that pass now first."""
    old = {result.criterion.id: result for result in before.results}
    kinds = dict(alike(after.results, lambda result: _change(old.get(result.criterion.id), result)))
    score = f"{format_points(after.score)} of {format_points(after.max_score)} points"
    gain = _gain(after.score - before.score)
    lines = [f"{format_points(before.score)} -> {score}{gain}"]
    for change in (*_CHANGES.values(), "changed"):
        names = []
        for new in kinds.get(change, ()):
            was = old.get(new.criterion.id)
            gain = _gain(new.points - (was.points if was else 0))
            names.append(printable(new.criterion.id) + gain)
        if names:
            lines.append(f"{change}: {enumerated(names, MAX_NAMED_CRITERIA)}")
    return lines


def _change(old: Result | None, new: Result) -> str:
    """Return how a criterion changed; empty if it did not."""
    if old is None or old.outcome.status != new.outcome.status:
        return _CHANGES[new.outcome.status]
    is_other = old.points != new.points or (
        new.outcome.status != "passed" and old.outcome.message != new.outcome.message
    )
    return "changed" if is_other else ""


def _gain(points: Decimal) -> str:
    return f" ({signed_points(points)})" if points else ""


def _changes(watched: Sequence[Path], own: Collection[str] = ()) -> Iterator[list[Path]]:
    """Yield at once and after every change of the watched files and folders, without end.

    What is yielded is a list for the files that were read besides, which are watched from then on.
    `own` are the real paths of files that do not count: the reports that are written.
    """
    besides: list[Path] = []
    seen: _Stamps | None = None
    before: _Stamps = {}
    while True:
        start = time.monotonic()
        now = _stamps([*watched, *besides], own)
        if (
            seen is None or before == now != seen
        ):  # what changed since the last look may be half written
            yield besides
            seen = {**_stamps(besides, own), **now}
        before = now
        time.sleep(max(_POLL, _SHARE * (time.monotonic() - start)))


def _stamps(paths: Iterable[Path], own: Collection[str] = ()) -> _Stamps:
    """Return what identifies each file and its content; of a folder, each file and folder that a
    grading looks at.
    """
    found: _Stamps = {}
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
        if path.is_dir():
            return known
        return (*known, status.st_size, status.st_mtime_ns, status.st_ctime_ns)
    return None
