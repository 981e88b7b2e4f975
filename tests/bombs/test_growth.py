"""What asks for more work than its size: the work of each reader and each join grows as its input, or ends at the budget."""

from collections.abc import Callable
from math import log2
from pathlib import Path

import pytest

from grader.files.reading import URDF_LIMIT
from grader.lab.grading.grade import grade
from grader.lab.rubric.rubric import load_rubric
from grader.lab.submission.opening import open_submission
from grader.ros.package.robot_file import Read
from grader.ros.python import budget
from grader.workspace.opening.opening import open_workspace
from tests.bombs.files import Files, package
from tests.bombs.findings import BOMBS
from tests.bombs.long_texts import LONG_TEXTS
from tests.examples import spread
from tests.work import counted_work, hang_limit

pytestmark = pytest.mark.slow

_SIZE = 150
_MOST = 1.2  # the power of the size with which the work may grow
_TINY = 5_000  # parts, in place of those that each submission may use whatever its size
_RUBRIC = "diffdrive"


def _written(folder: Path, files: Files) -> str:
    for path, text in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text)
    return str(folder)


def _inspect(folder: str) -> None:
    opened = open_workspace(folder, URDF_LIMIT, {})
    opened.package_problems()
    opened.extent()
    for robot in opened.robots:
        if isinstance(robot, Read):
            opened.driven_joints(robot)


def _grade(folder: str) -> None:
    rubric = load_rubric(_RUBRIC)
    grade(rubric, open_submission(folder, rubric.lab))


@pytest.mark.parametrize("read", [_inspect, _grade])
@pytest.mark.parametrize("name", spread(BOMBS, 8))
def test_work_grows_as_the_input(
    name: str,
    read: Callable[[str], None],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Twice the input takes at most 2.3 times the work, beyond that of an empty package."""
    monkeypatch.setattr(budget, "_OF_WORKSPACE", _TINY)
    monkeypatch.setattr(budget, "_OF_PACKAGE", _TINY // 40)
    inputs = {"empty": package(), "one": BOMBS[name](_SIZE), "two": BOMBS[name](2 * _SIZE)}
    folders = {size: _written(tmp_path / size, files) for size, files in inputs.items()}
    read(folders["empty"])  # what is loaded once
    work = {}
    for size, folder in folders.items():
        with counted_work() as counted:
            read(folder)
        work[size] = counted.steps
    one, two = (work[size] - work["empty"] for size in ("one", "two"))
    assert log2(max(two, 1) / max(one, work["empty"])) < _MOST


@pytest.mark.parametrize("read", [_inspect, _grade])
@pytest.mark.parametrize("name", LONG_TEXTS)
def test_a_long_text_hangs_nothing(name: str, read: Callable[[str], None], tmp_path: Path) -> None:
    """A text that takes some 0.3 s is not what hangs: each took 4 s and more, most of them minutes."""
    folder = _written(tmp_path, LONG_TEXTS[name])
    with hang_limit(4.0):
        read(folder)
