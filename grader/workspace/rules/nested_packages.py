"""Packages that colcon does not find: in the folder of another one, or without a package.xml."""

import re

from grader.base.names import last_part
from grader.base.patterns import on_use
from grader.base.source import Location
from grader.files.tree import parents
from grader.ros.package.finding import IGNORING
from grader.ros.package.package import MANIFEST
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    Mismatches,
    warning,
)
from grader.workspace.rules.rule_table import (
    NO_BUILD,
    NOT_BUILT,
    Rule,
)
from grader.workspace.rules.used_packages import OF_TESTS

_MAX_BYTES = 200_000  # of a CMakeLists.txt or setup.py
# What only a package of ROS 2 has.
_BUILDS_PACKAGE = on_use(
    r"^[ \t]*+ament_package\s*+\(|['\"]share/ament_index/resource_index/packages['\"]",
    re.MULTILINE,
)

_PACKAGE_NESTED = Rule(
    "package-nested",
    "builds",
    NOT_BUILT,
    "No package is below the folder of another one, where colcon does not look.",
    why=(
        "colcon does not search below a package. The inner one is not built, and ros2 launch "
        "reports that the package is not found."
    ),
    wrong="set(CMAKE_CXX_STANDARD 17)",
    right="add_subdirectory(arm)",
    frame="CMakeLists.txt",
    beside={
        "package.xml": "",
        "../rover/arm/CMakeLists.txt": "project(arm)",
        "../rover/arm/package.xml": """
<package format="3">
  <name>arm</name>
  <version>1.0.0</version>
  <description>A part of a rover.</description>
  <maintainer email="a@example.com">A</maintainer>
  <license>MIT</license>
</package>
""",
    },
    at="rover/arm/package.xml",
)


def nested_package_facts(workspace: Workspace) -> Facts:
    """Yield the packages that are below another one: colcon does not search the folder of one.

    Those for tests, those that colcon is told to ignore, and those that CMakeLists.txt of the other
    one names may be there on purpose.
    """
    for package in workspace.packages:
        yield Compared("builds")
        setup = package.installation
        for folder in package.inner:
            is_named = setup is not None and folder.rstrip("/") in setup.source.text
            markers = [package.path(f"{folder}{name}") for name in IGNORING]
            is_ignored = any(marker in workspace.tree.files for marker in markers)
            path = package.path(f"{folder}{MANIFEST}")
            is_left_out = is_named or is_ignored or OF_TESTS.search(folder)
            if path in workspace.tree.files and not is_left_out:
                message = (
                    f"the package in {folder} is in the folder of the package {package.name!r}, "
                    "where colcon does not look: it is not built; put it beside the other one"
                )
                yield warning(_PACKAGE_NESTED, message, Location(path, 1, 1))
    yield from _without_manifest(workspace)


_PACKAGE_MANIFEST = Rule(
    "package-manifest",
    "builds",
    NO_BUILD,
    "A package of ROS 2 has a package.xml.",
    why=(
        "colcon finds packages of ROS 2 by their package.xml. It builds the folder as a project of "
        "plain CMake or Python, or not at all, and ros2 launch does not find the package."
    ),
    wrong="ament_package()",
    right="# ament_package()",
    frame="../parts/CMakeLists.txt",
    at="parts/CMakeLists.txt",
)


def _without_manifest(workspace: Workspace) -> Mismatches:
    """Yield the folders that build a package of ROS 2 and have no package.xml.

    Those below a package, and those that colcon is told to ignore, are not among them.
    """
    files = workspace.tree.files
    if not workspace.packages:
        return
    for path, file in files.items():
        if last_part(path) not in ("CMakeLists.txt", "setup.py"):
            continue
        folders = ["", *(f"{folder}/" for folder in parents(path))]
        known = {f"{folder}{name}" for folder in folders for name in (MANIFEST, *IGNORING)}
        data = file.read(_MAX_BYTES, first=True) if known.isdisjoint(files) else None
        if data and _BUILDS_PACKAGE.search(data.decode("utf-8", "replace")):
            message = "there is no package.xml next to this file, so colcon builds no ROS 2 package"
            yield warning(_PACKAGE_MANIFEST, message, Location(path, 1, 1))
