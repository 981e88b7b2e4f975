"""The files of a workspace whose names are compared: packages, launch files, parameter files,
the robot, nodes.
"""

import posixpath
import re
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache, cached_property, partial
from typing import TypeVar, TypeVarTuple

from grader.base.errors import InputError, NotDecided
from grader.base.reuse import Memory
from grader.base.source import LazyLocation, Location, Source
from grader.files.tree import Tree, parents
from grader.ros.build.places import (
    PREFIX,
    SHARE,
    LaunchKind,
    is_launch_file,
    launch_kind,
    share_parts,
)
from grader.ros.config.yaml_nodes import YamlFault, YamlNode, read_yaml
from grader.ros.config.yaml_values import sections_in, values_in
from grader.ros.known.known import known
from grader.ros.known.releases import Release
from grader.ros.launch.launch_model import GivenParameters, Launch, ParameterValue, StartedNode
from grader.ros.launch.node_parameters import (
    FileTables,
    NodeParameters,
    controllers_of,
    parameters_of,
    read_tables,
    value_in_file,
)
from grader.ros.package.finding import is_backup
from grader.ros.package.installed_files import are_installs_known, open_meant
from grader.ros.package.node_facts import NodeFacts, PackageNodes
from grader.ros.package.package import MANIFEST, Package
from grader.ros.package.package_interfaces import PackageInterfaces, read_interfaces
from grader.ros.package.python_nodes import read_nodes
from grader.ros.package.robot_file import Read
from grader.ros.python.budget import Budget, OutOfBudget
from grader.ros.urdf.model import Robot
from grader.ros.xml.elements import readable
from grader.ros.xml.parsing import Element, XmlFault, XmlFile

_Read = TypeVarTuple("_Read")
_T = TypeVar("_T")
_SYSTEM = re.compile(r"<ros2_control\b")
MANAGER, SPAWNERS = "controller_manager", ("spawner", "spawner.py")
_NAME = re.compile(r"\bname=[\"'](?:xacro:)?([\w.-]+)[\"']")
_CALLED = re.compile(r"<xacro:(?:[\w-]+\.)*([\w-]+)")
_PACKAGE_IN = re.compile("the package '([\\w-]+)'")  # in the reason why a path is not known
INCLUDED = re.compile(r"<xacro:include\b[^>]*?\bfilename\s*=\s*[\"']([^\"']+)[\"']")
_EXPRESSION, _WORD = re.compile(r"\$\{([^{}]*)"), re.compile(r"\w+")
_FOUND = re.compile(r"\$\(find ([\w-]+)\)/")
_MAX_FILES = 60  # of one kind in a package
# What is charged as one part: names of files that are compared, bytes of a file that a node is
# given, and characters of a text in which something is searched.
_FILES_A_PART, _BYTES_A_PART, _SEARCHED_A_PART = 8, 64, 512
_CAUSE = "not all names are compared"
TOO_MUCH = "comparing them takes more work than one submission may use"
_MAX_YAML = 512 * 1024  # bytes
_TEXTS = (".yaml", ".yml", ".urdf", ".xacro", ".srdf", ".sdf", ".world", ".rviz", ".py", ".xml")
_OWN_FOLDERS = frozenset({"config", "launch", "maps", "params", "rviz", "urdf", "worlds"})
_PROGRAMS = (".py", ".cpp", ".cc", ".hpp", ".sh", "CMakeLists.txt")
# Of a package, which may be empty.
_USUAL_FOLDERS = (
    *("action", "config", "include", "launch", "maps", "meshes", "models", "msg", "params"),
    *("resource", "rviz", "scripts", "src", "srv", "test", "urdf", "worlds"),
)
# Of files without code: parameters, models, pictures and texts.
_NO_CODE = frozenset(
    {
        *(".yaml", ".yml", ".urdf", ".xacro", ".srdf", ".sdf", ".world", ".rviz", ".xml"),
        *(".stl", ".dae", ".obj", ".png", ".jpg", ".jpeg", ".gif", ".pgm", ".pdf", ".md"),
    }
)
_WITH_LINES = (".yaml", ".yml", ".py")  # files whose comments begin with #
_COMMENT_LINE = re.compile(r"(?:^|(?<=\s))#[^\n]*")
_XML_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)


@dataclass(frozen=True, eq=False)
class KnownRobot:
    """A robot as ROS 2 loads it, expanded, of which everything is known."""

    path: str
    robot: Robot
    root: Element  # the <robot>
    source: Source

    @property
    def systems(self) -> list[Element]:
        """The <ros2_control> elements."""
        return list(self.root.iterchildren("ros2_control"))

    def place(self, element: Element) -> Location:
        """Return where an element is written."""
        return LazyLocation(self.source, self._positions[element]).resolve()

    @cached_property
    def _positions(self) -> Mapping[Element, int]:
        """The position of each element in document order."""
        return {element: tag for tag, element in enumerate(self.root.iter("*"))}


def _known_robot(urdf: Read) -> KnownRobot | None:
    loaded = urdf.loaded
    is_known = not loaded.undetermined and loaded.verdict != "rejected"
    if is_known and loaded.robot is not None and loaded.root is not None:
        return KnownRobot(urdf.path, loaded.robot, loaded.root, loaded.source)
    return None


@dataclass(frozen=True, eq=False)
class Workspace:
    """The packages of a folder with their robots, as the readers of names see them. Each file is
    read once.
    """

    found_packages: tuple[Package, ...]  # the one that matches best first
    urdfs: tuple[Read, ...]  # the files of robots that are read
    tree: Tree  # all files, also those outside of packages
    has_unread_robots: bool  # whether other files may be robots
    releases: tuple[Release, ...] = ()  # in one of which names should be; () for any
    memory: Memory | None = None  # what was read of an earlier state of the files

    @cached_property
    def _work(self) -> Budget:
        for package in self.found_packages:
            return package.work
        return Budget()

    @property
    def is_spent(self) -> bool:
        """Whether more is left to read and compare than a submission may ask for."""
        return self._work.is_spent

    def charge(self, parts: int) -> None:
        """Charge the work of comparing names to the budget of the submission. Raises NotDecided."""
        try:
            self._work.charge(parts)
        except OutOfBudget:
            raise NotDecided(f"not all names are compared: {TOO_MUCH}", _CAUSE) from None

    @cached_property
    def packages(self) -> tuple[Package, ...]:
        """The packages that a build of the workspace has: the best of each name, without those
        that colcon ignores.
        """
        packages = []
        for package in self.found_packages:
            best = package.packages.get(package.name)
            if not package.ignored_by and best is not None and best.folder == package.folder:
                packages.append(package)
        return tuple(packages)

    def means_one(self, package: Package, name: str) -> bool:
        """Return whether a name in a file of a package certainly means one package: its own, or
        the only one.
        """
        return name in package.names or self._counts[name] < 2

    @cached_property
    def _counts(self) -> Counter[str]:
        """How many packages have a name, without those that are ignored and backups."""
        used = [it for it in self.found_packages if not it.ignored_by and not is_backup(it.folder)]
        return Counter(package.name for package in used)

    @cached_property
    def launches(self) -> tuple[tuple[Package, str, Launch], ...]:
        """The launch files, each with its package and its path in it; without those of tests and of
        ROS 1.
        """
        launches: list[tuple[Package, str, Launch]] = []
        for package in self.packages:
            paths = _read_paths(package, package.launch_files)
            kinds = {path: self._kind_of_launch(package, path) for path in paths}
            paths = [path for path, kind in kinds.items() if kind == "launch"]
            launches += [(package, path, package.launch(path)) for path in paths]
        return tuple(launches)

    def _kind_of_launch(self, package: Package, path: str) -> LaunchKind:
        data = package.tree.read(path, _MAX_YAML)
        if data is None:
            return "launch"  # that it cannot be read is said
        return launch_kind(path, data.decode("utf-8", "replace"))

    @property
    def ros1_launches(self) -> Iterator[tuple[Package, list[str]]]:
        """The packages with launch files of ROS 1, and the paths of these."""
        for package in self.packages:
            paths = _read_paths(package, package.launch_files)
            of_ros1 = [it for it in paths if self._kind_of_launch(package, it) == "ROS 1"]
            if of_ros1:
                yield package, of_ros1

    @property
    def nodes(self) -> tuple[tuple[Package, StartedNode], ...]:
        """The nodes that launch files start, or may start: those that no other launch file
        includes. Raises NotDecided.
        """
        self.charge(1 + len(self._nodes))
        return self._nodes

    @cached_property
    def _nodes(self) -> tuple[tuple[Package, StartedNode], ...]:
        return tuple((package, node) for package, launch in self.roots for node in launch.nodes)

    @cached_property
    def roots(self) -> tuple[tuple[Package, Launch], ...]:
        """The launch files that no other one includes, with their packages."""
        included: set[str] = set()
        for _, _, launch in self.launches:
            included |= {passed.path for passed in launch.passed}
        found = []
        for package, path, launch in self.launches:
            if included.isdisjoint(self.targets_of(package, path)):
                found.append((package, launch))
        return tuple(found)

    def targets_of(self, package: Package, source: str) -> Sequence[str]:
        """Return the paths below the prefix at which a build installs a file of a package."""
        if package not in self._targets:
            targets: dict[str, list[str]] = {}
            for target, path in package.installed.items():
                targets.setdefault(path, []).append(target)
            self._targets[package] = targets
        return self._targets[package].get(source, ())

    @cached_property
    def _targets(self) -> dict[Package, dict[str, list[str]]]:
        """The paths at which builds install files, by packages and the paths of files in them."""
        return {}

    @property
    def launched(self) -> Iterator[tuple[int, StartedNode]]:
        """The nodes, each with the number of the launch file that starts it on its own."""
        for number, (_, launch) in enumerate(self.roots):
            self.charge(1 + len(launch.nodes))
            for node in launch.nodes:
                yield (number, node)

    @cached_property
    def yaml_files(self) -> Mapping[str, YamlNode | YamlFault]:
        """The YAML files that are no launch files, by their paths in the submission; or why one
        is not read.
        """
        files: dict[str, YamlNode | YamlFault] = {}
        for package in self.packages:
            paths = [path for path in package.tree.files if path.endswith((".yaml", ".yml"))]
            launched = {path for owner, path, _ in self.launches if owner is package}
            for path in _read_paths(package, (it for it in paths if it not in launched)):
                whole_path, data = package.path(path), package.tree.read(path, _MAX_YAML)
                if data is not None:
                    files[whole_path] = self.recall(_read_yaml, data, whole_path)
        return files

    def recall(self, read: Callable[[*_Read], _T], *of: *_Read) -> _T:
        """Return what a function makes of texts and nothing else, or made of them before."""
        if self.memory is None:
            return read(*of)
        return self.memory.recall((read, *of), None, self._work, lambda _: read(*of))

    @property
    def trees(self) -> Iterator[tuple[str, YamlNode]]:
        """The YAML files that are read, with their paths."""
        self.charge(1 + len(self.yaml_files))
        for path, node in self.yaml_files.items():
            if isinstance(node, YamlNode):
                yield (path, node)

    @cached_property
    def sdf_files(self) -> tuple[XmlFile, ...]:
        """The models and worlds of Gazebo that can be read."""
        return tuple(self._xml_files((".sdf", ".world")))

    @cached_property
    def srdf_files(self) -> tuple[XmlFile, ...]:
        """The descriptions of robots for MoveIt that can be read."""
        return tuple(self._xml_files((".srdf",)))

    def _xml_files(self, endings: tuple[str, ...]) -> Iterator[XmlFile]:
        for package in self.packages:
            for path in [it for it in package.tree.files if it.endswith(endings)][:_MAX_FILES]:
                with suppress(InputError, XmlFault):
                    data = package.tree.files[path].read(_MAX_YAML)
                    yield XmlFile(data, Source(package.path(path), data.decode("utf-8", "replace")))

    @cached_property
    def robots(self) -> tuple[KnownRobot, ...]:
        """The robots of which everything is known."""
        return tuple(found for urdf in self.urdfs if (found := _known_robot(urdf)) is not None)

    @property
    def has_other_robots(self) -> bool:
        """Whether there may be other robots than `robots`, which names may belong to."""
        is_unknown = len(self.robots) < len(self.urdfs)
        return self.has_unread_robots or is_unknown or self._loads_others

    @cached_property
    def _loads_others(self) -> bool:
        """Whether a launch file loads a robot of a package that is not there."""
        for package, _, launch in self.launches:
            for named in launch.named("urdf"):
                names = {share_parts(named.path or "")[0], *_PACKAGE_IN.findall(named.reason)}
                if any(name and package.find(name) is None for name in names):
                    return True
        return False

    @property
    def has_controller_manager(self) -> bool:
        """Return whether a launch file starts a controller manager, or the robot has one in
        Gazebo.
        """
        is_started = any(node.executable == "ros2_control_node" for _, node in self.nodes)
        return is_started or self.has_controllers_in_gazebo

    @cached_property
    def has_controllers_in_gazebo(self) -> bool:
        """Whether a robot has a controller manager in Gazebo."""
        for robot in self.robots:
            if any("ros2_control" in it.get("filename", "") for it in robot.root.iter("plugin")):
                return True
        return False

    @cached_property
    def nodes_by_package(self) -> Mapping[str, PackageNodes]:
        """The nodes of the installed Python modules and of C++, by the names of packages."""
        return {package.name: self._nodes_in(package) for package in self.packages}

    def _nodes_in(self, package: Package) -> PackageNodes:
        if self.memory is None:
            return _nodes_of(package)
        key = ("nodes", package.name, _program_texts(package))
        return self.memory.recall(key, None, package.budget, lambda _: _nodes_of(package))

    @cached_property
    def interfaces(self) -> Mapping[str, PackageInterfaces]:
        """The messages, services and actions of the packages, by the names of these. Of a name that
        several packages have nothing is known.
        """
        found = {}
        for package in self.packages:
            is_one = self._counts[package.name] < 2
            unknown = PackageInterfaces(is_complete=False)
            found[package.name] = read_interfaces(package) if is_one else unknown
        return found

    @cached_property
    def command_interfaces(self) -> Mapping[str, tuple[frozenset[str], Location]] | None:
        """The command interfaces of joints in <ros2_control>, of all robots; None without one."""
        if not any(robot.systems for robot in self.robots):
            return None
        interfaces: dict[str, tuple[frozenset[str], Location]] = {}
        for robot in self.robots:
            for joint in [it for system in robot.systems for it in system.iterchildren("joint")]:
                name, added = joint.get("name", ""), joint.iterchildren("command_interface")
                before, at = interfaces.get(name, (frozenset[str](), robot.place(joint)))
                interfaces[name] = (before.union(each.get("name", "") for each in added), at)
        return interfaces

    @property
    def has_all_interfaces(self) -> bool:
        """Return whether `command_interfaces` are those of every robot, also under other
        arguments of xacro.
        """
        if not self.robots or self.has_other_robots:
            return False
        text = "".join(source.text for source in self.xacro_sources)
        called = {*_CALLED.findall(text)}
        if "call" not in called:  # <xacro:call macro="..."/> may compute the name
            *macros, rest = text.split("</xacro:macro>")
            text = "".join(_without_macro(macro, called) for macro in macros) + rest
        written = len(_SYSTEM.findall(text))
        return written <= sum(len(robot.systems) for robot in self.robots)

    def own_node(self, node: StartedNode) -> NodeFacts | None:
        """Return the Python node of the workspace that a program starts, if it starts one that
        is known.
        """
        owner = self.package_of(node)
        if owner is None or owner.name not in self.nodes_by_package:
            return None
        return self._nodes_by_program.get((owner.name, node.executable))

    @cached_property
    def _nodes_by_program(self) -> Mapping[tuple[str, str], NodeFacts]:
        """The Python nodes by their packages and programs, of programs with one node."""
        programs: dict[tuple[str, str], list[Sequence[NodeFacts]]] = {}
        for package, found in self.nodes_by_package.items():
            for program in found.programs:
                programs.setdefault((package, program.name), []).append(program.nodes)
        nodes: dict[tuple[str, str], NodeFacts] = {}
        for key, of_programs in programs.items():
            if len(of_programs) == 1 and len(of_programs[0]) == 1:
                nodes[key] = of_programs[0][0]
        return nodes

    @cached_property
    def has_more_nodes(self) -> bool:
        """Whether launch files may start more than is known."""
        return any(launch.more for _, _, launch in self.launches)

    def is_read(self, node: StartedNode) -> bool:
        """Return whether all is known that the code of a node opens."""
        facts = self.own_node(node)
        return facts is not None and not facts.doubts

    def package_of(self, node: StartedNode) -> Package | None:
        """Return the package of the workspace whose program a node is."""
        if self.packages:
            return self.packages[0].find(node.package)
        return None

    def name_of(self, node: StartedNode) -> str | None:
        """Return the name that a node has, without its namespace; None where it is not known."""
        if node.node_name is None or node.node_name:
            return node.node_name
        return self.name_in_program(node)

    def name_in_program(self, node: StartedNode) -> str | None:
        """Return the name that the program of a node gives it; None where it is not known."""
        own = self.own_node(node)
        if own is not None:
            return own.name
        names: Mapping[str, str] = known()["node_names"]
        return names.get(f"{node.package}/{node.executable}")

    def children_of(self, name: str) -> frozenset[str]:
        """Return the nodes that a node of another package makes in its process, and that read
        its parameters.
        """
        children = frozenset(known()["children"].get(name, ()))
        return children | self.typed_sections if name == MANAGER else children

    @cached_property
    def controllers(self) -> frozenset[str]:
        """The names of sections in parameter files that may be those of controllers."""
        return frozenset(
            keys[-1] for _, tree in self.trees for keys, _ in sections_in(tree) if keys
        )

    @cached_property
    def typed_sections(self) -> frozenset[str]:
        """The names of controllers and others that parameter files give a type."""
        names: set[str] = set()
        for _, tree in self.trees:
            for keys, section in sections_in(tree):
                if keys and section.get("type") is not None:
                    names.add(keys[-1].rpartition("/")[2])
                if isinstance(section.value, dict):
                    for name, inner in section.value.items():
                        if inner.get("type") is not None:
                            names.add(name)
        return frozenset(names)

    def has_file(self, path: str) -> bool:
        """Return whether a build of the workspace installs a file at a path below the prefix."""
        return path in self._sources_of_installed

    def installed_yaml(self, path: str) -> YamlNode | None:
        """Return the YAML file that is installed at a path, which begins with the prefix's
        stand-in.
        """
        tree = self.yaml_files.get(self.source_of(path) or "")
        return tree if isinstance(tree, YamlNode) else None

    def source_of(self, path: str) -> str | None:
        """Return the file of the submission that is installed at a path, which begins with the
        prefix's stand-in.
        """
        inside = posixpath.normpath(path).removeprefix(f"{PREFIX}/")
        return self._sources_of_installed.get(inside)

    @cached_property
    def _sources_of_installed(self) -> Mapping[str, str]:
        """The files of the submission, by the paths below the prefix where they are installed."""
        sources: dict[str, str] = {}
        for package in self.packages:
            for target, source in package.installed.items():
                sources.setdefault(target, package.path(source))
        return sources

    @cached_property
    def parameter_files(self) -> Mapping[str, list[StartedNode]]:
        """The parameter files, by their paths in the submission, with the nodes that are given
        them.
        """
        nodes: dict[str, list[StartedNode]] = {}
        for _, node in self.nodes:
            for path in self.files_given(node):
                nodes.setdefault(path, []).append(node)
        return nodes

    def files_given(self, node: StartedNode) -> Iterator[str]:
        """Yield the parameter files that a node is given, by their paths in the submission."""
        for given in node.parameters or ():
            path = self.source_of(given.path) if given.path and given.is_plain else None
            if path is not None:
                yield path

    @cached_property
    def parameter_owners(self) -> Mapping[str, list[NodeParameters]]:
        """The parameters that nodes and controllers are given, by their names without
        namespaces.
        """
        owners: dict[str, list[NodeParameters]] = {}
        for package, launch in self.roots:
            # What a controller manager and Gazebo are given, its controllers get too.
            shared: list[GivenParameters] = []
            for node in launch.nodes:
                if self.name_of(node) == MANAGER:
                    shared += node.parameters or ()
            shared += self._simulated
            for node in launch.nodes:
                name = self.name_of(node)
                if name == MANAGER or (name is not None and node.package != MANAGER):
                    given = self.read_given(package, node, name)
                    owners.setdefault(name, []).append(given)
                for controller in _spawned_by(node):
                    files = (*shared, *(controller.parameters or ()))
                    started = controller._replace(parameters=files)
                    given = self.read_given(package, started, "")
                    owners.setdefault(controller.node_name or "", []).append(given)
        return owners

    @property
    def _simulated(self) -> Iterator[GivenParameters]:
        """The files that the robots give to the controller manager in Gazebo."""
        for robot in self.robots:
            for element in robot.root.iter("parameters"):
                path = _FOUND.sub(rf"{SHARE}/\1/", readable((element.text or "").strip()))
                if path.startswith(SHARE):
                    yield GivenParameters(robot.place(element), path)

    @cached_property
    def controller_files(self) -> frozenset[str]:
        """The parameter files, by their paths in the submission, that Gazebo and spawners give
        controllers.
        """
        given = [*self._simulated]
        for _, node in self.nodes:
            for controller in _spawned_by(node):
                given += controller.parameters or ()
        paths = {self.source_of(each.path) for each in given if each.path}
        return frozenset(path for path in paths if path is not None)

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
            if node.executable in SPAWNERS and controllers_of(node) is None:
                return "the arguments of a spawner are not evaluated"
        return ""

    def parameters_given(self, package: Package, node: StartedNode) -> NodeParameters:
        """Return the parameters that a node gets, whose launch file is in a package."""
        return self.read_parameters(package, node, self.name_of(node) or "")

    def read_parameters(self, package: Package, node: StartedNode, name: str) -> NodeParameters:
        """Return the parameters that a node gets that is called so in its program. Raises
        NotDecided.
        """
        return parameters_of(node, partial(self.open, package), name, self._read_tables)

    @cached_property
    def passed_files(self) -> Collection[str]:
        """The parameter files that launch files pass to others, which they include."""
        files: set[str | None] = set()
        for _, _, launch in self.launches:
            for passed in launch.passed:
                files |= {self.source_of(value or "") for _, value in passed.values}
        return {path for path in files if path is not None}

    def read_given(self, package: Package, node: StartedNode, name: str) -> NodeParameters:
        """Return the same, where a file that surely is nowhere gives nothing. Raises NotDecided."""
        return parameters_of(node, partial(self.open_given, package), name, self._read_tables)

    @cached_property
    def _read_tables(self) -> Callable[[bytes, str, bool], FileTables]:
        """A reader of parameter files that reads each once."""
        return cache(read_tables)

    def open(self, package: Package, path: str) -> tuple[bytes, str] | None:
        """Return a parameter file, as `open_meant` does. Raises NotDecided."""
        return self._open_once(partial(open_meant, package, path), package, path)

    def _open_once(
        self, find: Callable[[], tuple[bytes, str] | None], *key: object
    ) -> tuple[bytes, str] | None:
        """Return a file that is searched once, and charge what a node is given."""
        if key not in self._opened:
            self.charge(len(self.tree.files) // _FILES_A_PART)
            self._opened[key] = find()
        found = self._opened[key]
        self.charge(1 + len(found[0] if found is not None else b"") // _BYTES_A_PART)
        return found

    @cached_property
    def _opened(self) -> dict[tuple[object, ...], tuple[bytes, str] | None]:
        """The parameter files that were searched."""
        return {}

    def open_given(self, package: Package, path: str) -> tuple[bytes, str] | None:
        """Return a parameter file that a launch file of a package gives, as `open_meant` does, and
        nothing in one that surely is nowhere. Raises NotDecided.
        """
        return self._open_once(partial(self._find_given, package, path), package, path, "given")

    def _find_given(self, package: Package, path: str) -> tuple[bytes, str] | None:
        found = open_meant(package, path, absent_are_empty=True)
        owner = package.find(share_parts(f"{PREFIX}/{path}")[0])
        if found is None and owner is not None and are_installs_known(owner):
            return (b"", path) if self.is_nowhere(owner, path) else None
        return found

    def is_nowhere(self, owner: Package, target: str) -> bool:
        """Return whether a file of text that the package does not have is surely nowhere.

        What the limits of reading, a submodule or a link leave out may be there, and an own program
        may write a file that it names.
        """
        if not target.endswith(_TEXTS) or self.tree.ignored or owner.tree.links:
            return False
        for folder in parents(target.removeprefix(owner.share)):
            self.charge(len(owner.tree.files) // _FILES_A_PART)
            is_empty = not any(path.startswith(f"{folder}/") for path in owner.tree.files)
            is_submodule = is_empty and posixpath.basename(folder) not in _OWN_FOLDERS
            if folder in owner.tree.folders and is_submodule:
                return False
        name = posixpath.basename(target)
        for package in self.packages:
            for source in self.sources_of(package, _PROGRAMS):
                if name in source.text and not is_launch_file(source.path):
                    return False
        return True

    def written_values(self, parameter: str) -> Iterator[ParameterValue]:
        """Yield the values that files have for a parameter, of whatever node."""
        for _, tree in self.trees:
            for _, section in sections_in(tree):
                node = section.get(*parameter.split("."))
                if node is not None:
                    yield value_in_file(node)

    def wildcard_places(self, node: StartedNode) -> frozenset[Location]:
        """Return the places of parameters that a file gives to every node."""
        places: set[Location] = set()
        for given in node.parameters or ():
            tree = self.installed_yaml(given.path) if given.path else None
            if tree is not None:
                places |= self._wildcard_places_in(tree)
        self.charge(len(places))
        return frozenset(places)

    @cached_property
    def _wildcard_places_in(self) -> Callable[[YamlNode], frozenset[Location]]:
        """The places in a file of the parameters that it gives to every node, found once."""
        return cache(_wildcard_places_in)

    @cached_property
    def absent_submodules(self) -> tuple[str, ...]:
        """The empty folders that git may fetch: those of submodules, as their names say."""
        filled = {folder for path in self.tree.files for folder in parents(path)}
        empty = []
        for folder in self.tree.folders:
            above, _, name = folder.rpartition("/")
            is_usual = name in _USUAL_FOLDERS or above.endswith("include")
            if folder not in filled and not is_usual:
                empty.append(folder)
        return tuple(empty)

    def begins_with(self, path: str, start: bytes) -> bool:
        """Return whether a file of the submission begins with some bytes."""
        file = self.tree.files.get(path)
        return file is not None and file.read(len(start), first=True) == start

    def has_plugin(self, name: str) -> bool:
        """Return whether a package describes a plugin of this name for pluginlib."""
        sources = (it for package in self.packages for it in self.sources_of(package, (".xml",)))
        return any(f'name="{name}"' in it.text for it in sources)

    def sources_of(self, package: Package, endings: tuple[str, ...]) -> Iterator[Source]:
        """Yield the texts of the files of a package with these endings, without those of tests."""
        key = (package, endings)
        if key not in self._paths:
            self._paths[key] = [path for path in package.tree.files if path.endswith(endings)]
        return self._sources(package, self._paths[key])

    @cached_property
    def _paths(self) -> dict[tuple[Package, tuple[str, ...]], list[str]]:
        """The paths of the files of packages, by their endings."""
        return {}

    def launch_sources(self, package: Package) -> Iterator[Source]:
        """Yield the texts of the launch files of a package."""
        return self._sources(package, package.launch_files)

    def _sources(self, package: Package, paths: Iterable[str]) -> Iterator[Source]:
        for path in _read_paths(package, paths):
            if (package, path) not in self._texts:
                self._texts[package, path] = _without_comments(package, path)
            source = self._texts[package, path]
            if source is not None:
                self.charge(1 + len(source.text) // _SEARCHED_A_PART)
                yield source

    @cached_property
    def _texts(self) -> dict[tuple[Package, str], Source | None]:
        """The texts that were read, without comments, by package and path, of others too: each is
        read once.
        """
        return {}

    @cached_property
    def robot_files(self) -> frozenset[str]:
        """The files that the robots are made of, by their paths; empty where none is known."""
        files: set[str] = set()
        for robot in self.robots:
            files |= {robot.path, *(robot.place(it).path for it in robot.root.iter("*"))}
        return frozenset(files)

    @cached_property
    def xacro_sources(self) -> tuple[Source, ...]:
        """The texts of the xacro files and URDFs, and of the files of other endings that these
        include.
        """
        sources: list[Source] = []
        for package in self.packages:
            sources += self.sources_of(package, (".xacro", ".urdf"))
        names: set[str] = set()
        for source in sources:
            names |= {posixpath.basename(path) for path in INCLUDED.findall(source.text)}
        others = tuple(name for name in names if name and not name.endswith((".xacro", ".urdf")))
        for package in self.packages:
            sources += self.sources_of(package, others)
        return tuple(sources)

    @cached_property
    def words_in_expressions(self) -> frozenset[str]:
        """The words in the expressions of the xacro files."""
        words: set[str] = set()
        for source in self.xacro_sources:
            for expression in _EXPRESSION.findall(source.text):
                words.update(_WORD.findall(expression))
        return frozenset(words)

    def searched_launch_texts(self) -> tuple[str, ...]:
        """Return the texts of the launch files, to search something in each. Raises NotDecided."""
        self.charge(1 + sum(map(len, self.launch_texts)) // _SEARCHED_A_PART)
        return self.launch_texts

    @cached_property
    def launch_texts(self) -> tuple[str, ...]:
        """The texts of the launch files, of those of ROS 1 too."""
        sources: list[Source] = []
        for package in self.packages:
            sources += self._sources(package, package.launch_files)
        for package in self.packages:
            sources += self.sources_of(package, (".launch",))
        return tuple(source.text for source in sources)

    @cached_property
    def python_texts(self) -> tuple[str, ...]:
        """The texts of the Python files."""
        sources: list[Source] = []
        for package in self.packages:
            sources += self.sources_of(package, (".py",))
        return tuple(source.text for source in sources)


def _read_yaml(data: bytes, path: str) -> YamlNode | YamlFault:
    try:
        return read_yaml(data, path)
    except YamlFault as fault:
        return fault


def _program_texts(package: Package) -> tuple[tuple[str, bytes | None], ...]:
    """Return the files of a package, each with its bytes unless its ending says that it has no
    code.
    """
    texts: list[tuple[str, bytes | None]] = []
    for path, file in package.tree.files.items():
        has_code = path == MANIFEST or file.suffix not in _NO_CODE
        texts.append((path, package.tree.read(path, _MAX_YAML) if has_code else None))
    return tuple(texts)


def _nodes_of(package: Package) -> PackageNodes:
    found = read_nodes(package)
    setup = package.installation
    if setup is None or not any(target.sources for target in setup.targets):
        return found
    from grader.ros.package.cpp_nodes import read_cpp_nodes  # late: few submissions have C++

    compiled = read_cpp_nodes(package)
    return found._replace(
        nodes=(*found.nodes, *compiled.nodes),
        programs=(*found.programs, *compiled.programs),
        doubts=(*found.doubts, *compiled.doubts),
        has_loose_declarations=found.has_loose_declarations or compiled.has_loose_declarations,
        imports=(*found.imports, *compiled.imports),
        field_uses=(*found.field_uses, *compiled.field_uses),
        faults=(*found.faults, *compiled.faults),
        synchronised=(*found.synchronised, *compiled.synchronised),
        loose_frames=compiled.loose_frames,
        texts=compiled.texts,
        cpp_files=compiled.cpp_files,
    )


def _wildcard_places_in(tree: YamlNode) -> frozenset[Location]:
    places: set[Location] = set()
    for keys, section in sections_in(tree):
        if not keys or any(key.strip("/") in ("*", "**") for key in keys):
            places |= {value.node.location for value in values_in(section)}
    return frozenset(places)


def _without_comments(package: Package, path: str) -> Source | None:
    """Return the text of a file with blanks in place of comments; None if it cannot be read."""
    data = package.tree.read(path, _MAX_YAML)
    if data is None:
        return None
    text = data.decode("utf-8", "replace")
    comment = _COMMENT_LINE if path.endswith(_WITH_LINES) else _XML_COMMENT
    return Source(package.path(path), comment.sub(_blank, text))


def _read_paths(package: Package, paths: Iterable[str]) -> list[str]:
    """Return the paths of a package's files that are read: no tests, none of packages in it, and
    not too many.
    """
    unread = ("test/", *package.inner)
    return [path for path in paths if not path.startswith(unread)][:_MAX_FILES]


def _spawned_by(node: StartedNode) -> Sequence[StartedNode]:
    """Return the controllers that a node starts, if it is a spawner whose arguments are known."""
    return (controllers_of(node) or ()) if node.executable in SPAWNERS else ()


def _without_macro(text: str, called: Collection[str]) -> str:
    """Return a text, which ends where a macro ends, without the macro if nothing calls it."""
    before, _, macro = text.partition("<xacro:macro")
    name = _NAME.search(macro.partition(">")[0])
    if name is not None and name[1] not in called:
        return before
    return text


def _blank(found: re.Match[str]) -> str:
    """Return blanks in place of a comment, so that places stay the same."""
    return re.sub(r"\S", " ", found[0])
