"""Changes between two runs or gradebooks: who, by how much, in which criteria, and why."""

from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.gradebook import run_writer as module
from grader.classroom.gradebook.changes import Change, PointsChange, changes
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.marks import Entry, Kind, add_mark
from grader.classroom.gradebook.run_writer import save_student
from grader.classroom.gradebook.snapshots import last_two
from grader.classroom.students import Student
from grader.classroom.typed_names import criterion_of
from grader.errors import InputError
from grader.grading.criterion import TOTAL, Adjustment
from grader.grading.rubric import Rubric, read_rubric
from tests.classroom.gradebooks import graded_as, lab, lab_text, mark, record_run
from tests.examples import examples

LAB = lab()
OTHER = lab(box="5")
_ADJUST = '\n[adjust.essay]\naction = "full"\nreason = "ambiguous"\n[adjust.loads]\naction = "drop"\nreason = "odd"\n'
ADJUSTED = read_rubric(
    (lab_text().replace('id = "tall"', 'id = "tall"\nbonus = true') + _ADJUST).encode(), Path("small.toml")
)


@pytest.fixture
def book(tmp_path: Path) -> Any:
    """Yield an empty gradebook."""
    with Gradebook(tmp_path / "book.db", create=True) as opened:
        yield opened


def run(book: Gradebook, rubric: Any = LAB, digest: str = "a", **signs: str) -> int:
    """Record a run with these results."""
    return record_run(book, rubric, [graded_as(rubric, key, row, digest) for key, row in signs.items()])


def put(book: Gradebook, key: str, name: str, points: str | None) -> None:
    """Add a manual mark."""
    given = None if points is None else Decimal(points)
    mark(book, Grades(book).find(key), criterion_of(LAB, name), given, "me", "")


def found(book: Gradebook, before: int | None = None, after: int | None = None) -> list[Change]:
    """Return the changes between two runs."""
    return changes(*last_two(book, before, after))


def why(book: Gradebook) -> dict[str, tuple[str, ...]]:
    """Return the reason for each student."""
    return {change.key: change.why for change in found(book)}


def test_nothing_changed(book: Gradebook) -> None:
    """An equal run is no change, nor is another submission with the same points."""
    run(book, anna="ppp?f", ben="pfs?f")
    run(book, anna="ppp?f")
    run(book, digest="b", ben="pfs?f")
    assert found(book) == []


def test_another_grader(book: Gradebook, monkeypatch: pytest.MonkeyPatch) -> None:
    """The version of the grader is the reason."""
    run(book, anna="ppppp")
    monkeypatch.setattr(module, "__version__", "99.0")
    run(book, anna="ppppf")
    assert why(book) == {"anna": ("the grader changed",)}


def test_manual_marks(book: Gradebook) -> None:
    """Marks count as changes if they are added, replaced or removed between the start of the older run and the next one."""
    first = run(book, anna="ppp??", ben="ppp??", cleo="ppp??", dora="ppp??")
    put(book, "anna", "essay", "2")
    put(book, "ben", "essay", "2")
    second = run(book, anna="ppp??")
    put(book, "ben", "essay", None)
    put(book, "cleo", "picture", "0")
    third = run(book, anna="ppp??")
    put(book, "dora", "box", "0")

    def seen(before: int, after: int) -> dict[str, list[PointsChange]]:
        assert all(change.why == ("manual marks changed",) for change in found(book, before, after))
        return {change.key: list(change.steps) for change in found(book, before, after)}

    two, none = Decimal(2), Decimal(0)
    anna = {"anna": [PointsChange("essay", None, two)]}
    assert seen(first, second) == anna | {"cleo": [PointsChange("picture", None, none)]}
    assert seen(second, third) == {
        "ben": [PointsChange("essay", two, None)],
        "cleo": [PointsChange("picture", None, none)],
        "dora": [PointsChange("box", Decimal("2.5"), none)],
    }
    assert seen(first, third) == anna | {
        "cleo": [PointsChange("picture", None, none)],
        "dora": [PointsChange("box", Decimal("2.5"), none)],
    }


def test_several_reasons(book: Gradebook) -> None:
    """All reasons are named."""
    run(book, anna="ppppp")
    run(book, OTHER, digest="b", anna="ppp!f")
    put(book, "anna", "picture", "0.5")
    words = (
        "the submission changed", "the rubric changed", "manual marks changed", "it was graded, and is errored",
    )  # fmt: skip
    assert why(book) == {"anna": words}


def test_which_runs(book: Gradebook) -> None:
    """The last two runs, or the named ones; a single named run is compared with the one before it."""
    with pytest.raises(InputError, match="not two runs to compare"):
        last_two(book)
    run(book, anna="fffff")
    with pytest.raises(InputError, match="not two runs to compare"):
        last_two(book)
    for signs in ("pffff", "ppfff", "pppff"):
        run(book, digest=signs, anna=signs)

    def runs(before: int | None = None, after: int | None = None) -> tuple[int, ...]:
        return tuple(side.run for side in last_two(book, before, after))

    assert (runs(), runs(1), runs(None, 2), runs(1, 3)) == ((3, 4), (1, 4), (1, 2), (1, 3))
    assert found(book, 1, 3)[0].after == Decimal("5.5")
    for named in ((9, None), (None, 9), (0, None)):
        with pytest.raises(InputError, match=r"there is no run [09]; the runs are: 1, 2, 3, 4"):
            runs(*named)
    for turned in ((4, None), (None, 1), (3, 2), (2, 2)):
        with pytest.raises(InputError, match="is not before run"):
            runs(*turned)


STATUS_LETTERS = st.text("pfs?!-", min_size=5, max_size=5)


@examples(12)
@given(
    st.sampled_from([OTHER, ADJUSTED]),
    STATUS_LETTERS,
    STATUS_LETTERS,
    st.lists(st.tuples(st.sampled_from([criterion.id for criterion in LAB.criteria]), st.booleans()), max_size=4),
)
def test_steps_add_up(newer: Rubric, before: str, after: str, marks: list[tuple[str, bool]]) -> None:
    """The difference of the scores is the sum of the steps, and the newer score is the current one, also of the report."""
    from tempfile import TemporaryDirectory

    with TemporaryDirectory() as folder, Gradebook(Path(folder, "book.db"), create=True) as book:
        run(book, anna=before)
        run(book, newer, anna=after)
        for name, is_given in marks:
            put(book, "anna", name, "0.25" if is_given else None)
        for change in found(book):
            assert change.before is not None
            assert change.after is not None
            assert change.why
            total = sum(((step.after or 0) - (step.before or 0) for step in change.steps), Decimal(0))
            assert change.after - change.before == total
            grade = Grades(book).find("anna")
            report = Grades(book).report(grade)
            assert change.after == grade.score == report.score
            assert (grade.out_of, grade.pending) == (report.max_score, report.pending)


def put_entry(book: Gradebook, key: str, kind: Kind, points: str | None = None, criterion: str = TOTAL) -> None:
    """Add an entry for the whole submission, or for a criterion."""
    entry = Entry(kind, None if points is None else Decimal(points), "so it is")
    add_mark(book, Grades(book).find(key), criterion, entry, "me")


def test_final_marks_and_excuses_are_named(book: Gradebook) -> None:
    """A final mark replaces the total, also without a submission; an excuse keeps it; a comment changes nothing."""
    with book.transaction():
        save_student(book, Student("dora", "Dora Fi"), None)
    run(book, anna="ppp??", ben="ppp??", cleo="ppp??")
    run(book, anna="ppp??", ben="ppp??", cleo="ppp??")
    put_entry(book, "anna", "points", "2")
    put_entry(book, "ben", "excused")
    put_entry(book, "cleo", "comment")
    put_entry(book, "cleo", "comment", criterion="essay")
    put_entry(book, "cleo", "second", "1", criterion="essay")
    put_entry(book, "dora", "points", "0")
    six = Decimal(6)
    assert found(book) == [
        Change("anna", six, Decimal(2), (), ("final mark: none to 2",)),
        Change("ben", six, six, (), ("excused",)),
        Change("dora", None, Decimal(0), (), ("final mark: none to 0",), "Dora Fi"),
    ]
    run(book, anna="ppp??")
    run(book, anna="ppp??")
    put_entry(book, "anna", "withdrawn")
    put_entry(book, "ben", "withdrawn")
    assert [change.why for change in found(book)] == [
        ("final mark: 2 to none",),
        ("no longer excused",),
    ]


def test_a_mark_with_a_later_comment_still_counts(book: Gradebook) -> None:
    """A comment alone keeps the points, so it is no change."""
    run(book, anna="ppp??")
    put(book, "anna", "essay", "2")
    run(book, anna="ppp??")
    put_entry(book, "anna", "comment", criterion="essay")
    run(book, anna="ppp??")
    assert found(book) == []


def test_marks_of_adjusted_criteria_are_no_reason(book: Gradebook) -> None:
    """A mark that does not count is not named, whether it was there before the adjustment or came after it."""
    adjust = '\n[adjust.essay]\naction = "full"\nreason = "ambiguous"\n'
    adjusted = read_rubric((lab_text() + adjust).encode(), Path("small.toml"))
    run(book, anna="ppp??", ben="ppp??")
    put(book, "anna", "essay", "1")
    run(book, anna="ppp??", ben="ppp??")
    put(book, "ben", "essay", "2")
    run(book, adjusted, anna="ppp??", ben="ppp??")
    changed = {change.key: (change.before, change.after, change.why) for change in found(book)}
    assert changed == {
        "anna": (Decimal(7), Decimal(10), ("the rubric changed",)),
        "ben": (Decimal(6), Decimal(10), ("the rubric changed",)),
    }
    assert [change.rubric[0].after for change in found(book)] == [Adjustment("full", "ambiguous")] * 2
