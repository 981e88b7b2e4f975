"""Packages that are there: in the workspace, in a release of ROS 2, or under a key of rosdep."""

import re
from collections.abc import Iterable, Iterator
from itertools import chain, starmap

from grader.base.errors import NotDecided
from grader.base.names import last_part, near
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.source import Location
from grader.base.text import enumerated, quoted
from grader.ros.installation.manifest_conditions import evaluate_condition
from grader.ros.known.package_rows import package_row
from grader.ros.known.released import (
    find_releases,
    is_released,
    released_date,
    released_packages,
    rosdep_keys,
)
from grader.ros.known.releases import other_name
from grader.ros.known.rosdep_words import rosdep_words
from grader.ros.package.package import MANIFEST, Package
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    Mismatch,
    Mismatches,
    charge_guess,
)
from grader.workspace.rules.rule_table import NO_KEY, NO_PACKAGE, Rule, Symptom
from grader.workspace.rules.used_packages import calls_in, named_in_robots, required_by_cmake

_DEPENDENCY = on_use(r"<(?P<tag>\w*depend)(?P<attributes>\s[^<>]*)?>\s*(?P<name>[^<>\s]+)\s*</")
_CONDITION = on_use(r"\bcondition\s*=\s*(?:\"([^\"]*)\"|'([^']*)')")
_GROUP = "group_depend"
_OF_ROS = on_use(r"[a-z][a-z0-9]*+(?:_[a-z0-9]++)++")
_MAX_DIFFERENT = 2  # letters in the length of two similar names
_MAX_FOUND = 40  # packages of a workspace, beyond which others may not be read
# Words of names that say nothing of the robot: my_robot_description.
_OF_TEMPLATES = frozenset({"my", "robot", "ros", "ros2", "bot"})


def provision_facts(workspace: Workspace) -> Facts:
    """Yield the keys that rosdep does not know, and packages that nothing has."""
    for package in workspace.packages:
        manifest = package.manifest
        if manifest and not manifest.refusals and not package.is_of_ros1:
            yield from _unknown_keys(workspace, package)
    yield from _absent_packages(workspace)


def _unknown_keys(workspace: Workspace, package: Package) -> Facts:
    """Yield the dependencies of a package that rosdep cannot install.

    It is a note where the name may be that of a package that is built from source.
    """
    assert package.manifest
    for source in workspace.texts.read_sources(package, (MANIFEST,)):
        if source.path != package.path(MANIFEST):
            continue
        for match in _DEPENDENCY.finditer(source.text):
            name = match["name"]
            condition = _CONDITION.search(match["attributes"] or "")
            is_left_out = match["tag"] == _GROUP or name not in package.manifest.dependencies
            if condition:
                held = evaluate_condition(condition[1] or condition[2])
                is_left_out = is_left_out or held is not True
            if is_left_out or package.find(name):
                continue
            yield Compared("keys")
            wrong = _wrong_key(workspace, name, source.at(match.start("name")))
            if wrong:
                yield wrong


_ROSDEP_KEY = Rule(
    "rosdep-key",
    "keys",
    NO_KEY,
    "rosdep knows the dependencies in package.xml that the workspace does not have.",
    why=(
        "rosdep install stops with 'Cannot locate rosdep definition' and installs none of the "
        "dependencies, which also stops a build in CI."
    ),
    symptoms=(
        Symptom(
            "rosdep-key",
            pattern=r"Cannot locate rosdep definition for \[(?P<key>[\w.+-]{1,200}+)\]",
            source="ros-infrastructure/rosdep 2685b28, src/rosdep2/lookup.py:474",
            sentence="rosdep knows no such name.",
            example="cell: Cannot locate rosdep definition for [numpy]",
            within=("key",),
        ),
    ),
    wrong="<exec_depend>pyserial</exec_depend>",
    right="<exec_depend>python3-serial</exec_depend>",
    frame="python/package.xml",
)


def _wrong_key(workspace: Workspace, name: str, at: Location) -> Mismatch | None:
    """Return what is wrong with a dependency that the workspace does not have."""
    if name in rosdep_keys() or workspace.texts.is_provided(name):
        return None
    if is_released(name):
        return _of_other_release(workspace, name, at)
    no_key = f"rosdep has no key {quoted(name)}"
    words = rosdep_words()
    if name in words.elsewhere:
        message = f"{no_key}: delete the line; {words.elsewhere[name]}"
        return Mismatch(_ROSDEP_KEY, message, at, word=name)
    own_names = workspace.own_packages
    charge_guess(workspace, own_names)
    meant = words.instead.get(name) or near(name, own_names) or _near_key(workspace, name)
    if meant is not None:
        wrong = Mismatch(_ROSDEP_KEY, f"{no_key}, so rosdep install stops", at, word=name)
        return wrong.meaning(name, meant).offering(name, meant)
    if _is_of_project(name, own_names):
        return None
    message = (
        f"{no_key}, and neither the workspace nor a release of ROS 2 ({released_date()}) has such "
        "a package: rosdep install stops, unless it is told to skip the name"
    )
    return Mismatch(_ROSDEP_KEY, message, at, is_certain=False, word=name)


def _is_of_project(name: str, others: Iterable[str]) -> bool:
    """Return whether a name begins as that of a package of the workspace: arm_msgs and arm_driver.

    Such a package is one of the same project, of which only a part is inspected.
    """
    first = name.partition("_")[0]
    if first in _OF_TEMPLATES:
        first = name.rpartition("_")[0]
    return any(other == first or other.startswith(f"{first}_") for other in others)


def _of_other_release(workspace: Workspace, name: str, at: Location) -> Mismatch | None:
    """Return that only other releases than those of the workspace have a package."""
    stated = workspace.releases
    if not stated or "rolling" in stated or is_released(name, stated):
        return None  # what Rolling lacks, it may have again
    if other_name("package", name, {*stated}):
        return None  # which is said of its own
    having = enumerated([release.title() for release in find_releases(name)])
    wanted = enumerated([release.title() for release in stated], word="or")
    message = (
        f"the package {quoted(name)} is released for {having}, and not for {wanted} "
        f"({released_date()}): rosdep install stops"
    )
    return Mismatch(_ROSDEP_KEY, message, at, is_certain=False, word=name)


def _near_key(workspace: Workspace, name: str) -> str | None:
    """Return the key of rosdep, or the released package, that a name surely stands for.

    Names of apt that have no key are similar to those of other libraries.
    """
    if name.startswith("lib"):
        return None
    first = name[:1].lower()
    alike = []
    for known in chain(rosdep_keys(), released_packages()):
        if known[0] == first and abs(len(known) - len(name)) <= _MAX_DIFFERENT:
            alike.append(known)
    charge_guess(workspace, alike)
    return near(name, alike)


class _NamedPackage(Named):
    """A package that a file names, and where.

    `is_compared` says whether the rule of files compares a similar name.
    """

    name: str
    location: Location
    is_compared: bool = True


def _absent_packages(workspace: Workspace) -> Facts:
    """Yield packages that files name, and that neither the workspace nor a release has.

    Each is yielded once. It is an error where a package of the workspace is called alike, and
    nothing says that the other one exists.
    """
    folder = workspace.folder
    if len(folder.found_packages) >= _MAX_FOUND or folder.tree.ignored:
        return
    declared: set[str] = set()
    for package in folder.found_packages:
        if package.manifest:
            declared |= package.manifest.dependencies
    seen = set()
    for package in workspace.packages:
        for named in _named_by(workspace, package):
            if named.name in seen:
                continue
            seen.add(named.name)
            if not _may_exist(workspace, package, named.name, declared):
                yield from _absent(workspace, named)


def _named_by(workspace: Workspace, package: Package) -> Iterator[_NamedPackage]:
    """Yield the packages that launch files, code and robots of a package name."""
    launched = set()
    for owner, path, launch in workspace.launches.files:
        if owner is package:
            launched.add(package.path(path))
            for node in launch.nodes:
                if not node.included_by and node.location.path == package.path(path):
                    yield _NamedPackage(node.package, node.location)
    texts = workspace.texts
    for source in texts.launch_sources(package):
        if source.path in launched:
            yield from starmap(_NamedPackage, calls_in(source))
    for source in texts.read_sources(package, (".py", ".cpp", ".hpp")):
        if source.path not in launched:
            for name, at in calls_in(source):
                yield _NamedPackage(name, at, is_compared=False)
    yield from starmap(_NamedPackage, named_in_robots(workspace, package))
    yield from _required_by_cmake(package)


def _required_by_cmake(package: Package) -> Iterator[_NamedPackage]:
    """Yield the packages with names as those of ROS 2 that CMake certainly has to find."""
    for required, at in required_by_cmake(package):
        name = required.name
        if required.is_for_tests or is_released(name) or _is_of_rosdep(name):
            continue
        if _OF_ROS.fullmatch(name):
            yield _NamedPackage(name, at, is_compared=False)


def _is_of_rosdep(name: str) -> bool:
    """Return whether a key of rosdep has a name of CMake: nlohmann-json-dev for nlohmann_json."""
    dashed = name.replace("_", "-")
    return any(dashed in key for key in rosdep_keys())


def _may_exist(workspace: Workspace, package: Package, name: str, declared: set[str]) -> bool:
    """Return whether something says that a package exists."""
    if package.find(name) or is_released(name) or name in declared:
        return True
    if name in package.installed_besides or not re.fullmatch(r"[a-z]\w*", name):
        return True
    folders = [last_part(other.folder) for other in workspace.folder.found_packages]
    row = package_row(name)
    if row.programs or row.launch or name in folders or workspace.folder.absent_submodules:
        return True
    if any(other.name == name for other in workspace.folder.found_packages):
        return True  # one that colcon ignores
    try:
        return workspace.texts.is_provided(name, in_words=True)
    except NotDecided:
        return True


_PACKAGE_EXISTS = Rule(
    "package-exists",
    "dependencies",
    NO_PACKAGE,
    "The packages that files name exist: in the workspace, or in a release of ROS 2.",
    why=(
        "Launch files and nodes stop with PackageNotFoundError when they ask for its share "
        "folder, and find_package() stops a build."
    ),
    wrong="""
Node(package='rviz2', executable='rviz2',
     arguments=['-d', os.path.join(get_package_share_directory('my_robot_description'), 'a.rviz')]),
""",
    right="""
Node(package='rviz2', executable='rviz2',
     arguments=['-d', os.path.join(get_package_share_directory('rover'), 'rviz', 'rover.rviz')]),
""",
    beside={
        "../cart_description/package.xml": """
<package format="3">
  <name>cart_description</name>
  <version>1.0.0</version>
  <description>A part of a rover.</description>
  <maintainer email="a@example.com">A</maintainer>
  <license>MIT</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
""",
    },
)


def _absent(workspace: Workspace, named: _NamedPackage) -> Mismatches:
    """Yield that a package is not there, unless the rule of files says it."""
    name = named.name
    at = named.location
    names = workspace.own_packages
    charge_guess(workspace, names)
    meant = near(name, names)
    if meant is not None and named.is_compared:
        return
    meant = meant or _package_meant(name, names)
    if meant is not None:
        wrong = Mismatch(_PACKAGE_EXISTS, f"there is no package {quoted(name)}", at, word=name)
        yield wrong.meaning(name, meant)
        return
    message = (
        f"neither the workspace nor a release of ROS 2 ({released_date()}) has the package "
        f"{quoted(name)}, and no package.xml declares it"
    )
    wrong = Mismatch(_PACKAGE_EXISTS, message, at, is_certain=False, word=name)
    yield wrong.meaning(name, _near_key(workspace, name))


def _package_meant(name: str, names: Iterable[str]) -> str | None:
    """Return the package of the workspace that a name surely means, which is not similar.

    It is the only one with the same last word, as `description`, if it has another word
    of the name, or that has no word of its own, as in my_robot_description.
    """
    *words, kind = name.split("_")
    if not words:
        return None
    alike = [other for other in names if other.rpartition("_")[2] == kind and other != kind]
    own_words = {*words} - _OF_TEMPLATES
    if own_words:
        alike = [other for other in alike if not own_words.isdisjoint(other.split("_"))]
    return alike[0] if len(alike) == 1 else None
