"""The submissions of a class, one a student, in one or several folders or zips, and which layout their names prove."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from grader.classroom.grouping import ClassSubmission, course_of, is_course, nbgrader, one_each
from grader.classroom.layouts import ClassFolder, readings_of
from grader.classroom.listing import listing_of
from grader.classroom.owners import Intake, Owners
from grader.classroom.people import People
from grader.classroom.roster import Roster
from grader.classroom.team_folders import team_labs, teams
from grader.errors import InputError
from grader.files.class_zip import ClassZip
from grader.files.names import PACKAGE_FILES
from grader.submission.labs import MAX_WRAPPERS, LabFolders, lab_words
from grader.submission.students import is_part
from grader.text import printable_path, shell_quoted

__all__ = ["ClassSubmission", "Intake", "read_class"]

LAYOUTS = ("folders", "canvas", "moodle", "teams", "nbgrader")


def read_class(
    paths: Sequence[Path],
    roster: Roster | None,
    layout: str = "auto",
    assignment: str = "",
    rubric_id: str = "",
    folders: tuple[str, ...] = (),
) -> Intake:
    """Return the submissions in class folders or zips, the sections of one class; raises InputError if there are none.

    `assignment` is the one to grade in nbgrader; `rubric_id` is the name of the lab in names of folders, and `folders`
    are the names of its own (default: its id).
    """
    if layout not in ("auto", *LAYOUTS):
        raise InputError(f"there is no layout {layout!r}; the layouts are: auto, {', '.join(LAYOUTS)}")
    labs = folders or tuple(filter(None, [rubric_id]))
    words = frozenset(word for lab in labs for word in lab_words(lab))
    ways = (["/".join(path.resolve().parts[-count:]) for path in paths] for count in (1, 2))
    names = next((way for way in ways if len(set(way)) == len(way)), [])
    if not names:
        raise InputError("the class folders have the same names: rename one, so that the roster can name them")
    roots = list(zip(map(listing_of, paths), names, strict=True))
    owners = Owners(People(roster.students if roster is not None else ()), roots, has_roster=roster is not None)
    owners.notes.extend(roster.notes if roster is not None else ())
    found: list[ClassSubmission] = []
    layouts: dict[str, None] = {}
    for root, (path, (listing, _)) in enumerate(zip(paths, roots, strict=True)):
        top = ClassFolder(
            listing, listing.children(""), "", path.resolve().name, owners.people, rubric_id, LabFolders(labs), words,
            assignment, layout != "auto", owners.ignored,
        )  # fmt: skip
        folder = _inner_class(top)
        chosen = _layout_of(folder) if layout == "auto" else layout
        layouts[chosen] = None
        _check(path, folder, chosen)
        count = len(found)
        ways_to_read = {"teams": teams, "nbgrader": nbgrader}
        some = ways_to_read[chosen](folder) if chosen in ways_to_read else one_each(folder, chosen)
        found += (one._replace(root=root) if root else one for one in some)
        if len(found) == count:
            example = "".join(f": {line}" for line in sorted(owners.ignored)[:1])
            advice = f" (without --layout {layout} the layout is detected)" if layout != "auto" else ""
            raise InputError(f"there is no submission in {printable_path(path)}{example}{advice}")
    owners.find(found)
    return owners.intake(" and ".join(layouts))


def _check(path: Path, folder: ClassFolder, layout: str) -> None:
    """Raise InputError for a folder that is no class, or does not fit what the user has named."""
    shown = printable_path(path)
    if folder.assignment and layout != "nbgrader":
        raise InputError(f"--assignment is only for the layout nbgrader, and {shown} has the layout {layout}")
    if layout == "folders" and not folder.is_explicit and "package.xml" in folder.children.files:
        advice = f"grade it with `grader grade {shell_quoted(path)}`"
        raise InputError(f"{shown} is one submission and not a class: it contains a package.xml ({advice})")


def _layout_of(folder: ClassFolder) -> str:
    """Return the layout that the names prove, else `folders`. Canvas writes names in lower case."""
    names = folder.children.folders + folder.children.files
    in_moodle = {name for name in names if readings_of(name, "moodle")}
    readings = {name: readings_of(name, "canvas") for name in names if "_" in name}
    lower = {
        name for name, found in readings.items() if any(one.login or one.name == one.name.lower() for one in found)
    }
    for layout, fitting, share in (("moodle", in_moodle, 1), ("canvas", lower, 3)):
        if fitting and len(fitting) >= share * sum(name not in fitting for name in folder.entries):
            return layout
    if is_course(folder) or ("submitted" in folder.children.folders and course_of(folder).children.folders):
        return "nbgrader"
    return "teams" if any(team_labs(folder)) else "folders"


def _inner_class(folder: ClassFolder) -> ClassFolder:
    """Return the folder that contains the submissions, without the gradebooks in it.

    A download may be in folders that contain nothing else. In a zip, it can be any folder that contains all
    submissions, unless it is itself one.
    """
    has, folders = folder.listing.has, folder.children.folders
    settings = [name for name in folders if has(f"{folder.start}{name}/class.toml")]
    books = {name for name in settings for file in ("results.jsonl", "marks") if has(f"{folder.start}{name}/{file}")}
    folder.ignore(books, "is a gradebook")
    around = [replace(folder, children=folder.children._replace(folders=[it for it in folders if it not in books]))]
    while (inner := _only_folder(around[-1])) is not None and len(around) <= MAX_WRAPPERS:
        if _layout_of(inner) in ("canvas", "moodle") or is_course(inner):
            return inner
        around.append(inner)
    if len(around) == 1 or folder.children.files or not isinstance(folder.listing, ClassZip):
        return around[0]
    only = around[1]
    is_package = not PACKAGE_FILES.isdisjoint(only.children.files) or any(map(is_part, only.children.folders))
    return around[0] if is_package or len(only.entries) <= 1 else only


def _only_folder(folder: ClassFolder) -> ClassFolder | None:
    """Return the only folder in a folder without other submissions; None if there is none, or it is a student's."""
    name, *others = folder.entries or [""]
    if others or name not in folder.children.folders or name == "submitted" or folder.people.knows_student(name):
        return None
    return folder.inside(name) if _layout_of(folder) == "folders" else None
