"""What Python's own library has in each release of ROS 2: the file python_names.toml.

The Python that runs the grader is not asked, so that each version gives the same marks.
"""

from collections.abc import Collection, Mapping
from functools import cache
from pathlib import Path
from typing import Any

import tomli

from grader.ros.known.releases import Release

PYTHON_NAMES_FILE = Path(__file__).with_suffix(".toml")
MODULES = ""  # the key of the names of all modules
_DEFAULT: tuple[Release, ...] = ("jazzy",)


@cache
def _tables() -> Mapping[str, Mapping[str, str]]:
    tables: dict[str, Any] = tomli.loads(PYTHON_NAMES_FILE.read_text("utf-8"))
    return tables


def python_versions(releases: Collection[Release]) -> list[tuple[int, int]]:
    """Return the versions of Python that some releases run with; without any, that of Jazzy."""
    versions = []
    for release in releases or _DEFAULT:
        major, _, minor = _tables()["python"][release].partition(".")
        versions.append((int(major), int(minor)))
    return versions


@cache
def python_names(key: str, releases: tuple[Release, ...] = ()) -> frozenset[str]:
    """Return the names that a module, or a type of values, has in one of some releases.

    >>> "batched" in python_names("itertools"), "batched" in python_names("itertools", ("humble",))
    (True, False)
    """
    tables = _tables()
    names = set(tables["always"].get(key, "").split())
    for release in releases or _DEFAULT:
        names.update(tables[tables["python"][release]].get(key, "").split())
    return frozenset(names)
