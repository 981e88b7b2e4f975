"""A gradebook of an earlier version opens with every mark and every result."""

import csv
import sqlite3
from collections.abc import Iterator
from contextlib import closing
from decimal import Decimal
from pathlib import Path

import pytest

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.marks import newest_mark
from grader.classroom.gradebook.schema import STEPS
from grader.classroom.gradebook.statistics import statistics
from grader.errors import InputError
from grader.usecases.grades_csv import grades_csv
from tests.classroom.gradebooks import mark

DATA = Path(__file__).parent / "data"
# A class of five in two runs, with five marks: written by grader 0.1.0 with these schema versions, dumped as SQL.
VERSIONS = (3, 4, 5, 6)
TABLES = {
    "rubric": "rubric", "criterion": "criterion", "template": "template", "student": "student", "run": "run",
    "result": "result", "seen": "submission", "mark": "mark", "model_answer": "model_answer",
}  # fmt: skip


@pytest.fixture(params=VERSIONS)
def version(request: pytest.FixtureRequest) -> int:
    """Return an earlier version of the schema."""
    return int(request.param)


@pytest.fixture
def path(tmp_path: Path, version: int) -> Path:
    """Return the path of a gradebook of that version."""
    path = tmp_path / "book.db"
    with closing(sqlite3.connect(path)) as connection:
        connection.executescript((DATA / f"version{version}.sql").read_text(encoding="utf-8"))
        assert connection.execute("PRAGMA user_version").fetchone() == (version,)
    return path


@pytest.fixture
def book(path: Path) -> Iterator[Gradebook]:
    """Yield the same gradebook, opened by this version."""
    with Gradebook(path) as opened:
        yield opened


def test_every_row_is_kept(path: Path, version: int) -> None:
    """All values of all tables are unchanged, in the same order of columns; new columns are at the end."""
    tables = TABLES if version == 3 else {name: name for name in TABLES.values()}
    with closing(sqlite3.connect(path)) as connection:
        before = {new: list(connection.execute(f"SELECT * FROM {old}")) for old, new in tables.items()}
    with Gradebook(path) as book:
        assert next(book.rows("PRAGMA user_version")) == (len(STEPS),)
        for name, rows in before.items():
            assert [row[: len(rows[0])] for row in book.rows(f"SELECT * FROM {name}")] == rows
    assert len(before["mark"]) == 5
    assert len(before["result"]) == 6


def test_every_grade_is_kept(book: Gradebook, version: int) -> None:
    """The exported grades are those that the version exported; later columns and the words of `not_final_because` are new."""
    with (DATA / f"version{version}.csv").open(encoding="utf-8", newline="") as file:
        before = [{**row, "not_final_because": "", "carried": ""} for row in csv.DictReader(file)]
    after = list(csv.DictReader(grades_csv(Grades(book)).splitlines()))
    assert [{name: row[name] for name in before[0]} | {"not_final_because": ""} for row in after] == before


def test_every_mark_is_kept(book: Gradebook) -> None:
    """Marks count with their authors and comments; a removed mark does not, and can be added again."""
    grades = Grades(book)
    essay = next(result for result in grades.report(grades.find("anna")).results if result.criterion.id == "essay")
    assert essay.manual_mark is not None
    assert (essay.manual_mark.points, essay.manual_mark.comment) == (Decimal("3.5"), "Well done.")
    emil = grades.find("emil")
    assert (emil.marks, emil.score) == (1, Decimal(4))
    taken_back = newest_mark(book, emil.id, "picture")
    assert taken_back is not None
    assert taken_back.points is None
    picture = next(criterion for criterion in grades.newest_rubric().criteria if criterion.id == "picture")
    assert mark(book, emil, picture, Decimal(1), "Kim", "").before == taken_back
    assert grades.find("emil").score == Decimal(5)


def test_reports_and_statistics_can_be_made(book: Gradebook) -> None:
    """Every record is read; the failures are counted."""
    grades = Grades(book)
    assert [grades.report(grade).score for grade in grades.all()] == [grade.score for grade in grades.all()]
    found = statistics(book, grades.newest_rubric())
    assert found.graded == 4
    assert {failure.criterion.id for failure in found.failures} == {"box"}
    assert sum(failure.count for failure in found.failures) == 2


@pytest.mark.parametrize(
    "statement",
    ["DELETE FROM mark", "UPDATE mark SET points = 0", "REPLACE INTO mark SELECT * FROM mark", "DELETE FROM result"],
)
def test_marks_and_results_stay_protected(book: Gradebook, statement: str) -> None:
    """Triggers refuse to change them, as before."""
    with pytest.raises(InputError, match="never"), book.input_errors():
        book.connection.execute(statement)


def test_a_newer_version_is_refused(path: Path) -> None:
    """A grader does not open the gradebook of a later one, and leaves it as it is."""
    with closing(sqlite3.connect(path)) as connection, connection:
        connection.execute(f"PRAGMA user_version = {len(STEPS) + 1}")
    before = path.read_bytes()
    with pytest.raises(InputError, match="was made by a newer grader: install that version, or name another file"):
        Gradebook(path)
    assert path.read_bytes() == before
