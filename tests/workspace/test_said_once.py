"""One mistake is one finding, and what is not understood is counted."""

import json
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from tests.command_line import run

_MANIFEST = """\
<package format="3"><name>{name}</name><version>0.1.0</version><description>A.</description>
<maintainer email="a@example.com">A</maintainer><license>MIT</license>{depends}
<export><build_type>ament_{build}</build_type></export></package>
"""
_CMAKE = """\
cmake_minimum_required(VERSION 3.8)
project({name})
find_package(ament_cmake REQUIRED)
install(DIRECTORY launch urdf meshes DESTINATION share/${{PROJECT_NAME}})
ament_package()
"""
_LAUNCH = """\
import os
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        {actions}
    ])
"""


def package(name: str, actions: str = "", depends: str = "") -> dict[str, str]:
    """Return the files of a package with a launch file."""
    return {
        f"{name}/package.xml": _MANIFEST.format(name=name, depends=depends, build="cmake"),
        f"{name}/CMakeLists.txt": _CMAKE.format(name=name),
        f"{name}/launch/a.launch.py": _LAUNCH.format(actions=actions),
        f"{name}/urdf/.keep": "",
        f"{name}/meshes/other.obj": "v 0 0 0\n",
    }


def inspected(folder: Path, files: Mapping[str, str]) -> Any:
    """Return what `grader inspect` says of files as JSON."""
    for path, text in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text, encoding="utf-8")
    return json.loads(run(("inspect", folder, "--format", "json")).stdout)


def places_of(inspection: Any, code: str) -> list[tuple[str, int]]:
    """Return the places of all problems with a code."""
    problems = [*inspection["problems"]]
    for robot in inspection["robots"]:
        problems += robot["problems"]
    places = [each["location"] for each in problems if each["code"] == code]
    return [(place["path"], place["line"]) for place in places]


def test_the_dependencies_that_a_package_lacks_are_one_finding(tmp_path: Path) -> None:
    """At the first use, with the tags to add; each package has its own, and a misspelt one stays apart."""
    nodes = "Node(package='rviz2', executable='rviz2'),\n        Node(package='joy', executable='joy_node'),"
    depends = "<exec_depend>joyy</exec_depend>"
    files = {**package("a_bot", nodes), **package("b_bot", nodes, depends)}
    inspection = inspected(tmp_path, files)
    launch = "launch/a.launch.py"
    assert places_of(inspection, "REF008") == [
        (f"a_bot/{launch}", 8),
        (f"b_bot/{launch}", 8),
        (f"b_bot/{launch}", 9),
    ]
    messages = [each["message"] for each in inspection["problems"] if each["code"] == "REF008"]
    assert messages[0] == (
        "package.xml of 'a_bot' does not declare 'rviz2' and 'joy', which its files use: "
        "add <exec_depend>rviz2</exec_depend> <exec_depend>joy</exec_depend>"
    )
    assert messages[1].endswith("'rviz2', which is used here: add <exec_depend>rviz2</exec_depend>")
    assert messages[2].endswith(
        "'joy', which is used here; it declares 'joyy': did you mean 'joy'?"
    )


def test_an_environment_variable_is_said_once(tmp_path: Path) -> None:
    """With the number of other launch files that need it, but for those that ask whether it is set."""
    files: dict[str, str] = {}
    for name in ("a_bot", "b_bot", "c_bot", "d_bot"):
        files |= package(name, "Node(package=os.environ['MY_BOT'], executable='go'),")
    handled = (
        "Node(package=os.environ['MY_BOT'] if 'MY_BOT' in os.environ else 'x', executable='go'),"
    )
    files["d_bot/launch/a.launch.py"] = _LAUNCH.format(actions=handled)
    inspection = inspected(tmp_path, files)
    assert places_of(inspection, "REF022") == [("a_bot/launch/a.launch.py", 8)]
    [message] = [each["message"] for each in inspection["problems"] if each["code"] == "REF022"]
    assert message.endswith("give it a default; 2 other launch files need it too")


def test_a_missing_mesh_is_one_finding(tmp_path: Path) -> None:
    """It is a file that a build does not install; a mesh at a relative path is one that RViz does not find."""
    meshes = [
        f'<link name="l{number}"><visual><geometry><mesh filename="{name}"/></geometry></visual></link>'
        for number, name in enumerate(("package://a_bot/meshes/othr.obj", "meshes/other.obj"))
    ]
    robot = "\n".join(('<robot name="a">', *meshes, "</robot>"))
    inspection = inspected(tmp_path, {**package("a_bot"), "a_bot/urdf/a.urdf": robot})
    assert places_of(inspection, "REF001") + places_of(inspection, "REF009") == [
        ("a_bot/urdf/a.urdf", 2)
    ]
    assert places_of(inspection, "RVZ004") == [("a_bot/urdf/a.urdf", 3)]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('<child link="b"/>', '<child link="b/>'),
        ("<origin xyz", "<orgin xyz"),
        ("</visual>", "</visua>"),
        ('type="fixed"', 'type="fixd"'),
    ],
)
def test_what_is_assumed_of_a_mistake_is_no_other_finding(
    old: str, new: str, tmp_path: Path
) -> None:
    """A broken tag or a misspelt word is one error, without how the rest is read; an editor has both."""
    robot = (
        '<robot name="a">\n<link name="a">\n<visual>\n<origin xyz="0 0 1"/>\n'
        '<geometry><sphere radius="1"/></geometry>\n</visual>\n</link>\n<link name="b"/>\n'
        '<joint name="j" type="fixed">\n<parent link="a"/>\n<child link="b"/>\n</joint>\n</robot>\n'
    )
    assert robot.count(old) == 1
    inspection = inspected(tmp_path, {"a.urdf": robot.replace(old, new)})
    [problem] = inspection["robots"][0]["problems"]
    assert problem["code"] != "URDF015"
    line = robot.partition(old)[0].count("\n") + 1
    assert abs(problem["location"]["line"] - line) <= 1


def test_an_archive_beside_its_folder_is_read_once(tmp_path: Path) -> None:
    """A robot in it that is not beside it is read, and so is one that differs."""
    robot = '<robot name="a"><link name="b"/><link name="b"/></robot>'
    inspected(tmp_path / "ws", {"bot/a.urdf": robot})
    shutil.make_archive(str(tmp_path / "ws" / "bot"), "zip", tmp_path / "ws", "bot")
    inspection = inspected(tmp_path / "ws", {})
    assert places_of(inspection, "URDF031") == [("bot/a.urdf", 1)]
    other = inspected(tmp_path / "ws", {"bot/a.urdf": f"<!-- newer -->\n{robot}"})
    assert sorted(places_of(other, "URDF031")) == [("bot.zip/bot/a.urdf", 1), ("bot/a.urdf", 2)]


def test_the_calls_that_are_not_known_are_counted(tmp_path: Path) -> None:
    """With their files, most first; comments and definitions are no calls, and a workspace without any is not praised."""
    source = """\
// create_publisher<Odd>("odd", 1);
void make(rclcpp::Node & node) {
  node.create_publisher<std_msgs::msg::String>("a", 1);
  /* node.create_service<X>("x") */ node.declare_parameter("speed", 1.0);
}
"""
    files = {
        **package("a_bot"),
        "a_bot/src/driver.cpp": source,
        "a_bot/a_bot/helper.py": "def create_client(x):  # create_client(1)\n    x.create_client(T, 'a')\n",
    }
    read = inspected(tmp_path / "ws", files)["read"]
    assert (read["calls"], read["all_calls"]) == (0, 3)
    assert [(row["path"], row["calls"]) for row in read["unread_files"]] == [
        ("a_bot/src/driver.cpp", 2),
        ("a_bot/a_bot/helper.py", 1),
    ]
    text = " ".join(run(("inspect", tmp_path / "ws")).stdout.decode().split())
    assert "ws: no problems in what was read" in text
    assert "0 of 3 calls" in text
    assert "calls in a_bot/src/driver.cpp (2) and a_bot/a_bot/helper.py (1)" in text
    (tmp_path / "empty").mkdir()
    (tmp_path / "empty/package.xml").write_text(
        _MANIFEST.format(name="empty", depends="", build="cmake"), encoding="utf-8"
    )
    shown = run(("inspect", tmp_path / "empty")).stdout.decode()
    assert "the names agree" not in shown


_CART = """\
<robot name="cart">
<link name="base_link"><visual><geometry><box size="0.4 0.3 0.1"/></geometry></visual></link>
<link name="left"><visual><geometry><cylinder radius="{radius}" length="0.04"/></geometry></visual></link>
<link name="right"><visual><geometry><cylinder radius="0.1" length="0.04"/></geometry></visual></link>
<link name="caster"><visual><geometry><sphere radius="0.04"/></geometry></visual></link>
<joint name="left_joint" type="continuous"><parent link="base_link"/><child link="left"/>
<origin xyz="-0.1 0.2 {left}" rpy="-1.5708 0 0"/><axis xyz="0 0 1"/></joint>
<joint name="right_joint" type="continuous"><parent link="base_link"/><child link="right"/>
<origin xyz="-0.1 -0.2 0" rpy="-1.5708 0 0"/><axis xyz="0 0 1"/></joint>
<joint name="caster_joint" type="fixed"><parent link="base_link"/><child link="caster"/>
<origin xyz="0.15 0 {caster}"/></joint>
<gazebo><plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
<left_joint>left_joint</left_joint><right_joint>right_joint</right_joint>
</plugin></gazebo>
</robot>
"""


@pytest.mark.parametrize(
    ("radius", "left", "caster", "line", "text"),
    [
        (0.1, 0.0, -0.06, None, ""),
        (0.09, -0.01, -0.06, 3, "when its wheels turn forward, it drives a circle"),
        (0.1, 0.0, -0.02, 11, "on level ground, it leans by 9.27 degrees"),
        (0.1, 0.0, -0.2, 11, "on level ground, it leans by "),
    ],
)
def test_a_robot_that_leans_is_a_warning(
    radius: float, left: float, caster: float, line: int | None, text: str, tmp_path: Path
) -> None:
    """So is one that its wheels drive elsewhere; of a correct one a line says that it drives straight ahead."""
    robot = _CART.format(radius=radius, left=left, caster=caster)
    inspection = inspected(tmp_path, {"cart.urdf": robot})
    [shown] = inspection["robots"]
    assert shown["verdict"] == "clean"
    problems = [each for each in shown["problems"] if each["rule"] == "robot-stands"]
    if line is None:
        assert problems == []
        assert "it drives straight ahead" in run(("inspect", tmp_path)).stdout.decode()
    else:
        [problem] = problems
        assert (problem["severity"], problem["location"]["line"]) == ("warning", line)
        assert problem["message"].startswith(text)
        assert run(("inspect", tmp_path)).returncode == 0


_SETUP = """\
from glob import glob
from setuptools import setup
setup(name='arm', version='0.1.0', packages=[], data_files=[
    ('share/ament_index/resource_index/packages', ['resource/arm']),
    ('share/arm', ['package.xml']),
    ('share/arm/launch', glob('launch/*')),
    ('share/arm/urdf', glob('PATTERN')),
])
"""


@pytest.mark.parametrize(
    ("pattern", "file", "codes"),
    [
        pytest.param("urdf/*.xacro", "urdf/arm.urdf", ["REF001"], id="of the file"),
        pytest.param("meshes/*.stl", "urdf/arm.urdf", ["PKG013", "REF001"], id="of other files"),
        pytest.param("urdf/*.xacro", "launch/a.launch.py", ["PKG013"], id="of no file"),
    ],
)
def test_a_pattern_without_a_match_is_said_with_the_file(
    pattern: str, file: str, codes: list[str], tmp_path: Path
) -> None:
    """A file that a build does not install for its pattern is one finding, which names that."""
    action = "Node(package='rviz2', executable='rviz2', arguments=[share('arm') + '/FILE']),"
    launch = _LAUNCH.format(actions=action.replace("FILE", file))
    importing = "from ament_index_python.packages import get_package_share_directory as share\n"
    manifest = _MANIFEST.format(name="arm", depends="<depend>rviz2</depend>", build="python")
    files = {
        "arm/package.xml": manifest,
        "arm/setup.py": _SETUP.replace("PATTERN", pattern),
        "arm/setup.cfg": "[install]\ninstall_scripts=$base/lib/arm\n",
        "arm/resource/arm": "",
        "arm/launch/a.launch.py": importing + launch,
        "arm/urdf/arm.urdf": "<robot name='arm'><link name='base'/></robot>",
        "arm/meshes/.keep": "",
    }
    problems = inspected(tmp_path, files)["problems"]
    said = {each["code"]: each["message"] for each in problems if each["code"] in codes}
    wanted = ("PKG013", "REF001")
    assert sorted(each["code"] for each in problems if each["code"] in wanted) == codes
    if codes == ["REF001"]:
        expected = "the pattern 'urdf/*.xacro' in setup.py matches no file; there is urdf/arm.urdf"
        assert said["REF001"].endswith(f": {expected}")
