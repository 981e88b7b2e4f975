"""A lab of nodes without a robot: an unedited draft of its solution finds its wrong variants, and takes nothing from correct
ones.
"""

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

LAB = "laundry"
# What needs manual grading: another function makes the node.
PENDING = {
    "r04-spin-elsewhere": {
        "laundry-launch-py-publishes-node-runs",
        "laundry-launch-py-serves-node-runs",
    }
}


@pytest.fixture(scope="module")
def rubric(tmp_path_factory: pytest.TempPathFactory) -> Rubric:
    """Return the draft of a rubric from the solution."""
    folder = tmp_path_factory.mktemp("laundry")
    solution = make_variant(LAB, "solution", folder)
    done = run(["rubric", "new", folder / "lab.toml", "--from", solution])
    assert done.returncode == 0, done.stderr
    return load_rubric(str(folder / "lab.toml"))


def graded(rubric: Rubric, name: str, folder: Path) -> Report:
    """Return the report of a variant."""
    return grade(rubric, open_submission(str(make_variant(LAB, name, folder)), rubric.lab))


@pytest.mark.parametrize("name", spread([name for name in variants_of(LAB) if name[0] == "w"], 12))
def test_a_wrong_variant_loses_the_criterion_of_its_family(
    rubric: Rubric, name: str, tmp_path: Path
) -> None:
    """What follows from the mistake is not deducted, and the line of the mistake is in a file that was changed."""
    report = graded(rubric, name, tmp_path)
    [lost] = [it for it in report.results if it.points < it.criterion.points]
    assert report.max_score - report.score == lost.criterion.points
    variant = variants_of(LAB)[name]
    assert lost.criterion.id == f"{variant.family}-names-agree"
    assert lost.outcome.location is not None


@pytest.mark.parametrize("name", [name for name in variants_of(LAB) if name[0] == "r"])
def test_a_correct_variant_loses_nothing(rubric: Rubric, name: str, tmp_path: Path) -> None:
    """Names that are made in other ways are known; a node that is made elsewhere is left to a person."""
    results = graded(rubric, name, tmp_path).results
    statuses = {it.criterion.id: it.outcome.status for it in results}
    assert {it for it in statuses if statuses[it] == "pending"} == PENDING.get(name, set())
    assert set(statuses.values()) <= {"passed", "pending"}
