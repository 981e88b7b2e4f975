"""Files of MoveIt: the joints, groups and controllers that joint_limits.yaml and its neighbours
name.
"""

from collections.abc import Iterator

from grader.base.text import quoted
from grader.ros.config.yaml_nodes import YamlNode
from grader.ros.config.yaml_values import sections_in
from grader.ros.known.package_tables import moveit_actions
from grader.ros.workspace.graph.started_controllers import defined_controllers
from grader.ros.workspace.model.workspace import Workspace
from grader.ros.workspace.rules.names import Fact, Mismatch, Use, corrections
from grader.ros.workspace.rules.rule_table import (
    MOVEIT_ACTION,
    MOVEIT_CONTROLLER,
    MOVEIT_JOINTS,
)
from grader.ros.workspace.rules.spawners import started_controllers

_MANAGER = "moveit_simple_controller_manager"
_TABLES_OF_JOINTS = ("joint_limits", "initial_positions")


def moveit_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield what the YAML files of a configuration for MoveIt name, if a robot is known."""
    if not workspace.robots.known:
        return
    for _, tree in workspace.installed.trees:
        for key in _TABLES_OF_JOINTS:
            table = tree.get(key)
            if table is not None and isinstance(table.value, dict):
                for name, node in table.value.items():
                    yield Use("joint", name, node.location, key)
        if isinstance(tree.value, dict):
            for name, node in tree.value.items():
                if node.get("kinematics_solver") is not None:
                    yield Use("group", name, node.location, "kinematics_solver")
        manager = tree.get(_MANAGER)
        if manager is not None:
            yield from _controllers(workspace, manager)


def _controllers(workspace: Workspace, manager: YamlNode) -> Iterator[Fact]:
    """Yield the controllers of ros2_control that MoveIt sends goals to, their joints and their
    actions.
    """
    names = manager.get("controller_names")
    # Without definitions, the robot's driver has the controllers.
    defined = {controller.name for controller in defined_controllers(workspace)}
    are_defined = bool(defined)
    left_out = _not_spawned(workspace)
    for node in names.items if names is not None else ():
        name = node.text or ""
        section = manager.get(name)
        if section is None:
            continue  # a list of plugins without its section
        if are_defined:
            # Another robot may have a driver with its controllers.
            is_optional = workspace.robots.may_be_others
            yield Use("controller", name, node.location, "controller_names", optional=is_optional)
        if name in left_out:
            message = (
                f"controller_names: no spawner starts {quoted(name)}: MoveIt waits for its action"
            )
            yield Mismatch(MOVEIT_CONTROLLER, message, node.location)
        joints = section.get("joints")
        for joint in joints.items if joints is not None else ():
            yield Use("joint", joint.text or "", joint.location, f"{name}.joints")
        yield from _other_joints(workspace, name, joints)
        yield from _other_action(name, section)


def _not_spawned(workspace: Workspace) -> frozenset[str]:
    """Return the controllers that no spawner starts, while one starts others that move joints."""
    started = started_controllers(workspace)
    movers = {it.name for it in defined_controllers(workspace) if not it.is_broadcaster}
    if started is None or started.isdisjoint(movers):
        return frozenset()
    return frozenset(movers - started)


def _other_action(name: str, section: YamlNode) -> Iterator[Mismatch]:
    """Yield that MoveIt sends the goals of a controller to an action that it does not have."""
    kind, action = section.get("type"), section.get("action_ns")
    if kind is None or action is None:
        return
    wanted = moveit_actions().get(kind.text or "")
    if wanted is not None and action.text not in ("", wanted):
        message = f"{name}.action_ns is {action.text!r}; the action of its controller is {wanted!r}"
        either = corrections(action.text or "", action.location, wanted)
        yield Mismatch(MOVEIT_ACTION, message, action.location, kind.location, corrections=either)


def _other_joints(workspace: Workspace, name: str, joints: YamlNode | None) -> Iterator[Mismatch]:
    """Yield that MoveIt gives a controller other joints than it has, all of which are in the
    robot.
    """
    sections: list[YamlNode] = []
    for _, tree in workspace.installed.trees:
        sections += [section for keys, section in sections_in(tree) if keys[-1:] == (name,)]
    if joints is None or len(sections) != 1:
        return
    types = [each.type.text or "" for each in defined_controllers(workspace) if each.name == name]
    is_gripper = any(kind.endswith("/GripperActionController") for kind in types)
    controlled = sections[0].get("joint" if is_gripper else "joints")
    if controlled is None:
        return
    by_moveit, by_controller = _joint_names(joints), _joint_names(controlled)
    # MoveIt sends no goals for joints that follow others.
    every = [joint for found in workspace.robots.known for joint in found.robot.joints]
    following = {joint.name for joint in every if joint.mimic is not None}
    differing = sorted((by_moveit ^ by_controller) - following)
    if not by_moveit or not by_controller or not differing:
        return
    if {joint.name for joint in every}.issuperset(differing):
        message = (
            f"{name}.joints: MoveIt and the controller ({controlled.location.file_and_line}) have "
            f"other joints: {', '.join(differing)}"
        )
        yield Mismatch(MOVEIT_JOINTS, message, joints.location, controlled.location)


def _joint_names(node: YamlNode) -> set[str]:
    return {joint.text or "" for joint in node.items or [node]}
