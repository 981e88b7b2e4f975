"""grader batch: a class against a rubric, into a gradebook."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal, get_args

import typer

from grader.cli.options import DEFAULT_RUBRIC, DueOption, FormatOption, GradebookOption, MaxSizeOption, RubricOption
from grader.cli.output import screen, warn
from grader.errors import GraderError
from grader.files.reading import URDF_LIMIT
from grader.report.formats import Format, OutputFormat

if TYPE_CHECKING:
    from rich.progress import Progress as Bar

    from grader.classroom.run.batch import Progress

Layout = Literal["auto", "folders", "canvas", "moodle", "teams", "nbgrader"]
_LINE_SECONDS = 10.0  # between lines of progress, if standard error is no terminal
_PATH = "A folder with an entry for each student, or the zip of an LMS."
_ADD = "Add to the gradebook even if it has another class, assignment or rubric."
_TIMEOUT = "Time limit for each submission."


def batch(
    path: Annotated[Path, typer.Argument(metavar="PATH", help=_PATH)],
    gradebook: GradebookOption,
    rubric: RubricOption = DEFAULT_RUBRIC,
    jobs: Annotated[
        int | None, typer.Option(metavar="N", min=1, help="Worker processes; default: one per processor.")
    ] = None,
    timeout: Annotated[float, typer.Option(metavar="SECONDS", min=0.1, help=_TIMEOUT)] = 60.0,
    roster: Annotated[Path | None, typer.Option(metavar="CSV", help="The students of the class.")] = None,
    layout: Annotated[
        Layout, typer.Option(metavar="LAYOUT", help=f"Layout of PATH: {', '.join(get_args(Layout))}.")
    ] = "auto",
    assignment: Annotated[str, typer.Option(metavar="NAME", help="The assignment in the nbgrader layout.")] = "",
    reports: Annotated[Path | None, typer.Option(metavar="DIR", help="Write a report for each student here.")] = None,
    report_format: Annotated[
        list[Format] | None, typer.Option(metavar="FORMAT", help="Format of these reports; repeatable.")
    ] = None,
    csv: Annotated[Path | None, typer.Option(metavar="FILE", help="Also write the grades as CSV.")] = None,
    due: DueOption = None,
    force: Annotated[bool, typer.Option("--force", help="Grade unchanged submissions again.")] = False,
    add: Annotated[bool, typer.Option("--add", help=_ADD)] = False,
    cluster: Annotated[str | None, typer.Option(metavar="ADDRESS", help="A Dask cluster, as tcp://host:8786.")] = None,
    max_size: MaxSizeOption = URDF_LIMIT,
    output_format: FormatOption = OutputFormat.TERMINAL,
) -> str:
    """Grade a class into a gradebook, in parallel.

    Rerun the same command to resume, or to grade what is new or changed. Submissions are isolated: a crash or timeout affects only
    its own submission. Exits 0 when every submission has a result, whatever the grades.

    Examples:

      grader batch submissions.zip --gradebook lab6.db --roster roster.csv

      grader batch class/ --gradebook lab6.db --reports reports --csv grades.csv
    """
    from grader.usecases.grade_class import ClassRequest, grade_class  # imports what grades a class

    formats = tuple(report_format or [Format.TERMINAL])
    for kind in formats:
        if kind.needs == "identity":
            raise GraderError(f"{kind} is for one repository: use `grader grade` there")
    request = ClassRequest(
        path, gradebook, rubric, jobs, timeout, roster, layout, assignment, due, force, cluster, add, max_size, reports, formats, csv
    )  # fmt: skip
    return grade_class(request, output_format, screen(), _progress_display(), warn)


@contextmanager
def _progress_display() -> Iterator[Callable[["Progress"], None]]:
    """Show the progress of a run; yields the function that takes it."""
    began = last_line = time.monotonic()

    def print_line(progress: "Progress") -> None:
        nonlocal last_line
        now = time.monotonic()
        if now - last_line > _LINE_SECONDS:
            last_line = now
            warn(_line(progress, now - began))

    if sys.stderr is None or not sys.stderr.isatty():
        yield print_line
        return
    with _bar() as bar:
        task = bar.add_task("grading", total=None, rate="", found="")

        def move(progress: "Progress") -> None:
            rate = f"{progress.done / max(1e-3, time.monotonic() - began):.0f}/s"
            bar.update(task, total=progress.total, completed=progress.done, rate=rate, found=_counts(progress))

        yield move


def _bar() -> "Bar":
    from rich import progress
    from rich.console import Console

    columns = (
        progress.TextColumn("{task.description}"),
        progress.BarColumn(),
        progress.MofNCompleteColumn(),
        progress.TextColumn("{task.fields[rate]}"),
        progress.TimeRemainingColumn(),
        progress.TextColumn("{task.fields[found]}"),
    )
    return progress.Progress(*columns, console=Console(stderr=True), transient=True)


def _counts(progress: "Progress") -> str:
    counts = [(progress.errored, "errored"), (progress.unreadable, "unreadable"), (progress.unchanged, "unchanged")]
    return ", ".join(f"{count} {status}" for count, status in counts if count)


def _line(progress: "Progress", seconds: float) -> str:
    rate = progress.done / seconds if seconds else 0.0
    left = (progress.total - progress.done) / rate if rate else 0.0
    counts = _counts(progress)
    time_left = f"{left:.0f} s" if left < 100 else f"{left / 60:.0f} min"
    return f"{progress.done} of {progress.total}, {rate:.0f}/s, {time_left} left{f' ({counts})' if counts else ''}"
