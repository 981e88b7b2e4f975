"""Names that mean the same in all packages: the file shared_names.toml."""

from functools import cache
from typing import NamedTuple

from grader.ros.known.typed_rows import read_file


class SharedNames(NamedTuple):
    """Names that mean the same in all packages; the file says whose they are."""

    frames: tuple[str, ...]  # that are there without the robot
    topics: tuple[str, ...]  # of programs that a person starts, and of drivers
    clock_words: tuple[str, ...]  # of what may publish /clock


@cache
def shared_names() -> SharedNames:
    """Return the names that mean the same in all packages."""
    return read_file(SharedNames, "shared_names")
