"""The refusal to grade several students as one, a class or a team's repository, with the command for each and all."""

import os
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from grader.errors import InputError
from grader.submission.labs import MAX_WRAPPERS
from grader.text import counted, first_lines, printable_path, shell_quoted

if TYPE_CHECKING:
    from grader.grading.rubric import Rubric

_MAX_LISTED = 20
_LMS = {"canvas": "Canvas", "moodle": "Moodle", "nbgrader": "nbgrader"}


def refuse_class(path: str, rubric: "Rubric", options: str) -> None:
    """Raise InputError, with the command for the class, if a path is a whole class as an LMS or nbgrader gives it."""
    if not _may_be_class(path):
        return
    from grader.classroom.layouts import is_submission  # late: few submissions look like a class
    from grader.classroom.submissions import read_class

    try:
        found = read_class([Path(path)], None, rubric_id=rubric.id)
    except (InputError, OSError, ValueError):
        return
    certain = [one for one in found.submissions if found.layout != "canvas" or any(map(is_submission, one.paths))]
    if found.layout in _LMS and len(certain) > 1:  # a student may have pictures with names as in Canvas
        what = f"{printable_path(path)} is a download of {_LMS[found.layout]} with"
        raise InputError(f"{_head(what, len(found.submissions))}\n{_for_all(shell_quoted(path), options)}")


def _may_be_class(path: str) -> bool:
    """Return whether a path is a zip, or a folder with names of an LMS. Reads only names, so that it is fast."""
    names: list[str] = []
    with suppress(OSError, ValueError):
        for _ in range(MAX_WRAPPERS):
            names = os.listdir(path)  # noqa: PTH208
            inner = [name for name in names[:_MAX_LISTED] if os.path.isdir(f"{path}/{name}")]  # noqa: PTH112
            if len(inner) != 1 or "submitted" in names:
                break
            path = f"{path}/{inner[0]}"
    is_class = "submitted" in names or sum(name.count("_") > 1 for name in names) > 1
    return is_class if names else path.lower().endswith(".zip")


def _head(what: str, students: int) -> str:
    return f"{what} the submissions of {counted(students, 'student')}: nothing was graded"


def _for_all(path: str, options: str) -> str:
    return f"to grade all: grader batch {path}{options}"


def refusal(path: str, students: tuple[str, ...], options: str) -> InputError:
    """Return the error for a path that contains the submissions of several students, in these folders.

    `options` are those of the command that choose the rubric and its parts, as a shell reads them.
    """
    is_folder = Path(path).is_dir()
    lines = [_head(f"{printable_path(path)} contains", len(students))]
    if not is_folder:
        lines.append("extract the archive; in its folder:")
    start = Path(path) if is_folder else Path()
    each = [f"to grade one: grader grade {shell_quoted(start / student)}{options}" for student in students]
    lines += first_lines(each, _MAX_LISTED)
    common = Path(os.path.commonpath([str(Path(student).parent) for student in students]))
    for_all = _for_all(f"{shell_quoted(start / common)} --layout folders", options)
    return InputError("\n".join((*lines, for_all)))
