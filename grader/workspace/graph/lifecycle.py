"""Nodes with a lifecycle, and what configures and activates them."""

import re
from collections.abc import Iterable, Sequence

from grader.base.patterns import on_use
from grader.ros.known.parameter_rows import row_for
from grader.ros.known.releases import RELEASES
from grader.ros.launch.launch_model import Launch, StartedNode, StuckNode
from grader.ros.python.values import Unknown
from grader.workspace.model.text_files import MAX_YAML, read_code
from grader.workspace.model.workspace import Workspace

_MANAGER = "lifecycle_manager"  # of Nav2
LIFECYCLE_MANAGERS = (_MANAGER, "nav2_lifecycle_manager::LifecycleManager")
# What activates a node with a lifecycle: an event of a launch file, its own code, or a process.
_ACTIVATES = on_use(
    r"TRANSITION_ACTIVATE|transition_id\s*+=\s*+(?![\w.]*TRANSITION_|[0124-9])"
    r"|trigger_activate|[.>]activate\(\)|autostart\s*+=\s*+True|lifecycle_bringup"
    r"|change_state|lifecycle\W{1,9}set\b[^\n]{0,99}(?:\n[^\n]{0,99}){0,3}\bactivate\b"
    r"|lifecycleStartup|ManageLifecycleNodes"
)
_SETS_STATE = on_use(r"lifecycle\W{1,9}set\b")
_NAMES_ACTIVE = on_use(r"\bactivate\b")
# Parameters that nodes have which a manager of Nav2 leads: of its own nodes, and of slam_toolbox.
_OF_MANAGED = ("bond_disable_heartbeat_timeout", "use_lifecycle_manager")


def are_nodes_activated(workspace: Workspace) -> bool | None:
    """Return whether launch files or code activate nodes; None where a command may do it."""
    texts = _list_texts(workspace)
    if any(_ACTIVATES.search(text) for text in texts):
        return True
    if any(_SETS_STATE.search(text) and _NAMES_ACTIVE.search(text) for text in texts):
        return None
    return False


def _list_texts(workspace: Workspace) -> list[str]:
    """Return the texts of launch files and of code."""
    texts = list(workspace.texts.launch_texts)
    for package in workspace.packages:
        sources = read_code(workspace.texts, package)
        texts += [source.text for source in sources]
    return texts


def find_stuck_nodes(workspace: Workspace, launch: Launch) -> Sequence[StuckNode]:
    """Return the nodes that the events of a launch file leave inactive.

    Nothing else may activate them: no other file names what activates a node.
    """
    if not launch.stuck:
        return ()
    words = [word for text in _list_texts(workspace) for word in _ACTIVATES.findall(text)]
    are_events = all(word.lower().startswith("transition_") for word in words)
    return launch.stuck if words and are_events else ()


def managed_nodes(workspace: Workspace, managers: Iterable[StartedNode]) -> tuple[set[str], bool]:
    """Return the nodes that lifecycle managers activate on their own, and whether these are all."""
    managed: set[str] = set()
    is_known = True
    for node in managers:
        owner = node.node_name or _MANAGER
        for given in workspace.parameters.owners.get(owner, ()):
            rows = (given.values.get(name) for name in ("node_names", "autostart"))
            names, starts = (row.value if row else None for row in rows)
            if isinstance(names, list) and starts is True:
                managed.update(map(str, names))
            is_known = is_known and not given.unknown
            is_known = is_known and not isinstance(names, Unknown)
            is_known = is_known and not isinstance(starts, Unknown)
    return managed, is_known


def has_lifecycle(workspace: Workspace, node: StartedNode) -> bool:
    """Return whether a node certainly has a lifecycle: by its class, or in each release."""
    facts = workspace.code.own_node(node)
    if facts:
        data = workspace.tree.read(facts.location.path, MAX_YAML) or b""
        name = re.escape(facts.class_name.rpartition("::")[2].rpartition(".")[2])
        bases = re.search(rf"class\s++{name}\b([^{{]{{0,120}}+)", data.decode(errors="replace"))
        return bases is not None and "LifecycleNode" in bases[1]
    for release in workspace.releases or RELEASES:
        if not any(row_for(node.name, parameter, release) for parameter in _OF_MANAGED):
            return False
    return True
