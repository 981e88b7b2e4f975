"""A class taken in: which layout its folder or zip has, and who has handed in what. No submission is opened."""

import os
from collections.abc import Callable, Iterator
from pathlib import Path

from grader.classroom.intake.layouts import canvas, folders, moodle, nbgrader, teams
from grader.classroom.intake.layouts.layout import IgnoredFiles, Submissions
from grader.classroom.intake.listing import Children, FolderListing, Listing
from grader.classroom.intake.names import ending_of
from grader.classroom.intake.roster import Roster
from grader.classroom.intake.roster_match import RosterMatches, place
from grader.classroom.intake.zip_listing import ZipListing
from grader.classroom.students import ClassSubmission, Student
from grader.errors import InputError
from grader.files.opening import archive_kind
from grader.files.reading import not_there, read_start
from grader.text import printable_path

LAYOUTS = ("folders", "canvas", "moodle", "teams", "nbgrader")
_MAX_NAMES = 1_000  # in one folder
Knows = Callable[[str], bool]


class Intake:
    """A class's hand-ins. `ignored` says in one line each what in the folder is no submission, and why.

    With a roster, `unmatched` are the keys of submissions that belong to nobody in it (they are graded all the same), `absent`
    are those who have submitted nothing, `contested` those whom several submissions may belong to, and `notes` says where the
    roster leaves it open whose a submission is. A submission that is named like a group of the roster, and like nobody in it,
    counts once for each member of the group. `assignments` are what nbgrader or Canvas call it.
    """

    def __init__(
        self, layout: str, shelf: Submissions, ignored: IgnoredFiles, roster: Roster | None, placement: RosterMatches
    ) -> None:
        self.layout = layout
        self.ignored = ignored.lines()
        self.unmatched = placement.unmatched
        self.absent: tuple[Student, ...] = placement.absent
        self.contested: tuple[Student, ...] = placement.contested
        self.assignments = shelf.assignments | (roster.assignments if roster is not None else frozenset())
        self.notes = (*(roster.notes if roster else ()), *placement.notes)
        self._shelf = shelf
        self._roster = roster
        self._placement = placement

    def __len__(self) -> int:
        return len(self._placement.order)

    def keys(self) -> Iterator[str]:
        """The keys of the submissions, in order."""
        for position, index in enumerate(self._placement.order):
            yield self._placement.key(self._roster, position, self._shelf.student(index))

    def named_students(self) -> Iterator[Student]:
        """Who has submitted, as the names of the submissions say."""
        yield from map(self._shelf.student, range(len(self._shelf)))

    def submissions(self) -> Iterator[ClassSubmission]:
        """The hand-ins in the order of their students' keys, made one by one; it may be called again."""
        for position, index in enumerate(self._placement.order):
            yield self._placement.final(self._roster, position, self._shelf.hand_in(index))


def read_class(
    path: Path, roster: Roster | None = None, layout: str = "auto", assignment: str = "", rubric_id: str = "lab6"
) -> Intake:
    """Who has handed in what, in a folder or zip. Raises InputError, in one plain sentence, where there is nothing to take in.

    `assignment` is the one of nbgrader that is meant; `rubric_id` names the lab for folders that are called after it.
    """
    if layout not in ("auto", *LAYOUTS):
        raise InputError(f"there is no layout {layout!r}; there are: auto, {', '.join(LAYOUTS)}")
    listing = _listing(path)
    taking = _Taking(listing, _top_name(path), roster, assignment, rubric_id)
    if taking.is_empty:
        raise InputError(f"{printable_path(path)} is empty: name the folder that holds the class's submissions")
    chosen = taking.layout() if layout == "auto" else layout
    if assignment and chosen != "nbgrader":
        raise InputError(
            f"--assignment goes with the layout nbgrader only, and {printable_path(path)} is taken as {chosen}: leave it out, "
            "or say --layout nbgrader"
        )
    if layout == "auto" and chosen == "folders" and "package.xml" in taking.children.files:
        shown = printable_path(path)
        raise InputError(
            f"{shown} is one submission and no class: it holds a package.xml itself (grader grade {shown} grades it)"
        )
    ignored = IgnoredFiles()
    shelf = taking.find_submissions(chosen, ignored, is_told=layout != "auto")
    if not len(shelf):
        lines = ignored.lines()
        example = f": {lines[0]}" if lines else ""
        advice = f" (without --layout {layout} it is found out)" if layout != "auto" else ""
        raise InputError(f"nothing in {printable_path(path)} is a submission{example}{advice}")
    placement = place(shelf, roster, holds_students=taking.holds_students)
    return Intake(chosen, shelf, ignored, roster, placement)


class _Taking:
    """What is known while a class is taken in: where its submissions are, and which names the roster knows."""

    def __init__(self, listing: Listing, top: str, roster: Roster | None, assignment: str, rubric_id: str) -> None:
        self._listing = listing
        self._top = top
        self._knows: Knows | None = roster.knows if roster else None
        self._knows_submission: Knows | None = roster.knows_submission if roster else None
        self._knows_surname: Knows | None = roster.knows_surname if roster else None
        self._assignment = assignment
        self._rubric_id = rubric_id
        self._start = ""
        self.children = listing.children("")
        self.is_empty = not any(self.children)
        if isinstance(listing, ZipListing):
            self._step_in()

    def layout(self) -> str:
        """The layout that this surely is, and else `folders`."""
        if moodle.fits(self.children):
            return "moodle"
        if canvas.fits(self.children):
            return "canvas"
        if self._course() is not None:
            return "nbgrader"
        return "teams" if self._labs(is_told=False) else "folders"

    def find_submissions(self, layout: str, ignored: IgnoredFiles, *, is_told: bool) -> Submissions:
        """The hand-ins in this layout; `is_told` where the user has named it."""
        listing, children, start = self._listing, self.children, self._start
        match layout:
            case "moodle":
                return moodle.find_submissions(listing, children, start, ignored)
            case "canvas":
                return canvas.find_submissions(children, start, ignored)
            case "nbgrader":
                where = self._course()
                return nbgrader.find_submissions(
                    listing, start if where is None else where, ignored, self._assignment, self._rubric_id
                )
            case "teams":
                labs = self._labs(is_told=is_told)
                return teams.find_submissions(
                    listing, children, start, ignored, self._rubric_id, self._knows_submission, labs
                )
            case _:
                return folders.find_submissions(
                    listing, children, start, ignored, self._rubric_id, self._knows_submission
                )

    def holds_students(self, path: str) -> bool:
        """Whether a folder holds hand-ins of at least two students: then it is a section, and not what a team has handed in."""
        inner = self._listing.children(path, _MAX_NAMES)
        names = inner.folders + [name.removesuffix(ending_of(name)) for name in inner.files if ending_of(name)]
        return self._knows is not None and sum(map(self._knows, names)) > 1

    def _step_in(self) -> None:
        """Go into the one folder in which everything in a zip lies, unless that is itself what one student has handed in."""
        folders, files, _ = self.children
        if len(folders) != 1 or files or folders[0] == "submitted" or self.layout() != "folders":
            return
        if self._knows and self._knows(folders[0]):
            return
        inner = self._listing.children(folders[0])
        if _is_one(inner):
            return
        self._top, self._start, self.children = folders[0], f"{folders[0]}/", inner

    def _course(self) -> str | None:
        return nbgrader.find_course(self._listing, self.children, self._start, self._top, self._rubric_id)

    def _labs(self, *, is_told: bool) -> dict[str, str]:
        return teams.find_labs(
            self._listing, self.children, self._start, self._rubric_id, self._knows_surname, is_told=is_told
        )


def _is_one(children: Children) -> bool:
    """Whether a folder looks like one submission and not like a class of them."""
    robots = [name for name in children.files if name.lower().endswith((".urdf", ".xacro"))]
    several = len(children.folders) + sum(1 for name in children.files if ending_of(name))
    return teams.is_package(children) or several == 0 or (len(robots) == 1 and several == 1)


def _top_name(path: Path) -> str:
    try:
        return path.resolve().name
    except OSError:
        return path.name


def _listing(path: Path) -> Listing:
    """The listing of a class folder or zip; raises InputError, in one sentence, where it is neither."""
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
            " (grader grade takes a single one)"
        )
    return ZipListing(path)
