"""Grade files of an LMS: the cases of `fills.toml`, and what holds for any class and any file."""

import csv
import io
import tomllib
from decimal import Decimal
from pathlib import Path
from typing import Any, Literal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.base.errors import InputError
from grader.classroom.lms.fill import Filled, FillOptions, PublishedGrade, fill
from grader.classroom.lms.forms import FORMS
from grader.classroom.roster.roster import Student
from grader.classroom.tables import read_table

CASES = tomllib.loads(Path(__file__).with_name("fills.toml").read_text(encoding="utf-8"))["case"]
NAMES = ("A wheeled base", "lab6")
CANVAS = (
    "Student,ID,SIS User ID,SIS Login ID,Section,Lab 6 (98765)\n    Points Possible,,,,,100.00\n"
)


def fill_text(
    text: str | bytes, *grades: PublishedGrade, lms: str = "canvas", out_of: int = 100, **more: Any
) -> Filled:
    data = text if isinstance(text, bytes) else text.encode()
    return fill(
        data, grades, FORMS[lms], FillOptions(Decimal(out_of), NAMES, shown="lms.csv", **more)
    )


def grades_in(text: str) -> list[PublishedGrade]:
    """Return the class in a table of students with `total`, `comment`, and `is_on_roster`, which may be no."""
    grades = []
    for row in csv.DictReader(io.StringIO(text)):
        total, comment, on_roster = (
            row.pop(name, "") for name in ("total", "comment", "is_on_roster")
        )
        points = Decimal(total) if total not in ("", "EX") else None
        why = "excused" if total == "EX" else "nothing was submitted"
        student = Student(**row, is_on_roster=on_roster != "no")  # type: ignore[arg-type]
        grades.append(PublishedGrade(student, points, total == "EX", why, comment))
    return grades


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case['lms']}: {case['about']}")
def test_cases(case: dict[str, Any]) -> None:
    """A file is filled byte for byte, with the lines that say what its import changes, or refused in one line."""
    grades = grades_in(case.get("class", ""))
    more = {"out_of": case.get("out_of", 100), **case.get("options", {})}
    try:
        data, lines, is_complete, _ = fill_text(case["file"], *grades, lms=case["lms"], **more)
    except InputError as error:
        assert ([str(error)], None) == (case["lines"], case.get("filled"))
        return
    assert (data.decode(), lines, is_complete) == (
        case["filled"],
        case["lines"],
        case.get("is_complete", False),
    )


@given(st.decimals(0, 10_000, places=4), st.sampled_from(["100.00", "100,00"]))
def test_points_never_gain(points: Decimal, maximum: str) -> None:
    """The written points are at most those earned, less than a cent below, with the decimal sign of the maximum."""
    text = CANVAS.replace(",", ";").replace("100.00", maximum) + "Ann;11;;;A;\n"
    row = (
        fill_text(text, PublishedGrade(Student("a", canvas="11"), points))
        .data.decode()
        .splitlines()[-1]
    )
    cell = row.rpartition(";")[2]
    assert cell[-3] == maximum[-3]
    assert Decimal(0) <= points - Decimal(cell.replace(",", ".")) < Decimal("0.01")


ODD = st.text(st.sampled_from("aé=+-@\"',;\n\r\t 😀\u202eשא\\(x)"), min_size=1, max_size=8)


@given(
    st.lists(
        st.tuples(ODD, ODD, st.sampled_from(["", "80", "58.50", "EX"]), st.booleans()), max_size=6
    ),
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
    writer.writerows(csv.reader(io.StringIO(CANVAS)))
    for number, (name, section, old, _) in enumerate(students):
        writer.writerow(
            [name.replace("\r", ""), str(number), "", "", section.replace("\r", ""), old]
        )
    data = text.getvalue().encode(encoding)
    grades = [
        PublishedGrade(Student(f"k{n}", canvas=str(n)), Decimal("58.5"))
        for n, one in enumerate(students)
        if one[3]
    ]
    filled = fill_text(data, *grades)
    before, after = read_table(data, "x"), read_table(filled.data, "x")
    assert (before.bom, before.encoding, before.rows[:2]) == (
        after.bom,
        after.encoding,
        after.rows[:2],
    )
    known = {row.value(1): row for row in before.rows[2:]}
    expected = [
        str(n) for n, (*_, old, is_graded) in enumerate(students) if is_graded and old != "EX"
    ]
    assert [row.value(1) for row in after.rows[2:]] == expected
    for row in after.rows[2:]:
        assert (row.cells[:5], row.end) == (known[row.value(1)].cells[:5], known[row.value(1)].end)
        assert row.value(5) == "58.50"
    assert all(line.isprintable() for line in filled.lines)


FIELDS = ("canvas", "login", "sis", "email")
PERSON = st.tuples(
    st.sampled_from(["Ann Ash", "Ash, Ann", "ann  ash", "Bob", ""]),
    st.sets(st.sampled_from([*FIELDS, "name"])),  # what the roster has
    st.sets(st.sampled_from(["login", "sis"])),  # what the file has
    st.sampled_from(["", *FIELDS[1:]]),  # the key on the roster
)


@given(st.lists(PERSON, min_size=1, max_size=6), st.lists(st.integers(0, 5), max_size=3))
def test_nobody_gets_the_grade_of_another(
    people: list[tuple[str, set[str], set[str], str]], liars: list[int]
) -> None:
    """A row gets its student's grade or none, whatever the file and the roster lack, and if a student submits as another."""
    rows, grades, own = [], [], {}
    for number, (name, known, shown, key) in enumerate(people):
        true = {field: f"{field}{number}" for field in FIELDS} | {
            "canvas": str(100 + number),
            "name": name,
        }
        ids = [true[field] if field in shown else "" for field in ("sis", "login")]
        rows.append([name or "x", true["canvas"], *ids, "A", ""])
        values: dict[str, Any] = {field: true[field] for field in known}
        grades.append(
            PublishedGrade(Student(true.get(key, f"key{number}"), **values), Decimal(number))
        )
        own[true["canvas"]] = f"{number}.00"
    for number in liars:
        name = people[number % len(people)][0]
        grades.append(
            PublishedGrade(
                Student(f"login{number}", name, login=f"login{number}", is_on_roster=False),
                Decimal(99),
            )
        )
    text = io.StringIO()
    csv.writer(text).writerows(rows)
    filled = fill_text(CANVAS + text.getvalue(), *grades)
    for row in read_table(filled.data, "x").rows[2:]:
        assert row.value(5) == own[row.value(1)]


def test_a_large_class_has_few_lines() -> None:
    """Rows and students without a grade are one line for each reason, and replaced grades are limited."""
    rows = "".join(f"Student {n},{n},,,A,{1 if n < 50 else ''}\n" for n in range(200))
    grades = [
        PublishedGrade(
            Student(f"k{n}", canvas=str(n)), Decimal(n) if n < 50 else None, why_open="open"
        )
        for n in range(150)
    ]
    lines = fill_text(CANVAS + rows, *grades).lines
    assert lines[0] == "column 'Lab 6 (98765)': 49 filled in, 1 already the same"
    assert lines[1:3] == [
        "row 3, Student 0: was 1, becomes 0.00",
        "row 5, Student 2: was 1, becomes 2.00",
    ]
    assert lines[41] == "... and 9 more"
    why = "matches no student for certain"
    assert lines[42:] == [
        "without a grade: 100 (row 53, Student 50; row 54, Student 51; row 55, Student 52 and 97 more): open",
        f"in the file, but not in the class: 50 (row 153, Student 150; row 154, Student 151; row 155, Student 152 and 47 more): {why}",
    ]
