"""What `grader inspect` says of whole workspaces as people publish them: several packages, robots and names."""

import json
from collections.abc import Mapping
from pathlib import Path

import pytest

from grader.files.tree import make_tree, overlaid
from grader.lab.submission.opening import make_submission
from grader.lab.submission.submission import Lab, Submission
from grader.workspace.rules.reading import read_agreement
from tests.command_line import run

pytestmark = pytest.mark.slow

_XACRO = """\
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <link name="base"/><link name="hand"/>
  <joint name="elbow" type="revolute">
    <parent link="base"/><child link="hand"/><limit lower="0" upper="${pi/2}" effort="1" velocity="1"/>
  </joint>
</robot>
"""
_RUNS_XACRO = """\
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.substitutions import Command
from launch_ros.actions import Node

def generate_launch_description():
    urdf = get_package_share_directory("arm") + "/urdf/arm.urdf"
    robot = {"robot_description": Command(["xacro ", urdf])}
    node = Node(package="robot_state_publisher", executable="robot_state_publisher", parameters=[robot])
    return LaunchDescription([node])
"""


def package(
    folder: str, *folders: str, name: str = "", files: Mapping[str, str] | None = None
) -> dict[str, str]:
    """Return the files of a package whose build installs these folders."""
    name = name or folder.rpartition("/")[2]
    install = (
        f"install(DIRECTORY {' '.join(folders)} DESTINATION share/{name})\n" if folders else ""
    )
    cmake = f"project({name})\nfind_package(ament_cmake REQUIRED)\n{install}ament_package()\n"
    manifest = f"<package format='3'><name>{name}</name><export><build_type>ament_cmake</build_type></export></package>"
    own = {"package.xml": manifest, "CMakeLists.txt": cmake, **(files or {})}
    return {f"{folder}/{path}": text for path, text in own.items()}


def workspace(*packages: Mapping[str, str]) -> Submission:
    """Return a workspace of packages, read without a rubric."""
    texts = {path: text.encode() for files in packages for path, text in files.items()}
    return make_submission(overlaid(make_tree("ws", (), ()), texts), "ws", Lab("robot.urdf"))


def errors_in(*packages: Mapping[str, str]) -> list[str]:
    """Return the messages of what certainly does not agree, without undeclared dependencies."""
    found = read_agreement(workspace(*packages).workspace).mismatches
    return [it.message for it in found if it.is_certain and it.family != "dependencies"]


def test_a_launch_file_of_any_package_runs_xacro() -> None:
    """Also where another package comes first, and where the launch file is in a package beside that of the robot."""
    robot, launch = {"urdf/arm.urdf": _XACRO}, {"launch/arm.launch.py": _RUNS_XACRO}
    first = package("a", files={"setup.py": "", "launch/a.launch.py": "", "a.rviz": ""})
    for packages in (
        [first, package("arm", "urdf", "launch", files={**robot, **launch})],
        [
            first,
            package("arm", "urdf", files=robot),
            package("arm_bringup", "launch", files=launch),
        ],
    ):
        assert workspace(*packages).verdict == "clean"
    alone = package("arm", "urdf", files=robot)
    copy = package("old/arm", "urdf", "launch", files=launch)
    assert workspace(first, alone).verdict == workspace(first, alone, copy).verdict == "rejected"


def test_a_file_means_its_own_package_of_several_of_one_name() -> None:
    """What the robot includes, and what a launch file names, is looked for in the package that the file is in."""
    robot = _XACRO.replace(
        "<link", '<xacro:include filename="$(find arm)/urdf/more.xacro"/><link', 1
    )
    files = {"urdf/arm.xacro": robot, "urdf/more.xacro": "<robot/>"}
    packages = [
        package(
            "a/arm", "urdf", files={"urdf/box.urdf": '<robot name="box"><link name="box"/></robot>'}
        )
    ]
    packages += [package("b/arm", "urdf", files=files)]
    assert workspace(*packages).verdict == "clean"
    assert errors_in(*packages) == []


def test_a_package_in_another_one_has_its_own_files() -> None:
    """A launch file of the inner package is judged by what the inner package installs."""
    inner = package(
        "arm/src/arm",
        "urdf",
        "launch",
        files={"urdf/arm.urdf": _XACRO, "launch/a.launch.py": _RUNS_XACRO},
    )
    assert errors_in(package("arm"), inner) == []
    stray = {"arm/urdf/package.xml": "<package format='3'><name>stray</name></package>"}
    own = package(
        "arm", "urdf", "launch", files={"urdf/arm.urdf": _XACRO, "launch/a.launch.py": _RUNS_XACRO}
    )
    [arm] = [it for it in workspace(own, stray).packages if it.name == "arm"]
    assert "share/arm/urdf/arm.urdf" in arm.installed


def test_a_name_of_several_packages_is_undecided_elsewhere() -> None:
    """A file of a third package may mean either, also the one that lacks the file or the program."""
    launch = _RUNS_XACRO.replace('executable="robot_state_publisher"', 'executable="x"')
    launch = launch.replace('package="robot_state_publisher"', 'package="arm"')
    third = package("c", "launch", files={"launch/c.launch.py": launch})
    arms = [
        package(
            f"{it}/arm",
            "urdf",
            files={f"urdf/{it}.xacro": '<robot name="r"><link name="l"/></robot>'},
        )
        for it in "ab"
    ]
    assert len(errors_in(arms[0], third)) == 2
    assert errors_in(*arms, third) == []


def test_files_of_parameters_that_are_given_together_count_together() -> None:
    """A list in one file may name sections of another one; a file that a node gets on its own needs its sections."""
    head = "local_costmap:\n  local_costmap:\n    ros__parameters:\n      plugins: [walls]\n"
    base = head + '      walls: {plugin: "nav2_costmap_2d::ObstacleLayer"}\n'
    overlay = head.replace("walls", "walls, fog") + '      fog: {plugin: "fog_layer/FogLayer"}\n'
    launch = """
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    share = get_package_share_directory("n")
    return LaunchDescription([
        Node(package="nav2_controller", executable="controller_server", parameters=[FILES])])
"""
    files = {"config/base.yaml": base, "config/overlay.yaml": overlay}
    for given, count in ((("base", "overlay"), 0), (("base",), 0), (("overlay",), 1)):
        text = launch.replace("FILES", ", ".join(f'share + "/config/{it}.yaml"' for it in given))
        found = errors_in(
            package("n", "config", "launch", files={**files, "launch/n.launch.py": text})
        )
        assert len(found) == count, found
    assert (
        "there is no plugin section 'walls'"
        in errors_in(package("n", "config", files={"config/overlay.yaml": overlay}))[0]
    )


def test_what_programs_write_and_metapackages_bring_is_no_warning() -> None:
    """Nor is a transform that equals a joint of the robot."""
    nodes = """
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    share = get_package_share_directory("m")
    return LaunchDescription([
        Node(package="gazebo_ros", executable="spawn_entity.py"),
        Node(package="tf2_ros", executable="static_transform_publisher",
             arguments=["--frame-id", "base", "--child-frame-id", "hand"]),
        Node(package="warehouse_ros_mongo", executable="mongo_wrapper_ros.py",
             parameters=[{"database_path": share + "/default_warehouse_mongo_db"}])])
"""
    robot = _XACRO.replace("${pi/2}", "1")
    own = package(
        "m", "launch", "urdf", files={"launch/m.launch.py": nodes, "urdf/arm.urdf": robot}
    )
    needed = "".join(
        f"<depend>{it}</depend>" for it in ("gazebo_ros_pkgs", "tf2_ros", "warehouse_ros_mongo")
    )
    own["m/package.xml"] = own["m/package.xml"].replace("<export>", f"{needed}<export>")
    assert [it.message for it in read_agreement(workspace(own).workspace).mismatches] == []


def test_a_file_of_macros_is_the_robot_only_if_there_is_no_other() -> None:
    """A robot whose links depend on what is not submitted comes before it."""
    start = '<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    macros = f'{start}<xacro:macro name="m"><link name="l"/></xacro:macro></robot>'
    robot = f'{start}<xacro:include filename="$(find other)/arm.xacro"/></robot>'
    found = workspace(package("arm", files={"a/macros.xacro": macros, "b/robot.xacro": robot}))
    assert found.path == "arm/b/robot.xacro"
    assert [it.is_part for it in found.other_candidates] == [True]


_LOADS = _RUNS_XACRO.replace('Command(["xacro ", urdf])', "open(urdf).read()").replace(
    "from launch.substitutions import Command\n", ""
)


@pytest.mark.parametrize(
    ("launch", "expected"),
    [
        ("", [("warning", "URDF014", "arm.urdf")]),
        (_RUNS_XACRO, []),
        (_LOADS, [("error", "URDF022", "arm.urdf"), ("warning", "URDF014", "arm.urdf")]),
    ],
    ids=["nothing loads it", "xacro runs", "it is loaded"],
)
def test_xacro_under_the_name_of_a_urdf(
    launch: str, expected: list[tuple[str, str, str]], tmp_path: Path
) -> None:
    """It is a warning unless a launch file loads it as it stands, and a part without links is nothing."""
    declared = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"'
    files = {
        "urdf/arm.urdf": f'{declared} name="arm"><xacro:include filename="made.xacro"/><xacro:arm/></robot>',
        "urdf/more.urdf": f"{declared}></robot>",
        "urdf/made.xacro": f'{declared}><xacro:macro name="arm"><link name="base"/></xacro:macro></robot>',
        **({"launch/arm.launch.py": launch} if launch else {}),
    }
    for path, text in package("arm", "urdf", "launch", files=files).items():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(text, encoding="utf-8")
    robots = json.loads(run(("inspect", tmp_path, "--format", "json")).stdout)["robots"]
    said = []
    for robot in robots:
        for problem in robot["problems"]:
            name = problem["location"]["path"].rpartition("/")[2]
            said.append((problem["severity"], problem["code"], name))
    assert sorted(said) == expected
