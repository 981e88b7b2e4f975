"""What is wrong in the files of a workspace's packages, each on its own.

It is what stops a build or a launch file, and what is wrong in RViz files.
"""

from collections.abc import Iterator

from grader.base.errors import NotDecided
from grader.base.names import last_part
from grader.base.problems import Problem
from grader.base.source import Location
from grader.base.text import counted
from grader.ros.installation import package_problems as kinds
from grader.ros.installation.places import is_of_one_machine, where_written
from grader.ros.known.releases import releases_with
from grader.ros.launch.launch_model import Launch
from grader.ros.package.found_problems import (
    build_problems,
    launch_problems,
    launch_syntax,
    sorted_problems,
)
from grader.ros.package.installed_files import are_installs_known
from grader.ros.package.package import MANIFEST, Package
from grader.workspace.graph.rviz_ends import list_rviz_files
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.reading import read_agreement

_OF_MISSING_FILES = (kinds.SETUP_STOPS, kinds.EMPTY_GLOB)
_LAUNCH_FOLDER = "launch/"
_COUNTED = (kinds.SETUP_UNKNOWN, kinds.LAUNCH_UNKNOWN)  # and not listed


def _file_problems(workspace: Workspace) -> Iterator[Problem]:
    """Yield what is wrong in package.xml, setup.py, CMakeLists.txt, launch and RViz files."""
    yield from _build_problems(workspace)
    yield from _launch_problems(workspace)
    yield from _uninstalled_launch_files(workspace)
    for package, paths in workspace.launches.of_ros1:
        files = counted(len(paths), "launch file")
        message = f"the package has {files} of ROS 1, which ros2 launch does not read"
        yield Problem(kinds.OF_ROS1, message, Location(package.path(paths[0]), 1, 1))
    for file in list_rviz_files(workspace):
        seen = set()  # of displays of another release, only the first is said
        for problem in sorted_problems(file.problems):
            if problem.kind is not kinds.ROS1_CLASS or problem.kind not in seen:
                seen.add(problem.kind)
                yield problem


def _launch_problems(workspace: Workspace) -> Iterator[Problem]:
    """Yield what is wrong in launch files, but for programs that do not exist.

    A missing program is also a name that does not agree.
    """
    roots = {launch.source.path for launch in workspace.launches.outermost}
    mismatches = read_agreement(workspace).mismatches
    wrong_programs = {each.location for each in mismatches if each.family == "programs"}
    for _, path, launch in workspace.launches.files:
        if launch.syntax:
            yield launch_syntax(launch, launch.syntax)
        is_root = launch.source.path in roots
        hard_coded = set()  # where paths of one machine are written
        for problem in launch_problems(_started(workspace, path, launch)) if is_root else ():
            if problem.kind is kinds.HARD_CODED:
                place = _where_written(launch, problem.location)
                if place and place in hard_coded:
                    continue  # several files of one folder
                if place:
                    hard_coded.add(place)
                    problem = problem._replace(location=place, around=problem.location)  # noqa: PLW2901
            if problem.location not in wrong_programs:
                yield problem


def _where_written(launch: Launch, at: Location) -> Location | None:
    """Return where a launch file writes the path that it names at a place, or its beginning."""
    source = launch.source
    named = [reference.path or "" for reference in launch.references if reference.location == at]
    path = next(filter(is_of_one_machine, named), "")
    return where_written(source, path) if at.path == source.path else None


def _uninstalled_launch_files(workspace: Workspace) -> Iterator[Problem]:
    """Yield the packages with a folder launch of which a build installs no file."""
    for package in workspace.packages:
        files = []
        for path in package.launch_files:
            name = path.removeprefix(_LAUNCH_FOLDER)
            if name != path and "launch" in name:
                files.append(path)
        setup = package.installation
        is_module = f"{_LAUNCH_FOLDER}__init__.py" in package.tree.files
        if not files or is_module or not setup or not are_installs_known(package):
            continue
        if setup.stops:  # such as a file of this folder that is not there
            continue
        if not {*package.installed.values()}.isdisjoint(files):
            continue
        name = files[0].removeprefix(_LAUNCH_FOLDER)
        message = f"ros2 launch does not find {name}: no {setup.entry} names the folder launch"
        place = Location(package.path(files[0]), 1, 1)
        yield Problem(kinds.NO_LAUNCH_FILES, message, place)


def _build_problems(workspace: Workspace) -> Iterator[Problem]:
    """Yield what stops a build, unless it needs what git has not fetched."""
    for package in workspace.packages:
        lacks_submodule = any(map(package.holds, workspace.folder.absent_submodules))
        for problem in build_problems(package, workspace.releases):
            if not (lacks_submodule and problem.kind in _OF_MISSING_FILES):
                yield problem


def listed_problems(workspace: Workspace) -> list[Problem]:
    """Return what is wrong in the files, each once.

    What is not evaluated is only counted.
    """
    return [
        problem
        for problem in dict.fromkeys(_file_problems(workspace))
        if problem.kind not in _COUNTED
    ]


def ros1_problem(package: Package) -> Problem:
    """Return the note that a package is not one of ROS 2."""
    message = f"the package {package.name!r} is one of ROS 1, and is not compared with others"
    return Problem(kinds.OF_ROS1, message, Location(package.path(MANIFEST), 1, 1))


def _started(workspace: Workspace, path: str, launch: Launch) -> Launch:
    """Return a launch file that no other one surely includes, without some faults.

    These are the faults that its caller may correct, and those of arguments that a stated release
    has. Who starts the file gives it values, and a file that may include it declares arguments.
    """
    is_closed = not _may_be_included(workspace, last_part(path), launch)
    faults = []
    for fault in launch.in_releases(workspace.releases).faults:
        having = releases_with("argument", fault.argument) if fault.argument else ()
        if any(release in having for release in workspace.releases):
            continue
        if fault.lacks == "" or (fault.lacks == "declaration" and is_closed):
            faults.append(fault)
    return launch._replace(faults=tuple(faults), syntax=None)


def _may_be_included(workspace: Workspace, name: str, launch: Launch) -> bool:
    """Return whether a text names a launch file, or a launch file is not known as a whole."""
    try:
        count = sum(name in text for text in workspace.texts.searched_launch_texts())
    except NotDecided:
        return True
    if count > (name in launch.source.text):
        return True
    for other in workspace.launches.every:
        if not all(unknown.follows_error for unknown in other.unknown):
            return True
    return False
