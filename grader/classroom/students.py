"""Who handed in, and what each of them has handed in."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Student:
    """A student or a team. `key` names them in the gradebook, and is unique there; the rest is empty where it is not known.

    `login`, `sis` (the number that the university gives), `canvas` (Canvas' user id) and `moodle` (Moodle's participant id) are what
    rosters and LMS files know them by. `team` is the team folder that a submission lies in, in the teams layout. `maybe_canvas` are
    the numbers one of which is Canvas' user id, where a file's name can be read in more than one way. Neither of these two is kept.
    """

    key: str
    name: str = ""
    email: str = ""
    login: str = ""
    sis: str = ""
    canvas: str = ""
    moodle: str = ""
    team: str = ""
    maybe_canvas: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class ClassSubmission:
    """What one student has handed in: the last attempt, and where the earlier ones are.

    `paths` lead from the top of the class folder (or archive) to one folder, one file, or the several files that an LMS has
    saved side by side; with forward slashes. `names` says what the student called each of these, where the LMS has renamed
    them. `submitted` is a time as ISO 8601, empty where nobody says. `is_certain` is False where a roster assigns it by something
    less than the student's own number, key or login.
    """

    student: Student
    paths: tuple[str, ...]
    is_late: bool = False
    submitted: str = ""
    attempt: int = 1
    earlier: tuple[str, ...] = ()
    names: tuple[str, ...] = ()
    is_certain: bool = True
