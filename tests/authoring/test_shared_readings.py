"""What mutants share, because it does not depend on the changed file, makes no difference."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from grader.lab.authoring.mutant_kinds import KindScore
from grader.lab.authoring.rubric_test import GROUP, Trial, run_rubric_test
from grader.lab.rubric.rubric import Rubric, load_rubric
from tests.command_line import run
from tests.labs.variants import make_variant

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def rubric(tmp_path_factory: pytest.TempPathFactory) -> Rubric:
    """Return the draft of a lab of nodes."""
    folder = tmp_path_factory.mktemp("laundry")
    solution = make_variant("laundry", "solution", folder)
    assert run(["rubric", "new", folder / "lab.toml", "--from", solution]).returncode == 0
    return load_rubric(str(folder / "lab.toml"))


def test_mutants_share_what_does_not_depend_on_their_file(rubric: Rubric) -> None:
    """One after the other, they fail the same criteria as each on its own."""
    shared = Trial(rubric)
    chosen = [*shared.mutants()][::37]
    together = [shared.outcome(mutant) for mutant in chosen]
    apart = [Trial(load_rubric(str(rubric.path))).outcome(mutant) for mutant in chosen]
    assert together == apart
    assert {outcome.fate for outcome in together} >= {"caught"}


def test_the_progress_is_told_after_each_group(rubric: Rubric, tmp_path: Path) -> None:
    """So the time left is that of whole groups."""
    told: list[int] = []

    def progress(done: int, total: int, scores: Sequence[KindScore]) -> None:
        assert total == 12
        assert scores
        told.append(done)

    def grade_all(mutants: Sequence[Any]) -> Any:
        return map(Trial(rubric).outcome, mutants)

    run_rubric_test(rubric, None, progress, grade_all, most=12)
    assert told == [GROUP, 2 * GROUP]
