"""A roster with other ids: students keep their rows, marks and results, also those who have submitted nothing, or in another section."""

import shutil
from pathlib import Path

import pytest

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from tests.classroom.gradebooks import grader, lab_text, write_submission

FIRST = "id,name,canvas id\n1,Ann Ash,1\n2,Bo Birch,2\n3,Cy Cedar,3\n4,Di Fir,4\n5,Ed Elm,5\n"
SECOND = "id,name,canvas id\nann.ash,Ann Ash,1\nbo.birch,Bo Birch,2\ncy,Cy Cedar,3\ndi,Di Fir,4\ned,Ed Elm,5\n"


@pytest.fixture
def top(tmp_path: Path) -> Path:
    """Return a folder with the Canvas downloads of two sections, graded with the first roster."""
    (tmp_path / "small.toml").write_text(lab_text())
    (tmp_path / "first.csv").write_text(FIRST)
    (tmp_path / "second.csv").write_text(SECOND)
    for section, name, number in (("a", "ashann", 1), ("a", "birchbo", 2), ("b", "cedarcy", 3), ("b", "firdi", 4)):
        write_submission(tmp_path / "one")
        (tmp_path / section).mkdir(exist_ok=True)
        shutil.make_archive(str(tmp_path / section / f"{name}_{number}_1{number}_lab"), "zip", tmp_path / "one")
        shutil.rmtree(tmp_path / "one")
    assert run(tmp_path, "a", "--rubric", tmp_path / "small.toml", "--roster", tmp_path / "first.csv")
    assert run(tmp_path, "b")
    for who, *what in (("3", "essay", "4"), ("5", "total", "0"), ("4", "total", "--excused")):
        assert grader("mark", who, *what, "--gradebook", tmp_path / "book.db").returncode == 0
    return tmp_path


def run(top: Path, section: str, *more: object) -> str:
    """Grade a section into the gradebook; return what it prints."""
    done = grader("batch", top / section, "--gradebook", top / "book.db", *more)
    assert done.returncode == 0, done
    return done.stdout + done.stderr


def rows(top: Path) -> dict[str, tuple[str, bool, int, bool]]:
    """Return for each student the final mark, whether excused, the number of marks, and whether there is a submission."""
    with Gradebook(top / "book.db") as book:
        return {
            grade.student.key: (str(grade.final), grade.is_excused, grade.marks, grade.result is not None)
            for grade in Grades(book).all()
        }


EXPECTED = {
    "ann.ash": ("None", False, 0, True),
    "bo.birch": ("None", False, 0, True),
    "cy": ("None", False, 1, True),
    "di": ("None", True, 0, True),
    "ed": ("0", False, 0, False),
}


def test_students_of_another_section_and_without_a_submission(top: Path) -> None:
    """All get the ids of the new roster at once, with all marks, and the other section's run finds them."""
    printed = run(top, "a", "--roster", top / "second.csv")
    assert "5 is ed now, with all manual marks" in printed
    assert "nothing was submitted" not in printed
    assert rows(top) == EXPECTED
    assert "ambiguous" not in run(top, "b")
    assert rows(top) == EXPECTED


def test_two_students_who_could_be_one_stay_apart(top: Path) -> None:
    """A number decides, not a name: with other numbers they are other students."""
    (top / "other.csv").write_text(SECOND.replace("Elm,5", "Elm,55").replace("Cedar,3", "Cedar,33"))
    run(top, "a", "--roster", top / "other.csv")
    found = rows(top)
    assert found["5"] == EXPECTED["ed"]
    assert found["3"] == EXPECTED["cy"]
    assert found["ed"] == found["cy"] == ("None", False, 0, False)


def test_the_rubric_and_the_parts_of_the_last_run(top: Path) -> None:
    """Without --rubric a rerun uses the last rubric, also if its file has gone; fewer parts than before are named."""
    assert f"rubric of the last run: {top / 'small.toml'}" in run(top, "a")
    (top / "small.toml").unlink()
    assert "0 graded, 2 unchanged" in run(top, "a")
    assert "the last run graded" not in run(top, "a", "--part", "robot")
    assert "the last run graded robot only, and this one grades all parts: pass --part robot" in run(top, "a")
