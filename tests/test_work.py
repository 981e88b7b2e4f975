"""The work of common commands, counted: the same on every machine. A limit is raised only for a reason, given here.

Each limit is about a tenth more than what was counted with Python 3.11; later versions make fewer calls.
"""

from pathlib import Path

import pytest

from grader.grading.grade import grade
from grader.grading.rubric import load_rubric
from grader.submission.opening import open_submission
from tests.command_line import ROOT, run
from tests.work import limited_work

PACKAGE = ROOT / "submissions/lab6/reference" / "roscourse_sim_ws" / "src" / "my_robot"
SYSTEM_CALLS = ("open", "read", "stat", "lstat", "fstat", "scandir", "listdir")
URDF = PACKAGE / "urdf" / "my_robot.urdf"


@pytest.mark.parametrize(("path", "limit"), [(URDF, 3_800), (PACKAGE, 17_500)], ids=["URDF", "package"])
def test_calls_of_a_grading(path: Path, limit: int) -> None:
    """The second grading with a rubric: what is done once for all submissions is not counted."""
    rubric = load_rubric("lab6")
    grade(rubric, open_submission(str(path), rubric.lab))
    with limited_work(limit):
        grade(rubric, open_submission(str(path), rubric.lab))


def test_system_calls_of_a_submission(tmp_path: Path) -> None:
    """What thirty single files need more than ten; the class before them loads the modules."""
    _grade(tmp_path / "before", 10)
    with limited_work(of=SYSTEM_CALLS) as few:
        _grade(tmp_path / "few", 10)
    with limited_work(of=SYSTEM_CALLS) as many:
        _grade(tmp_path / "many", 30)
    assert many.calls - few.calls <= 20 * 11


def _grade(folder: Path, count: int) -> None:
    folder.mkdir()
    for number in range(count):
        (folder / f"student-{number}.urdf").write_bytes(URDF.read_bytes())
    assert run(("batch", folder, "--gradebook", folder.with_suffix(".book"), "--jobs", "1")).returncode == 0
