"""Marks of many students from one file: rows, review sheets, and exports that a person changed."""

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.base.errors import InputError
from grader.classroom.marks.mark_import import MarkImport, exported_text
from grader.classroom.marks.marks import Mark, Marks, append_marks
from grader.classroom.roster.roster import Student
from grader.classroom.tables import write_table
from tests.classroom.marks import LAB, folder_of, read, said

CASES = tomllib.loads(Path(__file__).with_name("import.toml").read_text(encoding="utf-8"))["case"]
CLASS = (Student("anna", "Anna Ek"), Student("ben", "Ben Oh"), Student("0012"), Student("-x"))
DIGESTS = {"anna": "d0a", "ben": "d0b", "-x": "d0c"}
ANSWERS = {("essay", "da1"): ("anna", "ben"), ("essay", "dc3"): ("-x",)}
GIVEN = {
    "kim.csv": "time,by,student,criterion,points,comment,submission\n"
    "2026-11-23T14:05:09.123+00:00,Kim,anna,essay,3,good,d0a\n2026-11-23T14:05:09.123+00:00,Kim,0012,total,excused,,\n"
    "2026-11-23T14:05:09.123+00:00,Kim,ben,picture,1,,d01\n",
    "own.csv": "student,criterion,points\n-x,total,4\n",
}
CRITERIA = tuple(row.id for row in LAB.criteria)
NONE = {**dict.fromkeys(CRITERIA, ""), "grade": ""}
POINTS = {
    "anna": {**NONE, "essay": "3", "picture": "1", "grade": "6.5"},
    "ben": {**NONE, "box": "2"},
    "0012": NONE,
    "-x": {**NONE, "grade": "4"},
}


def importing(marks: Marks, points: Mapping[str, Mapping[str, str]] = POINTS) -> MarkImport:
    """Return an import into the class."""
    return MarkImport(CLASS, LAB, marks, DIGESTS, ANSWERS, points)


def timed(marks: Marks, new: list[Mark]) -> list[Mark]:
    """Return new marks with the times at which they count."""
    return [one._replace(time=marks.next_time((one.student, one.criterion))) for one in new]


@pytest.mark.parametrize("case", CASES, ids=lambda case: case["about"])
def test_what_a_file_becomes(case: dict[str, Any], tmp_path: Path) -> None:
    """As the table says; once the marks are appended, the same file has no new ones."""
    folder, text = folder_of(tmp_path, GIVEN), case["file"]
    for key, points in POINTS.items():
        text = text.replace(f"{{{key}}}", exported_text(points))
    if "error" in case:
        with pytest.raises(InputError) as caught:
            timed(read(folder), importing(read(folder)).read(text.encode(), "marks.csv")[0])
        assert str(caught.value).splitlines() == case["error"].splitlines()
        return
    marks, same = importing(read(folder)).read(text.encode(), "marks.csv")
    said_of = [f"{one.student} {one.criterion} {said(one)} {one.submission}" for one in marks]
    assert (said_of, same) == (case["marks"], case.get("same", 0))
    append_marks(folder / "lee.csv", timed(read(folder), marks))
    after = {key: dict(points) for key, points in POINTS.items()}
    for one in marks:
        after[one.student] |= {
            one.criterion: one.value or after[one.student].get(one.criterion, "")
        }
    assert importing(read(folder), after).read(text.encode(), "marks.csv")[0] == []


VALUES = st.dictionaries(st.sampled_from(CRITERIA), st.sampled_from(("", "0", "0.25", "0.5")))


@given(st.dictionaries(st.sampled_from(("anna", "ben", "-x")), VALUES), st.data())
def test_only_changed_cells_of_an_export_are_marks(
    values: Mapping[str, Mapping[str, str]], data: st.DataObject
) -> None:
    """None without a change; else the changed ones, whatever a spreadsheet does to decimals; or they are refused."""
    points = {student: {**NONE, **row} for student, row in values.items()}
    has_other_points = data.draw(st.booleans())
    now = {
        student: {**row, "loads": "0.75"} if has_other_points else row
        for student, row in points.items()
    }
    cells = {(student, name): text for student, row in values.items() for name, text in row.items()}
    changed = {key: "0.4" for key in cells if data.draw(st.booleans())}
    rows = []
    for student, row in values.items():
        texts = [
            changed.get((student, name), row.get(name, "")).replace(
                ".", data.draw(st.sampled_from(",."))
            )
            for name in CRITERIA
        ]
        rows.append([student, *texts, exported_text(points[student]), "d0"])
    text = write_table(["id", *CRITERIA, "exported", "submission"], rows)
    if has_other_points and changed:
        with pytest.raises(InputError, match="has other points now than when they were exported"):
            importing(Marks({}, {}, {}, []), now).read(text.encode(), "grades.csv")
        return
    found, _ = importing(Marks({}, {}, {}, []), now).read(text.encode(), "grades.csv")
    assert {(one.student, one.criterion): one.value for one in found} == changed


def test_a_new_mark_counts_though_a_clock_was_ahead(tmp_path: Path) -> None:
    """Its time is later than that of the newest one."""
    folder = tmp_path / "marks"
    append_marks(
        folder / "kim.csv", [Mark("2999-12-31T23:59:59.999+00:00", "Kim", "anna", "essay", "1")]
    )
    rows = b"student,criterion,points\nanna,essay,2\n"
    append_marks(
        folder / "lee.csv", timed(read(folder), importing(read(folder)).read(rows, "marks.csv")[0])
    )
    assert said(read(folder).counting["anna", "essay"]) == "2"


def test_a_number_may_be_a_key_without_its_zeros(tmp_path: Path) -> None:
    """3 is refused where 0003 is a key, though it is an id of another student; 09 is an id as it is written."""
    marks = read(folder_of(tmp_path, {}))
    students = (Student("carol", canvas="3", sis="09"), Student("0003"), Student("9"))
    digests = {"carol": "d0a", "0003": "d0b", "9": "d0c"}
    into = MarkImport(students, LAB, marks, digests, {}, {})
    head = "student,criterion,points\n"
    with pytest.raises(InputError, match="'3' may be '0003', changed by a spreadsheet"):
        into.read(f"{head}3,grade,1\n".encode(), "marks.csv")
    [mark], _ = into.read(f"{head}09,grade,1\n".encode(), "marks.csv")
    assert mark.student == "carol"
