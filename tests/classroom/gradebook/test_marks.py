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


@pytest.mark.parametrize(
    ("text", "points"),
    [
        ("0", "0"),
        ("4", "4"),
        ("4.25", "4.25"),
        ("3,5", "3.5"),
        (" 3.5 ", "3.5"),
        ("0.0001", "0.0001"),
        ("3.50000", "3.5"),
        ("4e0", "4"),
        ("-0", "0"),
        ("+1", "1"),
        (".5", "0.5"),
    ],
)
def test_points(text: str, points: str) -> None:
    """Points from 0 to the maximum, with up to 4 decimals after a point or a comma."""
    assert read_points(text, ESSAY.id, ESSAY.points) == Decimal(points)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("4.2501", "is worth 0 to 4.25 points, not 4.2501"),
        ("5", "is worth 0 to 4.25 points, not 5"),
        ("-1", "is worth 0 to 4.25 points, not -1"),
        ("-0.0001", "is worth 0 to 4.25 points"),
        ("1e30", "is worth 0 to 4.25 points"),
        ("1e999999999", "is worth 0 to 4.25 points"),
        ("-1e999999999", "is worth 0 to 4.25 points"),
        ("1e-999999999", "at most 4 decimals"),
        ("1e-5", "at most 4 decimals"),
        ("3.00001", "at most 4 decimals"),
        ("3." + "9" * 40, "at most 4 decimals"),  # which rounds to all points
        ("nan", "points are a number from 0 to 4.25"),
        ("snan", "points are a number"),
        ("-nan", "points are a number"),
        ("inf", "points are a number"),
        ("-inf", "points are a number"),
        ("", "points are a number"),
        ("1_0", "points are a number"),
        ("-", "points are a number"),
        ("--", "points are a number"),
        ("four", "points are a number"),
        ("3/4", "points are a number"),
        ("50%", "points are a number"),
        ("1,000.5", "points are a number"),
        ("\x1b[31m3", r"not '\\x1b\[31m3'"),
    ],
)
def test_invalid_points(text: str, why: str) -> None:
    """One line says which points are valid."""
    with pytest.raises(InputError, match=why):
        read_points(text, ESSAY.id, ESSAY.points)


@given(st.text())
def test_any_text_is_points_or_refused(text: str) -> None:
    """Any text is refused or gives points between 0 and the maximum."""
    try:
        points = read_points(text, ESSAY.id, ESSAY.points)
    except InputError:
        return
    assert 0 <= points <= ESSAY.points and points * 10_000 % 1 == 0


def test_a_criterion_without_points() -> None:
    """A mark on a criterion without points can only add a comment."""
    nothing = ESSAY._replace(points=Decimal(0))
    assert read_points("0", nothing.id, nothing.points) == 0
    with pytest.raises(InputError, match="is worth 0 to 0 points, not 1"):
        read_points("1", nothing.id, nothing.points)


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


def test_an_unreadable_submission_can_be_marked(standings: Grades) -> None:
    """It is marked criterion by criterion, and final when all have marks."""
    for number, criterion in enumerate(LAB.criteria):
        assert standings.find("dora").why_not_final == "it could not be graded: no zip", number
        put(standings, "dora", criterion.id, str(criterion.points))
    found = standings.find("dora")
    assert (found.score, found.out_of, found.pending, found.why_not_final) == (LAB.points, LAB.points, Decimal(0), "")


def test_parts_that_were_not_graded_can_be_marked(standings: Grades) -> None:
    """A single URDF has no written answers; a mark for them adds to both score and maximum."""
    put(standings, "cleo", "essay", "4")
    found = standings.find("cleo")
    assert (found.score, found.out_of, found.pending) == (Decimal(10), Decimal("10.25"), Decimal(0))
    (essay,) = [result for result in standings.report(found).results if result.criterion.id == "essay"]
    assert (essay.points, essay.outcome.status) == (Decimal(4), "skipped")
