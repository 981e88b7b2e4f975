"""Packages in the folder of another package, where colcon does not look for them."""

from grader.base.source import Location
from grader.ros.package.finding import IGNORING
from grader.ros.package.package import MANIFEST
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    warning,
)
from grader.workspace.rules.rule_table import (
    NOT_BUILT,
    Rule,
)
from grader.workspace.rules.used_packages import OF_TESTS

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
