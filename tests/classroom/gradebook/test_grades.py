"""Which student a name means, whose grade is final, and who needs attention."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from grader.classroom.gradebook.attention import attention
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.run_writer import RunWriter, save_student
from grader.classroom.gradebook.stored import Enrolment
from grader.classroom.students import ClassSubmission, Student
from tests.classroom.gradebooks import graded_as, lab, record_run

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
