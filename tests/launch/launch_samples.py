"""The samples of launch files, and the results of evaluating one in a form that is easy to compare."""

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from grader.ros.installation.places import PREFIX
from grader.ros.launch.launch_file import read_launch
from grader.ros.launch.launch_model import Launch, LaunchFault, NamedFile

SAMPLES = {
    path.name.removesuffix(".txt"): path
    for path in sorted(Path(__file__).parent.glob("launch_samples/*.txt"))
}
FOLDER = "share/my_robot/launch"
# Files of the package that the samples include or read.
INNER = {
    f"{FOLDER}/inner.launch.py": b"""\
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('gui', default_value='false'),
        Node(package='joint_state_publisher_gui', executable='joint_state_publisher_gui',
             condition=IfCondition(LaunchConfiguration('gui'))),
        Node(package='joint_state_publisher', executable='joint_state_publisher'),
    ])
""",
    "share/my_robot/config/viewers.yaml": b"names: [rviz2]\n",
    f"{FOLDER}/broken.launch.py": b"def generate_launch_description(:\n",
}
_SIGNS = {True: "", False: "!", None: "?"}


def summarize_sample(sample: str) -> list[str]:
    """Return the results for a sample, which is installed in my_robot's folder launch."""
    return summarize(read(SAMPLES[sample].read_bytes(), sample))


class Installed(NamedTuple):
    """What is installed around a launch file: these files, by their paths below the prefix, and every program."""

    files: Mapping[str, bytes]

    def open_installed(self, path: str) -> tuple[bytes, str] | None:
        """Return a file and its path in the submission."""
        return (
            (self.files[path], path.removeprefix("share/my_robot/")) if path in self.files else None
        )

    def has_package(self, name: str) -> bool:
        """Return whether a package is there."""
        return name != ""

    def misspelt_package(self, name: str) -> str | None:
        """Return the package that a name stands for."""

    def files_in(self, folder: str) -> tuple[str, ...]:
        """Return the names of the files in a folder."""
        return tuple(
            path.rpartition("/")[2] for path in self.files if path.rpartition("/")[0] == folder
        )

    def has_program(self, package: str, name: str) -> bool:
        """Return whether a package has a program."""
        return "" not in (package, name)


def read(data: bytes, name: str, others: dict[str, bytes] = INNER) -> Launch:
    """Return the results for a launch file of this name; `others` are installed, too."""
    return read_launch(data, f"launch/{name}", f"{FOLDER}/{name}", Installed(others))


def summarize(launch: Launch) -> list[str]:
    """Return the results for a launch file as lines.

    A node is named by its program, preceded by its package if that has another name; ! means not started, ? unknown.
    Everything else has its line and its path or text; `wrong:` and `unknown:` precede the reason why there is no path.
    """
    nodes = " ".join(
        _node(node.package, node.executable) + _SIGNS[node.when] for node in launch.nodes
    )
    forgotten = " ".join(_node(node.package, node.executable) for node in launch.forgotten)
    found = [f"nodes: {nodes}"] if nodes else []
    for kind in ("urdf", "rviz", "include"):
        found += [f"{kind} {_reference(named)}" for named in launch.named(kind)]
    found += [f"faults {_fault(fault)}" for fault in launch.faults]
    found += [f"doubts {_fault(fault)}" for fault in launch.doubts]
    found += [f"unknown {_fault(fault)}" for fault in launch.unknown]
    found += [f"forgotten: {forgotten}"] if forgotten else []
    return found + ([f"syntax: {_fault(launch.syntax)}"] if launch.syntax is not None else [])


def _node(package: str, executable: str) -> str:
    return executable if package == executable else f"{package}/{executable}"


def _fault(fault: LaunchFault) -> str:
    """Return a fault with its line; the parsers' own messages differ between their versions."""
    parsers = ("Python cannot read the file", "not readable as XML", "not readable as YAML")
    message = next(
        (parser for parser in parsers if fault.message.startswith(f"{parser}: ")), fault.message
    )
    return f"{fault.location.line}: {message}"


def _reference(named: NamedFile) -> str:
    line = f"{named.location.line}: "
    if named.path is not None and not named.reason:
        return line + named.path.removeprefix(f"{PREFIX}/share/")
    return f"{line}{'wrong' if named.is_certain else 'unknown'}: {named.reason}"
