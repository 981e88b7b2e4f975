"""Which layout a class folder has, and whether it certainly is a whole class.

A layout is proven by the names in one folder; a download is a whole class as an LMS or nbgrader gives it, and no folder
of a student. Either may be in folders that contain nothing else.
"""

import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from grader.classroom.intake.layouts import canvas, moodle, nbgrader, teams
from grader.classroom.intake.layouts.folders import FolderSubmissions
from grader.classroom.intake.layouts.layout import ClassFolder, IgnoredFiles, Submissions
from grader.classroom.intake.names import ending_of
from grader.classroom.listing import Children, ClassListing, FolderListing, ZipListing
from grader.errors import InputError
from grader.files.names import ROBOT_ENDINGS
from grader.files.opening import archive_kind
from grader.files.reading import not_there, read_start
from grader.submission.labs import MAX_WRAPPERS
from grader.text import printable_path

LAYOUTS: dict[str, Callable[[ClassFolder], Submissions]] = {
    "folders": FolderSubmissions,
    "canvas": canvas.find_submissions,
    "moodle": moodle.find_submissions,
    "teams": teams.find_submissions,
    "nbgrader": nbgrader.find_submissions,
}


def layout_of(folder: ClassFolder) -> str:
    """Return the layout that the names prove, else `folders`."""
    if moodle.is_layout(folder.children):
        return "moodle"
    if canvas.is_layout(folder.children):
        return "canvas"
    if nbgrader.find_course(folder) is not None:
        return "nbgrader"
    return "teams" if teams.find_labs(folder) else "folders"


def inner_class(folder: ClassFolder) -> ClassFolder:
    """Return the folder that contains the submissions.

    An unpacked download may be in folders that contain nothing else. In a zip, it can be any folder that contains all
    files, unless it is itself a submission.
    """
    wrappers, inner = list[ClassFolder](), _only_folder(folder)
    while inner is not None and len(wrappers) < MAX_WRAPPERS and not is_download(inner):
        wrappers.append(inner)
        inner = _only_folder(inner)
    if inner is not None and is_download(inner):
        for outer in (folder, *wrappers):
            beside = ((name, "is beside the folder of the download") for name in outer.children.files)
            folder.ignored.add_all(outer.start, (*beside, *outer.children.refused))
        return inner
    only = _only_folder(folder) if isinstance(folder.listing, ZipListing) and not folder.children.files else None
    return folder if only is None or _is_one_submission(only.children) else only


def _only_folder(folder: ClassFolder) -> ClassFolder | None:
    """Return the only folder in a folder without other submissions; None if there is none, or it is a student's."""
    folders, files, _ = folder.children
    if len(folders) != 1 or folders[0] == "submitted" or any(map(ending_of, files)) or layout_of(folder) != "folders":
        return None
    if folder.roster is not None and folder.roster.knows(folders[0]):
        return None
    inner = f"{folder.start}{folders[0]}"
    return replace(folder, children=folder.listing.children(inner), start=f"{inner}/", name=folders[0])


def is_download(folder: ClassFolder) -> bool:
    """Return whether a folder is certainly a whole class as an LMS or nbgrader gives it, and no folder of a student."""
    children = folder.children
    return moodle.is_layout(children) or canvas.is_class(children, folder.name) or nbgrader.is_course(folder)


def _is_one_submission(children: Children) -> bool:
    robots = [name for name in children.files if name.lower().endswith(ROBOT_ENDINGS)]
    several = len(children.folders) + sum(1 for name in children.files if ending_of(name))
    return teams.is_package(children) or several == 0 or (len(robots) == 1 and several == 1)


class Download(NamedTuple):
    """A whole class as an LMS or nbgrader gives it."""

    layout: str
    students: int


def find_download(path: Path, rubric_id: str) -> Download | None:
    """Return the download of a class at a path, a folder or zip; None for what may be the submission of one student.

    In Canvas, the names of two students' archives or robots prove it: a student may have pictures with such names.
    """
    try:
        listing = listing_of(path)
        top = ClassFolder(listing, listing.children(""), "", IgnoredFiles(), path.resolve().name, rubric_id)
        folder = next((folder for folder in (top, inner_class(top)) if is_download(folder)), None)
        if folder is None:
            return None
        layout = layout_of(folder)
        students = nbgrader.count_students(folder) if layout == "nbgrader" else len(LAYOUTS[layout](folder))
    except (InputError, OSError, ValueError):
        return None
    is_class = students > 1 and (layout != "canvas" or canvas.count_certain(folder.children) > 1)
    return Download(layout, students) if is_class else None


def listing_of(path: Path) -> ClassListing:
    """Return the listing of a class folder or zip; raises InputError if it is neither."""
    shown = printable_path(path)
    try:
        if path.is_dir():
            return FolderListing(path)
        exists = os.path.lexists(path)
    except (OSError, ValueError) as error:
        raise InputError(f"cannot read {shown}: {error}") from None
    if not exists:
        raise not_there(path)
    if archive_kind(read_start(path, 512)) != "zip":
        raise InputError(
            f"{shown} is neither a folder nor a zip: name the folder that holds the class's submissions"
            " (`grader grade` grades a single one)"
        )
    return ZipListing(path)
