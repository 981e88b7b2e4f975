"""Arguments that launch files and xacro declare, and that nothing uses."""

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from re import Match

from grader.base.names import last_part
from grader.base.patterns import on_use
from grader.base.source import Source
from grader.base.text import enumerated, quoted
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.arguments import includes_others
from grader.workspace.rules.names import (
    Compared,
    Facts,
    Mismatches,
    warning,
)
from grader.workspace.rules.rule_table import (
    UNREAD,
    Rule,
)

_DECLARED = on_use(r"\bDeclareLaunchArgument\(\s*+(?:name\s*+=\s*+)?[\"'](\w++)[\"']")
_BOUND = on_use(r"^[ \t]*+(\w++)\s*+=\s*+LaunchConfiguration\(\s*+[\"'](\w++)[\"']", re.MULTILINE)
_WORD = on_use(r"(?<![\w\"'])[A-Za-z_]\w*+(?![\"'])")  # outside of texts
_TEXT = on_use(r"[\"'](\w++)[\"']")
# With one of these, others may use an argument, or text that is not read.
_OTHER_USERS = (
    "IncludeLaunchDescription",
    "allow_substs",
    "launch_configurations",
    "import_module",
)
_COMPUTED = on_use(r"LaunchConfiguration\((?!\s*+(?:\w++\s*+=\s*+)?[\"']\w*+[\"']\s*+[,)])")
_IMPORTED = on_use(r"^[ \t]*+(?:from|import)\s++(\w++)", re.MULTILINE)
_XACRO_DECLARED = on_use(r"<xacro:arg\s++name\s*+=\s*+[\"']([\w-]++)[\"']")
_XACRO_USED = on_use(r"\$\(arg\s++([\w-]++)|\barg\(\s*+[\"'](\w++)")


def unused_argument_facts(workspace: Workspace) -> Facts:
    """Yield the arguments that are declared, and that nothing in the files uses.

    A launch file that includes another one shares its arguments with it.
    """
    yield from _of_launch_files(workspace)
    yield from _of_xacro(workspace)


_LAUNCH_ARGUMENT_USED = Rule(
    "launch-argument-used",
    "words",
    UNREAD,
    "A launch file uses the arguments that it declares.",
    why=(
        "ros2 launch --show-args lists the argument and a value is accepted, but it changes "
        "nothing: nodes run as without it."
    ),
    wrong="""
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('use_sim_time', default_value='true'),
        Node(package='turtlesim', executable='turtlesim_node'),
    ])
""",
    right="""
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    time = LaunchConfiguration('use_sim_time')
    return LaunchDescription([
        DeclareLaunchArgument('use_sim_time', default_value='true'),
        Node(package='turtlesim', executable='turtlesim_node', parameters=[{'use_sim_time': time}]),
    ])
""",
    frame="turtle.launch.py",
)


def _of_launch_files(workspace: Workspace) -> Facts:
    """Yield the arguments of launch files in Python whose names nothing else in the file has."""
    for package in workspace.packages:
        for source in workspace.texts.launch_sources(package):
            if _may_be_used_otherwise(workspace, source):
                continue
            yield Compared("words")
            counts = Counter(_TEXT.findall(source.text)) - _count_unread(source.text)
            declared = list(_DECLARED.finditer(source.text))
            unused = [match for match in declared if counts[match[1]] == 1]
            if unused:
                message = f"nothing in the launch file uses the {_named(unused)}"
                yield warning(_LAUNCH_ARGUMENT_USED, message, source.at(unused[0].start(1)))


def _named(unused: Sequence[Match[str]]) -> str:
    """Return the names of arguments as words: `arguments 'speed' and 'world'`."""
    names = enumerated([quoted(match[1]) for match in unused])
    return f"argument {names}" if len(unused) == 1 else f"arguments {names}"


def _count_unread(text: str) -> Counter[str]:
    """Return how often a value of an argument is bound to a variable that nothing reads."""
    read = Counter(_WORD.findall(text))
    return Counter(match[2] for match in _BOUND.finditer(text) if read[match[1]] == 1)


def _may_be_used_otherwise(workspace: Workspace, source: Source) -> bool:
    """Return whether the arguments of a launch file may be used otherwise than by their names."""
    text = source.text
    name = last_part(source.path)
    if any(word in text for word in _OTHER_USERS) or _COMPUTED.search(text):
        return True
    modules = workspace.own_packages.keys()
    if not modules.isdisjoint(_IMPORTED.findall(text)):
        return True
    return any(name in other and other != text for other in workspace.texts.launch_texts)


def _used_arguments(sources: Iterable[Source]) -> set[str]:
    """Return the arguments of xacro that texts use."""
    used = set()
    for source in sources:
        for match in _XACRO_USED.finditer(source.text):
            used.add(match[1] or match[2])
    return used


_XACRO_ARGUMENT_USED = Rule(
    "xacro-argument-used",
    "words",
    UNREAD,
    "The files of xacro use the arguments that they declare.",
    why=(
        "xacro accepts any value and prints the same robot. A change of the value has no effect"
        " in RViz or Gazebo."
    ),
    wrong="""
<robot name="rover" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="height" default="0.2"/>
  <link name="base_link"/>
</robot>
""",
    right="""
<robot name="rover" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="height" default="0.2"/>
  <link name="base_link">
    <visual><geometry><box size="0.4 0.3 $(arg height)"/></geometry></visual>
  </link>
</robot>
""",
    frame="rover.urdf.xacro",
    beside={
        "rover.urdf": "",
    },
)


def _of_xacro(workspace: Workspace) -> Mismatches:
    """Yield the arguments of xacro that no file of xacro in the workspace uses.

    A file of another package that one includes may use any.
    """
    sources = list(workspace.robots.xacro_sources)
    if any(includes_others(workspace, source) for source in sources):
        return
    used = _used_arguments(sources)
    for source in sources:
        unused = [match for match in _XACRO_DECLARED.finditer(source.text) if match[1] not in used]
        if unused:
            message = f"nothing uses the {_named(unused)} of xacro"
            yield warning(_XACRO_ARGUMENT_USED, message, source.at(unused[0].start(1)))
