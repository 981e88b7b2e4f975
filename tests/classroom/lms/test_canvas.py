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
from grader.classroom.lms.preflight import Filled, Overwrite, RowNote
from grader.classroom.students import Student
from grader.classroom.tables import read_table
from grader.errors import InputError

HEADER = "Student,ID,SIS User ID,SIS Login ID,Section,Lab 6 (98765)"
POINTS = "    Points Possible,,,,,100.00"


def graded(key: str, total: str | None = "58.5", why_not: str = "", **known: Any) -> LmsGrade:
    return LmsGrade(Student(key, **known), None if total is None else Decimal(total), why_not=why_not)


def gradebook(*rows: str, header: str = HEADER, points: str = POINTS, end: str = "\n") -> bytes:
    return "".join(row + end for row in (header, points, *rows) if row).encode()


def fill(data: bytes, *grades: LmsGrade, column: str = "", out_of: str = "100", **more: Any) -> Filled:
    names = ("lab6", "A wheeled base")
    options = FillOptions(Decimal(out_of), names, column, shown="the gradebook", **more)
    return fill_gradebook(data, grades, options)


def lines(filled: Filled) -> list[str]:
    return filled.data.decode().splitlines()


def test_a_manual_posting_row_and_blank_lines_stay() -> None:
    """Rows that are no student's are unchanged and not reported as unknown."""
    rows = (",,,,,Manual Posting", "", ",,,,,", '"Doe, Jane",11,S11,jdoe,A,')
    data = (HEADER + "\r\n" + rows[0] + "\r\n" + POINTS + "\r\n" + "\r\n".join(rows[1:])).encode()
    filled = fill(data, graded("x", canvas="11"))
    assert filled.data == data + b"58.50"
    assert filled.preflight.matches


@pytest.mark.parametrize("key", ["S11", "jdoe@uni.example"])
def test_the_key_counts_as_number_and_login(key: str) -> None:
    """A gradebook whose keys are numbers or addresses is matched by them."""
    assert fill(gradebook('"Doe, Jane",11,S11,jdoe@uni.example,A,'), graded(key)).preflight.filled == 1


def test_the_most_reliable_identifier_decides() -> None:
    """Canvas' number takes precedence over a name, and a name matches nobody whose numbers differ."""
    data = gradebook('"Doe, Jane",11,,,A,', '"Roe, Rick",12,,,A,')
    filled = fill(
        data, graded("a", "10", canvas="12", name="Jane Doe"), graded("b", "20", canvas="13", name="Rick Roe")
    )
    assert lines(filled)[2:] == ['"Roe, Rick",12,,,A,10.00']
    assert filled.preflight.unknown == [
        RowNote(3, "Doe, Jane", "no student of the gradebook matches this id, address or name"),
    ]
    assert filled.preflight.missing == [RowNote(0, "Rick Roe", "has a grade, but no row in the file")]
    assert not filled.preflight.matches


def test_namesakes_are_never_guessed() -> None:
    """Two rows for one student, or two students for one row, are reported and not filled."""
    data = gradebook('"Doe, Jane",11,,,A,', '"Doe, Jane",12,,,A,', '"Lee, Ann",13,,,A,')
    filled = fill(data, graded("a", name="Jane Doe"), graded("b", name="Ann Lee"), graded("c", name="Lee, Ann"))
    assert lines(filled) == [HEADER, POINTS]
    assert [left.row for left in filled.preflight.ambiguous] == [3, 4, 5]
    assert filled.preflight.ambiguous[2].why == "could be any of 'Ann Lee', 'Lee, Ann'"
    assert not filled.preflight.matches


def test_a_remaining_namesake_is_no_match() -> None:
    """A namesake is not matched because the other one is; a matched student's name leaves its row to others."""
    data = gradebook('"Doe, Jane",11,,,A,', '"Doe, Jane",12,,,A,')
    filled = fill(data, graded("a", canvas="11", name="Jane Doe"), graded("b", name="Jane Doe"))
    assert [(left.row, left.why) for left in filled.preflight.ambiguous] == [
        (4, "'Jane Doe' could be this row or another one")
    ]
    assert filled.preflight.filled == 1
    filled = fill(data, graded("a", canvas="11", name="Jane Doe"))
    assert [left.row for left in filled.preflight.unknown] == [4]
    filled = fill(
        gradebook('"Doe, Jane",11,,,A,', '"Doe, Jane",12,,j2,A,'),
        graded("a", sis="x", canvas="11"),
        graded("j2", name="Jane Doe"),
    )
    assert filled.preflight.filled == 2


def test_rows_without_a_grade_are_omitted_with_the_reason() -> None:
    """Pending, excused, not assigned, misplaced cells: none of them is in the file, and each is reported."""
    rows = ["Pen,11,,,A,80", "Exe,12,,,A,EX", "Nas,13,,,A,N/A", "Rag,14,,,A", "Oks,15,,,A,"]
    grades = [
        graded("a", None, "a person still has to look", canvas="11"),
        *(graded(str(n), canvas=str(n)) for n in range(12, 16)),
    ]
    filled = fill(gradebook(*rows), *grades)
    assert lines(filled)[2:] == ["Oks,15,,,A,58.50"]
    assert [(left.who, left.why) for left in filled.preflight.ungraded] == [
        ("Pen", "a person still has to look"),
        ("Exe", "is excused in Canvas"),
        ("Nas", "is not assigned this assignment in Canvas"),
        ("Rag", "the row has 5 cells and the header 6"),
    ]
    assert filled.preflight.matches


def test_excuses() -> None:
    """An excuse is EX, is counted, replaces a grade with a notice, and is missed if there is no row; N/A stays."""
    rows = ["Ann,11,,,A,", "Bob,12,,,A,80", "Cem,13,,,A,ex", "Dee,14,,,A,N/A", "Eli,15,,,A"]
    excused = [LmsGrade(Student(f"k{n}", canvas=str(n)), None, "", "excused", is_excused=True) for n in range(11, 17)]
    filled = fill(gradebook(*rows), *excused)
    assert lines(filled)[2:] == ["Ann,11,,,A,EX", "Bob,12,,,A,EX", "Cem,13,,,A,ex"]
    found = filled.preflight
    assert found.excused == ["Ann", "Bob", "Cem"]
    assert found.conflicts == [Overwrite(4, "Bob", "80", "EX")]
    assert (found.filled, found.unchanged) == (2, 1)
    assert [note.why for note in found.ungraded] == [
        "is not assigned this assignment in Canvas",
        "the row has 5 cells and the header 6",
    ]
    assert found.missing == [RowNote(0, "k16", "is excused, but no row in the file")]
    assert not found.matches
    again = fill(filled.data, *excused[:3])
    assert again.data == filled.data
    assert (again.preflight.filled, again.preflight.unchanged) == (0, 3)


def test_only_this_assignment() -> None:
    """The columns that identify students stay, each once, and the row of points; all other columns are omitted, with their quotes."""
    header = 'Student,ID,"SIS User ID",SIS Login ID,Section,Notes,Quiz (1),Lab 6 (2),Section,Current Score'
    points = '"    Points Possible",,,,,,10,100,,(read only)'
    posting = ",,,,,,,Manual Posting,,"
    rows = ('"Doe, Jane",11,S11,jdoe,A,mine,7,,B,90', "Short,12", "Roe,13,,,A,mine,7,80,B,90")
    data = f"{header}\r\n{posting}\r\n{points}\r\n" + "".join(f"{row}\r\n" for row in rows)
    filled = fill(data.encode(), graded("x", canvas="11"), only=True)
    assert filled.data.decode() == (
        'Student,ID,"SIS User ID",SIS Login ID,Section,Lab 6 (2)\r\n,,,,,Manual Posting\r\n'
        '"    Points Possible",,,,,100\r\n"Doe, Jane",11,S11,jdoe,A,58.50\r\n'
    )
    assert not filled.preflight.warnings


def test_the_test_student_is_ignored() -> None:
    """Canvas' own test student is omitted and not reported as missing."""
    filled = fill(gradebook('"Student, Test",99,,abc,A,'))
    assert lines(filled) == [HEADER, POINTS]
    assert filled.preflight.matches


@pytest.mark.parametrize(
    ("header", "column", "chosen"),
    [
        ("Lab 5 (1),Lab 6 (2)", "", "Lab 6 (2)"),
        ("Lab 61 (1),LAB-6: base (2)", "", "LAB-6: base (2)"),
        ("Homework (1),Week 3: a wheeled base (2)", "", "Week 3: a wheeled base (2)"),
        ("Lab 6 (1),Current Score,Unposted Final Score (Fall)", "", "Lab 6 (1)"),
        ("Anything (1)", "Anything", "Anything (1)"),
        ("Lab 6 (1),Lab 6 report (2)", "", "Lab 6 (1)"),
        ("Lab 6 (1),Lab 6 report (2)", "2", "Lab 6 report (2)"),
        ("Lab 6 (1),Lab 6 report (2)", "Lab 6 report", "Lab 6 report (2)"),
        ("Lab 6 (1),Notes", "Notes", "Notes"),
    ],
)
def test_the_column(header: str, column: str, chosen: str) -> None:
    """By its title or number if given; else the one that names the rubric."""
    header = "Student,ID,SIS Login ID,Section," + header
    width = header.count(",")
    data = gradebook("Ann,11,a,A" + "," * (width - 3), header=header, points="Points Possible" + "," * width)
    filled = fill(data, graded("x", canvas="11"), column=column)
    assert filled.preflight.column == chosen
    assert next(csv.reader([lines(filled)[2]]))[header.split(",").index(chosen)] == "58.50"


@pytest.mark.parametrize(
    ("header", "column", "words"),
    [
        ("Lab 6 a (1),Lab 6 b (2)", "", "several possible columns.*'Lab 6 a \\(1\\)' and 'Lab 6 b \\(2\\)'"),
        (
            "Quiz (1),Test (2)",
            "",
            "no column with a title like 'lab6' or 'A wheeled base'.*'Quiz \\(1\\)' and 'Test \\(2\\)'",
        ),
        ("Midterm (98764)", "", "no column with a title like .*, choose one with --column: 'Midterm \\(98764\\)'"),
        ("Notes", "", "no column of an assignment.*'Notes'"),
        ("Lab 6 (1)", "Lab 7", "no writable column 'Lab 7'; the columns are: 'Lab 6 \\(1\\)'"),
        ("Lab 6 (1),Lab 6 (2)", "Lab 6", "more than one column 'Lab 6'"),
        ("Lab 6 (1),Final Score", "Final Score", "no writable column"),
        ("Lab 6 (1),Lab 6 (1)", "", "several possible columns"),
    ],
)
def test_an_ambiguous_column_is_refused(header: str, column: str, words: str) -> None:
    """If several columns or none match, the message lists the existing ones."""
    with pytest.raises(InputError, match=words):
        fill(gradebook(header="Student,ID,SIS Login ID,Section," + header, points=""), column=column)


def test_read_only_columns_are_not_filled() -> None:
    """A column that Canvas marks as read-only, in any language, is not filled."""
    data = gradebook(header=HEADER + ",Extra (7)", points=POINTS + ",(nur lesen)")
    assert fill(data).preflight.column == "Lab 6 (98765)"
    with pytest.raises(InputError, match="no writable column"):
        fill(data, column="7")


@pytest.mark.parametrize("data", [b"", b"\n", b"Name,Grade\n", b"Student,ID,Lab 6 (1)\n", b"%PDF-1.7 \x81"])
def test_other_files_are_refused(data: bytes) -> None:
    """A file that was not exported from Canvas is refused in one sentence."""
    with pytest.raises(InputError, match=r"gradebook") as raised:
        fill(data)
    assert "\n" not in str(raised.value)


def test_other_exports() -> None:
    """Separate first and last names, an integration ID, a root account, no SIS User ID, a guarded name."""
    header = "LastName,FirstName,ID,SIS User ID,SIS Login ID,Integration ID,Root Account,Section,Lab 6 (1)"
    filled = fill(
        gradebook("Doe,Jane,11,,,,,A,", header=header, points="Points Possible,,,,,,,,100"),
        graded("x", name="Jane Doe"),
    )
    assert lines(filled)[2] == "Doe,Jane,11,,,,,A,58.50"
    header = "Student,ID,SIS Login ID,Section,Lab 6 (1)"
    data = gradebook('"=""=1+1, Jane""",11,j,A,', header=header, points="Points Possible,,,,100")
    filled = fill(data, graded("x", name="Jane =1+1"))
    assert lines(filled)[2] == '"=""=1+1, Jane""",11,j,A,58.50'


def test_semicolons_and_decimal_commas() -> None:
    """An export in a language with decimal commas gets one; in a file with commas it is quoted."""
    data = gradebook("Jane;11;S;j;A;", header=HEADER.replace(",", ";"), points="Points Possible;;;;;100,00")
    assert lines(fill(data, graded("x", canvas="11")))[2] == "Jane;11;S;j;A;58,50"
    data = gradebook("Jane,11,S,j,A,", points='Points Possible,,,,,"100,00"')
    assert lines(fill(data, graded("x", canvas="11")))[2] == 'Jane,11,S,j,A,"58,50"'


def test_warnings() -> None:
    """Other points, no points, other assignments and another encoding are reported."""
    filled = fill(gradebook(), out_of="70", any_maximum=True)
    assert "has 100.00 points possible in Canvas, but the rubric has 70" in filled.preflight.warnings[0]
    assert "has no points possible" in fill(gradebook(points="Points Possible,,,,,")).preflight.warnings[0]
    assert "no row Points Possible" in fill(gradebook(points="")).preflight.warnings[0]
    filled = fill(gradebook(header=HEADER + ",Lab 7 (3)", points=POINTS + ",10"))
    assert "1 other assignment" in filled.preflight.warnings[0]
    filled = fill(gradebook(header=HEADER.replace("Section", "Section,Section"), points="Points Possible,,,,,,100"))
    assert "more than one column Section" in filled.preflight.warnings[0]
    assert "another format" in fill(gradebook().decode().encode("utf-16")).preflight.warnings[0]


def test_students_without_a_total_are_not_missed() -> None:
    """Students with neither a grade nor a row are not reported."""
    assert fill(gradebook(), graded("x", None)).preflight.matches


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
