"""The transforms that nodes publish, or may publish, as launch files start them.

They are what `ros2 run tf2_tools view_frames` would show.
"""

from collections.abc import Iterator, Sequence
from typing import Any, Literal, NamedTuple

from grader.base.source import Location
from grader.base.text import quoted
from grader.base.transforms import Transform
from grader.ros.known.gazebo_rows import NO_SYSTEM, gazebo
from grader.ros.known.package_rows import DecidingParameter, find_transforms, package_row
from grader.ros.launch.launch_model import STATE_PUBLISHER, StartedNode
from grader.ros.launch.node_parameters import NodeParameters
from grader.ros.package.package import Package
from grader.ros.package.static_transforms import (
    STATIC_PUBLISHER,
    frames_named,
    has_zero_rotation,
    static_pose,
)
from grader.ros.python.values import Unknown
from grader.ros.xml.parsing import Element
from grader.workspace.graph.bridge_rows import BRIDGE, rows_of_bridge
from grader.workspace.graph.code_ends import list_frames
from grader.workspace.graph.gazebo_topics import name_system, roots
from grader.workspace.graph.started_controllers import defined_controllers, spawned_controllers
from grader.workspace.model.workspace import Workspace

_EdgeSource = Literal["robot", "static", "code", "program", "controller", "Gazebo"]
_TF = "/tf"
_OF_ROBOT = 100  # parts of searching the plugins of a robot or a world
_MOVING = ("revolute", "continuous", "prismatic")
_PUBLISHED = ("publishes", "is above")


class Edge(NamedTuple):
    """A transform that something publishes, or may publish; a frame that is not known is empty.

    `Graph` makes the edges of a workspace. Rules that say that two programs place one frame read
    those that are certain; rules that say that nothing connects two frames read all.
    """

    parent: str
    child: str
    launch: int  # the number of the launch file that starts what publishes it
    source: _EdgeSource
    is_certain: bool
    by: str
    location: Location
    is_static: bool = False
    pose: Transform | None = None  # T_parent_child, where it never changes and is known
    # The topics of joint states without which robot_state_publisher does not publish it.
    needs: tuple[str, ...] = ()

    @property
    def is_known(self) -> bool:
        """Whether both frames are known."""
        return bool(self.parent and self.child)


def _edges_of_publishers(
    workspace: Workspace, launch: int, publishers: Sequence[StartedNode]
) -> Iterator[Edge]:
    """Yield the joints of the robots that robot_state_publishers of a launch file publish."""
    is_certain = any(not node.frame_prefix and publishes_as_named(node) for node in publishers)
    topics = [node.topic("joint_states") for node in publishers]
    states = tuple(topic for topic in topics if topic is not None)
    yield from _edges_of_robots(workspace, launch, states, is_certain=is_certain)


def edges_in(workspace: Workspace, launch: int) -> Iterator[Edge]:
    """Yield the transforms of the nodes and controllers of a launch file. Raises NotDecided."""
    package, file = workspace.launches.roots[launch]
    workspace.charge(1 + len(file.nodes))
    publishers = []
    for node in file.nodes:
        if node.executable == STATE_PUBLISHER:
            publishers.append(node)
        else:
            yield from _published_by(workspace, launch, package, node)
        if package_row(node.package).publishes_transforms or node.frame_prefix != "":
            yield Edge("", "", launch, "program", False, node.executable, node.location)
    if publishers:
        yield from _edges_of_publishers(workspace, launch, publishers)
    yield from _broadcast_by_controllers(workspace, launch)


def is_zero_rotation(node: StartedNode) -> bool:
    """Return whether a node certainly publishes a static transform that tf2 ignores.

    Its quaternion is 0 0 0 0.
    """
    is_static = (node.package, node.executable) == STATIC_PUBLISHER
    return is_static and publishes_as_named(node) and has_zero_rotation(node)


def _published_by(
    workspace: Workspace, launch: int, package: Package, node: StartedNode
) -> Iterator[Edge]:
    """Yield the transforms that a node publishes, but for those of the robot."""
    program = (node.package, node.executable)
    if program == (BRIDGE, "parameter_bridge"):
        yield from _broadcast_by_gazebo(workspace, launch, node)
    elif program == STATIC_PUBLISHER:
        parent, child = frames_named(node)
        pose = static_pose(node)
        is_certain = publishes_as_named(node) and not has_zero_rotation(node)
        yield Edge(
            parent or "",
            child or "",
            launch,
            "static",
            is_certain,
            node.executable,
            node.location,
            is_static=True,
            pose=pose,
        )
    else:
        yield from _edges_of_code(workspace, launch, node)
        if find_transforms("/".join(program)):
            given = workspace.parameters.given_to(package, node)
            for parent, child in _broadcast("/".join(program), given):
                is_certain = publishes_as_named(node)
                by, at = node.executable, node.location
                yield Edge(parent, child, launch, "program", is_certain, by, at)


def publishes_as_named(node: StartedNode) -> bool:
    """Return whether a node is started for certain, and publishes on /tf."""
    if node.when is not True or node.namespace or node.remaps is None:
        return False
    return not any("tf" in rule[0] for rule in node.remaps)


def _edges_of_code(workspace: Workspace, launch: int, node: StartedNode) -> Iterator[Edge]:
    """Yield the transforms of own code.

    Which of its frames is in which one is not known: each is connected with the first.
    """
    first = ""
    for name, frame in list_frames(workspace, node):
        if frame.use in _PUBLISHED:
            first = first or name or ""
            yield Edge(first, name or "", launch, "code", False, node.executable, frame.location)


def _edges_of_robots(
    workspace: Workspace, launch: int, states: tuple[str, ...], *, is_certain: bool
) -> Iterator[Edge]:
    """Yield the joints of the robots, which robot_state_publisher publishes.

    `states` are the topics of the states of joints that move.

    It is certain where it is known of which robot.
    """
    is_one = len(workspace.robots.known) == 1 and not workspace.robots.may_be_others
    for known_robot in workspace.robots.known:
        for joint in known_robot.robot.joints:
            if joint.location is None:
                continue
            pose = None
            if joint.type == "fixed" and joint.origin is not None:
                pose = joint.origin.placed_in()
            yield Edge(
                joint.parent,
                joint.child,
                launch,
                "robot",
                is_certain and is_one,
                f"the joint {quoted(joint.name)} of the robot",
                joint.location.resolve(),
                is_static=pose is not None,
                pose=pose,
                needs=states if joint.type in _MOVING else (),
            )


def _broadcast_by_controllers(workspace: Workspace, launch: int) -> Iterator[Edge]:
    """Yield the transforms of the controllers that a launch file spawns."""
    spawned = spawned_controllers(workspace, launch)
    for controller in defined_controllers(workspace):
        if controller.name not in spawned or spawned[controller.name]:
            continue  # a remapping may be of /tf
        gifts = workspace.parameters.owners.get(controller.name, [])
        if len(gifts) == 1:
            for parent, child in _broadcast(controller.type.text or "", gifts[0]):
                by, at = controller.name, controller.location
                yield Edge(parent, child, launch, "controller", True, by, at)


def _broadcast_by_gazebo(workspace: Workspace, launch: int, bridge: StartedNode) -> Iterator[Edge]:
    """Yield the transforms of systems of Gazebo that a bridge publishes on /tf.

    The systems are those that name their frames.
    """
    if bridge.namespace not in ("", "/"):
        return
    topics = set()
    for row in rows_of_bridge(workspace, bridge):
        if row.is_published and bridge.topic(f"/{row.ros}") == _TF:
            topics.add(row.gz)
    for root, place in roots(workspace) if topics else ():
        plugins = [*root.iter("plugin")]
        workspace.charge(_OF_ROBOT + len(plugins))
        for plugin in plugins:
            topic = (plugin.findtext("tf_topic") or "").strip().strip("/")
            frames = frames_of_system(plugin) if topic in topics else None
            if frames is not None:
                is_certain = bridge.when is True
                by = f"the system {name_system(plugin)} of Gazebo"
                yield Edge(*frames, launch, "Gazebo", is_certain, by, place(plugin))


def frames_of_system(plugin: Element) -> tuple[str, str] | None:
    """Return parent and child of the transform that a system of Gazebo publishes.

    The result is None if it does not name both.
    """
    frames = gazebo().system.get(name_system(plugin), NO_SYSTEM).transform
    if frames is None:
        return None
    parent = (plugin.findtext(frames.parent) or "").strip()
    child = (plugin.findtext(frames.child) or "").strip()
    return (parent, child) if parent and child else None


def _broadcast(kind: str, given: NodeParameters) -> Iterator[tuple[str, str]]:
    """Yield parent and child of the transforms that a program or controller publishes.

    The parameters of the program or controller name them.
    """
    for row in find_transforms(kind):
        parts = [row.on, row.parent, row.child, *row.if_equal]
        values = [_value(given, part) for part in parts]
        if given.unknown or None in values:
            continue
        on, parent, child, *equal = values
        if on != row.on.off and len({*equal}) < 2:
            yield str(parent).strip("/"), str(child).strip("/")


def _value(given: NodeParameters, part: DecidingParameter) -> Any:
    """Return the value of a parameter, or its default; None where it is not known."""
    row = given.values.get(part.parameter)
    value = row.value if row is not None else part.default
    return None if isinstance(value, Unknown) else value
