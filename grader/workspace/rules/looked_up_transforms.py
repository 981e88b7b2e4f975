"""Transforms that own nodes look up between frames that are there, and that nothing connects."""

from collections.abc import Iterator
from functools import lru_cache

from grader.base.grouping import Strings
from grader.base.records import Named
from grader.base.source import Location
from grader.base.text import quoted
from grader.ros.known.gazebo_rows import gazebo
from grader.workspace.graph.code_ends import list_frames
from grader.workspace.graph.gazebo_topics import list_systems
from grader.workspace.graph.graph import make_graph
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.frames import openings
from grader.workspace.rules.names import Compared, Mismatch, warning
from grader.workspace.rules.rule_table import (
    UNCONNECTED,
    Rule,
)
from grader.workspace.rules.shared_symptoms import TREES_NOT_CONNECTED

_FILTERS = ("robot_localization/ekf_node", "robot_localization/ukf_node")
# The parameters with their frames, and the defaults of these.
_FRAMES = (
    ("world_frame", "odom"),
    ("map_frame", "map"),
    ("odom_frame", "odom"),
    ("base_link_frame", "base_link"),
)


class _Lookup(Named):
    """A transform that a node looks up."""

    frames: tuple[str, str]
    location: Location
    known: Strings = ()  # programs of which all transforms are known


class _Trees:
    """The frames that are published, and which of them transforms connect."""

    def __init__(self) -> None:
        self._number: dict[str, int] = {}
        self._members: list[list[str]] = []

    def connect(self, *frames: str) -> None:
        """Add that there are transforms between frames."""
        for frame in frames:
            if frame not in self._number:
                self._number[frame] = len(self._members)
                self._members.append([frame])
            first, second = sorted((self._number[frames[0]], self._number[frame]))
            if first != second:
                moved = self._members[second]
                self._members[second] = []
                self._members[first] += moved
                self._number.update(dict.fromkeys(moved, first))

    def are_apart(self, one: str, other: str) -> bool:
        """Return whether two frames are published, and not connected."""
        numbers = self._number.get(one), self._number.get(other)
        return None not in numbers and numbers[0] != numbers[1]


_TRANSFORM_CONNECTED = Rule(
    "transform-connected",
    "transforms",
    UNCONNECTED,
    "The frames between which a node looks up a transform are connected.",
    why=(
        "Each lookup fails with a ConnectivityException, because the two frames are not part of"
        " the same tree. Code without a handler stops there."
    ),
    symptoms=(TREES_NOT_CONNECTED,),
    wrong="self.buffer.lookup_transform('map', 'lidar', rclpy.time.Time())",
    right="self.buffer.lookup_transform('base_link', 'lidar', rclpy.time.Time())",
    frame="tick/pilot.py",
    beside={
        "rover.launch.py": """
Node(package='robot_state_publisher', executable='robot_state_publisher',
     parameters=[{'robot_description': robot}]),
Node(package='tf2_ros', executable='static_transform_publisher',
     arguments=['--frame-id', 'map', '--child-frame-id', 'dock']),
Node(package='rover', executable='pilot'),
""",
        "lidar/rover.urdf": "",
    },
)


def lookup_facts(workspace: Workspace) -> Iterator[Compared | Mismatch]:
    """Yield the transforms that are looked up between frames that nothing connects.

    Launch files publish the frames, and certainly nothing that these start connects them. A
    program in another terminal may publish other frames, such as the map, and is not likely to
    connect these.
    """
    lookups = list(_lookups(workspace))
    if not lookups or any(fact.kind == "frame" for fact in openings(workspace)):
        return
    for lookup in lookups:
        target, source = lookup.frames
        trees = _published(workspace, lookup.known)
        if not trees:
            continue
        yield Compared("transforms")
        if trees.are_apart(target, source):
            message = (
                f"nothing that is started connects {quoted(target)} and {quoted(source)}, so this "
                "lookup fails"
            )
            at = lookup.location
            yield warning(_TRANSFORM_CONNECTED, message, at)._replace(names=(target, source))


def _lookups(workspace: Workspace) -> Iterator[_Lookup]:
    """Yield what nodes that are certainly started look up, where both frames are known.

    A filter of robot_localization in the map needs the odometry of another source: ros_filter.cpp.
    """
    for package, node in workspace.launches.placed_nodes:
        if not node.when:
            continue
        if node.name in _FILTERS:
            parameters = workspace.parameters.given_to(package, node)
            given = parameters.values
            frames = [given[name].value if name in given else default for name, default in _FRAMES]
            is_in_map = frames[0] == frames[1] and "world_frame" in given
            if is_in_map and not parameters.unknown:
                looked_up = (str(frames[2]), str(frames[3]))
                yield _Lookup(looked_up, given["world_frame"].location, (node.executable,))
        by_call: dict[Location, list[str]] = {}
        for name, frame in list_frames(workspace, node):
            if frame.lookup:
                by_call.setdefault(frame.lookup, []).append((name or "").removeprefix("/"))
        for at, names in by_call.items():
            if len(names) == 2:
                yield _Lookup((names[0], names[1]), at)


@lru_cache(maxsize=4)
def _published(workspace: Workspace, known: Strings) -> _Trees | None:
    """Return what launch files publish, whatever conditions say; None where that is not known.

    Of some programs all is known.
    """
    if not list_systems(workspace).isdisjoint(gazebo().odometry_systems):
        return None
    trees = _Trees()
    for edge in make_graph(workspace).edges:
        if not edge.is_known:
            if edge.by in known:
                continue
            return None
        trees.connect(edge.parent.removeprefix("/"), edge.child.removeprefix("/"))
    return trees
