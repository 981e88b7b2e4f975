"""Checks of a package: its manifest, whether a build of it succeeds, and what that installs.

Nothing is run.
"""

from fnmatch import fnmatch

from grader.base.errors import MissingElement
from grader.base.source import Location
from grader.base.text import enumerated
from grader.lab.checks.check import About
from grader.lab.checks.installed_files import (
    INSTALLING,
    FileKind,
    build_error,
    files_of_kind,
    require_installed,
)
from grader.lab.checks.outcome import Outcome, failed, judged, passed
from grader.lab.submission.submission import Submission
from grader.ros.package.package import CMAKE, MANIFEST, RESOURCE_INDEX, SETUP, Package

ABOUT = {
    "package_found": About(
        (MANIFEST, SETUP), causes={"refused": "the tools of ROS 2 refuse package.xml"}
    ),
    "package_type": About((MANIFEST,)),
    "build_installs": About((SETUP, "file"), causes=INSTALLING),
    "setup_imports": About(
        (SETUP,),
        causes={
            "name": "a name in setup.py is not defined or imported",
            "files": "a file or folder that is listed does not exist, or is of another kind",
        },
    ),
    "installs_files": About((SETUP, "file"), causes=INSTALLING),
}
# The file that colcon needs for a build type.
_BUILT_BY = {"ament_python": SETUP, "ament_cmake": CMAKE, "cmake": CMAKE}


def package_found(submission: Submission, *, name: str) -> Outcome:
    """The submission has a ROS 2 package of this name.

    Args:
        name: The name that package.xml should give it.
    """
    package = submission.needed_package()
    manifest = package.needed_manifest()
    fine = manifest.name == name
    if manifest.refusals and (fine or manifest.name is None):
        problem = manifest.refusals[0]
        count = len(manifest.refusals)
        more = f" (and {count - 1} more)" if count > 1 else ""
        return failed(
            problem.message + more, problem.location, problem=problem.message, cause="refused"
        )
    message = f"the package is named {manifest.name!r}; it should be named {name!r}"
    if fine:
        message = f"the package is valid and named {name!r}"
    setup = package.installation
    registered = package.registered
    if fine and setup and registered and name not in registered:
        # ament_index finds a package by its marker. colcon adds one for the name in package.xml,
        # but no file goes below that name.
        others = enumerated(map(repr, registered))
        message = f"package.xml names the package {name!r}, but setup.py registers it as {others}"
        at = next(copy.at for copy in setup.copies if copy.target.startswith(RESOURCE_INDEX))
        return failed(message, setup.location(at))
    return judged(fine, message, manifest.name, name, at=manifest.name_location)


def package_type(package: Package, *, build_type: str = "") -> Outcome:
    """The package is of a build type, such as ament_python.

    Args:
        build_type: The build type, such as ament_python; default: one whose file the package has,
            setup.py or CMakeLists.txt.
    """
    manifest = package.needed_manifest()
    actual = manifest.build_type
    if not build_type:
        fitting = [kind for kind, name in _BUILT_BY.items() if name in package.tree.files]
        build_type = actual if actual in fitting else next(iter(fitting), "ament_cmake")
    fine = actual == build_type
    message = f"the build type is {actual!r}" if actual else "<build_type> in package.xml is empty"
    if not fine:
        # REP 149: a package.xml without build_type means catkin.
        message += " (ROS 1; also the default without <build_type>)" if actual == "catkin" else ""
        message += f"; it should be {build_type!r}"
    return judged(fine, message, actual, build_type, at=manifest.type_location)


def build_installs(
    package: Package,
    submission: Submission,
    *,
    kind: FileKind,
    name: str,
    despite_errors: bool = False,
) -> Outcome:
    """A build of the package installs its URDF, launch file or RViz file, below share/<package>.

    setup.py or CMakeLists.txt is evaluated statically; what cannot be determined needs manual
    grading.

    Args:
        kind: The kind of the file.
        name: The file's name, which decides if the package has several files of the kind.
        despite_errors: Whether an error that stops the build is ignored, which `setup_imports`
            reports.
    """
    files = files_of_kind(package, kind, name)
    graded = submission.path
    if kind == "urdf" and graded is not None and package.holds(graded):  # whatever its name ends in
        files = [graded.removeprefix(package.path("")), *files]
    if not files:
        raise package.missing(kind)
    return require_installed(package, files, kind, despite_errors=despite_errors)


def installs_files(package: Package, *, files: list[str], despite_errors: bool = False) -> Outcome:
    """A build of the package installs at least one file that matches these patterns, below
    share/<package>.

    Args:
        files: Patterns for paths in the package, such as "meshes/*.stl"; one installed file is
            enough.
        despite_errors: Whether an error that stops the build is ignored, which `setup_imports`
            reports.
    """

    def is_wanted(path: str) -> bool:
        return any(fnmatch(path, pattern) for pattern in files)

    matching = list(filter(is_wanted, package.tree.files))
    if not matching:
        patterns = enumerated(map(repr, files), word="or")
        raise MissingElement(
            "file", files[0], message=f"the package has no file that matches {patterns}"
        )
    return require_installed(package, matching, None, despite_errors=despite_errors)


def setup_imports(package: Package, *, where_there: bool = False) -> Outcome:
    """A build of the package succeeds: Python runs `setup.py`, or CMake `CMakeLists.txt`,
    without an error.

    Args:
        where_there: Whether what is to be installed and does not exist is no error, for `carried`.
    """
    setup = package.needed_installation()
    if package.copies:
        place = Location(f"{package.copies[0]}/{MANIFEST}", 1, 1)
        return failed(package.copies_text, place, problem=package.copies_text)
    return build_error(package, where_there=where_there) or passed(f"{setup.file} builds")
