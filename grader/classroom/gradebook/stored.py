"""The stored data of a student: identity, enrolment, and the newest submission."""

import json
from collections.abc import Sequence
from operator import attrgetter
from typing import Any, NamedTuple

from grader.classroom.gradebook.result import storable
from grader.classroom.students import ClassSubmission, Student


class Enrolment(NamedTuple):
    """The roster entry of a student. The fields are columns of the table `student`."""

    is_on_roster: int | None = None  # None where there is no roster
    deadline: str = ""  # the student's own deadline, ISO 8601
    extension: float = 0.0  # days
    days_late: float | None = None
    roster_entry: str = ""  # the row of the roster as JSON, for a later run without --roster
    section: str = ""
    marker: str = ""  # the person who grades the student manually


STUDENT_COLUMNS = ("key", "name", "email", "login", "sis", "canvas", "moodle")
PROFILE_COLUMNS = (*STUDENT_COLUMNS, *Enrolment._fields)
_COUNT = len(STUDENT_COLUMNS)
_VALUES = attrgetter(*STUDENT_COLUMNS)
_PROFILE = ", ".join(f"student.{name}" for name in PROFILE_COLUMNS)
STORED_SUBMISSIONS = f"""
SELECT student.id, {_PROFILE},
    result.id, result.rubric, result.version, result.digest, result.verdict, result.parts,
    submission.fingerprint, submission.files, submission.is_late, submission.submitted, submission.is_gone,
    run.source, run.max_size
FROM student JOIN newest_submission AS submission ON submission.student = student.id
JOIN result ON result.id = submission.result
JOIN run ON run.id = submission.run
ORDER BY student.key
"""
WITHOUT_SUBMISSION = f"""
SELECT student.id, {_PROFILE} FROM student
WHERE NOT EXISTS (SELECT 1 FROM submission WHERE submission.student = student.id) ORDER BY key
"""


class StoredSubmission(NamedTuple):
    """The profile of a student in the gradebook, and the newest submission with its result, unless there is none."""

    student_id: int
    profile: tuple[Any, ...]  # PROFILE_COLUMNS
    result: int = 0
    rubric: str = ""
    version: str = ""
    digest: str = ""
    verdict: str = "missing"
    parts: str = ""  # ids between spaces
    fingerprint: str = ""
    files: str = "[[], [], 0, []]"  # JSON, see files_json
    is_late: int = 0
    submitted: str = ""
    is_gone: int = 1
    source: str = ""
    max_size: int = 0

    @classmethod
    def of(cls, row: tuple[Any, ...]) -> "StoredSubmission":
        """Return what a row of one of the two queries says."""
        end = 1 + len(PROFILE_COLUMNS)
        return cls(row[0], row[1:end], *row[end:])

    @property
    def student(self) -> Student:
        """The student."""
        return Student(*self.profile[:_COUNT])

    @property
    def enrolment(self) -> Enrolment:
        """Return the enrolment that the roster gives the student."""
        return Enrolment(*self.profile[_COUNT:])

    @property
    def key(self) -> str:
        """The student's key."""
        return str(self.profile[0])

    @property
    def paths(self) -> list[str]:
        """The paths of the submission below the class."""
        return list(json.loads(self.files)[0])

    def is_same(self, submission: ClassSubmission, enrolment: Enrolment | None) -> bool:
        """Return whether a submission has the same files, times, student and enrolment, without reading contents."""
        return (
            not self.is_gone
            and self.files == files_json(submission)
            and self.is_late == submission.is_late
            and self.submitted == submission.submitted
            and profile_of(submission.student, enrolment, self.profile) == self.profile
        )


def files_json(submission: ClassSubmission) -> str:
    """Return where a submission is, as JSON: paths, names, attempt, paths of earlier attempts."""
    return json.dumps((submission.paths, submission.names, submission.attempt, submission.earlier))


def profile_of(student: Student, enrolment: Enrolment | None, before: Sequence[Any] = ()) -> tuple[Any, ...]:
    """Return a row of PROFILE_COLUMNS: empty fields of the student, and no enrolment, stay as they were `before`."""
    values: tuple[str, ...] = _VALUES(student)
    if not "".join(values).isascii():
        values = tuple(map(storable, values))
    if before:
        values = tuple(value or old for value, old in zip(values, before[:_COUNT], strict=True))
    return (*values, *(enrolment or before[_COUNT:] or Enrolment()))
