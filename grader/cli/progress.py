"""How far a batch has come, on standard error: a bar on a terminal, a plain line now and then elsewhere."""

import sys
import time
from types import TracebackType
from typing import TYPE_CHECKING, Self

from grader.cli.output import complain

if TYPE_CHECKING:
    from rich.progress import Progress as Bar

    from grader.classroom.run.batch import Progress

_EVERY = 10.0  # seconds between plain lines


class ProgressDisplay:
    """Shows the progress of a run from its beginning to its end."""

    def __init__(self) -> None:
        self._bar: Bar | None = None
        self._began = self._told = time.monotonic()

    def __enter__(self) -> Self:
        if sys.stderr is not None and sys.stderr.isatty():
            self._bar = _bar()
            self._bar.start()
            self._bar.add_task("grading", total=None, rate="", found="")
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar.stop()

    def show(self, progress: "Progress") -> None:
        """Show how far a run has come."""
        if self._bar is not None:
            rate = f"{progress.done / max(1e-3, time.monotonic() - self._began):.0f}/s"
            self._bar.update(
                self._bar.task_ids[0], total=progress.total, completed=progress.done, rate=rate, found=_found(progress)
            )
        elif time.monotonic() - self._told > _EVERY:
            self._told = time.monotonic()
            complain(_line(progress, self._told - self._began))


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


def _found(progress: "Progress") -> str:
    """What went wrong so far."""
    counted = [(progress.errored, "errored"), (progress.unreadable, "unreadable"), (progress.unchanged, "unchanged")]
    return ", ".join(f"{count} {what}" for count, what in counted if count)


def _line(progress: "Progress", seconds: float) -> str:
    rate = progress.done / seconds if seconds else 0.0
    left = (progress.total - progress.done) / rate if rate else 0.0
    found = _found(progress)
    return f"{progress.done} of {progress.total}, {rate:.0f}/s, {_time(left)} left{f' ({found})' if found else ''}"


def _time(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 100 else f"{seconds / 60:.0f} min"
