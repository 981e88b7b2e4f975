"""grader grade --fix: write the submission with the edits of all hints, never over the files that are graded."""

import os
from pathlib import Path

from grader.errors import InputError
from grader.grading.report import Fix, Report
from grader.text import counted, format_points, printable, printable_path
from grader.usecases.writing import save_bytes


def write_fix(target: Path, graded: str, report: Report, fix: Fix) -> str:
    """Write the files that edits change, and return what was done in a sentence. Raises InputError.

    A target that is a folder, or whose name ends in a slash, gets each file under its path; any other is the one file that changes.
    """
    files = {path: data for path, data in fix.files.items() if data is not None}
    if not files:
        return "--fix: there is no edit to make, so nothing was written"
    is_folder = target.is_dir() or str(target).endswith(os.sep)
    if len(files) > 1 and not is_folder:
        names = ", ".join(map(printable, files))
        raise InputError(f"--fix: the edits change {len(files)} files ({names}): name a folder that exists")
    written = {(target / path if is_folder else target): data for path, data in files.items()}
    for file in written:
        _refuse_input(file, graded)
    for file, data in written.items():
        if is_folder:
            file.parent.mkdir(parents=True, exist_ok=True)
        save_bytes(file, data, (graded,))
    gone = [f"; the file {printable(path)} has another name" for path, data in fix.files.items() if data is None]
    score = f"{format_points(report.score)} -> {format_points(fix.report.score)} of {format_points(report.max_score)} points"
    where = printable_path(target) if is_folder or len(written) > 1 else printable_path(next(iter(written)))
    return f"--fix: {counted(len(written), 'file')} written to {where}: {score}{''.join(gone)}"


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
