"""The robots with which the names in a file are compared.

They are those that the file's launch files start, or those of packages that have to do with that
of the file. A file may name what another robot of the workspace has, and not mean it.
"""

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from functools import cache, cached_property, lru_cache
from itertools import chain

from grader.base.records import Named
from grader.base.text import quoted
from grader.ros.installation.places import share_parts
from grader.ros.launch.launch_model import Launch
from grader.ros.package.finding import package_around
from grader.ros.package.package import Package
from grader.workspace.model.known_robots import KnownRobot
from grader.workspace.model.launches import list_spawned
from grader.workspace.model.workspace import Workspace

# First words of names of packages that say nothing of the robot.
_ANY_ROBOT = frozenset({"ros", "ros2", "robot", "simple", "test", "demo", "example"})


class ComparedRobots(Named):
    """The robots with which the names in a file are compared.

    If they `are_started`, the launch files that give the file to nodes start these robots and no
    others, so that what another robot has does not count.
    """

    robots: tuple[KnownRobot, ...] = ()
    are_started: bool = False

    @property
    def paths(self) -> frozenset[str]:
        """The paths of their files."""
        return frozenset(robot.path for robot in self.robots)

    @property
    def words(self) -> str:
        """Where a name is looked for, for a message; empty unless it is one robot of several."""
        if len(self.robots) == 1 and self.are_started:
            return f" in the robot {quoted(self.robots[0].robot.name)}"
        return ""


def robots_for_file(workspace: Workspace, path: str) -> ComparedRobots:
    """Return the robots with which the names in a parameter file are compared."""
    return _groups(workspace).for_file(path)


def robots_for_launch(workspace: Workspace, number: int) -> ComparedRobots:
    """Return the robots with which names are compared of what a launch file starts.

    `number` is that of `Launches.launched`.
    """
    return _groups(workspace).for_launch(number)


@lru_cache(maxsize=2)
def _groups(workspace: Workspace) -> "_RobotGroups":
    return _RobotGroups(workspace)


class _RobotGroups:
    """Which robots are started with which files, and which packages have to do with others."""

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace
        self._known = workspace.robots.known
        self._is_single = len(self._known) == 1
        self._started = []  # by each launch file
        self._launches: dict[str, list[int]] = {}  # by the files that they give
        # The packages of which each launch file has something.
        self._together = []
        for number, (package, launch) in enumerate(workspace.launches.roots):
            workspace.charge(1 + len(launch.nodes))
            self._started.append(self._find_robots(launch))
            for path in self._list_files(launch):
                self._launches.setdefault(path, []).append(number)
            self._together.append({package.name, *_list_packages(launch)})
        self._dependencies = {
            package.name: _names_below(package, workspace.packages)
            for package in workspace.packages
        }
        self._robot_packages = [self._find_package(robot.path) for robot in self._known]

    def for_file(self, path: str) -> ComparedRobots:
        """Return the robots for a parameter file."""
        launches = self._launches.get(path, [])
        giving = self._giving_in_gazebo(path)
        robots = {robot.path: robot for robot in giving}
        are_known = bool(launches or giving)
        for number in launches:
            started = self._started[number]
            are_known = are_known and started is not None
            robots |= {robot.path: robot for robot in started or ()}
        if are_known and robots:
            return self._of_started(robots.values())
        related = self._related_to(self._find_package(path))
        robots |= {robot.path: robot for robot in related}
        return ComparedRobots(tuple(robots.values()))

    def for_launch(self, number: int) -> ComparedRobots:
        """Return the robots for what a launch file starts."""
        started = self._started[number]
        if started:
            return self._of_started(started)
        package, _ = self._workspace.launches.roots[number]
        return ComparedRobots(tuple(self._related_to(package)))

    def _of_started(self, robots: Iterable[KnownRobot]) -> ComparedRobots:
        # Of the only robot, all is said without its name.
        return ComparedRobots(tuple(robots), are_started=not self._is_single)

    def _find_robots(self, launch: Launch) -> tuple[KnownRobot, ...] | None:
        """Return the robots that a launch file starts; None where not all are known."""
        by_path = {robot.path: robot for robot in self._known}
        robots = {}
        for named in launch.named("urdf"):
            path = self._workspace.installed.find_source(named.path) if named.path else None
            if (
                path not in by_path
                or len(self._workspace.launches.robot_arguments[named.path or ""]) > 1
            ):
                return None
            robots[path] = by_path[path]
        return None if launch.more or not robots else tuple(robots.values())

    def _list_files(self, launch: Launch) -> Iterator[str]:
        """Yield the parameter files that the nodes and controllers of a launch file get."""
        installed = self._workspace.installed
        for node in launch.nodes:
            yield from self._workspace.parameters.files_given(node)
            for controller in list_spawned(node):
                for given in controller.parameters or ():
                    path = installed.find_source(given.path) if given.path else None
                    if path is not None:
                        yield path

    def _giving_in_gazebo(self, path: str) -> list[KnownRobot]:
        """Return the robots that give a file to the controller manager in Gazebo."""
        giving = []
        for robot, given in self._workspace.robots.files_in_gazebo:
            if self._workspace.installed.find_source(given.path) == path:
                giving.append(robot)
        return giving

    def _find_package(self, path: str) -> Package | None:
        return package_around(self._workspace.packages, path)

    def _related_to(self, package: Package | None) -> Iterator[KnownRobot]:
        """Yield the robots of packages that have to do with another package."""
        related = self._find_related(package.name) if package else frozenset()
        for robot, around in zip(self._known, self._robot_packages, strict=True):
            if package is None or around is None or around.name in related:
                yield robot

    @cached_property
    def _find_related(self) -> Callable[[str], frozenset[str]]:
        """The packages that have to do with one, searched once for each.

        The other one depends on it or the reverse, a launch file has something of both, a package
        with launch files depends on both, or their names begin with the same word.
        """
        groups = list(self._together)
        for package in self._workspace.packages:
            if package.launch_files:
                groups.append({*self._dependencies[package.name]})
        by_word: dict[str, set[str]] = {}
        for name in self._dependencies:
            by_word.setdefault(name.partition("_")[0], set()).add(name)
        groups += [names for word, names in by_word.items() if word not in _ANY_ROBOT]
        groups_by_name: dict[str, list[Collection[str]]] = {}
        for name, below in self._dependencies.items():
            groups_by_name.setdefault(name, []).append({name, *below})
            for other in below:
                groups_by_name.setdefault(other, []).append((name,))
        for group in groups:
            for name in group:
                groups_by_name.setdefault(name, []).append(group)
        return cache(lambda name: frozenset(chain.from_iterable(groups_by_name[name])))


def _list_packages(launch: Launch) -> Iterator[str]:
    """Yield the packages of the nodes that a launch file starts, and of the files that it names."""
    for node in launch.nodes:
        yield node.package
        for given in node.parameters or ():
            yield share_parts(given.path)[0]
    for named in launch.references:
        yield share_parts(named.path or "")[0]


def _names_below(package: Package, packages: Sequence[Package]) -> frozenset[str]:
    """Return the packages of a workspace on which one depends, also by way of others."""
    by_name = {each.name: each for each in packages}
    waiting = [package]
    names = set()
    while waiting:
        manifest = waiting.pop().manifest
        for name in manifest.dependencies if manifest else ():
            if name in by_name and name not in names:
                names.add(name)
                waiting.append(by_name[name])
    return frozenset(names)
