"""Whether something that is not read may publish a topic: only where nothing may is a subscription
in vain.
"""

from itertools import chain

from grader.ros.known.known import known
from grader.ros.launch.launch_model import StartedNode
from grader.ros.workspace.gazebo import BRIDGE
from grader.ros.workspace.workspace import Workspace

_SOURCES = (".cpp", ".cc", ".cxx", ".c", ".hpp", ".hh", ".h")
# Topics that drivers, players, and nodes which are started by hand publish.
_BY_OTHERS = (
    "cmd_vel",
    "joint_states",
    "odom",
    "scan",
    "tf",
    "tf_static",
    "map",
    "clock",
    "goal_pose",
    "initialpose",
    "joy",
    "robot_description",
    "imu",
    "rosout",
    "diagnostics",
)


def may_be_published(workspace: Workspace, topic: str) -> bool:
    """Return whether something may publish a topic for which no publisher is known."""
    first, last = topic.strip("/").partition("/")[0], topic.rpartition("/")[2]
    if last in _BY_OTHERS or first in workspace.controllers:
        return True
    if any(launch.more for _, _, launch in workspace.launches):
        return True
    root = workspace.robot_root
    remapped = root.iter("remapping", "ros_topic") if root is not None else ()
    texts = chain(
        (tree.source.text for _, tree in workspace.trees), (it.text or "" for it in remapped)
    )
    # A parameter, or a remapping of a plugin, may name what something publishes.
    if any(topic.strip("/") in text for text in texts):
        return True
    return any(_may_publish(workspace, node, topic) for _, node in workspace.nodes)


def _may_publish(workspace: Workspace, node: StartedNode, topic: str) -> bool:
    package = workspace.package_of(node)
    if package is not None:
        own = workspace.python_node(node)
        if own is not None:
            return bool(own.doubts) or any(
                it.name is None for it in own.endpoints if it.kind == "publisher"
            )
        texts = [source.text for source in workspace.sources_of(package, _SOURCES)]
        return (
            not texts
            or any(topic.rpartition("/")[2] in text for text in texts)
            or _is_remapped_to(node, topic)
        )
    if node.package == BRIDGE:
        return not _is_plain_bridge(workspace, node)
    return node.package not in known()["without_frames"] or _is_remapped_to(node, topic)


def _is_remapped_to(node: StartedNode, topic: str) -> bool:
    return node.remaps is None or any(
        rule[1].strip("/") == topic.strip("/") for rule in node.remaps
    )


def _is_plain_bridge(workspace: Workspace, node: StartedNode) -> bool:
    """Return whether all topics of a bridge are known: those of its arguments and of its file."""
    files = [
        it
        for given in node.parameters or ()
        for name, it in given.values.items()
        if name == "config_file"
    ]
    is_read = all(
        isinstance(it.value, str) and workspace.source_of(it.value) in workspace.yaml_files
        for it in files
    )
    words_are_known = node.arguments is not None and None not in node.arguments
    return is_read and words_are_known and node.remaps == () and node.namespace in ("", "/")
