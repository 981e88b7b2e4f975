"""`grader grade` of launch files with event handlers, with files of other packages, and in the Python of ROS 2 Jazzy."""

import json
import shutil
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.command_line import ROOT, run

LAUNCH = "launch/my_robot_rviz.launch.py"
RETURN = "    return LaunchDescription(["
STATES = """        Node(
            package='joint_state_publisher',
            executable='joint_state_publisher',
            condition=UnlessCondition(gui),
        ),
        Node(
            package='joint_state_publisher_gui',
            executable='joint_state_publisher_gui',
            condition=IfCondition(gui),
        ),
"""
INCLUDES = """from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
"""
HANDLERS = """from launch.actions import RegisterEventHandler
from launch.event_handlers import OnExecutionComplete, OnProcessExit, OnProcessIO, OnProcessStart
"""


def graded(folder: Path, *edits: tuple[str, str, str]) -> dict[str, Any]:
    """Return the results of the reference's launch criteria after these edits of its files."""
    package = folder / "my_robot"
    shutil.copytree(ROOT / "rubrics/lab6/my_robot", package)
    for name, old, new in edits:
        path = package / name
        assert old in path.read_text()
        path.write_text(path.read_text().replace(old, new, 1))
    report = json.loads(run(("grade", package, "--format", "json", "--hints", "none")).stdout)
    return {row["id"]: row for row in report["results"]}


def statuses(found: dict[str, Any]) -> tuple[str, str]:
    """Return the statuses of the nodes and of the files of a launch file."""
    return found["launch-nodes"]["status"], found["launch-finds-files"]["status"]


def including(path: str) -> list[tuple[str, str, str]]:
    """Return the edits that include the launch file at a path."""
    action = f"        IncludeLaunchDescription(PythonLaunchDescriptionSource({path})),\n"
    return [(LAUNCH, "import os\n", f"import os\n{INCLUDES}"), (LAUNCH, f"{RETURN}\n", f"{RETURN}\n{action}")]


@pytest.mark.parametrize(
    ("handler", "states"),
    [
        ("OnProcessStart(on_start=lambda event, context: [node])", "passed"),
        ("OnProcessStart(on_start=lambda event, context: Node(package=event.name, executable=event.name))", "pending"),
        ("OnProcessExit(on_exit=lambda event, context: [node] if event.returncode else [])", "pending"),
        ("OnProcessExit(on_exit=stopped)", "pending"),
        ("OnProcessIO(on_stdout=lambda event: print(event.text, undefined))", "failed"),
        ("OnExecutionComplete(on_completion=lambda *_: None)", "failed"),
    ],
)
def test_an_event_handler_is_called_with_unknown_arguments(handler: str, states: str, tmp_path: Path) -> None:
    """No error in a handler is a failure; what it starts counts, if it certainly does."""
    node = "    node = Node(package='joint_state_publisher', executable='joint_state_publisher')\n"
    stopped = "    def stopped(event, context):\n        raise RuntimeError(event.process_name + undefined)\n"
    found = graded(
        tmp_path,
        (LAUNCH, "import os\n", f"import os\n{HANDLERS}"),
        (LAUNCH, STATES, f"        RegisterEventHandler({handler}),\n"),
        (LAUNCH, RETURN, node + stopped + RETURN),
    )
    assert statuses(found) == (states, "passed")
    assert ("does not start joint_state_publisher or" in found["launch-nodes"]["message"]) == (states == "failed")


@pytest.mark.parametrize(("declared", "status"), [("exec_depend", "pending"), ("author", "failed")])
def test_a_package_that_was_not_submitted(declared: str, status: str, tmp_path: Path) -> None:
    """A package whose name is like that of the graded one is another one, if package.xml depends on it."""
    found = graded(
        tmp_path,
        ("package.xml", "  <license>", f"  <{declared}>my_robots</{declared}>\n  <license>"),
        (LAUNCH, "share_directory('my_robot')", "share_directory('my_robots')"),
    )
    assert statuses(found) == ("passed", status)


KNOWN = "get_package_share_directory('ros_gz_sim') + '/launch/gz_sim.launch.py'"


@pytest.mark.parametrize(
    ("path", "expected", "without_states"),
    [
        (KNOWN, ("passed", "passed"), "failed"),
        ("'/opt/ros/humble/share/gazebo_ros/launch/gazebo.launch.py'", ("passed", "passed"), "failed"),
        (KNOWN.replace("gz_sim.l", "new.l"), ("passed", "passed"), "pending"),
        ("'/opt/ros/jazzy/share/a/launch/my_robot_rviz.launch.py'", ("passed", "pending"), "pending"),
        ("get_package_share_directory('nav2_bringup') + '/launch/rviz_launch.py'", ("passed", "pending"), "failed"),
    ],
)
def test_an_included_file_of_another_package(
    path: str, expected: tuple[str, str], without_states: str, tmp_path: Path
) -> None:
    """What a known launch file starts is known; any other one may start every node that is missing."""
    assert statuses(graded(tmp_path / "whole", *including(path))) == expected
    found = graded(tmp_path / "part", *including(path), (LAUNCH, STATES, ""))
    assert statuses(found) == (without_states, expected[1])


def test_a_launch_argument_that_an_included_file_may_declare(tmp_path: Path) -> None:
    """An included file shares its launch arguments, so one that is used after it is no error."""
    used = (LAUNCH, "'-d', ", "'-d', LaunchConfiguration('world'), ")
    assert statuses(graded(tmp_path / "included", *including(KNOWN), used)) == ("passed", "pending")
    assert statuses(graded(tmp_path / "alone", used))[0] == "failed"


@pytest.mark.parametrize(
    "code",
    [
        "type Path = str\n",
        "def first[T](items: list[T]) -> T:\n    return items[0]\n",
        "class Names[T]:\n    pass\n",
        "names = {'a': 1}\nname = f'{names['a']}/{'b'}'\n",
        "name = f'{\n  1 + 1\n}'\n",
    ],
)
@pytest.mark.parametrize("path", [LAUNCH, "setup.py"])
def test_what_python_3_12_added_is_no_failure(path: str, code: str, tmp_path: Path) -> None:
    """ROS 2 Jazzy runs Python 3.12: where an older one grades, a person decides."""
    expected = {"passed"} if sys.version_info >= (3, 12) else {"passed", "pending"}
    found = graded(tmp_path / "right", (path, "import os\n", f"import os\n{code}"))
    assert {row["status"] for name, row in found.items() if name.startswith(("setup", "launch"))} == expected
    names = graded(tmp_path / "wrong", (path, "import os\n", "import os\nname = f'{os.sep}a' b\n"))
    assert "failed" in {row["status"] for name, row in names.items() if name.startswith(("setup", "launch"))}


def test_what_ros2_launch_starts_is_no_failure(tmp_path: Path) -> None:
    """Its XML frontend reads files that end in .launch, and a Node takes any iterable of arguments."""
    shutil.copytree(ROOT / "submissions/lab6/equivalent-launch-file-in-xml/my_robot", tmp_path / "xml")
    (path,) = (tmp_path / "xml").rglob("*.launch.xml")
    path.rename(path.with_suffix(""))
    report = json.loads(run(("grade", tmp_path / "xml", "--format", "json", "--hints", "none")).stdout)
    assert "passed" in [row["status"] for row in report["results"] if row["id"] == "launch-nodes"]
    publisher = "executable='robot_state_publisher',\n"
    keys = (LAUNCH, publisher, f"{publisher}            arguments={{'gui': gui}},\n")
    assert statuses(graded(tmp_path, keys)) == ("passed", "passed")
