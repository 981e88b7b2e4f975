"""grader grade --watch: grade again whenever a file changes.

Show last what changed in the report.
"""

from collections.abc import Sequence
from decimal import Decimal
from pathlib import Path

from grader.app.commands.repeating import refuse_watching, repeat_on_change, show_round
from grader.app.grading import (
    MAX_NAMED_CRITERIA,
    GradeRequest,
    GradeRun,
    grade_request,
    requested_rubric,
    save_reports,
)
from grader.app.saving import check_saves
from grader.base.errors import GraderError
from grader.base.processor_time import GRADE_SECONDS
from grader.base.text import enumerated, format_points, printable, signed_points
from grader.lab.grading.report import Report, Result
from grader.lab.rubric.rubric import find_rubric, shipped_rubrics
from grader.lab.rubric.rubric_files import list_files
from grader.report.criteria import alike
from grader.report.formats import Format, render
from grader.report.writing import Terminal

_CHANGES = {
    "passed": "now passed",
    "given": "failed, but not deducted",
    "failed": "now failed",
    "skipped": "now skipped",
    "pending": "now needs manual grading",
    "errored": "now errored",
}


def watch(request: GradeRequest, terminal: Terminal) -> None:
    """Grade now and after every change, until Ctrl-C, which raises KeyboardInterrupt.

    A submission or rubric that cannot be read is reported, and graded again after the next change.

    Raises:
        GraderError: What no change of a file corrects: wrong usage, an unknown rubric, standard
            output that is closed, a report that cannot be saved.
    """
    saves = request.saves
    watched = _watched(request)
    rubric = list_files(request.rubric, request.answers) if saves else ()
    check_saves(saves, rubric, request.path)
    _ = request.threshold  # refuse a wrong one at once
    last = None

    def work() -> tuple[GradeRun, Sequence[Path]]:
        run = grade_request(request, terminal.warn)
        return run, run.besides

    def show(run: GradeRun) -> None:
        nonlocal last
        save_reports(request, run)
        _show(run.report, last, terminal, verbose=request.verbose)
        last = run.report

    repeat_on_change(watched, [file for _, file in saves], terminal, GRADE_SECONDS, work, show)


def _watched(request: GradeRequest) -> list[Path]:
    """Return what is watched: the submission, and a rubric that is no shipped one.

    Raises GraderError.
    """
    refuse_watching(request.path, request.output_format)
    if request.fix:
        raise GraderError("--watch writes no fix: use --fix without it")
    watched = files_to_watch(request.path, request.rubric)
    if len(watched) == 1:
        requested_rubric(request)  # an unknown part
    return watched


def files_to_watch(path: str, rubric: str) -> list[Path]:
    """Return a submission, and a rubric that is no shipped one.

    Raises GraderError for an unknown rubric.
    """
    file = find_rubric(rubric)
    if file in shipped_rubrics().values():
        return [Path(path)]
    return [Path(path), file]


def _show(report: Report, last: Report | None, terminal: Terminal, *, verbose: bool) -> None:
    """Show the report, then what changed since the last one."""
    text = render(report, Format.TERMINAL, screen=terminal.screen(), verbose=verbose)
    changed = comparison_lines(last, report) if last else ()
    show_round(text, terminal, changed, is_first=not last, is_whole=verbose)


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
    status = new.outcome.status
    if not old or old.outcome.status != status:
        return _CHANGES["given" if status == "failed" and new.points else status]
    is_other = old.points != new.points or (
        new.outcome.status != "passed" and old.outcome.message != new.outcome.message
    )
    return "changed" if is_other else ""


def _gain(points: Decimal) -> str:
    return f" ({signed_points(points)})" if points else ""
