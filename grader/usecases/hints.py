"""Hints of one submission: `--hints` and the rubric decide how much they tell, `--fix` writes their edits."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from grader.errors import InputError, OutOfTime
from grader.grading.hints.hinting import fixed, hinted
from grader.grading.levels import LEVELS, Level
from grader.grading.report import Fix, Report
from grader.submission.submission import Submission
from grader.text import enumerated, format_points, printable, printable_path
from grader.usecases import Warn
from grader.usecases.writing import make_folder, refuse_inputs, refuse_symlinks, save_bytes

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
    if found.faults:
        warn(f"some hints are missing: the grader itself failed ({found.faults[0]}); please report it")
    return found.report, fixed(found, submission) if is_fixed else None


def files_to_fix(
    target: Path, graded: str, report: Report, fix: Fix, besides: Sequence[Path], others: Iterable[Path]
) -> dict[Path, bytes]:
    """Return the files to write that edits change. Raises InputError if one of them may not be written.

    A target that is a folder gets each file under its path; any other is the one file that changes.
    `besides` are the files that were read besides a single one, `others` what else the run reads or writes.
    """
    files = {path: data for path, data in fix.files.items() if data is not None}
    is_folder = target.is_dir()
    if len(files) > 1 and not is_folder:
        names = ", ".join(map(printable, files))
        raise InputError(f"--fix: the edits change {len(files)} files ({names}): name a folder that exists")
    own = report.submission.path
    if files and besides and not is_folder and own not in files:
        raise InputError(f"--fix: the edits change {printable(*files)}, not {own}: name a folder that exists")
    written = {(target / path if is_folder else target): data for path, data in files.items()}
    for file in written:
        refuse_symlinks(file, (graded,))
        refuse_inputs("--fix", file, (Path(graded), *besides, *others))
    return written


def write_fix(target: Path, graded: str, report: Report, fix: Fix, written: Mapping[Path, bytes]) -> str:
    """Write the files that edits change, and return what was done in a sentence. Raises InputError."""
    if not written:
        return "--fix: there is no edit to make, so nothing was written"
    for file, data in written.items():
        if target.is_dir():
            make_folder(file.parent)
        save_bytes(file, data, (graded,))
    gone = [f"; {printable(path)} was renamed: delete the old file" for path, data in fix.files.items() if data is None]
    names = enumerated([printable(path) for path, data in fix.files.items() if data is not None], _MAX_NAMED)
    score = f"{format_points(report.score)} -> {format_points(fix.report.score)} of {format_points(report.max_score)} points"
    return f"--fix: wrote {names} to {printable_path(target)}: {score}{''.join(gone)}"
