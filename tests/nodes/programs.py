"""Packages with one program in Python."""

from collections.abc import Sequence

from grader.base.slips import Slip
from grader.files.tree import make_tree, overlaid
from grader.ros.known.releases import Release
from grader.ros.nodes.python.python_nodes import program_slips
from grader.ros.package.finding import read_packages

MANIFEST = "<package format='3'><name>hub</name></package>"
CMAKE = """
project(hub)
find_package(ament_cmake REQUIRED)
install(PROGRAMS scripts/drive_circle.py DESTINATION lib/${PROJECT_NAME})
ament_package()
"""
SETUP = """
from setuptools import setup
setup(name='hub', packages=['scripts'],
      entry_points={'console_scripts': ['drive_circle = scripts.drive_circle:main']})
"""


def slips_of(text: str, releases: Sequence[Release] = (), *, is_script: bool = True) -> list[Slip]:
    """Return the slips of a program with a text: a script, or a module whose main() is called."""
    build = (
        {"CMakeLists.txt": CMAKE} if is_script else {"setup.py": SETUP, "scripts/__init__.py": ""}
    )
    files = {"package.xml": MANIFEST, "scripts/drive_circle.py": text, **build}
    tree = overlaid(
        make_tree("work", (), ()), {f"hub/{name}": it.encode() for name, it in files.items()}
    )
    [package] = read_packages(tree, "urdf/hub.urdf", releases=tuple(releases))
    return [*program_slips(package)]
