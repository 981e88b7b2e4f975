"""Detect the layout of a class folder or zip, and find the submissions in it."""

from grader.classroom.intake.layouts import canvas, folders, moodle, nbgrader, teams
from grader.classroom.intake.layouts.layout import IgnoredFiles, Submissions
from grader.classroom.intake.listing import Children, ClassListing
from grader.classroom.intake.names import ending_of, stems_of
from grader.classroom.intake.roster import Roster
from grader.classroom.intake.zip_listing import ZipListing

LAYOUTS = ("folders", "canvas", "moodle", "teams", "nbgrader")
_MAX_NAMES = 1_000  # in one folder


class ClassLayout:
    """The names in a class, and what the roster knows about them. `top` is the name of the class folder."""

    def __init__(self, listing: ClassListing, top: str, roster: Roster | None, assignment: str, rubric_id: str) -> None:
        self._listing = listing
        self._top = top
        self._roster = roster
        self._knows_submission = roster.knows_submission if roster else None
        self._assignment = assignment
        self._rubric_id = rubric_id
        self._start = ""
        self.children = listing.children("")
        self.is_empty = not any(self.children)
        if isinstance(listing, ZipListing):
            self._enter_only_folder()

    def detected(self) -> str:
        """Return the layout that the names prove, else `folders`."""
        if moodle.is_layout(self.children):
            return "moodle"
        if canvas.is_layout(self.children):
            return "canvas"
        if self._course() is not None:
            return "nbgrader"
        return "teams" if self._labs(is_explicit=False) else "folders"

    def find_submissions(self, layout: str, ignored: IgnoredFiles, *, is_explicit: bool) -> Submissions:
        """Return the submissions in this layout; `is_explicit` if the user has named it."""
        listing, children, start, rubric_id = self._listing, self.children, self._start, self._rubric_id
        match layout:
            case "moodle":
                return moodle.find_submissions(listing, children, start, ignored)
            case "canvas":
                return canvas.find_submissions(children, start, ignored)
            case "nbgrader":
                course = self._course()
                top = start if course is None else course
                return nbgrader.find_submissions(listing, top, ignored, self._assignment, rubric_id)
            case "teams":
                labs = self._labs(is_explicit=is_explicit)
                knows = self._knows_submission
                return teams.find_submissions(listing, children, start, ignored, rubric_id, knows, labs)
            case _:
                return folders.find_submissions(listing, children, start, ignored, rubric_id, self._knows_submission)

    def holds_students(self, path: str) -> bool:
        """Return whether a folder contains submissions of at least two students: then it is a section, and not a team's submission."""
        inner = self._listing.children(path, _MAX_NAMES)
        return self._roster is not None and sum(map(self._roster.knows, stems_of(inner.folders, inner.files))) > 1

    def _enter_only_folder(self) -> None:
        """Enter the one folder that contains everything in a zip, unless it is itself a submission."""
        folders, files, _ = self.children
        if len(folders) != 1 or files or folders[0] == "submitted" or self.detected() != "folders":
            return
        if self._roster is not None and self._roster.knows(folders[0]):
            return
        inner = self._listing.children(folders[0])
        if not _is_one_submission(inner):
            self._top, self._start, self.children = folders[0], f"{folders[0]}/", inner

    def _course(self) -> str | None:
        return nbgrader.find_course(self._listing, self.children, self._start, self._top, self._rubric_id)

    def _labs(self, *, is_explicit: bool) -> dict[str, str]:
        knows = self._roster.knows_surname if self._roster else None
        return teams.find_labs(
            self._listing, self.children, self._start, self._rubric_id, knows, is_explicit=is_explicit
        )


def _is_one_submission(children: Children) -> bool:
    robots = [name for name in children.files if name.lower().endswith((".urdf", ".xacro"))]
    several = len(children.folders) + sum(1 for name in children.files if ending_of(name))
    return teams.is_package(children) or several == 0 or (len(robots) == 1 and several == 1)
