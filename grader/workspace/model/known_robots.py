"""The robots of a workspace as ROS 2 loads them, and what their files say of others."""

import posixpath
import re
from collections.abc import Collection, Iterator, Mapping
from functools import cached_property, lru_cache

from grader.base.patterns import on_use
from grader.base.records import Record
from grader.base.source import LazyLocation, Location, Source
from grader.ros.installation.places import SHARE, share_parts
from grader.ros.launch.launch_model import GivenParameters
from grader.ros.package.robot_file import Read
from grader.ros.urdf.model import Robot
from grader.ros.xml.elements import first_text, readable
from grader.ros.xml.parsing import Element
from grader.workspace.model.launches import CONTROL_NODE, Launches
from grader.workspace.model.text_files import TextFiles
from grader.workspace.model.workspace_folder import WorkspaceFolder

# Plugins of hardware that have the interfaces which <ros2_control> lists, and no others.
_LISTED_HARDWARE = (
    *("mock_components/GenericSystem", "fake_components/GenericSystem"),
    *("gz_ros2_control/GazeboSimSystem", "ign_ros2_control/IgnitionSystem"),
    *("gazebo_ros2_control/GazeboSystem", "topic_based_ros2_control/TopicBasedSystem"),
)
_SYSTEM = on_use(r"<ros2_control\b")
_NAME = on_use(r"\bname=[\"'](?:xacro:)?([\w.-]+)[\"']")
_CALLED = on_use(r"<xacro:(?:[\w-]+\.)*([\w-]+)")
_PACKAGE_IN = on_use("the package '([\\w-]+)'")  # in the reason why a path is not known
INCLUDED = on_use(r"<xacro:include\b[^<>]*?\bfilename\s*=\s*[\"']([^\"']+)[\"']")
_EXPRESSION = re.compile(r"\$\{([^{}]*)")
_WORD = re.compile(r"\w+")
_FOUND = on_use(r"\$\(find ([\w-]+)\)/")


class KnownRobot(Record):
    """A robot as ROS 2 loads it, expanded, of which everything is known."""

    path: str
    robot: Robot
    root: Element  # the <robot>
    source: Source

    @cached_property
    def systems(self) -> list[Element]:
        """The <ros2_control> elements."""
        return list(self.root.iterchildren("ros2_control"))

    @property
    def has_controller_manager(self) -> bool:
        """Whether it has one in Gazebo."""
        plugins = self.root.iter("plugin")
        return any("ros2_control" in plugin.get("filename", "") for plugin in plugins)

    def place(self, element: Element) -> Location:
        """Return where an element is written."""
        return LazyLocation(self.source, self._positions[element]).resolve()

    @cached_property
    def _positions(self) -> Mapping[Element, int]:
        """The position of each element in document order."""
        return {element: tag for tag, element in enumerate(self.root.iter("*"))}


class Robots(Record):
    """The robots of a workspace as ROS 2 loads them, and what their files say of others."""

    urdfs: tuple[Read, ...]  # the files of robots that are read
    has_unread_robots: bool  # whether other files may be robots
    folder: WorkspaceFolder
    texts: TextFiles
    launches: Launches

    @cached_property
    def known(self) -> tuple[KnownRobot, ...]:
        """The robots of which everything is known."""
        return tuple(robot for urdf in self.urdfs if (robot := _known_robot(urdf)))

    @property
    def may_be_others(self) -> bool:
        """Whether there may be other robots than `robots`, which names may belong to."""
        is_unknown = len(self.known) < len(self.urdfs)
        return self.has_unread_robots or is_unknown or self._loads_others

    @cached_property
    def _loads_others(self) -> bool:
        """Whether a launch file loads a robot of a package that is not there."""
        for package, _, launch in self.launches.files:
            for named in launch.named("urdf"):
                names = {share_parts(named.path or "")[0], *_PACKAGE_IN.findall(named.reason)}
                if any(name and not package.find(name) for name in names):
                    return True
        return False

    @property
    def has_controller_manager(self) -> bool:
        """Return whether a launch file or the robot starts a controller manager.

        The robot has one in Gazebo.
        """
        is_started = any(node.executable == CONTROL_NODE for node in self.launches.nodes)
        return is_started or self.has_controllers_in_gazebo

    @cached_property
    def has_controllers_in_gazebo(self) -> bool:
        """Whether a robot has a controller manager in Gazebo."""
        return any(robot.has_controller_manager for robot in self.known)

    @cached_property
    def has_all_interfaces(self) -> bool:
        """Return whether the command interfaces of every robot are known.

        This includes the robots under other arguments of xacro.
        """
        if not self.known or self.may_be_others:
            return False
        text = "".join(source.text for source in self.xacro_sources)
        called = {*_CALLED.findall(text)}
        if "call" not in called:  # <xacro:call macro="..."/> may compute the name
            *macros, rest = text.split("</xacro:macro>")
            text = "".join(_without_macro(macro, called) for macro in macros) + rest
        written = len(_SYSTEM.findall(text))
        return written <= sum(len(robot.systems) for robot in self.known)

    @cached_property
    def files(self) -> frozenset[str]:
        """The files that the robots are made of, by their paths; empty where none is known."""
        files = set()
        for robot in self.known:
            files |= {robot.path, *(robot.place(element).path for element in robot.root.iter("*"))}
        return frozenset(files)

    @cached_property
    def xacro_sources(self) -> tuple[Source, ...]:
        """The texts of the xacro files and URDFs, and of what they include.

        Included files may have other endings.
        """
        sources = list(self.texts.every_source((".xacro", ".urdf")))
        names = set()
        for source in sources:
            names |= {posixpath.basename(path) for path in INCLUDED.findall(source.text)}
        others = tuple(name for name in names if name and not name.endswith((".xacro", ".urdf")))
        return (*sources, *self.texts.every_source(others))

    @cached_property
    def words_in_expressions(self) -> frozenset[str]:
        """The words in the expressions of the xacro files."""
        words = set()
        for source in self.xacro_sources:
            for expression in _EXPRESSION.findall(source.text):
                words.update(_WORD.findall(expression))
        return frozenset(words)

    @property
    def given_in_gazebo(self) -> Iterator[GivenParameters]:
        """The files that the robots give to the controller manager in Gazebo."""
        for _, given in self.files_in_gazebo:
            yield given

    @property
    def files_in_gazebo(self) -> Iterator[tuple[KnownRobot, GivenParameters]]:
        """The same files, each with the robot that gives it."""
        for robot in self.known:
            for element in robot.root.iter("parameters"):
                path = _FOUND.sub(rf"{SHARE}/\1/", readable(first_text(element)))
                if path.startswith(SHARE):
                    yield robot, GivenParameters(robot.place(element), path)


@lru_cache(maxsize=16)  # parameter files that are compared with the same robots
def command_interfaces(
    robots: tuple[KnownRobot, ...],
) -> Mapping[str, tuple[frozenset[str], Location]]:
    """Return the command interfaces of the joints in <ros2_control> of some robots.

    A joint without any is left to its hardware, unless that is known to have what is listed.
    """
    interfaces: dict[str, tuple[frozenset[str], Location]] = {}
    for robot in robots:
        for system in robot.systems:
            plugin = next(system.iterfind("hardware/plugin"), None)
            is_own = plugin is not None and first_text(plugin) not in _LISTED_HARDWARE
            for joint in system.iterchildren("joint"):
                if is_own and next(joint.iterchildren("command_interface"), None) is None:
                    continue
                name = joint.get("name", "")
                added = joint.iterchildren("command_interface")
                before, at = interfaces.get(name, (frozenset[str](), robot.place(joint)))
                interfaces[name] = (before.union(each.get("name", "") for each in added), at)
    return interfaces


@lru_cache(maxsize=16)
def state_interfaces(robots: tuple[KnownRobot, ...]) -> Mapping[str, frozenset[str]]:
    """Return the state interfaces of the joints of hardware that has those that are listed."""
    interfaces: dict[str, frozenset[str]] = {}
    for robot in robots:
        for system in robot.systems:
            plugin = system.findtext("hardware/plugin", "").strip()
            for joint in system.iterchildren("joint") if plugin in _LISTED_HARDWARE else ():
                name = joint.get("name", "")
                added = [each.get("name", "") for each in joint.iterchildren("state_interface")]
                interfaces[name] = interfaces.get(name, frozenset()).union(added)
    return interfaces


def _known_robot(urdf: Read) -> KnownRobot | None:
    loaded = urdf.loaded
    is_known = not loaded.undetermined and loaded.verdict != "rejected"
    if is_known and loaded.robot and loaded.root is not None:
        return KnownRobot(urdf.path, loaded.robot, loaded.root, loaded.source)
    return None


def _without_macro(text: str, called: Collection[str]) -> str:
    """Return a text, which ends where a macro ends, without the macro if nothing calls it."""
    before, _, macro = text.partition("<xacro:macro")
    name = _NAME.search(macro.partition(">")[0])
    if name and name[1] not in called:
        return before
    return text
