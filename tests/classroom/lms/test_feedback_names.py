"""The names of feedback files: Moodle and Canvas give each to the right student, or there is none."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.lms.feedback_names import canvas_target, canvas_upload_name, moodle_folder
from grader.classroom.students import Student

ANYBODY = (Student("x"),)
USER_101 = (Student("x", canvas="101"),)


@given(st.text(max_size=90))
def test_moodle_reads_the_participant_in_any_folder(name: str) -> None:
    """After the first underscore, whatever the name; it is one folder, is not hidden, and is not too long."""
    folder = moodle_folder(Student("key", name), "77")
    assert folder.split("_", 4)[1:] == ["77", "assignfeedback", "file"]
    assert not set(folder) & set("/\\:*?\"<>|&`'\n") - {"'"}
    assert folder.isprintable()
    assert not folder.startswith((".", "~", " ", "_"))
    assert len(folder) < 100


@pytest.mark.parametrize(
    ("name", "target"),
    [
        ("doejane_101_2001_lab6.zip", ("101", "2001")),
        ("doejane_LATE_101_2001_lab6.zip", ("101", "2001")),
        ("doejane_101_2001_7_8.zip", ("101", "2001")),
        ("anon_aB3dE_2001_lab6.zip", ("aB3dE", "2001")),
        ("LATE_anon_aB3dE_2001_lab6.zip", ("aB3dE", "2001")),
        ("mallory_77_101_2001_lab6.zip", ("77", "101")),
        ("doejane_101_2001_my_link.zip", None),
        ("doejane_101_text.html", None),
        ("._doejane_101_2001_lab6.zip", None),
        ("lab6.zip", None),
        ("LATE", None),
        ("LATE_LATE", None),
    ],
)
def test_whose_file_canvas_takes_it_for(name: str, target: tuple[str, str] | None) -> None:
    """The first two numbers, without LATE; names that Canvas ignores have none."""
    assert canvas_target(name) == target


@pytest.mark.parametrize(
    ("names", "members", "ending", "chosen"),
    [
        (["a_101_2001_lab6.zip"], ANYBODY, ".md", "a_101_2001_lab6.zip"),
        (["a_101_2001_lab6.zip", "a_101_2002_answers.md"], ANYBODY, ".md", "a_101_2002_answers.md"),
        (["a_101_2001_lab6.urdf", "a_101_2002_lab6.zip"], ANYBODY, ".md", "a_101_2002_lab6.zip"),
        (["a_101_2001_lab6.urdf", "a_101_2002_photo.png"], ANYBODY, ".md", "a_101_2001_lab6.urdf"),
        (["a_101_2001_lab6.tar.gz", "a_101_2002_photo.png"], ANYBODY, ".md", "a_101_2001_lab6.tar.gz"),
        (["a_101_2001_LAB6.ZIP"], ANYBODY, ".html", "a_101_2001_LAB6.ZIP"),
        (["mallory_77_101_2001_lab6.zip"], USER_101, ".md", ""),  # Canvas would read 77
        (["mallory_77_101_2001_lab6.zip"], ANYBODY, ".md", ""),
        (["a_102_2001_lab6.zip"], USER_101, ".md", ""),
        (["a_101_2001_lab6.zip"], (Student("y", canvas="102"), *USER_101), ".md", "a_101_2001_lab6.zip"),
    ],
)
def test_the_name_for_canvas(names: list[str], members: tuple[Student, ...], ending: str, chosen: str) -> None:
    """A file of the student's that Canvas recognises and that a report can be opened under."""
    name, why = canvas_upload_name(names, members, ending)
    assert name == chosen
    assert bool(why) != bool(name)


@pytest.mark.parametrize(
    ("names", "ending", "why"),
    [
        (["a_101_2001_p.pdf"], ".md", "Canvas would show the report as 'a_101_2001_p.pdf', which could not be opened"),
        (
            ["a_101_2001_r.urdf"],
            ".html",
            "Canvas would show the report as 'a_101_2001_r.urdf', which could not be opened; Markdown could be",
        ),
        (["lab6.zip"], ".md", "Canvas would find another student, or none, by the name 'lab6.zip'"),
        ([], ".md", "submitted no file in Canvas"),
    ],
)
def test_why_there_is_no_name(names: list[str], ending: str, why: str) -> None:
    """The reason says what Canvas would do."""
    assert canvas_upload_name(names, ANYBODY, ending) == ("", why)
