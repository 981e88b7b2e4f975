"""Opened files: their packages, and their robots."""

from collections.abc import Collection, Sequence
from dataclasses import field, replace
from functools import cached_property
from typing import TYPE_CHECKING

from grader.base.grouping import Strings, StringsByName
from grader.base.problems import Problem
from grader.base.records import Record
from grader.base.source import Source
from grader.files.reading import URDF_LIMIT
from grader.files.tree import Tree, make_tree
from grader.ros.known.releases import NOT_STATED, Release, StatedReleases
from grader.ros.package.package import MANIFEST, Package
from grader.ros.package.robot_file import Absent, OtherCandidate, Read, Unreadable, Urdf
from grader.ros.python.budget import Budget

if TYPE_CHECKING:
    from grader.base.reuse import Memory
    from grader.ros.launch.launch_model import ParameterValue
    from grader.ros.package.mesh_loading import Around, MeshLoader
    from grader.ros.urdf.driving import DescribedDriving
    from grader.workspace.graph.launch_graph import LaunchGraph
    from grader.workspace.model.workspace import Workspace
    from grader.workspace.opening.extent import Extent

_NO_FILES = make_tree("", (), ())


class OpenedWorkspace(Record):
    """The packages and the robots of opened files: a URDF on its own, a folder or an archive.

    `open_workspace` makes it of a path, `read_workspace` of a file tree. Commands show its robots,
    its problems and how much of it was read. What is not asked for is not read.

    >>> from grader.files.tree import make_tree, overlaid
    >>> from grader.workspace.api import read_workspace
    >>> files = {"arm.urdf": b"<robot name='arm'><link name='base'/></robot>"}
    >>> opened = read_workspace(overlaid(make_tree("ws", (), ()), files), "ws", 10_000, {})
    >>> [robot.path for robot in opened.robots], opened.extent().robots
    (['arm.urdf'], 1)
    """

    id: str  # the name of the file or folder, or of whose it is
    urdf: Urdf  # of a workspace, all of whose robots are read, absent
    other_candidates: tuple[OtherCandidate, ...] = ()  # other robots and packages
    packages: tuple[Package, ...] = ()  # the one that matches best first
    whole_tree: Tree = _NO_FILES  # every file, also outside of packages
    notes: Strings = ()  # on how it was read
    is_single: bool = True  # whether it is a URDF on its own, not a folder or archive
    robots: tuple[Read | Unreadable, ...] = ()  # of a workspace, all of whose robots are read
    ros1_packages: tuple[Package, ...] = ()  # whose names are not compared
    besides: Strings = ()  # the paths of the files that a URDF on its own includes
    distro: Release | None = None  # the release of ROS 2 that is asked for
    stated: StatedReleases = NOT_STATED  # those that a workspace is for
    around: "Around | None" = None  # of a URDF on its own: reads the packages around it
    neighbours: tuple[Package, ...] = ()  # the packages around a URDF on its own
    budget: Budget = field(default_factory=Budget)  # of the work to read the URDF
    memory: "Memory | None" = None  # what was read of an earlier state of the files
    reads_meant: bool = False  # whether a misspelling that is reported counts as what is meant

    @cached_property
    def workspace(self) -> "Workspace":
        """Its packages and its robots, whose names are compared."""
        from grader.workspace.model.workspace import (
            Workspace,  # late: few rubrics ask for names
        )

        has_other_robots = any(
            not candidate.is_part
            for candidate in self.unused_candidates
            if not candidate.path.endswith(MANIFEST)
        )
        urdfs = tuple(robot for robot in (*self.robots, self.urdf) if isinstance(robot, Read))
        has_unread = has_other_robots or any(isinstance(robot, Unreadable) for robot in self.robots)
        releases = (self.distro,) if self.distro is not None else self.stated.releases
        return Workspace(
            self.packages,
            urdfs,
            self.whole_tree,
            has_unread,
            releases,
            memory=self.memory,
            reads_meant=self.reads_meant,
        )

    @property
    def path(self) -> str | None:
        """The path of the URDF, relative to the opened folder; None without one."""
        if isinstance(self.urdf, Absent):
            return None
        return self.urdf.path or None

    @property
    def unused_candidates(self) -> tuple[OtherCandidate, ...]:
        """The other candidates that the URDF is not expanded from."""
        return tuple(
            candidate for candidate in self.other_candidates if candidate.path not in self.included
        )

    @property
    def included(self) -> Collection[str]:
        """The files that the URDF is expanded from, itself among them."""
        source = self.urdf.reading.source if isinstance(self.urdf, Read) else None
        return getattr(source, "documents", ())

    def find_problems(self, robot: Read) -> tuple[Problem, ...]:
        """Return the problems of one of its robots and of its meshes."""
        from grader.ros.package.incomplete import problems_of_robot  # late: few commands list them

        packages = self.packages + self.ros1_packages
        return problems_of_robot(robot, packages, self.whole_tree, lambda: self._starts(robot))

    def _starts(self, robot: Read) -> bool:
        """Return whether a robot is started for its controllers, always with the same arguments."""
        workspace = self.workspace
        given = set()
        for path, arguments in workspace.launches.robot_arguments.items():
            if workspace.installed.find_source(path) == robot.path:
                given |= arguments
        is_known = len(given) == 1 and all(value is not None for _, value in next(iter(given)))
        return is_known and workspace.robots.has_controller_manager

    def problems_once(
        self, robot: Read, of_packages: Sequence[Problem] = (), *, with_assumptions: bool = False
    ) -> tuple[Problem, ...]:
        """Return the same without what repeats another problem, also one of the packages.

        Assumptions repeat one unless they are asked for.
        """
        from grader.workspace.rules.one_cause import without_repetitions  # late: as above

        problems = self.find_problems(robot)
        return without_repetitions(problems, of_packages, with_assumptions=with_assumptions)

    def driven_joints(self, robot: Read) -> list[str]:
        """Return the joints of the wheels that a plugin in a robot, or a controller, drives.

        A controller counts only without a plugin, and not for a URDF on its own.
        """
        # Late: few commands ask for wheels.
        from grader.workspace.model.driven_joints import joints_of_controllers, joints_of_plugins

        joints = joints_of_plugins(robot)
        if joints or self.is_single:
            return joints
        return joints_of_controllers(self.workspace)

    def standing_problem(
        self, robot: Read, driving: "DescribedDriving", *, with_course: bool
    ) -> Problem | None:
        """Return that one of its robots leans, or is not driven straight ahead `with_course`."""
        from grader.workspace.rules.standing import standing_problem  # late: as above

        return standing_problem(robot.path, driving, with_course=with_course)

    def load_meshes(self, robot: Read) -> "MeshLoader":
        """Return what loads the meshes of one of its robots, for pictures."""
        from grader.ros.package.mesh_loading import MeshLoader  # late: few robots have meshes

        packages = self.packages + self.ros1_packages
        return MeshLoader(robot, self.around or (lambda _: (packages, self.whole_tree)))

    def package_problems(self) -> list[Problem]:
        """Return what is wrong in its packages: in their files, then names that do not agree."""
        # Late: most commands list no problems of a workspace.
        from grader.workspace.rules.file_problems import listed_problems, ros1_problem
        from grader.workspace.rules.one_cause import without_said_patterns
        from grader.workspace.rules.release_problems import compared_names

        problems = [ros1_problem(package) for package in self.ros1_packages]
        problems += listed_problems(self.workspace)
        problems += compared_names(self.workspace)
        return without_said_patterns(problems)

    def default_value(self, node: str, parameter: str) -> "ParameterValue | None":
        """Return the value that a node has for a parameter that it does not get; None without."""
        from grader.workspace.rules.default_values import default_value  # late: few rubrics ask

        return default_value(self.workspace, node, parameter)

    def mesh_size_problems(self) -> list[Problem]:
        """Return the meshes whose sizes surely are in another unit.

        `grader inspect` alone warns of them.
        """
        from grader.workspace.rules.mesh_sizes import mesh_size_problems  # late: as above

        return mesh_size_problems(self.workspace)

    def launch_files(self) -> list[str]:
        """Return the paths of its launch files.

        Those that no other one includes come first, and of these the one that includes most.
        """
        from grader.workspace.graph.launch_graphs import launch_files  # late: few commands ask

        return launch_files(self.workspace)

    def launch_graph(self, path: str) -> "LaunchGraph":
        """Return what runs after one of its launch files is launched on its own."""
        from grader.workspace.graph.launch_graphs import launch_graph  # late: as above

        return launch_graph(self.workspace, path)

    def under(self, arguments: "StringsByName") -> "OpenedWorkspace":
        """Return it with its launch files under these launch arguments."""
        packages = tuple(package.under(arguments) for package in self.packages)
        return replace(self, packages=packages)

    def extent(self) -> "Extent":
        """Return how much of it was read."""
        from grader.workspace.opening.extent import make_extent  # late: few commands say it

        unread = sum(isinstance(robot, Unreadable) for robot in self.robots)
        return make_extent(self.workspace, unread, self.stated)

    def source(self, path: str) -> Source | None:
        """Return the text of one of its files, for quoting; None if it cannot be read."""
        if isinstance(self.urdf, Read) and path == self.urdf.path:
            return self.urdf.source
        data = self.whole_tree.read(path, URDF_LIMIT)
        if data is not None:
            return Source.decoded(path, data)
        return None
