"""Mutants of the reference that no check can tell from it, for the rubric to declare with the reason."""

from collections.abc import Iterator
from typing import NamedTuple

from grader.authoring.solution import Solution
from grader.package.package import Package
from grader.robot.model import Mesh


class Ignored(NamedTuple):
    """Patterns of mutants that may keep full marks, and why."""

    patterns: list[str]
    reason: str


_NEGATIVE = "ROS 2 loads a negative size; the checks of shapes compare its amount."
_TEMPLATE = "These entries of data_files are those of the template; the criteria are about files that ROS 2 opens."
_MODULES = "No check is about the Python modules of the package, or about where its programs are installed."


def ignored_mutants(solution: Solution) -> Iterator[Ignored]:
    """Yield what a rubric of all facts of a solution ignores nevertheless."""
    of_visuals = [visual.geometry for link in solution.links for visual in link.visuals]
    of_collisions = [collision.geometry for link in solution.links for collision in link.collisions]
    shapes = [shape for shape in (*of_visuals, *of_collisions) if not isinstance(shape, Mesh)]
    if shapes:
        kinds = sorted({type(shape).__name__.lower() for shape in shapes})
        yield Ignored([f"number negated: link */geometry/{kind} *" for kind in kinds], _NEGATIVE)
    package = solution.submission.package
    if package is not None and not package.is_cmake:
        yield from _of_package(package)


def _of_package(package: Package) -> Iterator[Ignored]:
    modules = [path for path in package.tree.files if path.endswith("/__init__.py") or path == "setup.cfg"]
    if modules:
        yield Ignored([f"file *: {path}" for path in modules], _MODULES)
    if any(path.startswith("share/ament_index/") for path in package.installed):
        yield Ignored(["* setup.py *share/ament_index/*", "* setup.py *package.xml*"], _TEMPLATE)
