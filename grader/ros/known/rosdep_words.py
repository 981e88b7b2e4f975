"""What people write for a key of rosdep: the file rosdep.toml."""

from collections.abc import Mapping
from functools import cache

from grader.base.grouping import Strings, StringsByName
from grader.base.records import Named
from grader.ros.known.typed_rows import read_file


class RosdepWords(Named):
    """Names that are no keys of rosdep, with the key of what they name."""

    instead: StringsByName
    elsewhere: StringsByName  # how package.xml says it
    modules: StringsByName  # of Python, with their keys
    libraries: StringsByName  # that find_package() of CMake finds, with their keys
    alike: Mapping[str, Strings]  # other keys with which the same is installed
    brought: Mapping[str, frozenset[str]]  # by a key the packages that install it


@cache
def rosdep_words() -> RosdepWords:
    """Return what people write for a key of rosdep.

    >>> rosdep_words().instead["pyserial"]
    'python3-serial'
    """
    return read_file(RosdepWords, "rosdep")
