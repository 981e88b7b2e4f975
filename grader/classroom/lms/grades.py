"""A student's grade for an LMS: points in its notation."""

import re
from dataclasses import dataclass
from decimal import ROUND_FLOOR, Decimal

from grader.classroom.students import Student

_NUMBER = re.compile(r"-?[0-9][0-9.,]*")
_COMMA = re.compile(r"[0-9],[0-9]{1,2}$")


@dataclass(frozen=True, slots=True)
class LmsGrade:
    """A student's grade. Without a total `why_not` says why: no submission, needs manual grading.

    `feedback` is HTML from `feedback_html`; Moodle takes it, Canvas' gradebook has no place for it. `is_on_roster` is
    False for a submission that is not on the roster of its class. `is_excused` is an excuse for an LMS that knows
    excuses; it has no total. `is_older` means that the final mark or excuse was given for an earlier submission.
    """

    student: Student
    total: Decimal | None
    feedback: str = ""
    why_not: str = ""
    is_on_roster: bool = True
    is_excused: bool = False
    is_older: bool = False

    @property
    def who(self) -> str:
        """The student's name, else the key."""
        return self.student.name or self.student.key


def rounded_down(points: Decimal) -> Decimal:
    """Return points with the two decimals of Canvas and Moodle, rounded down: 99.996 of 100 is not the maximum."""
    return points.quantize(Decimal("0.01"), ROUND_FLOOR)


def points_text(points: Decimal, *, comma: bool = False) -> str:
    """Return points as both systems export them (Canvas gradebook_exporter.rb, Moodle format_float): two decimals."""
    text = format(rounded_down(points), "f")
    return text.replace(".", ",") if comma else text


def read_lms_points(text: str) -> Decimal | None:
    """Return the points in a cell, or None; the last comma or point is decimal (Canvas gradebook_importer.rb)."""
    text = re.sub(r"\s", "", text)
    if not _NUMBER.fullmatch(text):
        return None
    *whole, last = re.split("[.,]", text)
    return Decimal("".join(whole) + "." + (last or "0") if whole else last)


def has_decimal_comma(text: str) -> bool:
    """Return whether a number has a decimal comma: 100,00."""
    return _COMMA.search(text.strip()) is not None
