"""Which student a name means, whose grade is final, and who needs attention."""

from collections.abc import Iterator
from decimal import Decimal
from pathlib import Path

import pytest

from grader.classroom.gradebook.attention import attention
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.marks import Entry, add_mark
from grader.classroom.gradebook.run_writer import RunWriter, save_student
from grader.classroom.gradebook.stored import Enrolment
from grader.classroom.students import ClassSubmission, Student
from grader.classroom.typed_names import criterion_of
from grader.grading.rubric import Rubric, read_rubric
from tests.classroom.gradebooks import graded_as, lab, lab_text, mark, record_run

LAB = lab()
PEOPLE = (
    Student("anna", "Anna Ek", "anna@example.org", "ae1", "S1", "101", "9001"),
    Student("ben", "Ben Oh", "ben@example.org", "bo2", "S2", "102", "9002"),
    Student("emil", "Ben Oh", "emil@example.org", "eo5", "S5", "105", "101"),  # his number in Moodle is hers in Canvas
    Student("S1", "Sven", login="s1"),  # his key is the number that the university gives her
)


@pytest.fixture
def book(tmp_path: Path) -> Iterator[Gradebook]:
    """Yield a gradebook with a few students."""
    with Gradebook(tmp_path / "book.db", create=True) as opened:
        with opened.transaction():
            for person in PEOPLE:
                save_student(opened, person, None)
        yield opened


def notices(book: Gradebook) -> dict[str, str]:
    """Return who needs attention, and why."""
    found = {item.key: "" for group in attention(Grades(book)).groups for item in group.items}
    return {key: Grades(book).find(key).why_attention for key in found}


def put(book: Gradebook, key: str, name: str = "essay") -> None:
    """Add a manual mark of one point."""
    standings = Grades(book)
    mark(book, standings.find(key), criterion_of(LAB, name), Decimal(1), "me", "")


def test_who_needs_attention(tmp_path: Path) -> None:
    """Students without a submission, with an unreadable one, not on the roster, or with an error of the grader."""
    with Gradebook(tmp_path / "book.db", create=True) as book:
        signs = {"anna": "ppp??", "ben": "p!p??", "fay": "ppppp"}
        record_run(book, LAB, [graded_as(LAB, key, row) for key, row in signs.items()])
        record_run(book, LAB, [graded_as(LAB, "cleo", "?????", reason="no zip")])
        with book.transaction():
            save_student(book, Student("dora"), Enrolment(1))
            save_student(book, Student("fay"), Enrolment(0))
        assert notices(book) == {
            "ben": "the grader failed: on 1 criterion",
            "cleo": "could not be graded: no zip",
            "dora": "nothing was submitted",
            "fay": "not on the roster",
        }
        found = attention(Grades(book))
        assert [(group.reason, [item.name or item.key for item in group.items]) for group in found.groups] == [
            ("the grader failed", ["ben"]),
            ("could not be graded", ["cleo"]),
            ("nothing was submitted", ["dora"]),
            ("not on the roster", ["fay"]),
        ]
        assert found.total == 4


@pytest.mark.parametrize(
    ("rubric", "digest", "why"),
    [
        (LAB, "a", ""),
        (LAB, "b", "marked before the submission changed: essay"),
        (lab(loads="1"), "a", ""),  # the same submission, and the question is worth the same
        (lab(essay="3"), "a", "marked before the points of the criterion changed: essay"),
        (lab(essay="3"), "b", "marked before the submission changed: essay"),
        (
            lab(essay="0.5"),
            "a",
            (
                "a manual mark exceeds the maximum of its criterion: essay; "
                "marked before the points of the criterion changed: essay"
            ),
        ),
    ],
)
def test_an_older_mark(rubric: Rubric, digest: str, why: str, tmp_path: Path) -> None:
    """A mark is kept; if it was given for another submission or other points, its criterion is named."""
    with Gradebook(tmp_path / "book.db", create=True) as book:
        record_run(book, LAB, [graded_as(LAB, "anna", "ppp??")])
        put(book, "anna")
        assert notices(book) == {}
        record_run(book, rubric, [graded_as(rubric, "anna", "ppp?f", digest)])
        assert notices(book) == ({"anna": why} if why else {})
        assert Grades(book).find("anna").marks == 1


def test_a_mark_of_a_criterion_that_the_rubric_no_longer_has(tmp_path: Path) -> None:
    """It is named, unless the submission is not graded with the new rubric yet, or has a final mark."""
    other = read_rubric(lab_text().replace('id = "essay"', 'id = "text"').encode(), Path("small.toml"))
    why = "a manual mark is of a criterion that the rubric no longer has: essay"
    with Gradebook(tmp_path / "book.db", create=True) as book:
        record_run(book, LAB, [graded_as(LAB, key, "ppp??") for key in ("anna", "ben", "emil", "fay")])
        for key in ("anna", "ben", "emil"):
            put(book, key)
        put(book, "anna", "picture")
        add_mark(book, Grades(book).find("emil"), "total", Entry("points", Decimal(3)), "")
        record_run(book, other, [graded_as(other, key, "ppp??") for key in ("anna", "emil", "fay")])
        assert notices(book) == {"anna": why, "ben": "graded with an earlier version of the rubric"}
        assert attention(Grades(book)).total == 2
        record_run(book, LAB, [graded_as(LAB, key, "ppp??") for key in ("anna", "ben", "emil", "fay")])
        assert notices(book) == {}


def test_several_older_marks_are_in_the_order_of_the_rubric(tmp_path: Path) -> None:
    """Whatever the order in which they were given."""
    with Gradebook(tmp_path / "book.db", create=True) as book:
        record_run(book, LAB, [graded_as(LAB, "anna", "ppp??")])
        for name in ("picture", "essay", "loads"):
            put(book, "anna", name)
        record_run(book, LAB, [graded_as(LAB, "anna", "ppp??", "b")])
        assert notices(book) == {"anna": "marked before the submission changed: loads, essay, picture"}


def test_a_mark_on_an_unreadable_submission_is_listed(tmp_path: Path) -> None:
    """Unreadable submissions have no digest, so a new result may be about another one."""
    with Gradebook(tmp_path / "book.db", create=True) as book:
        broken = graded_as(LAB, "anna", "?????", reason="no zip")._replace(digest="")
        record_run(book, LAB, [broken])
        put(book, "anna")
        record_run(book, LAB, [broken])
        assert "marked before" not in notices(book)["anna"]
        record_run(book, LAB, [broken._replace(reason="no tar")])
        assert "marked before" not in notices(book)["anna"]  # the same record: nothing new was found
        record_run(book, LAB, [graded_as(LAB, "anna", "?????", reason="no tar")])
        assert "marked before" in notices(book)["anna"]


@pytest.mark.parametrize("entry", [Entry("points", Decimal(3)), Entry("excused")])
def test_a_final_mark_on_an_unreadable_submission_is_listed(entry: Entry, tmp_path: Path) -> None:
    """Two results without a digest may be about different submissions."""
    with Gradebook(tmp_path / "book.db", create=True) as book:
        for signs in ("?????", "?ff??"):
            record_run(book, LAB, [graded_as(LAB, "anna", signs, reason="no zip")._replace(digest="")])
            if signs == "?????":
                add_mark(book, Grades(book).find("anna"), "total", entry, "")
                assert notices(book) == {}
        assert notices(book) == {"anna": "final mark or excuse given before the submission changed"}


def test_undecodable_names(tmp_path: Path) -> None:
    """Names of students and folders in another encoding are kept as far as they can be read."""
    graded = graded_as(LAB, "x", "ppppp")._replace(verdict="unreadable", reason="no \udcff")
    with Gradebook(tmp_path / "book.db", create=True) as book:
        writer = RunWriter(book, "class\udcff", "moodle", LAB)
        student = Student("x", "J\udcfcrg \u00d8")
        with book.transaction():
            result = writer.add_result(save_student(book, student, None), graded)
            writer.add_submission(save_student(book, student, None), result, ClassSubmission(student, ("a\udcff",)), "")
        known = next(submission for submission in book.stored_submissions() if submission.key == "x")
        assert known is not None
        assert known.is_same(ClassSubmission(student, ("a\udcff",)), None)
        found = Grades(book).find("x")
    assert (found.student.name, found.reason) == ("J\\udcfcrg \u00d8", "no \\udcff")
    assert (found.files.root, found.files.paths) == ("class\\udcff", ("a\udcff",))
