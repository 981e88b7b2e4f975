"""What the YAML files of a configuration for MoveIt name: joints, groups, controllers and actions."""

from pathlib import Path

import pytest

from grader.files.tree import make_tree, overlaid
from grader.submission.opening import submission_of
from grader.submission.submission import Lab
from grader.workspace.reading import read_agreement

_ARM = Path(__file__).parent.parent / "corpus" / "given" / "moveit" / "arm"
_CONTROLLERS = """\
controller_manager:
  ros__parameters:
    arm_controller: {type: joint_trajectory_controller/JointTrajectoryController}
    joint_state_broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}
arm_controller:
  ros__parameters: {joints: [shoulder], command_interfaces: [position]}
"""
_MOVEIT = """\
moveit_simple_controller_manager:
  controller_names: [arm_controller]
  arm_controller:
    type: FollowJointTrajectory
    action_ns: follow_joint_trajectory
    joints: [shoulder]
"""
_ROBOT = """\
<robot name="arm">
  <link name="base"/><link name="hand"/>
  <joint name="shoulder" type="revolute">
    <parent link="base"/><child link="hand"/><limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
  <ros2_control name="arm" type="system">
    <hardware><plugin>mock_components/GenericSystem</plugin></hardware>
    <joint name="shoulder"><command_interface name="position"/><state_interface name="position"/></joint>
  </ros2_control>
</robot>
"""
_SRDF = '<robot name="arm"><group name="arm"><chain base_link="base" tip_link="hand"/></group></robot>'
_JOINT_LIMITS = "joint_limits: {shoulder: {max_velocity: 1.0}}"
_FILES = {
    "config/arm.urdf.xacro": _ROBOT, "config/arm.srdf": _SRDF, "config/joint_limits.yaml": _JOINT_LIMITS,
    "config/ros2_controllers.yaml": _CONTROLLERS, "config/moveit_controllers.yaml": _MOVEIT,
}  # fmt: skip


def found_in(changed: dict[str, str]) -> list[str]:
    """Return the messages of what certainly is wrong in the package with changed files."""
    paths = [path for path in sorted(_ARM.rglob("*")) if path.is_file()]
    files = {path.relative_to(_ARM).as_posix().removesuffix(".txt"): path.read_bytes() for path in paths}
    texts = {path: text.encode() for path, text in {**_FILES, **changed}.items()}
    tree = overlaid(make_tree("arm", (), ()), {**files, **texts})
    found = read_agreement(submission_of(tree, "arm", Lab("config/arm.urdf.xacro")))
    return [it.message for it in found.mismatches if it.is_sure and it.family != "dependencies"]


def test_a_configuration_agrees() -> None:
    """Joints, groups, controllers and actions that exist are no mistake."""
    assert found_in({}) == []


@pytest.mark.parametrize(
    ("path", "old", "new", "message"),
    [
        ("config/joint_limits.yaml", "shoulder", "sholder", "joint_limits: there is no joint 'sholder'"),
        ("config/kinematics.yaml", "arm:", "hand:", "kinematics_solver: there is no group 'hand'"),
        ("config/arm.srdf", 'tip_link="hand"', 'tip_link="tool"', "<chain> tip_link: there is no link 'tool'"),
        ("config/moveit_controllers.yaml", "[shoulder]", "[elbow]", "arm_controller.joints: there is no joint 'elbow'"),
        ("config/moveit_controllers.yaml", "arm_controller", "arm_moveit", "controller_names: there is no controller"),
        ("config/moveit_controllers.yaml", "action_ns: follow", "action_ns: send", "arm_controller.action_ns is"),
        ("config/moveit_controllers.yaml", "names: [arm", "names: [an_arm", "controller_names: there is no plugin"),
    ],
)
def test_a_name_that_does_not_exist_is_wrong(path: str, old: str, new: str, message: str) -> None:
    """Each mistake is named."""
    text = _FILES.get(path) or (_ARM / path).read_text(encoding="utf-8")
    assert any(found.startswith(message) for found in found_in({path: text.replace(old, new)}))


def test_nothing_is_said_of_a_robot_that_is_not_known() -> None:
    """A robot whose description is not part of the submission may have any joint."""
    include = (
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:include filename="$(find other)/a.xacro"/></robot>'
    )
    assert found_in({"config/arm.urdf.xacro": include, "config/joint_limits.yaml": "joint_limits: {elbow: {}}"}) == []
