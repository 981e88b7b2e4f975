"""Changes between two runs or gradebooks: who, by how much, in which criteria, and why."""

from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.gradebook import run_writer as module
from grader.classroom.gradebook.changes import Change, changes
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.snapshots import last_two
from grader.classroom.typed_names import criterion_of
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


def test_another_grader(book: Gradebook, monkeypatch: pytest.MonkeyPatch) -> None:
    """The version of the grader is the reason."""
    run(book, anna="ppppp")
    monkeypatch.setattr(module, "__version__", "99.0")
    run(book, anna="ppppf")
    assert why(book) == {"anna": ("the grader changed",)}


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
