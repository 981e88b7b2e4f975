"""A small workspace for messages of a log, and what is said of a log in it."""

from collections.abc import Mapping

from grader.files.tree import make_tree, overlaid
from grader.ros.api import Read
from grader.workspace.api import LogAnswer, explain_log, read_workspace

SETUP = """
from setuptools import setup
setup(
    name='cell',
    packages=['cell'],
    data_files=[('share/cell', ['package.xml']), ('share/cell/launch', ['launch/c.launch.py'])],
    entry_points={'console_scripts': ['mover = cell.mover:main']},
)
"""
LAUNCH = """
from launch import LaunchDescription
from launch.substitutions import Command
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([
        NODES
    ])
"""
_CODE = "def main():\n    print(missing)\n"


def make_workspace(
    files: Mapping[str, str] = {}, nodes: str = "", name: str = "cell"
) -> dict[str, str]:
    """Return the files of a package in src/, with a launch file that starts nodes."""
    manifest = f"<package format='3'><name>{name}</name><version>1.0.0</version>"
    manifest += "<description>A.</description><maintainer email='a@example.com'>A</maintainer><license>MIT</license>"
    manifest += "<export><build_type>ament_python</build_type></export></package>"
    package = {
        "package.xml": manifest,
        "setup.py": SETUP.replace("cell", name),
        "setup.cfg": f"[install]\ninstall_scripts=$base/lib/{name}\n",
        f"resource/{name}": "",
        f"{name}/__init__.py": "",
        f"{name}/mover.py": _CODE,
        "launch/c.launch.py": LAUNCH.replace("NODES", nodes),
        **files,
    }
    return {f"src/{name}/{path}": text for path, text in package.items()}


def explain(files: Mapping[str, str], log: str) -> list[LogAnswer]:
    """Return what is said of a log in a workspace."""
    data = {path: text.encode() for path, text in files.items()}
    opened = read_workspace(overlaid(make_tree("ws", (), ()), data), "ws", 1 << 20, {})
    problems = opened.package_problems()
    for robot in opened.robots:
        if isinstance(robot, Read):
            problems += opened.find_problems(robot)
    return [*explain_log(opened, problems, log.encode())]
