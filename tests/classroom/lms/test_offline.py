"""Totals in the grade files of Blackboard and Brightspace: only the correct cells change, and what is unclear is refused."""

import re
from decimal import Decimal
from typing import Any

import pytest

from grader.classroom.lms.filling import FillOptions
from grader.classroom.lms.grades import LmsGrade
from grader.classroom.lms.offline import BLACKBOARD, BRIGHTSPACE, OfflineFormat, fill_offline
from grader.classroom.lms.preflight import Filled
from grader.classroom.students import Student
from grader.errors import InputError

LEARN = '"Last Name","First Name","Username","Student ID","Lab 6 [Total Pts: 100 Score] |222","Total [Total Pts: up to 300 Score] |9"'
D2L = "OrgDefinedId,Username,Last Name,First Name,Lab 6 Points Grade <Numeric MaxPoints:100 Weight:5>,End-of-Line Indicator"


def fill(form: OfflineFormat, text: str, *grades: LmsGrade, **options: Any) -> Filled:
    settings = FillOptions(Decimal(100), ("lab6", "A wheeled base"), **options)
    return fill_offline(text.encode(), grades, settings, form)


def graded(total: str | None = "58.5", why_not: str = "", **known: Any) -> LmsGrade:
    return LmsGrade(Student("x", **known), None if total is None else Decimal(total), why_not=why_not)


@pytest.mark.parametrize(("form", "header"), [(BLACKBOARD, LEARN), (BRIGHTSPACE, D2L)])
def test_rows_without_a_grade_are_omitted(form: OfflineFormat, header: str) -> None:
    """With the reason; rows and students without a match are reported."""
    rows = "".join(f"{key},{key},Cedar,{key},,\n" for key in ("a", "b"))
    filled = fill(form, f"{header}\n{rows}", graded(None, "excused", login="a", sis="a"), graded(sis="c", login="c"))
    assert filled.data.decode() in (f"{header}\n", f"{header}\n")
    found = filled.preflight
    assert {note.why for note in [*found.ungraded, *found.unknown, *found.missing]} >= {
        "no student of the gradebook matches this id, address or name",
        "has a grade, but no row in the file",
    }


def test_what_blackboard_has_not_graded_yet() -> None:
    """The words Needs Grading are no grade that is lost; the preview user of an instructor is nobody's."""
    rows = 'Ash,Jane,ja1,S11,Needs Grading,\n"Ash_previewuser",P,ja1_previewuser,,,\n'
    filled = fill(BLACKBOARD, f"{LEARN}\n{rows}", graded(login="ja1"))
    assert filled.data.decode().splitlines()[1:] == ["Ash,Jane,ja1,S11,58.50,"]
    assert not filled.preflight.conflicts
    assert filled.preflight.matches


def test_brightspace_cuts_points_above_the_maximum() -> None:
    """Extra credit is exported, with a warning that names the student."""
    filled = fill(BRIGHTSPACE, f"{D2L}\n#S11,#ja1,Ash,Jane,,#\n", graded("105", login="ja1"))
    assert "105.00" in filled.data.decode()
    assert filled.preflight.warnings == [
        'row 2, Ash, Jane: 105 points: Brightspace reduces them to the maximum, unless "Can Exceed" is ticked for the grade item'
    ]


@pytest.mark.parametrize(
    ("form", "header", "words"),
    [
        (BLACKBOARD, "Username,Notes", "not a grade file of Blackboard.*'Lab 6 \\[Total Pts: 100 Score\\] |123456'"),
        (BLACKBOARD, "Name,Lab 6 [Total Pts: 100 Score] |222", "its first row needs Username or Student ID"),
        (BRIGHTSPACE, "", "not a grade file of Brightspace.*but has nothing"),
        (
            BRIGHTSPACE,
            D2L.replace("100", "10"),
            "Brightspace's maximum of 'Lab 6' is 10, but the rubric's maximum is 100",
        ),
        (
            BLACKBOARD,
            LEARN.replace("100", "10"),
            "Blackboard's maximum of 'Lab 6' is 10, but the rubric's maximum is 100",
        ),
        (BLACKBOARD, "Username,Lab A [Total Pts: 5] |1,Lab B [Total Pts: 5] |2", "choose one with --column"),
        (
            BRIGHTSPACE,
            D2L.replace("Lab 6", "Midterm"),
            "no column with a title like 'lab6' or 'A wheeled base', choose one",
        ),
    ],
)
def test_what_is_refused(form: OfflineFormat, header: str, words: str) -> None:
    """Another file, another maximum, and an ambiguous column, in one sentence."""
    with pytest.raises(InputError, match=words) as raised:
        fill(form, f"{header}\n")
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize("column", ["Lab 7", "7", "Lab 7 [Total Pts: 5 Score] |7"])
def test_the_column(column: str) -> None:
    """By its title, number or header; --only leaves the others out, and any maximum is allowed."""
    header = "Username,Lab 6 [Total Pts: 100 Score] |222,Lab 7 [Total Pts: 5 Score] |7,Notes"
    filled = fill(BLACKBOARD, f"{header}\nja1,1,,mine\n", graded(login="ja1"), column=column, any_maximum=True)
    assert filled.data.decode().endswith("\nja1,1,58.50,mine\n")
    assert re.search(
        "has 5 points in Blackboard, but the rubric has 100.*1 other assignment", " ".join(filled.preflight.warnings)
    )
    filled = fill(
        BLACKBOARD, f"{header}\nja1,1,,mine\n", graded(login="ja1"), column=column, any_maximum=True, only=True
    )
    assert filled.data.decode() == "Username,Lab 7 [Total Pts: 5 Score] |7\nja1,58.50\n"


def test_only_keeps_what_brightspace_needs() -> None:
    """The ids, the names, the grade and the indicator of the end of a line."""
    header = D2L.replace(",Lab 6", ",Prelab Points Grade <Numeric MaxPoints:5>,Lab 6")
    filled = fill(BRIGHTSPACE, f"{header}\n#S11,#ja1,Ash,Jane,5,,#\n", graded(login="ja1"), only=True)
    assert filled.data.decode() == f"{D2L}\n#S11,#ja1,Ash,Jane,58.50,#\n"
    assert not filled.preflight.warnings
