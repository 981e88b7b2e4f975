"""Adjusted criteria and extra credit through the command line: grade, batch, regrade, marks, exit codes, exports."""

import json
from pathlib import Path
from typing import Any

import pytest

from tests.classroom.gradebooks import batch, grader, lab_text, urdf, write_submission
from tests.report.class_pages import ClassPageReader

pytestmark = pytest.mark.slow


def adjusted(text: str, name: str, action: str) -> str:
    """Return a rubric with an adjustment."""
    return f'{text}\n\n[adjust.{name}]\naction = "{action}"\nreason = "odd handout"\n'


def with_bonus(text: str, name: str) -> str:
    """Return a rubric in which a criterion is extra credit."""
    assert f'id = "{name}"' in text
    return text.replace(f'id = "{name}"', f'id = "{name}"\nbonus = true')


def rubric(folder: Path, text: str, name: str = "lab.toml") -> Path:
    """Write a rubric and return its path."""
    (folder / name).write_text(text)
    return folder / name


def students(top: Path) -> dict[str, Any]:
    """Return the current grades by student."""
    done = grader("stats", "--gradebook", top / "book", "--format", "json")
    return {student["id"]: student for student in json.loads(done.stdout)["students"]}


def scores(top: Path) -> dict[str, tuple[Any, Any, Any]]:
    """Return score, maximum and pending points by student."""
    return {
        key: (one["score"], one["max_score"], one["pending"]) for key, one in students(top).items()
    }


@pytest.fixture
def wrong(tmp_path: Path) -> Path:
    """Return a submission with everything, but a box of another size."""
    write_submission(tmp_path / "emil", "1 1 2")
    return tmp_path / "emil"


# --- One submission -----------------------------------------------------------------------------------------------------


@pytest.mark.usefixtures("hostile_checks")
def test_a_faulty_check_of_a_dropped_criterion_is_no_fault(wrong: Path, tmp_path: Path) -> None:
    """The instructor has dropped it for this reason: the exit code is 3 without the adjustment, and 0 with it."""
    text = lab_text(extra="1").replace(
        'title = "About extra"\npoints = 1\npart = "robot"\ncheck = "urdf_loads"',
        'title = "About extra"\npoints = 1\npart = "robot"\ncheck = "behaves"',
    )
    (wrong / "robot.urdf").write_text(urdf().replace('name="r"', 'name="returns_text"'))
    codes = [
        grader("grade", wrong, "--rubric", rubric(tmp_path, chosen)).returncode
        for chosen in (text, adjusted(text, "extra", "drop"))
    ]
    assert codes == [3, 0]


# --- A class --------------------------------------------------------------------------------------------------------------


def test_the_class_gets_the_new_totals_without_force(top: Path) -> None:
    """An adjustment is another rubric: all are graded again. Marks do not count meanwhile, and come back."""
    before = scores(top)
    assert before["emil"] == (3, 11, 5)
    for name, points in (("box", 1), ("essay", 1)):
        assert grader("mark", "emil", name, points, "--gradebook", top / "book").returncode == 0
    marked = scores(top)
    assert marked["emil"] == (5, 11, 1)
    text = adjusted(adjusted(lab_text(), "box", "full"), "essay", "drop")
    assert batch(top, rubric=rubric(top, text)).returncode == 0
    assert scores(top) == {
        "anna": (6, 7, 1),
        "ben": (6, 7, 1),
        "cleo": (0, 7, 7),  # could not be read: only graded submissions get the points
        "dora": (None, None, 0),  # nothing was submitted
        "emil": (5.5, 7, 1),  # and `tall` is not skipped any more: it fails
    }
    assert students(top)["emil"]["manual_marks"] == 0
    assert students(top)["emil"]["carried"] == []
    batch(top)
    assert scores(top) == marked


def test_a_part_that_was_not_submitted_stays_not_graded(top: Path) -> None:
    """What is given to everybody is given on graded parts only."""
    batch(top, "--part", "robot", rubric=rubric(top, adjusted(lab_text(), "essay", "full")))
    assert scores(top)["anna"] == (6, 6, 0)


def test_review_does_not_ask(top: Path) -> None:
    """An adjusted question is no item."""
    batch(
        top, rubric=rubric(top, adjusted(adjusted(lab_text(), "essay", "drop"), "picture", "full"))
    )
    sheet = top / "sheet.csv"
    assert grader("review", "--gradebook", top / "book", "--sheet", sheet).returncode == 0
    assert "essay" not in sheet.read_text() and "picture" not in sheet.read_text()


def test_statistics(top: Path) -> None:
    """Adjusted criteria are no mistakes and not among the hardest; a grade above the maximum is in the last bar."""
    text = with_bonus(adjusted(adjusted(lab_text(), "essay", "full"), "picture", "drop"), "box")
    text = text.replace('requires = ["box"]', "")
    batch(top, rubric=rubric(top, text))
    data = json.loads(grader("stats", "--gradebook", top / "book", "--format", "json").stdout)[
        "statistics"
    ]
    assert data["grades"] == {"students": 3, "mean": 9, "median": 10}
    assert data["tenths"] == [0, 0, 0, 0, 0, 0, 0, 0, 0, 3]
    rows = {row["id"]: row for row in data["criteria"]}
    assert (rows["essay"]["share"], rows["picture"]["share"]) == (None, None)
    shown = grader("stats", "--gradebook", top / "book").stdout
    assert "box: 'base' shows" not in shown  # extra credit that was not earned is no common mistake
    assert "tall: the bottom of 'base'" in shown


def test_final_marks_and_excuses_are_counted_in_words(top: Path) -> None:
    """How many students have one, also without a submission."""
    for key, points in (("anna", "excused"), ("dora", 0), ("emil", 10)):
        assert grader("mark", key, "total", points, "--gradebook", top / "book").returncode == 0
    data = json.loads(grader("stats", "--gradebook", top / "book", "--format", "json").stdout)[
        "statistics"
    ]
    assert (data["counts"], data["grades"]["students"]) == (
        {"excused": 1, "graded": 2, "missing": 1, "unreadable": 1},
        3,
    )
    assert sum(data["tenths"]) == 3
    assert (
        grader("export", "html", "--gradebook", top / "book", "--output", top / "pages").returncode
        == 0
    )
    page = ClassPageReader(top / "pages" / "index.html")
    assert [(row["grade"], row["status"]) for row in page.table("students")] == [
        ("", "excused"),
        ("0", "missing, final mark"),
        ("6", "graded"),
        ("10", "graded, final mark"),
        ("", "unreadable"),
    ]


# --- Late penalties, rubrics, bundles --------------------------------------------------------------------------------------


def test_the_late_penalty_is_of_the_maximum_without_extra_credit(top: Path) -> None:
    """Ten percent of 8.5 points, not of 11; a dropped criterion lowers the maximum as well."""
    (top / "roster.csv").write_text("id,late\nanna,1\nben,\n")
    for text, points in (
        (with_bonus(lab_text("percent_per_day = 10"), "box"), -0.85),
        (adjusted(lab_text("percent_per_day = 10"), "picture", "drop"), -1),
        (adjusted(lab_text("percent_per_day = 10"), "picture", "full"), -1.1),
    ):
        batch(top, rubric=rubric(top, text))
        assert students(top)["anna"]["late"]["points"] == points


def test_a_mutant_is_not_caught_by_an_adjusted_criterion(tmp_path: Path) -> None:
    """It loses no points there; a bonus catches it."""
    (tmp_path / "robot.urdf").write_text(urdf())
    text = 'reference = "robot.urdf"\n' + lab_text().replace('requires = ["box"]', "")
    data = [
        json.loads(grader("rubric", "test", rubric(tmp_path, chosen), "--format", "json").stdout)
        for chosen in (text, with_bonus(text, "box"), adjusted(text, "box", "drop"))
    ]
    caught = [found["mutants"]["caught"] for found in data]
    assert caught[0] == caught[1] > caught[2]


@pytest.mark.usefixtures("hostile_checks")
def test_a_class_with_a_faulty_check_that_is_dropped(tmp_path: Path) -> None:
    """The grader did not fail on anybody: the grade is final but for manual grading."""
    write_submission(tmp_path / "class" / "anna")
    (tmp_path / "class" / "anna" / "robot.urdf").write_text(
        urdf().replace('name="r"', 'name="returns_text"')
    )
    text = lab_text(extra="1").replace(
        'points = 1\npart = "robot"\ncheck = "urdf_loads"',
        'points = 1\npart = "robot"\ncheck = "behaves"',
    )
    lab = rubric(tmp_path, adjusted(text, "extra", "drop"))
    where = "--gradebook", tmp_path / "book", "--rubric", lab, "--jobs", 1, "--format", "json"
    done = grader("batch", tmp_path / "class", *where)
    data = json.loads(done.stdout)
    (anna,) = data["students"]
    assert (anna["status"], anna["score"], anna["max_score"], data["run"]["errored"]) == (
        "graded",
        6,
        11,
        0,
    )
