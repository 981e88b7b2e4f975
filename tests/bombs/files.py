"""The files of packages for inputs that ask for much work."""

from collections.abc import Callable, Iterable

Files = dict[str, str]  # by path

URDF = '<robot name="my_robot"><link name="base_link"/></robot>'
_MANIFEST = (
    '<package format="3"><name>{name}</name><version>0.0.0</version><description>d</description>'
    '<maintainer email="lab@example.org">a</maintainer><license>MIT</license>{more}'
    "<export><build_type>{kind}</build_type></export></package>"
)
_SETUP = """from setuptools import setup
from glob import glob
setup(name='{name}', version='0.0.0', packages=['{name}'], data_files=[
    ('share/ament_index/resource_index/packages', ['resource/{name}']),
    ('share/{name}', ['package.xml']),
    ('share/{name}/launch', glob('launch/*')),
    ('share/{name}/urdf', glob('urdf/*')),
    ('share/{name}/config', glob('config/*')),
], entry_points={{'console_scripts': [{programs}]}})
"""
_CMAKE = (
    "cmake_minimum_required(VERSION 3.8)\nproject(my_robot)\nfind_package(ament_cmake REQUIRED)\n"
)
_HEAD = """from launch import LaunchDescription
from launch_ros.actions import Node
from ament_index_python.packages import get_package_share_directory
P = get_package_share_directory('my_robot') + '/config/'
def generate_launch_description():
"""
_NODE = """import rclpy
from rclpy.node import Node
from std_msgs.msg import String
class N(Node):
    def __init__(self):
        super().__init__("n")
{body}
def main():
    rclpy.init()
    rclpy.spin(N())
"""


def lines(count: int, text: Callable[[int], str], between: str = "\n") -> str:
    """Return a text for each number below a count."""
    return between.join(text(number) for number in range(count))


def word(number: int) -> str:
    """Return a word for a number: names with other numbers are not taken for misspelt ones."""
    letters = "abcdefghij"
    return "".join(letters[int(digit)] for digit in f"{number:05d}")


def package(name: str = "my_robot", more: str = "", programs: str = "", urdf: str = URDF) -> Files:
    """Return the files of a package that setup.py installs."""
    return {
        "package.xml": _MANIFEST.format(name=name, kind="ament_python", more=more),
        "setup.py": _SETUP.format(name=name, programs=programs),
        f"resource/{name}": "",
        f"{name}/__init__.py": "",
        "urdf/my_robot.urdf": urdf,
    }


def cmake(text: str, files: Iterable[str] = (), more: str = "") -> Files:
    """Return the files of a package that CMake installs, with other empty files."""
    depends = f"<buildtool_depend>ament_cmake</buildtool_depend>{more}"
    return {
        "package.xml": _MANIFEST.format(name="my_robot", kind="ament_cmake", more=depends),
        "CMakeLists.txt": f"{_CMAKE}{text}\nament_package()\n",
        "urdf/my_robot.urdf": URDF,
        **dict.fromkeys(files, ""),
    }


def launched(actions: str, **given: str) -> Files:
    """Return a package with a launch file of these actions, an expression of a list."""
    text = f"{_HEAD}    return LaunchDescription({actions})\n"
    return {**package(**given), "launch/a.launch.py": text}


def started(count: int, parameters: str = "", program: str = "'x'", more: str = "") -> str:
    """Return the actions that start as many nodes."""
    given = f", parameters=[{parameters}]" if parameters else ""
    node = f"Node(package='my_robot', executable={program}, name='n%d' % i{given}{more})"
    return f"[{node} for i in range({count})]"


def program(body: Iterable[str]) -> str:
    """Return the text of a program with a node that does this when it is created."""
    return _NODE.format(body="\n".join(f"        {line}" for line in body))


def robot(count: int, more: str = "") -> str:
    """Return a robot with as many links and joints beside its base."""
    links = lines(
        count,
        lambda i: (
            f'<link name="link_{word(i)}_a"/><joint name="joint_{word(i)}_a" type="continuous">'
            f'<parent link="base_link"/><child link="link_{word(i)}_a"/></joint>'
        ),
    )
    return f'<robot name="my_robot"><link name="base_link"/>\n{links}\n{more}</robot>'
