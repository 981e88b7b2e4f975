"""A lab of nodes in C++: an unedited draft of its solution finds its wrong variants, and takes nothing from correct ones."""

from pathlib import Path

import pytest

from grader.lab.grading.grade import grade
from grader.lab.rubric.rubric import Rubric, load_rubric
from grader.lab.submission.opening import open_submission
from tests.command_line import run
from tests.examples import spread
from tests.labs.variants import make_variant, variants_of

pytestmark = pytest.mark.slow

LAB = "beacon"
# The class of a component is no name of a program: the code of the node is wrong.
FAMILIES = {"w10-component-class": "code"}


@pytest.fixture(scope="module")
def rubric(tmp_path_factory: pytest.TempPathFactory) -> Rubric:
    """Return the draft of a rubric from the solution."""
    folder = tmp_path_factory.mktemp(LAB)
    solution = make_variant(LAB, "solution", folder)
    done = run(["rubric", "new", folder / "lab.toml", "--from", solution])
    assert done.returncode == 0, done.stderr
    return load_rubric(str(folder / "lab.toml"))


def statuses_of(rubric: Rubric, name: str, folder: Path) -> dict[str, str]:
    """Return the status of each criterion for a variant."""
    submission = open_submission(str(make_variant(LAB, name, folder)), rubric.lab)
    results = grade(rubric, submission).results
    return {it.criterion.id: it.outcome.status for it in results}


@pytest.mark.parametrize("name", spread([name for name in variants_of(LAB) if name[0] == "w"], 6))
def test_a_wrong_variant_fails_in_its_family(rubric: Rubric, name: str, tmp_path: Path) -> None:
    """The names of the family that is wrong do not agree."""
    family = FAMILIES.get(name, variants_of(LAB)[name].family)
    assert statuses_of(rubric, name, tmp_path)[f"{family}-names-agree"] == "failed"


@pytest.mark.parametrize("name", [name for name in variants_of(LAB) if name[0] == "r"])
def test_a_correct_variant_passes(rubric: Rubric, name: str, tmp_path: Path) -> None:
    """Constants, other names, initializer lists and other ways to spin are read as well."""
    assert set(statuses_of(rubric, name, tmp_path).values()) == {"passed"}
