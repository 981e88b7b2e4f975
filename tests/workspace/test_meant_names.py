"""A misspelling that is reported hides nothing: the other rules go on with what is meant."""

from collections.abc import Mapping
from pathlib import Path

import pytest

from tests.test_misconfigurations import inspected

_NODE = "executable='follower', name='follower'"
_FILES = {
    "package.xml": """\
<package format="3"><name>drive_bot</name><version>0.1.0</version><description>Drives.</description>
<maintainer email="a@example.com">A</maintainer><license>MIT</license>
<exec_depend>rclpy</exec_depend><export><build_type>ament_python</build_type></export></package>
""",
    "setup.py": """\
from glob import glob
from setuptools import setup
setup(name='drive_bot', version='0.1.0', packages=['drive_bot'], data_files=[
    ('share/ament_index/resource_index/packages', ['resource/drive_bot']),
    ('share/drive_bot', ['package.xml']),
    ('share/drive_bot/launch', glob('launch/*')),
    ('share/drive_bot/config', glob('config/*')),
], entry_points={'console_scripts': ['follower = drive_bot.follower:main']})
""",
    "setup.cfg": "[develop]\nscript_dir=$base/lib/drive_bot\n[install]\ninstall_scripts=$base/lib/drive_bot\n",
    "resource/drive_bot": "",
    "drive_bot/__init__.py": "",
    "drive_bot/follower.py": """\
import rclpy
from rclpy.node import Node


class Follower(Node):
    def __init__(self):
        super().__init__('follower')
        self.declare_parameter('wall_distance', 0.5)


def main():
    rclpy.init()
    rclpy.spin(Follower())
""",
    "config/follower.yaml": "follower:\n  ros__parameters:\n    wall_distanse: 0.4\n",
    "launch/follow.launch.py": f"""\
import os
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    share = get_package_share_directory('drive_bot')
    return LaunchDescription([
        Node(package='drive_bot', {_NODE},
             parameters=[os.path.join(share, 'config', 'follower.yaml')]),
    ])
""",
}


def places(folder: Path, files: Mapping[str, str]) -> list[tuple[str, int]]:
    """Return the file and line of each error of a package."""
    for path, text in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text, encoding="utf-8")
    errors = [problem for problem in inspected(folder) if problem["severity"] == "error"]
    return [(error["location"]["path"], error["location"]["line"]) for error in errors]


@pytest.mark.parametrize(
    ("file", "old", "new", "at"),
    [
        ("launch/follow.launch.py", "executable='follower'", "executable='folower'", 10),
        ("launch/follow.launch.py", "'follower.yaml'", "'folower.yaml'", 11),
        ("config/follower.yaml", "follower:\n", "folower:\n", 1),
        ("config/follower.yaml", "ros__parameters", "ros_parameters", 2),
        ("setup.py", "drive_bot.follower:main", "drive_bot.folower:main", 8),
        ("setup.py", "drive_bot.follower:main", "drive_bot.follower:mian", 8),
        ("setup.py", "drive_bot.follower:main", "drivebot.follower:main", 8),
    ],
    ids=["program", "file", "section", "ros__parameters", "module", "function", "package"],
)
def test_a_misspelling_hides_no_other(
    file: str, old: str, new: str, at: int, tmp_path: Path
) -> None:
    """Both it and the parameter that the node does not declare are reported; the parameter alone, if it is corrected."""
    parameter = ("config/follower.yaml", 3)
    assert places(tmp_path / "one", _FILES) == [parameter]
    assert old in _FILES[file]
    changed = {**_FILES, file: _FILES[file].replace(old, new)}
    assert sorted(places(tmp_path / "two", changed)) == sorted([(file, at), parameter])
    right = _FILES["config/follower.yaml"].replace("distanse", "distance")
    changed["config/follower.yaml"] = right.replace(old, new) if "config" in file else right
    assert places(tmp_path / "left", changed) == [(file, at)]


def test_the_module_of_an_entry_point_says_which_is_meant(tmp_path: Path) -> None:
    """A program with the name of a module is the one that runs that, not a more similar one."""
    entries = "'wall_runner = drive_bot.follower:main', 'followers = drive_bot.other:main'"
    setup = _FILES["setup.py"].replace("'follower = drive_bot.follower:main'", entries)
    other = _FILES["drive_bot/follower.py"].replace("wall_distance", "wall_distanse")
    files = {**_FILES, "setup.py": setup, "drive_bot/other.py": other}
    expected = [("config/follower.yaml", 3), ("launch/follow.launch.py", 10)]
    assert sorted(places(tmp_path, files)) == expected
    [wrong] = [problem for problem in inspected(tmp_path) if problem["code"] == "REF006"]
    assert wrong["message"].endswith("did you mean 'wall_runner'?")


def test_a_program_that_is_a_guess_is_not_read(tmp_path: Path) -> None:
    """Of what the suggested program declares nothing is said: another one may be meant."""
    launch = _FILES["launch/follow.launch.py"].replace(_NODE, "executable='the_follower'")
    files = {**_FILES, "launch/follow.launch.py": launch}
    assert places(tmp_path, files) == [("launch/follow.launch.py", 10)]
    [wrong] = [problem for problem in inspected(tmp_path) if problem["code"] == "REF006"]
    assert wrong["message"].endswith("did you mean 'follower'?")
