"""What Gazebo refuses of robots, compared with libsdformat."""

import shutil
import subprocess
from pathlib import Path

import pytest

from tests.workspace.test_rule_examples import problems_of

pytestmark = pytest.mark.slow

_JUDGE = """\
#include <sdf/sdf.hh>
#include <iostream>
#include <iterator>
int main()
{
  const std::string text{std::istreambuf_iterator<char>(std::cin), {}};
  return sdf::Root().LoadSdfString(text).empty() ? 0 : 1;
}
"""
_LIBRARIES = ("sdformat15", "sdformat14", "sdformat13", "sdformat12")
_RULES = ("gazebo-robot", "sensor-name")
_MOMENTS = 'ixx="0.002" iyy="0.002" izz="0.003" ixy="0" ixz="0" iyz="0"'
_BODY = f'<inertial><mass value="0.5"/><inertia {_MOMENTS}/></inertial>'
_MAST = '<joint name="mast_joint" type="fixed"><parent link="base"/><child link="mast"/></joint>'
ROBOTS = {
    "one body": f'<link name="base">{_BODY}</link>',
    "a body below a frame": f'<link name="foot"/><link name="base">{_BODY}</link>'
    '<joint name="foot_joint" type="fixed"><parent link="foot"/><child link="base"/></joint>',
    "two bodies that are fixed": f'<link name="base">{_BODY}</link><link name="mast">{_BODY}</link>{_MAST}',
    "two bodies, one of which turns": f'<link name="base">{_BODY}</link><link name="wheel">{_BODY}</link>'
    '<joint name="turns" type="continuous"><parent link="base"/><child link="wheel"/></joint>',
    "a mast that is kept": f'<link name="base">{_BODY}</link><link name="mast">{_BODY}</link>{_MAST}'
    '<gazebo reference="mast_joint"><preserveFixedJoint>true</preserveFixedJoint></gazebo>',
}
_SENSOR = '<gazebo reference="base"><sensor name="s" type="imu"/></gazebo>'
CHANGES = {
    "nothing": "",
    "no type": '<gazebo reference="base"><sensor name="s"/></gazebo>',
    "another type": '<gazebo reference="base"><sensor name="s" type="gpulidar"/></gazebo>',
    "no name": '<gazebo reference="base"><sensor type="imu"/></gazebo>',
    "one name twice": _SENSOR + _SENSOR,
    "one name on the mast": _SENSOR + _SENSOR.replace("base", "mast"),
    "no filename": '<gazebo><plugin name="p"/></gazebo>',
    "a word": '<gazebo reference="base"><sensor name="s" type="camera"><camera><image><width>w</width>'
    "</image></camera></sensor></gazebo>",
    "a unit": '<gazebo reference="base"><sensor name="s" type="imu"><update_rate>30 Hz</update_rate></sensor></gazebo>',
    "yes": '<gazebo reference="base"><sensor name="s" type="imu"><always_on>yes</always_on></sensor></gazebo>',
    "a large moment": _MOMENTS.replace('ixx="0.002"', 'ixx="0.02"'),
    "a large product": _MOMENTS.replace('ixy="0"', 'ixy="0.004"'),
    "a plate": _MOMENTS.replace('izz="0.003"', 'izz="0.004"'),
}


@pytest.fixture(scope="module")
def judge(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a program that ends with 1 if libsdformat refuses the robot that it reads."""
    folder = tmp_path_factory.mktemp("judge")
    if shutil.which("g++") is None or shutil.which("pkg-config") is None:
        pytest.skip("libsdformat is not compared: there is no g++ or pkg-config")
    found = subprocess.run(["pkg-config", "--list-package-names"], capture_output=True, text=True)
    names = [name for name in _LIBRARIES if name in found.stdout.split()]
    if not names:
        pytest.skip("libsdformat is not compared: Debian's libsdformat-dev is not installed")
    (folder / "judge.cpp").write_text(_JUDGE, encoding="utf-8")
    flags = ["pkg-config", "--cflags", "--libs", names[0]]
    options = subprocess.run(flags, capture_output=True, text=True, check=True).stdout.split()
    program = folder / "judge"
    subprocess.run(["g++", "-std=c++17", "-o", program, folder / "judge.cpp", *options], check=True)
    return program


@pytest.mark.parametrize("robot", ROBOTS)
def test_gazebo_refuses_what_libsdformat_refuses(robot: str, judge: Path, tmp_path: Path) -> None:
    """A robot with each change has a problem if, and only if, libsdformat refuses it."""
    for name, change in CHANGES.items():
        parts = ROBOTS[robot]
        parts = parts.replace(_MOMENTS, change, 1) if "ixx" in change else parts + change
        text = f'<robot name="r">{parts}</robot>'
        refused = subprocess.run([judge], input=text, text=True, capture_output=True, check=False)
        found = problems_of(tmp_path / name, _files(text))
        said = [problem["message"] for problem in found if problem["rule"] in _RULES]
        assert bool(said) == (refused.returncode != 0), (name, said, refused.stderr)


def _files(robot: str) -> dict[str, str]:
    """Return a package whose launch file creates a robot in Gazebo."""
    return {
        "package.xml": '<package format="3"><name>r</name><version>1.0.0</version><description>A rover.'
        '</description><maintainer email="a@example.com">A</maintainer><license>MIT</license>'
        "<export><build_type>ament_cmake</build_type></export></package>",
        "CMakeLists.txt": "cmake_minimum_required(VERSION 3.8)\nproject(r)\nfind_package(ament_cmake REQUIRED)\n"
        "install(DIRECTORY launch urdf DESTINATION share/${PROJECT_NAME})\nament_package()\n",
        "urdf/r.urdf": robot,
        "launch/r.launch.py": "import os\n\nfrom ament_index_python.packages import get_package_share_directory\n"
        "from launch import LaunchDescription\nfrom launch_ros.actions import Node\n\n\n"
        "def generate_launch_description():\n"
        "    path = os.path.join(get_package_share_directory('r'), 'urdf', 'r.urdf')\n"
        "    return LaunchDescription([Node(package='ros_gz_sim', executable='create', arguments=['-file', path])])\n",
    }
