"""Whether something that is not read may publish a topic: only where nothing may is a subscription
in vain.
"""

from fnmatch import fnmatchcase

from grader.ros.known.known import known
from grader.ros.launch.launch_model import StartedNode
from grader.ros.workspace.graph.bridge_rows import BRIDGE
from grader.ros.workspace.graph.endpoints import ANY, opened_by
from grader.ros.workspace.model.workspace import Workspace

_SOURCES = (".cpp", ".cc", ".cxx", ".c", ".hpp", ".hh", ".h")


def is_own_type(workspace: Workspace, kind: str | None) -> bool:
    """Return whether a package of the workspace defines a type, and only its own programs know it:
    none relays what others send.
    """
    if any(node.package in known()["relaying"] for _, node in workspace.nodes):
        return False
    return (kind or "").partition(".")[0] in workspace.interfaces


def may_be_published(workspace: Workspace, topic: str, kind: str | None) -> bool:
    """Return whether something may publish a topic of a type for which no publisher is known."""
    if any(launch.more for _, _, launch in workspace.launches):
        return True
    if is_own_type(workspace, kind):
        own = [node for _, node in workspace.nodes if workspace.package_of(node) is not None]
        return any(may_be_published_by(workspace, node, topic) for node in own)
    name = topic.strip("/")
    first, last = name.partition("/")[0], topic.rpartition("/")[2]
    if last in known()["topics_of_others"] or first in workspace.controllers:
        return True
    # A parameter, or a remapping of a plugin, may name what something publishes.
    if any(name in tree.source.text for _, tree in workspace.trees):
        return True
    for robot in workspace.robots:
        if any(name in (it.text or "") for it in robot.root.iter("remapping", "ros_topic")):
            return True
    return any(may_be_published_by(workspace, node, topic) for _, node in workspace.nodes)


def may_be_published_by(workspace: Workspace, node: StartedNode, topic: str) -> bool:
    """Return whether a node may publish a topic that it is not known to publish."""
    package = workspace.package_of(node)
    if package is None:
        if node.package == BRIDGE:
            return not _is_plain_bridge(workspace, node)
        return node.package not in known()["without_frames"] or _is_remapped_to(node, topic)
    own_node = workspace.own_node(node)
    if own_node is not None:
        opened = opened_by(workspace, node)
        names = [each.name or ANY for each in opened if each.endpoint.kind == "publisher"]
        return bool(own_node.doubts) or any(ANY in it and fnmatchcase(topic, it) for it in names)
    texts = [source.text for source in workspace.sources_of(package, _SOURCES)]
    last = topic.rpartition("/")[2]
    return not texts or any(last in text for text in texts) or _is_remapped_to(node, topic)


def _is_remapped_to(node: StartedNode, topic: str) -> bool:
    return node.remaps is None or any(
        rule[1].strip("/") == topic.strip("/") for rule in node.remaps
    )


def _is_plain_bridge(workspace: Workspace, node: StartedNode) -> bool:
    """Return whether all topics of a bridge are known: those of its arguments and of its file."""
    for given in node.parameters or ():
        file = given.values.get("config_file")
        if file is not None:
            path = workspace.source_of(file.value) if isinstance(file.value, str) else None
            if path not in workspace.yaml_files:
                return False
    words_are_known = node.arguments is not None and None not in node.arguments
    return words_are_known and node.remaps == () and node.namespace in ("", "/")
