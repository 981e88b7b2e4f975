"""The controllers that parameter files define and spawners start, and the topics of these.

They are controllers of ros2_control.
"""

from collections.abc import Iterator, Mapping
from functools import lru_cache

from grader.base.grouping import Strings
from grader.base.names import last_part
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.source import Location
from grader.ros.config.yaml_nodes import YamlNode
from grader.ros.config.yaml_values import sections_in
from grader.ros.known.package_rows import ControllerRow, controller_row
from grader.ros.launch.launch_model import Launch, StartedNode
from grader.ros.launch.node_parameters import list_controllers
from grader.ros.nodes.node_facts import Endpoint, EndpointKind
from grader.workspace.model.launches import CONTROL_NODE, MANAGER, SPAWNERS, list_spawned
from grader.workspace.model.workspace import Workspace

# Programs and services that start controllers, besides spawners.
_OTHER_STARTS = on_use(r"(load|switch|set)_controller|(Load|Switch)Controller")
_JOINT_STATE = "sensor_msgs.msg.JointState"
_LOCAL_TOPICS = "use_local_topics"  # the parameter that puts the broadcaster's name before its own


class Controller(Named):
    """A controller that a parameter file defines for the controller manager."""

    name: str
    type: YamlNode
    location: Location
    has_file: bool  # of its own for its parameters
    is_own: bool  # whether its own section has the type, which only its spawner can read

    @property
    def row(self) -> ControllerRow:
        """What is known of its type."""
        return controller_row(self.type.text)

    @property
    def is_broadcaster(self) -> bool:
        """Return whether it publishes, and moves nothing."""
        return (self.type.text or "").endswith("Broadcaster")


@lru_cache(maxsize=2)
def named_sections(workspace: Workspace) -> tuple[tuple[Strings, YamlNode], ...]:
    """Return the parameters of nodes, also those inside of others.

    A section inside of another one is another mistake.
    """
    sections = []
    for keys, node in workspace.installed.sections:
        if keys:
            sections += [(keys, node), *sections_in(node, keys)]
    return tuple(sections)


@lru_cache(maxsize=2)
def parameters_of_controllers(workspace: Workspace) -> Mapping[str, YamlNode]:
    """Return the parameters in the sections of parameter files, by the last names of their nodes.

    Some of these nodes are controllers.
    """
    return {last_part(keys[-1]): node for keys, node in named_sections(workspace)}


@lru_cache(maxsize=2)
def defined_controllers(workspace: Workspace) -> tuple[Controller, ...]:
    """Return the controllers that parameter files define, with their types."""
    controllers = []
    for keys, section in named_sections(workspace):
        name = last_part(keys[-1])
        # The type is in a section of the controller manager, or in their own, for a spawner.
        if name == MANAGER and isinstance(section.value, dict):
            defined = section.value
            around = section
        else:
            defined = {name: section}
            around = None
        for controller, node in defined.items():
            kind = node.get("type")
            if kind and kind.text is not None and "/" in kind.text:
                has_file = node.get("params_file") is not None
                at = kind.location
                if around and controller in around.key_marks:
                    at = around.key_location(controller)
                controllers.append(Controller(controller, kind, at, has_file, not around))
    return tuple(controllers)


def controller_endpoints(
    workspace: Workspace, launch: int, node: StartedNode
) -> Iterator[tuple[str, Endpoint]]:
    """Yield the topics of the controllers in a node's process, each with its controller's name.

    The controllers are those that the launch file of the node spawns.
    """
    if node.executable != CONTROL_NODE or node.namespace is None or node.remaps is None:
        return
    remaps = spawned_controllers(workspace, launch)
    # With this parameter, the type of a topic depends on its value.
    for keys, section in named_sections(workspace):
        if section.get("use_stamped_vel"):
            remaps.pop(keys[-1], None)
    started = {
        name: node._replace(node_name=name, remaps=rules + node.remaps)
        for name, rules in remaps.items()
    }
    for controller in defined_controllers(workspace):
        name = controller.name
        if name not in started:
            continue
        for kind, written, message in _list_topics(workspace, controller):
            topic = started[name].topic(written)
            if topic is not None:
                yield name, Endpoint(kind, message, topic, controller.location)


def _list_topics(
    workspace: Workspace, controller: Controller
) -> Iterator[tuple[EndpointKind, str, str]]:
    """Yield kind, name and type of the topics that a controller opens."""
    row = controller.row
    for name, message in row.subscriptions.items():
        yield "subscription", f"~/{name}", message
    for name, message in row.publishers.items():
        yield "publisher", f"~/{name}", message
    if row.publishes_joint_states:
        section = parameters_of_controllers(workspace).get(controller.name)
        if not section or section.get(_LOCAL_TOPICS) is None:
            yield "publisher", "joint_states", _JOINT_STATE


def spawned_controllers(workspace: Workspace, launch: int) -> dict[str | None, tuple[Strings, ...]]:
    """Return the controllers that the spawners of a launch file start, with their remappings.

    The keys are the names of the controllers.
    """
    remaps = {}
    for root in workspace.launches.outermost[max(0, launch) : launch + 1]:
        workspace.charge(1 + len(root.nodes))
        for spawner in root.nodes:
            if spawner.when:
                for controller in list_spawned(spawner):
                    remaps[controller.node_name] = controller.remaps or ()
    return remaps


class _Spawned(Named):
    """The controllers that the spawners of a launch file start."""

    names: Strings
    is_known: bool  # whether nothing else may start others
    first: Location | None  # where the first spawner is started


def spawned_by(launch: Launch) -> _Spawned:
    """Return the controllers that spawners start in a launch file and those that it includes."""
    names: dict[str, None] = {}
    first = None
    texts = (launch.source.text, *launch.command_texts)
    is_known = not launch.unknown and not any(map(_OTHER_STARTS.search, texts))
    for node in launch.nodes:
        if node.package != MANAGER or node.executable not in SPAWNERS:
            continue
        started = list_controllers(node)
        is_known = is_known and started is not None and node.when is not None
        if node.when:
            first = first or node.location
            for controller in started or ():
                if controller.node_name:
                    names[controller.node_name] = None
    return _Spawned((*names,), is_known, first)
