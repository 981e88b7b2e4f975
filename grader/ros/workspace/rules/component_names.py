"""Components that launch files load: whether their packages register them, and whether something
starts their containers.
"""

import re
from collections.abc import Iterator

from grader.base.names import closest, near
from grader.base.source import Location
from grader.base.text import quoted
from grader.ros.launch.launch_model import Launch, LoadedComponent
from grader.ros.package.package import Package
from grader.ros.workspace.model.workspace import Workspace
from grader.ros.workspace.rules.names import (
    Compared,
    Fact,
    Mismatch,
    Undecided,
    corrections,
    cost_of_guess,
    warning,
)
from grader.ros.workspace.rules.rule_table import (
    COMPONENT_REGISTERED,
    CONTAINER_STARTED,
)

_CONTAINERS = "rclcpp_components"
_CMAKE = ("CMakeLists.txt", ".cmake")
# A class that CMake computes.
_COMPUTED = re.compile(r"rclcpp_components_register_nodes?\s*\(\s*+[^\s()][^()$]*+\$")
_OTHER_WAY = "ament_index_register_resource"


def component_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield components that nothing registers, and containers that nothing starts."""
    for package, launch in workspace.launches.roots:
        workspace.charge(1 + len(launch.components))
        for component in launch.components:
            yield from _unregistered(workspace, package, component)
        yield from _no_container(workspace, launch)


def _unregistered(
    workspace: Workspace, package: Package, component: LoadedComponent
) -> Iterator[Fact]:
    """Yield that a package of the workspace does not have the class that a container loads."""
    name, plugin = component.package, component.plugin
    owner = package.find(name) if name is not None else None
    if owner is None or plugin is None:
        return
    setup = owner.installation
    if (
        setup is None
        or setup.fault is not None
        or not workspace.folder.means_one(package, owner.name)
    ):
        return
    yield Compared("programs")
    registered: dict[str, Location] = {}
    for target in setup.targets:
        for own in target.components:
            registered[own.plugin] = setup.location(own.at)
    texts = [source.text for source in workspace.texts.sources_of(owner, _CMAKE)]
    if plugin in registered or any(plugin in text for text in texts):
        return
    workspace.charge(cost_of_guess(len(registered)))
    meant = near(plugin, registered) or closest(plugin, registered)
    is_open = any(_COMPUTED.search(text) or _OTHER_WAY in text for text in texts)
    is_known = not (setup.unknown or setup.unread or is_open)
    message = f"the package {owner.name!r} registers no component {quoted(plugin)}"
    if meant is not None:
        message += f"; did you mean {quoted(meant)} ({registered[meant].file_and_line})?"
    elif not is_known:
        yield Undecided("programs", f"which components {owner.name} has is not evaluated")
        return
    else:
        message += f"; it registers {', '.join(registered) or 'none'}"
    related = registered[meant] if meant is not None else None
    either = corrections(plugin, component.location, meant, related)
    yield Mismatch(COMPONENT_REGISTERED, message, component.location, related, is_known, either)


def _no_container(workspace: Workspace, launch: Launch) -> Iterator[Mismatch]:
    """Yield the containers that a launch file asks for and does not start, though it starts
    others. What may start more leaves open which there are.
    """
    started = _containers(workspace, launch) if launch.components else None
    if not started:
        return
    for component in launch.components:
        name = component.container
        if name and component.when is True and name not in started:
            workspace.charge(cost_of_guess(len(started)))
            meant = closest(name, started) or min(started)
            at = started[meant]
            message = (
                f"nothing starts a container {name}, for which launch waits without end; "
                f"{meant} is started at {at.file_and_line}"
            )
            yield warning(CONTAINER_STARTED, message, component.loaded_at, at)


def _containers(workspace: Workspace, launch: Launch) -> dict[str, Location] | None:
    """Return the nodes of a launch file that may be containers, by their full names; None where
    not all of them are known, or none is a container.
    """
    places = {it.location for it in launch.containers}
    places |= {it.loaded_at for it in launch.components}
    if any(unknown.location not in places for unknown in launch.unknown):
        return None
    if not all(workspace.installed.has_file(passed.path) for passed in launch.passed):
        return None
    found: dict[str, Location] = {}
    for container in launch.containers:
        if container.name is None:
            return None
        found[container.name] = container.location
    for node in launch.nodes:
        may_be = node.package == _CONTAINERS or workspace.package_of(node) is not None
        if may_be and (not node.node_name or node.namespace is None):
            return None
        if node.node_name and found:
            found[node.full_name(node.node_name)] = node.location
    return found or None
