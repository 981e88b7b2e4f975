"""The ends of well-known programs, components and controllers, as they are started."""

from collections.abc import Callable, Iterator
from fnmatch import fnmatchcase
from operator import eq, ne
from typing import Any

from grader.base.source import Location
from grader.ros.known.end_rows import OpenedEnds, VaryingEnd
from grader.ros.known.releases import RELEASES, Release
from grader.ros.launch.launch_model import StartedNode
from grader.ros.launch.node_parameters import NodeParameters
from grader.ros.python.values import Unknown
from grader.workspace.graph.launch_graph import PART_UNKNOWN, GraphEnd
from grader.workspace.model.workspace import Workspace

_USUAL: Release = "jazzy"  # of a workspace that states none
_NO_NAME = "its namespace or its remappings are known only at run time"


def shown_type(name: str | None) -> str:
    """Return a type as ROS 2 writes it: sensor_msgs/msg/LaserScan; empty if it is not known."""
    return (name or "").replace(".", "/")


def last_release(workspace: Workspace) -> Release:
    """Return the release of a workspace: of several the last one."""
    return max(workspace.releases, key=RELEASES.index, default=_USUAL)


def ends_of_row(
    row: OpenedEnds, node: StartedNode, given: NodeParameters, release: Release
) -> Iterator[GraphEnd]:
    """Yield what a program opens that has a row.

    Args:
        row: What is known of the program.
        node: The node with its name, as it is started.
        given: The parameters that it is given.
        release: The release of ROS 2.
    """
    for kind, name, message in row.fixed:
        yield _end(kind, name, message, node, node.location)
    for varying in row.varying:
        if varying.is_in(release):
            for name, message, location, doubt in _list_names(varying, given, node.location):
                yield _end(varying.kind, name, message, node, location, doubt)


def _end(
    kind: Any, name: str, message: str, node: StartedNode, at: Location, doubt: str = ""
) -> GraphEnd:
    full = node.topic(name) if name != PART_UNKNOWN else None
    if full is None or "~" in full:
        known = name if name.startswith("/") else f"/{name}"
        known = known.replace("~", PART_UNKNOWN)
        return GraphEnd(kind, known, shown_type(message), at, doubt=doubt or _NO_NAME)
    return GraphEnd(kind, full, shown_type(message), at, doubt=doubt)


def _list_names(
    end: VaryingEnd, given: NodeParameters, at: Location
) -> Iterator[tuple[str, str, Location, str]]:
    """Yield name and type of an end, where its name is written, and why it may not be there."""
    doubt = _doubt_of_conditions(end, given)
    if doubt is None:
        return
    is_named = False
    for parameter, value in given.values.items():
        if not end.parameter or not fnmatchcase(parameter, end.parameter):
            continue
        is_named = True
        if isinstance(value.value, str) and value.value:
            name = value.value
            if end.is_below:
                name = f"{parameter.split('.')[-2]}/{name}"
            yield name, _find_type(end, parameter, given), value.location, doubt
        elif isinstance(value.value, Unknown):
            yield PART_UNKNOWN, end.type, value.location, value.value.reason
    if not is_named and end.name:
        unknown = given.unknown if end.parameter else ""
        yield end.name, end.type, at, doubt or unknown


def _find_type(end: VaryingEnd, parameter: str, given: NodeParameters) -> str:
    """Return the type of an end that a parameter names."""
    if not end.type_parameter:
        return end.type
    above = parameter.rpartition(".")[0]
    row = given.values.get(f"{above}.{end.type_parameter}")
    if not row or not isinstance(row.value, str):
        return ""
    return f"{end.type}{row.value}"


def _doubt_of_conditions(end: VaryingEnd, given: NodeParameters) -> str | None:
    """Return why it is not certain that an end is opened; None if it certainly is not."""
    for conditions, holds in ((end.only, eq), (end.unless, ne)):
        for name, value in conditions.items():
            doubt = _doubt_of_condition(given, name, value, holds)
            if doubt is None or doubt:
                return doubt
    return ""


def _doubt_of_condition(
    given: NodeParameters, name: str, value: Any, holds: Callable[[Any, Any], bool]
) -> str | None:
    """Return why it is not certain that a condition holds; empty if it does, None if not."""
    row = given.values.get(name)
    if not row:
        if given.unknown:
            return given.unknown
        return "" if holds(None, value) else None
    if isinstance(row.value, Unknown):
        return row.value.reason
    return "" if holds(row.value, value) else None
