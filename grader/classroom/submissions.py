"""The submissions of a class, one a student, in one or several folders or zips."""

from collections.abc import Sequence
from pathlib import Path

from grader.classroom.detection import LAYOUTS, inner_class, layout_of, submissions_in
from grader.classroom.grouping import ClassSubmission
from grader.classroom.layouts import ClassFolder
from grader.classroom.listing import listing_of
from grader.classroom.owners import Intake, Owners
from grader.classroom.people import People
from grader.classroom.roster import Roster
from grader.errors import InputError
from grader.submission.labs import LabFolders, lab_words
from grader.text import printable_path, shell_quoted

__all__ = ["ClassSubmission", "Intake", "read_class"]


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
    students, notes = roster if roster is not None else Roster(())
    ways = (["/".join(path.resolve().parts[-count:]) for path in paths] for count in (1, 2))
    names = next((way for way in ways if len(set(way)) == len(way)), [])
    if not names:
        raise InputError("the class folders have the same names: rename one, so that the roster can name them")
    roots = list(zip(map(listing_of, paths), names, strict=True))
    owners = Owners(People(students), roots, has_roster=roster is not None)
    owners.notes.extend(notes)
    found: list[ClassSubmission] = []
    layouts: dict[str, None] = {}
    for root, (path, (listing, _)) in enumerate(zip(paths, roots, strict=True)):
        top = ClassFolder(
            listing, listing.children(""), "", path.resolve().name, owners.people, rubric_id, LabFolders(labs), words,
            assignment, layout != "auto", owners.ignored,
        )  # fmt: skip
        folder = inner_class(top)
        chosen = layout_of(folder) if layout == "auto" else layout
        _check(path, folder, chosen)
        count = len(found)
        found += (one._replace(root=root) if root else one for one in submissions_in(folder, chosen))
        if len(found) == count:
            example = "".join(f": {line}" for line in sorted(owners.ignored)[:1])
            advice = f" (without --layout {layout} the layout is detected)" if layout != "auto" else ""
            raise InputError(f"there is no submission in {printable_path(path)}{example}{advice}")
        layouts[chosen] = None
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
