"""What the gradebook has of a student, against which a run holds what it finds."""

import json
from typing import Any, NamedTuple

from grader.classroom.students import ClassSubmission, Student

_STUDENT = ("key", "name", "email", "login", "sis", "canvas", "moodle")


class Enrolment(NamedTuple):
    """What the roster says of a student: whether they are in it, when it is due for them, and how late they were."""

    expected: int | None  # 1 on the roster, 0 not on it, None while there is none
    due: str = ""
    extension: float = 0.0
    days_late: float | None = None
    entry: str = ""  # the whole row of the roster as JSON, for a run that names none


UNKNOWN = Enrolment(None)
_COLUMNS = (*_STUDENT, *Enrolment._fields)
ALL_STUDENTS = f"SELECT {', '.join(_STUDENT)} FROM student ORDER BY key"
FIND_STUDENT = f"SELECT id, {', '.join(_COLUMNS)} FROM student WHERE key = ?"
ADD_STUDENT = f"INSERT INTO student ({', '.join(_COLUMNS)}) VALUES (?{', ?' * (len(_COLUMNS) - 1)})"
CHANGE_STUDENT = f"UPDATE student SET {', '.join(f'{name} = ?' for name in _COLUMNS)} WHERE id = ?"
KNOWN = f"""
SELECT student.id, seen.result, result.rubric, result.version, result.digest, result.verdict, seen.fingerprint,
    seen.place, seen.is_late, seen.submitted, seen.is_gone, run.source, {", ".join(f"student.{name}" for name in _COLUMNS)}
FROM student JOIN seen ON seen.student = student.id AND seen.run =
    (SELECT max(run) FROM seen AS newer WHERE newer.student = student.id)
JOIN result ON result.id = seen.result
JOIN run ON run.id = seen.run
"""


class StoredSubmission(NamedTuple):
    """What the gradebook has of a student: the newest result, what it was made from, and what was told of the student."""

    student: int
    result: int
    rubric: str
    version: str
    digest: str
    verdict: str
    fingerprint: str
    place: str
    is_late: int
    submitted: str
    is_gone: int
    source: str
    told: tuple[Any, ...]

    @property
    def key(self) -> str:
        """The student's key."""
        return str(self.told[0])

    @property
    def record(self) -> Student:
        """What is known of the student."""
        return Student(*self.told[: len(_STUDENT)])

    @property
    def entry(self) -> str:
        """The row of the roster, as JSON; empty for one who is not on it."""
        return str(self.told[len(_STUDENT) + Enrolment._fields.index("entry")])

    @property
    def is_expected(self) -> bool:
        """Whether the student was on the roster."""
        return bool(self.told[len(_STUDENT)])

    def is_same(self, hand_in: ClassSubmission, enrolment: Enrolment | None) -> bool:
        """Whether nothing new is said of the student and the hand-in, whatever is in it."""
        return (
            not self.is_gone
            and self.place == place_of(hand_in)
            and self.is_late == hand_in.is_late
            and self.submitted == hand_in.submitted
            and told_of(self.told, hand_in.student, enrolment) == self.told
        )


def known_of(row: tuple[Any, ...]) -> StoredSubmission:
    """What a row of KNOWN says."""
    (
        identity, result, rubric, version, digest, verdict, fingerprint, place, is_late, submitted, is_gone, source, *told,
    ) = row  # fmt: skip
    return StoredSubmission(
        identity, result, rubric, version, digest, verdict, fingerprint, place, is_late, submitted, is_gone, source,
        tuple(told),
    )  # fmt: skip


def storable(text: str) -> str:
    """Text as a gradebook can hold it: what is no Unicode is spelt out."""
    return text.encode("utf-8", "backslashreplace").decode()


def place_of(hand_in: ClassSubmission) -> str:
    """Where a hand-in is, as JSON: paths, names, attempt, paths of earlier attempts."""
    return json.dumps((hand_in.paths, hand_in.names, hand_in.attempt, hand_in.earlier))


def values_of(student: Student) -> tuple[str, ...]:
    """A student's columns."""
    told = (student.key, student.name, student.email, student.login, student.sis, student.canvas, student.moodle)
    return told if "".join(told).isascii() else tuple(map(storable, told))


def told_of(before: tuple[Any, ...], student: Student, enrolment: Enrolment | None) -> tuple[Any, ...]:
    """What is known of a student after something more was said."""
    count = len(_STUDENT)
    values = tuple(new or old for new, old in zip(values_of(student), before[:count], strict=True))
    return values + (before[count:] if enrolment is None else tuple(enrolment))
