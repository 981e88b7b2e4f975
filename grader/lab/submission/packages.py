"""The graded package of a submission, and the reasons against the others."""

from collections.abc import Sequence

from grader.base.text import (
    MAX_NAMED,
    enumerated,
    quoted,
)
from grader.ros.package.finding import (
    is_backup,
    missing_files,
    renewed_packages,
)
from grader.ros.package.package import NO_PACKAGE, Package

DEEPER = "it matches equally well, but is deeper in the folders"
LATER = "it matches equally well, but comes later in alphabetical order"
BACKUP = "it is named like a backup"
_Packages = tuple[Package, ...]


def with_preferred(packages: Sequence[Package], preferred: Package) -> _Packages:
    """Return the packages, renewed, with a table in which `preferred` is the one of its name.

    Of several packages of one name, ROS 2 would find the first in the environment; for the files
    of a robot, its own package is meant.
    """
    renewed = renewed_packages(packages, preferred.work)
    best = renewed[preferred]
    best.packages[best.name] = best
    return tuple(renewed.values())


def why_none(packages: _Packages, elsewhere: _Packages, name: str) -> tuple[str, str]:
    """Return why none of these packages has this name, and which there are.

    Nor has one `elsewhere`, outside of the lab.
    """
    names = [
        f"{quoted(package.name)} in {package.folder or 'the submission'}"
        for package in packages or elsewhere
    ]
    there = f"; there {'are' if len(names) > 1 else 'is'} {enumerated(names, MAX_NAMED)}"
    if packages:
        for package in packages:
            if package.manifest and package.manifest.refusals:
                problem = package.manifest.refusals[0]
                place = f"line {problem.location.line} of {problem.location.path}"
                there += f"; {problem.message} ({place})"
                break
        return f"no package is named {name!r}, and none contains the graded URDF", there
    if names:
        return "no package was submitted for this lab", there
    return NO_PACKAGE, ""


def why_not(graded: Package | None, other: Package, urdf: str) -> str:
    """Return why another package than this one is graded, or none."""
    if not graded:
        return f"the package {other.name!r} has another name, and does not contain the graded URDF"
    if other.name != graded.name:
        return f"the package {graded.name!r} is graded, not {other.name!r}"
    if is_backup(other.folder) and not is_backup(graded.folder):
        return BACKUP
    if missing_files(other, urdf) != missing_files(graded, urdf):
        return "the package that is graded has more of the files that the lab asks for"
    if other.folder.count("/") != graded.folder.count("/"):
        return DEEPER
    return LATER
