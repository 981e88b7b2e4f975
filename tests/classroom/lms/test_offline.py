"""Totals in the grade files of Blackboard and Brightspace: only the correct cells change, and what is unclear is refused."""

from decimal import Decimal
from typing import Any

from grader.classroom.lms.filling import FillOptions
from grader.classroom.lms.grades import LmsGrade
from grader.classroom.lms.offline import BRIGHTSPACE, OfflineFormat, fill_offline
from grader.classroom.lms.preflight import Filled
from grader.classroom.students import Student

D2L = "OrgDefinedId,Username,Last Name,First Name,Lab 6 Points Grade <Numeric MaxPoints:100 Weight:5>,End-of-Line Indicator"


def fill(form: OfflineFormat, text: str, *grades: LmsGrade, **options: Any) -> Filled:
    settings = FillOptions(Decimal(100), ("lab6", "A wheeled base"), **options)
    return fill_offline(text.encode(), grades, settings, form)


def graded(total: str | None = "58.5", why_not: str = "", **known: Any) -> LmsGrade:
    return LmsGrade(Student("x", **known), None if total is None else Decimal(total), why_not=why_not)


def test_brightspace_cuts_points_above_the_maximum() -> None:
    """Extra credit is exported, with a warning that names the student."""
    filled = fill(BRIGHTSPACE, f"{D2L}\n#S11,#ja1,Ash,Jane,,#\n", graded("105", login="ja1"))
    assert "105.00" in filled.data.decode()
    assert filled.preflight.warnings == [
        'row 2, Ash, Jane: 105 points: Brightspace reduces them to the maximum, unless "Can Exceed" is ticked for the grade item'
    ]
