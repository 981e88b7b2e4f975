"""Read a class folder or zip: detect its layout, and find the submission of each student. No submission is opened."""

from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from grader.classroom.intake.detection import LAYOUTS, Download, find_download, inner_class, layout_of, listing_of
from grader.classroom.intake.intake import Intake, assign
from grader.classroom.intake.layouts.layout import ClassFolder, IgnoredFiles
from grader.classroom.intake.names import ending_of, is_course_folder, stems_of
from grader.classroom.intake.roster import Roster
from grader.classroom.listing import FolderListing
from grader.errors import InputError
from grader.text import counted, printable_path, shell_quoted

_MAX_NAMES = 1_000  # in one folder
_MAX_CHECKED = 20  # entries of a class folder


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
    listing, name = listing_of(path), path.name
    with suppress(OSError):
        name = path.resolve().name
    lab_folders = lab_folders or tuple(filter(None, (rubric_id,)))
    folder = ClassFolder(
        listing, listing.children(""), "", IgnoredFiles(), name, rubric_id, roster, assignment, lab_folders=lab_folders
    )
    folder = inner_class(folder)
    if not any(folder.children):
        raise InputError(f"{shown} is empty: name the folder that holds the class's submissions")
    chosen = _chosen_layout(folder, layout, path)
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


def _chosen_layout(folder: ClassFolder, layout: str, path: Path) -> str:
    """Return the layout of a class folder. Raises InputError if it does not fit the folder, or what the user named."""
    shown = printable_path(path)
    chosen = layout_of(folder) if layout == "auto" else layout
    if folder.assignment and chosen != "nbgrader":
        raise InputError(
            f"--assignment is only for the layout nbgrader, and {shown} has the layout {chosen}: remove it, or add"
            " --layout nbgrader"
        )
    if layout == "auto" and chosen == "folders" and "package.xml" in folder.children.files:
        raise InputError(
            f"{shown} is one submission and not a class: it contains a package.xml "
            f"(grade it with `grader grade {shell_quoted(path)}`)"
        )
    return chosen
