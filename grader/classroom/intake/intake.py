"""Read a class folder or zip: its layout, and the submission of each student. No submission is opened."""

import os
from collections.abc import Iterator
from pathlib import Path

from grader.classroom.intake.assigning import Assigned, assign
from grader.classroom.intake.class_layout import LAYOUTS, ClassLayout
from grader.classroom.intake.layouts.layout import IgnoredFiles, Submissions
from grader.classroom.intake.listing import ClassListing, FolderListing
from grader.classroom.intake.roster import Roster
from grader.classroom.intake.zip_listing import ZipListing
from grader.classroom.students import ClassSubmission, Student
from grader.errors import InputError
from grader.files.opening import archive_kind
from grader.files.reading import not_there, read_start
from grader.text import printable_path


class Intake:
    """The submissions of a class. `ignored` says in lines what in the folder is not a submission, and why.

    With a roster, `unmatched` are the keys of submissions of students who are not on it (they are still graded), `absent` are students
    without a submission, `contested` students with several possible submissions, and `notes` says which submissions are ambiguous.
    A submission that is named like a group of the roster, and like no student on it, counts once for each member of the group.
    `assignments` are the names of the assignment in nbgrader or Canvas.
    """

    def __init__(
        self, layout: str, submissions: Submissions, ignored: IgnoredFiles, roster: Roster | None, assigned: Assigned
    ) -> None:
        self.layout = layout
        self.ignored = ignored.lines()
        self.unmatched = assigned.unmatched
        self.absent = assigned.absent
        self.contested = assigned.contested
        self.assignments = submissions.assignments | (roster.assignments if roster is not None else frozenset())
        self.notes = (*(roster.notes if roster else ()), *assigned.notes)
        self._submissions = submissions
        self._roster = roster
        self._assigned = assigned

    def __len__(self) -> int:
        return len(self._assigned.order)

    def keys(self) -> Iterator[str]:
        """Yield the keys of the submissions, in order."""
        for position, index in enumerate(self._assigned.order):
            submission = ClassSubmission(self._submissions.student(index), ())
            yield self._assigned.final(self._roster, position, submission).student.key

    def named_students(self) -> Iterator[Student]:
        """Yield the students that the names of the submissions identify."""
        yield from map(self._submissions.student, range(len(self._submissions)))

    def submissions(self) -> Iterator[ClassSubmission]:
        """Yield the submissions in the order of their students' keys."""
        for position, index in enumerate(self._assigned.order):
            yield self._assigned.final(self._roster, position, self._submissions.submission(index))


def read_class(
    path: Path, roster: Roster | None = None, layout: str = "auto", assignment: str = "", rubric_id: str = "lab6"
) -> Intake:
    """Return the submissions in a class folder or zip; raises InputError if there are none.

    `assignment` is the one to grade in nbgrader; `rubric_id` is the name of the lab in names of folders.
    """
    if layout not in ("auto", *LAYOUTS):
        raise InputError(f"there is no layout {layout!r}; the layouts are: auto, {', '.join(LAYOUTS)}")
    shown = printable_path(path)
    class_layout = ClassLayout(_listing(path), _top_name(path), roster, assignment, rubric_id)
    if class_layout.is_empty:
        raise InputError(f"{shown} is empty: name the folder that holds the class's submissions")
    chosen = class_layout.detected() if layout == "auto" else layout
    if assignment and chosen != "nbgrader":
        raise InputError(
            f"--assignment is only for the layout nbgrader, and {shown} has the layout {chosen}: remove it, or add"
            " --layout nbgrader"
        )
    if layout == "auto" and chosen == "folders" and "package.xml" in class_layout.children.files:
        raise InputError(
            f"{shown} is one submission and not a class: it contains a package.xml (grade it with `grader grade {shown}`)"
        )
    ignored = IgnoredFiles()
    submissions = class_layout.find_submissions(chosen, ignored, is_explicit=layout != "auto")
    if not len(submissions):
        example = "".join(f": {line}" for line in ignored.lines()[:1])
        advice = f" (without --layout {layout} the layout is detected)" if layout != "auto" else ""
        raise InputError(f"there is no submission in {shown}{example}{advice}")
    assigned = assign(submissions, roster, holds_students=class_layout.holds_students)
    return Intake(chosen, submissions, ignored, roster, assigned)


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
            " (`grader grade` grades a single one)"
        )
    return ZipListing(path)
