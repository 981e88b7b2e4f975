"""Names of other releases of ROS 2 than those that a workspace is for."""

import re
from collections.abc import Iterator

from grader.base.problems import Problem
from grader.base.source import Location
from grader.ros.config.yaml_values import sections_in, values_in
from grader.ros.known.releases import RELEASES, NameKind, Release, other_name
from grader.ros.workspace.controllers import defined_controllers
from grader.ros.workspace.name_problems import OTHER_RELEASE, name_problems
from grader.ros.workspace.names import Agreement
from grader.ros.workspace.reading import read_agreement
from grader.ros.workspace.workspace import Workspace

_DISTRO = "ROS_DISTRO"
_DEPENDENCY = re.compile(r"<\w*depend>\s*([\w-]+)\s*</")
_PLUGIN_KEYS = ("plugin", "robot_model_type")


def compared_names(workspace: Workspace) -> Iterator[Problem]:
    """Yield what is wrong with the names of a workspace: those that do not agree, then those of
    other releases.
    """
    agreement = read_agreement(workspace)
    yield from name_problems(agreement)
    yield from _release_problems(workspace, agreement)


def _release_problems(workspace: Workspace, agreement: Agreement) -> list[Problem]:
    """Return the names that no stated release has, each once in a file; without those that are said
    not to agree.
    """
    if not workspace.releases:
        return []
    said = {it.location for it in agreement.mismatches if it.family != "dependencies"}
    found: dict[tuple[str, str], Problem] = {}
    uses = (*_uses_in_yaml(workspace), *_uses_in_launch_files(workspace), *_declared(workspace))
    for kind, name, at, owner in uses:
        # A file such as humble/nav2.yaml is for this release as well.
        releases = {*workspace.releases, *_named_releases(at.path)}
        other = other_name(kind, name, releases, shown=owner)
        if other is not None and at not in said:
            problem = Problem(OTHER_RELEASE, other.message, at, kind)
            found.setdefault((other.message, at.path), problem)
    return sorted(
        found.values(), key=lambda it: (it.location.path, it.location.line, it.location.column)
    )


def _named_releases(path: str) -> Iterator[Release]:
    words = re.split("[^a-z]+", path.lower())
    yield from (release for release in RELEASES if release in words)


_Use = tuple[NameKind, str, Location, str]  # with the start of the name that is not shown


def _uses_in_yaml(workspace: Workspace) -> Iterator[_Use]:
    """Yield the plugins, controllers and parameters in YAML files."""
    types: dict[str, str] = {}
    for controller in defined_controllers(workspace):
        types[controller.name] = controller.type.text or ""
        if not workspace.has_plugin(types[controller.name]):
            yield "controller", types[controller.name], controller.location, ""
    for _, tree in workspace.trees:
        for value in values_in(tree):
            if value.keys[-1:] and value.keys[-1] in _PLUGIN_KEYS:
                yield "plugin", value.node.text or "", value.node.location, ""
        for keys, section in sections_in(tree):
            name = keys[-1].rpartition("/")[2] if keys else ""
            owner = f"{types.get(name, name)}/"
            for value in values_in(section):
                yield "parameter", owner + ".".join(value.keys), value.node.location, owner


def _uses_in_launch_files(workspace: Workspace) -> Iterator[_Use]:
    """Yield the packages, programs, launch files and topics of controllers in launch files, but for
    those that decide by the release.
    """
    types = {it.name: it.type.text or "" for it in defined_controllers(workspace)}
    launches = [(it[0], it[2]) for it in workspace.launches if _DISTRO not in it[2].source.text]
    paths = {launch.source.path for _, launch in launches}
    for package, node in workspace.nodes:
        if node.location.path not in paths:
            continue
        if package.find(node.package) is None:
            yield "package", node.package, node.location, ""
            owner = f"{node.package}/"
            yield "program", f"{owner}{node.executable}", node.location, owner
        for names in node.remaps or ():
            for topic in names:
                controller, _, last = topic.strip("/").rpartition("/")
                owner = f"{types.get(controller.rpartition('/')[2], '')}/"
                yield "topic", owner + last, node.location, owner
    for package, launch in launches:
        for passed in launch.passed:
            parts = passed.path.split("/")
            if parts[0] == "share" and len(parts) > 1 and package.find(parts[1]) is None:
                yield "package", parts[1], passed.location, ""
                owner = f"{parts[1]}/"
                yield "launch file", owner + parts[-1], passed.location, owner


def _declared(workspace: Workspace) -> Iterator[_Use]:
    """Yield the packages that package.xml declares without a condition."""
    for package in workspace.packages:
        manifest = package.manifest
        if manifest is None:
            continue
        for found in _DEPENDENCY.finditer(manifest.source.text):
            name = found[1]
            if name in manifest.dependencies and package.find(name) is None:
                yield "package", name, manifest.source.at(found.start(1)), ""
