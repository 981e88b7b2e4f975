"""What is kept of an earlier look at a workspace changes no result, and saves most of the work."""

import random
from collections.abc import Mapping
from typing import Any

import pytest

from grader.base.problems import Problem
from grader.base.reuse import Memory
from grader.files.reading import URDF_LIMIT
from grader.files.tree import make_tree, overlaid
from grader.ros.package.robot_file import Read
from grader.workspace.opening.all_robots import read_workspace
from tests.command_line import ROOT
from tests.nodes.test_inherited_nodes import BASE, TWO_PACKAGES
from tests.workspace.random_edits import Files, edited_files, edited_text, files_of

pytestmark = pytest.mark.slow

_WORKSPACES = [
    "rubrics/diffdrive",
    "rubrics/lab6",
    "rubrics/sensors",
    "tests/labs/beacon",
    "tests/labs/gripper",
    "tests/labs/laundry",
    "tests/labs/twolink",
]
_EMPTY = make_tree("ws", (), ())


def _found(files: Mapping[str, bytes], memory: Memory | None) -> list[Problem]:
    tree = overlaid(_EMPTY, files)
    opened = read_workspace(tree, "ws", URDF_LIMIT, {}, memory)
    found = opened.package_problems()
    for robot in opened.robots:
        if isinstance(robot, Read):
            found += opened.find_problems(robot)
    return found


def _compare(files: Files, count: int, draw: random.Random) -> None:
    """Look at a workspace after each of some edits, with what is kept and from nothing."""
    memory, now = Memory(10_000), files
    for number in range(count):
        assert _found(now, memory) == _found(now, None), number
        memory.forget_unused()
        now = edited_files(files if number % 5 == 4 else now, draw)


@pytest.mark.parametrize("folder", _WORKSPACES)
def test_equals_one_from_nothing(folder: str) -> None:
    _compare(files_of(ROOT / folder), 15, random.Random(folder))


@pytest.mark.exhaustive
@pytest.mark.parametrize("folder", _WORKSPACES)
def test_equals_one_from_nothing_often(folder: str) -> None:
    _compare(files_of(ROOT / folder), 60, random.Random(f"{folder}!"))


def twenty_packages() -> Files:
    """Return a workspace of 20 packages, each of which drives a robot of its own."""
    files: Files = {}
    for path, data in files_of(ROOT / "rubrics/diffdrive/diffdrive_robot").items():
        for number in range(20):
            name = f"rover{number}_robot"
            text = data.replace(b"diffdrive_robot", name.encode())
            files[f"src/{name}/{path.replace('diffdrive_robot', name)}"] = text
    return files


class _CountedMemory(Memory):
    """What is kept, with the number of results that were asked for and made."""

    def __init__(self) -> None:
        super().__init__(10_000)
        self.asked = self.made = 0

    def recall(self, key: Any, asked: Any, work: Any, make: Any) -> Any:
        self.asked += 1

        def counted(answers: Any) -> Any:
            self.made += 1
            return make(answers)

        return super().recall(key, asked, work, counted)


def test_a_change_of_one_package_is_little_work() -> None:
    """After a change in one of 20 packages, at most a fifth of what is kept is made again."""
    files, draw = twenty_packages(), random.Random(20)
    memory = _CountedMemory()
    _found(files, memory)
    memory.forget_unused()
    for path in sorted(path for path in files if path.startswith("src/rover7_robot/")):
        memory.asked = memory.made = 0
        _found({**files, path: edited_text(files[path], draw)}, memory)
        assert memory.made <= memory.asked / 5, path
        _found(files, memory)
        memory.forget_unused()


def test_a_base_in_a_package_that_is_not_declared_is_asked_for_again() -> None:
    """A change of the base class, or of its folder, changes the node of another package, whose files stay."""
    memory = Memory(10_000)
    for topic, folder in (("light", "base"), ("lamp", "base"), ("lamp", "bases")):
        texts = {**TWO_PACKAGES, "base/light/base.py": BASE.replace("'light'", f"'{topic}'")}
        files = {
            path.replace("base/", f"{folder}/", 1): text.encode() for path, text in texts.items()
        }
        opened = read_workspace(overlaid(_EMPTY, files), "ws", URDF_LIMIT, {}, memory)
        code = opened.workspace.code.by_package
        ends = code["lamp"].nodes[0].endpoints
        assert (topic, f"{folder}/light/base.py") in [(end.name, end.location.path) for end in ends]
        assert code["light"].nodes[0].location.path == f"{folder}/light/base.py"
