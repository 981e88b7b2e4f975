"""The files that `--save` and `--write-baseline` write, which never replace what is read."""

import os
from collections.abc import Mapping, Sequence
from pathlib import Path

from grader.report.formats import FormatRow
from grader.report.invocation import Saves
from grader.report.writing import missing_folder, refuse_inputs, refuse_symlinks, save_all
from grader.report.written_files import refuse_other_file


def check_saves(saves: Saves[FormatRow], rubric: Sequence[Path], path: str) -> None:
    """Raise InputError if a report on a submission cannot be saved.

    `rubric` are the files of the rubric, which no report replaces.
    """
    for _, file in saves:
        check_file("--save", file, path, rubric)


def check_file(option: str, file: Path, path: str, others: Sequence[Path] = ()) -> None:
    """Raise InputError if the file that an option names cannot be written.

    It has no folder, would replace a file that is read and that the grader did not write, or leads
    through a symlink of a submission. `others` are inputs besides the submission at `path`.
    """
    # os.path.isdir is False for a name that is too long, for which Path.is_dir raises before Python
    # 3.14.
    is_folder = os.path.isdir(path)  # noqa: PTH112
    refuse_symlinks(file, [path])
    refuse_inputs(option, file, others if is_folder else [*others, Path(path)])
    refuse_other_file(option, file, [Path(path)] if is_folder else _packages_around(path))
    if not os.path.isdir(file.parent):  # noqa: PTH112
        raise missing_folder(file)


def _packages_around(path: str) -> list[Path]:
    """Return the package that a single file is in, with whose files it is read."""
    folders = Path(path).absolute().parents
    return [each for each in folders if os.path.isfile(each / "package.xml")][:1]  # noqa: PTH113


def save_texts(texts: Mapping[Path, str], path: str, read: Sequence[Path]) -> None:
    """Write the reports on a submission. Raises InputError: then none has changed.

    Args:
        texts: The reports by their files.
        path: The submission.
        read: The files that a single one was read with.
    """
    for file in texts:
        refuse_inputs("--save", file, read)
    data = {file: text.encode("utf-8", "backslashreplace") for file, text in texts.items()}
    save_all(data, (path,))
