"""Each edited copy of a submission has its own budget: its result does not depend on the copies that were graded before."""

from collections.abc import Sequence
from pathlib import Path

import pytest

from grader.lab.authoring.mutants import Mutant
from grader.lab.authoring.rubric_test import MutantOutcome, Trial, run_rubric_test
from grader.lab.grading.deciding import decide
from grader.lab.rubric.rubric import load_rubric
from grader.lab.submission.edited import with_urdf
from grader.lab.submission.submission import Submission
from grader.report.writers.rubric_test_result import render_rubric_test
from grader.ros.package.robot_file import Read
from tests.command_line import run
from tests.labs.variants import make_variant

pytestmark = pytest.mark.slow

_LABS = ("twolink", "laundry")  # a robot in xacro, and nodes


@pytest.fixture(scope="module")
def drafts(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Return the drafts of rubrics of labs with names that have to agree."""
    files = {}
    for lab in _LABS:
        folder = tmp_path_factory.mktemp(lab)
        solution = make_variant(lab, "solution", folder)
        files[lab] = folder / f"{lab}.toml"
        assert run(["rubric", "new", files[lab], "--from", solution]).returncode == 0
    return files


def _work_of(submission: Submission) -> tuple[int, ...]:
    """Return what was charged for a submission: to its URDF, its packages and all of its files."""
    of_packages = (package.budget.used for package in submission.packages)
    return (submission.budget.used, submission.packages[0].work.used, *of_packages)


def _charged(trial: Trial, mutant: Mutant) -> tuple[int, ...]:
    submission = trial.submission(mutant)
    if submission is None:
        return ()
    trial.results(mutant, submission)
    return _work_of(submission)


@pytest.mark.parametrize("lab", _LABS)
def test_a_mutant_is_charged_alike_whichever_comes_first(drafts: dict[str, Path], lab: str) -> None:
    """Forward, backward, and alone: the same work of URDF, packages and workspace."""
    rubric = load_rubric(str(drafts[lab]))
    trial = Trial(rubric)
    every = [*trial.mutants()]
    chosen = every[:: len(every) // 8]
    forward = [_charged(trial, mutant) for mutant in chosen]
    again = Trial(rubric)
    backward = [_charged(again, mutant) for mutant in reversed(chosen)]
    assert forward == backward[::-1]
    alone = [_charged(Trial(load_rubric(str(drafts[lab]))), mutant) for mutant in chosen]
    assert forward == alone
    assert len(set(forward)) > 1


@pytest.mark.parametrize("lab", _LABS[:1])
def test_a_copy_leaves_the_budget_of_the_submission(drafts: dict[str, Path], lab: str) -> None:
    """Hints, readings, mutants and equivalents edit the URDF by `with_urdf`: each copy pays for itself."""
    rubric = load_rubric(str(drafts[lab]))
    trial = Trial(rubric)
    before = _work_of(trial.reference)
    copies = []
    for _ in range(2):
        urdf = trial.reference.urdf
        assert isinstance(urdf, Read)
        copy = with_urdf(trial.reference, {urdf.path: urdf.data})
        assert [*decide(rubric, copy, trial.expected)] == [*trial.expected.values()]
        copies.append(_work_of(copy))
    assert _work_of(trial.reference) == before
    assert copies[0] == copies[1]
    assert copies[0][1] > 0


def test_what_takes_too_much_work_is_not_caught(drafts: dict[str, Path]) -> None:
    """With half of the work of the reference no names are compared: a mutant that loses nothing else counts for neither."""
    rubric = load_rubric(str(drafts["twolink"]))
    trial = Trial(rubric)
    work = trial.reference.packages[0].work
    work.grow(work.used // 2)

    def graded(mutants: Sequence[Mutant]) -> list[MutantOutcome]:
        return [trial.outcome(mutant) for mutant in mutants]

    result = run_rubric_test(rubric, None, lambda *_: None, graded, most=40)
    assert result.over_budget
    for loss in result.over_budget:
        assert loss.criteria
        assert all(
            "takes more work than one submission may use" in text for text in loss.criteria.values()
        )
    fates = (
        result.caught,
        result.same,
        *map(len, (result.survivors, result.ignored, result.over_budget)),
    )
    assert sum(fates) == result.tried == 40
    counted = sum(kind.graded for kind in result.kinds)
    assert counted == result.caught + len(result.survivors)
    text = render_rubric_test(result, 100)
    assert f", {len(result.over_budget)} over budget, " in text
    assert "These mutants take more work than one submission may use, and do not count:" in text
