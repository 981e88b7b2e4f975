"""Who is meant by a name, whose grade is final, and who needs a look."""

from collections.abc import Iterator
from decimal import Decimal
from pathlib import Path

import pytest

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.marks import criterion_of, mark
from grader.classroom.gradebook.run_writer import RunWriter, save_student
from grader.classroom.gradebook.stored import Enrolment
from grader.classroom.students import ClassSubmission, Student
from grader.errors import InputError
from grader.grading.rubric import Rubric
from tests.classroom.gradebooks import came_out, graded_into, lab

LAB = lab()
PEOPLE = (
    Student("anna", "Anna Ek", "anna@example.org", "ae1", "S1", "101", "9001"),
    Student("ben", "Ben Oh", "ben@example.org", "bo2", "S2", "102", "9002"),
    Student("emil", "Ben Oh", "emil@example.org", "eo5", "S5", "105", "101"),  # his number in Moodle is hers in Canvas
    Student("S1", "Sven", login="s1"),  # his key is the number that the university gives her
)


@pytest.fixture
def book(tmp_path: Path) -> Iterator[Gradebook]:
    """A gradebook with a few people."""
    with Gradebook(tmp_path / "book.db", create=True) as opened:
        with opened.transaction():
            for person in PEOPLE:
                save_student(opened, person, None)
        yield opened


def test_people_are_known_by_all_that_names_one_of_them(book: Gradebook) -> None:
    """Key, login, address, numbers, name; a key goes before the rest."""
    for name in ("anna", "ae1", "anna@example.org", "9001", "Anna Ek"):
        assert Grades(book).find(name).student.key == "anna"
    assert Grades(book).find("S1").student.name == "Sven"


@pytest.mark.parametrize("name", ["Ben Oh", "101"])
def test_several_are_never_one(book: Gradebook, name: str) -> None:
    """Nobody is taken whom somebody else might be, even where the names are of two kinds."""
    keys = "'ben', 'emil'" if name == "Ben Oh" else "'anna', 'emil'"
    with pytest.raises(InputError, match=f"'{name}' is ambiguous: it may be {keys}; use one of these ids"):
        Grades(book).find(name)


@pytest.mark.parametrize(
    ("name", "guess"),
    [
        ("ana", "; did you mean 'anna'?"),
        ("Ana Ek", "; did you mean 'Anna Ek'?"),
        ("ANNA", "; did you mean 'anna'?"),
        ("", ""),
    ],
)
def test_nobody(book: Gradebook, name: str, guess: str) -> None:
    """The message guesses who was meant."""
    with pytest.raises(InputError) as caught:
        Grades(book).find(name)
    everyone = f"; `grader export csv --gradebook {book.path}` lists all students"
    assert str(caught.value) == f"there is no student {name!r} in the gradebook{guess or everyone}"


def looks(book: Gradebook) -> dict[str, str]:
    """Who needs a look, and why."""
    return {each.who: each.why for each in Grades(book).needing_attention(99).listed}


def put(book: Gradebook, key: str, name: str = "essay") -> None:
    """Give a point by hand."""
    standings = Grades(book)
    mark(book, standings.find(key), criterion_of(LAB, name), Decimal(1), "me", "")


def test_who_needs_a_look(tmp_path: Path) -> None:
    """Whoever has submitted nothing or nothing readable, or is a stranger, and where the grader failed."""
    with Gradebook(tmp_path / "book.db", create=True) as book:
        signs = {"anna": "ppp??", "ben": "p!p??", "fay": "ppppp"}
        graded_into(book, LAB, [came_out(LAB, key, each) for key, each in signs.items()])
        graded_into(book, LAB, [came_out(LAB, "cleo", "?????", reason="no zip")])
        with book.transaction():
            save_student(book, Student("dora"), Enrolment(1))
            save_student(book, Student("fay"), Enrolment(0))
        assert looks(book) == {
            "ben": "the grader failed on a criterion",
            "cleo": "it could not be graded: no zip",
            "dora": "nothing was submitted",
            "fay": "not on the roster",
        }
        short = Grades(book).needing_attention(1)
        assert ([each.who for each in short.listed], short.total) == (["ben"], 4)


@pytest.mark.parametrize(
    ("rubric", "digest", "is_older"),
    [
        (LAB, "a", False),
        (LAB, "b", True),  # another submission
        (lab(loads="1"), "a", False),  # the same submission, and the question is worth the same
        (lab(essay="3"), "a", True),
    ],
)
def test_a_mark_from_before(rubric: Rubric, digest: str, is_older: bool, tmp_path: Path) -> None:
    """A mark stays, and is listed where it was given on another submission or for other points."""
    with Gradebook(tmp_path / "book.db", create=True) as book:
        graded_into(book, LAB, [came_out(LAB, "anna", "ppp??")])
        put(book, "anna")
        assert looks(book) == {}
        graded_into(book, rubric, [came_out(rubric, "anna", "ppp?f", digest)])
        why = "1 manual mark is from before the submission or the points changed"
        assert looks(book) == ({"anna": why} if is_older else {})
        assert Grades(book).find("anna").marks == 1


def test_a_mark_on_what_could_not_be_opened_is_looked_at_again(tmp_path: Path) -> None:
    """Where there was nothing to tell one submission from another, a new result may be of another one."""
    with Gradebook(tmp_path / "book.db", create=True) as book:
        broken = came_out(LAB, "anna", "?????", reason="no zip")._replace(digest="")
        graded_into(book, LAB, [broken])
        put(book, "anna")
        graded_into(book, LAB, [broken])
        assert "from before" not in looks(book)["anna"]
        graded_into(book, LAB, [broken._replace(reason="no tar")])
        assert "from before" not in looks(book)["anna"]  # the same record: nothing new was found
        graded_into(book, LAB, [came_out(LAB, "anna", "?????", reason="no tar")])
        assert "from before" in looks(book)["anna"]


def test_who_was_left_behind_by_a_new_rubric(tmp_path: Path) -> None:
    """A grade by an earlier rubric still counts, and is listed."""
    newer = lab(loads="1")
    with Gradebook(tmp_path / "book.db", create=True) as book:
        graded_into(book, LAB, [came_out(LAB, key, "ppppp") for key in ("anna", "ben")])
        graded_into(book, newer, [came_out(newer, "anna", "ppppp")])
        assert looks(book) == {"ben": "graded with an earlier version of the rubric"}
        assert Grades(book).find("ben").score == LAB.points


def test_a_total_is_the_score_less_what_being_late_costs(tmp_path: Path) -> None:
    """The policy is that of the rubric that the submission was graded by; the score stays as it is."""
    late = lab("due = 2026-09-01T12:00:00Z\npercent_per_day = 10\n")
    with Gradebook(tmp_path / "book.db", create=True) as book:
        graded_into(book, late, [came_out(late, "anna", "pppff")], submitted="2026-09-02T13:00:00Z")
        found = Grades(book).find("anna")
        assert (found.score, found.late.days, found.late.points, found.total) == (
            Decimal(6),
            2,
            Decimal("-2.2"),
            Decimal("3.8"),
        )
        assert Grades(book).report(found).score == Decimal(6)


def test_names_that_are_no_text(tmp_path: Path) -> None:
    """What a folder in another encoding calls a student, and where the class is, is kept as far as it can be read."""
    graded = came_out(LAB, "x", "ppppp")._replace(verdict="unreadable", reason="no \udcff")
    with Gradebook(tmp_path / "book.db", create=True) as book:
        writer = RunWriter(book, "class\udcff", "moodle", LAB)
        student = Student("x", "J\udcfcrg \u00d8")
        with book.transaction():
            result = writer.add_result(save_student(book, student, None), graded)
            writer.add_submission(save_student(book, student, None), result, ClassSubmission(student, ("a\udcff",)), "")
        known = next(each for each in book.stored_submissions() if each.key == "x")
        assert known is not None
        assert known.is_same(ClassSubmission(student, ("a\udcff",)), None)
        found = Grades(book).find("x")
    assert (found.student.name, found.reason) == ("J\\udcfcrg \u00d8", "no \\udcff")
    assert (found.files.root, found.files.paths) == ("class\\udcff", ("a\udcff",))
