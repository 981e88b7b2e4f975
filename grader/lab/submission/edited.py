"""A submission with edits.

It has the changed texts of its files, and the submission read again with them.
"""

from collections.abc import Iterable, Mapping
from dataclasses import replace

from grader.base.element_edits import edited
from grader.base.source import Edit
from grader.files.reading import URDF_LIMIT
from grader.files.tree import overlaid
from grader.lab.submission.submission import Submission
from grader.ros.package.robot_file import Read, read_as_ros
from grader.ros.python.budget import Budget

_Files = Mapping[
    str, bytes | None
]  # the new content of files by path; None for one that is no longer there


def edited_files(submission: Submission, edits: Iterable[Edit]) -> _Files | None:
    """Return the files of a submission that edits change; None where the edits do not fit."""
    by_path: dict[str, list[Edit]] = {}
    for edit in edits:
        by_path.setdefault(edit.path, []).append(edit)
    files: dict[str, bytes | None] = {}
    for path, of_file in by_path.items():
        before = content(submission, path)
        text = (before or b"").decode("utf-8", "surrogateescape")
        renamed = next((edit.renamed for edit in of_file if edit.renamed), "")
        after = edited(text, path, [edit for edit in of_file if not edit.renamed])
        if after is None:
            return None
        if renamed:
            files[path] = None
        files[renamed or path] = after.encode("utf-8", "surrogateescape")
    return files


def content(submission: Submission, path: str) -> bytes | None:
    """Return the bytes of a file of a submission; None where it has none that can be read."""
    if isinstance(submission.urdf, Read) and path == submission.urdf.path:
        return submission.urdf.data
    return submission.whole_tree.read(path, URDF_LIMIT)


def with_urdf(submission: Submission, files: _Files) -> Submission:
    """Return a submission with only the URDF read again.

    This is for edits of the URDF and of xacro that it includes.
    """
    submission = submission.renewed()
    urdf = submission.urdf
    assert isinstance(urdf, Read)
    is_renamed = files.get(urdf.path, b"") is None
    path = next((new for new, data in files.items() if data is not None and is_renamed), urdf.path)
    if submission.whole_tree.files:
        whole_tree = overlaid(submission.whole_tree, files)
    else:
        whole_tree = submission.whole_tree
    surroundings = submission.surroundings(Budget(), whole_tree)
    read = read_as_ros(files.get(path) or urdf.data, path, surroundings)
    return replace(submission, urdf=read, whole_tree=whole_tree, budget=surroundings.budget)


def with_files(submission: Submission, files: _Files) -> Submission:
    """Return a submission that is read again from scratch with other files. Raises InputError."""
    if submission.reopen is None:
        return with_urdf(submission, files)
    return submission.reopen(overlaid(submission.whole_tree, files))
