"""MoveItConfigsBuilder: the files that it reads, the parameters of nodes, and what the functions of its package start."""

from typing import Any

import pytest

from grader.ros.launch.launch_file import read_launch
from grader.ros.launch.launch_model import Launch
from grader.ros.launch.node_parameters import collect_parameters
from grader.ros.python.values import Unknown
from tests.launch.launch_samples import Installed, summarize

pytestmark = pytest.mark.slow

PACKAGE = "share/arm_moveit_config"
FILES = {
    "arm.urdf.xacro": b"<robot name='arm'/>",
    "arm.srdf": b"<robot name='arm'><virtual_joint name='v' type='fixed' parent_frame='world' child_link='base'/></robot>",
    "kinematics.yaml": b"arm: {kinematics_solver: kdl, timeout: 0.05}",
    "joint_limits.yaml": b"joint_limits: {j1: {max_velocity: 1.5}}",
    "pilz_cartesian_limits.yaml": b"cartesian_limits: {max_trans_vel: 1.0}",
    "moveit_controllers.yaml": b"moveit_simple_controller_manager: {controller_names: [arm_controller]}",
    "ros2_controllers.yaml": b"controller_manager: {ros__parameters: {update_rate: 100}}",
    "ompl_planning.yaml": b"planning_plugins: [ompl]\nplanner_configs: {RRT: {range: 0.0}}",
}
DEMO = (
    "nodes: controller_manager/ros2_control_node tf2_ros/static_transform_publisher robot_state_publisher"
    " moveit_ros_move_group/move_group moveit_ros_move_group/move_group! rviz2 rviz2! controller_manager/spawner"
    " controller_manager/spawner"
)
STARTED = (
    "rsp",
    "move_group",
    "moveit_rviz",
    "spawn_controllers",
    "warehouse_db",
    "static_virtual_joint_tfs",
)
BUILT = "MoveItConfigsBuilder('arm').to_moveit_configs()"
HEAD = """\
from moveit_configs_utils.launches import *
from launch import LaunchDescription
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from moveit_configs_utils import MoveItConfigsBuilder


def generate_launch_description():
"""


def installed(*missing: str, **changed: bytes) -> Installed:
    """Return a MoveIt package, with launch files for each function, without some files of its folder config."""
    files = {
        f"{PACKAGE}/config/{name}": data for name, data in FILES.items() if name not in missing
    }
    files |= {f"{PACKAGE}/config/{name.replace('__', '.')}": data for name, data in changed.items()}
    for name in STARTED:
        files[f"{PACKAGE}/launch/{name}.launch.py"] = (
            f"{HEAD}    return generate_{name}_launch({BUILT})\n".encode()
        )
    return Installed(files)


def launch(body: str, machine: Installed | None = None) -> Launch:
    """Return a launch file whose function has this body."""
    name = "launch/a.launch.py"
    return read_launch(
        f"{HEAD}    {body}\n".encode(), name, f"{PACKAGE}/{name}", machine or installed()
    )


def node(built: str, what: str = ".to_dict()") -> str:
    """Return a body that gives a node this part of a configuration."""
    return (
        f"return LaunchDescription([Node(package='a', executable='b', parameters=[{built}{what}])])"
    )


def given(body: str, machine: Installed | None = None) -> dict[str, Any]:
    """Return the parameters of the node that is started; `?` for those that are unknown, `more` if there may be more."""
    machine = machine or installed()
    found = collect_parameters(launch(body, machine).nodes[0], machine.open_installed, "b")
    values = {
        name: "?" if isinstance(it.value, Unknown) else it.value
        for name, it in found.values.items()
    }
    return values | ({"more": found.unknown} if found.unknown else {})


def read_by(body: str, machine: Installed | None = None) -> list[str]:
    """Return the names of the files that have to be there."""
    return [(it.path or "?").rpartition("/")[2] for it in launch(body, machine).named("read")]


def test_the_demo() -> None:
    """generate_demo_launch includes the launch files of the package, which start what MoveIt's functions start."""
    assert summarize(launch(f"return generate_demo_launch({BUILT})")) == [
        DEMO,
        "urdf 9: arm_moveit_config/config/arm.urdf.xacro",
        "rviz 9: arm_moveit_config/config/moveit.rviz",
        *(
            f"include 9: arm_moveit_config/launch/{name}.launch.py"
            for name in (
                "static_virtual_joint_tfs",
                "rsp",
                "move_group",
                "moveit_rviz",
                "spawn_controllers",
            )
        ),
    ]


@pytest.mark.parametrize(
    ("function", "nodes"),
    [
        (
            "warehouse_db",
            "warehouse_ros_mongo/mongo_wrapper_ros.py moveit_ros_warehouse/moveit_init_demo_warehouse!",
        ),
        ("setup_assistant", "moveit_setup_assistant moveit_setup_assistant!"),
    ],
)
def test_other_functions(function: str, nodes: str) -> None:
    """The other functions start their nodes, too."""
    assert summarize(launch(f"return generate_{function}_launch({BUILT})")) == [f"nodes: {nodes}"]


def test_parameters() -> None:
    """Nodes get the tables of the files, by the names that MoveIt gives them; its own defaults are not known."""
    found = given(node(BUILT))
    assert found["robot_description_kinematics.arm.timeout"] == 0.05
    assert found["robot_description_planning.joint_limits.j1.max_velocity"] == 1.5
    assert found["robot_description_planning.cartesian_limits.max_trans_vel"] == 1.0
    assert found["moveit_simple_controller_manager.controller_names"] == ["arm_controller"]
    assert (found["robot_description"], found["planning_pipelines"]) == ("?", "?")
    assert (found["default_planning_pipeline"], found["ompl.planner_configs.RRT.range"]) == (
        "ompl",
        0.0,
    )
    assert "stomp" in found["more"]


def test_parts() -> None:
    """A node can be given one part of a configuration; the steps of the builder change it."""
    steps = "MoveItConfigsBuilder('arm').joint_limits().planning_pipelines('ompl', ['ompl']).moveit_cpp('config/kinematics.yaml')"
    assert given(node(f"{steps}.to_moveit_configs()", ".joint_limits")) == {
        "robot_description_planning.joint_limits.j1.max_velocity": 1.5
    }
    found = given(node(steps, ".planning_scene_monitor(publish_robot_description=True).to_dict()"))
    assert "more" not in found
    assert (found["planning_pipelines"], found["publish_robot_description"]) == (["ompl"], True)
    assert found["arm.kinematics_solver"] == "kdl"
    assert "pilz_cartesian_limits.yaml" not in read_by(node(steps))


@pytest.mark.parametrize(
    ("missing", "is_needed"),
    [
        ("kinematics.yaml", True),
        ("joint_limits.yaml", True),
        ("pilz_cartesian_limits.yaml", True),
        ("arm.srdf", True),
        ("arm.urdf.xacro", False),
        ("moveit_controllers.yaml", False),
    ],
)
def test_missing_files(missing: str, is_needed: bool) -> None:
    """A file that MoveIt needs is read, whether it is there or not; the robot and the controllers are optional."""
    assert (missing in read_by(node(BUILT), installed(missing))) is is_needed
    assert launch(node(BUILT), installed(missing)).faults == ()


@pytest.mark.parametrize(
    ("built", "fault"),
    [
        ("MoveItConfigsBuilder()", "MoveItConfigsBuilder needs the name of the robot"),
        (
            "MoveItConfigsBuilder('arm').planning_pipelines('x', ['ompl'])",
            "the default pipeline 'x' is none of ompl",
        ),
        (
            "MoveItConfigsBuilder('arm').planning_pipelines(pipelines=[])",
            "MoveIt finds no *_planning.yaml",
        ),
        (
            "MoveItConfigsBuilder('arm').joint_limits(path='a')",
            "joint_limits takes no argument 'path'",
        ),
        (
            "MoveItConfigsBuilder('arm').joint_limits('a', 'b')",
            "joint_limits takes at most 1 arguments",
        ),
        (f"{BUILT}.robot", "MoveItConfigs has no attribute 'robot'"),
    ],
)
def test_faults(built: str, fault: str) -> None:
    """What MoveIt or Python refuses stops the launch file."""
    assert [it.message for it in launch(node(built, "")).faults] == [fault]


def test_several_controllers() -> None:
    """MoveIt cannot choose between several files of controllers without a usual name."""
    found = launch(node(BUILT), installed("moveit_controllers.yaml", my_controllers__yaml=b"a: 1"))
    assert (
        "cannot choose between my_controllers.yaml, ros2_controllers.yaml"
        in found.faults[0].message
    )
    by_name = given(
        node(BUILT), installed("moveit_controllers.yaml", arm_controllers__yaml=b"a: 1")
    )
    assert by_name["a"] == 1


def test_sensors() -> None:
    """Sensors are read if the file is there and lists one."""
    assert "sensors" in given(
        node(BUILT, ".sensors_3d"), installed(sensors_3d__yaml=b"sensors: [kinect]\nkinect: {a: 1}")
    )
    assert given(node(BUILT, ".sensors_3d"), installed(sensors_3d__yaml=b"sensors: []")) == {}


@pytest.mark.parametrize(
    "built",
    [
        "MoveItConfigsBuilder(open('a').read())",
        "MoveItConfigsBuilder('arm').joint_limits(LaunchConfiguration('a'))",
        "MoveItConfigsBuilder('arm').robot_description(mappings=LaunchConfiguration('a'))",
        "MoveItConfigsBuilder('arm').planning_pipelines(pipelines=LaunchConfiguration('a'))",
    ],
)
def test_undecided(built: str) -> None:
    """What is not known leaves the launch file undecided."""
    found = launch(node(built))
    assert found.doubts
    assert not found.faults


def test_what_only_the_setup_assistant_says() -> None:
    """With another SRDF, or without the robot's usual name, the hidden file .setup_assistant decides: unknown."""
    found = launch(
        f"return generate_static_virtual_joint_tfs_launch({BUILT})",
        installed("arm.srdf", my__srdf=b"<robot/>"),
    )
    reasons = [
        "the virtual joints of the SRDF are not evaluated",
        "the SRDF that MoveIt finds is not evaluated",
    ]
    assert [it.message for it in found.unknown] == reasons
    published = launch(f"return generate_rsp_launch({BUILT})", installed("arm.urdf.xacro"))
    assert [it.path for it in published.named("urdf")] == [None]
    assert launch("return generate_rsp_launch(1)").doubts


def test_mappings() -> None:
    """The arguments of xacro are those that the builder is given; substitutions are not known."""
    built = "MoveItConfigsBuilder('arm').robot_description(mappings={'a': '1', 'b': LaunchConfiguration('c')}).to_moveit_configs()"
    [named] = launch(f"return generate_rsp_launch({built})").named("urdf")
    assert (named.by, named.arguments) == ("xacro", (("a", "1"), ("b", None)))


def test_broken_yaml() -> None:
    """A file that is no YAML leaves undecided what reads it."""
    assert launch(node(BUILT), installed(kinematics__yaml=b"{")).doubts


def test_several_controllers_of_a_list() -> None:
    """A list of controllers that is not known may start more."""
    machine = installed(
        "moveit_controllers.yaml", moveit_controllers__yaml=b"moveit_simple_controller_manager: 1"
    )
    assert launch(f"return generate_spawn_controllers_launch({BUILT})", machine).unknown
