"""grader grade --watch: grade again whenever something has changed, and say first what has become of it."""

import gc
import os
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from grader.cli.output import complain, emit, screen
from grader.errors import GraderError, InputError, RubricError
from grader.report.formats import Format, render
from grader.report.screen import draw
from grader.report.since import lines_since, nothing_since
from grader.text import printable_path
from grader.usecases.grade import Wanted, graded, make_room, save_reports, wanted_rubric

if TYPE_CHECKING:
    from rich.console import Console

    from grader.grading.report import Report

_NOTHING_GRADED = 2


class _Told(NamedTuple):
    """A report that was shown, and its text at a width that does not change with the terminal's."""

    report: "Report"
    text: str


def watch(wanted: Wanted) -> int:
    """Grade now and whenever something has changed, until Ctrl-C: the exit code of the last time.

    What cannot be read is told and waited out. Raises GraderError for what no change of a file would mend: wrong usage, a rubric
    that there is not, standard output that is closed, a report that cannot be saved.
    """
    rounds = _rounds(wanted)
    modes = make_room(wanted)
    _ = wanted.threshold  # which no change of a file would correct
    gc.enable()  # unlike other commands this one may run for hours
    code: int | None = None
    last: _Told | None = None
    said = ""
    complain(f"watching {printable_path(wanted.path)}; Ctrl-C ends it")
    try:
        for is_news in rounds:
            try:
                done = graded(wanted)
            except (InputError, RubricError) as error:
                code = _NOTHING_GRADED
                if is_news or str(error) != said:
                    _explain(wanted.path, error)
                said = str(error)
                continue
            code, said = done.code, ""
            save_reports(wanted, done, modes)
            last = _show(done.report, last, is_news=is_news)
    except KeyboardInterrupt:
        if code is None:  # in the midst of the first time
            raise
    return _NOTHING_GRADED if code is None else code


def _rounds(wanted: Wanted) -> Iterator[bool]:
    """Each time that it is to be graded, and whether something has changed; raises GraderError where it cannot be watched."""
    if wanted.path in ("", "-"):
        raise GraderError("--watch takes a file or folder: standard input is read only once")
    if wanted.format is not Format.TERMINAL:
        raise GraderError(
            f"--watch prints reports for a person: leave --format out, --save {wanted.format.value}=FILE writes one each time"
        )
    rubric = _rubric_file(wanted)
    try:
        from grader.usecases.file_events import Watched, rounds
    except ImportError:
        raise InputError("--watch needs watchfiles: pip install 'urdf-grader[watch]'") from None
    return rounds(Watched(Path(wanted.path), rubric, frozenset(os.path.realpath(file) for _, file in wanted.saves)))


def _rubric_file(wanted: Wanted) -> Path | None:
    """The rubric's file, if it is one that may change; raises GraderError for a rubric or parts that there are not."""
    from grader.grading.rubric import find_rubric, shipped_rubrics

    file = find_rubric(wanted.rubric)
    if file not in shipped_rubrics().values():
        return file
    wanted_rubric(wanted)
    return None


def _explain(path: str, error: GraderError) -> None:
    """Say why nothing was graded this time."""
    if not os.path.lexists(path):
        complain(f"{printable_path(path)} does not exist: it is graded as soon as it does")
        return
    for line in str(error).split("\n"):
        complain(line)


def _show(report: "Report", last: _Told | None, *, is_news: bool) -> _Told:
    """Print what has changed, and then the whole report; where that is nothing, one line at most."""
    told = _Told(report, render(report, Format.TERMINAL))
    if last is not None and told.text == last.text:
        if is_news:
            emit(f"{nothing_since(report)}\n")
        return told
    news = draw(partial(_news, lines_since(last.report, report)), screen()) if last is not None else ""
    emit(news + render(report, Format.TERMINAL, screen=screen()))
    return told


def _news(lines: list[str], console: "Console") -> None:
    from rich.text import Text

    from grader.report.layout import wrapped

    console.print()
    for line in lines:
        wrapped(console, Text(line, style="bold"), 0)
    console.print()
