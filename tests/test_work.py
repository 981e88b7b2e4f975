"""The work of a grading, counted: the same on every machine. The limits are ten times what was counted."""

from pathlib import Path

import pytest

from grader.lab.grading.grade import grade
from grader.lab.rubric.rubric import load_rubric
from grader.lab.submission.opening import open_submission
from tests.command_line import ROOT
from tests.work import limited_work

PACKAGE = ROOT / "submissions/lab6/reference" / "roscourse_sim_ws" / "src" / "my_robot"
URDF = PACKAGE / "urdf" / "my_robot.urdf"


@pytest.mark.parametrize(
    ("path", "limit"), [(URDF, 35_000), (PACKAGE, 160_000)], ids=["URDF", "package"]
)
def test_calls_of_a_grading(path: Path, limit: int) -> None:
    """The second grading with a rubric: what is done once for all submissions is not counted."""
    rubric = load_rubric("lab6")
    grade(rubric, open_submission(str(path), rubric.lab))
    with limited_work(limit):
        grade(rubric, open_submission(str(path), rubric.lab))
