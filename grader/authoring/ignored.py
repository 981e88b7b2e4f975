"""Mutants that no check can distinguish from the reference, for the rubric to declare with the reason."""

import re
from collections.abc import Iterator
from typing import NamedTuple

from grader.checks.measures.fact import Solution


class IgnoredMutants(NamedTuple):
    """Patterns of mutants that may keep full marks, and why."""

    patterns: list[str]
    reason: str


_TEMPLATE = "These entries of data_files are those of the template; the criteria are about files that ROS 2 opens."
_MODULES = "No check is about the Python modules of the package, or about where its programs are installed."
_CONDITION = "The launch file starts this node only with other arguments than the defaults."
_FOLDER = "ros2 launch finds a launch file in any folder of the installed package."


def ignored_mutants(solution: Solution) -> Iterator[IgnoredMutants]:
    """Yield what a rubric of all facts of a solution ignores nevertheless."""
    package = solution.submission.package
    if package is None:
        return
    for path in package.launch_files:
        names = dict.fromkeys(node.executable for node in package.launch(path).nodes if node.when is False)
        if names:
            yield IgnoredMutants([f"* {path} *{name}*" for name in names], _CONDITION)
    if package.is_cmake:
        return
    modules = [path for path in package.tree.files if path.endswith("/__init__.py") or path == "setup.cfg"]
    if modules:
        yield IgnoredMutants([f"file *: {path}" for path in modules], _MODULES)
    if any(path.startswith("share/ament_index/") for path in package.installed):
        yield IgnoredMutants(["* setup.py *share/ament_index/*", "* setup.py *package.xml*"], _TEMPLATE)
    if package.setup is not None and re.search(r"""["']launch["']""", package.setup.source.text):
        yield IgnoredMutants(["string misspelt: setup.py launch*"], _FOLDER)
