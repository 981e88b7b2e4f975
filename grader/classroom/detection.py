"""Which layout the names in a class folder prove, and which folder contains the submissions."""

from collections.abc import Iterator
from dataclasses import replace

from grader.classroom.grouping import ClassSubmission, course_of, is_course, nbgrader, one_each
from grader.classroom.layouts import ClassFolder, readings_of
from grader.classroom.listing import is_gradebook
from grader.classroom.team_folders import team_labs, teams
from grader.files.class_zip import ClassZip
from grader.files.names import PACKAGE_FILES
from grader.submission.labs import MAX_WRAPPERS
from grader.submission.students import is_part

LAYOUTS = ("folders", "canvas", "moodle", "teams", "nbgrader")


def layout_of(folder: ClassFolder) -> str:
    """Return the layout that the names prove, else `folders`. Canvas writes names in lower case."""
    names = folder.children.folders + folder.children.files
    in_moodle = {name for name in names if readings_of(name, "moodle")}
    lower = {
        name for name in names if any(one.name == one.name.lower() or one.login for one in readings_of(name, "canvas"))
    }
    for layout, fitting, share in (("moodle", in_moodle, 1), ("canvas", lower, 3)):
        if fitting and len(fitting) >= share * sum(name not in fitting for name in folder.entries):
            return layout
    if is_course(folder) or ("submitted" in folder.children.folders and course_of(folder).children.folders):
        return "nbgrader"
    return "teams" if any(team_labs(folder)) else "folders"


def submissions_in(folder: ClassFolder, layout: str) -> Iterator[ClassSubmission]:
    """Return the submissions in a folder, each with the student as far as names tell."""
    if layout in ("teams", "nbgrader"):
        return teams(folder) if layout == "teams" else nbgrader(folder)
    return one_each(folder, layout)


def inner_class(folder: ClassFolder) -> ClassFolder:
    """Return the folder that contains the submissions, without the gradebooks in it.

    A download may be in folders that contain nothing else. In a zip, it can be any folder that contains all
    submissions, unless it is itself one.
    """
    if books := [name for name in folder.children.folders if is_gradebook(folder.listing, folder.start + name)]:
        folder.ignore(books, "is a gradebook")
        kept = [name for name in folder.children.folders if name not in books]
        folder = replace(folder, children=folder.children._replace(folders=kept))
    around = [folder]
    while (inner := _only_folder(around[-1])) is not None and len(around) <= MAX_WRAPPERS:
        if layout_of(inner) in ("canvas", "moodle") or is_course(inner):
            return inner
        around.append(inner)
    if len(around) == 1 or folder.children.files or not isinstance(folder.listing, ClassZip):
        return folder
    only = around[1]
    is_package = not PACKAGE_FILES.isdisjoint(only.children.files) or any(map(is_part, only.children.folders))
    return folder if is_package or len(only.entries) <= 1 else only


def _only_folder(folder: ClassFolder) -> ClassFolder | None:
    """Return the only folder in a folder without other submissions; None if there is none, or it is a student's."""
    name, *others = folder.entries or [""]
    if others or name not in folder.children.folders or name == "submitted" or folder.people.knows_student(name):
        return None
    return folder.inside(name) if layout_of(folder) == "folders" else None
