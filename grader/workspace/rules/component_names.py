"""Components that launch files load: whether their packages register them.

It is compared as well whether something starts their containers.
"""

from collections.abc import Callable, Mapping
from functools import cache

from grader.base.names import closest, near
from grader.base.patterns import on_use
from grader.base.source import Location
from grader.base.text import quoted
from grader.ros.launch.launch_model import Launch, LoadedComponent
from grader.ros.package.package import Package
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Fact,
    Facts,
    Mismatch,
    Mismatches,
    Undecided,
    charge_guess,
    warning,
)
from grader.workspace.rules.rule_table import (
    NO_COMPANION,
    NO_PROGRAM,
    Rule,
)
from grader.workspace.rules.shared_symptoms import COMPONENT_CLASS, COMPONENT_RESOURCE

_CONTAINERS = "rclcpp_components"
_CMAKE = ("CMakeLists.txt", ".cmake")
# A class that CMake computes.
_COMPUTED = on_use(r"rclcpp_components_register_nodes?\s*\(\s*+[^\s()][^()$]*+\$")
_OTHER_WAY = "ament_index_register_resource"


def component_facts(workspace: Workspace) -> Facts:
    """Yield components that nothing registers, and containers that nothing starts."""
    registered_in = cache(_registered_in)
    for package, launch in workspace.launches.roots:
        workspace.charge(1 + len(launch.components))
        for component in launch.components:
            yield from _unregistered(workspace, package, component, registered_in)
        yield from _no_container(workspace, launch)


def _unregistered(
    workspace: Workspace,
    package: Package,
    component: LoadedComponent,
    registered_in: Callable[[Package], Mapping[str, Location]],
) -> Facts:
    """Yield that a package of the workspace does not have the class that a container loads.

    It is certain where all is known that the package registers. Otherwise it is said only if there
    is a class with a similar name. A class that a file of CMake names may be registered there.
    """
    plugin = component.plugin
    owner = package.find(component.package) if component.package is not None else None
    if not owner or plugin is None or not workspace.folder.means_one(package, owner.name):
        return
    setup = owner.installation
    if setup is None or setup.fault:
        return
    yield Compared("programs")
    registered = registered_in(owner)
    texts = [source.text for source in workspace.texts.read_sources(owner, _CMAKE)]
    if plugin in registered or any(plugin in text for text in texts):
        return
    charge_guess(workspace, registered)
    is_open = bool(setup.unknown or setup.unread) or any(map(_may_register, texts))
    yield _no_component(owner.name, plugin, component.location, registered, is_open=is_open)


_COMPONENT_REGISTERED = Rule(
    "component-registered",
    "programs",
    NO_PROGRAM,
    "CMakeLists.txt of the package registers the component that a launch file loads.",
    why=(
        "The container reports that it did not find the class, and the node is missing. The "
        "container and its other components run on."
    ),
    symptoms=(
        COMPONENT_CLASS,
        COMPONENT_RESOURCE,
    ),
    wrong="""
ComposableNodeContainer(
    package='rclcpp_components', executable='component_container', name='parts', namespace='',
    composable_node_descriptions=[ComposableNode(package='rover', plugin='rover::Driver')],
),
""",
    right="""
ComposableNodeContainer(
    package='rclcpp_components', executable='component_container', name='parts', namespace='',
    composable_node_descriptions=[ComposableNode(package='rover', plugin='rover::Drive')],
),
""",
    beside={
        "package.xml": "",
        "parts/CMakeLists.txt": "",
        "drive.cpp": "RCLCPP_COMPONENTS_REGISTER_NODE(rover::Drive)",
    },
)


def _no_component(
    package: str, plugin: str, at: Location, registered: Mapping[str, Location], *, is_open: bool
) -> Fact:
    """Return that a package registers no component of a name, as far as it is known which."""
    meant = near(plugin, registered) or closest(plugin, registered)
    message = f"the package {package!r} registers no component {quoted(plugin)}"
    if meant is not None:
        related = registered[meant]
        wrong = Mismatch(_COMPONENT_REGISTERED, message, at, related, not is_open)
        return wrong.meaning(plugin, meant, related).offering(plugin, meant)
    if is_open:
        return Undecided("programs", f"which components {package} has is not evaluated")
    message = f"{message}; it registers {', '.join(registered) or 'none'}"
    return Mismatch(_COMPONENT_REGISTERED, message, at)


def _registered_in(package: Package) -> Mapping[str, Location]:
    """Return the components that a package registers, with their places."""
    registered = {}
    setup = package.installation
    assert setup  # as the caller knows
    for target in setup.targets:
        for component in target.components:
            registered[component.plugin] = setup.location(component.at)
    return registered


def _may_register(text: str) -> bool:
    """Return whether a file of CMake may register components whose classes are not read."""
    return _COMPUTED.search(text) is not None or _OTHER_WAY in text


_CONTAINER_STARTED = Rule(
    "container-started",
    "wiring",
    NO_COMPANION,
    "The container of a component is started.",
    why=(
        "launch waits without end for the load service of the container. The component is never"
        " loaded, and no error is printed."
    ),
    wrong="""
ComposableNodeContainer(package='rclcpp_components', executable='component_container', name='parts',
                        namespace='', composable_node_descriptions=[]),
LoadComposableNodes(target_container='partss', composable_node_descriptions=[
    ComposableNode(package='image_proc', plugin='image_proc::RectifyNode')]),
""",
    right="""
ComposableNodeContainer(package='rclcpp_components', executable='component_container', name='parts',
                        namespace='', composable_node_descriptions=[]),
LoadComposableNodes(target_container='parts', composable_node_descriptions=[
    ComposableNode(package='image_proc', plugin='image_proc::RectifyNode')]),
""",
)


def _no_container(workspace: Workspace, launch: Launch) -> Mismatches:
    """Yield the containers that a launch file asks for and does not start, though it starts others.

    What may start more leaves open which there are.
    """
    started = _containers(workspace, launch) if launch.components else None
    if not started:
        return
    for component in launch.components:
        name = component.container
        if name and component.when and name not in started:
            charge_guess(workspace, started)
            meant = closest(name, started) or min(started)
            at = started[meant]
            message = (
                f"nothing starts a container {name}, for which launch waits without end; "
                f"{meant} is started at {at.file_and_line}"
            )
            yield warning(_CONTAINER_STARTED, message, component.loaded_at, at)


def _containers(workspace: Workspace, launch: Launch) -> dict[str, Location] | None:
    """Return the nodes of a launch file that may be containers, by their full names.

    The result is None where not all of them are known, or none is a container.
    """
    containers = {}
    for container in launch.containers:
        if container.name is None:
            return None
        containers[container.name] = container.location
    if not containers or _may_start_others(workspace, launch):
        return None
    for node in launch.nodes:
        if node.is_component:
            continue
        is_named = node.node_name and node.namespace is not None
        may_be = node.package == _CONTAINERS or workspace.find_package(node) is not None
        if may_be and not is_named:
            return None
        if node.node_name:
            containers[node.full_name(node.node_name)] = node.location
    return containers


def _may_start_others(workspace: Workspace, launch: Launch) -> bool:
    """Return whether a launch file may start containers that are not known."""
    return bool(launch.unknown) or not all(
        workspace.installed.has_file(passed.path) for passed in launch.passed
    )
