"""Dependencies: the packages that files of a package name, and whether its package.xml declares
them.
"""

import re
from collections.abc import Iterator

from grader.base.names import near
from grader.base.source import Location
from grader.ros.config.yaml_nodes import YamlNode
from grader.ros.config.yaml_values import sections_in
from grader.ros.known.known import known
from grader.ros.package.package import Package
from grader.ros.workspace.names import Compared, Fact, Mismatch, corrections
from grader.ros.workspace.workspace import Workspace

_FIND = re.compile(r"\$\(find ([\w-]+)\)|package://([\w-]+)/")
_OF_ROS = ("rclpy", "tf2_ros")
_IMPORT = re.compile(r"^(?:from|import)\s+(\w+)", re.MULTILINE)


def dependency_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield the packages that a package uses and does not declare."""
    for package in workspace.packages:
        if package.manifest is None or package.manifest.refusals:
            continue
        declared = {*package.manifest.dependencies, *package.names}
        declared |= {name for it in declared for name in known()["metapackages"].get(it, ())}
        others = [package.find(name) for name in declared]
        brought = {
            name
            for it in others
            if it is not None and it.manifest
            for name in it.manifest.dependencies
        }
        used: dict[str, Location] = {}
        for name, at in _used(workspace, package):
            used.setdefault(name, at)
        yield from (Compared("dependencies") for _ in used)
        for name, at in used.items():
            if name not in declared:
                meant, start = near(name, declared), package.manifest.name_location
                guess = f"; did you mean {meant!r}?" if meant is not None else ""
                message = (
                    f"package.xml of {package.name!r} does not declare {name!r}, which is used "
                    f"here{guess}"
                )
                # rosdep installs what packages need that are declared.
                is_sure = name not in brought
                either = corrections(name, at, meant, start if meant not in used else None)
                yield Mismatch("dependencies", message, at, start, is_sure, either)


def _used(workspace: Workspace, package: Package) -> Iterator[tuple[str, Location]]:
    """Yield the packages that are used, and where."""
    for owner, _, launch in workspace.launches:
        if owner is package:
            yield from (
                (node.package, node.location) for node in launch.nodes if not node.included_by
            )
            paths = ((passed.path.split("/"), passed.location) for passed in launch.passed)
            yield from (
                (parts[1], at) for parts, at in paths if parts[0] == "share" and len(parts) > 1
            )
    own = {it.name for it in workspace.packages}
    for source in workspace.sources_of(package, (".xacro", ".urdf")):
        named = (
            (found[1] or found[2], source.at(found.start()))
            for found in _FIND.finditer(source.text)
        )
        # A misspelt own package is a mistake of files.
        yield from (
            (name, at) for name, at in named if near(name, own) is None or package.depends_on(name)
        )
    modules = {part.removesuffix(".py") for path in package.tree.files for part in path.split("/")}
    for source in workspace.sources_of(package, (".py",)):
        for found in _IMPORT.finditer(source.text):
            is_ros = found[1] in own or found[1].endswith("_msgs") or found[1] in _OF_ROS
            if is_ros and found[1] not in modules:
                yield found[1], source.at(found.start(1))
    for tree in (tree for path, tree in workspace.trees if package.holds(path)):
        for _, section in sections_in(tree):
            yield from _controller_packages(section)


def _controller_packages(section: YamlNode) -> Iterator[tuple[str, Location]]:
    """Yield the packages of the controllers that a section of the controller manager names."""
    for inner in section.value.values() if isinstance(section.value, dict) else ():
        kind = inner.get("type")
        if kind is not None and kind.text in known()["controllers"]:
            yield str(kind.text).partition("/")[0], kind.location
