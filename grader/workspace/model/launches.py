"""The launch files of a workspace, and the nodes that they start."""

import posixpath
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache, cached_property

from grader.base.records import Record
from grader.ros.installation.places import LaunchKind, launch_kind
from grader.ros.launch.launch_model import Launch, StartedNode
from grader.ros.launch.node_parameters import list_controllers
from grader.ros.package.package import Package
from grader.workspace.model.text_files import MAX_YAML, read_paths
from grader.workspace.model.workspace_folder import WorkspaceFolder

MANAGER = "controller_manager"
SPAWNERS = ("spawner", "spawner.py")
CONTROL_NODE = "ros2_control_node"  # the program of the manager


class Launches(Record):
    """The launch files of a workspace, and the nodes that they start."""

    folder: WorkspaceFolder
    only: str = ""  # the path of the only one that is launched; empty for all roots

    @cached_property
    def files(self) -> tuple[tuple[Package, str, Launch], ...]:
        """The launch files, each with its package and its path in it.

        Those of tests and of ROS 1 are not among them.
        """
        launches = []
        for package in self.folder.packages:
            paths = read_paths(package, package.launch_files)
            kinds = {path: self._kind_of_launch(package, path) for path in paths}
            paths = [path for path, kind in kinds.items() if kind == "launch"]
            launches += [(package, path, package.launch(path)) for path in paths]
        return tuple(launches)

    @property
    def every(self) -> Sequence[Launch]:
        """The same launch files alone."""
        return [launch for _, _, launch in self.files]

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
    def nodes(self) -> Sequence[StartedNode]:
        """The same as `placed_nodes`, without packages. Raises NotDecided."""
        return [node for _, node in self.placed_nodes]

    @property
    def programs(self) -> set[tuple[str, str]]:
        """The packages and programs of these nodes. Raises NotDecided."""
        return {node.program for node in self.nodes}

    @property
    def placed_nodes(self) -> tuple[tuple[Package, StartedNode], ...]:
        """The nodes that launch files start, or may start, each with the package of its file.

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

        Each is with its package, and has its components among its nodes.
        """
        included = set()
        for launch in self.every:
            included |= {passed.path for passed in launch.passed}
        root_launches = []
        for package, path, launch in self.files:
            is_root = included.isdisjoint(self.find_targets(package, path))
            if launch.source.path == self.only if self.only else is_root:
                root_launches.append((package, launch.with_components()))
        return tuple(root_launches)

    @property
    def outermost(self) -> Sequence[Launch]:
        """The same as `roots`, without packages."""
        return [launch for _, launch in self.roots]

    @cached_property
    def robot_arguments(self) -> Mapping[str, set[tuple[tuple[str, str | None], ...]]]:
        """The arguments of xacro with which launch files read robots, by the paths of these.

        A robot is known under one of them only.
        """
        arguments: dict[str, set[tuple[tuple[str, str | None], ...]]] = {}
        for launch in self.outermost:
            for named in launch.named("urdf"):
                arguments.setdefault(named.path or "", set()).add(named.arguments)
        return arguments

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
        return any(launch.with_components().more for launch in self.every)

    @cached_property
    def unknown_includes(self) -> str:
        """Why a launch file may include another one, with other arguments; empty if none does."""
        names = {posixpath.basename(launch.source.path) for launch in self.outermost}
        for launch in self.outermost:
            others = names - {posixpath.basename(launch.source.path)}
            for unknown in launch.unknown:
                if any(name in launch.source.text for name in others):
                    return unknown.message
        return ""

    @cached_property
    def unknown_nodes(self) -> str:
        """Why launch files may start more nodes or controllers; empty where they do not."""
        for launch in self.outermost:
            for unknown in launch.unknown:
                return unknown.message
        for launch in self.outermost:
            if launch.unread:
                return launch.unread
        for node in self.nodes:
            if node.executable in SPAWNERS and list_controllers(node) is None:
                return "the arguments of a spawner are not evaluated"
        return ""


def list_spawned(node: StartedNode) -> Sequence[StartedNode]:
    """Return the controllers that a node starts, if it is a spawner whose arguments are known."""
    return (list_controllers(node) or ()) if node.executable in SPAWNERS else ()


def _targets_by_source(package: Package) -> Mapping[str, Sequence[str]]:
    """Return the paths at which a build installs files, by their paths in the package."""
    targets: dict[str, list[str]] = {}
    for target, path in package.installed.items():
        targets.setdefault(path, []).append(target)
    return targets
