"""Read a class folder or zip: detect its layout, and find the submission of each student. No submission is opened."""

import os
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from grader.classroom.intake.intake import Intake, assign
from grader.classroom.intake.layouts import canvas, moodle, nbgrader, teams
from grader.classroom.intake.layouts.folders import FolderSubmissions
from grader.classroom.intake.layouts.layout import ClassFolder, IgnoredFiles, Submissions
from grader.classroom.intake.listing import Children, ClassListing, FolderListing, ZipListing
from grader.classroom.intake.names import ending_of, is_course_folder, stems_of
from grader.classroom.intake.roster import Roster
from grader.errors import InputError
from grader.files.names import ROBOT_ENDINGS
from grader.files.opening import archive_kind
from grader.files.reading import not_there, read_start
from grader.submission.labs import MAX_WRAPPERS
from grader.text import counted, printable_path, shell_quoted

LAYOUTS: dict[str, Callable[[ClassFolder], Submissions]] = {
    "folders": FolderSubmissions,
    "canvas": canvas.find_submissions,
    "moodle": moodle.find_submissions,
    "teams": teams.find_submissions,
    "nbgrader": nbgrader.find_submissions,
}
_MAX_NAMES = 1_000  # in one folder
_MAX_CHECKED = 20  # entries of a class folder


def _detected(folder: ClassFolder) -> str:
    """Return the layout that the names prove, else `folders`."""
    if moodle.is_layout(folder.children):
        return "moodle"
    if canvas.is_layout(folder.children):
        return "canvas"
    if nbgrader.find_course(folder) is not None:
        return "nbgrader"
    return "teams" if teams.find_labs(folder) else "folders"


def _unwrapped(folder: ClassFolder) -> ClassFolder:
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
    if len(folders) != 1 or folders[0] == "submitted" or any(map(ending_of, files)) or _detected(folder) != "folders":
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
        listing = _listing(path)
        top = ClassFolder(listing, listing.children(""), "", IgnoredFiles(), path.resolve().name, rubric_id)
        folder = next((folder for folder in (top, _unwrapped(top)) if is_download(folder)), None)
        if folder is None:
            return None
        layout = _detected(folder)
        students = nbgrader.count_students(folder) if layout == "nbgrader" else len(LAYOUTS[layout](folder))
    except (InputError, OSError, ValueError):
        return None
    is_class = students > 1 and (layout != "canvas" or canvas.count_certain(folder.children) > 1)
    return Download(layout, students) if is_class else None


def _notes_on_downloads(folder: ClassFolder, path: Path) -> list[str]:
    """Return a note on each entry of a small class folder that is graded as one submission and may be a whole class.

    Raises InputError if there are no other entries but the course's own: then they do not count as submissions of one
    student.
    """
    names = folder.children.folders + [name for name in folder.children.files if ending_of(name)]
    others = [name for name in sorted(names) if not is_course_folder(name)] if len(names) <= _MAX_CHECKED else []
    found: dict[str, Download] = {}
    for name in others:
        is_known = folder.roster is not None and folder.roster.knows(name.removesuffix(ending_of(name)))
        if not is_known and (download := find_download(path / name, folder.rubric_id)) is not None:
            found[name] = download
    notes = []
    for name, download in found.items():
        inner, what = path / name, f"a download of a whole class ({counted(download.students, 'student')})"
        command = f"grade it with `grader batch {shell_quoted(inner)}`"
        if len(found) == len(others):
            raise InputError(
                f"{printable_path(inner)} is {what}: {command}; "
                "if it is the submission of one student, add --layout folders"
            )
        notes.append(f"{printable_path(name)} is graded as the submission of one student; if it is {what}, {command}")
    return notes


def read_class(
    path: Path,
    roster: Roster | None = None,
    layout: str = "auto",
    assignment: str = "",
    rubric_id: str = "",
    lab_folders: tuple[str, ...] = (),
) -> Intake:
    """Return the submissions in a class folder or zip; raises InputError if there are none.

    `assignment` is the one to grade in nbgrader; `rubric_id` is the name of the lab in names of folders, and
    `lab_folders` are the names of its own (default: its id).
    """
    if layout not in ("auto", *LAYOUTS):
        raise InputError(f"there is no layout {layout!r}; the layouts are: auto, {', '.join(LAYOUTS)}")
    shown = printable_path(path)
    listing, name = _listing(path), path.name
    with suppress(OSError):
        name = path.resolve().name
    lab_folders = lab_folders or tuple(filter(None, (rubric_id,)))
    folder = ClassFolder(
        listing, listing.children(""), "", IgnoredFiles(), name, rubric_id, roster, assignment, lab_folders=lab_folders
    )
    folder = _unwrapped(folder)
    if not any(folder.children):
        raise InputError(f"{shown} is empty: name the folder that holds the class's submissions")
    chosen = _detected(folder) if layout == "auto" else layout
    if assignment and chosen != "nbgrader":
        raise InputError(
            f"--assignment is only for the layout nbgrader, and {shown} has the layout {chosen}: remove it, or add"
            " --layout nbgrader"
        )
    if layout == "auto" and chosen == "folders" and "package.xml" in folder.children.files:
        raise InputError(
            f"{shown} is one submission and not a class: it contains a package.xml "
            f"(grade it with `grader grade {shell_quoted(path)}`)"
        )
    is_guess = layout == "auto" and chosen == "folders" and isinstance(listing, FolderListing)
    notes = _notes_on_downloads(folder, path) if is_guess else []
    submissions = LAYOUTS[chosen](replace(folder, is_explicit=layout != "auto"))
    ignored = folder.ignored.lines()
    if not len(submissions):
        example = "".join(f": {line}" for line in ignored[:1])
        advice = f" (without --layout {layout} the layout is detected)" if layout != "auto" else ""
        raise InputError(f"there is no submission in {shown}{example}{advice}")

    def holds_students(path: str) -> bool:
        """Return whether two students or more have submissions in a folder: it is a section, not a team's work."""
        inner = listing.children(path, _MAX_NAMES)
        return roster is not None and sum(map(roster.knows, stems_of(inner.folders, inner.files))) > 1

    intake = assign(chosen, ignored, submissions, roster, holds_students)
    return replace(intake, notes=(*notes, *intake.notes))


def _listing(path: Path) -> ClassListing:
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
