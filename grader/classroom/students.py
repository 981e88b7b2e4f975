"""Students of a class and their submissions.

A submission of a class is, in this order: a ClassSubmission (whose it is and where, found by a layout), an
OpenedSubmission (its files and their digest), a Submission (what of it is graded), and a GradingResult (its points).
In the gradebook it is a StoredSubmission (as the last run found it), and a StudentGrade (with its SubmissionFiles and
the manual marks).
"""

from dataclasses import dataclass

# The name of the student whom Canvas makes for "View as Student", in its gradebook and in lower case.
CANVAS_TEST_STUDENT = frozenset({"student, test", "test student"})


@dataclass(frozen=True, slots=True)
class Student:
    """A student or a team. `key` is unique in the gradebook; the other fields are empty where they are not known.

    `login`, `sis` (the university's id), `canvas` (Canvas' user id) and `moodle` (Moodle's participant id) are the ids
    in rosters and LMS files. `team` is the team folder of the submission, in the teams layout. `readings` are the names
    of a student or group and the Canvas user ids that the name of a file in Canvas may mean. The gradebook stores
    neither of these two.
    """

    key: str
    name: str = ""
    email: str = ""
    login: str = ""
    sis: str = ""
    canvas: str = ""
    moodle: str = ""
    team: str = ""
    readings: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class ClassSubmission:
    """The submission of one student in a class: the last attempt, and where the earlier ones are.

    `paths` are relative to the class folder or zip, with forward slashes: one folder, one file, or the several files
    that an LMS has saved side by side. `names` are the student's own names of these, where the LMS has renamed them.
    `submitted` is ISO 8601, empty if unknown. `is_certain` is False if a roster matched it by less than the student's
    own id, key or login.
    """

    student: Student
    paths: tuple[str, ...]
    is_late: bool = False
    submitted: str = ""
    attempt: int = 1
    earlier: tuple[str, ...] = ()
    names: tuple[str, ...] = ()
    is_certain: bool = True
