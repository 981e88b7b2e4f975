"""The zip of reports: Moodle and Canvas give each to the right student, or it is not in the zip."""

import io
import tarfile
import tomllib
import zipfile
from pathlib import Path
from typing import Any

import pytest

from grader.classroom.lms.feedback import canvas_names, moodle_names, write_feedback
from grader.classroom.roster.roster import Student

pytestmark = pytest.mark.slow

CASES = tomllib.loads(Path(__file__).with_name("canvas_names.toml").read_text(encoding="utf-8"))[
    "case"
]


@pytest.mark.parametrize("case", CASES, ids=lambda case: str(case["about"]))
def test_names_for_canvas(case: dict[str, Any]) -> None:
    """A report gets the name of a submitted file that Canvas recognises and that the report can be opened under."""
    members = [Student(f"s{user}", canvas=user) for user in case.get("users", [""])]
    found = canvas_names(
        [(member, tuple(case["files"])) for member in members],
        case.get("report", "lab-feedback.md"),
    )
    expected = dict.fromkeys((member.key for member in members), case.get("name", case.get("why")))
    assert found == ((expected, {}) if "name" in case else ({}, expected))


def test_a_file_name_that_is_not_utf_8() -> None:
    """Canvas gave no such name, and a zip cannot have it."""
    names, without = canvas_names(
        [(Student("bob", canvas="102"), ("class/bob_102_556_ro\udcffbot.md",))], "lab.md"
    )
    assert (names, [*without]) == ({}, ["bob"])


def test_participants() -> None:
    """One of two students, or none at all, is no number."""
    students = [
        Student("a", "Ann", moodle="1"),
        Student("b", moodle="2"),
        Student("c", moodle="2"),
        Student("d"),
    ]
    names, without = moodle_names(students, "r.html")
    assert names == {"a": "Participant_1_assignfeedback_file_/r.html"}
    assert without["b"] == without["c"] == "another student has participant number 2, too"
    assert without["d"] == "has no participant number, and no row of a grading worksheet (--into)"


def test_the_zip_depends_on_the_reports_only() -> None:
    """A report is in an archive under the name of one; the members of a group with different reports get none."""
    names = {
        "a": "a_1_2_lab.zip",
        "b": "b_3_4_lab.TGZ",
        "c": "c_5_6_x.md",
        "d": "d_7_8_x.md",
        "e": "d_7_8_x.md",
    }
    reports = {"a": b"A", "b": b"B", "c": b"C", "d": b"D", "e": b"E"}
    data, without = write_feedback(reports, names, "lab-feedback.md")
    assert (data, without) == write_feedback(
        dict(reversed(reports.items())), names, "lab-feedback.md"
    )
    assert without == dict.fromkeys(
        "de", "the members of the group have different reports, and Canvas gives one to all of them"
    )
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    assert files.keys() == {names["a"], names["b"], names["c"]}
    assert files[names["c"]] == b"C"
    with zipfile.ZipFile(io.BytesIO(files[names["a"]])) as inner:
        assert inner.read("lab-feedback.md") == b"A"
    with tarfile.open(fileobj=io.BytesIO(files[names["b"]])) as tar:
        assert tar.getnames() == ["lab-feedback.md"]
    assert write_feedback({"d": b"D", "e": b"D"}, names, "r.md")[1] == {}
