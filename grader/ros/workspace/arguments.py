"""Arguments of launch files and of xacro: those that are declared, and those that are passed."""

import re
from collections.abc import Iterator

from grader.base.source import Location
from grader.ros.build.places import PREFIX
from grader.ros.known.known import known
from grader.ros.launch.launch_model import Launch
from grader.ros.workspace.names import Definition, Fact, Open, Use
from grader.ros.workspace.workspace import Workspace

_CONFIGURATION = re.compile(r"LaunchConfiguration\(\s*[\"'](\w+)[\"']|\$\(var (\w+)")
_MAX_LAUNCH = 128 * 1024  # bytes, as launch files are read
_FIND = re.compile(r"\$\(find ([\w-]+)\)")
_XACRO_ARGUMENT = re.compile(r"<xacro:arg\b[^>]*?\bname\s*=\s*[\"']([^\"']+)[\"']")


def argument_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield the arguments that launch files and xacro declare, and those that includes and Command
    pass.
    """
    for package, path, launch in workspace.launches:
        start = Location(package.path(path), 1, 1)
        for owner in [target for target, source in package.installed.items() if source == path]:
            yield from (
                Definition("launch argument", name, start, owner) for name in launch.declared
            )
            text = package.tree.files[path].read(_MAX_LAUNCH).decode("utf-8", "replace")
            used = {name for found in _CONFIGURATION.findall(text) for name in found if name}
            yield from (Definition("launch argument", name, start, owner) for name in used)
            yield from _of_included(workspace, launch, owner)
            if launch.more:
                yield Open("launch argument", owner)
    for owner, names in known()["launch_arguments"].items():
        yield from (
            Definition("launch argument", name, Location(owner, 1, 1), owner) for name in names
        )
    for _, _, launch in workspace.launches:
        for passed in launch.passed:
            if workspace.has_file(passed.path) or passed.path in known()["launch_arguments"]:
                for name, _ in passed.values:
                    said = f"the include of {passed.path.rpartition('/')[2]}"
                    yield Use(
                        "launch argument", name, passed.location, said, passed.path, optional=True
                    )
    yield from _of_xacro(workspace)


def _of_included(workspace: Workspace, launch: Launch, owner: str) -> Iterator[Fact]:
    """Yield the arguments of launch files that are not submitted, which a launch file passes on by
    including them.
    """
    for passed in launch.passed:
        names = known()["launch_arguments"].get(passed.path)
        if names is not None:
            for name in names:
                yield Definition("launch argument", name, passed.location, owner)
        elif not workspace.has_file(passed.path):
            yield Open("launch argument", owner)


def _of_xacro(workspace: Workspace) -> Iterator[Fact]:
    for source in workspace.xacro_sources:
        for found in _XACRO_ARGUMENT.finditer(source.text):
            yield Definition("xacro argument", found[1], source.at(found.start(1)))
        if any(workspace.packages[0].find(name) is None for name in _FIND.findall(source.text)):
            yield Open("xacro argument")  # of files that are included from other packages
    for _, _, launch in workspace.launches:
        for file in launch.named("urdf", "read"):
            path = (file.path or "").removeprefix(f"{PREFIX}/")
            if file.by == "xacro" and workspace.has_file(path):
                for name, _ in file.arguments:
                    yield Use(
                        "xacro argument", name, file.location, "Command of xacro", optional=True
                    )
