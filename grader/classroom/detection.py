"""Which layout the names in a class folder prove, and which folder contains the submissions."""

import re
from dataclasses import replace

from grader.classroom import course_layouts, layouts
from grader.classroom.layouts import ClassFolder, ClassSubmission, in_canvas, in_moodle
from grader.classroom.listing import ZipListing, is_gradebook
from grader.files.names import PACKAGE_FILES, ROBOT_ENDINGS
from grader.submission.labs import MAX_WRAPPERS
from grader.submission.students import is_part
from grader.text import printable_path

# Words in the names of folders with what a course hands out: Lab6 resources, Handout (old); no other may be in them.
_COURSE = frozenset(
    {
        "resource", "handout", "solution", "template", "starter", "skeleton", "material", "example", "instruction",
        "reference", "rubric", "grading", "demo", "slide",
    }
)  # fmt: skip
_BESIDE = frozenset(
    word.removesuffix("s")
    for word in (
        "lab", "course", "class", "code", "file", "folder", "for", "of", "the", "and", "to", "from", "old", "new",
        "sample", "model", "student", "project", "assignment", "exercise", "task", "week", "ws", "workspace",
    )
)  # fmt: skip
_MAX_CHECKED = 20  # entries of a class folder
LAYOUTS = {
    "folders": course_layouts.folders,
    "canvas": layouts.canvas,
    "moodle": layouts.moodle,
    "teams": course_layouts.teams,
    "nbgrader": course_layouts.nbgrader,
}


def layout_of(folder: ClassFolder) -> str:
    """Return the layout that the names prove, else `folders`."""
    for layout, share in (("moodle", 1), ("canvas", 3)):
        fitting = {name for name in folder.children.folders + folder.children.files if _fits(layout, name)}
        if fitting and len(fitting) >= share * sum(name not in fitting for name in folder.entries):
            return layout
    course = course_layouts.course_of(folder)
    if course_layouts.is_course(course) or (course is not folder and course.children.folders):
        return "nbgrader"
    return "teams" if any(course_layouts.team_labs(folder)) else "folders"


def _fits(layout: str, name: str) -> bool:
    """Return whether a name is one of a layout. Canvas writes names in lower case, so capitals do not count."""
    if layout == "moodle":
        return in_moodle(name) is not None
    return any(one["login"] or name[: one.start()] == name[: one.start()].lower() for one in in_canvas(name))


def is_download(folder: ClassFolder) -> bool:
    """Return whether a folder is certainly a whole class as an LMS or nbgrader gives it, and no folder of a student."""
    layout = layout_of(folder)
    if layout == "canvas":  # a student may have pictures with such names
        users = {one[0] for name in folder.entries for one in in_canvas(name)[-1:]}
        return "submissions" in folder.name.casefold() or len(users) > 1
    return layout == "moodle" or (layout == "nbgrader" and course_layouts.is_course(course_layouts.course_of(folder)))


def submissions_in(folder: ClassFolder, layout: str) -> list[ClassSubmission]:
    """Return the submissions in a folder, each with the student as far as names tell."""
    folder.ignored.extend(f"{printable_path(folder.start + name)} {reason}" for name, reason in folder.children.refused)
    return list(LAYOUTS[layout](folder))


def is_of_course(path: str) -> bool:
    """Return whether a name has a word of the course's own folders, and no word that could be a student's."""
    stem = path.rpartition("/")[2].partition(".")[0].casefold()
    words = {word.removesuffix("s") for word in re.findall(r"[^\W\d_]+", stem)}
    return not words.isdisjoint(_COURSE) and words <= _COURSE | _BESIDE


def downloads_in(folder: ClassFolder) -> list[str]:
    """Return the folders in a small class folder that are downloads of a whole class, by their names."""
    names = [
        name
        for name in folder.children.folders
        if len(folder.entries) <= _MAX_CHECKED and not folder.people.knows(name)
    ]
    return [name for name in sorted(names) if is_download(_inside(folder, name))]


def _inside(folder: ClassFolder, name: str) -> ClassFolder:
    start = f"{folder.start}{name}"
    return replace(folder, children=folder.listing.children(start), start=f"{start}/", name=name)


def inner_class(folder: ClassFolder) -> ClassFolder:
    """Return the folder that contains the submissions, without the gradebooks in it.

    A download may be in folders that contain nothing else. In a zip, it can be any folder that contains all files,
    unless it is itself a submission.
    """
    if books := [name for name in folder.children.folders if is_gradebook(folder.listing, folder.start + name)]:
        folder.ignore(books, "is a gradebook")
        kept = [name for name in folder.children.folders if name not in books]
        folder = replace(folder, children=folder.children._replace(folders=kept))
    around, inner = [folder], _only_folder(folder)
    only = inner if isinstance(folder.listing, ZipListing) and not folder.children.files else None
    while inner is not None and len(around) <= MAX_WRAPPERS:
        if is_download(inner):
            for outer in around:
                outer.ignore(outer.children.files, "is beside the folder of the download")
            return inner
        around.append(inner)
        inner = _only_folder(inner)
    return folder if only is None or _is_one_submission(only) else only


def _only_folder(folder: ClassFolder) -> ClassFolder | None:
    """Return the only folder in a folder without other submissions; None if there is none, or it is a student's."""
    name, *others = folder.entries or [""]
    if others or name not in folder.children.folders or name == "submitted" or folder.people.knows_student(name):
        return None
    return _inside(folder, name) if layout_of(folder) == "folders" else None


def _is_one_submission(folder: ClassFolder) -> bool:
    """Return whether a folder is a package, an only robot, or has nothing in it that could be a submission."""
    is_package = not PACKAGE_FILES.isdisjoint(folder.children.files) or any(map(is_part, folder.children.folders))
    is_robot = len(folder.entries) == 1 and folder.entries[0].lower().endswith(ROBOT_ENDINGS)
    return is_package or is_robot or not folder.entries
