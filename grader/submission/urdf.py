"""The URDF of a submission, as one of three states, and what ROS 2 makes of it: read as it is, or expanded by xacro."""

import re
from collections.abc import Collection, Mapping
from itertools import islice
from typing import TYPE_CHECKING, NamedTuple

from grader.names import closest
from grader.problems import Problem, causes, in_order
from grader.python.budget import Budget
from grader.robot.model import Robot
from grader.robot.reader import Reading, find_xacro, read_robot, read_urdf
from grader.robot.urdf_problems import RAW_XACRO
from grader.source import Source
from grader.xml.catalogue import DOCTYPE, NOT_WELL_FORMED

if TYPE_CHECKING:
    from grader.submission.surroundings import Surroundings

_MAX_COMPARED = 50  # links whose names are compared


class OtherCandidate(NamedTuple):
    """A file that could have been graded, and why another one is."""

    path: str
    reason: str


# These are no dataclasses: making each one takes 1 ms of the start of every command.


class Absent:
    """No file of the submission is a URDF."""

    __slots__ = ()


class Unreadable(NamedTuple):
    """The URDF is too large or damaged; `reason` is a sentence that names the file."""

    path: str
    reason: str


class Read(NamedTuple):
    """The URDF was read, even if ROS 2 rejects it; `reading` is of the expanded text if it is xacro.

    Of xacro that is loaded without xacro, `as_it_stands` is what ROS 2 makes of the text: whether it loads, and the
    verdict. The robot is that of `reading`, so that everything else is graded as if it had been expanded.
    """

    path: str
    data: bytes
    reading: Reading
    is_expanded: bool = False
    as_it_stands: Reading | None = None

    @property
    def loaded(self) -> Reading:
        """What ROS 2 loads."""
        return self.as_it_stands or self.reading

    @property
    def source(self) -> Source:
        """The text that the student wrote."""
        return Source(self.path, self.data.decode("utf-8", "replace")) if self.is_expanded else self.reading.source

    @property
    def problems(self) -> tuple[Problem, ...]:
        """Every problem of the file; of xacro that is loaded without xacro, those of the expanded text."""
        if self.as_it_stands is None:
            return self.reading.problems
        raw = [problem for problem in self.as_it_stands.problems if problem.kind is RAW_XACRO]
        return (*raw, *self.reading.problems)


Urdf = Absent | Unreadable | Read


def read_as_ros(data: bytes, path: str, surroundings: "Surroundings | None" = None) -> Read:
    """Read a URDF as ROS 2 gets it: expanded if a launch file runs xacro on it, or else if its name says xacro.

    Other xacro is loaded as it stands; unless that makes no
    difference, everything but that is graded on its expansion.
    """
    if not _needs_xacro(data):
        reading = read_urdf(data, path)
        if not any(problem.kind in (DOCTYPE, NOT_WELL_FORMED) for problem in reading.problems):
            return Read(path, data, reading)
    name = path.rpartition("/")[2].lower()
    if surroundings is None:
        from grader.submission.surroundings import Surroundings  # late: most URDFs are no xacro

        surroundings = Surroundings(Budget())
    launched = surroundings.robot_references(path)
    programs = {reference.by for reference in launched}
    if programs == {"xacro"} if programs else _says_xacro(name):
        given = dict(launched[0].arguments) if launched else {}
        return Read(path, data, _expand_xacro(data, path, surroundings, given), is_expanded=True)
    reading = read_urdf(data, path)
    if not any(problem.kind is RAW_XACRO for problem in reading.problems):
        return Read(path, data, reading)
    expanded = _expand_xacro(data, path, surroundings, {})
    if expanded.robot is None:
        return Read(path, data, reading)
    if reading.verdict == "clean":
        if _model(reading) == _model(expanded):
            return Read(path, data, reading)
        reading = reading._replace(verdict="degraded")  # ROS 2 ignores the tags of xacro, and what they stand for
    return Read(path, data, expanded, is_expanded=True, as_it_stands=reading)


def known_links(robot: Robot, wanted: Collection[str]) -> int:
    """Return how many of the wanted links a robot has, also under a similar name."""
    names = {link.name for link in robot.links}
    missing = set(wanted) - names
    others = islice(sorted(names.difference(wanted)), _MAX_COMPARED)
    similar = {closest(name, missing) for name in others} - {None} if missing else ()
    return len(wanted) - len(missing) + len(similar)


def is_another_robot(robot: Robot | None, wanted: Collection[str]) -> bool:
    """Return whether a completely known robot has fewer than half of the wanted links."""
    if robot is None or robot.incomplete or 2 * sum(map(robot.has_link, wanted)) >= len(wanted):
        return False  # without comparing names, which takes long
    return 2 * known_links(robot, wanted) < len(wanted)


def _says_xacro(name: str) -> bool:
    """Return whether xacro in a file of this name, in lower case, is meant to be expanded; standard input is a URDF."""
    return not name.endswith(".urdf") if ".xacro" in name else ".urdf" not in name and name != "-"


def _model(reading: Reading) -> tuple[object, ...]:
    """Return the links, shapes and joints that ROS 2 loads, without the masses: RViz needs none."""
    robot = reading.robot
    if robot is None:
        return ()
    links = {link.name: (link.visuals, link.collisions) for link in robot.links}
    return links, {joint.name: joint for joint in robot.joints}


def _needs_xacro(data: bytes) -> bool:
    """Return whether there is xacro in a text, outside of comments."""
    return (b"$" in data or b"xacro:" in data) and find_xacro(data.decode("utf-8", "replace")) is not None


def _expand_xacro(data: bytes, path: str, surroundings: "Surroundings", launched: Mapping[str, str | None]) -> Reading:
    """Return the robot that xacro makes of a file; where it cannot be expanded at all, what can be read of the text.

    The folder that a build installs a package in is called differently in launch files and in xacro. A file that the
    launch file names there and that no build certainly installs stays as it is: what is in it cannot be determined.
    """
    from grader.package.launch.places import SHARE  # late: most URDFs are no xacro
    from grader.xacro.expansion import expand
    from grader.xacro.texts import INSTALLED

    given = dict(launched)
    for name, text in launched.items():
        shared = re.fullmatch(rf"{SHARE}/([^/]+)/?(.*)", text or "")
        if shared is None:
            continue
        package, inside = shared.groups()
        if not inside or surroundings.package(package) is None or surroundings.installed(package, inside) is not None:
            given[name] = f"{INSTALLED}/{package}/share/{package}/{inside}".rstrip("/")
    expansion = expand(data, path, surroundings, {**given, **surroundings.arguments})
    if expansion.root is None and expansion.recovered is None and expansion.problems:
        raw = read_urdf(data, path)
        problems = [problem for problem in raw.problems if problem.kind not in (RAW_XACRO, NOT_WELL_FORMED)]
        return Reading("rejected", raw.robot, (*expansion.problems, *problems), raw.source)
    reading = read_robot(expansion.document)
    meant = read_robot(expansion.meant.document) if expansion.meant is not None else reading
    if not meant.is_meant or expansion.meant is None:
        return reading
    found = in_order([*causes(reading.problems), *expansion.assumed, *meant.problems])
    return meant._replace(verdict="rejected", problems=found)
