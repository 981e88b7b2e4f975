"""The page computes the pose of every link as Python does."""

import json
from collections.abc import Callable, Iterator
from math import isfinite
from pathlib import Path
from random import Random
from typing import Any

import pytest

from grader.drawing.picture import Picture
from grader.drawing.scene import scene_of
from grader.errors import MissingElement, NotDecided
from grader.report.pages.model import picture_data
from grader.robot.frames import Position
from grader.robot.kinematics import Configuration
from grader.robot.model import Robot
from grader.robot.reader import read_urdf
from grader.submission.urdf import Read
from tests.browser.conftest import OpenPage
from tests.oracles.example_robots import URDFS
from tests.samples import ROOT, SAMPLES

pytestmark = pytest.mark.exhaustive
SCRIPT = ROOT / "grader" / "report" / "pages" / "files" / "kinematics.js"
MAX_ERROR = 1e-6  # metres, and of the entries of rotations
TIMES = 3  # random configurations of each robot

# What no sample has: mimic joints in a chain and in a loop, of a leader that is missing; an axis without direction; a planar and a
# floating joint; a loop of joints; two joints with one name; a frame in the middle of the tree.
ODD = """<robot name="odd">
<link name="a"/><link name="b"/><link name="c"/><link name="d"/><link name="e"/><link name="f"/><link name="g"/><link name="h"/>
<link name="i"/><link name="j"/><link name="k"/><link name="l"/><link name="m"/>
<joint name="lead" type="revolute"><parent link="a"/><child link="b"/><origin xyz="1 2 3" rpy="0.1 1.5707963267948966 -2"/>
  <axis xyz="1 2 -3"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
<joint name="one" type="prismatic"><parent link="b"/><child link="c"/><axis xyz="0 1 1"/><mimic joint="lead" multiplier="-2" offset="0.3"/>
  <limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
<joint name="two" type="continuous"><parent link="c"/><child link="d"/><axis xyz="0 0 -1"/><mimic joint="one" multiplier="0.5"/></joint>
<joint name="x" type="continuous"><parent link="d"/><child link="e"/><mimic joint="y" offset="1"/></joint>
<joint name="y" type="continuous"><parent link="e"/><child link="f"/><mimic joint="x" offset="2"/></joint>
<joint name="z" type="continuous"><parent link="f"/><child link="g"/><mimic joint="nowhere" offset="0.7"/></joint>
<joint name="flat" type="planar"><parent link="b"/><child link="h"/><axis xyz="0 0 1"/></joint>
<joint name="free" type="floating"><parent link="h"/><child link="i"/><origin xyz="0 0 1"/></joint>
<joint name="none" type="continuous"><parent link="b"/><child link="j"/><axis xyz="0 0 0"/></joint>
<joint name="lead" type="continuous"><parent link="j"/><child link="k"/><origin xyz="0 1 0"/><axis xyz="0 1 0"/></joint>
<joint name="l1" type="fixed"><parent link="l"/><child link="m"/></joint>
<joint name="l2" type="fixed"><parent link="m"/><child link="l"/></joint>
</robot>"""


def robots() -> Iterator[tuple[str, Robot]]:
    """Yield the sample robots with joints that move, each only once, the odd one, and some real ones."""
    seen: set[Robot] = set()
    for name, sample in SAMPLES.items():
        urdf = sample.open().urdf
        robot = urdf.reading.robot if isinstance(urdf, Read) else None
        if robot is not None and robot not in seen and any(joint.type != "fixed" for joint in robot.joints):
            seen.add(robot)
            yield name, robot
    texts = [("odd", ODD.encode()), *((path.name, path.read_bytes()) for path in URDFS[::6])]
    for name, text in texts:
        robot = read_urdf(text).robot
        if robot is not None and Configuration(robot).main_tree:
            yield name, robot


def cases(name: str, robot: Robot, random: Random) -> Iterator[dict[str, Any]]:
    """Yield a robot's data with random positions and the poses that Python computes, in the frames of its root and of its last link."""
    sizes = {"planar": 3, "floating": 6}  # the page leaves these joints where they are
    placed: dict[str, Position] = {
        joint.name: [random.uniform(-1, 1) for _ in range(sizes[joint.type])]
        for joint in robot.joints
        if joint.type in sizes
    }
    rest = Configuration(robot, placed)
    for frame in dict.fromkeys((rest.main_tree[0], rest.main_tree[-1])):
        data = picture_data(Picture(scene_of(rest, frame), None, (), (), ()))["robot"]
        for _ in range(TIMES):
            movable = [joint for joint in robot.joints if joint.type in ("revolute", "continuous", "prismatic")]
            free = [joint for joint in movable if joint.mimic is None or random.random() < 0.2]
            given: dict[str, Position] = {joint.name: random.uniform(-3, 3) for joint in free}
            moved = Configuration(robot, placed | given, holding=rest.parent_joints)
            poses = [_pose(moved, link, frame) for link in dict.fromkeys(link.name for link in robot.links)]
            yield {"name": name, "robot": data, "given": [*given.items()], "expected": poses}


def _pose(robot: Configuration, link: str, frame: str) -> list[float] | None:
    try:
        pose = robot.pose(link, relative_to=frame)
    except (MissingElement, NotDecided):
        return None
    values = [*pose.rotation, *pose.translation]
    return values if all(map(isfinite, values)) else None


COMPARE = """cases => cases.map(({name, robot, given, expected}) => {
  const found = posesOf(robot, new Map(given));
  return [name, Math.max(...expected.map((pose, k) => pose === null || found[k] === null ? (pose === found[k] ? 0 : 9)
    : Math.max(...pose.map((value, m) => Math.abs(value - found[k][m])))))];
})"""


def test_page_computes_the_poses_of_python(open_page: Callable[..., OpenPage], tmp_path: Path) -> None:
    """Every link of every robot, at random positions of its joints: the same place and direction, or none."""
    random = Random(6)
    asked = [case for name, robot in robots() for case in cases(name, robot, random)]
    file = tmp_path / "page.html"
    file.write_text(f"<!DOCTYPE html><title>k</title><script>{SCRIPT.read_text()}</script>")
    found = open_page(file).page.evaluate(COMPARE, json.loads(json.dumps(asked)))
    assert len(found) > 400
    assert sum(pose is not None for case in asked for pose in case["expected"]) > 2000
    assert [(name, error) for name, error in found if not error <= MAX_ERROR] == []
