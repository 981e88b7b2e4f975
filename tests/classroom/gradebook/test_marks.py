"""Marks manually: what points may be, whom and what they are for, and what waits for a person."""

from collections.abc import Iterator
from dataclasses import replace
from decimal import Decimal
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.marks import criterion_of, manual_grading_queue, mark, pending_criterion, read_points
from grader.errors import InputError
from tests.classroom.gradebooks import came_out, graded_into, lab

LAB = lab(essay="4.25")
ESSAY = criterion_of(LAB, "essay")


@pytest.fixture
def standings(tmp_path: Path) -> Iterator[Grades]:
    """A gradebook with four submissions: two with both questions open, a URDF alone, and one that could not be read."""
    with Gradebook(tmp_path / "book.db", create=True) as book:
        came = [("anna", "ppp??"), ("ben", "fsp??"), ("cleo", "ppp--")]
        graded = [came_out(LAB, key, signs) for key, signs in came]
        graded_into(book, LAB, [*graded, came_out(LAB, "dora", "?????", reason="no zip")])
        yield Grades(book)


def put(standings: Grades, key: str, name: str, points: str) -> None:
    """Mark a criterion manually."""
    criterion = criterion_of(LAB, name)
    mark(standings.book, standings.find(key), criterion, read_points(points, criterion), "me", "why")


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
    """From nothing to all, with up to 4 decimals, behind a point or a comma."""
    assert read_points(text, ESSAY) == Decimal(points)


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
        ("--", "points are a number"),
        ("four", "points are a number"),
        ("3/4", "points are a number"),
        ("50%", "points are a number"),
        ("1,000.5", "points are a number"),
        ("\x1b[31m3", r"not '\\x1b\[31m3'"),
    ],
)
def test_what_are_no_points(text: str, why: str) -> None:
    """One line says what there may be."""
    with pytest.raises(InputError, match=why):
        read_points(text, ESSAY)


@given(st.text())
def test_any_text_is_points_or_refused(text: str) -> None:
    """Whatever is typed, nothing but points that the criterion is worth comes of it."""
    try:
        points = read_points(text, ESSAY)
    except InputError:
        return
    assert points is None or (0 <= points <= ESSAY.points and points * 10_000 % 1 == 0)


def test_a_criterion_worth_nothing_takes_nothing_else() -> None:
    """Its mark can only be for the comment."""
    nothing = replace(ESSAY, points=Decimal(0))
    assert read_points("0", nothing) == 0
    with pytest.raises(InputError, match="is worth 0 to 0 points, not 1"):
        read_points("1", nothing)


def test_a_misspelt_criterion() -> None:
    """The message guesses what was meant."""
    with pytest.raises(InputError, match="the rubric small has no criterion 'esay'; did you mean 'essay'"):
        criterion_of(LAB, "esay")


def test_like_is_marked_beside_like(standings: Grades) -> None:
    """One criterion after the other, in the rubric's order; nothing of a submission that could not be read or has no such part."""
    wanted = [("anna", "essay"), ("ben", "essay"), ("anna", "picture"), ("ben", "picture")]
    assert manual_grading_queue(standings) == wanted
    assert manual_grading_queue(standings, "picture") == wanted[2:]
    assert manual_grading_queue(standings, "box") == []


def test_what_was_marked_waits_no_more(standings: Grades) -> None:
    """Until the mark is taken back."""
    first, *rest = manual_grading_queue(standings)
    assert pending_criterion(standings, first) is not None
    put(standings, "anna", "essay", "1")
    assert manual_grading_queue(standings) == rest
    assert pending_criterion(standings, first) is None  # somebody else has looked this up before the mark
    put(standings, "anna", "essay", "-")
    assert manual_grading_queue(standings) == [first, *rest]


def test_a_fault_of_ours_keeps_nobody_from_marking_the_rest(standings: Grades) -> None:
    """What a check of ours could not decide is nobody's question, but the written answers of the same submission are."""
    graded_into(standings.book, LAB, [came_out(LAB, "emil", "p!p??")])
    assert [each.criterion for each in manual_grading_queue(standings) if each.key == "emil"] == ["essay", "picture"]
    standing = standings.find("emil")
    assert (standing.verdict, standing.why_not_final) == ("errored", "the grader failed on a criterion")
    for name, points in (("box", "2.5"), ("essay", "4"), ("picture", "1")):
        put(standings, "emil", name, points)
    assert standings.find("emil").why_not_final == ""
    assert standings.find("emil").score == Decimal("11")


def test_a_hand_in_that_cannot_be_read_can_be_marked(standings: Grades) -> None:
    """Criterion by criterion; it is final when all of them are."""
    for number, criterion in enumerate(LAB.criteria):
        assert standings.find("dora").why_not_final == "it could not be graded: no zip", number
        put(standings, "dora", criterion.id, str(criterion.points))
    found = standings.find("dora")
    assert (found.score, found.out_of, found.pending, found.why_not_final) == (LAB.points, LAB.points, Decimal(0), "")


def test_what_was_not_asked_for_can_be_marked(standings: Grades) -> None:
    """A URDF alone has no written answers; if they came by mail, a mark adds their points to both sides."""
    put(standings, "cleo", "essay", "4")
    found = standings.find("cleo")
    assert (found.score, found.out_of, found.pending) == (Decimal(10), Decimal("10.25"), Decimal(0))
    (essay,) = [each for each in standings.report(found).results if each.criterion.id == "essay"]
    assert (essay.points, essay.outcome.status) == (Decimal(4), "skipped")


def test_bytes_that_are_no_text_are_spelt_out(standings: Grades) -> None:
    """A comment or a name from a terminal in another encoding is kept, as far as it can be read."""
    mark(standings.book, standings.find("anna"), ESSAY, Decimal(1), "m\udcff", "gr\udcf6n \ud800")
    assert list(standings.book.rows("SELECT author, comment FROM mark")) == [("m\\udcff", "gr\\udcf6n \\ud800")]
    with pytest.raises(InputError, match="there is no"):
        standings.find("\udcff")
