"""Controllers of ros2_control: their YAML, actions, topics and interfaces of joints."""

from collections.abc import Collection, Iterator, Mapping, Sequence

from grader.base.names import closest, first_part, last_part, near
from grader.base.source import Location
from grader.ros.config.yaml_nodes import YamlNode
from grader.ros.config.yaml_values import PARAMETERS, is_misspelt_key
from grader.ros.known.package_rows import (
    controller_actions,
    controller_types,
    is_known_controller,
)
from grader.ros.known.releases import other_name, releases_with
from grader.workspace.graph.compared_robots import robots_for_file
from grader.workspace.graph.started_controllers import (
    Controller,
    defined_controllers,
    named_sections,
    parameters_of_controllers,
)
from grader.workspace.model.known_robots import (
    KnownRobot,
    command_interfaces,
    state_interfaces,
)
from grader.workspace.model.launches import CONTROL_NODE, MANAGER
from grader.workspace.model.under_arguments import may_be_offered
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Correction,
    Definition,
    Facts,
    Mismatch,
    Mismatches,
    Use,
    corrections,
)
from grader.workspace.rules.rule_table import NO_CONTROLLER, Rule, Symptom
from grader.workspace.rules.shared_symptoms import (
    CLASS_DOES_NOT_EXIST,
    CONTROLLER_NOT_LOADED,
    INTERFACE_MISSING,
    INTERFACE_NOT_AVAILABLE,
    INTERFACES_NOT_ACCEPTED,
    SERVICE_NOT_CONTACTED,
)

_LIKENESS = 0.85  # of a type to one of another package
_MAX_KEYS = 2  # of joints; steering controllers have those of an older release as well


def controller_facts(workspace: Workspace) -> Facts:
    """Yield the controllers, types, sections and interfaces in YAML files, and those of actions."""
    controllers = list(defined_controllers(workspace))
    if not controllers:
        return
    for controller in controllers:
        yield Definition("controller", controller.name, controller.location)
    # In other parameters, a section replaces the type before it: that it is there is a mistake of
    # parameters.
    for keys, node in named_sections(workspace):
        if MANAGER in keys[:-1]:
            yield Definition("controller", keys[-1], node.location)
    sections = parameters_of_controllers(workspace)
    for controller in controllers:
        yield from _other_type(workspace, controller)
        section = sections.get(controller.name)
        if not section:
            yield from _no_parameters(workspace, controller, sections)
        else:
            yield from _no_list(controller, section)
            yield from _no_interface(workspace, controller, section)
            yield from _no_state(workspace, controller, _beside(workspace, controller, section))
            yield from _claimed_twice(controller, section)
    yield from _action_facts(workspace)
    yield from _no_hardware(workspace)


_CONTROLLER_HARDWARE = Rule(
    "controller-hardware",
    "controllers",
    NO_CONTROLLER,
    "A robot with a controller manager has <ros2_control>.",
    why=(
        "The controller manager parses <ros2_control> for its hardware. Without the element it "
        "has no interfaces, so no controller can move a joint."
    ),
    symptoms=(SERVICE_NOT_CONTACTED,),
    wrong="""
Node(package='controller_manager', executable='ros2_control_node', parameters=[controllers]),
""",
    right="""
Node(package='rover', executable='motors'),  # or describe the hardware in <ros2_control>
""",
    frame="control/rover.launch.py",
    beside={
        "arm/controllers.yaml": "",
        "plain/rover.urdf": """
<robot name="rover">
  <link name="base_link"/> <link name="arm"/>
  <joint name="arm_joint" type="continuous"><parent link="base_link"/><child link="arm"/></joint>
</robot>
""",
        "motors.py": "",
    },
)


def _no_hardware(workspace: Workspace) -> Mismatches:
    """Yield that a controller manager is started, while no robot has <ros2_control>.

    Nothing is said where a robot may have more than is read.
    """
    robots = workspace.robots
    if any(robot.systems for robot in robots.known) or not robots.has_all_interfaces:
        return
    for node in workspace.launches.nodes:
        if node.executable == CONTROL_NODE:
            message = "the controller manager is started, but the robot has no <ros2_control>"
            yield Mismatch(_CONTROLLER_HARDWARE, message, node.location)
            return


_CONTROLLER_TYPE = Rule(
    "controller-type",
    "controllers",
    NO_CONTROLLER,
    "The type of a controller is one that a package has.",
    why=(
        "pluginlib finds no such class. The controller manager prints 'Loader for controller "
        "... not found', and the controller is not loaded."
    ),
    symptoms=(
        CLASS_DOES_NOT_EXIST,
        Symptom(
            "controller-not-found",
            pattern=(
                r"Loader for controller '(?P<controller>[^']{1,200}+)' \(type "
                r"'(?P<type>[^']{1,200}+)'\) not found\."
            ),
            source=(
                "ros-controls/ros2_control 53b9999d1, controller_manager/src/"
                "controller_manager.cpp:1253"
            ),
            sentence="No installed package has the type of the controller.",
            example="Loader for controller 'arm' (type 'arm_ctrl/Arm') not found.",
            within=("type",),
        ),
        CONTROLLER_NOT_LOADED,
    ),
    wrong="joint_state_broadcaster: {type: joint_state_broadcaster/JointStatePublisher}",
    right="joint_state_broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}",
    frame="types/controllers.yaml",
)


def _other_type(workspace: Workspace, controller: Controller) -> Mismatches:
    """Yield that no package has a class of the controller's type.

    It is certain where all classes of the package are known, or the same class is in a package with
    a similar name. Nothing is said of types that a release, a plugin in the workspace or a package
    of it may have, and of other packages only if there is a similar type.
    """
    written = controller.type.text or ""
    types = controller_types()
    package, _, class_name = written.partition("/")
    is_known = any(kind.startswith(f"{package}/") for kind in types)
    if _may_have_type(workspace, written, is_known=is_known):
        return
    same_class = [kind for kind in types if kind.partition("/")[2] == class_name]
    other = other_name("controller", written, workspace.releases)
    meant = other.name or None if other else None
    meant = meant or _meant_type(written, same_class, is_known=is_known)
    if meant is None and not is_known:
        return
    message = f"{controller.name}.type: there is no controller of the type {written!r}"
    is_certain = is_known or other is not None or near(written, same_class) is not None
    wrong = Mismatch(_CONTROLLER_TYPE, message, controller.type.location, is_certain=is_certain)
    yield wrong.meaning(written, meant)


def _meant_type(written: str, same_class: Sequence[str], *, is_known: bool) -> str | None:
    """Return the type that is meant: of the same class in another package, or a similar one."""
    similar = closest(written, same_class)
    if similar is not None:
        return similar
    if len(same_class) == 1:
        return same_class[0]
    if is_known:
        return closest(written, controller_types())
    return closest(written, controller_types(), likeness=_LIKENESS)


def _may_have_type(workspace: Workspace, written: str, *, is_known: bool) -> bool:
    """Return whether something has, or may have, a controller of a type.

    `is_known` says whether all types of its package are known.
    """
    package = first_part(written)
    if package in workspace.own_packages or workspace.texts.has_plugin(written):
        return True
    if is_known_controller(written) or releases_with("controller", written):
        return not other_name("controller", written, workspace.releases)
    if is_known or not any(each.depends_on(package) for each in workspace.packages):
        return False
    return near(package, [first_part(kind) for kind in controller_types()]) is None


_CONTROLLER_PARAMETERS = Rule(
    "controller-parameters",
    "controllers",
    NO_CONTROLLER,
    "A controller that needs parameters has some.",
    why=(
        "Without names of joints or interfaces the controller cannot be configured, or it moves"
        " nothing. Its spawner reports the failure."
    ),
    wrong="""
controller_manager:
  ros__parameters:
    arm_controller: {type: joint_trajectory_controller/JointTrajectoryController}
""",
    right="""
controller_manager:
  ros__parameters:
    arm_controller: {type: joint_trajectory_controller/JointTrajectoryController}
arm_controller:
  ros__parameters:
    joints: [arm_joint]
    command_interfaces: [position]
""",
    frame="controllers.yaml",
    beside={
        "arm/rover.urdf": "",
    },
)


def _no_parameters(
    workspace: Workspace, controller: Controller, sections: Mapping[str, YamlNode]
) -> Mismatches:
    """Yield that a controller that needs joints has no parameters.

    It has neither a section of its name, nor one of all nodes, nor a file of its own.
    """
    needs_joints = bool(controller.row.joints)
    if needs_joints and "**" not in sections and not controller.has_file:
        message = (
            f"the controller {controller.name!r} has no parameters: there is no key "
            f"{controller.name} with ros__parameters"
        )
        either = _section_corrections(workspace, controller, sections)
        yield Mismatch(_CONTROLLER_PARAMETERS, message, controller.location, corrections=either)


_CONTROLLER_LIST = Rule(
    "controller-list",
    "controllers",
    NO_CONTROLLER,
    "A parameter of a controller that needs a list has one.",
    why=(
        "The controller declares a list, so a string raises a parameter type exception. The "
        "controller is not loaded, and its spawner ends with an error."
    ),
    wrong="""
joints: arm_joint
command_interfaces: [position]
""",
    right="""
joints: [arm_joint]
command_interfaces: [position]
""",
    frame="gains/controllers.yaml",
    beside={
        "arm/rover.urdf": "",
    },
)


def _no_list(controller: Controller, section: YamlNode) -> Mismatches:
    """Yield the parameters of a controller that are lists of joints, and are given a string."""
    for key in controller.row.joints:
        given = section.get(key) if key.endswith("s") else None
        if given and given.text:
            message = (
                f"{controller.name}.{key} is given a string; the controller stops without a "
                f"list: [{given.text}]"
            )
            yield Mismatch(_CONTROLLER_LIST, message, given.location)


_CLAIMED_ONCE = Rule(
    "claimed-once",
    "controllers",
    NO_CONTROLLER,
    "A controller claims each command interface once.",
    why=(
        "The resource manager hands out each command interface once. The second claim raises an"
        " error, and the controller does not become active."
    ),
    symptoms=(
        Symptom(
            "interface-claimed",
            pattern=(
                r"Resource conflict for controller '(?P<controller>[^']{1,200}+)'\. Command "
                r"interface '(?P<joint>[^'/]{1,200}+)/[^']{1,200}+' is already claimed"
            ),
            source=(
                "ros-controls/ros2_control 53b9999d1, controller_manager/src/"
                "controller_manager.cpp:2696"
            ),
            sentence="Two controllers claim one command interface.",
            example=(
                "Resource conflict for controller 'arm_controller'. Command interface "
                "'elbow/position' is already claimed."
            ),
            within=("joint",),
        ),
    ),
    wrong="""
joints: [arm_joint, arm_joint]
command_interfaces: [position]
""",
    right="""
joints: [arm_joint]
command_interfaces: [position]
""",
    frame="gains/controllers.yaml",
    beside={
        "arm/rover.urdf": "",
    },
)


def _claimed_twice(controller: Controller, section: YamlNode) -> Mismatches:
    """Yield the command interfaces that a controller claims twice.

    Steering controllers, which have the parameters of an older release as well, claim those of
    one release.
    """
    needed = controller.row.joints
    if len(needed) > _MAX_KEYS:
        return
    claimed: dict[str, Location] = {}
    for joint, interfaces in _needed_in(section, needed):
        for interface in interfaces:
            name = f"{joint.text}/{interface}"
            before = claimed.setdefault(name, joint.location)
            if before != joint.location:
                message = (
                    f"{controller.name} claims the command interface {name} twice "
                    f"({before.file_and_line})"
                )
                yield Mismatch(_CLAIMED_ONCE, message, joint.location, before)


def _section_corrections(
    workspace: Workspace, controller: Controller, sections: Mapping[str, YamlNode]
) -> tuple[Correction, ...]:
    """Return the correction of a controller's name above its parameters.

    It may also correct the key ros__parameters there.
    """
    meant = closest(controller.name, sections)
    if meant is not None:
        return corrections(meant, sections[meant].location, controller.name, controller.location)
    for tree in workspace.installed.trees:
        section = tree.get(controller.name)
        for key, node in section.table.items() if section else ():
            if is_misspelt_key(key, node):
                return corrections(key, node.location, PARAMETERS)
    return ()


def _needed_in(
    section: YamlNode, needed: Mapping[str, str]
) -> Iterator[tuple[YamlNode, list[str]]]:
    """Yield the joints in a controller's parameters, with the command interfaces it needs."""
    for key, wanted in needed.items():
        names = [wanted]
        if wanted.startswith("="):
            names = [given.text or "" for given in _entries(section, wanted.removeprefix("="))]
        for joint in _entries(section, key):
            yield joint, names


def _entries(section: YamlNode, key: str) -> Sequence[YamlNode]:
    """Return the entries of a list of parameters, or the one that stands in its place."""
    given = section.get(key)
    if not given:
        return ()
    return given.items or [given]


def needed_interfaces(workspace: Workspace) -> frozenset[str]:
    """Return the command interfaces that controllers need, each as joint/interface."""
    sections = parameters_of_controllers(workspace)
    needed = set()
    for controller in defined_controllers(workspace):
        section = sections.get(controller.name)
        if section:
            for joint, names in _needed_in(section, controller.row.joints):
                needed |= {f"{joint.text}/{name}" for name in names}
    return frozenset(needed)


_CONTROLLER_INTERFACE = Rule(
    "controller-interface",
    "controllers",
    NO_CONTROLLER,
    "<ros2_control> has the interfaces of joints that a controller needs.",
    why=(
        "The controller manager does not activate a controller whose interfaces are missing. "
        "Its spawner ends with an error, and the joints do not move."
    ),
    symptoms=(
        INTERFACE_MISSING,
        INTERFACES_NOT_ACCEPTED,
        INTERFACE_NOT_AVAILABLE,
    ),
    wrong="""
joints: [arm_joint]
command_interfaces: [velocity]
""",
    right="""
joints: [arm_joint]
command_interfaces: [position]
""",
    frame="gains/controllers.yaml",
    beside={
        "arm/rover.urdf": "",
    },
)


def _no_interface(workspace: Workspace, controller: Controller, section: YamlNode) -> Mismatches:
    """Yield the command interfaces that a controller needs and <ros2_control> does not have.

    They are those of a joint.

    Names that are no joints of a robot are mistakes of frames. A joint without <ros2_control> is
    said only where the robot has no more than is read.
    """
    robots = robots_for_file(workspace, section.source.path).robots
    interfaces = command_interfaces(robots)
    are_comparable = _are_all_joints(workspace, robots, interfaces)
    for joint, needed in _needed_in(section, controller.row.joints):
        name = joint.text or ""
        message = f"{controller.name} needs the command interface {name}"
        if name in interfaces:
            yield from _missing_interfaces(workspace, joint, needed, message, interfaces[name])
        elif are_comparable and needed and _are_all_joints(workspace, robots, [name]):
            text = f"{message}/{needed[0]}; <ros2_control> has no joint {name!r}"
            yield Mismatch(_CONTROLLER_INTERFACE, text, joint.location)


def _beside(workspace: Workspace, controller: Controller, section: YamlNode) -> YamlNode:
    """Return the parameters of a controller in the file that defines it, else those of its name."""
    for keys, node in named_sections(workspace):
        is_beside = node.source.path == controller.type.source.path and node.get("joints")
        if is_beside and last_part(keys[-1]) == controller.name:
            return node
    return section


def _no_state(workspace: Workspace, controller: Controller, section: YamlNode) -> Mismatches:
    """Yield the state interfaces that a controller reads and <ros2_control> does not have.

    Own hardware may have others than those that are listed there.
    """
    if not is_known_controller(controller.type.text):
        return
    offered = state_interfaces(robots_for_file(workspace, section.source.path).robots)
    said = set()
    for kind, joint, at in _needed_states(controller, section):
        interfaces = offered.get(joint, (kind,))
        if kind in said or kind in interfaces or may_be_offered(workspace, kind, "state_interface"):
            continue
        said.add(kind)
        text = (
            f"{controller.name} needs the state interface {joint}/{kind}, which <ros2_control> "
            "does not have"
        )
        yield Mismatch(_CONTROLLER_INTERFACE, text, at)


def _needed_states(
    controller: Controller, section: YamlNode
) -> Iterator[tuple[str, str, Location]]:
    """Yield the state interfaces that a controller reads: kind, joint and where it is named."""
    for kind in _entries(section, "state_interfaces"):
        for joint in _entries(section, "joints"):
            yield kind.text or "", joint.text or "", kind.location
    yield from _feedback_states(controller, section)


def _small_text(section: YamlNode, key: str) -> str:
    """Return the text of a parameter in small letters; empty where it is not given."""
    node = section.get(key)
    return (node.text or "").lower() if node else ""


def _feedback_states(
    controller: Controller, section: YamlNode
) -> Iterator[tuple[str, str, Location]]:
    """Yield the same of the feedback that a type of controllers reads of its own."""
    feedback = controller.row.feedback
    if not feedback:
        return
    kinds = {"": feedback.on, "true": feedback.on, "false": feedback.off}
    kind_read = kinds.get(_small_text(section, feedback.switch), "")
    is_read = _small_text(section, feedback.unless) in ("", "false")
    for key in feedback.joints if kind_read and is_read else ():
        for joint in _entries(section, key):
            yield kind_read, joint.text or "", joint.location


def _are_all_joints(
    workspace: Workspace, robots: Sequence[KnownRobot], names: Collection[str]
) -> bool:
    """Return whether all of some names, if any, are joints of robots that are read whole."""
    joints = set()
    for known_robot in robots:
        joints |= {joint.name for joint in known_robot.robot.joints}
    return bool(names) and joints.issuperset(names) and workspace.robots.has_all_interfaces


def _missing_interfaces(
    workspace: Workspace,
    joint: YamlNode,
    needed: Sequence[str],
    message: str,
    interfaces: tuple[frozenset[str], Location],
) -> Mismatches:
    """Yield the command interfaces that <ros2_control> does not have of a joint that it has."""
    offered, at = interfaces
    there = f"<ros2_control> has {', '.join(sorted(offered)) or 'none'} ({at.file_and_line})"
    for missing in needed:
        if missing not in offered and not may_be_offered(workspace, missing):
            text = f"{message}/{missing}; {there}"
            wrong = Mismatch(_CONTROLLER_INTERFACE, text, joint.location, at)
            yield wrong.correcting(missing, near(missing, offered), at)


def _action_facts(workspace: Workspace) -> Facts:
    """Yield the controllers whose actions own nodes ask for."""
    namespaces = _namespaces(workspace)
    for node in workspace.launches.nodes:
        own_node = workspace.code.own_node(node)
        for endpoint in own_node.endpoints if own_node else ():
            topic = node.topic(endpoint.name or "") if endpoint.kind == "action client" else None
            controller, _, action = (topic or "").rpartition("/")
            namespace, _, name = controller.strip("/").rpartition("/")
            if action in controller_actions():
                written = name if namespace in namespaces else controller.strip("/")
                yield Use("controller", written, endpoint.location, "ActionClient")


def _namespaces(workspace: Workspace) -> set[str]:
    """Return the namespaces of controllers: those of keys, of controller managers and of Gazebo."""
    names = {"/".join(keys).rpartition("/")[0] for keys, _ in named_sections(workspace)}
    names |= {node.namespace or "" for node in workspace.launches.nodes if node.package == MANAGER}
    for robot in workspace.robots.known:
        names |= {element.text or "" for element in robot.root.iter("namespace")}
    return {name.strip("/ ") for name in names}
