"""grader grade --watch: grade again whenever a file changes, and show first what changed in the report."""

import gc
import os
from collections.abc import Iterator, Sequence
from decimal import Decimal
from pathlib import Path

from rich.console import Console
from rich.text import Text

from grader.errors import GraderError, InputError, RubricError
from grader.grading.report import Report, Result
from grader.grading.rubric import find_rubric, shipped_rubrics
from grader.report.console import wrapped
from grader.report.formats import Format, render
from grader.report.screen import draw
from grader.text import format_points, printable, printable_path, signed_points
from grader.usecases import Terminal, Warn
from grader.usecases.exit_codes import ExitCode
from grader.usecases.grade import GradeRequest, grade_submission, remove_reports, requested_rubric, save_reports

_STATUSES = {
    "passed": "now passed",
    "failed": "now failed",
    "skipped": "now skipped",
    "pending": "now needs manual grading",
    "errored": "now errored",
}
_MAX_NAMED = 8
_PointsChange = tuple[str, Decimal]  # a criterion, and the change of its points
_Shown = tuple[Report, str]  # the report that was shown last, and its text for a file, whatever the terminal's width


def watch(request: GradeRequest, terminal: Terminal) -> ExitCode:
    """Grade now and after every change, until Ctrl-C; return the exit code of the last grading.

    A submission or rubric that cannot be read is reported, and graded again after the next change.

    Raises:
        GraderError: What no change of a file corrects: wrong usage, an unknown rubric, standard output that is closed, a report
            that cannot be saved.
    """
    changes = _changes(request, terminal.warn)
    modes = remove_reports(request)
    _ = request.threshold  # refuse a wrong one at once
    gc.enable()  # unlike other commands, this one may run for hours
    code: ExitCode | None = None
    last: _Shown | None = None
    last_error = ""
    terminal.warn(f"watching {printable_path(request.path)}; stop with Ctrl-C")
    try:
        for has_changed in changes:
            try:
                result = grade_submission(request, terminal.warn)
            except (InputError, RubricError) as error:
                code = ExitCode.NOT_GRADED
                if has_changed or str(error) != last_error:
                    _show_error(request.path, error, terminal.warn)
                last_error = str(error)
                continue
            code, last_error = result.exit_code, ""
            save_reports(request, result, modes)
            last = _show(result.report, last, terminal, has_changed=has_changed)
    except KeyboardInterrupt:
        if code is None:  # during the first grading
            raise
    return ExitCode.NOT_GRADED if code is None else code


def _changes(request: GradeRequest, warn: Warn) -> Iterator[bool]:
    """Return an iterator that yields before each grading, whether a file has changed. Raises GraderError."""
    if request.path in ("", "-"):
        raise GraderError("--watch takes a file or folder: standard input is read only once")
    if request.format is not Format.TERMINAL:
        raise GraderError(
            f"--watch prints in the format terminal only: use --save {request.format.value}=FILE instead of --format"
        )
    rubric = _rubric_file(request, warn)
    try:
        from grader.usecases.file_events import Watched, changes
    except ImportError:
        raise InputError("--watch needs watchfiles: pip install 'urdf-grader[watch]'") from None
    return changes(Watched(Path(request.path), rubric, frozenset(os.path.realpath(file) for _, file in request.saves)))


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


def _show(report: Report, last: _Shown | None, terminal: Terminal, *, has_changed: bool) -> _Shown:
    """Show what changed, then the whole report; of a report that is the same, one line at most."""
    shown = report, render(report, Format.TERMINAL)
    if last is not None and shown[1] == last[1]:
        if has_changed:
            terminal.show(f"{unchanged_line(report)}\n")
        return shown
    screen = terminal.screen()
    lines = comparison_lines(last[0], report) if last is not None else []
    changes = draw(lambda console: _print_lines(lines, console), screen) if lines else ""
    terminal.show(changes + render(report, Format.TERMINAL, screen=screen))
    return shown


def _print_lines(lines: list[str], console: Console) -> None:
    console.print()
    for line in lines:
        wrapped(console, Text(line, style="bold"), 0)
    console.print()


def comparison_lines(before: Report, after: Report) -> list[str]:
    """Return the score, then the criteria whose status, points or message changed."""
    rows = list(_rows(before, after))
    score = _score(before, after)
    if not rows:
        return [f"{score}; only other parts of the report changed"]
    return [score, *(f"{change}: {_named(criteria)}" for change, criteria in rows)]


def unchanged_line(report: Report) -> str:
    """Return the line for a report that is the same as before."""
    return f"nothing has changed: {_of(report)} points"


def _rows(before: Report, after: Report) -> Iterator[tuple[str, Sequence[_PointsChange]]]:
    """Yield each kind of change with its criteria, those that pass now first."""
    old = {result.criterion.id: result for result in before.results}
    new = {result.criterion.id: result for result in after.results}
    found: dict[str, list[_PointsChange]] = {change: [] for change in _STATUSES.values()}
    for name, result in new.items():
        change = _change(old.get(name), result)
        if change is not None:
            was = old[name].points if name in old else Decimal(0)
            found.setdefault(change, []).append((name, result.points - was))
    removed = [(name, -result.points) for name, result in old.items() if name not in new]
    yield from ((change, criteria) for change, criteria in [*found.items(), ("removed", removed)] if criteria)


def _change(old: Result | None, new: Result) -> str | None:
    """Return how a criterion changed, None if it did not."""
    if old is None or old.outcome.status != new.outcome.status:
        return _STATUSES[new.outcome.status]
    if (old.points, old.criterion.points) != (new.points, new.criterion.points):
        return "with other points"
    has_message = new.outcome.status != "passed" and old.outcome.message != new.outcome.message
    return "with another message" if has_message else None


def _score(before: Report, after: Report) -> str:
    if (before.score, before.max_score) == (after.score, after.max_score):
        return f"{_of(after)} points, as before"
    was = format_points(before.score) if before.max_score == after.max_score else _of(before)
    return f"{was} -> {_of(after)} points{_in_brackets(after.score - before.score)}"


def _of(report: Report) -> str:
    return f"{format_points(report.score)} of {format_points(report.max_score)}"


def _named(criteria: Sequence[_PointsChange]) -> str:
    """Return the criteria with the change of their points; of many the first, and how many more there are."""
    named = [f"{printable(name)}{_in_brackets(points)}" for name, points in criteria[:_MAX_NAMED]]
    rest = criteria[_MAX_NAMED:]
    if rest:
        named.append(f"and {len(rest)} more{_in_brackets(sum((points for _, points in rest), Decimal(0)))}")
    return ", ".join(named)


def _in_brackets(points: Decimal) -> str:
    return f" ({signed_points(points)})" if points else ""
