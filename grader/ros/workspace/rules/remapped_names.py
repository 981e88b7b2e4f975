"""Remappings of names that no node has, and how many topics of own code are compared."""

from collections.abc import Iterator, Sequence

from grader.base.text import enumerated
from grader.ros.launch.launch_model import StartedNode
from grader.ros.workspace.graph.bridge_rows import bridge_rows
from grader.ros.workspace.graph.code_ends import END_SOURCES, opened_by
from grader.ros.workspace.graph.graph import Graph, graph_of
from grader.ros.workspace.model.workspace import Workspace
from grader.ros.workspace.rules.names import Counted, Definition, Fact, Open, Use

_MAX_NAMED = 3  # programs


def remapping_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield the names that nodes have, and those that remappings of one node alone replace; and how
    many topics are compared.
    """
    owners: dict[tuple[str, ...], list[StartedNode]] = {}  # of each rule the first nodes with it
    for _, node in workspace.launches.nodes:
        for rule in node.remaps or ():
            of_rule = owners.setdefault(rule, [])
            if len(of_rule) < 2 and not any(node is owner for owner in of_rule):
                of_rule.append(node)
    read: set[object] = set()
    for _, node in workspace.launches.launched:
        key = (node.package, node.executable, node.location, node.remaps)
        if node.when is not False and key not in read:
            read.add(key)
            rules = [rule for rule in node.remaps or () if len(owners[rule]) == 1]
            yield from _remappings(workspace, node, rules)
    yield _count(graph_of(workspace))


def _remappings(
    workspace: Workspace, node: StartedNode, rules: Sequence[tuple[str, ...]]
) -> Iterator[Fact]:
    """Yield the names that a node has, and those that these remappings, of it alone, replace."""
    facts = workspace.code.own_node(node)
    if facts is None or node.remaps is None:
        return
    owner = f"{node.package}/{node.executable} {node.location.file_and_line}"
    names = [(endpoint.name, endpoint.location) for endpoint in facts.endpoints]
    is_open = bool(facts.doubts)
    for opened in opened_by(workspace, node._replace(remaps=(), namespace="")):
        is_open = is_open or not opened.is_known
        if opened.is_known:
            names.append((opened.name, opened.location))
    if is_open:
        yield Open("topic", owner)
    for name, at in names:
        if name is not None:
            yield Definition("topic", _bare(name), at, owner)
    for rule in rules:
        name = _bare(rule[0])
        if not name.startswith("__") and ":" not in name:
            # Actions and what rclpy itself opens, such as /tf, are not listed.
            said = f"the remapping of {node.executable}"
            yield Use("topic", name, node.location, said, owner, optional=True)


def _bare(name: str) -> str:
    return name.removeprefix("~").removeprefix("/")


def _count(graph: Graph) -> Counted:
    """Return how many topics of own code have another end, which a node, a controller, a
    bridge or a well-known program opens; and why not all are known.
    """
    published = {end.name for end in graph.of_kind("publisher", sources=END_SOURCES)}
    subscribed = {end.name for end in graph.of_kind("subscription", sources=END_SOURCES)}
    for row in bridge_rows(graph.workspace):
        if row.is_published:
            published.add(f"/{row.ros}")
        if row.is_read:
            subscribed.add(f"/{row.ros}")
    others = {"publisher": subscribed, "subscription": published}
    ends = [end for end in graph.ends if end.source == "code" and end.kind in others]
    known = [end for end in ends if end.is_known]
    compared = sum(end.name in others[end.kind] for end in known)
    computed = len(ends) - len(known)
    reasons = []
    if computed:
        reasons.append(f"{computed} {'is' if computed == 1 else 'are'} computed")
    unread = _unread_programs(graph.workspace)
    if unread:
        reasons.append(f"the source of {enumerated(unread, _MAX_NAMED)} is not read")
    return Counted("topics", compared, len(ends), ", and ".join(reasons))


def _unread_programs(workspace: Workspace) -> list[str]:
    """Return the programs of the workspace that are started and whose nodes are not known."""
    programs = set()
    for _, node in workspace.launches.launched:
        owner = workspace.package_of(node)
        if node.when is False or owner is None or workspace.code.own_node(node) is not None:
            continue
        if owner.has_program(node.package, node.executable):
            programs.add(node.executable)
    return sorted(programs)
