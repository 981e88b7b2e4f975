"""Read a workspace with all of its robots: every file that is one, and not a part of another."""

import posixpath
from collections import Counter
from collections.abc import Collection, Sequence
from typing import TypeGuard

from grader.base.errors import InputError, NotDecided
from grader.base.grouping import StringsByName
from grader.base.reuse import Memory
from grader.base.source import Source
from grader.files.limits import ARCHIVES
from grader.files.reading import URDF_LIMIT
from grader.files.tree import Tree, parents
from grader.ros.installation.places import is_template
from grader.ros.known.releases import Release, StatedReleases
from grader.ros.package.finding import (
    is_backup,
    launched_paths,
    package_around,
    read_packages,
)
from grader.ros.package.made_paths import made_paths
from grader.ros.package.package import Package
from grader.ros.package.robot_file import Absent, Read, Surroundings, Unreadable, read_as_ros
from grader.ros.package.robot_readings import read_as_meant
from grader.ros.package.robots import RobotFile, find_robots, list_parts
from grader.ros.python.budget import READING, Budget
from grader.ros.urdf.urdf_problems import NO_LINKS, ROBOT_WITHOUT_NAME, UNKNOWN_LINK
from grader.workspace.model.known_robots import INCLUDED
from grader.workspace.model.stated_releases import stated_releases
from grader.workspace.opening.opened import OpenedWorkspace

_DECLARES = b"xmlns:xacro"
_MAX_PACKAGES = 1000
_MAX_ROBOTS = 200
_NOTES = (".txt", ".md", ".rst", ".log")
_MAX_ALIKE = 20  # files of one name and size with which one in an archive is compared


def read_workspace(
    tree: Tree,
    identity: str,
    max_size: int,
    arguments: StringsByName,
    memory: Memory | None = None,
    stated: StatedReleases | None = None,
) -> OpenedWorkspace:
    """Return the packages in a file tree, and their robots in the order of their paths.

    Args:
        tree: The files.
        identity: The name of the folder or archive.
        max_size: The largest size of a robot, in bytes.
        arguments: The arguments of xacro that the user gives.
        memory: What was read of an earlier state of the files.
        stated: The release of ROS 2 that an option or a setting gives; without it, its files state
            releases.
    """
    if not stated:
        stated = stated_releases(tree)
    all_packages = read_packages(
        tree,
        "",
        memory=memory,
        most=_MAX_PACKAGES,
        releases=stated.releases,
        are_whole=True,
    )
    packages = _outermost(all_packages)
    ros1_packages = tuple(package for package in packages if package.is_of_ros1)
    return OpenedWorkspace(
        identity,
        Absent(),
        packages=tuple(package for package in packages if package not in ros1_packages),
        whole_tree=tree,
        is_single=False,
        robots=tuple(_read_robots(tree, packages, max_size, arguments, memory, stated.releases)),
        ros1_packages=ros1_packages,
        memory=memory,
        stated=stated,
        reads_meant=True,
    )


def _outermost(packages: tuple[Package, ...]) -> tuple[Package, ...]:
    """Return the packages without those that are inside of others, where colcon looks for none."""
    folders = [package.path("") for package in packages]
    outermost = []
    for package in packages:
        path = package.path("")
        if not any(path.startswith(folder) and path != folder for folder in folders):
            outermost.append(package)
    return tuple(outermost)


def _read_robots(
    tree: Tree,
    packages: tuple[Package, ...],
    max_size: int,
    arguments: StringsByName,
    memory: Memory | None,
    releases: Collection[Release],
) -> list[Read | Unreadable]:
    robot_files = _without_packed_copies(tree, find_robots(tree, max_size=max_size))
    launched = launched_paths(tree, packages, robot_files)
    included = list_parts(robot_files) | _chosen_parts(tree, robot_files)
    whole = Budget(READING + (packages[0].work.limit if packages else 0))
    counts = Counter(file.name for file in robot_files)
    robots: list[Read | Unreadable] = []
    parts: list[Read | Unreadable] = []
    for file in _whole(robot_files, launched, included)[:_MAX_ROBOTS]:
        budget = Budget(whole=whole)
        around = package_around(packages, file.path)
        surroundings = Surroundings(
            budget,
            tree,
            around,
            packages,
            arguments,
            assumes_defaults=True,
            memory=memory,
            releases=releases,
            called="workspace",
        )
        robot = _read(tree, file, max_size, surroundings)
        if file.path not in launched:
            robot = _without_loading(robot)
        is_loaded = file.path in launched and file.path not in included
        is_piece = (
            _is_part(robot)
            or _declares_only(robot)
            or (counts[file.name] > 1 and _is_without_parents(robot))
        )
        is_whole = not _is_empty(robot) and (is_loaded or not is_piece)
        (robots if is_whole else parts).append(robot)
    return robots or [part for part in parts if not _is_empty(part)]


def _without_loading(robot: Read | Unreadable) -> Read | Unreadable:
    """Return xacro under the name of a URDF, which nothing loads, as its expansion.

    The warning that ROS 2 does not evaluate it stays.
    """
    if not isinstance(robot, Read) or not robot.as_it_stands:
        return robot
    reading = robot.reading._replace(problems=robot.problems)
    return robot._replace(reading=reading, as_it_stands=None)


def _declares_only(robot: Read | Unreadable) -> bool:
    """Return whether a file declares xacro and has no links: others may include it."""
    if not isinstance(robot, Read) or _DECLARES not in robot.data:
        return False
    model = robot.reading.robot
    return model is not None and not model.links


def _without_packed_copies(tree: Tree, robot_files: Sequence[RobotFile]) -> list[RobotFile]:
    """Return the files without those in archives that are also outside, with equal bytes."""
    packed = []
    outside: dict[tuple[str, int], list[str]] = {}  # the paths of the others by name and size
    for file in robot_files:
        if any(folder.lower().endswith(ARCHIVES) for folder in parents(file.path)):
            packed.append(file)
        else:
            outside.setdefault((file.name, file.size), []).append(file.path)
    copies = set()
    for file in packed:
        alike = outside.get((file.name, file.size), [])[:_MAX_ALIKE]
        data = tree.read(file.path, URDF_LIMIT) if alike else None
        if data is not None and any(tree.read(path, URDF_LIMIT) == data for path in alike):
            copies.add(file.path)
    return [file for file in robot_files if file.path not in copies]


def _whole(
    robot_files: Sequence[RobotFile], launched: set[str], parts: frozenset[str]
) -> list[RobotFile]:
    """Return the files that launch files load, and those that are no backups, parts or notes."""
    whole = []
    for file in robot_files:
        is_other = file.path in parts or is_backup(file.path) or _is_note(file)
        is_other = is_other or is_template(file.path)
        if file.path in launched or not is_other:
            whole.append(file)
    return whole


def _is_note(file: RobotFile) -> bool:
    """Return whether a file is a text with a piece of a robot in it, which no program loads."""
    is_text = file.name.endswith(_NOTES)
    return is_text and not any(word in file.name for word in ("urdf", "xacro"))


def _chosen_parts(tree: Tree, robot_files: Sequence[RobotFile]) -> frozenset[str]:
    """Return the paths of those files that another one includes by a name that it computes."""
    parts = set()
    for file in robot_files:
        text = (tree.read(file.path, URDF_LIMIT) or b"").decode("utf-8", "replace")
        names = [name for name in INCLUDED.findall(text) if "$" in posixpath.basename(name)]
        for made in made_paths(Source(file.path, "\n".join(names))) if names else ():
            parts |= {other.path for other in robot_files if made.matches(other.path)} - {file.path}
    return frozenset(parts)


def _read(
    tree: Tree, file: RobotFile, max_size: int, surroundings: Surroundings
) -> Read | Unreadable:
    try:
        data = tree.files[file.path].read(max_size)
        return read_as_meant(read_as_ros(data, file.path, surroundings), surroundings)
    except (InputError, NotDecided) as error:
        return Unreadable(file.path, str(error))


def _is_part(robot: Read | Unreadable) -> bool:
    """Return whether a file of xacro has no name or no links, as one that others include."""
    if not _is_xacro(robot):
        return False
    model = robot.reading.robot
    return _is_empty(robot) or (model is not None and not model.name)


def _is_without_parents(robot: Read | Unreadable) -> bool:
    """Return whether a file of xacro lacks only links that its joints name.

    One of several with a name, which belong to states of a robot, is then a piece of one of them.
    """
    if not _is_xacro(robot):
        return False
    return {problem.kind for problem in robot.problems if problem.severity == "error"} == {
        UNKNOWN_LINK
    }


def _is_empty(robot: Read | Unreadable) -> bool:
    """Return whether a file has no links, as one of xacro that only defines macros.

    A file that is not called a URDF may be that of another program, which has a <robot> too; the
    driver of Webots reads a URDF of its own form (webots_ros2_driver, WebotsNode).
    """
    if not isinstance(robot, Read):
        return False
    is_of_webots = b"<webots" in robot.data
    if robot.path.endswith(".urdf") and not (is_of_webots or _is_xacro(robot)):
        return False
    errors = {problem.kind for problem in robot.problems if problem.severity == "error"}
    return NO_LINKS in errors and errors <= {NO_LINKS, ROBOT_WITHOUT_NAME}


def _is_xacro(robot: Read | Unreadable) -> TypeGuard[Read]:
    return isinstance(robot, Read) and (robot.is_expanded or robot.path.endswith(".xacro"))
