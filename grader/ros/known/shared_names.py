"""Names that mean the same in all packages: the file shared_names.toml."""

from functools import cache

from grader.base.grouping import Strings
from grader.base.records import Named
from grader.ros.known.typed_rows import read_file


class SharedNames(Named):
    """Names that mean the same in all packages; the file says whose they are."""

    frames: Strings  # that are there without the robot
    topics: Strings  # of programs that a person starts, and of drivers
    clock_words: Strings  # of what may publish /clock


@cache
def shared_names() -> SharedNames:
    """Return the names that mean the same in all packages."""
    return read_file(SharedNames, "shared_names")
