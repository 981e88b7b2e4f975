"""The packages that are released for ROS 2, and the keys of rosdep: the file rosdistro.json.xz.

The file is made of ros/rosdistro by `python -m tests.known.make_released CHECKOUT`, and read when a
name is looked up first. rosdistro_license.txt is the licence of what is in it.
"""

import json
import lzma
from collections.abc import Collection, Mapping
from functools import cache
from pathlib import Path

from grader.base.grouping import StringsByName
from grader.base.records import Named
from grader.ros.known.releases import RELEASES, Release, Releases

RELEASED_FILE = Path(__file__).with_name("rosdistro.json.xz")


class _ReleasedTable(Named):
    """The packages by their names, and the day of the commit that they were read from."""

    date: str
    releases: Mapping[str, frozenset[Release]]
    repositories: StringsByName
    metapackages: frozenset[str]
    by_repository: Mapping[str, frozenset[str]]
    rosdep: frozenset[str]


@cache
def _table() -> _ReleasedTable:
    data = json.loads(lzma.decompress(RELEASED_FILE.read_bytes()))
    releases_by_name = {}
    repositories = {}
    by_repository = {}
    for repository, groups in data["repositories"].items():
        names = set()
        for words, group in groups.items():
            releases = frozenset(release for release in RELEASES if release in words.split())
            for name in group.split():
                releases_by_name[name], repositories[name] = releases, repository
                names.add(name)
        by_repository[repository] = frozenset(names)
    metapackages = frozenset(data["metapackages"].split())
    rosdep = frozenset(data["rosdep"].split())
    return _ReleasedTable(
        data["date"], releases_by_name, repositories, metapackages, by_repository, rosdep
    )


def released_date() -> str:
    """Return the day of which the packages are: 2026-08-22."""
    return _table().date


def is_released(name: str, releases: Collection[Release] = ()) -> bool:
    """Return whether a package is released for one of some releases, or without any for one.

    >>> is_released("canopen_core", ["jazzy"]), is_released("canopen_cor")
    (True, False)
    """
    having = _table().releases.get(name, frozenset())
    return bool(having) and (not releases or not having.isdisjoint(releases))


def find_releases(name: str) -> Releases:
    """Return the releases for which a package is released, in their order.

    >>> find_releases("ros_ign_bridge")
    ('foxy', 'galactic', 'humble', 'iron')
    """
    having = _table().releases.get(name, frozenset())
    return tuple(release for release in RELEASES if release in having)


def rosdep_keys() -> frozenset[str]:
    """Return the keys by which rosdep installs what is no package of ROS.

    >>> "python3-serial" in rosdep_keys(), "pyserial" in rosdep_keys()
    (True, False)
    """
    return _table().rosdep


def released_packages() -> Collection[str]:
    """Return the names of all packages that are released for any release."""
    return _table().releases.keys()


def packages_brought_by(name: str) -> frozenset[str]:
    """Return the packages that a package may bring, because it seems to be a metapackage of them.

    They are those of its repository, or those of them whose names begin with its own. What its
    package.xml says is not known here.

    >>> "canopen_core" in packages_brought_by("canopen"), packages_brought_by("rclcpp")
    (True, frozenset())
    """
    if name not in _table().metapackages:
        return frozenset()
    repository = _table().repositories[name]
    others = _table().by_repository[repository] - {name}
    if name == repository:
        return others
    return frozenset(other for other in others if other.startswith(f"{name}_"))
