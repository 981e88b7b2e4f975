"""Plugins of Gazebo Classic: whether robots and models use those of ROS 2, and their elements."""

from grader.base.source import Location
from grader.base.text import enumerated
from grader.ros.known.gazebo_rows import gazebo
from grader.ros.xml.parsing import Element
from grader.workspace.graph.gazebo_topics import elements_in
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    Mismatches,
    warning,
)
from grader.workspace.rules.rule_table import (
    NO_WORD,
    Rule,
)
from grader.workspace.rules.used_packages import OF_TESTS

_LIBRARY = "libgazebo_ros_"
_RATE = "updateRate"


def classic_plugin_facts(workspace: Workspace) -> Facts:
    """Yield the plugins of ROS 1, and their elements that plugins of ROS 2 do not read.

    A library that the workspace builds may read any element, and one beside the element of ROS 2
    does no harm.
    """
    built = set()
    for package in workspace.packages:
        setup = package.installation
        built |= {target.name for target in setup.targets} if setup else set()
    for plugin, place in elements_in(workspace, "plugin"):
        library = plugin.get("filename", "")
        at = place(plugin)
        name = library.removeprefix("lib").removesuffix(".so")
        if not library.startswith(_LIBRARY) or name in built or OF_TESTS.search(at.path):
            continue
        owners = [each for each in workspace.packages if each.holds(at.path)]
        if not any(owner.is_of_ros1 for owner in owners):
            yield Compared("words")
            yield from _wrong_plugin(plugin, library, at)


_CLASSIC_PLUGIN = Rule(
    "classic-plugin",
    "words",
    NO_WORD,
    "The plugins of Gazebo Classic and their elements are those of ROS 2.",
    why=(
        "Gazebo Classic does not load a library of ROS 1, and plugins ignore elements that they"
        " do not know. Topics, frames and rates keep their defaults."
    ),
    wrong="""
  <gazebo>
    <plugin name="drive" filename="libgazebo_ros_diff_drive.so">
      <robotBaseFrame>base_link</robotBaseFrame>
    </plugin>
  </gazebo>
""",
    right="""
  <gazebo>
    <plugin name="drive" filename="libgazebo_ros_diff_drive.so">
      <robot_base_frame>base_link</robot_base_frame>
    </plugin>
  </gazebo>
""",
    frame="rover.urdf",
)


def _wrong_plugin(plugin: Element, library: str, at: Location) -> Mismatches:
    """Yield that a plugin is one of ROS 1, or has elements of ROS 1."""
    classic = gazebo().classic
    if library in classic.libraries:
        instead = classic.libraries[library]
        message = f"ROS 2 has no plugin {library}, so Gazebo does not load it: use {instead}"
        yield warning(_CLASSIC_PLUGIN, message, at)
        return
    name = library.removeprefix(_LIBRARY).removesuffix(".so")
    given = [child.tag for child in plugin]
    if name not in classic.plugins:
        return
    written = []
    for tag in given:
        is_read = tag not in classic.elements or classic.elements[tag].strip("<>") in given
        is_of_sensor = tag == _RATE and name in classic.of_sensors
        if not is_read and not is_of_sensor:
            written.append(tag)
    if written:
        unread = enumerated([f"<{tag}>" for tag in written], word="or")
        instead = enumerated(dict.fromkeys(classic.elements[tag] for tag in written))
        message = f"{library} of ROS 2 does not read {unread}, as in ROS 1, but {instead}"
        yield warning(_CLASSIC_PLUGIN, message, at)
