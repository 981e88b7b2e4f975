"""The stored data of a student: identity, enrolment, and the newest submission."""

import json
from collections.abc import Sequence
from operator import attrgetter
from typing import Any, NamedTuple

from grader.classroom.students import ClassSubmission, Student


class Enrolment(NamedTuple):
    """The roster entry of a student. The fields are columns of the table `student`."""

    is_on_roster: int | None  # None where there is no roster
    deadline: str = ""  # the student's own deadline, ISO 8601
    extension: float = 0.0  # days
    days_late: float | None = None
    roster_entry: str = ""  # the row of the roster as JSON, for a later run without --roster


NO_ROSTER = Enrolment(None)
STUDENT_COLUMNS = ("key", "name", "email", "login", "sis", "canvas", "moodle")
PROFILE_COLUMNS = (*STUDENT_COLUMNS, *Enrolment._fields)
_COUNT = len(STUDENT_COLUMNS)
_VALUES = attrgetter(*STUDENT_COLUMNS)
STORED_SUBMISSIONS = f"""
SELECT student.id, result.id, result.rubric, result.version, result.digest, result.verdict, submission.fingerprint,
    submission.files, submission.is_late, submission.submitted, submission.is_gone, run.source,
    {", ".join(f"student.{name}" for name in PROFILE_COLUMNS)}
FROM student JOIN submission ON submission.student = student.id AND submission.run =
    (SELECT max(run) FROM submission AS newer WHERE newer.student = student.id)
JOIN result ON result.id = submission.result
JOIN run ON run.id = submission.run
ORDER BY student.key
"""


class Profile(NamedTuple):
    """A student with the enrolment."""

    student: Student
    enrolment: Enrolment

    @classmethod
    def from_columns(cls, values: Sequence[Any]) -> "Profile":
        """Return the profile in a row of PROFILE_COLUMNS."""
        return cls(Student(*values[:_COUNT]), Enrolment(*values[_COUNT:]))

    def columns(self) -> tuple[Any, ...]:
        """Return a row of PROFILE_COLUMNS."""
        return (*_student_columns(self.student), *self.enrolment)

    def updated(self, student: Student, enrolment: Enrolment | None) -> "Profile":
        """Return the profile with new data: empty fields of `student`, and an `enrolment` of None, keep the old values."""
        enrolment = self.enrolment if enrolment is None else enrolment
        new, old = _student_columns(student), _VALUES(self.student)
        if new == old:  # a shortcut for most students
            return Profile(self.student, enrolment)
        values: tuple[Any, ...] = tuple(value or before for value, before in zip(new, old, strict=True))
        return Profile(Student(*values), enrolment)


class StoredSubmission(NamedTuple):
    """The newest submission of a student in the gradebook, with its result and the student's profile."""

    student_id: int
    result: int
    rubric: str
    version: str
    digest: str
    verdict: str
    fingerprint: str
    files: str  # JSON, see files_json
    is_late: int
    submitted: str
    is_gone: int
    source: str
    profile: Profile

    @classmethod
    def from_row(cls, row: Sequence[Any]) -> "StoredSubmission":
        """Return the submission in a row of STORED_SUBMISSIONS."""
        return cls._make((*row[:12], Profile.from_columns(row[12:])))

    @property
    def key(self) -> str:
        """The student's key."""
        return self.profile.student.key

    @property
    def paths(self) -> list[str]:
        """The paths of the submission below the class."""
        return list(json.loads(self.files)[0])

    @property
    def is_on_roster(self) -> bool:
        """Return whether the student was on the roster."""
        return bool(self.profile.enrolment.is_on_roster)

    def is_same(self, submission: ClassSubmission, enrolment: Enrolment | None) -> bool:
        """Return whether a submission has the same files, times, student and enrolment; the contents are not compared."""
        return (
            not self.is_gone
            and self.files == files_json(submission)
            and self.is_late == submission.is_late
            and self.submitted == submission.submitted
            and self.profile.updated(submission.student, enrolment) == self.profile
        )


def storable(text: str) -> str:
    """Return text that SQLite can store: lone surrogates are written as escapes."""
    return text.encode("utf-8", "backslashreplace").decode()


def files_json(submission: ClassSubmission) -> str:
    """Return where a submission is, as JSON: paths, names, attempt, paths of earlier attempts."""
    return json.dumps((submission.paths, submission.names, submission.attempt, submission.earlier))


def _student_columns(student: Student) -> tuple[str, ...]:
    values: tuple[str, ...] = _VALUES(student)
    return values if "".join(values).isascii() else tuple(map(storable, values))
