"""The sample submissions: the reference and its equivalents get full marks, each mistake loses just what it should."""

import tomllib
from pathlib import Path

import pytest

from grader.grading.grade import grade
from grader.grading.rubric import load_rubric, shipped_rubrics
from grader.submission.submission import open_submission

SAMPLES = Path(__file__).parent.parent / "submissions"
NAMES = sorted(path.parent.name for path in SAMPLES.glob("*/expected.toml"))
RUBRIC = load_rubric("lab6")  # of the samples that name no other


@pytest.mark.parametrize("name", NAMES)
def test_a_sample_loses_exactly_what_it_should(name: str) -> None:
    """The verdict and the criteria that do not pass are those that stand beside the sample."""
    expected = tomllib.loads((SAMPLES / name / "expected.toml").read_text(encoding="utf-8"))
    rubric = load_rubric(expected.get("rubric", RUBRIC.id))
    report = grade(rubric, open_submission(str(SAMPLES / name), wanted=rubric.urdf))
    assert report.submission.urdf.verdict == expected["verdict"]
    lost = [result.criterion.id for result in report.results if result.outcome.status != "passed"]
    assert lost == expected["lost"]
    assert {result.outcome.status for result in report.results} <= {"passed", "failed", "skipped"}


def test_there_are_samples_enough() -> None:
    """Five equivalents and fifteen mistakes at the least; only the reference and the equivalents get full marks."""
    full = {name for name in NAMES if not tomllib.loads((SAMPLES / name / "expected.toml").read_text())["lost"]}
    assert full == {name for name in NAMES if name == "reference" or name.startswith("equivalent-")}
    assert len(full) >= 6
    assert len(NAMES) - len(full) >= 15


@pytest.mark.parametrize("name", shipped_rubrics())
def test_a_reference_gets_full_marks(name: str) -> None:
    """Every rubric that comes with the grader has a reference solution, which passes all of it."""
    rubric = load_rubric(name)
    report = grade(rubric, open_submission(str(rubric.path.parent / rubric.reference), wanted=rubric.urdf))
    assert report.score == report.max_score == rubric.points


def test_the_rubric_carries_the_reference() -> None:
    """The rubric's reference solution is the sample of that name, byte for byte."""
    reference = RUBRIC.path.parent / RUBRIC.reference / RUBRIC.urdf
    assert reference.read_bytes() == (SAMPLES / "reference/my_robot/urdf/my_robot.urdf").read_bytes()


@pytest.mark.parametrize("name", NAMES)
def test_a_skip_names_a_criterion_that_failed(name: str) -> None:
    """What is skipped is due to a criterion above it that failed itself."""
    report = grade(RUBRIC, open_submission(str(SAMPLES / name), wanted=RUBRIC.urdf))
    failed: set[str] = set()
    for result in report.results:
        if result.outcome.status == "skipped":
            assert result.because in failed
        elif result.outcome.status == "failed":
            failed.add(result.criterion.id)
