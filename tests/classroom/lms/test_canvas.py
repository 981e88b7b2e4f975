"""Totals in a Canvas gradebook: only the correct cells change, and every row that is not filled is reported."""

import csv
import io
from decimal import Decimal
from typing import Any, Literal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.lms.canvas import fill_gradebook
from grader.classroom.lms.filling import FillOptions
from grader.classroom.lms.grades import LmsGrade, has_decimal_comma, points_text, read_lms_points
from grader.classroom.lms.preflight import Filled
from grader.classroom.students import Student
from grader.classroom.tables import read_table

HEADER = "Student,ID,SIS User ID,SIS Login ID,Section,Lab 6 (98765)"
POINTS = "    Points Possible,,,,,100.00"


def graded(key: str, total: str | None = "58.5", why_not: str = "", **known: Any) -> LmsGrade:
    return LmsGrade(Student(key, **known), None if total is None else Decimal(total), why_not=why_not)


def fill(data: bytes, *grades: LmsGrade, column: str = "", out_of: str = "100", **more: Any) -> Filled:
    names = ("lab6", "A wheeled base")
    options = FillOptions(Decimal(out_of), names, column, shown="the gradebook", **more)
    return fill_gradebook(data, grades, options)


@given(st.decimals(0, 10_000, places=4))
def test_points_never_gain(points: Decimal) -> None:
    """The written points are at most those earned, less than a cent below, and read back as themselves."""
    text = points_text(points)
    assert Decimal(0) <= points - Decimal(text) < Decimal("0.01")
    assert read_lms_points(text) == read_lms_points(text.replace(".", ",")) == Decimal(text)
    assert has_decimal_comma(text.replace(".", ","))


@pytest.mark.parametrize(
    ("text", "points"),
    [
        ("1.234,50", "1234.50"),
        ("1,234.50", "1234.50"),
        ("80", "80"),
        ("-1,5", "-1.5"),
        ("", None),
        ("EX", None),
        ("80%", None),
        ("٣", None),
    ],
)
def test_points_are_read_as_canvas_reads_them(text: str, points: str | None) -> None:
    """The last comma or point is the decimal mark; anything else is no number."""
    assert read_lms_points(text) == (None if points is None else Decimal(points))


NAMES = st.text(st.sampled_from("aé=+-@\"',;\n\r\t 😀\u202eשא\\(x)"), min_size=1, max_size=8)


@given(
    st.lists(st.tuples(NAMES, NAMES, st.sampled_from(["", "80", "58.50", "EX"]), st.booleans()), max_size=6),
    st.sampled_from([csv.QUOTE_ALL, csv.QUOTE_MINIMAL]),
    st.sampled_from(["\r\n", "\n"]),
    st.sampled_from(["utf-8", "utf-8-sig", "utf-16"]),
)
def test_only_grades_change(
    students: list[tuple[str, str, str, bool]], quoting: Literal[0, 1], end: str, encoding: str
) -> None:
    """Whatever names and sections contain, rows differ from the export in the grade's cell only, and none is added."""
    text = io.StringIO(newline="")
    writer = csv.writer(text, quoting=quoting, lineterminator=end)
    writer.writerow(HEADER.split(","))
    writer.writerow(POINTS.split(","))
    for number, (name, section, old, _) in enumerate(students):
        writer.writerow([name.replace("\r", ""), str(number), "", "", section.replace("\r", ""), old])
    data = text.getvalue().encode(encoding)
    grades = [graded(f"k{n}", canvas=str(n)) for n, (*_, is_graded) in enumerate(students) if is_graded]
    filled = fill(data, *grades)
    before, after = read_table(data, "x"), read_table(filled.data, "x")
    assert (before.bom, before.encoding) == (after.bom, after.encoding)
    assert before.rows[:2] == after.rows[:2]
    known = {row.value(1): row for row in before.rows[2:]}
    expected = [n for n, (*_, old, is_graded) in enumerate(students) if is_graded and old != "EX"]
    assert [row.value(1) for row in after.rows[2:]] == [str(n) for n in expected]
    for row in after.rows[2:]:
        assert [cell.raw for cell in row.cells[:5]] == [cell.raw for cell in known[row.value(1)].cells[:5]]
        assert row.end == known[row.value(1)].end
        assert row.value(5) == "58.50"
