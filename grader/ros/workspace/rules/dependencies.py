"""Dependencies: the packages that a package's files name, and whether it declares them.

They are declared in its package.xml.
"""

import re
from collections.abc import Collection, Iterator, Mapping

from grader.base.names import near
from grader.base.source import Location
from grader.ros.config.yaml_nodes import YamlNode
from grader.ros.config.yaml_values import sections_in
from grader.ros.installation.manifest import Manifest
from grader.ros.known.package_rows import controller_row, is_known_controller, package_row
from grader.ros.known.released import is_released, packages_brought_by
from grader.ros.launch.launch_model import Launch
from grader.ros.package.package import Package
from grader.ros.workspace.model.workspace import Workspace
from grader.ros.workspace.rules.names import Compared, Fact, Mismatch, corrections, cost_of_guess
from grader.ros.workspace.rules.rule_table import (
    DEPENDENCY_DECLARED,
)

_FIND = re.compile(r"\$\(find ([\w-]+)\)|package://([\w-]+)/")
_OF_ROS = ("rclpy", "tf2_ros")
_XACRO = "xacro"
_RUNTIME = "rosidl_default_runtime"  # what generated interfaces need
_IMPORT = re.compile(r"^(?:from|import)\s+(\w+)", re.MULTILINE)


def dependency_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield the packages that a package uses and does not declare."""
    for package in workspace.packages:
        if package.manifest is None or package.manifest.refusals:
            continue
        used: dict[str, Location] = {}
        for name, at in _used(workspace, package):
            # What a launch file of another package starts, that package has to declare.
            if name not in used and package.holds(at.path):
                used[name] = at
                yield Compared("dependencies")
        yield from _undeclared(workspace, package, package.manifest, used)


def _undeclared(
    workspace: Workspace, package: Package, manifest: Manifest, used: Mapping[str, Location]
) -> Iterator[Mismatch]:
    """Yield the packages that are used and that package.xml does not declare.

    Those that packages of the workspace bring, which are declared, rosdep installs.
    """
    declared = _declared(package)
    brought: dict[str, str] = {}  # what each is brought by
    for name in sorted(declared):
        dependency = package.find(name)
        if dependency is not None and dependency.manifest:
            for inner in dependency.manifest.dependencies:
                brought.setdefault(inner, name)
    start = manifest.name_location
    for name, at in used.items():
        if name in declared:
            continue
        workspace.charge(cost_of_guess(len(declared)))
        meant = near(name, declared)
        if meant is not None and _is_there(package, name) and _is_there(package, meant):
            meant = None  # another package
        misplaced = manifest.misplaced.get(name)
        guess = ""
        if misplaced is not None:
            guess = f": <export> has it (line {misplaced.line}), where it has no effect"
        elif meant is not None:
            guess = f"; did you mean {meant!r}?"
        message = (
            f"package.xml of {package.name!r} does not declare {name!r}, which is used here{guess}"
        )
        is_certain = name not in brought
        if not is_certain:
            message = (
                f"package.xml of {package.name!r} does not declare {name!r}, which only "
                f"{brought[name]!r} brings: the package builds and runs as long as that needs it"
            )
        either = corrections(name, at, meant, start if meant not in used else None)
        lacked = name if not guess else ""
        yield Mismatch(
            DEPENDENCY_DECLARED, message, at, start, is_certain, either, word=name, lacked=lacked
        )


def _is_there(package: Package, name: str) -> bool:
    """Return whether the workspace or a release has a package."""
    return package.find(name) is not None or is_released(name)


def _declared(package: Package) -> set[str]:
    """Return the dependencies of a package, those that its metapackages bring, and the package."""
    assert package.manifest is not None
    declared = {*package.manifest.dependencies, *package.names}
    for name in [*declared]:
        declared.update(package_row(name).members, packages_brought_by(name))
    return declared


def _used(workspace: Workspace, package: Package) -> Iterator[tuple[str, Location]]:
    """Yield the packages that are used, and where."""
    for owner, _, launch in workspace.launches.files:
        if owner is package:
            yield from _launched(launch)
    generated_at = workspace.code.interfaces[package.name].location
    if generated_at is not None:
        yield _RUNTIME, generated_at
    names = {other.name for other in workspace.packages}
    yield from _found_by_xacro(workspace, package, names)
    yield from _imported(workspace, package, names)
    for path, tree in workspace.installed.trees:
        if package.holds(path):
            for _, section in sections_in(tree):
                yield from _controller_packages(section)


def _found_by_xacro(
    workspace: Workspace, package: Package, names: Collection[str]
) -> Iterator[tuple[str, Location]]:
    """Yield the packages of paths in URDF and xacro. A misspelt own one is a mistake of files."""
    for source in workspace.texts.sources_of(package, (".xacro", ".urdf")):
        for match in _FIND.finditer(source.text):
            name = match[1] or match[2]
            workspace.charge(cost_of_guess(len(names)))
            if name in names or package.depends_on(name) or near(name, names) is None:
                yield name, source.at(match.start())


def _launched(launch: Launch) -> Iterator[tuple[str, Location]]:
    """Yield the packages whose programs or launch files a launch file starts.

    Among them is xacro, where it prints a robot.
    """
    included = {passed.location for passed in launch.passed}  # of whose nodes these are the places
    for node in launch.nodes:
        if not node.included_by and node.location not in included:
            yield node.package, node.location
    for reference in launch.references:
        if reference.by == _XACRO:
            yield _XACRO, reference.location
    for passed in launch.passed:
        folder, _, inside = passed.path.partition("/")
        if folder == "share" and inside:
            yield inside.partition("/")[0], passed.location


def _imported(
    workspace: Workspace, package: Package, names: Collection[str]
) -> Iterator[tuple[str, Location]]:
    """Yield the packages of ROS 2 or of the workspace that the Python files of a package import."""
    modules = set()  # of the package, as far as their names say
    for path in package.tree.files:
        modules |= {part.removesuffix(".py") for part in path.split("/")}
    for source in workspace.texts.sources_of(package, (".py",)):
        for match in _IMPORT.finditer(source.text):
            name = match[1]
            is_ros = name in names or name.endswith("_msgs") or name in _OF_ROS
            if is_ros and name not in modules:
                yield name, source.at(match.start(1))


def _controller_packages(section: YamlNode) -> Iterator[tuple[str, Location]]:
    """Yield the packages of the controllers that a section of the controller manager names."""
    for inner in section.value.values() if isinstance(section.value, dict) else ():
        kind = inner.get("type")
        if kind is not None and is_known_controller(kind.text):
            own_package = str(kind.text).partition("/")[0]
            yield controller_row(kind.text).package or own_package, kind.location
