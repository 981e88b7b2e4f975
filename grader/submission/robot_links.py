"""The links of robots that may be graded: how many of those that a lab names, and so whether it is another robot."""

from collections.abc import Sequence
from typing import NamedTuple

from grader.errors import InputError, NotDecided
from grader.files.tree import Tree
from grader.package.package import Package
from grader.robot.model import Robot
from grader.static_python.budget import Budget
from grader.submission.packages import package_around
from grader.submission.robots import RobotFile
from grader.submission.submission import Lab, Opening
from grader.submission.surroundings import Surroundings
from grader.submission.urdf import is_another_robot, known_links, read_as_ros

_MAX_READ = 4 * 1024 * 1024  # bytes of all candidates
_COST_OF_FILE = 64 * 1024  # bytes that take as long to read as the smallest file


class RobotLinks(NamedTuple):
    """How many links a robot has, of those that the lab names unless it `is_another`; all if the lab names none."""

    is_another: bool = False
    links: int = 0
    is_nameless: bool = False


def count_links(
    tree: Tree, lab: Lab, robots: Sequence[RobotFile], packages: tuple[Package, ...], opening: Opening
) -> dict[str, RobotLinks]:
    """Return the links of each robot, expanded by xacro, by its path; of very many only the first are read."""
    budget, left = Budget(), _MAX_READ
    found: dict[str, RobotLinks] = {}
    for robot in robots:
        left -= min(robot.size, opening.max_size) + _COST_OF_FILE
        if left < 0:
            found[robot.path] = RobotLinks(is_another=bool(lab.links))
            continue
        around = package_around(packages, robot.path)
        known = (around, *packages) if around is not None else packages
        surroundings = Surroundings(budget, tree, around, known, opening.arguments)
        try:
            reading = read_as_ros(tree.files[robot.path].read(opening.max_size), robot.path, surroundings).reading
            found[robot.path] = _links_of(reading.robot, robot.robot, lab, is_open=bool(reading.undetermined))
        except (InputError, NotDecided):  # it may be the robot of the lab
            found[robot.path] = RobotLinks()
    return found


def _links_of(robot: Robot | None, name: str, lab: Lab, *, is_open: bool) -> RobotLinks:
    if robot is None:
        return RobotLinks() if is_open else RobotLinks(is_another=bool(lab.links), is_nameless=not name)
    is_another = is_another_robot(robot, lab.links)
    counted = len(robot.links) if is_another or not lab.links else known_links(robot, lab.links)
    return RobotLinks(is_another, counted, not robot.name)
