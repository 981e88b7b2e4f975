"""Labs of actions and of an arm in Gazebo: an unedited draft finds each wrong variant, and takes nothing from correct ones."""

from functools import cache
from pathlib import Path

import pytest

from grader.lab.grading.grade import grade
from grader.lab.grading.report import Report
from grader.lab.rubric.rubric import Rubric, load_rubric
from grader.lab.submission.opening import open_submission
from tests.command_line import run
from tests.examples import spread
from tests.labs.variants import make_variant, variants_of

pytestmark = pytest.mark.slow

LABS = ("courier", "docking", "lifter")


def names_of(kind: str) -> list[tuple[str, str]]:
    """Return the labs with their variants of a kind: w for wrong ones, r for right ones."""
    return [(lab, name) for lab in LABS for name in variants_of(lab) if name[0] == kind]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder for the drafts."""
    return tmp_path_factory.mktemp("drafts")


@cache
def draft_of(lab: str, folder: Path) -> Rubric:
    """Return the draft of a rubric from the solution of a lab."""
    solution = make_variant(lab, "solution", folder)
    path = folder / f"{lab}.toml"
    assert run(["rubric", "new", path, "--from", solution]).returncode == 0
    return load_rubric(str(path))


def graded(lab: str, name: str, folder: Path, tmp_path: Path) -> Report:
    """Return the report of a variant."""
    rubric = draft_of(lab, folder)
    return grade(rubric, open_submission(str(make_variant(lab, name, tmp_path)), rubric.lab))


@pytest.mark.parametrize(("lab", "name"), spread(names_of("w"), 15))
def test_a_wrong_variant_loses_points(lab: str, name: str, folder: Path, tmp_path: Path) -> None:
    """And nothing is left to a person."""
    report = graded(lab, name, folder, tmp_path)
    assert report.score < report.max_score
    assert report.pending == 0


@pytest.mark.parametrize(("lab", "name"), names_of("r"))
def test_a_correct_variant_loses_nothing(lab: str, name: str, folder: Path, tmp_path: Path) -> None:
    """Whatever its structure, its launch files and the names that are free."""
    report = graded(lab, name, folder, tmp_path)
    assert report.score == report.max_score
    assert report.pending == 0
