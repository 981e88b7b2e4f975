"""The controllers that parameter files define and spawners start, and the topics of these.

They are controllers of ros2_control.
"""

import re
from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import NamedTuple

from grader.base.source import Location
from grader.ros.config.yaml_nodes import YamlNode
from grader.ros.config.yaml_values import sections_in
from grader.ros.known.package_rows import controller_row
from grader.ros.launch.launch_model import Launch, StartedNode
from grader.ros.launch.node_parameters import list_controllers
from grader.ros.nodes.node_facts import Endpoint, EndpointKind
from grader.workspace.model.launches import CONTROL_NODE, MANAGER, SPAWNERS
from grader.workspace.model.workspace import Workspace

# Programs and services that start controllers, besides spawners.
_OTHER_STARTS = re.compile(r"(load|switch|set)_controller|(Load|Switch)Controller")
_JOINT_STATE = "sensor_msgs.msg.JointState"
_LOCAL_TOPICS = "use_local_topics"  # the parameter that puts the broadcaster's name before its own


class Controller(NamedTuple):
    """A controller that a parameter file defines for the controller manager."""

    name: str
    type: YamlNode
    location: Location
    has_file: bool  # of its own for its parameters
    is_own: bool  # whether its own section has the type, which only its spawner can read

    @property
    def is_broadcaster(self) -> bool:
        """Return whether it publishes, and moves nothing."""
        return (self.type.text or "").endswith("Broadcaster")


@lru_cache(maxsize=2)
def named_sections(workspace: Workspace) -> tuple[tuple[tuple[str, ...], YamlNode], ...]:
    """Return the parameters of nodes, also those inside of others.

    A section inside of another one is another mistake.
    """
    sections: list[tuple[tuple[str, ...], YamlNode]] = []
    for _, tree in workspace.installed.trees:
        for keys, node in sections_in(tree):
            if keys:
                sections += [(keys, node), *sections_in(node, keys)]
    return tuple(sections)


def parameters_of_controllers(workspace: Workspace) -> Mapping[str, YamlNode]:
    """Return the parameters in the sections of parameter files, by the last names of their nodes.

    Some of these nodes are controllers.
    """
    return {keys[-1].rpartition("/")[2]: node for keys, node in named_sections(workspace)}


@lru_cache(maxsize=2)
def defined_controllers(workspace: Workspace) -> tuple[Controller, ...]:
    """Return the controllers that parameter files define, with their types."""
    controllers: list[Controller] = []
    for keys, section in named_sections(workspace):
        name = keys[-1].rpartition("/")[2]
        # The type is in a section of the controller manager, or in their own, for a spawner.
        if name == MANAGER and isinstance(section.value, dict):
            defined, around = section.value, section
        else:
            defined, around = {name: section}, None
        for controller, node in defined.items():
            kind = node.get("type")
            if kind is not None and kind.text is not None and "/" in kind.text:
                has_file = node.get("params_file") is not None
                at = kind.location
                if around is not None and controller in around.key_marks:
                    at = around.key_location(controller)
                controllers.append(Controller(controller, kind, at, has_file, around is None))
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
        if section.get("use_stamped_vel") is not None:
            remaps.pop(keys[-1], None)
    for controller in defined_controllers(workspace):
        name = controller.name
        if name not in remaps:
            continue
        started = node._replace(node_name=name, remaps=(*remaps[name], *node.remaps))
        for kind, written, message in _list_topics(workspace, controller):
            topic = started.topic(written)
            if topic is not None:
                yield name, Endpoint(kind, message, topic, controller.location)


def _list_topics(
    workspace: Workspace, controller: Controller
) -> Iterator[tuple[EndpointKind, str, str]]:
    """Yield kind, name and type of the topics that a controller opens."""
    row = controller_row(controller.type.text)
    for name, message in row.subscriptions.items():
        yield "subscription", f"~/{name}", message
    for name, message in row.publishers.items():
        yield "publisher", f"~/{name}", message
    if row.publishes_joint_states:
        section = parameters_of_controllers(workspace).get(controller.name)
        if section is None or section.get(_LOCAL_TOPICS) is None:
            yield "publisher", "joint_states", _JOINT_STATE


def spawned_controllers(
    workspace: Workspace, launch: int
) -> dict[str | None, tuple[tuple[str, ...], ...]]:
    """Return the controllers that the spawners of a launch file start, with their remappings.

    The keys are the names of the controllers.
    """
    remaps: dict[str | None, tuple[tuple[str, ...], ...]] = {}
    for number, spawner in workspace.launches.launched:
        if number == launch and spawner.executable in SPAWNERS and spawner.when:
            for controller in list_controllers(spawner) or ():
                remaps[controller.node_name] = controller.remaps or ()
    return remaps


class _Spawned(NamedTuple):
    """The controllers that the spawners of a launch file start."""

    names: tuple[str, ...]
    is_known: bool  # whether nothing else may start others
    first: Location | None  # where the first spawner is started


def spawned_by(launch: Launch) -> _Spawned:
    """Return the controllers that spawners start in a launch file and those that it includes."""
    names: dict[str, None] = {}
    first: Location | None = None
    texts = (launch.source.text, *launch.commands)
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
