"""There and back with a class of 120: what Canvas and Moodle import are the class's grades, and nothing else changes."""

from decimal import Decimal

import pytest

from grader.classroom.lms.feedback import canvas_names, moodle_names, write_feedback
from grader.classroom.lms.fill import Filled, FillOptions, fill
from grader.classroom.lms.forms import FORMS
from tests.classroom.lms import importers
from tests.classroom.lms.lms_class import CELLS, CLASS, STUDENTS, canvas_file, moodle_file

pytestmark = pytest.mark.slow

KEPT = "Please come to my office."  # a comment that a person wrote in Moodle
WITHOUT_EXCUSES = {key: cell for key, cell in CELLS.items() if cell}
WITH_EXCUSES = {
    one.student.key: "EX" if one.is_excused else CELLS[one.student.key] for one in CLASS
}
OPTIONS = FillOptions(Decimal(11), ("A small lab", "small"))


def old_grades() -> dict[str, str]:
    """Return what the LMS has already: nothing, the same grade, or another one."""
    return {one.key: ("", "", CELLS[one.key], "1.00")[n % 4] for n, one in enumerate(STUDENTS)}


def fill_lms(lms: str, data: bytes, options: FillOptions = OPTIONS) -> Filled:
    return fill(data, CLASS, FORMS[lms], options)


def test_canvas_imports_the_grades() -> None:
    """Every grade is there afterwards, every other cell is as it was, and the file is otherwise unchanged."""
    before, grades = old_grades(), {key: cell for key, cell in WITH_EXCUSES.items() if cell}
    filled = fill_lms("canvas", canvas_file(before))
    assert filled.data == canvas_file(grades)  # byte for byte
    assert filled.is_complete
    state = {one.canvas: {"A small lab": before[one.key], "Prelab": "9.00"} for one in STUDENTS}
    after = importers.canvas_import(filled.data, state)
    for one in STUDENTS:
        found = after[one.canvas]
        assert (found["A small lab"], found["Prelab"]) == (
            grades.get(one.key, before[one.key]),
            "9.00",
        )


def test_moodle_imports_grades_and_comments() -> None:
    """A comment of a person stays, and a student without a grade keeps everything."""
    before, kept = old_grades(), {one.key: KEPT for one in STUDENTS[::9]}
    filled = fill_lms("moodle", moodle_file(before, kept))
    comments = {one.student.key: kept.get(one.student.key, one.comment) for one in CLASS}
    assert filled.data == moodle_file(WITHOUT_EXCUSES, comments)
    state = {
        one.moodle: {"Lab": before[one.key], "comment": kept.get(one.key, "")} for one in STUDENTS
    }
    after = importers.moodle_import(filled.data, state)
    for one in STUDENTS:
        has_grade = one.key in WITHOUT_EXCUSES
        assert after[one.moodle]["Lab"] == WITHOUT_EXCUSES.get(one.key, before[one.key])
        assert after[one.moodle]["comment"] == (comments if has_grade else kept).get(one.key, "")


def test_only_resets_no_other_assignment() -> None:
    """With --only, what was graded in Canvas after the export stays."""
    data = canvas_file(dict.fromkeys(CELLS, ""))
    filled = fill_lms("canvas", data, OPTIONS._replace(only=True))
    assert filled.data == canvas_file(
        {key: cell for key, cell in WITH_EXCUSES.items() if cell}, only=True
    )
    state = {one.canvas: {"A small lab": "", "Prelab": "10.00"} for one in STUDENTS}
    assert all(
        grades["Prelab"] == "10.00"
        for grades in importers.canvas_import(filled.data, state).values()
    )


def test_moodle_gives_each_student_the_report() -> None:
    """By the own participant number, or by that of the worksheet."""
    reports = {one.key: one.key.encode() for one in STUDENTS}
    numbers = {one.moodle: one.key for one in STUDENTS}
    names, without = moodle_names(STUDENTS, "lab.md")
    data, _ = write_feedback(reports, names, "lab.md")
    assert not without
    assert importers.moodle_feedback(data, numbers) == {
        key: {"lab.md": report} for key, report in reports.items()
    }
    some = fill_lms("moodle", moodle_file(dict.fromkeys(list(CELLS)[:60], ""), {})).numbers
    found = [one._replace(moodle=some.get(one.key, "")) for one in STUDENTS]
    names, without = moodle_names(found, "lab.md")
    assert (list(names), list(without)) == (list(CELLS)[:60], list(CELLS)[60:])
    assert names == {
        one.key: names[one.key] for one in STUDENTS if f"_{one.moodle}_" in names.get(one.key, "")
    }


def test_canvas_gives_each_student_the_report() -> None:
    """By the name of the submitted file; the members of a group share one, unless their reports differ."""
    leaders = {n: n - n % 2 if 40 <= n < 60 else n for n in range(len(STUDENTS))}
    files = {
        n: f"ash_{'LATE_' if n % 7 == 0 else ''}{1000 + n}_{90_000 + n}_lab.zip" for n in leaders
    }
    names, without = canvas_names(
        [(STUDENTS[n], (files[leader],)) for n, leader in leaders.items()], "lab.md"
    )
    reports = {
        STUDENTS[n].key: f"report {leader + (n == 41)}".encode() for n, leader in leaders.items()
    }
    data, apart = write_feedback(reports, names, "lab.md")
    assert (without, list(apart)) == ({}, ["s040", "s041"])
    attachments = {(str(1000 + n), str(90_000 + n)): "lab.zip" for n in leaders}
    groups = {str(1000 + n): {str(1000 + n), str(1001 + n)} for n in range(40, 60, 2)}
    found = importers.canvas_comments(data, attachments, groups)
    assert found == {one.canvas: reports[one.key] for one in STUDENTS if one.key not in apart}
