"""The versions of URDF, and which of them each release of ROS 2 reads.

Version 1.1 has capsules and quaternions; 1.2 has acceleration, deceleration and jerk, and checks
limits and sizes.
"""

from collections.abc import Collection

from grader.base.records import Named
from grader.ros.known.releases import Release
from grader.ros.urdf.numbers import version_in

UrdfVersion = tuple[int, int]

FIRST: UrdfVersion = (1, 0)  # of a file that states none
WITH_CAPSULES: UrdfVersion = (1, 1)
WITH_CHECKED_VALUES: UrdfVersion = (1, 2)

NEWEST = WITH_CHECKED_VALUES  # of any release

# The newest version that a release reads, where it is not the first one. Sources: urdfdom 4.0.1 of
# Jazzy and 6.0.0 of Lyrical, run on the same files; ros/rosdistro of August 2026.
_NEWEST: dict[Release, UrdfVersion] = {"lyrical": (1, 2), "rolling": (1, 2)}


class UrdfFormat(Named):
    """The version of a file, and the newest one that the release reads it is for."""

    newest: UrdfVersion = FIRST
    version: UrdfVersion = FIRST

    @property
    def warns(self) -> bool:
        """Whether ROS 2 warns of what it ignores because the file states an older version."""
        return self.newest > FIRST


def newest_version(releases: Collection[Release]) -> UrdfVersion:
    """Return the newest version that each of some releases reads; without any, the first one."""
    return min((_NEWEST.get(release, FIRST) for release in releases), default=FIRST)


def first_release(text: str) -> Release | None:
    """Return the first release that reads a version, as a file states it, if Jazzy does not."""
    for release, newest in _NEWEST.items():
        if FIRST < (version_in(text) or FIRST) <= newest:
            return release
    return None


def in_words(version: UrdfVersion) -> str:
    """Return a version as a file states it, `1.1`."""
    major, minor = version
    return f"{major}.{minor}"
