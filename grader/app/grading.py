"""A submission that is graded as the options of `grader grade` say.

It is graded once, or with --watch again and again.
"""

import os
import re
from collections.abc import Sequence
from decimal import Decimal
from pathlib import Path
from typing import TYPE_CHECKING

from grader.app.saving import save_texts
from grader.base.errors import GraderError, InputError
from grader.base.records import Named
from grader.base.source import Base
from grader.base.text import enumerated, printable, shell_quoted
from grader.lab.rubric.hint_levels import HintLevel
from grader.lab.rubric.rubric_files import load_named
from grader.report.formats import Format, list_inputs, render
from grader.report.invocation import (
    ExitCode,
    Saves,
    check_threshold,
    exit_code,
    read_arguments,
    read_saves,
    read_threshold,
)
from grader.report.repository import find_base, find_folder
from grader.report.writing import (
    Warn,
)

if TYPE_CHECKING:
    from grader.lab.grading.report import Report
    from grader.lab.hints.hinting import FixedFiles
    from grader.lab.rubric.rubric import Rubric
    from grader.lab.submission.submission import Submission

MAX_NAMED_CRITERIA = 8  # in a message
_MAX_UP = 3  # folders between a package and what is graded in it


class GradeRequest(Named):
    """The options of `grader grade`: a submission to grade, its rubric, and the reports to make."""

    path: str  # of the submission; - for a URDF on standard input
    rubric: str  # an id or a file
    expect_rubric: str | None  # the hash that the rubric must have
    part: (
        Sequence[str] | None
    )  # the ids of the parts to grade; default: all that the submission can meet
    output_format: Format  # of standard output
    save: Sequence[str] | None  # FORMAT=FILE, of the reports to write
    fail_under: str | None  # the score that must be reached, in points or percent
    max_size: int  # of a URDF, in bytes
    arg: Sequence[str] | None  # NAME=VALUE, of xacro
    answers: Path | None  # the model answers
    verbose: bool  # whether the terminal shows everything
    hints: HintLevel | None  # the most that hints tell; None for what the rubric allows
    fix: Path | None  # where to write the files with all proven edits
    watch: bool  # whether to grade again after every change

    @property
    def saves(self) -> Saves[Format]:
        """The files to write, with their formats. Raises GraderError."""
        return read_saves(self.save or (), Format)

    @property
    def threshold(self) -> tuple[Decimal, bool] | None:
        """The threshold of `--fail-under`, if there is one. Raises GraderError."""
        if self.fail_under is not None:
            return read_threshold(self.fail_under)
        return None


class GradeRun(Named):
    """A submission that was graded."""

    report: "Report"
    base: Base  # the place of the submission in a repository
    exit_code: ExitCode
    fix: "FixedFiles | None" = None  # the edits of all hints
    besides: Sequence[Path] = ()  # the files that were read besides a single one

    @property
    def reason(self) -> str:
        """Why the exit code is 1 although nothing failed; empty otherwise."""
        names = enumerated(
            [result.criterion.id for result in self.report.pending_automatic], MAX_NAMED_CRITERIA
        )
        if self.exit_code != ExitCode.FAILED or not names or self.report.has_failures:
            return ""
        return printable(f"exit code 1: cannot be determined, and needs manual grading: {names}")


def _warn_of_place(submission: "Submission", path: str, warn: Warn) -> None:
    """Warn of several candidates, and of a folder that is inside a package."""
    if submission.several:
        warn(submission.several)
    if submission.package or submission.is_single:
        return
    around = _package_around(path)
    if around:
        warn(f"{around}/package.xml exists: this is inside a package; run `grader grade {around}`")


def _warn_of_faults(report: "Report", warn: Warn) -> None:
    """Warn of each check that raised an error."""
    for result in report.results:
        if result.traceback:
            warn(printable(f"{result.criterion.id}: {result.traceback.strip().splitlines()[-1]}"))


def grade_request(request: GradeRequest, warn: Warn) -> GradeRun:
    """Grade a submission as a request says. Raises GraderError."""
    threshold = request.threshold  # before grading, to refuse a wrong one at once
    for kind in (request.output_format, *(kind for kind, _ in request.saves)):
        list_inputs(kind)  # as well
    from grader.lab.grading.grade import grade
    from grader.lab.submission.opening import open_submission
    from grader.lab.submission.submission import Opening

    rubric = requested_rubric(request)
    if threshold is not None:
        _check_threshold(rubric, request, threshold)
    reports = frozenset(os.path.realpath(file) for _, file in request.saves)
    opening = Opening(request.max_size, read_arguments(request.arg or ()), reports=reports)
    submission = open_submission(request.path, rubric.lab, opening, with_neighbours=True)
    _warn_of_place(submission, request.path, warn)
    report = grade(rubric, submission, tuple(request.part or ()))
    _warn_of_faults(report, warn)
    fix = None
    if report.has_failures or request.fix or request.hints is not None:
        from grader.app.hints_and_fix import (
            add_hints,  # late: many submissions lose nothing
        )

        report, fix = add_hints(
            report, submission, request.hints, warn, is_fixed=request.fix is not None
        )
    folder = find_folder(request.path, submission.path) if submission.is_single else None
    besides = tuple(folder / path for path in submission.besides) if folder else ()
    return GradeRun(
        report, find_base(request.path, folder), exit_code(report, threshold), fix, besides
    )


def _check_threshold(
    rubric: "Rubric", request: GradeRequest, threshold: tuple[Decimal, bool]
) -> None:
    """Raise GraderError for a threshold above what the graded parts are worth."""
    from grader.lab.rubric.criterion import worth

    parts = request.part or [part.id for part in rubric.parts]
    graded = worth(row for row in rubric.criteria if row.part in parts)
    check_threshold(threshold, graded.points + graded.bonus)


def save_reports(request: GradeRequest, run: GradeRun) -> None:
    """Write the reports that `--save` names. Raises InputError: then none has changed."""
    texts = {
        file: render(run.report, kind, run.base, verbose=request.verbose)
        for kind, file in request.saves
    }
    save_texts(texts, request.path, run.besides)


def _package_around(path: str) -> str:
    """Return the way from a folder up to the package that it is in; empty if it is in none."""
    folder = Path(path).absolute()
    ways = (
        os.path.normpath(f"{path}/{'../' * depth}")
        for depth in range(1, min(_MAX_UP, len(folder.parents)) + 1)
    )
    return next((shell_quoted(way) for way in ways if Path(way, "package.xml").is_file()), "")


def requested_rubric(request: GradeRequest) -> "Rubric":
    """Return the rubric.

    Raises GraderError if it is not the expected one or lacks a part that is named.
    """
    expected = request.expect_rubric
    if expected is not None and not re.fullmatch(r"[0-9a-fA-F]{64}", expected):
        raise GraderError(
            "--expect-rubric takes the 64 digits that `grader rubric show` prints as "
            f"sha256, not {expected!r}"
        )
    rubric = load_named(request.rubric, request.answers)
    if expected is not None and expected.lower() != rubric.sha256:
        raise InputError(
            f"the rubric {rubric.id} is not the expected one: its sha256 is "
            f"{rubric.sha256}, not {expected.lower()}"
        )
    for name in request.part or ():
        rubric.part(name)
    return rubric
