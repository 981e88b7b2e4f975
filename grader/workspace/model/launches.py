"""The launch files of a workspace, and the nodes that they start."""

import posixpath
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property

from grader.ros.installation.places import LaunchKind, launch_kind
from grader.ros.launch.launch_model import Launch, StartedNode
from grader.ros.launch.node_parameters import list_controllers
from grader.ros.package.package import Package
from grader.workspace.model.text_files import MAX_YAML, read_paths
from grader.workspace.model.workspace_folder import WorkspaceFolder

MANAGER, SPAWNERS = "controller_manager", ("spawner", "spawner.py")
CONTROL_NODE = "ros2_control_node"  # the program of the manager


@dataclass(frozen=True, eq=False)
class Launches:
    """The launch files of a workspace, and the nodes that they start."""

    folder: WorkspaceFolder
    only: str = ""  # the path of the only one that is launched; empty for all roots

    @cached_property
    def files(self) -> tuple[tuple[Package, str, Launch], ...]:
        """The launch files, each with its package and its path in it.

        Those of tests and of ROS 1 are not among them.
        """
        launches: list[tuple[Package, str, Launch]] = []
        for package in self.folder.packages:
            paths = read_paths(package, package.launch_files)
            kinds = {path: self._kind_of_launch(package, path) for path in paths}
            paths = [path for path, kind in kinds.items() if kind == "launch"]
            launches += [(package, path, package.launch(path)) for path in paths]
        return tuple(launches)

    @property
    def of_ros1(self) -> Iterator[tuple[Package, list[str]]]:
        """The packages with launch files of ROS 1, and the paths of these."""
        for package in self.folder.packages:
            paths = read_paths(package, package.launch_files)
            of_ros1 = [
                launch_path
                for launch_path in paths
                if self._kind_of_launch(package, launch_path) == "ROS 1"
            ]
            if of_ros1:
                yield package, of_ros1

    def _kind_of_launch(self, package: Package, path: str) -> LaunchKind:
        data = package.tree.read(path, MAX_YAML)
        if data is None:
            return "launch"  # that it cannot be read is said
        return launch_kind(path, data.decode("utf-8", "replace"))

    @property
    def nodes(self) -> tuple[tuple[Package, StartedNode], ...]:
        """The nodes that launch files start, or may start.

        The launch files are those that no other one includes. Raises NotDecided.
        """
        self.folder.charge(1 + len(self._nodes))
        return self._nodes

    @cached_property
    def _nodes(self) -> tuple[tuple[Package, StartedNode], ...]:
        return tuple((package, node) for package, launch in self.roots for node in launch.nodes)

    @cached_property
    def roots(self) -> tuple[tuple[Package, Launch], ...]:
        """The launch files that no other one includes, or the only one that is asked for.

        Each is with its package.
        """
        if self.only:
            files = [(package, file) for package, _, file in self.files]
            return tuple(pair for pair in files if pair[1].source.path == self.only)
        included: set[str] = set()
        for _, _, launch in self.files:
            included |= {passed.path for passed in launch.passed}
        root_launches = []
        for package, path, launch in self.files:
            if included.isdisjoint(self.find_targets(package, path)):
                root_launches.append((package, launch))
        return tuple(root_launches)

    def find_targets(self, package: Package, source: str) -> Sequence[str]:
        """Return the paths below the prefix at which a build installs a file of a package."""
        return self._targets(package).get(source, ())

    @cached_property
    def _targets(self) -> Callable[[Package], Mapping[str, Sequence[str]]]:
        """The paths at which a build installs files, by their paths in the package, found once."""
        return cache(_targets_by_source)

    @property
    def launched(self) -> Iterator[tuple[int, StartedNode]]:
        """The nodes, each with the number of the launch file that starts it on its own."""
        for number, (_, launch) in enumerate(self.roots):
            self.folder.charge(1 + len(launch.nodes))
            for node in launch.nodes:
                yield (number, node)

    @cached_property
    def has_more_nodes(self) -> bool:
        """Whether launch files may start more than is known."""
        return any(launch.more for _, _, launch in self.files)

    @cached_property
    def unknown_includes(self) -> str:
        """Why a launch file may include another one, with other arguments; empty if none does."""
        names = {posixpath.basename(launch.source.path) for _, launch in self.roots}
        for _, launch in self.roots:
            others = names - {posixpath.basename(launch.source.path)}
            for unknown in launch.unknown:
                if any(name in launch.source.text for name in others):
                    return unknown.message
        return ""

    @cached_property
    def unknown_nodes(self) -> str:
        """Why launch files may start more nodes or controllers; empty where they do not."""
        for _, launch in self.roots:
            for unknown in launch.unknown:
                return unknown.message
        for _, launch in self.roots:
            if launch.unread:
                return launch.unread
        for _, node in self.nodes:
            if node.executable in SPAWNERS and list_controllers(node) is None:
                return "the arguments of a spawner are not evaluated"
        return ""


def _targets_by_source(package: Package) -> Mapping[str, Sequence[str]]:
    """Return the paths at which a build installs files, by their paths in the package."""
    targets: dict[str, list[str]] = {}
    for target, path in package.installed.items():
        targets.setdefault(path, []).append(target)
    return targets
