"""The reports that `--save` writes, which never replace an input."""

import os
from collections.abc import Mapping, Sequence
from pathlib import Path

from grader.files.limits import ROBOT_ENDINGS
from grader.report.formats import FormatRow
from grader.report.invocation import Saves
from grader.report.writing import missing_folder, refuse_inputs, refuse_symlinks, save_all

_SOURCES = (
    *ROBOT_ENDINGS,
    ".toml",
    ".py",
    ".yaml",
    ".yml",
    ".rviz",
    ".cfg",
)  # of files that no report may replace


def is_source(file: Path) -> bool:
    """Return whether a file may be part of a submission, by its ending."""
    return file.suffix.lower() in _SOURCES


def check_saves(saves: Saves[FormatRow], rubric: Sequence[Path], *paths: str) -> None:
    """Raise InputError if a report cannot be saved.

    It has no folder, would overwrite an input, or leads through a symlink of a submission.

    Inputs are the files of the rubric and the submissions that are files.
    """
    # os.path.isdir is False for a name that is too long, for which Path.is_dir raises before Python
    # 3.14.
    inputs = [*rubric, *(Path(path) for path in paths if not os.path.isdir(path))]  # noqa: PTH112
    for _, file in saves:
        refuse_symlinks(file, paths)
        refuse_inputs("--save", file, inputs)
        if not os.path.isdir(file.parent):  # noqa: PTH112
            raise missing_folder(file)


def check_file(option: str, file: Path, path: str) -> None:
    """Raise InputError if the file that an option names cannot be written beside an input."""
    refuse_symlinks(file, [path])
    refuse_inputs(option, file, [] if os.path.isdir(path) else [Path(path)])  # noqa: PTH112
    if not os.path.isdir(file.parent):  # noqa: PTH112
        raise missing_folder(file)


def save_texts(texts: Mapping[Path, str], path: str, read: Sequence[Path]) -> None:
    """Write the reports on a submission. Raises InputError: then none has changed.

    Args:
        texts: The reports by their files.
        path: The submission.
        read: The files that it was read from.
    """
    for file in texts:
        inputs = [Path(path), *read] if is_source(file) else read
        refuse_inputs("--save", file, inputs)
    data = {file: text.encode("utf-8", "backslashreplace") for file, text in texts.items()}
    save_all(data, (path,))
