"""What Python's own library has in each release of ROS 2: the file python_names.toml.

The Python that runs the grader is not asked, so that each version gives the same marks.
"""

import re
from collections.abc import Collection
from functools import cache
from pathlib import Path
from typing import Any

import tomli

from grader.ros.known.releases import Release, Releases

PYTHON_NAMES_FILE = Path(__file__).with_suffix(".toml")
MODULES = ""  # the key of the names of all modules
_DEFAULT: Releases = ("jazzy",)


@cache
def _tables() -> Any:
    return tomli.loads(PYTHON_NAMES_FILE.read_text("utf-8"))


def python_version(releases: Collection[Release]) -> int:
    """Return the newest minor version of Python of some releases; without any, that of Jazzy."""
    return max(int(_version(release).removeprefix("3.")) for release in releases or _DEFAULT)


def _version(release: Release) -> str:
    """Return the version of Python of a release; of one that the table lacks, the newest."""
    versions = _tables()["python"]
    version: str = versions.get(release, versions["rolling"])
    return version


@cache
def python_names(key: str, releases: Releases = ()) -> frozenset[str]:
    """Return the names that a module, or a type of values, has in one of some releases.

    >>> "batched" in python_names("itertools"), "batched" in python_names("itertools", ("humble",))
    (True, False)
    """
    tables = _tables()
    names = set(tables["always"].get(key, "").split())
    for release in releases or _DEFAULT:
        names.update(tables[_version(release)].get(key, "").split())
    return frozenset(names)


def shared_message(text: str) -> str:
    """Return a message of Python as each version that runs the grader has it.

    >>> shared_message("float division by zero"), shared_message("expected a positive input")
    ('division by zero', 'math domain error')
    """
    for pattern, shared in _tables()["messages"].items():
        text = re.sub(pattern, shared, text)
    return text
