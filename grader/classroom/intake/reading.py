"""Read a class folder or zip: detect its layout, and find the submission of each student. No submission is opened."""

import os
from dataclasses import replace
from pathlib import Path

from grader.classroom.intake.intake import Intake, assign
from grader.classroom.intake.layouts import canvas, moodle, nbgrader, teams
from grader.classroom.intake.layouts.folders import FolderSubmissions
from grader.classroom.intake.layouts.layout import ClassFolder, IgnoredFiles, Submissions
from grader.classroom.intake.listing import Children, ClassListing, FolderListing, ZipListing
from grader.classroom.intake.names import ending_of, stems_of
from grader.classroom.intake.roster import Roster
from grader.errors import InputError
from grader.files.opening import archive_kind
from grader.files.reading import not_there, read_start
from grader.text import printable_path

LAYOUTS = ("folders", "canvas", "moodle", "teams", "nbgrader")
_MAX_NAMES = 1_000  # in one folder


class _ClassLayout:
    """The names in a class, and what the roster knows about them. `top` is the name of the class folder."""

    def __init__(self, listing: ClassListing, top: str, roster: Roster | None, rubric_id: str) -> None:
        self._listing = listing
        self._top = top
        self._roster = roster
        knows = roster.knows_submission if roster else None
        self.folder = ClassFolder(listing, listing.children(""), "", IgnoredFiles(), rubric_id, knows)
        if isinstance(listing, ZipListing):
            self._enter_only_folder()

    def detected(self) -> str:
        """Return the layout that the names prove, else `folders`."""
        if moodle.is_layout(self.folder.children):
            return "moodle"
        if canvas.is_layout(self.folder.children):
            return "canvas"
        if nbgrader.find_course(self.folder, self._top) is not None:
            return "nbgrader"
        return "teams" if self._labs(is_explicit=False) else "folders"

    def find_submissions(self, layout: str, assignment: str, *, is_explicit: bool) -> Submissions:
        """Return the submissions in this layout; `is_explicit` if the user has named it."""
        match layout:
            case "moodle":
                return moodle.find_submissions(self.folder)
            case "canvas":
                return canvas.find_submissions(self.folder)
            case "nbgrader":
                course = nbgrader.find_course(self.folder, self._top)
                return nbgrader.find_submissions(
                    self.folder, self.folder.start if course is None else course, assignment
                )
            case "teams":
                return teams.find_submissions(self.folder, self._labs(is_explicit=is_explicit))
            case _:
                return FolderSubmissions(self.folder)

    def holds_students(self, path: str) -> bool:
        """Return whether a folder holds submissions of at least two students: then it is a section, and not a team's submission."""
        inner = self._listing.children(path, _MAX_NAMES)
        return self._roster is not None and sum(map(self._roster.knows, stems_of(inner.folders, inner.files))) > 1

    def _enter_only_folder(self) -> None:
        """Enter the one folder that holds everything in a zip, unless it is itself a submission."""
        folders, files, _ = self.folder.children
        if len(folders) != 1 or files or folders[0] == "submitted" or self.detected() != "folders":
            return
        if self._roster is not None and self._roster.knows(folders[0]):
            return
        inner = self._listing.children(folders[0])
        if not _is_one_submission(inner):
            self._top = folders[0]
            self.folder = replace(self.folder, children=inner, start=f"{self._top}/")

    def _labs(self, *, is_explicit: bool) -> dict[str, str]:
        return teams.find_labs(
            self.folder, self._roster.knows_surname if self._roster else None, is_explicit=is_explicit
        )


def _is_one_submission(children: Children) -> bool:
    robots = [name for name in children.files if name.lower().endswith((".urdf", ".xacro"))]
    several = len(children.folders) + sum(1 for name in children.files if ending_of(name))
    return teams.is_package(children) or several == 0 or (len(robots) == 1 and several == 1)


def read_class(
    path: Path, roster: Roster | None = None, layout: str = "auto", assignment: str = "", rubric_id: str = "lab6"
) -> Intake:
    """Return the submissions in a class folder or zip; raises InputError if there are none.

    `assignment` is the one to grade in nbgrader; `rubric_id` is the name of the lab in names of folders.
    """
    if layout not in ("auto", *LAYOUTS):
        raise InputError(f"there is no layout {layout!r}; the layouts are: auto, {', '.join(LAYOUTS)}")
    shown = printable_path(path)
    class_layout = _ClassLayout(_listing(path), _top_name(path), roster, rubric_id)
    if not any(class_layout.folder.children):
        raise InputError(f"{shown} is empty: name the folder that holds the class's submissions")
    chosen = class_layout.detected() if layout == "auto" else layout
    if assignment and chosen != "nbgrader":
        raise InputError(
            f"--assignment is only for the layout nbgrader, and {shown} has the layout {chosen}: remove it, or add"
            " --layout nbgrader"
        )
    if layout == "auto" and chosen == "folders" and "package.xml" in class_layout.folder.children.files:
        raise InputError(
            f"{shown} is one submission and not a class: it holds a package.xml (grade it with grader grade {shown})"
        )
    submissions = class_layout.find_submissions(chosen, assignment, is_explicit=layout != "auto")
    ignored = class_layout.folder.ignored.lines()
    if not len(submissions):
        example = "".join(f": {line}" for line in ignored[:1])
        advice = f" (without --layout {layout} the layout is detected)" if layout != "auto" else ""
        raise InputError(f"there is no submission in {shown}{example}{advice}")
    return assign(chosen, ignored, submissions, roster, class_layout.holds_students)


def _top_name(path: Path) -> str:
    try:
        return path.resolve().name
    except OSError:
        return path.name


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
            " (grader grade grades a single one)"
        )
    return ZipListing(path)
