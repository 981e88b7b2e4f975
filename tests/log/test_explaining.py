"""What the files of a workspace explain of a log, and that nothing else is said."""

from collections.abc import Mapping

import pytest

from grader.base.errors import NotDecided
from grader.workspace.log import explaining
from tests.log.log_workspaces import LAUNCH as _LAUNCH
from tests.log.log_workspaces import SETUP as _SETUP
from tests.log.log_workspaces import explain as _explained
from tests.log.log_workspaces import make_workspace as _workspace


def _places(files: Mapping[str, str], log: str) -> list[str]:
    """Return the places that explain a log."""
    answers = _explained(files, log)
    return [answer.location.file_and_line for answer in answers if answer.location is not None]


_NOT_FOUND = "package 'NAME' not found, searching: ['/opt/ros/jazzy']"
_NO_TYPE = "[gz-1] [ERROR] [1.5] [controller_manager]: The 'type' param was not defined for 'arm'."
_NO_ACTION = (
    "No action namespace specified for controller `arm` through parameter `m.arm.action_ns`"
)
_NO_MODULE = """Traceback (most recent call last):
  File "/home/ann/ws/install/cell/lib/python3.12/site-packages/cell/mover.py", line 1, in <module>
    from cell.tools.maths import half
ModuleNotFoundError: No module named 'cell.tools'
"""
_TRACE = """[mover-1] Traceback (most recent call last):
[mover-1]   File "/usr/lib/python3.12/runpy.py", line 2, in main
[mover-1]     main()
[mover-1]   File "PATH/cell/mover.py", line 2, in main
[mover-1]     print(missing)
[mover-1] NameError: name 'missing' is not defined
[ERROR] [mover-1]: process has died [pid 7, exit code 1, cmd '/home/ann/mover'].
"""
_SPACED = """[ERROR] [launch]: Caught exception in launch (see debug for traceback): executed command failed. Command: xacro /home/ann/my ws/install/cell/share/cell/urdf/arm.urdf.xacro
Captured stderr output: Usage: xacro [options] <input>

xacro: error: expected exactly one input file as argument
"""
_TYPES = """controller_manager:
  ros__parameters:
    update_rate: 100
arm:
  ros__parameters:
    joints: [a]
"""
_MOVEIT = """moveit_simple_controller_manager:
  controller_names: [arm]
  arm:
    type: FollowJointTrajectory
"""
_NO_TERMINAL = """[turtle-1] Traceback (most recent call last):
[turtle-1]   File "/opt/ros/jazzy/lib/teleop_twist_keyboard/teleop_twist_keyboard", line 33, in <module>
[turtle-1]     main()
[turtle-1] termios.error: (25, 'Inappropriate ioctl for device')
"""
_KEYS = "Node(package='teleop_twist_keyboard', executable='teleop_twist_keyboard'),"
_WITH_ROBOT = {
    "urdf/arm.urdf.xacro": "<robot name='a'/>",
    "setup.py": _SETUP.replace("[('", "[('share/cell/urdf', ['urdf/arm.urdf.xacro']), ('", 1),
}
_MOVER = "Node(package='cell', executable='moover'),"
_STARTED = _MOVER.replace("moover", "mover")
_BRIDGE = "Node(package='joint_state_publisher', executable='joint_state_publisher'),"
_DECLARING = _workspace()["src/cell/package.xml"].replace(
    "<export>", "<exec_depend>joint_state_publisher</exec_depend><export>"
)
_IMPORTING = {
    "cell/mover.py": "import cv_bridge\nimport tf_transformations\n\ndef main(): ...\n",
}
_COMMAND = "Command(['xacro ', 'arm.urdf.xacro']),"
_EMPTY = "[robot_state_publisher-1] Error:   Error document empty.\n"
_PATH_AS_TEXT = (
    "Node(package='robot_state_publisher', executable='robot_state_publisher',"
    " parameters=[{'robot_description': '/a.urdf'}]),"
)
_AMCL = "Node(package='nav2_amcl', executable='amcl', parameters=['src/cell/config/amcl.yaml']),"


_OF_VARIABLE = _LAUNCH.replace("import Command", "import EnvironmentVariable").replace(
    "NODES",
    """Node(package='cell', executable='mover',
             arguments=[EnvironmentVariable(
                 'ROBOT')]),""",
)
_LAUNCH_OF_ROBOT = """
import os
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch_ros.actions import Node
def generate_launch_description():
    path = os.path.join(get_package_share_directory('cell'), 'urdf', 'arm.urdf')
    with open(path) as file:
        text = file.read()
    return LaunchDescription([
        Node(package='robot_state_publisher', executable='robot_state_publisher',
             parameters=[{'robot_description': text}]),
    ])
"""
_NO_FILE = """[ERROR] [launch]: Caught exception in launch (see debug for traceback): Caught multiple exceptions when trying to load file of format [py]:
 - FileNotFoundError: [Errno 2] No such file or directory: '/ws/install/cell/share/cell/urdf/arm.urdf'
"""
_NOT_PARSED = (
    "[robot_state_publisher-1]   what():  Unable to initialize urdf::model from robot description"
)
_OF_NO_TYPE = """<robot name='arm'><link name='a'/><link name='b'/>
<joint name='j' type='fixd'><parent link='a'/><child link='b'/></joint></robot>
"""
_WITH_COLOUR = "<robot name='arm'><material name='m'><color rgba='9 0 0 1'/></material><link name='a'/></robot>"
_STARTED_ROBOT = {
    "launch/c.launch.py": _LAUNCH_OF_ROBOT,
    "setup.py": _SETUP.replace("[('", "[('share/cell/urdf', ['urdf/arm.urdf']), ('", 1),
    "urdf/arm.urdf": _OF_NO_TYPE,
}
_NO_LIBEXEC = (
    "package 'cell' found at '/ws/install/cell', but libexec directory '/ws/install/cell/lib/cell' "
    "does not exist"
)
_CMAKE = """cmake_minimum_required(VERSION 3.8)
project(cell)
find_package(ament_cmake REQUIRED)
add_executable(mover src/mover.cpp)
INSTALL
ament_package()
"""
_OF_CMAKE = {
    "package.xml": _workspace()["src/cell/package.xml"].replace("ament_python", "ament_cmake"),
    "src/mover.cpp": "int main() {}\n",
}
_TARGETS = "install(TARGETS mover DESTINATION lib/${PROJECT_NAME})"


@pytest.mark.parametrize(
    ("files", "log", "place"),
    [
        pytest.param(
            _workspace(), _NOT_FOUND.replace("NAME", "cell"), "src/cell/package.xml:1", id="unbuilt"
        ),
        pytest.param(
            _workspace(nodes=_BRIDGE),
            _NOT_FOUND.replace("NAME", "joint_state_publisher"),
            "src/cell/launch/c.launch.py:8",
            id="not installed",
        ),
        pytest.param(
            _workspace(
                {"package.xml": _DECLARING},
                _MOVER.replace("moover", "mover") + _BRIDGE,
            ),
            _NOT_FOUND.replace("NAME", "joint_state_publisher"),
            "src/cell/launch/c.launch.py:8",
            id="declared and not installed",
        ),
        pytest.param(
            _workspace(nodes=_MOVER),
            "executable 'moover' not found on the libexec directory '/ws/install/cell/lib/cell' ",
            "src/cell/launch/c.launch.py:8",
            id="program",
        ),
        pytest.param(
            _workspace(nodes="Node(package='cell',\n  executable='moover'),"),
            "executable 'moover' not found on the libexec directory '/ws/install/cell/lib/cell' ",
            "src/cell/launch/c.launch.py:9",
            id="program in another line",
        ),
        pytest.param(
            _workspace({"launch/c.launch.py": _OF_VARIABLE}),
            "environment variable 'ROBOT' does not exist",
            "src/cell/launch/c.launch.py:9",
            id="variable in another line",
        ),
        pytest.param(
            _workspace({"launch/c.launch.py": _LAUNCH_OF_ROBOT}),
            _NO_FILE,
            "src/cell/launch/c.launch.py:8",
            id="file of a variable",
        ),
        pytest.param(
            _workspace(_STARTED_ROBOT), _NOT_PARSED, "src/cell/urdf/arm.urdf:2", id="robot"
        ),
        pytest.param(
            _workspace(_IMPORTING),
            "ModuleNotFoundError: No module named 'tf_transformations'",
            "src/cell/cell/mover.py:1",
            id="one of several packages",
        ),
        pytest.param(
            _workspace({"config/c.yaml": _TYPES}), _NO_TYPE, "src/cell/config/c.yaml:2", id="type"
        ),
        pytest.param(
            _workspace({"config/m.yaml": _MOVEIT}),
            _NO_ACTION,
            "src/cell/config/m.yaml:3",
            id="action",
        ),
        pytest.param(
            _workspace({"cell/tools/__init__.py": "", "cell/tools/maths.py": ""}),
            _NO_MODULE,
            "src/cell/setup.py:5",
            id="module",
        ),
        pytest.param(
            _workspace(),
            _TRACE.replace("PATH", "/ws/install/cell/lib/python3.12/site-packages"),
            "src/cell/cell/mover.py:2",
            id="traceback",
        ),
        pytest.param(
            _workspace(),
            _TRACE.replace("PATH", "/home/ann/ws/src/cell"),
            "src/cell/cell/mover.py:2",
            id="traceback of a source",
        ),
        pytest.param(
            _workspace(nodes=_KEYS),
            _NO_TERMINAL,
            "src/cell/launch/c.launch.py:8",
            id="no terminal",
        ),
        pytest.param(
            {**_workspace(), "src/old/cell/package.xml": _workspace()["src/cell/package.xml"]},
            "Duplicate package names not supported:\n- cell:\n  - ws/src/cell\n  - ws/src/old/cell",
            "src/old/cell/package.xml:1",
            id="copies",
        ),
        pytest.param(
            _workspace(_WITH_ROBOT, _COMMAND),
            _SPACED,
            "src/cell/launch/c.launch.py:8",
            id="spaced path",
        ),
        pytest.param(
            _workspace({"setup.cfg": ""}, _STARTED),
            _NO_LIBEXEC,
            "src/cell/launch/c.launch.py:8",
            id="setup.cfg",
        ),
        pytest.param(
            _workspace({**_OF_CMAKE, "CMakeLists.txt": _CMAKE.replace("INSTALL", "")}, _STARTED),
            _NO_LIBEXEC,
            "src/cell/launch/c.launch.py:8",
            id="install",
        ),
        pytest.param(
            _workspace(nodes=_PATH_AS_TEXT), _EMPTY, "src/cell/launch/c.launch.py:8", id="document"
        ),
    ],
)
def test_the_files_explain_a_message(files: Mapping[str, str], log: str, place: str) -> None:
    """The place is that of the cause, and with a workspace that has other names nothing is said."""
    assert _places(files, log) == [place]
    assert _places(_workspace(name="other"), log) == []


@pytest.mark.parametrize(
    ("files", "log"),
    [
        pytest.param(_workspace(), _NOT_FOUND.replace("NAME", "cel"), id="no such package"),
        pytest.param(_workspace(), _NOT_FOUND.replace("NAME", "rviz2"), id="a package not used"),
        pytest.param(
            _workspace({"config/c.yaml": _TYPES.replace("arm:", "hand:")}), _NO_TYPE, id="type"
        ),
        pytest.param(
            _workspace({"config/m.yaml": _MOVEIT + "    action_ns: go\n"}), _NO_ACTION, id="action"
        ),
        pytest.param(_workspace(), _NO_MODULE, id="no such module"),
        pytest.param(_workspace(), _NO_LIBEXEC, id="installed"),
        pytest.param(
            _workspace({**_OF_CMAKE, "CMakeLists.txt": _CMAKE.replace("INSTALL", _TARGETS)}),
            _NO_LIBEXEC,
            id="installed by CMake",
        ),
        pytest.param(
            _workspace({"cell/mover.py": "x = 1\n\n"}),
            _TRACE.replace("PATH", "/ws/src/cell"),
            id="another line",
        ),
        pytest.param(
            _workspace(),
            "Duplicate package names not supported:\n- cell:\n  - a\n  - b",
            id="copies",
        ),
        pytest.param(_workspace(_WITH_ROBOT), _SPACED, id="no command"),
        pytest.param(
            _workspace(_WITH_ROBOT, _COMMAND),
            _SPACED.replace("my ws", "ws"),
            id="no space",
        ),
        pytest.param(_workspace(), _EMPTY, id="not started"),
        pytest.param(
            _workspace({**_STARTED_ROBOT, "urdf/arm.urdf": _WITH_COLOUR}),
            _NOT_PARSED,
            id="a robot that ROS 2 loads",
        ),
        pytest.param(
            _workspace(
                {**_STARTED_ROBOT, "urdf/arm.urdf": _WITH_COLOUR, "urdf/hand.urdf": _OF_NO_TYPE}
            ),
            _NOT_PARSED,
            id="another robot",
        ),
        pytest.param(
            _workspace(nodes="Node(package='cell', executable='mover', name='moover'),"),
            "executable 'moover' not found on the libexec directory '/ws/install/cell/lib/cell' ",
            id="a name that is no program",
        ),
        pytest.param(_workspace(nodes=_MOVER), "ValueError: wrong", id="no traceback"),
    ],
)
def test_what_the_files_do_not_prove_is_not_said(files: Mapping[str, str], log: str) -> None:
    """The message is answered in general, or with the places of its names, and no cause is said."""
    answers = _explained(files, log)
    assert answers
    for answer in answers:
        assert (answer.location is None) == (answer.relation == "explains")
        assert answer.message


def test_what_keeps_a_node_from_publishing_a_frame_explains_it() -> None:
    """The finding is in the parameters of the node, and does not name the frame."""
    amcl = "amcl:\n  ros__parameters:\n    robot_model_type: differential\n"
    files = _workspace({"config/amcl.yaml": amcl})
    setup = files["src/cell/setup.py"].replace(
        "data_files=[", "data_files=[('share/cell/config', ['config/amcl.yaml']), "
    )
    share = "__import__('ament_index_python').get_package_share_directory('cell')"
    node = _AMCL.replace("'src/cell/config/amcl.yaml'", f"{share} + '/config/amcl.yaml'")
    imports = "from ament_index_python.packages import get_package_share_directory as share\n"
    node = node.replace(share, "share('cell')")
    launch = imports + _LAUNCH.replace("NODES", node)
    files |= {
        "src/cell/setup.py": setup,
        "src/cell/launch/c.launch.py": launch,
        "README.md": "For ROS 2 Jazzy.",
    }
    log = '[rviz2-2] Warning: Invalid frame ID "FRAME" passed to canTransform argument target_frame - frame does not exist'
    assert _places(files, log.replace("FRAME", "map")) == ["src/cell/config/amcl.yaml:3"]
    assert _places(files, log.replace("FRAME", "camera")) == []


def test_a_root_cause_is_said_before_what_follows() -> None:
    """What follows has no line of its own, except where nothing else is explained."""
    died = "[ERROR] [mover-1]: process has died [pid 7, exit code 1, cmd '/home/ann/mover'].\n"
    trace = _TRACE.replace("PATH", "/ws/src/cell")
    assert [answer.output for answer in _explained(_workspace(), died + trace)] == [
        "python-exception"
    ]
    [only] = _explained(_workspace(), died * 3)
    assert (only.line, only.location) == (1, None)


def test_the_answers_have_a_limit() -> None:
    """Of messages that no row knows, the first few are named; what is no failure is not."""
    log = "".join(f"[INFO] [1.5] [a]: error {n}\n[ERROR] [1.5] [a]: wrong {n}\n" for n in range(50))
    answers = _explained(_workspace(), log)
    assert [(answer.line, answer.text) for answer in answers] == [
        (2 * n + 2, f"wrong {n}") for n in range(5)
    ]


def test_without_a_budget_findings_are_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    """What cannot be determined is not said, and raises nothing."""

    def spent(*_: object) -> None:
        raise NotDecided("too much")

    monkeypatch.setattr(explaining, "search_place", spent)
    answer, *_ = _explained(_workspace(), _NOT_FOUND.replace("NAME", "cell"))
    assert answer.location is None


def test_a_module_is_explained_by_setup_py_only() -> None:
    """A package without one, or whose setup.py names the module, says nothing."""
    tools = {"cell/tools/__init__.py": ""}
    named = _SETUP.replace("packages=['cell']", "packages=['cell', 'cell.tools']")
    assert _places(_workspace({**tools, "setup.py": named}), _NO_MODULE) == []
    without = _workspace(tools)
    del without["src/cell/setup.py"]
    assert _places(without, _NO_MODULE) == []
    computed = "from setuptools import setup\nsetup(**{'name': 'cell'})\n"
    assert _places(_workspace({**tools, "setup.py": computed}), _NO_MODULE) == []
