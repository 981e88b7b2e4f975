"""Checks of a package and of the files that its setup.py installs. Nothing is built and nothing is run."""

from typing import TYPE_CHECKING

from grader.checks.check import About
from grader.checks.outcome import Outcome, failed, judged
from grader.errors import MissingElement, NotDecided
from grader.package.package import MANIFEST, RESOURCE_INDEX, SETUP, Package
from grader.submission.submission import Submission
from grader.text import enumerated

if TYPE_CHECKING:
    from grader.package.manifest import Manifest


# What the edits for hints may change.
ABOUT = {
    "package_found": About((MANIFEST, SETUP)),
    "package_type": About((MANIFEST,)),
}


def package_found(submission: Submission, *, name: str) -> Outcome:
    """The submission has a ROS 2 package of this name.

    Args:
        name: The name that package.xml should give it.
    """
    package = submission.needed_package()
    manifest = _readable_manifest(package)
    if manifest.name is None:
        problem = manifest.problems[0]
        return failed(problem.message, problem.location)
    fine = manifest.name == name
    message = f"the package is named {manifest.name!r}{'' if fine else f'; it should be named {name!r}'}"
    setup, registered = package.setup, package.registered
    if fine and setup is not None and registered and name not in registered:
        # ament_index finds a package by its marker. colcon adds one for the name in package.xml, but no file goes below
        # that name.
        others = enumerated([repr(other) for other in registered])
        message = f"package.xml names the package {name!r}, but setup.py registers it as {others}"
        at = next(copy.at for copy in setup.copies if copy.target.startswith(RESOURCE_INDEX))
        return failed(message, setup.location(at))
    return judged(fine, message, manifest.name, name, at=manifest.name_location)


def package_type(package: Package, *, build_type: str) -> Outcome:
    """The package is of a build type, such as ament_python.

    Args:
        build_type: The build type, such as ament_python.
    """
    manifest = _readable_manifest(package)
    actual = manifest.build_type
    fine = actual == build_type
    message = f"the build type is {actual!r}" if actual else "<build_type> in package.xml is empty"
    if not fine:
        # REP 149: a package.xml without build_type means catkin.
        message += " (ROS 1; also the default without <build_type>)" if actual == "catkin" else ""
        message += f"; it should be {build_type!r}"
    return judged(fine, message, actual, build_type, at=manifest.type_location)


def _readable_manifest(package: Package) -> "Manifest":
    manifest = package.manifest
    if manifest is not None and manifest.unread:
        raise NotDecided(manifest.unread, "package.xml cannot be read")
    from grader.package.problem_kinds import BAD_MANIFEST

    if manifest is None:
        where = f"the folder {package.folder!r}" if package.folder else "the submission"
        message = f"{where} has a setup.py, but no package.xml, so it is not a ROS 2 package"
        raise MissingElement(MANIFEST, package.folder, message=message)
    if any(problem.kind is BAD_MANIFEST for problem in manifest.problems):
        problem = manifest.problems[0]
        raise MissingElement(MANIFEST, package.folder, message=problem.message, location=problem.location)
    return manifest
