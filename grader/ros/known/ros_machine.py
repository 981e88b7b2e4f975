"""What every machine with ROS 2 has: the file machine.toml."""

from collections.abc import Mapping
from functools import cache
from typing import NamedTuple

from grader.ros.known.typed_rows import read_file


class RosMachine(NamedTuple):
    """What every machine with ROS 2 has, besides packages."""

    imported_by_launch: tuple[str, ...]  # Python packages
    environment: tuple[str, ...]  # variables that are set
    ending_commands: Mapping[str, tuple[str, ...]]  # with the options with which they do not end


@cache
def ros_machine() -> RosMachine:
    """Return what every machine with ROS 2 has."""
    return read_file(RosMachine, "machine")
