"""What the YAML files of a configuration for MoveIt name: joints, groups, controllers and actions."""

from pathlib import Path

import pytest

from grader.files.tree import make_tree, overlaid
from grader.lab.submission.opening import make_submission
from grader.lab.submission.submission import Lab
from grader.workspace.rules.reading import read_agreement
from tests.command_line import run
from tests.workspace.rule_examples import files_of_rule

pytestmark = pytest.mark.slow

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
_SRDF = (
    '<robot name="arm"><group name="arm"><chain base_link="base" tip_link="hand"/></group></robot>'
)
_JOINT_LIMITS = "joint_limits: {shoulder: {max_velocity: 1.0}}"
_FILES = {
    "config/arm.urdf.xacro": _ROBOT,
    "config/arm.srdf": _SRDF,
    "config/joint_limits.yaml": _JOINT_LIMITS,
    "config/ros2_controllers.yaml": _CONTROLLERS,
    "config/moveit_controllers.yaml": _MOVEIT,
}


def found_in(
    changed: dict[str, str], urdf: str = "config/arm.urdf.xacro", *, is_certain: bool = True
) -> list[str]:
    """Return the messages of what certainly is wrong in the package with changed files, or of what may be."""
    paths = [path for path in sorted(_ARM.rglob("*")) if path.is_file()]
    files = {
        path.relative_to(_ARM).as_posix().removesuffix(".txt"): path.read_bytes() for path in paths
    }
    texts = {path: text.encode() for path, text in {**_FILES, **changed}.items() if text}
    tree = overlaid(make_tree("arm", (), ()), {**files, **texts})
    found = read_agreement(make_submission(tree, "arm", Lab(urdf)).workspace)
    return [
        it.message
        for it in found.mismatches
        if it.is_certain == is_certain and it.family != "dependencies"
    ]


def test_a_configuration_agrees() -> None:
    """Joints, groups, controllers and actions that exist are no mistake."""
    assert found_in({}) == []


@pytest.mark.parametrize(
    ("path", "old", "new", "message"),
    [
        (
            "config/joint_limits.yaml",
            "shoulder",
            "sholder",
            "joint_limits: there is no joint 'sholder'",
        ),
        ("config/kinematics.yaml", "arm:", "hand:", "kinematics_solver: there is no group 'hand'"),
        (
            "config/arm.srdf",
            'tip_link="hand"',
            'tip_link="tool"',
            "<chain> tip_link: there is no link 'tool'",
        ),
        (
            "config/moveit_controllers.yaml",
            "[shoulder]",
            "[elbow]",
            "arm_controller.joints: there is no joint 'elbow'",
        ),
        (
            "config/moveit_controllers.yaml",
            "arm_controller",
            "arm_moveit",
            "controller_names: there is no controller",
        ),
        (
            "config/moveit_controllers.yaml",
            "action_ns: follow",
            "action_ns: send",
            "arm_controller.action_ns is",
        ),
        (
            "config/moveit_controllers.yaml",
            "names: [arm",
            "names: [an_arm",
            "controller_names: there is no plugin",
        ),
    ],
)
def test_a_name_that_does_not_exist_is_wrong(path: str, old: str, new: str, message: str) -> None:
    """Each mistake is named."""
    text = _FILES.get(path) or (_ARM / path).read_text(encoding="utf-8")
    assert any(found.startswith(message) for found in found_in({path: text.replace(old, new)}))


_LIMB = """\
  <link name="{0}"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="{0}_joint" type="fixed"><parent link="{1}"/><child link="{0}"/></joint>
"""


def test_a_state_beyond_a_limit_is_wrong() -> None:
    """Positions at the limits, and those of joints without limits, are not."""
    state = '<group_state name="up" group="arm"><joint name="shoulder" value="{}"/></group_state></robot>'
    for value in ("1", "-1.0", "0.5", "up"):
        assert found_in({"config/arm.srdf": _SRDF.replace("</robot>", state.format(value))}) == []
    found = found_in({"config/arm.srdf": _SRDF.replace("</robot>", state.format("2.7"))})
    assert found == ["<group_state>: 'shoulder' is at 2.7; its limits are -1 and 1"]


def test_a_group_without_parts_may_be_wrong() -> None:
    """MoveIt leaves it out; one whose parts xacro makes is another file's."""
    srdf = {"config/arm.srdf": _SRDF.replace("</robot>", '<group name="tool"/></robot>')}
    assert found_in(srdf) == []
    assert found_in(srdf, is_certain=False) == [
        "the group 'tool' has no joint, link, chain or group: MoveIt leaves it out"
    ]
    made = {
        "config/arm.srdf": srdf["config/arm.srdf"].replace(
            "/></robot>", "><link name='hand'/></group></robot>"
        )
    }
    assert found_in(made, is_certain=False) == []


def test_the_only_description_has_the_name_of_the_only_robot() -> None:
    """MoveIt writes an error and goes on, so it is a warning."""
    other = {"config/arm.srdf": _SRDF.replace('name="arm"', 'name="limb"', 1)}
    assert found_in(other, is_certain=False) == [
        "the SRDF is of the robot 'limb', but the robot is named 'arm'"
    ]
    both = {**other, "config/own.srdf": _SRDF}
    assert found_in(both, is_certain=False) == []


_HAND = """\
    hand_controller: {type: joint_trajectory_controller/JointTrajectoryController}
    joint_state_broadcaster"""
_SPAWN = """\
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        Node(package='controller_manager', executable='ros2_control_node'),
        Node(package='controller_manager', executable='spawner', arguments=[NAMES]),
    ])
"""


_LAUNCHES = ("demo", "move_group", "moveit_rviz", "rsp", "spawn_controllers")
_NOTHING = _SPAWN.partition("        Node")[0] + "    ])\n"


def test_the_controllers_of_moveit_are_started() -> None:
    """MoveIt waits for the action of one that no spawner starts; that none is started is said of all."""
    names = _MOVEIT.replace("[arm_controller]", "[arm_controller, hand_controller]")
    hand = "  hand_controller: {type: FollowJointTrajectory, action_ns: follow_joint_trajectory, joints: [shoulder]}\n"
    own = _CONTROLLERS.replace("    joint_state_broadcaster", _HAND)
    section = "hand_controller:\n  ros__parameters: {joints: [shoulder], command_interfaces: [position]}\n"
    files = {
        "config/moveit_controllers.yaml": names + hand,
        "config/ros2_controllers.yaml": own + section,
        **{f"launch/{name}.launch.py": _NOTHING for name in _LAUNCHES},
    }
    found = {}
    for started in ("'arm_controller'", "'arm_controller', 'hand_controller'", "input()"):
        launch = _SPAWN.replace("NAMES", started)
        found[started] = [
            it for it in found_in({**files, "launch/own.launch.py": launch}) if "spawner" in it
        ]
    message = "controller_names: no spawner starts 'hand_controller': MoveIt waits for its action"
    assert found == {
        "'arm_controller'": [message],
        "'arm_controller', 'hand_controller'": [],
        "input()": [],
    }


def test_a_description_of_another_robot_is_not_compared() -> None:
    """Its name says so, if there is one of the robot as well; on its own, it may be the name that is wrong."""
    joints = '<joint name="shoulder" value="2"/><joint name="neck" value="2"/>'
    state = f'<group_state name="up" group="arm">{joints}</group_state></robot>'
    other = _SRDF.replace("</robot>", state).replace('name="arm"', 'name="other"', 1)
    assert found_in({"config/other.srdf": other}) == []
    assert len(found_in({"config/arm.srdf": other})) == 2


def test_neighbours_whose_collisions_are_not_disabled_may_be_wrong_if_others_are() -> None:
    """It is a warning: they may not touch. If few pairs are disabled, it is not even that."""
    robot = _ROBOT.replace(
        "<ros2_control", "".join(map(_LIMB.format, "abcd", ("hand", *"abc"))) + "<ros2_control"
    )
    pairs = [("a", "b"), ("b", "c"), ("c", "d")]

    def found(disabled: list[tuple[str, str]]) -> list[str]:
        rows = "".join(
            f'<disable_collisions link1="{two}" link2="{one}"/>' for one, two in disabled
        )
        srdf = {"config/arm.srdf": _SRDF.replace("</robot>", f"{rows}</robot>")}
        return found_in({"config/arm.urdf.xacro": robot, **srdf}, is_certain=False)

    assert found(pairs) == found(pairs[:1]) == found([]) == []
    assert found(pairs[:2]) == [
        "a joint connects 'c' and 'd', but <disable_collisions> does not name them"
    ]


def test_moveit_and_the_controller_have_the_same_joints() -> None:
    """A joint that the robot does not have is said of the frames."""
    robot = _ROBOT.replace(
        "<ros2_control", _LIMB.format("a", "hand").replace("fixed", "continuous") + "<ros2_control"
    )
    own = {
        "config/arm.urdf.xacro": robot,
        "config/moveit_controllers.yaml": _MOVEIT.replace("[shoulder]", "[shoulder, a_joint]"),
    }
    assert found_in(own) == [
        "arm_controller.joints: MoveIt and the controller (config/ros2_controllers.yaml:6) have other joints: a_joint"
    ]


def test_a_joint_that_follows_another_is_listed_or_left_out() -> None:
    """MoveIt sends goals for active joints only, and the gripper's controller reads `joint`, not `joints`."""
    mimic = _LIMB.format("a", "hand").replace(
        'type="fixed">', 'type="continuous"><mimic joint="shoulder"/>'
    )
    robot = {"config/arm.urdf.xacro": _ROBOT.replace("<ros2_control", mimic + "<ros2_control")}
    both = {"config/moveit_controllers.yaml": _MOVEIT.replace("[shoulder]", "[shoulder, a_joint]")}
    assert found_in({**robot, **both}) == []
    kind = "joint_trajectory_controller/JointTrajectoryController"
    gripper = _CONTROLLERS.replace(kind, "position_controllers/GripperActionController")
    two = {
        "config/arm.urdf.xacro": robot["config/arm.urdf.xacro"].replace(
            '<mimic joint="shoulder"/>', ""
        )
    }
    for wanted, is_wrong in (("shoulder", False), ("a_joint", True)):
        own = gripper.replace("joints: [shoulder]", f"joint: {wanted}, joints: [shoulder, a_joint]")
        found = found_in({**two, "config/ros2_controllers.yaml": own})
        assert any("have other joints" in it for it in found) == is_wrong, found


def test_a_controller_of_another_robot_is_not_missing() -> None:
    """Where there are several robots, the driver of another one may have the controllers that MoveIt names."""
    moveit = {"config/moveit_controllers.yaml": _MOVEIT.replace("arm_controller", "limb")}
    other = {"urdf/limb.urdf": '<robot name="limb"><link name="l"/></robot>'}
    assert found_in(moveit) == ["controller_names: there is no controller 'limb'"]
    assert found_in({**moveit, **other}) == []


def test_the_robot_is_the_one_that_the_setup_assistant_names() -> None:
    """Its launch files give the arguments of xacro that the robot declares."""
    launch = (_ARM / "launch/rsp.launch.py.txt").read_text(encoding="utf-8")
    mapped = launch.replace(
        ".to_moveit_configs()",
        '.robot_description(mappings={"simulated": "true"}).to_moveit_configs()',
    )
    assistant = "moveit_setup_assistant_config:\n  urdf: {package: arm_moveit_config, relative_path: robots/arm.xacro}\n"
    robot = _ROBOT.replace(
        '<robot name="arm">',
        '<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        '<xacro:arg name="simulate" default="false"/>',
    )
    cmake = (_ARM / "CMakeLists.txt").read_text(encoding="utf-8")
    installed = cmake.replace(
        "ament_package",
        "install(FILES .setup_assistant DESTINATION share/${PROJECT_NAME})\n"
        "install(DIRECTORY robots DESTINATION share/${PROJECT_NAME})\nament_package",
    )
    found = found_in(
        {
            ".setup_assistant": assistant,
            "robots/arm.xacro": robot,
            "config/arm.urdf.xacro": "",
            "CMakeLists.txt": installed,
            "launch/rsp.launch.py": mapped,
        },
        "robots/arm.xacro",
    )
    assert found == [
        "Command of xacro: there is no xacro argument 'simulated'; did you mean 'simulate' (robots/arm.xacro:1)?"
    ]


def test_nothing_is_said_of_a_robot_that_is_not_known() -> None:
    """A robot whose description is not part of the submission may have any joint."""
    include = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:include filename="$(find other)/a.xacro"/></robot>'
    assert (
        found_in(
            {
                "config/arm.urdf.xacro": include,
                "config/joint_limits.yaml": "joint_limits: {elbow: {}}",
            }
        )
        == []
    )


@pytest.mark.parametrize(
    ("distro", "count"), [(["--distro", "jazzy"], 1), (["--distro", "humble"], 0), ([], 0)]
)
def test_the_adapters_of_a_pipeline_are_a_list_from_jazzy_on(
    distro: list[str], count: int, tmp_path: Path
) -> None:
    """Until Iron they are a text, and without a stated release nothing is said."""
    for path, text in files_of_rule("planning-list", "wrong").files.items():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(text, encoding="utf-8")
    done = run(("inspect", tmp_path, "--format", "concise", *distro))
    assert done.stdout.count(b"request_adapters is a text") == count
