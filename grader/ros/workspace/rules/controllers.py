"""Controllers of ros2_control: their YAML, their actions and topics, and the interfaces of their
joints.
"""

from collections.abc import Iterator, Mapping, Sequence

from grader.base.names import closest, near
from grader.base.source import Location
from grader.ros.config.yaml_nodes import YamlNode
from grader.ros.config.yaml_values import PARAMETERS, is_misspelt_key
from grader.ros.known.package_rows import (
    controller_actions,
    controller_row,
    controller_types,
    is_known_controller,
)
from grader.ros.known.releases import releases_with
from grader.ros.workspace.graph.started_controllers import (
    Controller,
    defined_controllers,
    named_sections,
    parameters_of_controllers,
)
from grader.ros.workspace.model.launches import MANAGER
from grader.ros.workspace.model.under_arguments import may_be_offered
from grader.ros.workspace.model.workspace import Workspace
from grader.ros.workspace.rules.names import (
    Correction,
    Definition,
    Fact,
    Mismatch,
    Use,
    corrections,
)
from grader.ros.workspace.rules.rule_table import (
    CLAIMED_ONCE,
    CONTROLLER_HARDWARE,
    CONTROLLER_INTERFACE,
    CONTROLLER_LIST,
    CONTROLLER_PARAMETERS,
    CONTROLLER_TYPE,
)

_LIKENESS_IN_PACKAGE, _LIKENESS = 0.7, 0.85  # of a type to one of its package, and of another one
_MAX_KEYS = 2  # of joints; steering controllers have those of an older release as well


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
    nested = ((keys[-1], node) for keys, node in named_sections(workspace) if MANAGER in keys[:-1])
    yield from (Definition("controller", name, node.location) for name, node in nested)
    sections = parameters_of_controllers(workspace)
    for controller in controllers:
        yield from _type_facts(workspace, controller)
        yield from _section_facts(workspace, controller, sections)
    yield from _action_facts(workspace)
    managers = [
        node for _, node in workspace.launches.nodes if node.executable == "ros2_control_node"
    ]
    if (
        managers
        and workspace.robots.command_interfaces is None
        and workspace.robots.has_all_interfaces
    ):
        message = "the controller manager is started, but the robot has no <ros2_control>"
        yield Mismatch(CONTROLLER_HARDWARE, message, managers[0].location)


def _type_facts(workspace: Workspace, controller: Controller) -> Iterator[Fact]:
    """Yield that no package has a class of the controller's type, where all classes of its package
    are known.
    """
    written = controller.type.text or ""
    package, _, class_name = written.partition("/")
    if (
        is_known_controller(written)
        or releases_with("controller", written)
        or workspace.texts.has_plugin(written)
    ):
        return
    if any(own.name == package for own in workspace.packages):
        return
    types = controller_types()
    is_known = any(kind.startswith(f"{package}/") for kind in types)
    is_declared = any(own.depends_on(package) for own in workspace.packages)
    if (
        is_declared
        and not is_known
        and near(package, [kind.partition("/")[0] for kind in types]) is None
    ):
        return
    same_class = [kind for kind in types if kind.partition("/")[2] == class_name]
    similar = closest(written, same_class)
    if similar is None and len(same_class) == 1:
        similar = same_class[0]
    elif similar is None:
        similar = (
            closest(written, types) if is_known else closest(written, types, likeness=_LIKENESS)
        )
    if is_known or similar is not None:
        guess = f"; did you mean {similar!r}?" if similar is not None else ""
        message = f"{controller.name}.type: there is no controller of the type {written!r}{guess}"
        is_certain = is_known or near(written, same_class) is not None
        at = controller.location
        either = corrections(written, at, similar)
        yield Mismatch(CONTROLLER_TYPE, message, at, is_certain=is_certain, corrections=either)


def _section_facts(
    workspace: Workspace, controller: Controller, sections: Mapping[str, YamlNode]
) -> Iterator[Fact]:
    """Yield that the parameters of a controller are missing, and the interfaces that its joints
    need.
    """
    needed = controller_row(controller.type.text).joints
    section = sections.get(controller.name)
    if section is None:
        if needed and "**" not in sections and not controller.has_file:
            message = (
                f"the controller {controller.name!r} has no parameters: there is no key "
                f"{controller.name} with ros__parameters"
            )
            either = _section_corrections(workspace, controller, sections)
            yield Mismatch(CONTROLLER_PARAMETERS, message, controller.location, corrections=either)
        return
    for key in needed:
        given = section.get(key) if key.endswith("s") else None
        if given is not None and given.text:
            message = (
                f"{controller.name}.{key} is given a string; the controller stops without a "
                f"list: [{given.text}]"
            )
            yield Mismatch(CONTROLLER_LIST, message, given.location)
    claimed: dict[str, Location] = {}
    for joint, interfaces in _needed_in(section, needed):
        yield from _interface_facts(workspace, controller, joint, interfaces)
        if len(needed) > _MAX_KEYS:
            continue
        for interface in interfaces:
            name = f"{joint.text}/{interface}"
            before = claimed.setdefault(name, joint.location)
            if before != joint.location:
                message = (
                    f"{controller.name} claims the command interface {name} twice "
                    f"({before.file_and_line})"
                )
                yield Mismatch(CLAIMED_ONCE, message, joint.location, before)


def _section_corrections(
    workspace: Workspace, controller: Controller, sections: Mapping[str, YamlNode]
) -> tuple[Correction, ...]:
    """Return the correction of the name of a controller above its parameters, or of the key
    ros__parameters there.
    """
    meant = closest(controller.name, sections)
    if meant is not None:
        return corrections(meant, sections[meant].location, controller.name, controller.location)
    for _, tree in workspace.installed.trees:
        section = tree.get(controller.name)
        if section is None or not isinstance(section.value, dict):
            continue
        for key, node in section.value.items():
            if is_misspelt_key(key, node):
                return corrections(key, node.location, PARAMETERS)
    return ()


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
    sections = parameters_of_controllers(workspace)
    needed: set[str] = set()
    for controller in defined_controllers(workspace):
        section = sections.get(controller.name)
        if section is not None:
            row = controller_row(controller.type.text)
            for joint, names in _needed_in(section, row.joints):
                needed |= {f"{joint.text}/{name}" for name in names}
    return frozenset(needed)


def _interface_facts(
    workspace: Workspace, controller: Controller, joint: YamlNode, needed: Sequence[str]
) -> Iterator[Mismatch]:
    """Yield the command interfaces that a controller needs of a joint, and <ros2_control> does not
    have.
    """
    interfaces, name = workspace.robots.command_interfaces or {}, joint.text or ""
    message = f"{controller.name} needs the command interface {name}"
    if name in interfaces:
        offered, at = interfaces[name]
        there = f"<ros2_control> has {', '.join(sorted(offered)) or 'none'} ({at.file_and_line})"
        for missing in needed:
            if missing not in offered and not may_be_offered(workspace, missing):
                either = corrections(missing, joint.location, near(missing, offered), at)
                text = f"{message}/{missing}; {there}"
                yield Mismatch(CONTROLLER_INTERFACE, text, joint.location, at, corrections=either)
        return
    if not interfaces or not workspace.robots.has_all_interfaces:
        return
    # Names that are no joints of a robot are mistakes of frames.
    joints = {each.name for found in workspace.robots.known for each in found.robot.joints}
    if needed and joints.issuperset([name, *interfaces]):
        text = f"{message}/{needed[0]}; <ros2_control> has no joint {name!r}"
        yield Mismatch(CONTROLLER_INTERFACE, text, joint.location)


def _action_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield the controllers whose actions own nodes ask for."""
    namespaces = _namespaces(workspace)
    for _, node in workspace.launches.nodes:
        own_node = workspace.code.own_node(node)
        for endpoint in own_node.endpoints if own_node is not None else ():
            topic = node.topic(endpoint.name or "") if endpoint.kind == "action client" else None
            controller, _, action = (topic or "").rpartition("/")
            namespace, _, name = controller.strip("/").rpartition("/")
            if action in controller_actions():
                written = name if namespace in namespaces else controller.strip("/")
                yield Use("controller", written, endpoint.location, "ActionClient")


def _namespaces(workspace: Workspace) -> set[str]:
    """Return the namespaces of controllers: those of keys, of controller managers and of Gazebo."""
    names = {"/".join(keys).rpartition("/")[0] for keys, _ in named_sections(workspace)}
    names |= {
        node.namespace or "" for _, node in workspace.launches.nodes if node.package == MANAGER
    }
    for robot in workspace.robots.known:
        names |= {element.text or "" for element in robot.root.iter("namespace")}
    return {name.strip("/ ") for name in names}
