"""A submission with edits.

It has the changed texts of its files, and the submission read again with them.
"""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import partial

from grader.base.element_edits import edit_files
from grader.base.source import Edit
from grader.files.reading import URDF_LIMIT
from grader.files.tree import overlaid
from grader.lab.submission.submission import Submission
from grader.ros.package.robot_file import Read
from grader.ros.package.robot_readings import read_edited
from grader.ros.python.budget import Budget

_Files = Mapping[
    str, bytes | None
]  # the new content of files by path; None for one that is no longer there


def edited_files(submission: Submission, edits: Iterable[Edit]) -> _Files | None:
    """Return the files of a submission that edits change; None where the edits do not fit."""
    return edit_files(partial(content, submission), edits)


def content(submission: Submission, path: str) -> bytes | None:
    """Return the bytes of a file of a submission; None where it has none that can be read."""
    if isinstance(submission.urdf, Read) and path == submission.urdf.path:
        return submission.urdf.data
    return submission.whole_tree.read(path, URDF_LIMIT)


def text_of(submission: Submission, path: str) -> str:
    """Return the text of a file of a submission; empty where it has none that can be read."""
    return (content(submission, path) or b"").decode("utf-8", "surrogateescape")


def with_urdf(submission: Submission, files: _Files) -> Submission:
    """Return a submission with only the URDF read again.

    This is for edits of the URDF and of xacro that it includes.
    """
    submission = submission.renewed()
    urdf = submission.urdf
    assert isinstance(urdf, Read)
    read = read_edited(urdf, submission.surroundings(Budget()), files)
    tree = submission.whole_tree
    whole_tree = overlaid(tree, files) if tree.files else tree
    return replace(submission, urdf=read, whole_tree=whole_tree, budget=Budget())


def with_files(submission: Submission, files: _Files) -> Submission:
    """Return a submission that is read again from scratch with other files. Raises InputError."""
    if submission.reopen is None:
        return with_urdf(submission, files)
    return submission.reopen(overlaid(submission.whole_tree, files))
