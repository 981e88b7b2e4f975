"""Files of MoveIt: the joints, groups and controllers that joint_limits.yaml and others name."""

from collections.abc import Collection, Iterator

from grader.base.records import Named
from grader.base.source import Location
from grader.base.text import enumerated, quoted
from grader.ros.config.yaml_nodes import YamlNode
from grader.ros.config.yaml_values import sections_in
from grader.ros.known.package_tables import moveit_actions
from grader.ros.known.releases import is_before
from grader.workspace.graph.compared_robots import robots_for_file
from grader.workspace.graph.started_controllers import defined_controllers
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Facts,
    Mismatch,
    Mismatches,
    Use,
    among,
)
from grader.workspace.rules.rule_table import NO_CONTROLLER, NO_PARAMETER, Rule
from grader.workspace.rules.shared_symptoms import (
    ACTION_NOT_CONNECTED,
    JOINTS_WITHOUT_CONTROLLER,
    TYPE_EXPECTED,
)
from grader.workspace.rules.spawners import started_controllers

_MANAGER = "moveit_simple_controller_manager"
_NEWER_TYPES = ("ParallelGripperCommand",)  # of controllers, on the branch main
_OF_PIPELINE = "_planning.yaml"  # MoveItConfigsBuilder finds the files by their names
_TABLES_OF_JOINTS = ("joint_limits", "initial_positions")


def moveit_facts(workspace: Workspace) -> Facts:
    """Yield what the YAML files of a configuration for MoveIt name, if a robot is known."""
    if not workspace.robots.known:
        return
    left_out = _not_spawned(workspace)
    for tree in workspace.installed.trees:
        path = tree.source.path
        if path.endswith(_OF_PIPELINE):
            yield from _text_for_list(workspace, tree)
        compared = robots_for_file(workspace, path)
        for use in _joints_and_groups(tree):
            yield among(use, compared)
        manager = tree.get(_MANAGER)
        for controller in _controllers(manager) if manager else ():
            for use in _list_names(workspace, controller):
                yield among(use, compared)
            yield from _not_started(controller, left_out)
            yield from _other_joints(workspace, controller)
            yield from _other_action(controller)


_PLANNING_LIST = Rule(
    "planning-list",
    "parameters",
    NO_PARAMETER,
    "The adapters of a planning pipeline of MoveIt are a list from Jazzy on.",
    is_of_type=True,
    why=(
        "move_group of Jazzy and later declares a list of strings. A single string raises an "
        "exception about the parameter type, and move_group ends at its start."
    ),
    symptoms=(TYPE_EXPECTED,),
    wrong="""
planning_plugin: ompl_interface/OMPLPlanner
request_adapters: default_planner_request_adapters/FixWorkspaceBounds
""",
    right="""
planning_plugins: [ompl_interface/OMPLPlanner]
request_adapters: [default_planning_request_adapters/ValidateWorkspaceBounds]
""",
    frame="ompl_planning.yaml",
    beside={
        "arm/rover.urdf": "",
    },
)


def _text_for_list(workspace: Workspace, tree: YamlNode) -> Mismatches:
    """Yield that the file of a pipeline has the form of Humble, and all stated releases are later.

    planning_pipeline_parameters.yaml of Jazzy declares a list: ParameterTypeException.
    """
    releases = workspace.releases
    adapters = tree.get("request_adapters")
    if not releases or any(is_before(release, "jazzy") for release in releases):
        return
    if adapters and isinstance(adapters.value, str):
        message = (
            "request_adapters is a text, so move_group stops: from Jazzy on it is a list, as "
            "planning_plugins is in place of planning_plugin"
        )
        at = tree.key_location("request_adapters")
        yield Mismatch(_PLANNING_LIST, message, at, names=("string_array", "string"))


def _joints_and_groups(tree: YamlNode) -> Iterator[Use]:
    """Yield the joints and groups in the tables of a file."""
    for key in _TABLES_OF_JOINTS:
        table = tree.get(key)
        for name, node in table.table.items() if table else ():
            yield Use("joint", name, node.location, key)
    for name, node in tree.table.items():
        if node.get("kinematics_solver"):
            yield Use("group", name, node.location, "kinematics_solver")


class _MoveItController(Named):
    """A controller of ros2_control to which MoveIt sends goals."""

    name: str
    location: Location
    section: YamlNode

    @property
    def joints(self) -> YamlNode | None:
        """The joints for which it gets goals."""
        return self.section.get("joints")


def _controllers(manager: YamlNode) -> Iterator[_MoveItController]:
    """Yield the controllers of a list of plugins that have a section."""
    names = manager.get("controller_names")
    for node in names.items if names else ():
        section = manager.get(node.text or "")
        if section:
            yield _MoveItController(node.text or "", node.location, section)


def _list_names(workspace: Workspace, controller: _MoveItController) -> Iterator[Use]:
    """Yield the controller and the joints that a section names.

    Without definitions, the robot's driver has the controllers; another robot may have one too.
    """
    name = controller.name
    at = controller.location
    if defined_controllers(workspace):
        is_optional = workspace.robots.may_be_others
        yield Use("controller", name, at, "controller_names", optional=is_optional)
    for joint in controller.joints.items if controller.joints else ():
        yield Use("joint", joint.text or "", joint.location, f"{name}.joints")


_MOVEIT_CONTROLLER = Rule(
    "moveit-controller",
    "controllers",
    NO_CONTROLLER,
    "A spawner starts the controllers that MoveIt commands.",
    why=(
        "Planning succeeds and execution fails: MoveIt waits for an action that no controller "
        "offers, then reports that its action client is not connected."
    ),
    symptoms=(
        ACTION_NOT_CONNECTED,
        JOINTS_WITHOUT_CONTROLLER,
    ),
    wrong="""
moveit_simple_controller_manager:
  controller_names: [hand_controller]
  hand_controller:
    {type: FollowJointTrajectory, action_ns: follow_joint_trajectory, joints: [arm_joint]}
""",
    right="""
moveit_simple_controller_manager:
  controller_names: [arm_controller]
  arm_controller:
    {type: FollowJointTrajectory, action_ns: follow_joint_trajectory, joints: [arm_joint]}
""",
    frame="moveit_controllers.yaml",
    beside={
        "arm/rover.urdf": "",
        "controllers.yaml": """
controller_manager:
  ros__parameters:
    arm_controller: {type: joint_trajectory_controller/JointTrajectoryController}
    hand_controller: {type: joint_trajectory_controller/JointTrajectoryController}
arm_controller:
  ros__parameters:
    {joints: [arm_joint], command_interfaces: [position], state_interfaces: [position]}
hand_controller:
  ros__parameters:
    {joints: [arm_joint], command_interfaces: [position], state_interfaces: [position]}
""",
        "spawn/rover.launch.py": "",
    },
)


def _not_started(controller: _MoveItController, left_out: Collection[str]) -> Mismatches:
    """Yield that no spawner starts a controller, while one starts others that move joints."""
    if controller.name in left_out:
        message = (
            f"controller_names: no spawner starts {quoted(controller.name)}: MoveIt waits for its "
            "action"
        )
        yield Mismatch(_MOVEIT_CONTROLLER, message, controller.location)


def _not_spawned(workspace: Workspace) -> frozenset[str]:
    """Return the controllers that no spawner starts, while one starts others that move joints."""
    started = started_controllers(workspace)
    movers = {
        controller.name
        for controller in defined_controllers(workspace)
        if not controller.is_broadcaster
    }
    if started is None or started.isdisjoint(movers):
        return frozenset()
    return frozenset(movers - started)


_MOVEIT_ACTION = Rule(
    "moveit-action",
    "controllers",
    NO_CONTROLLER,
    "MoveIt names the action of its controller.",
    why=(
        "MoveIt ignores the controller or waits for an action that does not exist. It plans, "
        "but every execution fails and the robot does not move."
    ),
    symptoms=(
        ACTION_NOT_CONNECTED,
        JOINTS_WITHOUT_CONTROLLER,
    ),
    wrong="""
moveit_simple_controller_manager:
  controller_names: [arm_controller]
  arm_controller: {type: FollowJointTrajectory, action_ns: follow_trajectory, joints: [arm_joint]}
""",
    right="""
moveit_simple_controller_manager:
  controller_names: [arm_controller]
  arm_controller:
    {type: FollowJointTrajectory, action_ns: follow_joint_trajectory, joints: [arm_joint]}
""",
    frame="moveit_controllers.yaml",
    beside={
        "arm/rover.urdf": "",
    },
)


def _other_action(controller: _MoveItController) -> Mismatches:
    """Yield that MoveIt sends the goals of a controller to no action, or to one that is not there.

    moveit_simple_controller_manager.cpp of Humble and Jazzy leaves out one without action_ns.
    """
    kind = controller.section.get("type")
    action = controller.section.get("action_ns")
    if not kind:
        return
    wanted = moveit_actions().get(kind.text or "")
    if wanted is None and kind.text and kind.text not in _NEWER_TYPES:
        message = (
            f"MoveIt has no type {kind.text!r} of controllers, so it leaves out {controller.name}: "
            f"it has {enumerated(moveit_actions())}"
        )
        yield Mismatch(_MOVEIT_ACTION, message, kind.location, is_certain=False)
        return
    if not action:
        if wanted is not None:
            message = (
                f"{controller.name} has no action_ns, so MoveIt leaves it out: add action_ns: "
                f"{wanted}"
            )
            yield Mismatch(_MOVEIT_ACTION, message, controller.section.location, kind.location)
        return
    if wanted is not None and action.text not in ("", wanted):
        message = (
            f"{controller.name}.action_ns is {action.text!r}; the action of its controller is "
            f"{wanted!r}"
        )
        wrong = Mismatch(_MOVEIT_ACTION, message, action.location, kind.location)
        yield wrong.correcting(action.text or "", wanted)


_MOVEIT_JOINTS = Rule(
    "moveit-joints",
    "controllers",
    NO_CONTROLLER,
    "MoveIt gives a controller the joints that it has.",
    why=(
        "The controller rejects trajectories for joints that it does not have, or MoveIt finds "
        "no controller for some joints. The robot does not move."
    ),
    symptoms=(JOINTS_WITHOUT_CONTROLLER,),
    wrong="""
moveit_simple_controller_manager:
  controller_names: [arm_controller]
  arm_controller: {type: FollowJointTrajectory, joints: [arm_joint, hand_joint]}
""",
    right="""
moveit_simple_controller_manager:
  controller_names: [arm_controller]
  arm_controller:
    {type: FollowJointTrajectory, action_ns: follow_joint_trajectory, joints: [arm_joint]}
""",
    frame="moveit_controllers.yaml",
    beside={
        "two/rover.urdf": """
<robot name="rover">
  <link name="base_link"/> <link name="arm"/> <link name="hand"/>
  <joint name="arm_joint" type="continuous"><parent link="base_link"/><child link="arm"/></joint>
  <joint name="hand_joint" type="continuous"><parent link="arm"/><child link="hand"/></joint>
</robot>
""",
        "arm/controllers.yaml": "",
    },
)


def _other_joints(workspace: Workspace, controller: _MoveItController) -> Mismatches:
    """Yield that MoveIt gives a controller other joints than it has, all of which are in the robot.

    MoveIt sends no goals for joints that follow others.
    """
    joints = controller.joints
    controlled = _controlled_joints(workspace, controller.name)
    if joints is None or controlled is None:
        return
    names = set()
    following = set()
    for known_robot in workspace.robots.known:
        for joint in known_robot.robot.joints:
            names.add(joint.name)
            if joint.mimic:
                following.add(joint.name)
    by_moveit = _joint_names(joints)
    by_controller = _joint_names(controlled)
    differing = sorted((by_moveit ^ by_controller) - following)
    if by_moveit and by_controller and differing and names.issuperset(differing):
        message = (
            f"{controller.name}.joints: MoveIt and the controller "
            f"({controlled.location.file_and_line}) have other joints: {', '.join(differing)}"
        )
        yield Mismatch(_MOVEIT_JOINTS, message, joints.location, controlled.location)


def _controlled_joints(workspace: Workspace, name: str) -> YamlNode | None:
    """Return the joints in the parameters of a controller; None unless one file has some."""
    sections = []
    for tree in workspace.installed.trees:
        sections += [section for keys, section in sections_in(tree) if keys[-1:] == (name,)]
    if len(sections) != 1:
        return None
    types = [each.type.text or "" for each in defined_controllers(workspace) if each.name == name]
    is_gripper = any(kind.endswith("/GripperActionController") for kind in types)
    return sections[0].get("joint" if is_gripper else "joints")


def _joint_names(node: YamlNode) -> set[str]:
    return {joint.text or "" for joint in node.items or [node]}
