"""Manual marks: valid points, students and criteria, and the criteria that need manual grading."""

from collections.abc import Iterator
from datetime import UTC, datetime
from decimal import Decimal
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.manual_queue import QueuedCriterion, manual_grading_queue, queued_results
from grader.classroom.gradebook.marks import (
    TAKE_BACK,
    WITHDRAWN,
    AddedMark,
    Entry,
    NewerMarkError,
    account,
    add_mark,
    undo_mark,
)
from grader.classroom.typed_names import criterion_of, read_points
from grader.errors import InputError
from tests.classroom.gradebooks import graded_as, lab, mark, record_run

LAB = lab(essay="4.25")
ESSAY = criterion_of(LAB, "essay")


@pytest.fixture
def standings(tmp_path: Path) -> Iterator[Grades]:
    """Yield a gradebook with four submissions: two with both questions open, a single URDF, and an unreadable one."""
    with Gradebook(tmp_path / "book.db", create=True) as book:
        came = [("anna", "ppp??"), ("ben", "fsp??"), ("cleo", "ppp--")]
        graded = [graded_as(LAB, key, signs) for key, signs in came]
        record_run(book, LAB, [*graded, graded_as(LAB, "dora", "?????", reason="no zip")])
        yield Grades(book)


def put(standings: Grades, key: str, name: str, points: str) -> None:
    """Mark a criterion manually."""
    criterion = criterion_of(LAB, name)
    given = None if points == TAKE_BACK else read_points(points, name, criterion.points)
    mark(standings.book, standings.find(key), criterion, given, "me", "why")


def is_open(standings: Grades, queued: QueuedCriterion) -> bool:
    """Return whether a queued criterion still needs manual grading."""
    (found,) = queued_results(standings, standings.find(queued.key), [queued.criterion])
    return found.result.is_open


@given(st.text())
def test_any_text_is_points_or_refused(text: str) -> None:
    """Any text is refused or gives points between 0 and the maximum."""
    try:
        points = read_points(text, ESSAY.id, ESSAY.points)
    except InputError:
        return
    assert 0 <= points <= ESSAY.points and points * 10_000 % 1 == 0


def test_a_container_may_have_no_account(monkeypatch: pytest.MonkeyPatch) -> None:
    """The audit then names nobody."""

    def fail() -> str:
        raise KeyError("getpwuid(): uid not found: 1234")

    monkeypatch.setattr("getpass.getuser", lambda: "robo")
    assert account() == "robo"
    monkeypatch.setattr("getpass.getuser", fail)
    assert account() == ""


ROWS = [  # kind, points, comment, author, name in reports, run of the result
    ("points", 10_000, "one root", "Kim", "Kim", 1),
    ("points", 10_000, "two roots", "robo", "Kim", 1),  # a comment keeps the points, their grader and their result
    ("excused", None, "", "Lee", "Lee", 2),
    ("excused", None, "ill", "Kim", "Lee", 2),
    ("withdrawn", None, "", "robo", "", 2),
    ("comment", None, "late", "robo", "", 2),  # there are no points to keep
    ("withdrawn", None, "", "Kim", "", 2),  # undone: the mark before it counts again
    ("second", 20_000, "", "Kim", "Kim", 2),
    ("second", 30_000, "", "Kim", "Kim", 2),
    ("second", 40_000, "", "Lee", "Lee", 2),
]


def test_every_entry_is_a_row_of_the_audit(standings: Grades, monkeypatch: pytest.MonkeyPatch) -> None:
    """It says who made it, whose name reports show, and which result it is about; a newer entry that was not seen refuses it."""
    monkeypatch.setattr("getpass.getuser", lambda: "robo")
    book = standings.book

    def add(entry: Entry, by: str, shown: int | None = None) -> AddedMark:
        return add_mark(book, Grades(book).find("anna"), "essay", entry, by, shown=shown)

    first = add(Entry("points", Decimal(1), "one root"), "Kim")
    record_run(book, LAB, [graded_as(LAB, "anna", "ppp??", "again")])
    second = add(Entry("comment", None, "two roots"), "", shown=first.id)
    assert (first.before, second.before and second.before.comment) == (None, "one root")
    for entry, by in (
        (Entry("excused"), "Lee"), (Entry("comment", None, "ill"), "Kim"), (WITHDRAWN, ""), (Entry("comment", None, "late"), ""),
    ):  # fmt: skip
        newest = add(entry, by)
    with pytest.raises(NewerMarkError) as caught:
        add(Entry("points", Decimal(2)), "Lee", shown=first.id)
    assert caught.value.mark.id == newest.id
    assert undo_mark(book, Grades(book).find("anna"), "essay", "Kim").comment == "late"
    own = add(Entry("second", Decimal(2)), "Kim", shown=newest.id)
    add(Entry("second", Decimal(3)), "Kim", shown=own.id)
    with pytest.raises(NewerMarkError):
        add(Entry("second", Decimal(4)), "Kim", shown=own.id)
    assert add(Entry("second", Decimal(4)), "Lee", shown=0).before is None
    rows = "SELECT kind, points, comment, author, grader_name, run FROM mark JOIN submission ON mark.result = submission.result"
    assert [tuple(row) for row in book.rows(f"{rows} ORDER BY mark.id")] == ROWS
    assert {datetime.fromisoformat(at).tzinfo for (at,) in book.rows("SELECT at FROM mark")} == {UTC}


def test_a_marked_criterion_is_no_longer_queued(standings: Grades) -> None:
    """It is queued again when the mark is removed."""
    first, *rest = manual_grading_queue(standings)
    assert is_open(standings, first)
    put(standings, "anna", "essay", "1")
    assert manual_grading_queue(standings) == rest
    assert not is_open(standings, first)  # another reviewer has read this before the mark
    put(standings, "anna", "essay", "-")
    assert manual_grading_queue(standings) == [first, *rest]


def test_an_error_of_the_grader_does_not_block_manual_grading(standings: Grades) -> None:
    """An errored criterion is not queued, but the written answers of the same submission are."""
    record_run(standings.book, LAB, [graded_as(LAB, "emil", "p!p??")])
    assert [question.criterion for question in manual_grading_queue(standings) if question.key == "emil"] == [
        "essay",
        "picture",
    ]
    standing = standings.find("emil")
    assert (standing.verdict, standing.why_not_final) == ("errored", "the grader failed on a criterion")
    for name, points in (("box", "2.5"), ("essay", "4"), ("picture", "1")):
        put(standings, "emil", name, points)
    assert standings.find("emil").why_not_final == ""
    assert standings.find("emil").score == Decimal("11")
