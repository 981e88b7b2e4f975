"""Arguments of launch files and of xacro: those that are declared, and those that are passed."""

from collections.abc import Iterator

from grader.base.patterns import on_use
from grader.base.source import Location, Source
from grader.ros.installation.places import PREFIX
from grader.ros.known.package_rows import launch_arguments
from grader.ros.launch.launch_model import Launch
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Definition,
    Facts,
    Open,
    Use,
)

_CONFIGURATION = on_use(r"LaunchConfiguration\(\s*[\"'](\w+)[\"']|\$\(var (\w+)")
_MAX_LAUNCH = 128 * 1024  # bytes, as launch files are read
_FIND = on_use(r"\$\(find ([\w-]+)\)")
_OTHER_INCLUDE = on_use(
    r"<xacro:include\b[^<>]*?\bfilename\s*=\s*[\"'](?![^\"']*\.(?:xacro|urdf)[\"'])"
)
# xacro takes an argument also where it is only used, if it is passed.
_XACRO_ARGUMENT = on_use(
    r"<xacro:arg\b[^<>]*?\bname\s*=\s*[\"']([^\"']+)[\"']|\$\(arg\s+([^\s)]+)|\barg\(\s*[\"'](\w+)"
)


def argument_facts(workspace: Workspace) -> Facts:
    """Yield the arguments that launch files and xacro declare, or that others pass.

    Includes and Command pass them.
    """
    for package, path, launch in workspace.launches.files:
        start = Location(package.path(path), 1, 1)
        text = (package.tree.read(path, _MAX_LAUNCH) or b"").decode("utf-8", "replace")
        names = list(launch.declared)
        names += {match[1] or match[2] for match in _CONFIGURATION.finditer(text)}
        for owner in workspace.launches.find_targets(package, path):
            for name in names:
                yield Definition("launch argument", name, start, owner)
            yield from _included_arguments(workspace, launch, owner)
            if launch.more:
                yield Open("launch argument", owner)
    for owner, declared in launch_arguments().items():
        for name in declared:
            yield Definition("launch argument", name, Location(owner, 1, 1), owner)
    yield from _passed_arguments(workspace)
    yield from _xacro_arguments(workspace)


def _included_arguments(workspace: Workspace, launch: Launch, owner: str) -> Facts:
    """Yield the arguments of outside launch files, which a launch file passes on.

    It passes them on by including files outside the workspace.
    """
    for passed in launch.passed:
        names = launch_arguments().get(passed.path)
        if names is not None:
            for name in names:
                yield Definition("launch argument", name, passed.location, owner)
        elif not workspace.installed.has_file(passed.path):
            yield Open("launch argument", owner)


def _passed_arguments(workspace: Workspace) -> Iterator[Use]:
    """Yield the arguments that launch files pass to those that they include."""
    for launch in workspace.launches.every:
        for passed in launch.passed:
            path = passed.path
            if workspace.installed.has_file(path) or path in launch_arguments():
                said = f"the include of {path.rpartition('/')[2]}"
                for name, _ in passed.values:
                    yield Use("launch argument", name, passed.location, said, path, optional=True)


def _xacro_arguments(workspace: Workspace) -> Facts:
    """Yield the arguments that xacro files declare, and those that launch files pass to xacro."""
    for source in workspace.robots.xacro_sources:
        for match in _XACRO_ARGUMENT.finditer(source.text):
            number = match.lastindex or 0
            yield Definition("xacro argument", match[number], source.at(match.start(number)))
            if "$" in match[number]:
                yield Open("xacro argument")
        if includes_others(workspace, source):
            yield Open("xacro argument")
    for launch in workspace.launches.every:
        yield from _passed_to_xacro(workspace, launch)


def _passed_to_xacro(workspace: Workspace, launch: Launch) -> Iterator[Use]:
    """Yield the arguments that a launch file passes to xacro with the files of the workspace."""
    for file in launch.named("urdf", "read"):
        path = (file.path or "").removeprefix(f"{PREFIX}/")
        if file.by == "xacro" and workspace.installed.has_file(path):
            # What includes the file declare is known where all of it was expanded.
            source_path = workspace.installed.find_source(file.path or "")
            is_expanded = source_path in workspace.robots.files
            for name, _ in file.arguments:
                at = file.location
                yield Use("xacro argument", name, at, "Command of xacro", optional=not is_expanded)


def includes_others(workspace: Workspace, source: Source) -> bool:
    """Return whether a file includes one of another package, or one that is not read here."""
    if any(not workspace.packages[0].find(name) for name in _FIND.findall(source.text)):
        return True
    return _OTHER_INCLUDE.search(source.text) is not None
