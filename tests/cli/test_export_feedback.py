"""grader export: feedback as a zip for an LMS, what it refuses, who graded, and the columns for Excel."""

import os
import shutil
import zipfile
from decimal import Decimal
from pathlib import Path
from typing import Any

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.marks import Entry, add_mark
from grader.classroom.gradebook.remarks import remarks_of
from grader.classroom.lms.feedback import FeedbackItem, feedback_html, is_own_feedback
from grader.grading.rubric import read_rubric
from tests.classroom.gradebooks import batch, graded_as, grader, lab_text, make_class, record_run, urdf

OWN = (
    "<p>Graded automatically: 58.5 of 100 points.</p><ul><li>The base: 2 of 4. it is 0.1 m too low</li></ul>"
    "<!-- grader 81396dd30bb0 -->"
)


def export(top: Path, *arguments: object) -> Any:
    """Export from the class's gradebook."""
    return grader("export", *arguments, "--gradebook", top / "book.db")


def mark(top: Path, key: str, criterion: str, entry: Entry, by: str = "") -> None:
    """Add an entry of a person."""
    with Gradebook(top / "book.db") as book:
        add_mark(book, Grades(book).find(key), criterion, entry, by)


def points(value: str, comment: str = "") -> Entry:
    """Return points with a comment."""
    return Entry("points", Decimal(value), comment)


# --- Who graded, and what persons said --------------------------------------------------------------------------------


def test_who_graded(top: Path) -> None:
    """Automatic, manual, or both; with the names that were given; a final mark is that of its giver alone."""

    def graded_by(key: str) -> str:
        with Gradebook(top / "book.db") as book:
            grades = Grades(book)
            return remarks_of(grades, grades.find(key)).graders.words

    assert graded_by("emil") == "automatically"
    mark(top, "emil", "box", Entry("comment", None, "see the lab"), "Kim")
    assert graded_by("emil") == "automatically"  # no points
    mark(top, "emil", "essay", points("2"))
    assert graded_by("emil") == "automatically, and manually"
    mark(top, "emil", "picture", points("1"), "Lee")
    mark(top, "emil", "box", points("1"), "Kim")
    assert graded_by("emil") == "automatically, and manually by Kim and Lee"
    mark(top, "emil", "box", Entry("withdrawn"), "Ann")
    assert graded_by("emil") == "automatically, and manually by Lee"
    mark(top, "emil", "total", points("9"), "Ann")
    assert graded_by("emil") == "manually by Ann"
    mark(top, "dora", "total", points("0"))
    assert graded_by("dora") == "manually"


def test_feedback_says_who_graded() -> None:
    """The grader's own comments are recognised; other words are a person's."""
    assert feedback_html(Decimal("58.5"), Decimal(100), [FeedbackItem("The base", Decimal(2), Decimal(4), "it is 0.1 m too low")]) == OWN  # fmt: skip
    for words in ("automatically", "manually", "automatically, and manually by =Kim & <Lee>;=1"):
        text = feedback_html(Decimal(1), Decimal(2), [FeedbackItem("Comment", None, Decimal(0), "fine")], words)
        assert is_own_feedback(text)
        assert "<li>Comment: fine</li>" in text
        assert not is_own_feedback(text.replace("fine", "not fine"))
    assert is_own_feedback(OWN)
    assert not is_own_feedback(OWN.replace("automatically", "badly"))


def test_extra_credit_is_not_part_of_the_maximum_in_the_lms(tmp_path: Path) -> None:
    """A bonus of 2 above 11 points: the maximum in the LMS is 11, and points above it are listed."""
    text = lab_text(extra="2").replace('id = "extra"', 'id = "extra"\nbonus = true')
    rubric = read_rubric(text.encode(), Path("small.toml"))
    with Gradebook(tmp_path / "book.db", create=True) as book:
        record_run(book, rubric, [graded_as(rubric, "anna", "pppppp")])
    (tmp_path / "d2l.csv").write_text(
        "Username,A small lab Points Grade <Numeric MaxPoints:11>,End-of-Line Indicator\n#anna,,#\n"
    )
    done = export(tmp_path, "brightspace", "--into", tmp_path / "d2l.csv")
    assert done.stdout.endswith("#anna,13.00,#\n")
    assert "row 2, anna: 13 points: Brightspace reduces them to the maximum" in done.stderr
    head = "Identifier,Full name,Username,Grade,Maximum grade,Last modified (grade),Feedback comments"
    (tmp_path / "moodle.csv").write_text(f"{head}\nParticipant 1,Anna,anna,,11.00,-,\n")
    why = "13.00 points are above the maximum of 11: raise the maximum there, or give a final mark"
    for more, code in (((), 0), (("--strict",), 1)):
        done = export(tmp_path, "moodle", "--into", tmp_path / "moodle.csv", *more)
        assert done.returncode == code
        assert f"the LMS would refuse the grade: row 2, Anna: {why}\n" in done.stderr


# --- The zip ----------------------------------------------------------------------------------------------------------


def test_a_file_name_that_is_not_utf_8(tmp_path: Path) -> None:
    """Its student gets no report, and the others get theirs."""
    make_class(tmp_path)
    shutil.rmtree(tmp_path / "class")
    (tmp_path / "class").mkdir()
    for name in (b"anna_101_555_robot.urdf", b"bob_102_556_ro\xffbot.urdf"):
        Path(os.fsdecode(os.path.join(os.fsencode(tmp_path), b"class", name))).write_text(urdf())
    assert batch(tmp_path).returncode == 0
    done = export(tmp_path, "canvas", "--feedback", tmp_path / "feedback.zip")
    assert done.returncode == 0, done.stderr
    why = "Canvas would find another student, or none, by the name 'bob_102_556_ro\\udcffbot.urdf'"
    assert f"no feedback for Ben Oh (ben): {why}\n" in done.stderr
    with zipfile.ZipFile(tmp_path / "feedback.zip") as archive:
        assert archive.namelist() == ["anna_101_555_robot.urdf"]
