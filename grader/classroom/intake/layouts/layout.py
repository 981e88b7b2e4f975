"""What a layout finds: the submissions of a class, the last of a student's attempts or copies, the ignored files."""

import os
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, replace
from hashlib import sha256

from grader.classroom.intake.roster import Roster
from grader.classroom.listing import Children, ClassListing
from grader.classroom.students import ClassSubmission, Student
from grader.text import printable_path

MAX_LINES = 200
_PATH_KEY = "./"  # no file name begins with this


class Submissions:
    """Submissions, sorted by their students' keys. A key that is not printable or not unique is replaced by a path key.

    `assignments` is what an LMS calls the assignment; of `contested` students a file was ignored that may be another
    student's. If the LMS hides all names (`is_anonymous`), a submission may belong to any student. `notes` say what was
    chosen.
    """

    def __init__(
        self,
        submissions: Iterable[ClassSubmission],
        assignments: frozenset[str] = frozenset(),
        contested: tuple[Student, ...] = (),
        notes: tuple[str, ...] = (),
        *,
        is_anonymous: bool = False,
    ) -> None:
        found = list(submissions)
        counts = Counter(submission.student.key for submission in found)
        for index, submission in enumerate(found):
            key = submission.student.key
            if counts[key] > 1 or not key.isprintable():
                student = replace(submission.student, key=path_key(submission.paths[0]))
                found[index] = replace(submission, student=student)
        self._submissions = sorted(found, key=lambda submission: submission.student.key)
        self.assignments = assignments
        self.contested = contested
        self.notes = notes
        self.is_anonymous = is_anonymous

    def __len__(self) -> int:
        return len(self._submissions)

    def student(self, index: int) -> Student:
        """Return the student, as far as names tell."""
        return self._submissions[index].student

    def submission(self, index: int) -> ClassSubmission:
        """Return the submission."""
        return self._submissions[index]

    def path(self, index: int) -> str:
        """Return the path of the student's folder or first file."""
        return self._submissions[index].paths[0]


def path_key(path: str) -> str:
    """Return the key of a submission whose own name cannot be its key: its path, which is unique.

    It begins with `./`, as no file name does, so that no student can take over such a key by naming a folder like it.
    """
    if path.isprintable():
        return f"{_PATH_KEY}{path}"
    return f"{_PATH_KEY}{printable_path(path)}-{sha256(os.fsencode(path)).hexdigest()}"


def is_path_key(key: str) -> bool:
    """Return whether a key was made by `path_key`."""
    return key.startswith(_PATH_KEY)


@dataclass(frozen=True, slots=True)
class ClassFolder:
    """The folder of a class's submissions: its names, and its path in the listing, `start`, empty or with a slash.

    `rubric_id` is the name of the lab in names of folders, `lab_folders` what its own folder is called, `assignment`
    the name in nbgrader, if the user has named it; `is_explicit` if the user has named the layout.
    """

    listing: ClassListing
    children: Children
    start: str
    ignored: "IgnoredFiles"
    name: str = ""
    rubric_id: str = ""
    roster: Roster | None = None
    assignment: str = ""
    is_explicit: bool = False
    lab_folders: tuple[str, ...] = ()


class IgnoredFiles:
    """The files that are not submissions, and why: the first lines in alphabetical order, and a count of the rest."""

    def __init__(self) -> None:
        self._lines: list[str] = []

    def add(self, path: str, reason: str) -> None:
        """Add a file; the reason continues a sentence that begins with its name."""
        self._lines.append(f"{printable_path(path)} {reason}")

    def add_all(self, folder: str, refused: Iterable[tuple[str, str]]) -> None:
        """Add names in a folder (which ends in a slash or is empty), each with its reason."""
        for name, reason in refused:
            self.add(folder + name, reason)

    def lines(self) -> tuple[str, ...]:
        """Return at most MAX_LINES lines, and one that counts the rest."""
        more = len(self._lines) - MAX_LINES
        return (*sorted(self._lines)[:MAX_LINES], *([f"and {more} more"] if more > 0 else ()))
