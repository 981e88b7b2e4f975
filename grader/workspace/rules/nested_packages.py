"""Packages in the folder of another package, where colcon does not look for them."""

from collections.abc import Iterator

from grader.base.source import Location
from grader.ros.package.finding import IGNORING
from grader.ros.package.package import MANIFEST
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import Compared, Fact, warning
from grader.workspace.rules.rule_table import PACKAGE_NESTED
from grader.workspace.rules.used_packages import OF_TESTS


def nested_package_facts(workspace: Workspace) -> Iterator[Fact]:
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
                yield warning(PACKAGE_NESTED, message, Location(path, 1, 1))
