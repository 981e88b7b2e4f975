"""What is kept of an earlier look at a workspace changes no result, and saves most of the work."""

import random
import re
from pathlib import Path

import pytest

from grader.base.problems import Problem
from grader.base.reuse import Memory
from grader.files.opening import open_tree
from grader.files.reading import URDF_LIMIT
from grader.files.tree import Tree, make_tree, overlaid
from grader.ros.package.robot_file import Read
from grader.ros.workspace.all_robots import read_workspace
from tests.command_line import ROOT

_WORKSPACES = [
    "rubrics/diffdrive",
    "rubrics/lab6",
    "rubrics/sensors",
    "tests/labs/beacon",
    "tests/labs/gripper",
    "tests/labs/laundry",
    "tests/labs/twolink",
]
_WORD = re.compile(rb"[\w.]+")
_EMPTY = make_tree("ws", (), ())
_Files = dict[str, bytes]


def _files_of(folder: Path) -> _Files:
    tree = open_tree(folder)
    assert tree is not None
    return {path: file.read(URDF_LIMIT) for path, file in tree.files.items()}


def _found(files: _Files, memory: Memory | None) -> list[Problem]:
    tree: Tree = overlaid(_EMPTY, files)
    opened = read_workspace(tree, "ws", URDF_LIMIT, {}, memory).of_release(None, "")
    found = opened.package_problems()
    for robot in opened.robots:
        if isinstance(robot, Read):
            found += opened.problems_of(robot)
    return found


def _edited(files: _Files, draw: random.Random) -> _Files:
    """Return the files after an edit such as people make: a word, a line, a file."""
    path = draw.choice(sorted(files))
    data = files[path]
    words = [found.span() for found in _WORD.finditer(data)] or [(0, 0)]
    start, end = draw.choice(words)
    other = draw.choice(sorted(files))
    lines = data.splitlines(keepends=True) or [b""]
    number = draw.randrange(len(lines))
    match draw.randrange(8):
        case 0:
            new = data[:start] + data[end:]
        case 1:
            a, b = draw.choice(words)
            new = data[:start] + data[a:b] + data[end:]
        case 2:
            new = b"".join(lines[:number] + lines[number + 1 :])
        case 3:
            new = b"".join(lines[: number + 1] + lines[number:])
        case 4:
            new = data[:start] + data[start:end][::-1] + data[end:]
        case 5:
            return {name: text for name, text in files.items() if name != path} or files
        case 6:
            return {**files, f"{path}.backup": data, f"{path[:-5]}x{path[-5:]}": files[other]}
        case _:
            new = data[:start]
    return {**files, path: new}


@pytest.mark.parametrize("folder", _WORKSPACES)
def test_equals_one_from_nothing(folder: str) -> None:
    draw = random.Random(folder)
    files = _files_of(ROOT / folder)
    memory, now = Memory(10_000), files
    for number in range(25):
        assert _found(now, memory) == _found(now, None), number
        memory.forget_unused()
        now = _edited(files if number % 5 == 4 else now, draw)
