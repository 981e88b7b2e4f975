"""The fixes of problems: what they are, and that reports never ask for them."""

import pickle
import shutil
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest

from grader import grade
from grader.base.element_edits import edited
from grader.base.problems import NO_FIXES, Fix, Fixes, Problem
from grader.base.source import Edit
from grader.files.tree import make_tree, overlaid
from grader.report.formats import InspectFormat
from grader.workspace.api import read_workspace
from tests.command_line import run
from tests.samples import ROOT

_SAMPLE = ROOT / "submissions/diffdrive/joint-misspelt"
_DIFFDRIVE = ROOT / "rubrics/diffdrive/diffdrive_robot"
_LAB6 = ROOT / "submissions/lab6/reference/roscourse_sim_ws/src/my_robot"
_URDF = "diffdrive_robot/urdf/diffdrive.urdf.xacro"
# A process that asks for a fix ends with this code.
_ASKED = 77
_STOPPING = f"""\
import os
import sys
from grader.base import problems
problems.Fixes.__iter__ = lambda self: os._exit({_ASKED})
"""


def _problems(folder: Path = _SAMPLE, changed: Mapping[str, str] = {}) -> list[Problem]:
    """Return what is wrong in the packages of a folder, some of whose files have other texts."""
    files = {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file()
    }
    for path, text in changed.items():
        files[path] = text.encode()
    tree = overlaid(make_tree("ws", (), ()), files)
    return read_workspace(tree, "ws", 1_000_000, {}).package_problems()


@pytest.fixture(scope="module")
def sample(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a submission with a misspelt name, and a misspelt attribute of its robot.

    Reports list the attribute as a problem, which has a fix.
    """
    folder = tmp_path_factory.mktemp("class") / "ada"
    shutil.copytree(_SAMPLE, folder)
    text = (folder / _URDF).read_text()
    assert ' size="' in text
    (folder / _URDF).write_text(text.replace(' size="', ' siz="', 1))
    report = grade(folder, rubric="diffdrive")
    assert any([*problem.fixes] for problem in report.problems)
    return folder


def _no_fix(_: Fixes) -> Iterator[Fix]:
    raise AssertionError("nothing that is printed asks for a fix")


def test_a_misspelt_name_has_a_fix_where_it_is_used() -> None:
    [problem] = [each for each in _problems() if each.severity == "error"]
    [fix] = problem.fixes
    at = problem.location
    right = "left_wheel_joint"
    assert fix.edits == (Edit(at.path, at.line, at.column, "wheel_left_joint", right),)
    assert fix.assumption == f"'wheel_left_joint' is read as '{right}'"
    assert problem.related is not None


def test_fixes_take_no_part_in_what_a_problem_is() -> None:
    """It is equal to itself without them, and its copy in another process has none."""
    [problem] = [each for each in _problems() if each.severity == "error"]
    plain = problem._replace(fixes=NO_FIXES)
    assert (problem, hash(problem)) == (plain, hash(plain))
    copy = pickle.loads(pickle.dumps(problem))
    assert copy == problem
    assert ([*problem.fixes] != [], [*copy.fixes]) == (True, [])


def test_fixes_are_computed_once_and_when_they_are_asked_for() -> None:
    asked = []

    def compute() -> list[Fix]:
        asked.append(1)
        return [Fix((), "nothing")]

    fixes = Fixes(compute)
    assert asked == []
    assert [*fixes] == [*fixes] == [Fix((), "nothing")]
    assert asked == [1]


@pytest.mark.slow
@pytest.mark.parametrize("form", InspectFormat)
def test_no_inspection_asks_for_a_fix(
    form: InspectFormat, sample: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    words = ("inspect", sample, "--format", form)
    expected = run(words).stdout
    monkeypatch.setattr(Fixes, "__iter__", _no_fix)
    assert run(words).stdout == expected


@pytest.mark.parametrize(
    ("path", "right", "wrong", "code"),
    [
        ("launch/my_robot_rviz.launch.py", "description():\n", "description()\n", "LCH001"),
        ("setup.py", "from glob import", "form glob import", "PKG010"),
        ("rviz/my_robot.rviz", "Enabled: true\n", "Enabled:true\n", "RVZ001"),
        ("scripts/drive_circle.py", "def send(self):\n", "def send(self)\n", "REF015"),
        ("scripts/drive_circle.py", "0.1, self.send)", "0.1, self.send())", "REF015"),
        ("scripts/drive_circle.py", "self.publisher.pub", "self.publsher.pub", "REF015"),
    ],
)
def test_what_is_wrong_in_a_file_has_a_fix(path: str, right: str, wrong: str, code: str) -> None:
    """In the syntax of Python and of YAML, and in the code of a node."""
    package = _DIFFDRIVE if path.startswith("scripts/") else _LAB6
    text = (package / path).read_text()
    assert right in text
    broken = text.replace(right, wrong, 1)
    [problem] = [each for each in _problems(package, {path: broken}) if each.code == code]
    [fix] = problem.fixes
    assert edited(broken, path, fix.edits) == text
