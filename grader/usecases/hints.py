"""Hints of one submission: `--hints` and the rubric decide how much they tell, `--fix` writes their edits."""

import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from grader.errors import InputError
from grader.grading.hints.hinting import fixed, hinted
from grader.grading.levels import LEVELS, Level
from grader.grading.report import Fix, Report
from grader.submission.submission import Submission
from grader.text import enumerated, format_points, printable, printable_path
from grader.usecases import Warn
from grader.usecases.limits import OutOfTime
from grader.usecases.writing import make_folder, save_bytes

_MAX_NAMED = 6


def with_hints(
    report: Report, submission: Submission, wanted: Level | None, warn: Warn, *, is_fixed: bool
) -> tuple[Report, Fix | None]:
    """Return a report with hints up to the wanted level, and the edits of all of them if they are to be written.

    The level cannot exceed the rubric's. At the levels `none` and `place`, pictures of the report do not show the reference. Raises
    InputError if edits are to be written at a level that does not show them.
    """
    allowed = report.rubric.hints
    level = allowed if wanted is None else min(allowed, wanted, key=LEVELS.index)
    if is_fixed and level != "edit":
        cause = f"the rubric {report.rubric.id} allows" if level == allowed else "--hints asks for"
        raise InputError(f"--fix needs hints of the level edit; {cause} {level}")
    if wanted is not None and level != wanted:
        warn(f"--hints {wanted}: the rubric {report.rubric.id} allows hints up to the level {allowed}")
    if level != allowed:
        report = replace(report, rubric=replace(report.rubric, hints=level))
    if level == "none" or not (report.has_failures or is_fixed):
        return report, None
    try:
        found = hinted(report, submission, level)
    except (Exception, OutOfTime) as error:  # noqa: BLE001  a fault of the search must not cost the report
        warn(f"no hints: the grader itself failed ({type(error).__name__}); please report it")
        return report, None
    return found.report, fixed(found, submission) if is_fixed else None


def write_fix(target: Path, graded: str, report: Report, fix: Fix, besides: Sequence[Path] = ()) -> str:
    """Write the files that edits change, and return what was done in a sentence. Raises InputError.

    A target that is a folder, or whose name ends in a slash, gets each file under its path; any other is the one file that changes.
    `besides` are the files that were read besides a single one.
    """
    files = {path: data for path, data in fix.files.items() if data is not None}
    if not files:
        return "--fix: there is no edit to make, so nothing was written"
    is_folder = target.is_dir() or str(target).endswith(os.sep)
    if len(files) > 1 and not is_folder:
        names = ", ".join(map(printable, files))
        raise InputError(f"--fix: the edits change {len(files)} files ({names}): name a folder that exists")
    own = report.submission.path
    if besides and not is_folder and own not in files:
        raise InputError(f"--fix: the edits change {printable(*files)}, not {own}: name a folder that exists")
    written = {(target / path if is_folder else target): data for path, data in files.items()}
    for file in written:
        for path in (graded, *map(str, besides)):
            _refuse_input(file, path)
    for file, data in written.items():
        if is_folder:
            make_folder(file.parent)
        save_bytes(file, data, (graded,))
    gone = [f"; {printable(path)} was renamed: delete the old file" for path, data in fix.files.items() if data is None]
    score = f"{format_points(report.score)} -> {format_points(fix.report.score)} of {format_points(report.max_score)} points"
    names = enumerated(list(map(printable, files)), _MAX_NAMED)
    return f"--fix: wrote {names} to {printable_path(target)}: {score}{''.join(gone)}"


def _refuse_input(file: Path, graded: str) -> None:
    """Raise InputError if a file that exists is the submission or in it."""
    root = Path(os.path.realpath(graded))
    real = Path(os.path.realpath(file))
    if real.exists() and graded != "-" and (real == root or root in real.parents or _is_same(file, root)):
        raise InputError(
            f"--fix would overwrite {printable_path(file)}, which is graded: choose another file or folder"
        )


def _is_same(file: Path, other: Path) -> bool:
    return other.exists() and file.samefile(other)
