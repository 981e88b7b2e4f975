"""Robots as `grader inspect` shows them.

This is problems, tree, joints and poses, and what is wrong in packages.
"""

from collections import Counter
from collections.abc import Iterable, Iterator
from itertools import islice
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING

from grader.base.errors import MissingElement, NotDecided
from grader.base.grouping import Strings
from grader.base.problems import Problem
from grader.base.records import Record
from grader.base.source import Base, Source, SourceOf
from grader.base.text import counted, printable
from grader.base.transforms import Transform
from grader.report.causes import SEVERITIES, in_order_of_severity
from grader.report.readings import UNDECIDED, VERDICTS
from grader.ros.api import Configuration, Joint, Reading

if TYPE_CHECKING:
    from grader.ros.api import MeshLoader, Unreadable
    from grader.workspace.api import DescribedRecording, Extent, LogAnswer

MAX_LISTED = 500  # links, or problems on a page
_MAX_INDENT = 60
EFFECTS = {
    **{verdict: text.replace("the file", "it") for verdict, text in VERDICTS.items()},
    "undecided": UNDECIDED,
}


NO_FAILURE = "no line of the log says that something fails"
_NO_BASE = Base(is_outside=True)


class InspectedRobot(Record):
    """A URDF as read, with its joints at given positions.

    Without `configuration`, ROS 2 reads nothing.
    """

    path: str
    reading: Reading
    configuration: Configuration | None = None
    relative_to: str | None = None
    hidden: frozenset[Problem] = frozenset()  # its problems that are ignored
    driving: str = ""  # how it stands and drives, if a controller or a plugin names its wheels
    wheels: Strings = ()  # the links of these wheels
    meshes: "MeshLoader | None" = None  # loads its meshes for pictures

    @property
    def verdict(self) -> str:
        """ROS 2's verdict; `undecided` where it cannot be determined statically."""
        return self.reading.verdict if self.reading.is_certain else "undecided"

    @property
    def problems(self) -> tuple[Problem, ...]:
        """What is wrong with it, and not ignored."""
        return tuple(problem for problem in self.reading.problems if problem not in self.hidden)

    @property
    def is_passed(self) -> bool:
        """Return whether ROS 2 loads it, as far as problems are not ignored."""
        if self.verdict not in ("rejected", "undecided"):
            return True
        return self.hidden != frozenset() and all(
            problem.kind.effect not in ("rejects", "undetermined") for problem in self.problems
        )

    @property
    def name(self) -> str:
        """The name of the robot in words."""
        if not self.configuration:
            return "no robot"
        return f"robot {self.configuration.robot.name!r}"

    def poses(self) -> Iterator[tuple[str, Transform | str]]:
        """Yield the pose of every link in the frame `relative_to`, in file order.

        If a link has none, yield the reason.
        """
        robot = self.configuration
        if not robot or self.relative_to is None:
            return
        for link in robot.robot.links:
            try:
                yield link.name, robot.pose(link.name, relative_to=self.relative_to)
            except (MissingElement, NotDecided) as reason:
                yield link.name, str(reason)


class Inspection(Record):
    """The robots at a path, and what is wrong with the files and names of its packages.

    `extent` is what was read of a workspace; None for a URDF on its own.
    """

    path: str
    robots: tuple[InspectedRobot, ...] = ()
    package_problems: tuple[Problem, ...] = ()
    extent: "Extent | None" = None
    source_of: SourceOf | None = None
    base: Base = _NO_BASE  # its place in a repository
    besides: tuple[Path, ...] = ()  # the files that were read besides a single one
    ignored: int = 0  # how many problems are ignored, and not among these
    known: int = 0  # how many are known from a baseline, and not among these either
    log: "tuple[LogAnswer, ...] | None" = None  # what is said of a log; None without one
    recordings: "tuple[DescribedRecording, ...]" = ()
    is_posed: bool = False  # whether positions of joints, or a frame of poses, are given
    unread: "tuple[Unreadable, ...]" = ()  # the robots that cannot be read

    @property
    def robot(self) -> InspectedRobot | None:
        """The robot that is shown whole: the only one."""
        return self.robots[0] if len(self.robots) == 1 else None

    @property
    def is_passed(self) -> bool:
        """Return whether ROS 2 loads all robots, and nothing else is certainly wrong."""
        severities = {problem.severity for problem in self.package_problems}
        return "error" not in severities and all(robot.is_passed for robot in self.robots)

    @property
    def has_no_readable_robot(self) -> bool:
        """Return whether there are robots, and none of them can be read."""
        return self.unread != () and not self.robots

    @property
    def problems(self) -> tuple[Problem, ...]:
        """The problems of the robots and of packages, errors first, then by file and line."""
        robot_problems = [problem for robot in self.robots for problem in robot.problems]
        return in_order_of_severity([*dict.fromkeys(robot_problems), *self.package_problems])

    def source(self, path: str) -> Source | None:
        """Return the text of a file, for quoting."""
        for robot in self.robots:
            if robot.reading.source.path == path:
                return robot.reading.source
        return self.source_of(path) if self.source_of is not None else None


def main_root(robot: Configuration) -> str | None:
    """Return the root of the largest tree; None if every link is in a loop."""
    return next(iter(robot.main_tree), None)


def lists(robot: InspectedRobot | None) -> Iterator[tuple[str, list[tuple[str, str]]]]:
    """Yield the links of a robot as a tree with their joints, and their poses.

    Each is a title, and names with words about each.
    """
    if not robot or robot.configuration is None or robot.relative_to is None:
        return  # there is neither a tree nor a frame
    links = _tree(robot.configuration)
    yield (
        "Tree",
        _first_rows((indent + printable(link), joint_text(joint)) for indent, link, joint in links),
    )
    title = f"Poses in {printable(robot.relative_to)!r} (x y z in m, roll pitch yaw in rad)"
    yield (
        title,
        _first_rows((printable(link), f"  {pose_text(pose)}") for link, pose in robot.poses()),
    )


def _first_rows(rows: Iterator[tuple[str, str]]) -> list[tuple[str, str]]:
    shown = list(islice(rows, MAX_LISTED))
    rest = sum(1 for _ in rows)
    if rest:
        return [*shown, (f"... and {rest} more", " (--format json lists all)")]
    return shown


def log_line(answer: "LogAnswer") -> str:
    """Return what is said of a message of a log, in one line."""
    place = f"line {answer.line} of the log: {printable(answer.message)}"
    if not answer.location:
        return place
    where = printable(answer.location.file_and_line)
    if answer.relation == "see also":
        return f"see also {where} for {place}"
    return f"{where} {answer.relation} {place}"


def effect(inspection: Inspection) -> str:
    """Return what ROS 2 does with the only robot; else how many problems there are."""
    if inspection.robot:
        return EFFECTS[inspection.robot.verdict]
    return problem_counts(inspection)


def count_severities(problems: Iterable[Problem]) -> str:
    """Return how many errors, warnings and notes there are; empty without any."""
    counts = Counter(problem.severity for problem in problems)
    return ", ".join(counted(counts[name], name) for name in SEVERITIES if counts[name])


def problem_counts(inspection: Inspection) -> str:
    """Return how many errors, warnings and notes an inspection has."""
    counts = count_severities(inspection.problems)
    if counts:
        return counts
    if inspection.ignored or inspection.known:
        return "no other problems"
    if inspection.recordings and not inspection.robots and not inspection.extent:
        return counted(len(inspection.recordings), "recording")
    if inspection.extent and not inspection.extent.is_whole:
        return "no problems in what was read"
    return "the names agree"


def choose_look(inspection: Inspection) -> str:
    """Return the verdict whose look the whole has.

    This is that of the only robot, else the worst of all.
    """
    verdicts = {robot.verdict for robot in inspection.robots}
    if not inspection.robot and not inspection.is_passed:
        return "rejected"
    return next((verdict for verdict in reversed(EFFECTS) if verdict in verdicts), "clean")


def robot_line(robot: InspectedRobot) -> str:
    """Return a robot of several in a line: its name, and how many links and joints it has."""
    words = [EFFECTS[robot.verdict], printable(robot.name)]
    if robot.configuration:
        model = robot.configuration.robot
        words += [counted(len(model.links), "link"), counted(len(model.joints), "joint")]
    return ", ".join(words)


def _tree(robot: Configuration) -> Iterator[tuple[str, str, Joint | None]]:
    """Yield every link after its parent: its indentation, its name, and its parent joint."""
    children: dict[str, list[Joint]] = {}
    for joint in robot.parent_joints.values():
        children.setdefault(joint.parent, []).append(joint)
    stack: list[tuple[str, str, Joint | None]] = [
        ("", root, None) for root in reversed(robot.roots)
    ]
    while stack:
        yield (link := stack.pop())
        indent = f"{link[0]}  " if len(link[0]) < _MAX_INDENT else link[0]
        stack += [(indent, joint.child, joint) for joint in reversed(children.get(link[1], []))]


def joint_text(joint: Joint | None) -> str:
    """Return a joint in words; empty for the parent joint of a root."""
    if not joint:
        return ""
    words = f"  {printable(joint.name)}: {printable(joint.type) or 'no type'}"
    if joint.type not in ("fixed", "floating"):
        words += (
            f" about {_numbers(joint.axis)}"
            if joint.axis is not None
            else " about an unreadable axis"
        )
    limit = joint.limit if joint.type in ("revolute", "prismatic") else None
    if limit and isfinite(limit.upper - limit.lower):
        words += f", {limit.lower:g}..{limit.upper:g}"
    if joint.mimic:
        words += f", mimics {printable(joint.mimic.joint)}"
    return words


def pose_text(pose: Transform | str) -> str:
    """Return a pose, x y z in m and roll pitch yaw in rad, or the reason why there is none."""
    if isinstance(pose, str):
        return printable(pose)
    return f"{_numbers(pose.translation)}  rpy {_numbers(pose.rpy)}"


def _numbers(values: tuple[float, ...]) -> str:
    return " ".join(f"{round(value, 4) + 0.0:g}" for value in values)
