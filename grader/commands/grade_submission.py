"""Grade one submission and save the reports that `--save` names."""

import os
import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from decimal import Decimal
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from grader.commands.invocation import ExitCode, Saves, exit_code, read_arguments, read_threshold
from grader.commands.rubrics import files_of, load
from grader.commands.writing import CHECKOUTS, Warn, refuse_inputs, refuse_symlinks, remove_previous, save
from grader.errors import GraderError, InputError
from grader.files.limits import ROBOT_ENDINGS
from grader.grading.hint_levels import HintLevel
from grader.report.formats import Format, inputs_of, render
from grader.source import Base
from grader.text import printable

if TYPE_CHECKING:
    from grader.grading.report import Report
    from grader.grading.rubric import Rubric
    from grader.hints.hinting import Fix

_KEPT = (*ROBOT_ENDINGS, ".toml", ".py", ".yaml", ".yml", ".rviz", ".cfg")  # files that a report may not remove first
_SHA256 = r"[0-9a-fA-F]{64}"


class GradeRequest(NamedTuple):
    """The options of `grader grade`: a submission to grade, its rubric, and the reports to make."""

    path: str  # of the submission; - for a URDF on standard input
    rubric: str  # an id or a file
    expect_rubric: str | None  # the hash that the rubric must have
    part: Sequence[str] | None  # the ids of the parts to grade; default: all that the submission can meet
    output_format: Format  # of standard output
    saves: Saves  # the files to write, with their formats
    fail_under: str | None  # the score that must be reached, in points or percent
    max_size: int  # of a URDF, in bytes
    arg: Sequence[str] | None  # NAME=VALUE, of xacro
    answers: Path | None  # the model answers
    verbose: bool  # whether the terminal shows everything
    hints: HintLevel | None  # the most that hints tell; None for what the rubric allows
    fix: Path | None  # where to write the files with all proven edits

    @property
    def threshold(self) -> tuple[Decimal, bool] | None:
        """The threshold of `--fail-under`, if there is one. Raises GraderError."""
        return read_threshold(self.fail_under) if self.fail_under is not None else None


class _GradeRun(NamedTuple):
    """A submission that was graded."""

    report: "Report"
    base: Base  # the place of the submission in a repository
    exit_code: ExitCode
    fix: "Fix | None" = None  # the edits of all hints
    besides: tuple[Path, ...] = ()  # the files that were read besides a single one

    @property
    def reason(self) -> str:
        """Why the exit code is 1 although nothing failed; empty otherwise."""
        names = ", ".join(result.criterion.id for result in self.report.pending_automatic)
        if self.exit_code != ExitCode.FAILED or not names or self.report.has_failures:
            return ""
        return printable(f"exit code 1: could not be decided, and needs manual grading: {names}")


def grade_and_save(request: GradeRequest, warn: Warn) -> _GradeRun:
    """Grade a submission and save its reports. Raises GraderError."""
    rubric = files_of(request.rubric, request.answers) if request.saves else ()
    modes = remove_reports(request.saves, rubric, request.path)
    run = grade_submission(request, warn)
    if request.fix is None or run.fix is None:
        save_reports(request, run, modes)
        return run
    from grader.commands.hints_and_fix import files_to_fix, write_fix  # late: few ask for it

    others = [*files_of(request.rubric, request.answers), *(file for _, file in request.saves)]
    files = files_to_fix(request.fix, request.path, run.report, run.fix, run.besides, others)
    save_reports(request, run, modes)
    warn(write_fix(request.fix, request.path, run.report, run.fix, files))
    return run


def grade_submission(request: GradeRequest, warn: Warn) -> _GradeRun:
    """Grade a submission. Raises GraderError."""
    threshold = request.threshold  # before grading, to refuse a wrong one at once
    for kind in (request.output_format, *(kind for kind, _ in request.saves)):
        inputs_of(kind)  # as well
    from grader.grading.grade import grade
    from grader.submission.opening import open_submission
    from grader.submission.submission import Opening

    rubric = requested_rubric(request)
    opening = Opening(request.max_size, read_arguments(request.arg or ()))
    submission = open_submission(request.path, rubric.lab, opening, with_neighbours=True)
    if submission.several:
        warn(submission.several)
    report = grade(rubric, submission, tuple(request.part or ()))
    for result in report.results:
        if result.traceback:
            warn(printable(f"{result.criterion.id}: {result.traceback.strip().splitlines()[-1]}"))
    fix = None
    if report.has_failures or request.fix is not None or request.hints is not None:
        from grader.commands.hints_and_fix import add_hints  # late: many submissions lose nothing

        report, fix = add_hints(report, submission, request.hints, warn, is_fixed=request.fix is not None)
    folder = _folder_of(request.path, submission.path) if submission.is_single else None
    besides = tuple(folder / path for path in submission.besides) if folder is not None else ()
    return _GradeRun(report, _base_of(request.path, folder), exit_code(report, threshold), fix, besides)


def remove_reports(saves: Saves, rubric: Sequence[Path], *paths: str) -> dict[Path, int]:
    """Remove the files that `--save` names and return their permissions.

    They may be of an earlier run, or forged by a student: if this run is refused, they must not be mistaken for its
    reports. Robot descriptions and other files of a package stay, because they may be what is read. Raises InputError
    if a report would overwrite a file of the rubric or one of the submissions, or lead through a symlink of a
    submission.
    """
    if not saves:
        return {}
    refusals: list[InputError] = []
    modes: dict[Path, int | None] = {}
    # os.path.isdir is False for a name that is too long, for which Path.is_dir raises before Python 3.14.
    inputs = [*rubric, *(Path(path) for path in paths if not os.path.isdir(path))]  # noqa: PTH112
    for _, file in saves:
        try:
            refuse_symlinks(file, paths)
            refuse_inputs("--save", file, inputs)
            if Path(os.path.realpath(file)).suffix.lower() not in _KEPT:
                modes[file] = remove_previous(file)
        except InputError as error:  # the others are removed nevertheless
            refusals.append(error)
    if refusals:
        raise refusals[0]
    return {file: mode for file, mode in modes.items() if mode is not None}


def save_reports(request: GradeRequest, run: _GradeRun, modes: Mapping[Path, int]) -> None:
    """Write the reports that `--save` names, with the permissions of the files before them. Raises InputError."""
    graded = Path(request.path, run.report.submission.path or "")
    for _, file in request.saves:
        is_source = file.suffix.lower() in _KEPT
        refuse_inputs("--save", file, (Path(request.path) if is_source else graded, *run.besides))
    for kind, file in request.saves:
        text = render(run.report, kind, run.base, verbose=request.verbose)
        save(file, text, (request.path,), modes.get(file))


def requested_rubric(request: GradeRequest) -> "Rubric":
    """Return the rubric. Raises GraderError if it is not the expected one or lacks a part that is named."""
    expected = request.expect_rubric
    if expected is not None and not re.fullmatch(_SHA256, expected):
        raise GraderError(
            f"--expect-rubric takes the 64 digits that `grader rubric show` prints as sha256, not {expected!r}"
        )
    rubric = load(request.rubric, request.answers)
    if expected is not None and expected.lower() != rubric.sha256:
        raise InputError(
            f"the rubric {rubric.id} is not the expected one: its sha256 is {rubric.sha256}, not {expected.lower()}"
        )
    for name in request.part or ():
        rubric.part(name)
    return rubric


def _folder_of(path: str, inside: str | None) -> Path:
    """Return the folder that the paths of a single URDF start in, given the path in it."""
    return Path(path).parent.resolve().joinpath(*[".."] * (inside or "").count("/")).resolve()


def _base_of(path: str, single: Path | None) -> Base:
    """Return where a submission is in its repository; `single` is the folder in which paths of a single URDF start."""
    if path == "-":
        return Base(is_outside=True)
    named = Path(path)
    is_folder = named.is_dir()
    # A file keeps the name that was typed, even if that is a symlink; a folder is resolved.
    place = named.resolve() if is_folder else named.parent.resolve() / named.name
    root = _repository(place)
    if root is None:
        return Base(is_outside=True)
    if is_folder or single is not None:
        start = place if single is None else single
        if not start.is_relative_to(root):
            return Base(is_outside=True)
        folder = start.relative_to(root).as_posix()
        return Base("" if folder == "." else f"{folder}/")
    return Base(archive=place.relative_to(root).as_posix())


def _repository(place: Path) -> Path | None:
    """Return the root of a path's repository: the CI checkout, else the folder with .git, else the current folder."""
    around = [place, *place.parents]
    for name in CHECKOUTS:
        checkout = Path(os.environ.get(name) or os.sep).resolve()
        if checkout in around[:-1]:  # the last is the root of the file system
            return checkout
    for folder in around:
        if (folder / ".git").exists():
            return folder
    with suppress(OSError):  # the current folder may have been deleted
        here = Path.cwd()
        return here if here in around else None
    return None
