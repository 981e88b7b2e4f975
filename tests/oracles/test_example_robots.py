"""The reader gives ROS 2's verdict on real robots."""

from pathlib import Path

import pytest

from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.reader import read_urdf
from tests.oracles.check_urdf import LYRICAL, check_urdf
from tests.oracles.example_robots import MISSING, URDFS, each_robot

pytestmark = pytest.mark.exhaustive


@each_robot
def test_verdict_is_that_of_ros(path: Path) -> None:
    """`check_urdf` and the reader agree; every problem has its location in the file."""
    data = path.read_bytes()
    read = read_urdf(data, path.name)
    oracle = check_urdf(data, seconds=20)
    assert read.verdict == oracle.verdict, (
        f"{oracle.stderr}\n{[problem.message for problem in read.problems]}"
    )
    lines = data.decode().split("\n")
    for problem in read.problems:
        at = problem.location
        assert lines[at.line - 1][at.column - 1 :], problem


@each_robot
def test_verdict_is_that_of_lyrical(path: Path) -> None:
    """`check_urdf` of Lyrical and the reader of its release agree."""
    data = path.read_bytes()
    oracle = check_urdf(data, seconds=20, release=LYRICAL)
    assert read_urdf(data, path.name, (LYRICAL,)).verdict == oracle.verdict, oracle.stderr


@each_robot
def test_every_link_of_a_robot_that_loads_has_a_pose(path: Path) -> None:
    """One root, and a pose in its frame for each link."""
    read = read_urdf(path.read_bytes(), path.name)
    if read.verdict == "rejected":
        return
    assert read.robot is not None
    configuration = Configuration(read.robot)
    assert len(configuration.roots) == 1
    for link in read.robot.links:
        configuration.pose(link.name)


@pytest.mark.skipif(not URDFS, reason=MISSING)
def test_there_are_enough_robots() -> None:
    """The data contains at least fifty robots, most of which load."""
    assert len(URDFS) >= 50
    verdicts = [read_urdf(path.read_bytes()).verdict for path in URDFS]
    assert verdicts.count("rejected") <= 0.1 * len(verdicts)
