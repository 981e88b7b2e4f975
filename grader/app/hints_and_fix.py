"""Hints of one submission.

`--hints` and the rubric decide how much they tell, `--fix` writes their edits.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from grader.base.errors import InputError, MachineError, OutOfTime
from grader.base.grouping import known_values
from grader.base.text import MAX_NAMED, enumerated, format_points, printable, printable_path
from grader.files.limits import ROBOT_ENDINGS
from grader.lab.grading.report import INCOMPLETE_HINTS, Report
from grader.lab.hints.hinting import FixedFiles, fixed, hinted
from grader.lab.rubric.hint_levels import LEVELS, HintLevel
from grader.lab.submission.submission import Submission
from grader.report.writing import Warn, make_folder, refuse_inputs, refuse_symlinks, save_bytes

_FILES = (*ROBOT_ENDINGS, ".zip")  # endings that no folder has


def add_hints(
    report: Report, submission: Submission, wanted: HintLevel | None, warn: Warn, *, is_fixed: bool
) -> tuple[Report, FixedFiles]:
    """Return a report with hints up to the wanted level, and the edits of all of them.

    The edits are returned if they are to be written.

    The level cannot exceed the rubric's. At the levels `none` and `place`, pictures of the report
    do not show the reference. Raises InputError if edits are to be written at a level that does not
    show them.
    """
    allowed = report.rubric.hints
    level = allowed if wanted is None else min(allowed, wanted, key=LEVELS.index)
    if is_fixed and level != "edit":
        cause = f"the rubric {report.rubric.id} allows" if level == allowed else "--hints asks for"
        raise InputError(f"--fix needs hints of the level edit; {cause} {level}")
    if wanted is not None and level != wanted:
        warn(
            f"--hints {wanted}: the rubric {report.rubric.id} allows hints up to the level "
            f"{allowed}"
        )
    if level != allowed:
        report = report._replace(rubric=replace(report.rubric, hints=level))
    fix = FixedFiles({}, report, "no criterion failed")
    if level == "none" or not report.has_failures:
        return report, fix
    try:
        hinted_report = hinted(report, submission, level)
    except OutOfTime as error:  # the report is there already
        warn(f"no hints: the search for them ran out of time: {error}")
        return report, fix._replace(why_nothing="the search for edits ran out of time")
    except Exception as error:  # noqa: BLE001  a fault of the search must not cost the report
        own_fault = f"the grader itself failed ({type(error).__name__}); please report it"
        warn(f"no hints: {error if isinstance(error, MachineError) else own_fault}")
        return report, fix._replace(why_nothing="the search for edits failed")
    if hinted_report.faults:
        warn(
            f"some hints are missing: the grader itself failed ({hinted_report.faults[0]}); please "
            "report it"
        )
    return hinted_report.report, fixed(hinted_report, submission) if is_fixed else fix


def files_to_fix(
    target: Path,
    graded: str,
    report: Report,
    fix: FixedFiles,
    besides: Sequence[Path],
    others: Iterable[Path],
) -> dict[Path, bytes]:
    """Return the files to write that edits change.

    Raises InputError if one of them may not be written.

    A folder gets each file under its path; of a submission that is one file, the target may be a
    file. `besides` are the files that were read besides a single one, `others` what else the run
    reads or writes.
    """
    files = known_values(fix.files)
    if _is_folder(target, report):
        is_named_like_file = target.suffix.lower() in _FILES and not target.exists()
        if is_named_like_file or target.is_file():
            raise InputError(
                f"--fix: {printable_path(target)} names a file: of a folder or an archive name a "
                "folder"
            )
        written = {target / path: data for path, data in files.items()}
    else:
        _refuse_several(files, report.submission.path, has_others=bool(besides))
        written = {}
        for data in files.values():  # of one file at most
            written[target] = data
    for file in written:
        refuse_symlinks(file, (graded,))
        refuse_inputs("--fix", file, (Path(graded), *besides, *others))
    return written


def _refuse_several(files: Mapping[str, bytes], urdf: str | None, *, has_others: bool) -> None:
    """Raise InputError if edits change more than the graded file, which alone fits into a file."""
    if len(files) > 1 or (files and has_others and urdf not in files):
        names = ", ".join(map(printable, files))
        only = f"only {urdf}" if urdf in files else urdf
        raise InputError(f"--fix: the edits change {names}, not {only}: name a folder that exists")


def _is_folder(target: Path, report: Report) -> bool:
    """Return whether a target is to be a folder: always, unless the submission is one file."""
    return target.is_dir() or not report.submission.is_single


def write_fix(
    target: Path, graded: str, report: Report, fix: FixedFiles, written: Mapping[Path, bytes]
) -> str:
    """Write the files that edits change, and return what was done in a sentence.

    Raises InputError.
    """
    if not written:
        return f"--fix: nothing was written: {fix.why_nothing}"
    for file, data in written.items():
        if _is_folder(target, report):
            make_folder(file.parent)
        save_bytes(file, data, (graded,))
    gone = [
        f"; {printable(path)} was renamed: delete the old file"
        for path, data in fix.files.items()
        if data is None
    ]
    if not report.hints_complete:
        gone.append(f"; {INCOMPLETE_HINTS}")
    names = enumerated(
        [printable(path) for path, data in fix.files.items() if data is not None], MAX_NAMED
    )
    before = format_points(report.score)
    after = format_points(fix.report.score)
    score = f"{before} -> {after} of {format_points(report.max_score)} points"
    return f"--fix: wrote {names} to {printable_path(target)}: {score}{''.join(gone)}"
