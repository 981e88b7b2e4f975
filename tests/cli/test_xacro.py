"""`grader grade` of xacro: what xacro refuses, what cannot be determined, and the files that it reads."""

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from tests.command_line import run
from tests.samples import ROOT

PACKAGE = ROOT / "rubrics/lab6/my_robot"
GREEN = "0 0.6 0 1"
NAMESPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
ROBOT = (PACKAGE / "urdf/my_robot.urdf").read_text().replace("<robot ", f"<robot {NAMESPACE} ")


def graded(path: Path, *more: str) -> tuple[int, dict[str, Any]]:
    """Return the exit code and the report of a submission."""
    done = run(("grade", path, "--format", "json", *more))
    return done.returncode, json.loads(done.stdout)


def statuses(report: dict[str, Any]) -> dict[str, str]:
    """Return the status of each criterion."""
    return {result["id"]: result["status"] for result in report["results"]}


@pytest.mark.parametrize(
    "added",
    [
        '<xacro:property name="d" value="$(arg nope)" lazy_eval="false"/>',
        '<xacro:property name="d" value="${xacro.arg(\'nope\')}" lazy_eval="false"/>',
        '<xacro:macro name="m" params="p"/><xacro:m p="$(arg nope)"/>',
        '<xacro:macro name="m" params="p:=$(arg nope)"/><xacro:m/>',
    ],
)
def test_a_value_that_xacro_may_refuse_is_undecided_even_if_nothing_uses_it(added: str, tmp_path: Path) -> None:
    """xacro evaluates it, so that the robot may not load: `urdf-loads` needs manual grading."""
    path = tmp_path / "my_robot.urdf.xacro"
    path.write_text(ROBOT.replace("</robot>", f"{added}</robot>"))
    code, report = graded(path)
    assert (code, report["score"], statuses(report)["urdf-loads"]) == (1, 67, "pending")
    assert graded(path, "--arg", "nope=1")[0] == 0


@pytest.mark.parametrize("expression", ["range(2**70)[1]", "len(math.keys())", "len(math)"])
def test_what_xacro_accepts_is_not_refused(expression: str, tmp_path: Path) -> None:
    """An expression that is valid for xacro and not supported is undecided."""
    path = tmp_path / "my_robot.urdf.xacro"
    path.write_text(ROBOT.replace("</robot>", f'<a b="${{{expression}}}"/></robot>'))
    code, report = graded(path)
    assert (code, report["score"], statuses(report)["urdf-loads"]) == (1, 67, "pending")


def test_a_macro_may_have_a_parameter_twice(tmp_path: Path) -> None:
    """The last default counts, as in xacro."""
    macro = f'<xacro:macro name="m" params="c:=1 c:=\'{GREEN}\'"><material name="green"><color rgba="${{c}}"/></material></xacro:macro>'
    before, _, after = ROBOT.partition('<material name="green">')
    path = tmp_path / "my_robot.urdf.xacro"
    path.write_text(f"{before}{macro}<xacro:m/>{after.partition('</material>')[2]}")
    assert graded(path)[1]["score"] == 70


# --- What the launch file gives xacro ---------------------------------------------------------------------------------

LAUNCH = """import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import Command, LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.substitutions import ExecutableInPackage


def generate_launch_description():
    share = get_package_share_directory('my_robot')
    path = os.path.join(share, 'my_robot.urdf.xacro')
    return LaunchDescription([
        DeclareLaunchArgument('color', default_value='0.6'),
        Node(package='robot_state_publisher', executable='robot_state_publisher',
             parameters=[{'robot_description': Command([COMMAND])}]),
        Node(package='joint_state_publisher_gui', executable='joint_state_publisher_gui'),
        Node(package='rviz2', executable='rviz2', arguments=['-d', os.path.join(share, 'my_robot.rviz')]),
    ])
"""
CMAKE = """cmake_minimum_required(VERSION 3.8)
project(my_robot)
find_package(ament_cmake REQUIRED)
install(DIRECTORY urdf/ rviz/ DESTINATION share/${PROJECT_NAME})
install(DIRECTORY launch config DESTINATION share/${PROJECT_NAME})
ament_package()
"""


def package_with(folder: Path, command: str, green: str, before: str = "") -> Path:
    """Return the reference package with xacro whose green is an expression, and a launch file that runs a command on it."""
    package = folder / "my_robot"
    shutil.copytree(PACKAGE, package)
    (package / "urdf/my_robot.urdf").unlink()
    text = ROBOT.replace(GREEN, green).replace("<material", f"{before}<material", 1)
    (package / "urdf/my_robot.urdf.xacro").write_text(text)
    (package / "launch/my_robot_rviz.launch.py").write_text(LAUNCH.replace("COMMAND", command))
    (package / "config").mkdir()
    (package / "config/params.yaml").write_text(f"green: {GREEN}\n")
    return package


@pytest.mark.parametrize("build", ["ament_python", "ament_cmake"])
@pytest.mark.parametrize("target", ["config", "parameters"])
def test_a_parameter_file_in_the_share_folder(build: str, target: str, tmp_path: Path) -> None:
    """The launch file gives xacro the path at which a build installs the file: it is read from where it is installed from."""
    command = f"'xacro ', path, ' params:=', share + '/{target}/params.yaml'"
    arg = '<xacro:arg name="params" default=""/><xacro:property name="p" value="${xacro.load_yaml(xacro.arg(\'params\'))}"/>'
    package = package_with(tmp_path, command, "${p['green']}", arg)
    setup = package / "setup.py"
    if build == "ament_cmake":
        setup.unlink()
        (package / "CMakeLists.txt").write_text(
            CMAKE.replace("launch config", "launch").replace(
                "ament_package()",
                f"install(DIRECTORY config/ DESTINATION share/${{PROJECT_NAME}}/{target})\nament_package()",
            )
        )
        manifest = package / "package.xml"
        manifest.write_text(manifest.read_text().replace("ament_python", "ament_cmake"))
    else:
        files = f"    (os.path.join('share', package_name, '{target}'), ['config/params.yaml']),\n    ],\n    install_requires"
        setup.write_text(setup.read_text().replace("],\n    install_requires", files))
    report = graded(tmp_path)[1]
    assert {name: statuses(report)[name] for name in ("urdf-loads", "base-green")} == dict.fromkeys(
        ("urdf-loads", "base-green"), "passed"
    )
    assert [problem for problem in report["problems"] if problem["code"].startswith("XACRO")] == []


def test_a_parameter_file_of_another_package_is_undecided(tmp_path: Path) -> None:
    """The share folder of a package that was not submitted is outside of the submission."""
    command = "'xacro ', path, ' params:=', get_package_share_directory('other') + '/config/params.yaml'"
    arg = '<xacro:arg name="params" default=""/><xacro:property name="p" value="${xacro.load_yaml(xacro.arg(\'params\'))}"/>'
    package_with(tmp_path, command, "${p['green']}", arg)
    report = graded(tmp_path)[1]
    assert statuses(report)["base-green"] == "pending"
    assert "the package other is not part of the submission" in {problem["message"] for problem in report["problems"]}


@pytest.mark.parametrize(
    "program", ["ExecutableInPackage('xacro', 'xacro')", "ExecutableInPackage(executable='xacro', package='xacro')"]
)
def test_a_command_with_executable_in_package(program: str, tmp_path: Path) -> None:
    """The xacro of the package xacro is run with the arguments of the command."""
    package_with(
        tmp_path,
        f"{program}, ' ', path, ' color:=', LaunchConfiguration('color')",
        "0 $(arg color) 0 1",
        '<xacro:arg name="color" default="1"/>',
    )
    found = statuses(graded(tmp_path)[1])
    assert [found[name] for name in ("base-green", "launch-finds-files", "launch-nodes")] == ["passed"] * 3
