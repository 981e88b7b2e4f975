"""The submissions of a class, one a student, in one or several folders or zips, and which layout their names prove."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from grader.classroom.grouping import ClassSubmission, one_each
from grader.classroom.layouts import ClassFolder, entries_of, readings_of
from grader.classroom.listing import listing_of
from grader.classroom.owners import Intake, Owners
from grader.classroom.roster import Roster
from grader.classroom.team_folders import nbgrader, teams
from grader.errors import InputError
from grader.files.class_zip import ClassZip
from grader.files.names import PACKAGE_FILES
from grader.submission.labs import MAX_WRAPPERS, LabFolders, is_part
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
    ways = (["/".join(path.resolve().parts[-count:]) for path in paths] for count in (1, 2))
    names = next((way for way in ways if len(set(way)) == len(way)), [])
    if not names:
        raise InputError("the class folders have the same names: rename one, so that the roster can name them")
    roots = list(zip(map(listing_of, paths), names, strict=True))
    owners = Owners(roster, roots)
    labs = LabFolders(folders or tuple(filter(None, [rubric_id])))
    found: list[ClassSubmission] = []
    layouts: dict[str, None] = {}
    for root, (path, (listing, _)) in enumerate(zip(paths, roots, strict=True)):
        lab, is_explicit = assignment or rubric_id, layout != "auto"
        top = ClassFolder(listing, listing.children(""), "", owners.people, labs, lab, is_explicit, owners.ignored)
        folder = _inner_class(_without_gradebooks(top))
        chosen = layout if is_explicit else "nbgrader" if assignment else _layout_of(folder)
        if chosen == "teams" and not is_explicit and "package.xml" in folder.children.files:
            what = f"{printable_path(path)} is one submission and not a class: it contains a package.xml"
            raise InputError(f"{what} (grade it with `grader grade {shell_quoted(path)}`)")
        ways_to_read = {"teams": teams, "nbgrader": nbgrader}
        entries = ways_to_read[chosen](folder) if chosen in ways_to_read else entries_of(folder, chosen)
        some = list(one_each(folder, entries, root))
        if not some:
            example = "".join(f": {line}" for line in sorted(owners.ignored)[:1])
            raise InputError(f"there is no submission in {printable_path(path)}{example}")
        has_teams = is_explicit or chosen != "teams" or any(one.student.group for one in some)
        layouts[chosen if has_teams else "folders"] = None
        found += some
    owners.find(found)
    return owners.intake(" and ".join(layouts))


def _without_gradebooks(folder: ClassFolder) -> ClassFolder:
    """Return a folder without the gradebooks in it."""
    has, folders = folder.listing.has, folder.children.folders
    found = {name for name in folders if has(f"{name}/class.toml")}
    books = {name for name in found if has(f"{name}/results.jsonl") or has(f"{name}/marks")}
    folder.ignore(books, "is a gradebook")
    return replace(folder, children=folder.children._replace(folders=[name for name in folders if name not in books]))


def _layout_of(folder: ClassFolder) -> str:
    """Return the layout that the names prove, else `teams`, which may be plain folders."""
    for layout, share in (("moodle", 1), ("canvas", 3)):
        read = {name: readings_of(name, layout) for name in folder.names}
        fitting = {name for name, found in read.items() if any(one.is_written_by(layout) for one in found)}
        if fitting and len(fitting) >= share * sum(name not in fitting for name in folder.entries):
            return layout
    is_course = "submitted" in folder.children.folders and folder.inside("submitted").children.folders
    return "nbgrader" if is_course else "teams"


def _inner_class(folder: ClassFolder) -> ClassFolder:
    """Return the folder that contains the submissions.

    A download may be in folders that contain nothing else. In a zip, it can be any folder that contains all
    submissions, unless it is itself one.
    """
    around, is_zip = [folder], isinstance(folder.listing, ClassZip)
    while len(around) <= MAX_WRAPPERS and (name := _only_folder(around[-1])):
        around.append(around[-1].inside(name))
        if _layout_of(around[-1]) in (["canvas", "moodle", "nbgrader"] if is_zip else ["canvas", "moodle"]):
            return around[-1]
    if len(around) == 1 or folder.children.files or not is_zip:
        return folder
    folders, files, _ = around[1].children
    is_package = not PACKAGE_FILES.isdisjoint(files) or any(map(is_part, folders))
    return folder if is_package or len(around[1].entries) <= 1 else around[1]


def _only_folder(folder: ClassFolder) -> str:
    """Return the only folder in a folder without other submissions; empty if there is none, or it is a student's."""
    name, *others = folder.entries or [""]
    is_student = name not in folder.children.folders or name == "submitted" or folder.people.knows(name)
    return "" if others or is_student else name
