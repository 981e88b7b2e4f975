"""`grader grade` of xacro: what xacro refuses, what cannot be determined, and the files that it reads."""

import json
import shutil
from hashlib import sha256
from pathlib import Path
from typing import Any

import pytest

from tests.command_line import run, run_with_input
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


WORK = '<note a="${[i * j for i in range(100) for j in range(100)][0]}"/>'  # takes some 150,000 parts of the budget
WRONG = ROBOT.replace("0.15 0 0.225", "0.15 0 0.325")


def test_a_file_that_takes_too_much_work_is_undetermined(tmp_path: Path) -> None:
    """What was expanded before the budget is spent is graded; the rest is named, and needs manual grading."""
    (tmp_path / "my_robot.xacro").write_text(ROBOT.replace("</robot>", WORK * 20 + "</robot>"))
    code, report = graded(tmp_path / "my_robot.xacro")
    assert code == 1
    (problem,) = report["problems"]
    assert problem["code"] == "XACRO006"
    assert problem["message"] == "reading this takes more work than one submission may use (500,000 parts)"
    assert problem["location"]["line"] == ROBOT.count("\n")  # where it stopped
    found = statuses(report)
    assert (found["urdf-loads"], found["base-box"], found["lidar-on-top"]) == ("pending", "passed", "passed")
    assert "failed" not in found.values()


CUTS = {
    "before the origin of a joint": ('<child link="base_link"/>', '<child link="base_link"/>' + WORK * 20),
    "in a link": ('<link name="lidar">', '<link name="lidar">' + WORK * 20),
    "before the child of a joint": ('<child link="left_wheel"/>', WORK * 20 + '<child link="left_wheel"/>'),
    "in a visual": ("<visual>", "<visual>" + WORK * 20),
    "in a macro": (
        '<link name="lidar">',
        '<link name="lidar"><xacro:macro name="m">' + WORK * 20 + "</xacro:macro><xacro:m/>",
    ),
}


@pytest.mark.parametrize("cut", CUTS)
def test_an_element_in_which_the_budget_is_spent_is_open(cut: str, tmp_path: Path) -> None:
    """What it may still contain needs manual grading: no criterion fails for what was not expanded."""
    old, new = CUTS[cut]
    assert old in ROBOT
    (tmp_path / "my_robot.xacro").write_text(ROBOT.replace(old, new, 1))
    code, report = graded(tmp_path / "my_robot.xacro")
    assert code == 1
    assert set(statuses(report).values()) <= {"passed", "pending"}
    assert [problem["code"] for problem in report["problems"]] == ["XACRO006"]


def test_a_single_file_has_the_budget_of_a_folder(tmp_path: Path) -> None:
    """Reading what is around a file does not halve it."""
    (tmp_path / "part.xacro").write_text(f"<robot {NAMESPACE}/>")
    included = '<xacro:include filename="part.xacro"/>' + WORK * 2 + "</robot>"
    (tmp_path / "my_robot.xacro").write_text(ROBOT.replace("</robot>", included))
    assert graded(tmp_path / "my_robot.xacro")[1]["score"] == graded(tmp_path)[1]["score"] == 70


@pytest.mark.parametrize("factor", [0, 1, 20])
def test_hints_are_searched_if_reading_takes_little_work(factor: int, tmp_path: Path) -> None:
    """Above a tenth of the budget there are none, and the report says so."""
    (tmp_path / "my_robot.xacro").write_text(WRONG.replace("</robot>", WORK * factor + "</robot>"))
    report = graded(tmp_path / "my_robot.xacro")[1]
    lost = [result for result in report["results"] if result["status"] == "failed"]
    assert [result["id"] for result in lost] == ["lidar-frame", "lidar-on-top"]
    assert any(result["hints"] for result in lost) == (factor == 0)
    said = [note for note in report["notes"] if "no hints were searched" in note]
    assert len(said) == (factor > 0)


@pytest.mark.parametrize(
    "expression",
    ["lambda: 1", "python.set([1])", "python.zip([1], [2])", "1 | 2", "max(*[1, 2])", "'a'.zfill(3)"],
)
def test_what_no_public_robot_uses_is_undetermined(expression: str, tmp_path: Path) -> None:
    """It needs manual grading with a message that says so, and everything else is graded."""
    (tmp_path / "my_robot.xacro").write_text(ROBOT.replace("</robot>", f'<note a="${{{expression}}}"/></robot>'))
    report = graded(tmp_path / "my_robot.xacro")[1]
    assert [problem["code"] for problem in report["problems"]] == ["XACRO006"]
    assert "not supported" in report["problems"][0]["message"]
    assert set(statuses(report).values()) == {"passed", "pending"}


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


def test_a_parameter_file_that_is_not_installed_is_undecided(tmp_path: Path) -> None:
    """Without an entry of data_files the build may not install it, so what ROS 2 makes of the robot needs manual grading."""
    command = "'xacro ', path, ' params:=', share + '/config/params.yaml'"
    arg = '<xacro:arg name="params" default=""/><xacro:property name="p" value="${xacro.load_yaml(xacro.arg(\'params\'))}"/>'
    package_with(tmp_path, command, "${p['green']}", arg)
    code, report = graded(tmp_path)
    assert (code, statuses(report)["base-green"]) == (1, "pending")


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


# --- A single file that includes its neighbours -----------------------------------------------------------------------

MATERIALS = '<material name="green"><color rgba="0 0.6 0 1"/></material>'
PART = f"<robot {NAMESPACE}>{MATERIALS}</robot>"
BEFORE, _, AFTER = ROBOT.partition('<material name="green">')
AFTER = AFTER.partition("</material>")[2]


def including(folder: Path, text: str, *, name: str = "urdf/my_robot.urdf.xacro") -> Path:
    """Write the reference as xacro with a text in place of its green, and a macro file, parameters and a package beside it."""
    path = folder / name
    path.parent.mkdir(parents=True)
    path.write_text(f"{BEFORE}{text}{AFTER}")
    (path.parent / "materials.xacro").write_text(PART)
    (folder / "config").mkdir()
    (folder / "config/params.yaml").write_text(f"green: {GREEN}\n")
    shutil.copy(PACKAGE / "package.xml", folder)
    return path


INCLUDE = '<xacro:include filename="materials.xacro"/>'
YAML = "<xacro:property name=\"p\" value=\"${{xacro.load_yaml('{}')['green']}}\"/>" + MATERIALS.replace(GREEN, "${{p}}")


@pytest.mark.parametrize(
    ("text", "read"),
    [
        (INCLUDE, "package.xml and urdf/materials.xacro"),
        ('<xacro:include filename="$(find my_robot)/urdf/materials.xacro"/>', "package.xml and urdf/materials.xacro"),
        (YAML.format("../config/params.yaml"), "config/params.yaml and package.xml"),
        (YAML.format("$(find my_robot)/config/params.yaml"), "config/params.yaml and package.xml"),
    ],
)
def test_a_single_file_reads_the_package_around_it(text: str, read: str, tmp_path: Path) -> None:
    """Includes, $(find) and load_yaml are read from the package; one note says which files; `inspect` does the same."""
    path = including(tmp_path / "my_robot", text)
    code, report = graded(path)
    assert (code, report["score"], report["max_score"]) == (0, 70, 70)
    assert report["submission"]["path"] == "urdf/my_robot.urdf.xacro"
    note = f"{read} were read besides urdf/my_robot.urdf.xacro"
    assert [found for found in report["notes"] if "besides" in found] == [note]
    done = run(("inspect", path))
    assert (done.returncode, done.stderr.decode().count(f"grader: {note}\n")) == (0, 1)


def test_a_single_file_without_a_package_reads_its_folder(tmp_path: Path) -> None:
    """The folder of the file is all that is read; a file that is not in it needs manual grading."""
    path = including(tmp_path / "my_robot", INCLUDE, name="my_robot.urdf.xacro")
    (tmp_path / "my_robot/package.xml").unlink()
    assert graded(path)[1]["score"] == 70
    (tmp_path / "my_robot/materials.xacro").rename(tmp_path / "materials.xacro")
    code, report = graded(path)
    assert (code, statuses(report)["urdf-loads"]) == (1, "pending")


def test_what_is_read_besides_counts_in_the_sha256(tmp_path: Path) -> None:
    """Another content of an included file gives another hash, another file beside it does not."""
    path = including(tmp_path / "my_robot", INCLUDE)
    first = graded(path)[1]["submission"]["sha256"]
    (path.parent / "other.xacro").write_text(PART)
    assert graded(path)[1]["submission"]["sha256"] == first
    (path.parent / "materials.xacro").write_text(PART.replace("/>", " />"))
    assert graded(path)[1]["submission"]["sha256"] != first


@pytest.mark.parametrize("text", [MATERIALS, MATERIALS.replace(GREEN, "0 ${0.6} 0 1")])
def test_a_single_file_without_includes_is_as_before(text: str, tmp_path: Path) -> None:
    """Its report is the same wherever it is, and its hash is that of its bytes; standard input reads no file."""
    path = including(tmp_path / "my_robot", text)
    alone = tmp_path / "my_robot.urdf.xacro"
    shutil.copy(path, alone)
    reports = [run(("grade", it, "--format", "json")).stdout for it in (path, alone)]
    assert reports[0] == reports[1]
    assert json.loads(reports[0])["submission"]["sha256"] == sha256(path.read_bytes()).hexdigest()


def test_standard_input_includes_nothing(tmp_path: Path) -> None:
    """A URDF on standard input has no neighbours."""
    path = including(tmp_path / "my_robot", INCLUDE)
    done = run_with_input(("grade", "-", "--format", "json"), path.read_bytes(), folder=path.parent)
    assert statuses(json.loads(done.stdout))["base-green"] != "passed"


def test_a_single_file_reads_nothing_outside_of_its_package(tmp_path: Path) -> None:
    """A path out of it, a symlink out of it and a file that is too large need manual grading."""
    outside = tmp_path / "materials.xacro"
    outside.write_text(PART)
    for number, include in enumerate(("../../materials.xacro", str(outside), "link.xacro", "large.xacro")):
        path = including(tmp_path / str(number), f'<xacro:include filename="{include}"/>')
        (path.parent / "link.xacro").symlink_to(outside)
        (path.parent / "large.xacro").write_text(PART + " " * 1024 * 1024)
        code, report = graded(path)
        assert (code, statuses(report)["urdf-loads"], statuses(report)["base-green"]) == (1, "pending", "pending")


def test_a_file_that_the_package_does_not_have(tmp_path: Path) -> None:
    """A file that the package lacks is missing, as for xacro."""
    path = including(tmp_path / "my_robot", INCLUDE.replace("materials", "material"))
    code, report = graded(path)
    message = "there is no file urdf/material.xacro in the submission; xacro stops here, and ROS 2 gets no robot"
    assert (code, statuses(report)["urdf-loads"]) == (1, "failed")
    assert message in {problem["message"] for problem in report["problems"]}


@pytest.mark.parametrize("include", [INCLUDE, INCLUDE.replace("materials", "mat*")])
def test_a_single_file_in_a_class_has_no_neighbours(include: str, tmp_path: Path) -> None:
    """The file of another student completes none; which files a pattern names is not known."""
    folder = tmp_path / "class"
    path = including(tmp_path / "my_robot", include)
    folder.mkdir()
    shutil.copy(path, folder / "ash.urdf.xacro")
    shutil.copy(path.parent / "materials.xacro", folder)
    reports = tmp_path / "reports"
    more = ("--gradebook", tmp_path / "g.db", "--reports", reports, "--report-format", "json", "--part", "task1")
    assert run(("batch", folder, *more)).returncode == 0
    found = statuses(json.loads((reports / "ash.json").read_text()))
    assert (found["urdf-loads"], found["base-green"]) == ("pending", "pending")


def test_a_fix_of_an_included_file(tmp_path: Path) -> None:
    """It is written into a folder under its path, never into a file of the student or in place of the graded file."""
    path = including(tmp_path / "my_robot", INCLUDE)
    part = path.parent / "materials.xacro"
    part.write_text(PART.replace(GREEN, "0 0.9 0 1"))
    before = {file: file.read_bytes() for file in sorted(tmp_path.rglob("*")) if file.is_file()}
    for target, message in (
        (
            tmp_path / "fixed.urdf.xacro",
            b"the edits change urdf/materials.xacro, not urdf/my_robot.urdf.xacro: name a folder",
        ),
        (tmp_path / "my_robot", b"also reads or writes it; name another file for --fix"),
    ):
        done = run(("grade", path, "--fix", target), COLUMNS="1000")
        assert (done.returncode, message in done.stderr) == (2, True), done.stderr
        assert {file: file.read_bytes() for file in sorted(tmp_path.rglob("*")) if file.is_file()} == before
    (tmp_path / "fixed").mkdir()
    run(("grade", path, "--fix", tmp_path / "fixed"))
    fixed = tmp_path / "fixed/urdf"
    assert [file.name for file in fixed.iterdir()] == ["materials.xacro"]
    assert fixed.joinpath("materials.xacro").read_text() == PART
