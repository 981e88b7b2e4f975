"""The result of a layout: the submissions of a class, and the ignored files."""

import os
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from hashlib import sha256
from typing import Protocol

from grader.classroom.students import ClassSubmission, Student
from grader.text import printable_path

MAX_LINES = 200
_PATH_KEY = "./"  # no file name begins with this


class Submissions(Protocol):
    """Submissions, sorted by their students' keys, which are printable and unique. Students are known from names alone."""

    @property
    def assignments(self) -> frozenset[str]:
        """The names that an LMS gives the assignment."""

    @property
    def contested(self) -> tuple[Student, ...]:
        """Students of whom a file was ignored because it may be another student's."""

    def __len__(self) -> int:
        """Return the number of submissions."""

    def student(self, index: int) -> Student:
        """Return the student that the names identify."""

    def submission(self, index: int) -> ClassSubmission:
        """Return the submission."""

    def path(self, index: int) -> str:
        """Return the path of the student's folder or first file in the class."""


@dataclass(frozen=True, slots=True)
class SubmissionList:
    """Submissions in memory."""

    submissions: Sequence[ClassSubmission]
    assignments: frozenset[str] = frozenset()
    contested: tuple[Student, ...] = ()

    def __len__(self) -> int:
        return len(self.submissions)

    def student(self, index: int) -> Student:
        """Return the student."""
        return self.submissions[index].student

    def submission(self, index: int) -> ClassSubmission:
        """Return the submission."""
        return self.submissions[index]

    def path(self, index: int) -> str:
        """Return the path of the first file."""
        return self.submissions[index].paths[0]


def submission_list(
    submissions: Iterable[ClassSubmission],
    assignments: frozenset[str] = frozenset(),
    contested: tuple[Student, ...] = (),
) -> SubmissionList:
    """Return the submissions sorted by key. A key that is not printable or not unique is replaced by a path key."""
    found = list(submissions)
    counts = Counter(submission.student.key for submission in found)
    for index, submission in enumerate(found):
        key = submission.student.key
        if counts[key] > 1 or not key.isprintable():
            student = replace(submission.student, key=path_key(submission.paths[0]))
            found[index] = replace(submission, student=student)
    return SubmissionList(sorted(found, key=lambda submission: submission.student.key), assignments, contested)


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


class IgnoredFiles:
    """The files that are not submissions, and why: the first lines in alphabetical order, and a count of the rest."""

    def __init__(self) -> None:
        self._lines: list[str] = []
        self._count = 0

    def add(self, path: str, reason: str) -> None:
        """Add a file; the reason continues a sentence that begins with its name."""
        self._lines.append(f"{printable_path(path)} {reason}")
        self._count += 1
        if len(self._lines) > 10 * MAX_LINES:
            self._lines = sorted(self._lines)[:MAX_LINES]

    def add_all(self, folder: str, refused: Iterable[tuple[str, str]]) -> None:
        """Add names in a folder (which ends in a slash or is empty), each with its reason."""
        for name, reason in refused:
            self.add(folder + name, reason)

    def lines(self) -> tuple[str, ...]:
        """Return at most MAX_LINES lines, and one that counts the rest."""
        shown = sorted(self._lines)[:MAX_LINES]
        more = self._count - len(shown)
        return (*shown, f"and {more} more") if more else tuple(shown)
