"""Imports of launch files that certainly fail, and those that may be there."""

import pytest

from grader.ros.launch.launch_file import read_launch
from tests.launch.launch_samples import Installed

_FILE = """\
IMPORT
from launch import LaunchDescription


def generate_launch_description():
    return LaunchDescription([])
"""


def _read_faults(statement: str) -> list[str]:
    """Return what stops a launch file with a statement."""
    data = _FILE.replace("IMPORT", statement).encode()
    launch = read_launch(data, "launch/a.launch.py", "share/a/launch/a.launch.py", Installed({}))
    return [fault.message for fault in launch.faults]


@pytest.mark.parametrize(
    ("statement", "message"),
    [
        (
            "from launch_ros.substitution import FindPackageShare",
            "there is no module 'launch_ros.substitution'; did you mean 'launch_ros.substitutions'?",
        ),
        (
            "import launch.nodes",
            "there is no module 'launch.nodes'",
        ),
        ("from launch_ros.nodes import Node", "there is no module 'launch_ros.nodes'"),
        (
            "from ament_index_python.package import get_package_prefix",
            "there is no module 'ament_index_python.package'; did you mean 'ament_index_python.packages'?",
        ),
        ("import rospy", "there is no module 'rospy'"),
        (
            "from launch.action import DeclareLaunchArgument",
            "launch.action has no 'DeclareLaunchArgument': import it from launch.actions",
        ),
        (
            "from launch.actions import IfCondition",
            "launch.actions has no 'IfCondition': import it from launch.conditions",
        ),
    ],
)
def test_a_module_that_a_package_lacks_stops_the_launch(statement: str, message: str) -> None:
    """It stops whether it is used or not, and the message names the module that users import."""
    faults = _read_faults(statement)
    assert faults == [message]


@pytest.mark.parametrize(
    "statement",
    [
        "from launch_ros.default_launch_description import ROSSpecificLaunchStartup",
        "from launch.actions.log import Log",
        "from launch_ros._private import thing",
        "import launch.launch_description_sources",
        "from ament_index_python.later import get_package_prefix",
        "from my_package.files import find_files",
        "import rclpy.experimental.other",
    ],
)
def test_a_module_that_may_be_there_stops_nothing(statement: str) -> None:
    """Older and private modules, modules below known ones and those of other packages may be there."""
    faults = _read_faults(statement)
    assert faults == []
