"""What goes to a learning management system: a student's total, or why there is none; and points as such a system writes them."""

import re
from dataclasses import dataclass
from decimal import ROUND_FLOOR, Decimal

from grader.classroom.students import Student

_CENT = Decimal("0.01")
_NUMBER = re.compile(r"-?[0-9][0-9.,]*")
_COMMA = re.compile(r"[0-9],[0-9]{1,2}$")


@dataclass(frozen=True, slots=True)
class LmsGrade:
    """What one student gets. Without a total `why_not` says, in words, why: no hand-in, a person still has to look.

    `feedback` is HTML (`feedback_html` makes it); Moodle takes it, Canvas' gradebook has no place for it. `is_on_roster` is False for
    a submission that is not on the roster of its class.
    """

    student: Student
    total: Decimal | None
    feedback: str = ""
    why_not: str = ""
    is_on_roster: bool = True

    @property
    def who(self) -> str:
        """The student for a message: by name, else by key."""
        return self.student.name or self.student.key


def cut(points: Decimal) -> Decimal:
    """Points with the two decimals that Canvas and Moodle keep, rounded down: 99.996 of 100 is no full mark."""
    return points.quantize(_CENT, ROUND_FLOOR)


def points_text(points: Decimal, *, comma: bool = False) -> str:
    """Points as both systems export them (Canvas gradebook_exporter.rb, Moodle format_float): two decimals, no exponent."""
    text = format(cut(points), "f")
    return text.replace(".", ",") if comma else text


def exact_words(points: Decimal) -> str:
    """Points as they are, without trailing zeros: 58.5, and 70 rather than 70.0."""
    return format(points.normalize(), "f") if points else "0"


def read_points(text: str) -> Decimal | None:
    """The points that a cell shows, or None. The last comma or point is the decimal mark (Canvas gradebook_importer.rb)."""
    text = re.sub(r"\s", "", text)
    if not _NUMBER.fullmatch(text):
        return None
    *whole, last = re.split("[.,]", text)
    return Decimal("".join(whole) + "." + (last or "0") if whole else last)


def has_decimal_comma(text: str) -> bool:
    """Whether a number is written with a comma before its decimals: 100,00."""
    return _COMMA.search(text.strip()) is not None
