"""A review goes forward and back through its queue, writes every mark at once, and undoes marks with new entries."""

from collections.abc import Iterator
from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.manual_queue import ReviewScope, reusable_comments
from grader.classroom.gradebook.marks import NewerMarkError
from grader.classroom.review.session import ReviewSession
from grader.classroom.typed_names import criterion_of
from tests.classroom.gradebooks import graded_as, lab, mark, record_run

LAB = lab()
KEYS = ("ash", "birch", "cedar")


@pytest.fixture
def book(tmp_path: Path) -> Iterator[Gradebook]:
    """Yield a gradebook with three submissions that have an open essay and picture each."""
    with Gradebook(tmp_path / "book.db", create=True) as book:
        record_run(book, LAB, [graded_as(LAB, key, "ppp??", key) for key in KEYS])
        yield book


def here(session: ReviewSession) -> str:
    """Return the current item in a few words: key, criterion, its points if it is marked."""
    if session.item is None:
        return "the end"
    given = session.item.result.manual_mark
    return f"{session.item.grade.student.key} {session.item.result.criterion.id} {given.points if given else 'open'}"


def theirs(book: Gradebook, key: str, criterion: str, points: str | None, comment: str = "") -> None:
    """Mark as somebody else does meanwhile."""
    value = None if points is None else Decimal(points)
    mark(book, Grades(book).find(key), criterion_of(LAB, criterion), value, "Lee", comment)


def entries(book: Gradebook) -> list[tuple[Any, ...]]:
    """Return all entries: key, criterion, points, name, author, comment."""
    query = "SELECT key, criterion, points / 10000.0, grader_name, author, comment FROM mark"
    return list(book.rows(f"{query} JOIN student ON student = student.id ORDER BY mark.id"))


def test_own_marks_stay_and_those_of_others_are_passed_over(book: Gradebook) -> None:
    """Going back shows what this review has marked, not what others have."""
    session = ReviewSession(Grades(book), ReviewScope("essay", "Kim"))
    session.mark(Decimal(3), "good")
    theirs(book, "birch", "essay", "1")
    session.next()
    assert here(session) == "cedar essay open"
    session.back()
    assert here(session) == "ash essay 3"
    session.next()
    assert here(session) == "cedar essay open"
    assert (session.marked, session.left) == (1, 1)


def test_a_mark_is_not_repeated(book: Gradebook) -> None:
    """The same points and comment add no entry; others replace the mark."""
    session = ReviewSession(Grades(book), ReviewScope("essay", "Kim"))
    for points, comment in ((3, "good"), (3, "good"), (3, "very good"), (2, "very good")):
        session.mark(Decimal(points), comment)
        session.go(0)
    assert [entry[2:4] + entry[5:] for entry in entries(book)] == [
        (3.0, "Kim", "good"), (3.0, "Kim", "very good"), (2.0, "Kim", "very good"),
    ]  # fmt: skip
    assert session.marked == 1


def test_undo_of_the_current_item_comes_first(book: Gradebook) -> None:
    """Elsewhere the newest mark is undone, and the review goes to its item."""
    session = ReviewSession(Grades(book), ReviewScope("essay"))
    for points in (1, 2):
        session.mark(Decimal(points), "")
        session.next()
    session.go(0)
    session.undo()
    assert here(session) == "ash essay open"
    session.next()
    session.next()
    assert here(session) == "cedar essay open"
    session.undo()
    assert here(session) == "birch essay open"
    with pytest.raises(IndexError):
        session.undo()


def test_an_undo_never_overwrites_a_newer_mark(book: Gradebook) -> None:
    """It is refused, and the item is left to who has marked it since."""
    session = ReviewSession(Grades(book), ReviewScope("essay", "Kim"))
    session.mark(Decimal(1), "")
    theirs(book, "ash", "essay", "4")
    count = len(entries(book))
    with pytest.raises(NewerMarkError):
        session.undo()
    assert (len(entries(book)), session.marked, session.own.can_undo) == (count, 0, False)


def test_reusable_comments(book: Gradebook) -> None:
    """Distinct, of this criterion, the most frequent first; those of marks that no longer count are not among them.

    In a review that goes on, a comment keeps its place.
    """
    first, second = ReviewSession(Grades(book)), ReviewSession(Grades(book))
    assert first.comments() == []
    theirs(book, "ash", "essay", "1", "one root")
    assert first.comments() == ["one root"]
    for key, comment in (("ash", "one root"), ("birch", "two roots"), ("cedar", "two roots")):
        theirs(book, key, "essay", "1", comment)
    theirs(book, "ash", "picture", "1", "too small")
    assert first.comments() == ["one root", "two roots"]
    assert second.comments() == ["two roots", "one root"]
    theirs(book, "ash", "essay", None)
    assert first.comments() == second.comments() == ["two roots"]
    assert reusable_comments(book, "essay", 0) == []
