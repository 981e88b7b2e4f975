"""Whether something that is not read may open an end.

Only where nothing may, another end of its name is in vain.
"""

from fnmatch import fnmatchcase

from grader.base.names import last_part
from grader.base.records import Named
from grader.ros.known.package_rows import package_row
from grader.ros.launch.launch_model import StartedNode
from grader.ros.nodes.node_facts import EndpointKind
from grader.ros.package.package import Package
from grader.workspace.graph.bridge_rows import BRIDGE
from grader.workspace.graph.code_ends import opened_by
from grader.workspace.model.text_files import CPP_ENDINGS
from grader.workspace.model.workspace import Workspace


class Sought(Named):
    """An end that something may open which is not read: its kind, its full name and its type."""

    kind: EndpointKind
    name: str
    type: str | None  # None where it is not known


def is_own_type(workspace: Workspace, kind: str | None) -> bool:
    """Return whether a type is one of the workspace that only its own programs know.

    A package of the workspace defines it, and none relays what others send.
    """
    if any(package_row(node.package).relays for node in workspace.launches.nodes):
        return False
    return (kind or "").partition(".")[0] in workspace.code.interfaces


def may_be_opened(workspace: Workspace, sought: Sought) -> bool:
    """Return whether something that is not read may open an end that nothing is known to open."""
    if workspace.launches.has_more_nodes:
        return True
    is_own = is_own_type(workspace, sought.type)
    for node in workspace.launches.nodes:
        # A program of another package does not know an own type.
        is_of_workspace = workspace.find_package(node) is not None
        if (is_of_workspace or not is_own) and _may_open(workspace, node, sought):
            return True
    if sought.kind == "publisher":
        return False
    return any(nodes.doubts for nodes in workspace.code.by_package.values())


def may_publish_type(workspace: Workspace, node: StartedNode, message: str) -> bool:
    """Return whether a node may publish messages of a type, on whatever topic."""
    facts = workspace.code.own_node(node)
    if not facts:
        return "frames" not in package_row(node.package).without
    types = {end.type for end in facts.endpoints if end.kind == "publisher"}
    return bool(facts.doubts) or not types.isdisjoint({message, None})


def is_all_read(workspace: Workspace, launch: int) -> bool:
    """Return whether all topics are known that the nodes of a launch file open."""
    if workspace.launches.roots[launch][1].unknown:
        return False
    for number, node in workspace.launches.launched:
        may_command = number == launch and "commands" not in package_row(node.package).without
        if may_command and not workspace.code.is_read(node):
            return False
    return True


def _may_open(workspace: Workspace, node: StartedNode, sought: Sought) -> bool:
    """Return whether a node may open an end that it is not known to open."""
    package = workspace.find_package(node)
    if not package:
        return _may_be_of_other_package(workspace, node, sought)
    facts = workspace.code.own_node(node)
    if not facts:
        return sought.kind != "publisher" or _may_publish_unread(workspace, package, node, sought)
    if facts.doubts:
        return True
    if sought.kind != "publisher" and _is_renamed_to(node, last_part(sought.name)):
        return True
    computed = [end for end in opened_by(workspace, node) if not end.is_known]
    return any(end.kind == sought.kind and fnmatchcase(sought.name, end.name) for end in computed)


def _may_be_of_other_package(workspace: Workspace, node: StartedNode, sought: Sought) -> bool:
    """Return whether a program of another package may open an end."""
    is_publisher = sought.kind == "publisher"
    if node.package == BRIDGE and is_publisher:
        return not _is_plain_bridge(workspace, node)
    if "frames" not in package_row(node.package).without:
        return True
    return is_publisher and _is_remapped_to(node, sought.name)


def _may_publish_unread(
    workspace: Workspace, package: Package, node: StartedNode, sought: Sought
) -> bool:
    """Return whether an own program whose nodes are not known may publish a topic.

    Its texts say so.
    """
    texts = [source.text for source in workspace.texts.read_sources(package, CPP_ENDINGS)]
    last = last_part(sought.name)
    return not texts or any(last in text for text in texts) or _is_remapped_to(node, sought.name)


def _is_remapped_to(node: StartedNode, name: str) -> bool:
    """Return whether a node may have a name that is remapped to this one."""
    if node.remaps is None:
        return True
    return any(rule[1].strip("/") == name.strip("/") for rule in node.remaps)


def _is_renamed_to(node: StartedNode, last: str) -> bool:
    """Return whether a node has a remapping to a name that ends so."""
    return any(last_part(rule[1]) == last for rule in node.remaps or ())


def _is_plain_bridge(workspace: Workspace, node: StartedNode) -> bool:
    """Return whether all topics of a bridge are known: those of its arguments and of its file."""
    for given in node.parameters or ():
        file = given.values.get("config_file")
        if file:
            path = (
                workspace.installed.find_source(file.value) if isinstance(file.value, str) else None
            )
            if path not in workspace.installed.yaml:
                return False
    words_are_known = node.arguments is not None and None not in node.arguments
    return words_are_known and node.remaps == () and node.namespace in ("", "/")
