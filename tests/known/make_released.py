"""Write the packages that are released for ROS 2: `python -m tests.known.make_released CHECKOUT`.

The argument is a clone of ros/rosdistro, of which the newest commit is read with git. The names stand by repository and by the
releases that have them, in `grader/ros/known/rosdistro.json.xz`, and beside them the keys of rosdep.
"""

import json
import lzma
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import yaml

from grader.ros.known.released import RELEASED_FILE
from grader.ros.known.releases import RELEASES

_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_NOTICE = "Names of ros/rosdistro, Copyright (c) Open Source Robotics Foundation, Inc.; BSD-3-Clause, see rosdistro_license.txt"


# Packages with code of their own, though others of their repositories are called after them: no metapackages.
_WITH_CODE = frozenset(
    {
        *(
            "agnocast",
            "ament_cmake",
            "ament_cmake_ros",
            "apriltag_detector",
            "crazyflie",
            "generate_parameter_library",
        ),
        *(
            "inverse_dynamics_solver",
            "launch",
            "mavros",
            "mujoco_ros2_control",
            "qt_gui",
            "rcl",
            "rclc",
            "rclcpp",
        ),
        *(
            "ros2cli",
            "rosbag2_storage",
            "rosidlcpp",
            "system_modes",
            "tf2",
            "tracetools",
            "ur_robot_driver",
        ),
    }
)
_ROSDEP_FILES = ("base", "python", "ruby")  # rosdep/sources.list.d/20-default.list names them
_MIN_OTHERS, _MIN_NAMED = 3, 4  # of the repository, and of those that are called after a package


def _git(checkout: str, *arguments: str) -> str:
    command = ["git", "-C", checkout, *arguments]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def released_names(distribution: str) -> Iterator[tuple[str, str]]:
    """Yield the released packages of a distribution.yaml, each after its repository."""
    for repository, entry in yaml.load(distribution, _LOADER)["repositories"].items():
        release = entry.get("release") or {}
        if "version" in release:
            for package in release.get("packages") or [repository]:
                yield repository, package


def rosdep_keys(checkout: str) -> list[str]:
    """Return the keys of rosdep that are no packages of ROS: what rosdep installs with apt or pip."""
    keys: set[str] = set()
    for name in _ROSDEP_FILES:
        keys |= yaml.load(_git(checkout, "show", f"HEAD:rosdep/{name}.yaml"), _LOADER).keys()
    return sorted(keys)


def make_released(checkout: str) -> bytes:
    """Return the file of what a clone has."""
    releases: dict[str, list[str]] = {}  # by package
    repositories: dict[str, str] = {}  # by package, of the newest release
    for release in RELEASES:
        for repository, package in released_names(
            _git(checkout, "show", f"HEAD:{release}/distribution.yaml")
        ):
            releases.setdefault(package, []).append(release)
            repositories[package] = repository
    groups: dict[str, dict[str, list[str]]] = {}
    for package in sorted(releases):
        of_repository = groups.setdefault(repositories[package], {})
        of_repository.setdefault(" ".join(releases[package]), []).append(package)
    metapackages: list[str] = []
    for repository, of_repository in groups.items():
        names = [name for group in of_repository.values() for name in group]
        for name in names:
            is_named = sum(other.startswith(f"{name}_") for other in names) >= _MIN_NAMED
            is_whole = name == repository and len(names) > _MIN_OTHERS
            if (is_named or is_whole) and name not in _WITH_CODE:
                metapackages.append(name)
    data = {
        "notice": _NOTICE,
        "source": "ros/rosdistro",
        "commit": _git(checkout, "rev-parse", "HEAD").strip(),
        "date": _git(checkout, "log", "-1", "--format=%cs").strip(),
        "metapackages": " ".join(sorted(metapackages)),
        "rosdep": " ".join(rosdep_keys(checkout)),
        "repositories": {
            repository: {
                words: " ".join(names) for words, names in sorted(groups[repository].items())
            }
            for repository in sorted(groups)
        },
    }
    text = json.dumps(data, separators=(",", ":"), ensure_ascii=True)
    return lzma.compress(text.encode(), preset=9 | lzma.PRESET_EXTREME)


if __name__ == "__main__":
    Path(RELEASED_FILE).write_bytes(make_released(sys.argv[1]))
