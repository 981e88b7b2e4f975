"""The sample submissions: the reference and its equivalents get full marks, each mistake loses its criteria."""

import filecmp

import pytest

from grader.grading.grade import grade
from grader.grading.rubric import load_rubric, shipped_rubrics
from grader.submission.opening import open_submission
from grader.submission.urdf import Read
from tests.samples import LAB6, ROOT, SAMPLES

every_sample = pytest.mark.parametrize("name", SAMPLES)
REFERENCE = "submissions/reference/roscourse_sim_ws/src/my_robot"


@every_sample
def test_a_sample_loses_the_expected_criteria(name: str) -> None:
    """The verdict, the criteria that cost points and those that are carried forward are those in expected.toml."""
    sample = SAMPLES[name]
    report = sample.grade()
    urdf = sample.open().urdf
    assert (urdf.loaded.verdict if isinstance(urdf, Read) else "missing") == sample.expected.verdict
    statuses = {result.criterion.id: result.outcome.status for result in report.results}
    carried = [result.criterion.id for result in report.results if result.carried]
    lost = [name for name, status in statuses.items() if status in ("failed", "skipped") and name not in carried]
    assert lost == list(sample.expected.lost)
    assert carried == list(sample.expected.carried)
    costly = [result.criterion for result in report.results if result.criterion.id in (*lost, *sample.expected.pending)]
    assert report.max_score - report.score == sum(criterion.points for criterion in costly)
    assert [name for name, status in statuses.items() if status == "pending"] == list(sample.expected.pending)
    assert "errored" not in statuses.values()


def test_there_are_enough_samples() -> None:
    """At least five equivalents and fifteen mistakes; only the reference and the equivalents lose nothing."""
    full = {name for name, sample in SAMPLES.items() if not sample.expected.lost and len(sample.expected.pending) < 4}
    assert full == {name for name in SAMPLES if name.startswith(("reference", "equivalent-"))}
    assert len(full) >= 6
    assert len(SAMPLES) - len(full) >= 15


@pytest.mark.parametrize("name", shipped_rubrics())
def test_a_reference_gets_full_marks(name: str) -> None:
    """The reference solution of every shipped rubric passes all criteria that need no manual grading."""
    rubric = load_rubric(name)
    path = str(rubric.path.parent / rubric.reference)
    report = grade(rubric, open_submission(path, wanted=rubric.urdf, package=rubric.package, folders=rubric.folders))
    assert report.max_score == rubric.points
    assert report.score + report.pending == rubric.points
    assert report.problems == ()


def test_the_rubric_contains_the_reference() -> None:
    """The rubric's reference solution equals the package of the sample of that name, byte for byte."""
    compared = filecmp.dircmp(LAB6.path.parent / LAB6.reference, ROOT / REFERENCE, ignore=["__pycache__"])
    waiting = [compared]
    while waiting:
        folders = waiting.pop()
        assert not (folders.left_only or folders.right_only or folders.diff_files), folders.left
        waiting += folders.subdirs.values()


@every_sample
def test_a_skip_names_a_criterion_that_failed(name: str) -> None:
    """A skip is caused by an earlier criterion that failed itself."""
    failed: set[str] = set()
    for result in SAMPLES[name].grade().results:
        if result.outcome.status == "skipped":
            assert result.because in failed
        elif result.outcome.status == "failed":
            failed.add(result.criterion.id)
