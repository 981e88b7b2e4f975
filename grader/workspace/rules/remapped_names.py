"""Remappings of names that no node has, and how many topics of own code are compared."""

from collections.abc import Mapping, Sequence

from grader.base.grouping import Strings
from grader.base.text import enumerated
from grader.ros.launch.launch_model import StartedNode
from grader.workspace.graph.code_ends import opened_by
from grader.workspace.graph.graph import Graph, make_graph
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import Counted, Definition, Facts, Use

_MAX_NAMED = 3  # programs


def remapping_facts(workspace: Workspace) -> Facts:
    """Yield the names that nodes have, and those that remappings of one node alone replace.

    It is said as well how many topics are compared.
    """
    owners = _owners_of_rules(workspace)
    read = set()
    for _, node in workspace.launches.launched:
        key = (node.package, node.executable, node.location, node.remaps)
        if node.when is not False and key not in read:
            read.add(key)
            rules = [rule for rule in node.remaps or () if len(owners[rule]) == 1]
            yield from _remappings(workspace, node, rules)
    yield _count(make_graph(workspace))


def _owners_of_rules(workspace: Workspace) -> Mapping[Strings, list[StartedNode]]:
    """Return of each remapping the first two nodes that have it."""
    owners: dict[Strings, list[StartedNode]] = {}
    for node in workspace.launches.nodes:
        for rule in node.remaps or ():
            of_rule = owners.setdefault(rule, [])
            if len(of_rule) < 2 and not any(node is owner for owner in of_rule):
                of_rule.append(node)
    return owners


def _remappings(workspace: Workspace, node: StartedNode, rules: Sequence[Strings]) -> Facts:
    """Yield the names that a node has, and those that these remappings, of it alone, replace.

    A node that may open others, as by a computed name, may have each of them.
    """
    facts = workspace.code.own_node(node)
    if not facts or node.remaps is None:
        return
    owner = f"{node.program_path} {node.location.file_and_line}"
    for endpoint in facts.endpoints:
        if endpoint.name is not None:
            yield Definition("topic", _bare(endpoint.name), endpoint.location, owner)
    is_open = bool(facts.doubts)
    for opened in opened_by(workspace, node._replace(remaps=(), namespace="")):
        if opened.is_known:
            yield Definition("topic", _bare(opened.name), opened.location, owner)
        else:
            is_open = True
    for rule in () if is_open else rules:
        name = _bare(rule[0])
        if not name.startswith("__") and ":" not in name:
            # Actions and what rclpy itself opens, such as /tf, are not listed.
            said = f"the remapping of {node.executable}"
            yield Use("topic", name, node.location, said, owner, optional=True)


def _bare(name: str) -> str:
    return name.removeprefix("~").removeprefix("/")


def _count(graph: Graph) -> Counted:
    """Return how many topics of own code have another end, and why not all are known.

    A node, a controller, a bridge or a well-known program opens the other end.
    """
    ends = {"publisher": graph.names_opened("subscription")}
    ends["subscription"] = graph.names_opened("publisher")
    total = 0
    known = 0
    compared = 0
    for end in graph.ends:
        if end.source == "code" and end.kind in ends:
            total += 1
            known += end.is_known
            compared += end.is_known and end.name in ends[end.kind]
    reasons = []
    computed = total - known
    if computed:
        reasons.append(f"{computed} {'is' if computed == 1 else 'are'} computed")
    unread = _unread_programs(graph.workspace)
    if unread:
        reasons.append(f"the source of {enumerated(unread, _MAX_NAMED)} is not read")
    return Counted("topics", compared, total, ", and ".join(reasons))


def _unread_programs(workspace: Workspace) -> list[str]:
    """Return the programs of the workspace that are started and whose nodes are not known."""
    programs = set()
    for _, node in workspace.launches.launched:
        owner = workspace.find_package(node)
        if node.when is False or not owner or workspace.code.own_node(node):
            continue
        if owner.has_program(*node.program):
            programs.add(node.executable)
    return sorted(programs)
