"""Controllers of ros2_control: their YAML, their actions and topics, and the interfaces of their
joints.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

from grader.base.names import closest, near
from grader.base.source import Location
from grader.ros.config.yaml_nodes import YamlNode
from grader.ros.config.yaml_values import PARAMETERS, is_misspelt_key, sections_in
from grader.ros.known.known import known
from grader.ros.launch.launch_model import StartedNode
from grader.ros.launch.node_parameters import controllers_of
from grader.ros.package.python_nodes import Endpoint
from grader.ros.workspace.names import (
    Correction,
    Definition,
    Fact,
    Mismatch,
    Use,
    corrections,
    place_text,
)
from grader.ros.workspace.workspace import MANAGER, SPAWNERS, Workspace

_MAX_KEYS = 2  # of joints; steering controllers have those of an older release as well


class Controller(NamedTuple):
    """A controller that a parameter file defines for the controller manager."""

    name: str
    type: YamlNode
    location: Location
    has_file: bool  # of its own for its parameters


def controller_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield the controllers that YAML files define, their types, sections and interfaces, and those
    of actions.
    """
    controllers = list(defined_controllers(workspace))
    if not controllers:
        return
    yield from (Definition("controller", it.name, it.location) for it in controllers)
    # In other parameters, a section replaces the type before it: that it is there is a mistake of
    # parameters.
    nested = ((keys[-1], node) for keys, node in _sections(workspace) if MANAGER in keys[:-1])
    yield from (Definition("controller", name, node.location) for name, node in nested)
    sections = {keys[-1].rpartition("/")[2]: node for keys, node in _sections(workspace)}
    for controller in controllers:
        yield from _type_facts(workspace, controller)
        yield from _section_facts(workspace, controller, sections)
    yield from _action_facts(workspace)
    managers = [node for _, node in workspace.nodes if node.executable == "ros2_control_node"]
    if managers and workspace.command_interfaces is None and workspace.has_all_interfaces:
        message = "the controller manager is started, but the robot has no <ros2_control>"
        yield Mismatch("controllers", message, managers[0].location)


def _sections(workspace: Workspace) -> Iterator[tuple[tuple[str, ...], YamlNode]]:
    """Yield the parameters of nodes, also those that are inside of others, which is another
    mistake.
    """
    for _, tree in workspace.trees:
        for keys, node in sections_in(tree):
            if keys:
                yield keys, node
                yield from sections_in(node, keys)


def defined_controllers(workspace: Workspace) -> Iterator[Controller]:
    """Yield the controllers that parameter files define, with their types."""
    for keys, node in _sections(workspace):
        own = keys[-1].rpartition("/")[2]
        is_manager = own == MANAGER and isinstance(node.value, dict)
        for name, inner in (
            node.value.items() if is_manager and isinstance(node.value, dict) else [(own, node)]
        ):
            kind = inner.get("type")
            if (
                kind is not None and kind.text is not None and "/" in kind.text
            ):  # or in its own section, for a spawner
                yield Controller(name, kind, kind.location, inner.get("params_file") is not None)


def controller_endpoints(
    workspace: Workspace, launch: int, node: StartedNode
) -> Iterator[tuple[str, Endpoint]]:
    """Yield the topics of the controllers in the process of a node, those that its launch file
    spawns.
    """
    if node.executable != "ros2_control_node" or node.namespace is None or node.remaps is None:
        return
    spawners = [
        it
        for number, it in workspace.launched
        if number == launch and it.executable in SPAWNERS and it.when
    ]
    spawned = {
        it.node_name: it.remaps or ()
        for spawner in spawners
        for it in controllers_of(spawner) or ()
    }
    unstamped = {
        keys[-1]
        for keys, section in _sections(workspace)
        if section.get("use_stamped_vel") is not None
    }
    for controller in defined_controllers(workspace):
        if controller.name not in spawned or controller.name in unstamped:
            continue
        own = replace(
            node, node_name=controller.name, remaps=(*spawned[controller.name], *node.remaps)
        )
        for kind, topics in known()["controller_topics"].get(controller.type.text, {}).items():
            for name, message in topics.items():
                topic = own.topic(f"~/{name}")
                if topic is not None:
                    yield topic, Endpoint(kind, message, topic, controller.location)


def _type_facts(workspace: Workspace, controller: Controller) -> Iterator[Fact]:
    """Yield that no package has a class of the controller's type, where all classes of its package
    are known.
    """
    types, written = known()["controllers"], controller.type.text or ""
    package = written.partition("/")[0]
    if (
        written in types
        or any(it.name == package for it in workspace.packages)
        or workspace.has_plugin(written)
    ):
        return
    same = [it for it in types if it.partition("/")[2] == written.partition("/")[2]]
    similar = closest(written, same) or (same[0] if len(same) == 1 else closest(written, types))
    is_known = any(name.startswith(f"{package}/") for name in types)
    if is_known or similar is not None:
        guess = f"; did you mean {similar!r}?" if similar is not None else ""
        message = f"{controller.name}.type: there is no controller of the type {written!r}{guess}"
        is_sure = is_known or near(written, same) is not None
        either = corrections(written, controller.location, similar)
        yield Mismatch(
            "controllers", message, controller.location, is_sure=is_sure, corrections=either
        )


def _section_facts(
    workspace: Workspace, controller: Controller, sections: Mapping[str, YamlNode]
) -> Iterator[Fact]:
    """Yield that the parameters of a controller are missing, and the interfaces that its joints
    need.
    """
    needed: Mapping[str, str] = known()["controllers"].get(controller.type.text, {})
    section = sections.get(controller.name)
    if section is None:
        if needed and "**" not in sections and not controller.has_file:
            message = (
                f"the controller {controller.name!r} has no parameters: there is no key "
                f"{controller.name}"
            )
            either = _of_sections(workspace, controller, sections)
            yield Mismatch(
                "controllers",
                f"{message} with ros__parameters",
                controller.location,
                corrections=either,
            )
        return
    for key in [it for it in needed if it.endswith("s")]:
        given = section.get(key)
        if given is not None and given.text:
            message = (
                f"{controller.name}.{key} is given a string; the controller stops without a "
                f"list: [{given.text}]"
            )
            yield Mismatch("controllers", message, given.location)
    claimed: dict[str, Location] = {}
    for joint, names in _needed_in(section, needed):
        yield from _interface_facts(workspace, controller, joint, names)
        for name in [f"{joint.text}/{it}" for it in names] if len(needed) <= _MAX_KEYS else ():
            before = claimed.setdefault(name, joint.location)
            if before != joint.location:
                message = (
                    f"{controller.name} claims the command interface {name} twice "
                    f"({place_text(before)})"
                )
                yield Mismatch("controllers", message, joint.location, before)


def _of_sections(
    workspace: Workspace, controller: Controller, sections: Mapping[str, YamlNode]
) -> tuple[Correction, ...]:
    """Return the correction of the name of a controller above its parameters, or of the key
    ros__parameters there.
    """
    meant = closest(controller.name, sections)
    if meant is not None:
        return corrections(meant, sections[meant].location, controller.name, controller.location)
    own = [node for _, tree in workspace.trees if (node := tree.get(controller.name)) is not None]
    keys = [it for node in own if isinstance(node.value, dict) for it in node.value.items()]
    return next(
        (
            corrections(key, node.location, PARAMETERS)
            for key, node in keys
            if is_misspelt_key(key, node)
        ),
        (),
    )


def _needed_in(
    section: YamlNode, needed: Mapping[str, str]
) -> Iterator[tuple[YamlNode, list[str]]]:
    """Yield the joints in the parameters of a controller, each with the command interfaces that it
    needs.
    """
    for key, wanted in needed.items():
        joints = section.get(key)
        given = section.get(wanted.removeprefix("=")) if wanted.startswith("=") else None
        names = [wanted] if not wanted.startswith("=") else []
        if given is not None:
            names = [it.text or "" for it in (given.items or [given])]
        for joint in (joints.items or [joints]) if joints is not None else ():
            yield joint, names


def needed_interfaces(workspace: Workspace) -> frozenset[str]:
    """Return the command interfaces that controllers need, each as joint/interface."""
    sections = {keys[-1].rpartition("/")[2]: node for keys, node in _sections(workspace)}
    types = known()["controllers"]
    found = (
        (sections.get(it.name), types.get(it.type.text, {}))
        for it in defined_controllers(workspace)
    )
    needed = [_needed_in(section, kinds) for section, kinds in found if section is not None]
    return frozenset(
        f"{joint.text}/{name}" for each in needed for joint, names in each for name in names
    )


def _interface_facts(
    workspace: Workspace, controller: Controller, joint: YamlNode, needed: Sequence[str]
) -> Iterator[Mismatch]:
    """Yield the command interfaces that a controller needs of a joint, and <ros2_control> does not
    have.
    """
    interfaces, name = workspace.command_interfaces or {}, joint.text or ""
    message = f"{controller.name} needs the command interface {name}"
    if name in interfaces:
        own, at = interfaces[name]
        there = f"<ros2_control> has {', '.join(sorted(own)) or 'none'} ({place_text(at)})"
        for missing in [it for it in needed if it not in own]:
            either = corrections(missing, joint.location, near(missing, own), at)
            yield Mismatch(
                "controllers",
                f"{message}/{missing}; {there}",
                joint.location,
                at,
                corrections=either,
            )
    elif (
        workspace.has_all_interfaces
        and interfaces
        and all(_is_joint(workspace, it) for it in [name, *interfaces])
    ):
        for missing in needed[:1]:
            text = f"{message}/{missing}; <ros2_control> has no joint {name!r}"
            yield Mismatch("controllers", text, joint.location)


def _is_joint(workspace: Workspace, name: str) -> bool:
    return workspace.robot is not None and workspace.robot.has_joint(name)


def _action_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield the controllers whose actions own nodes ask for."""
    for _, node in workspace.nodes:
        own = workspace.python_node(node)
        for endpoint in own.endpoints if own is not None else ():
            topic = node.topic(endpoint.name or "") if endpoint.kind == "action client" else None
            controller, _, action = (topic or "").rpartition("/")
            if action in known()["controller_actions"]:
                yield Use("controller", controller.strip("/"), endpoint.location, "ActionClient")
