"""What every machine with ROS 2 has: the file machine.toml."""

from collections.abc import Mapping
from functools import cache

from grader.base.grouping import Strings
from grader.base.records import Named
from grader.ros.known.typed_rows import read_file


class RosMachine(Named):
    """What every machine with ROS 2 has, besides packages."""

    imported_by_launch: Strings  # Python packages
    environment: Strings  # variables that are set
    ending_commands: Mapping[str, Strings]  # with the options with which they do not end


@cache
def ros_machine() -> RosMachine:
    """Return what every machine with ROS 2 has."""
    return read_file(RosMachine, "machine")
