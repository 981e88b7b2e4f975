"""The refusal to grade a repository of several students as one, with the command for each and for all."""

import os
from pathlib import Path
from typing import TYPE_CHECKING

from grader.errors import InputError
from grader.submission.labs import LabFolders
from grader.text import counted, first_lines, printable_path, shell_quoted

if TYPE_CHECKING:
    from grader.grading.rubric import Rubric

_MAX_LISTED = 20


def refusal(path: str, students: tuple[str, ...], rubric: "Rubric", options: str) -> InputError:
    """Return the error for a path that contains the submissions of several students, in these folders.

    `options` are those of the command that choose the rubric and its parts, as a shell reads them.
    """
    is_folder = Path(path).is_dir()
    lines = [
        f"{printable_path(path)} contains the submissions of {counted(len(students), 'student')}: nothing was graded"
    ]
    if not is_folder:
        lines.append("extract the archive; in its folder:")
    start = Path(path) if is_folder else Path()
    each = [f"to grade one: grader grade {shell_quoted(start / student)}{options}" for student in students]
    lines += first_lines(each, _MAX_LISTED)
    common = Path(os.path.commonpath([str(Path(student).parent) for student in students]))
    if LabFolders(rubric.folders).is_lab(common.name):  # the layout searches for the lab's folder
        common = common.parent
    gradebook = shell_quoted(f"{rubric.id}.db")
    command = f"grader batch {shell_quoted(start / common)} --layout teams --gradebook {gradebook}{options}"
    return InputError("\n".join((*lines, f"to grade all: {command}")))
