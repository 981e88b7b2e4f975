"""The items of a review: what is one item, in which order they come, and what one mark of several students is."""

import csv
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from grader.base.errors import InputError
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.review_items import ReviewFilter, review_items
from grader.classroom.results.results import hash_values
from grader.classroom.review.review_session import ReviewSession
from tests.checks.submissions import jpeg
from tests.classroom.gradebooks import PNG, batch, grader, lab_text, urdf, write_submission
from tests.documents.files import docx, pdf

pytestmark = pytest.mark.slow

ANSWERS = {
    "ash": "The roots.",
    "birch": "No.",
    "cedar": "The roots.  \n\n",
    "dogwood": "",
    "elm": "Long.",
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
    rows = [
        f"{key},{key.title()},{('Lab A', 'Lab B')[number % 2]},{key}"
        for number, key in enumerate(ANSWERS)
    ]
    rows += ["gum,Gum,Lab A,team", "holly,Holly,Lab B,team"]
    (top / "roster.csv").write_text("id,name,section,team\n" + "\n".join(rows) + "\n")
    (top / "small.toml").write_text(lab_text())
    done = batch(top)
    assert done.returncode == 0, done.stderr
    return top


@pytest.fixture
def book(graded: Path, tmp_path: Path) -> Path:
    """Return a copy of the gradebook, beside its class."""
    return shutil.copytree(graded, tmp_path / "copy") / "book"


@pytest.fixture
def session(book: Path) -> ReviewSession:
    """Return a review of the whole class."""
    return ReviewSession(book, by="Kim")


def items(session: ReviewSession) -> list[str]:
    """Return the criterion and the students of each item that is shown."""
    return [words(session, at) for at in session.listed]


def words(session: ReviewSession, at: int) -> str:
    """Return the criterion and the students of an item."""
    item = session.item_at(at)
    return f"{item.criterion.id}: {' '.join(one.student.key for one in item.members)}"


def give(session: ReviewSession, at: int, points: str, comment: str = "") -> None:
    """Mark an item as the person sees it."""
    assert session.mark(at, points, comment, session.item_at(at).view) == []


def rows(book: Path, by: str = "kim") -> list[tuple[str, ...]]:
    """Return the rows of a grader: student, criterion, points."""
    with (book / "marks" / f"{by}.csv").open(newline="") as file:
        return [(row["student"], row["criterion"], row["points"]) for row in csv.DictReader(file)]


def test_equal_answers_and_a_team_are_one_item(session: ReviewSession) -> None:
    """In the rubric's order, each criterion by student; those without an answer are its last item."""
    assert items(session) == [
        "essay: ash cedar",
        "essay: birch",
        "essay: elm",
        "essay: gum holly",
        "essay: dogwood fir",
        "picture: ash",
        "picture: birch",
        "picture: cedar",
        "picture: elm",
        "picture: gum holly",
        "picture: dogwood fir",
    ]


def test_one_mark_is_a_row_for_each_student(session: ReviewSession, book: Path) -> None:
    """Its digest is that of the student's own submission."""
    give(session, 3, "3", "good")
    give(session, 3, "2", "good")
    assert rows(book) == [(key, "essay", points) for points in "32" for key in ("gum", "holly")]
    give(session, 0, "1")
    digests = {one.student: one.digest for one in Gradebook(book).results.all()}
    marks = Gradebook(book).marks.counting
    assert {key: marks[key, "essay"].submission for key in ("ash", "cedar")} == {
        key: digests[key] for key in ("ash", "cedar")
    }
    assert digests["ash"] != digests["cedar"]


def test_a_mark_of_somebody_else_marks_nobody(session: ReviewSession, book: Path) -> None:
    """If one student has a newer mark, no student is marked; that one then leaves the item, and the others stay."""
    item = session.item_at(0)
    assert grader("mark", "ash", "essay", "1", "--gradebook", book, "--by", "Lee").returncode == 0
    session.refresh()
    assert session.mark(0, "3", "", item.view) is None
    assert not (book / "marks" / "kim.csv").exists()
    assert words(session, 0) == "essay: cedar"
    give(session, 0, "2")
    assert words(session, 0) == "essay: cedar"  # it stays in the list
    session.show_only(ReviewFilter(state=""))
    item = session.item_at(0)
    replaced = session.mark(0, "4", "", item.view)
    assert [(mark.by, mark.student) for mark in replaced or ()] == [("Lee", "ash")]
    assert rows(book) == [("cedar", "essay", "2")]


def test_sections(session: ReviewSession, book: Path) -> None:
    """In any spelling; only their students are shown, marked and counted. An unknown one is refused with the known ones."""
    of_b = ReviewSession(book, ReviewFilter("essay", "lab_b"), by="Lee")
    assert items(of_b) == ["essay: birch", "essay: holly", "essay: dogwood fir"]
    assert of_b.left == 4
    give(of_b, of_b.listed[1], "1")
    assert rows(book, "lee") == [("holly", "essay", "1")]
    with pytest.raises(
        InputError,
        match=r"no student has the section 'C' in the roster; it has 'Lab A' and 'Lab B'",
    ):
        session.show_only(ReviewFilter("", "C"))
    assert session.filter == ReviewFilter()


def test_who_has_no_items(book: Path) -> None:
    """A student with a final mark, one with an excuse, and an adjusted criterion; an overridden check is an item."""
    for words in (("ash", "total", "5"), ("elm", "total", "excused"), ("birch", "box", "1")):
        assert grader("mark", *words, "--gradebook", book).returncode == 0
    rubric = book / "rubric" / "small.toml"
    rubric.write_text(
        rubric.read_text() + '\n[adjust.picture]\naction = "full"\nreason = "no camera"\n'
    )
    opened = Gradebook(book)
    found = {
        f"{item.criterion.id}: {' '.join(one.student.key for one in item.members)}"
        for item in review_items(opened).values()
    }
    assert found == {
        "box: birch",
        "essay: birch",
        "essay: cedar",
        "essay: gum holly",
        "essay: dogwood fir",
    }


@pytest.fixture
def contents(tmp_path: Path) -> Callable[..., dict[str, list[str]]]:
    """Return a function that grades files: the students with each answer by criterion, and those without one."""

    def grade(**files: dict[str, bytes]) -> dict[str, list[str]]:
        for key, own in files.items():
            (tmp_path / "class" / key).mkdir(parents=True)
            for name, data in {"robot.urdf": urdf().encode(), **own}.items():
                (tmp_path / "class" / key / name).write_bytes(data)
        (tmp_path / "roster.csv").write_text("id\n" + "\n".join(files) + "\n")
        (tmp_path / "small.toml").write_text(lab_text())
        assert batch(tmp_path).returncode == 0
        found: dict[str, list[str]] = {}
        for (criterion, answer), item in review_items(Gradebook(tmp_path / "book")).items():
            keys = " ".join(one.student.key for one in item.members)
            found.setdefault(criterion if answer else f"no {criterion}", []).append(keys)
        return found

    return grade


def test_what_may_hold_an_answer_is_not_empty(
    contents: Callable[..., dict[str, list[str]]],
) -> None:
    """An unread document, a PDF without text, a photo, a Word file, a template: each is an item of its own."""
    template = b"# Step 1\n\nWhy?\n"
    found = contents(
        ash={"answers.md": template, "mine.pdf": b"%PDF-1.4 damaged"},
        birch={"scan.pdf": pdf(["-"])},
        cedar={"answer1.jpg": jpeg()},
        dogwood={"report.docx": docx("Task 3", "text")},
        elm={"answers.md": template},
        fir={},
    )
    assert found["essay"] == ["ash", "birch", "cedar", "dogwood", "elm"]
    assert found["no essay"] == ["fir"]
    assert found["picture"] == ["ash", "birch", "cedar", "dogwood"]
    assert found["no picture"] == ["elm fir"]


def test_answers_that_are_not_all_there_is_are_not_equal(
    contents: Callable[..., dict[str, list[str]]],
) -> None:
    """A picture, a PDF or another case can make a difference; empty lines at the end cannot."""
    text = b"# Step 1\n\n"
    found = contents(
        ash={"answers.md": text + b"![](a.png)", "a.png": PNG},
        birch={"answers.md": text + b"![](a.png)", "a.png": PNG},
        cedar={"answers.md": text + b"See the PDF.", "x.pdf": pdf(["one"])},
        dogwood={"answers.md": text + b"See the PDF.", "x.pdf": pdf(["two"])},
        elm={"answers.md": text + b"/Cmd_Vel"},
        fir={"answers.md": text + b"/cmd_vel"},
        gum={"answers.md": text + b"/cmd_vel\n\n"},
    )
    assert sorted(found["essay"]) == ["ash", "birch", "cedar", "dogwood", "elm", "fir gum"]


def test_a_team_with_several_files_is_one_item(tmp_path: Path) -> None:
    """Though the digests of its members differ, because several files are a submission named after the student.

    It has the same key in an anonymous sheet, where another member may be the first.
    """
    (tmp_path / "class").mkdir()
    for number, (name, data) in enumerate(
        {"robot.urdf": urdf().encode(), "screen.png": PNG, "answers.md": b"x"}.items()
    ):
        (tmp_path / "class" / f"team1_101_{2000 + number}_{name}").write_bytes(data)
    (tmp_path / "roster.csv").write_text(
        "id,name,canvas,group\nash,Ash,101,team1\ngum,Gum,102,team1\n"
    )
    (tmp_path / "small.toml").write_text(lab_text())
    done = batch(tmp_path)
    assert done.returncode == 0, done.stderr
    book = Gradebook(tmp_path / "book")
    assert sorted(book.keys, key=hash_values) == ["gum", "ash"]
    assert len({one.digest for one in book.results.all()}) == 2
    found = review_items(book).values()
    assert {
        (one.criterion.id, *(member.student.key for member in one.members)) for one in found
    } == {
        ("essay", "ash", "gum"),
        ("picture", "ash", "gum"),
    }
    assert review_items(book, is_anonymous=True).keys() == review_items(book).keys()
