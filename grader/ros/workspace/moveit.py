"""Files of MoveIt: the joints, groups and controllers that joint_limits.yaml and its neighbours
name.
"""

from collections.abc import Iterator

from grader.ros.config.yaml_nodes import YamlNode
from grader.ros.config.yaml_values import sections_in
from grader.ros.workspace.controllers import defined_controllers
from grader.ros.workspace.names import Fact, Mismatch, Use, corrections, place_text
from grader.ros.workspace.workspace import Workspace

_MANAGER = "moveit_simple_controller_manager"
_TABLES_OF_JOINTS = ("joint_limits", "initial_positions")
_ACTIONS = {"FollowJointTrajectory": "follow_joint_trajectory", "GripperCommand": "gripper_cmd"}


def moveit_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield what the YAML files of a configuration for MoveIt name, if the robot is known."""
    if workspace.robot is None:
        return
    for _, tree in workspace.trees:
        for key in _TABLES_OF_JOINTS:
            table = tree.get(key)
            for name, node in (
                table.value.items() if table is not None and isinstance(table.value, dict) else ()
            ):
                yield Use("joint", name, node.location, key)
        if isinstance(tree.value, dict):
            groups = {
                name: node
                for name, node in tree.value.items()
                if node.get("kinematics_solver") is not None
            }
            yield from (
                Use("group", name, node.location, "kinematics_solver")
                for name, node in groups.items()
            )
        manager = tree.get(_MANAGER)
        if manager is not None:
            yield from _controllers(workspace, manager)


def _controllers(workspace: Workspace, manager: YamlNode) -> Iterator[Fact]:
    """Yield the controllers of ros2_control that MoveIt sends goals to, their joints and their
    actions.
    """
    names = manager.get("controller_names")
    for node in names.items if names is not None else ():
        name = node.text or ""
        section = manager.get(name)
        if section is None:
            continue  # a list of plugins without its section
        if (
            next(defined_controllers(workspace), None) is not None
        ):  # else the robot's driver has them
            may_be_another = workspace.has_other_robots  # with a driver that has its controllers
            yield Use(
                "controller", name, node.location, "controller_names", optional=may_be_another
            )
        joints = section.get("joints")
        for joint in joints.items if joints is not None else ():
            yield Use("joint", joint.text or "", joint.location, f"{name}.joints")
        yield from _other_joints(workspace, name, joints)
        kind, action = section.get("type"), section.get("action_ns")
        wanted = _ACTIONS.get(kind.text or "") if kind is not None else None
        if wanted is not None and action is not None and action.text not in ("", wanted):
            message = (
                f"{name}.action_ns is {action.text!r}; the action of its controller is {wanted!r}"
            )
            either = corrections(action.text or "", action.location, wanted)
            yield Mismatch(
                "controllers",
                message,
                action.location,
                kind.location if kind else None,
                True,
                either,
            )


def _other_joints(workspace: Workspace, name: str, joints: YamlNode | None) -> Iterator[Mismatch]:
    """Yield that MoveIt gives a controller other joints than it has, all of which are in the
    robot.
    """
    sections = [
        section
        for _, tree in workspace.trees
        for keys, section in sections_in(tree)
        if keys[-1:] == (name,)
    ]
    types = [it.type.text or "" for it in defined_controllers(workspace) if it.name == name]
    key = "joint" if any(it.endswith("/GripperActionController") for it in types) else "joints"
    theirs = sections[0].get(key) if len(sections) == 1 else None
    if joints is None or theirs is None or workspace.robot is None:
        return
    own, other = ({it.text or "" for it in node.items or [node]} for node in (joints, theirs))
    following = {
        it.name for it in workspace.robot.joints if it.mimic is not None
    }  # MoveIt sends no goals for them
    differing = sorted((own ^ other) - following)
    if own and other and differing and all(map(workspace.robot.has_joint, differing)):
        message = (
            f"{name}.joints: MoveIt and the controller ({place_text(theirs.location)}) have "
            "other joints"
        )
        yield Mismatch(
            "controllers", f"{message}: {', '.join(differing)}", joints.location, theirs.location
        )
