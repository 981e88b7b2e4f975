"""What a launch file starts, for the outline of an editor."""

from collections.abc import Iterator
from typing import NamedTuple

from grader.base.source import Location, Source
from grader.ros.launch.launch_model import Launch
from grader.workspace.index.written_names import call_end
from grader.workspace.model.launches import SPAWNERS
from grader.workspace.model.workspace import Workspace


class StartedName(NamedTuple):
    """A node or component that a launch file starts, with the place of the action and its end."""

    name: str
    detail: str
    location: Location


def started_in(workspace: Workspace, path: str) -> Iterator[StartedName]:
    """Yield what a launch file itself starts; each action of a loop once."""
    for package, own_path, launch in workspace.launches.files:
        if package.path(own_path) == path:
            yield from _in_order(workspace, launch)


def _in_order(workspace: Workspace, launch: Launch) -> Iterator[StartedName]:
    first: dict[Location, StartedName] = {}
    for node in launch.nodes:
        name = workspace.code.find_name(node) or node.executable
        detail = node.program_path
        if node.executable in SPAWNERS:
            name = " ".join([node.executable, *(word or "..." for word in node.arguments or ())])
        first.setdefault(node.location, StartedName(name, detail, node.location))
    for component in launch.components:
        name = (component.node.node_name if component.node else "") or ""
        detail = f"{component.package or '...'} {component.plugin or '...'}"
        started = StartedName(name or component.plugin or "a component", detail, component.location)
        first.setdefault(component.location, started)
    for at, started in sorted(first.items()):
        if at.path == launch.source.path:
            yield started._replace(location=_whole(launch.source, at))


def _whole(source: Source, at: Location) -> Location:
    """Return the place of an action with its end."""
    end = source.at(call_end(source, source.start_offset(at)))
    return at._replace(end_line=end.line, end_column=end.column)
