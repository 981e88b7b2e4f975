"""The items of a review: what is one item, in which order they come, and that one mark serves all students of one."""

from collections.abc import Iterator
from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.manual_queue import ReviewScope
from grader.classroom.gradebook.marks import NewerMarkError
from grader.classroom.review.items import similar_order
from grader.classroom.review.queue import ReviewFilter
from grader.classroom.review.session import ReviewSession
from grader.classroom.typed_names import criterion_of
from grader.errors import InputError
from tests.checks.submissions import jpeg
from tests.classroom.gradebooks import PNG, batch, grader, lab, lab_text, mark, urdf, write_submission
from tests.documents.files import docx, pdf

ANSWERS = {
    "ash": "The roots.",
    "birch": "No.",
    "cedar": "The roots.  \n\n",
    "dogwood": "",
    "elm": "The long roots.",
    "fir": "",
}


@pytest.fixture(scope="module")
def graded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a class in two sections: two equal answers, two students without one, and gum and holly as a team."""
    top = tmp_path_factory.mktemp("items")
    for key, answer in ANSWERS.items():
        write_submission(top / "class" / key, answer=answer or "x")
        if not answer:
            (top / "class" / key / "answers.md").unlink()
            (top / "class" / key / "screen.png").unlink()
    write_submission(top / "class" / "team", answer="Ours [picture].")
    rows = [f"{key},{key.title()},{'AB'[number % 2]},{key}" for number, key in enumerate(ANSWERS)]
    rows += ["gum,Gum,A,team", "holly,Holly,B,team"]
    (top / "roster.csv").write_text("id,name,section,team\n" + "\n".join(rows) + "\n")
    (top / "small.toml").write_text(lab_text())
    done = batch(top)
    assert done.returncode == 0, done.stderr
    return top / "book.db"


@pytest.fixture
def book(graded: Path, tmp_path: Path) -> Iterator[Gradebook]:
    """Yield a copy of the gradebook."""
    (tmp_path / "book.db").write_bytes(graded.read_bytes())
    with Gradebook(tmp_path / "book.db") as book:
        yield book


def items(session: ReviewSession) -> list[str]:
    """Return the criterion and the students of each item that is listed."""
    listed = [session.queue.items[position] for position in session.queue.listed()]
    return [f"{item.criterion}: {' '.join(key for key, _ in item.students)}" for item in listed]


def points(book: Gradebook) -> list[tuple[Any, ...]]:
    """Return all marks: key, criterion, points."""
    query = "SELECT key, criterion, points / 10000.0 FROM mark JOIN student ON student = student.id ORDER BY mark.id"
    return list(book.rows(query))


def test_equal_answers_and_a_team_are_one_item(book: Gradebook) -> None:
    """Similar answers are neighbours; those without an answer come last, in one item for each criterion."""
    assert items(ReviewSession(Grades(book))) == [
        "essay: ash cedar", "essay: elm", "essay: birch", "essay: gum holly",
        "picture: ash", "picture: birch", "picture: cedar", "picture: elm", "picture: gum holly",
        "essay: dogwood fir", "picture: dogwood fir",
    ]  # fmt: skip


def test_one_mark_for_all_and_undo_for_all(book: Gradebook) -> None:
    """Each student gets the mark and each of them loses it again."""
    session = ReviewSession(Grades(book))
    session.mark(Decimal(3), "good")
    assert points(book) == [("ash", "essay", 3), ("cedar", "essay", 3)]
    session.go(0)
    session.mark(Decimal(3), "good")
    assert (len(points(book)), session.marked) == (2, 2)
    session.undo()
    assert points(book)[2:] == [("ash", "essay", None), ("cedar", "essay", None)]
    assert (session.marked, session.own.can_undo) == (0, False)


def test_a_mark_of_somebody_else_marks_nobody(book: Gradebook) -> None:
    """If one student has a newer mark, no student is marked; that one then leaves the item, and the others stay."""
    session = ReviewSession(Grades(book))
    other = ReviewSession(Grades(book))
    other.split()
    other.mark(Decimal(1), "")
    with pytest.raises(NewerMarkError):
        session.mark(Decimal(3), "")
    assert points(book) == [("ash", "essay", 1)]
    session.stay()
    assert session.item is not None
    assert [one.grade.student.key for one in session.item.members] == ["cedar"]
    session.mark(Decimal(2), "")
    assert points(book)[1:] == [("cedar", "essay", 2)]


def test_undo_keeps_a_newer_mark_of_one_student(book: Gradebook) -> None:
    """The others lose theirs."""
    session = ReviewSession(Grades(book))
    session.mark(Decimal(3), "")
    done = grader("mark", "cedar", "essay", "4", "--gradebook", book.path, "--by", "Lee")
    assert done.returncode == 0
    with pytest.raises(NewerMarkError):
        session.undo()
    assert points(book)[2:] == [("cedar", "essay", 4), ("ash", "essay", None)]
    assert not session.own.can_undo


def test_one_by_one(book: Gradebook) -> None:
    """The item is replaced by one for each of its students; an item of one student is not split."""
    session = ReviewSession(Grades(book))
    session.go(session.queue.listed()[-2])
    session.split()
    assert items(session)[9:] == ["essay: dogwood", "essay: fir", "picture: dogwood fir"]
    session.mark(Decimal(0), "")
    assert points(book) == [("dogwood", "essay", 0)]
    with pytest.raises(InputError, match=r"^this item has one student only$"):
        session.split()


def test_filters(book: Gradebook) -> None:
    """One question, one section without the students of others, and states; nothing that is marked is lost."""
    session = ReviewSession(Grades(book))
    session.show_only(ReviewFilter("essay", "B"))
    session.mark(Decimal(1), "")
    assert points(book) == [("birch", "essay", 1)]
    assert session.queue.sections == ["A", "B"]
    shown: dict[str, list[str]] = {}
    for state in ("unmarked", "answered", "empty", "marked"):
        session.show_only(ReviewFilter("essay", "", state))
        shown[state] = []
        while session.item is not None:
            shown[state].append(session.item.grade.student.key)
            session.next()
    everything = ["ash", "elm", "birch", "gum"]
    assert shown == {
        "unmarked": ["ash", "elm", "gum", "dogwood"], "answered": everything, "empty": ["dogwood"], "marked": ["birch"],
    }  # fmt: skip


def test_undo_of_an_item_that_the_filter_hides(book: Gradebook) -> None:
    """The filter is removed, and every student of the item loses the mark."""
    session = ReviewSession(Grades(book))
    session.mark(Decimal(1), "")
    session.show_only(ReviewFilter("picture", "B"))
    session.undo()
    assert session.queue.filter == ReviewFilter()
    assert [row[2] for row in points(book)] == [1, 1, None, None]


@pytest.mark.parametrize(("name", "found"), [("elm", "essay elm"), ("Birch", "essay birch"), ("fir", "essay dogwood")])
def test_a_student_is_found(name: str, found: str, book: Gradebook) -> None:
    """By key or name: the item of the current criterion, with something to read if there is one."""
    session = ReviewSession(Grades(book))
    session.find(name)
    assert session.item is not None
    assert f"{session.item.result.criterion.id} {session.item.grade.student.key}" == found


def test_who_is_not_found(book: Gradebook) -> None:
    """An unknown name, a student without an item of the filter, and a name in an anonymous review."""
    session = ReviewSession(Grades(book))
    session.show_only(ReviewFilter("", "A"))
    anonymous = ReviewSession(Grades(book), ReviewScope(anonymous=True))
    for one, name, why in (
        (session, "nobody", "there is no student 'nobody' in the gradebook"),
        (session, "birch", "there is nothing to grade for 'birch' under this filter"),
        (anonymous, "ash", "there is no submission 'ash': type the number of one"),
    ):
        with pytest.raises(InputError, match=why):
            one.find(name)
    anonymous.find("3")
    assert anonymous.item is not None and anonymous.item.first.number is not None


def test_a_result_that_changes_leaves_its_item(book: Gradebook) -> None:
    """After another run, equal answers may no longer be equal: only the students with the answer that is shown stay."""
    session = ReviewSession(Grades(book))
    with book.transaction():
        book.connection.execute("UPDATE student SET key = 'x' || key WHERE key = 'ash'")
    session.go(0)
    assert session.item is not None
    assert [one.grade.student.key for one in session.item.members] == ["cedar"]


@given(st.lists(st.text("ab c", max_size=12), unique=True))
def test_similar_order_keeps_every_text(texts: list[str]) -> None:
    """Each text is there once, and the first is the first."""
    order = similar_order(texts)
    assert sorted(order) == sorted(texts)
    assert order[:1] == texts[:1]


def test_similar_order() -> None:
    """Each is followed by the one that shares most words with it; very many keep their order."""
    texts = ["a b c", "x y", "a b d", "x y z", "a b c d"]
    assert similar_order(texts) == ["a b c", "a b c d", "a b d", "x y", "x y z"]
    many = [f"{number} {number % 7}" for number in range(1001)]
    assert similar_order(many) == sorted(many)


def contents(tmp_path: Path, **files: dict[str, bytes]) -> dict[str, list[str]]:
    """Return the students of each item that has something to read, and of the others, by criterion."""
    for key, own in files.items():
        (tmp_path / "class" / key).mkdir(parents=True)
        for name, data in {"robot.urdf": urdf().encode(), **own}.items():
            (tmp_path / "class" / key / name).write_bytes(data)
    (tmp_path / "roster.csv").write_text("id\n" + "\n".join(files) + "\n")
    (tmp_path / "small.toml").write_text(lab_text())
    assert batch(tmp_path).returncode == 0
    found: dict[str, list[str]] = {}
    with Gradebook(tmp_path / "book.db") as book:
        session = ReviewSession(Grades(book))
        for position in session.queue.listed():
            item = session.queue.items[position]
            name = item.criterion if item.content else f"no {item.criterion}"
            found.setdefault(name, []).append(" ".join(key for key, _ in item.students))
    return found


def test_what_may_hold_an_answer_is_not_empty(tmp_path: Path) -> None:
    """An unread document, a PDF without text, a photo, a Word file: each is an item of its own."""
    template = b"# Step 1\n\nWhy?\n"
    found = contents(
        tmp_path,
        ash={"answers.md": template, "mine.pdf": b"%PDF-1.4 damaged"},
        birch={"scan.pdf": pdf(["-"])},
        cedar={"answer1.jpg": jpeg()},
        dogwood={"report.docx": docx("Task 3", "text")},
        elm={"answers.md": template},
        fir={},
    )
    assert found["essay"] == ["ash", "birch", "cedar"]
    assert found["no essay"] == ["dogwood elm fir"]
    assert found["picture"] == ["ash", "birch", "cedar", "dogwood"]
    assert found["no picture"] == ["elm fir"]


def test_answers_that_are_not_all_there_is_are_not_equal(tmp_path: Path) -> None:
    """A picture, a PDF or another case can make a difference; empty lines at the end cannot."""
    text = b"# Step 1\n\n"
    found = contents(
        tmp_path,
        ash={"answers.md": text + b"![](a.png)", "a.png": PNG},
        birch={"answers.md": text + b"![](a.png)", "a.png": PNG},
        cedar={"answers.md": text + b"See the PDF.", "x.pdf": pdf(["one"])},
        dogwood={"answers.md": text + b"See the PDF.", "x.pdf": pdf(["two"])},
        elm={"answers.md": text + b"/Cmd_Vel"},
        fir={"answers.md": text + b"/cmd_vel"},
        gum={"answers.md": text + b"/cmd_vel\n\n"},
    )
    assert sorted(found["essay"]) == ["ash", "birch", "cedar", "dogwood", "elm", "fir gum"]


def theirs(book: Gradebook, key: str, points: int, by: str = "Lee") -> None:
    """Mark an essay as another person does."""
    mark(book, Grades(book).find(key), criterion_of(lab(), "essay"), Decimal(points), by, "")


def test_a_mark_that_replaces_an_own_one_leaves_the_item(book: Gradebook) -> None:
    """It is not shown as marked in this review, and not overwritten."""
    session = ReviewSession(Grades(book))
    session.mark(Decimal(3), "")
    theirs(book, "cedar", 4)
    session.go(0)
    assert session.item is not None
    assert [one.grade.student.key for one in session.item.members] == ["ash"]
    session.mark(Decimal(1), "")
    assert [row for row in points(book) if row[0] == "cedar"] == [("cedar", "essay", 3), ("cedar", "essay", 4)]


def test_each_newer_mark_is_confirmed(book: Gradebook) -> None:
    """Of two marks that were not shown, the older one is shown first, and the other one before it is replaced."""
    session = ReviewSession(Grades(book))
    theirs(book, "cedar", 4, "Mo")
    theirs(book, "ash", 2)
    shown, seen = 0, list[str]()
    for _ in range(2):
        with pytest.raises(NewerMarkError) as caught:
            session.mark(Decimal(3), "", shown)
        shown = caught.value.mark.id
        seen.append(caught.value.mark.by)
    session.mark(Decimal(3), "", shown)
    assert seen == ["Mo", "Lee"]
    assert [row[2] for row in points(book)] == [4, 2, 3, 3]


def test_undo_takes_the_newest_mark_of_a_student_first(book: Gradebook) -> None:
    """A mark of the item before it was split is undone after those of its students."""
    session = ReviewSession(Grades(book))
    session.mark(Decimal(3), "")
    session.go(0)
    session.split()
    session.mark(Decimal(1), "")
    session.go(0)
    assert session.item is not None and not session.item.others
    assert session.undo() is not None
    assert points(book)[-1] == ("ash", "essay", 3)
    session.undo()
    assert [row[::2] for row in points(book)[-2:]] == [("ash", None), ("cedar", None)]


def test_undo_reaches_students_whose_answer_has_changed(book: Gradebook) -> None:
    """The mark of each student is withdrawn, also if the item no longer shows all of them."""
    session = ReviewSession(Grades(book))
    session.mark(Decimal(3), "")
    with book.transaction():
        book.connection.execute(
            "INSERT INTO result SELECT NULL, student, rubric, version, digest || 'x', verdict, reason, parts, score,"
            " out_of, pending, dictionary, record, urdf, robot, forms FROM result WHERE student ="
            " (SELECT id FROM student WHERE key = 'ash')"
        )
        book.connection.execute(
            "UPDATE submission SET result = (SELECT max(id) FROM result) WHERE student ="
            " (SELECT id FROM student WHERE key = 'ash')"
        )
    session.undo()
    assert [row[2] for row in points(book)] == [3, 3, None, None]


def test_a_student_whom_others_have_marked_is_not_found(book: Gradebook) -> None:
    """No item of other students is shown instead."""
    session = ReviewSession(Grades(book), ReviewScope("essay"))
    theirs(book, "cedar", 4)
    with pytest.raises(InputError, match=r"^others have already marked 'cedar'$"):
        session.find("cedar")
    assert session.position == 0


def test_the_section_of_the_filter_must_exist(book: Gradebook) -> None:
    """An unknown question or section is refused, and the filter stays."""
    session = ReviewSession(Grades(book))
    for wanted in (ReviewFilter("nothing"), ReviewFilter("", "C")):
        with pytest.raises(InputError, match=r"^this review has no such question or section$"):
            session.show_only(wanted)
    assert session.queue.filter == ReviewFilter()
