"""The nodes of installed launch files of other packages that launch files include."""

from collections.abc import Iterator, Sequence

from grader.ros.known.end_rows import (
    IncludedNode,
    launch_file_is_known,
    nodes_of_launch_file,
)
from grader.ros.known.package_rows import package_row
from grader.ros.launch.launch_model import GivenParameters, Launch, PassedArguments, StartedNode
from grader.ros.package.package import Package
from grader.workspace.graph.launch_graph import Unread
from grader.workspace.graph.opened_by_programs import last_release
from grader.workspace.model.workspace import Workspace


def included_nodes(workspace: Workspace, package: Package, launch: Launch) -> Iterator[StartedNode]:
    """Yield the nodes that included launch files of other packages start, as far as is known."""
    release = last_release(workspace)
    for passed in launch.passed:
        owner, file = _included_file(passed)
        if passed.when is False or package.find(owner):
            continue
        for included in nodes_of_launch_file(owner, file, release):
            of_package, _, executable = included.node.partition("/")
            yield StartedNode(
                of_package,
                executable,
                None if passed.when is None else True,
                passed.location,
                remaps=_remappings_passed(passed, included),
                node_name=included.name,
                parameters=_parameters_passed(passed, included.parameters),
            )


def _remappings_passed(
    passed: PassedArguments, included: IncludedNode
) -> tuple[tuple[str, str], ...] | None:
    """Return the remappings of a node; None if an include passes a name that is not known."""
    values = dict(passed.values)
    remaps = []
    for name, default in included.remappings.items():
        to = values.get(included.arguments.get(name, ""), default)
        if to is None:
            return None
        remaps.append((name, to))
    return tuple(remaps)


def _parameters_passed(
    passed: PassedArguments, arguments: Sequence[str]
) -> tuple[GivenParameters, ...] | None:
    """Return the parameter files that an include passes; None if not all are known."""
    values = dict(passed.values)
    paths = [values.get(name) for name in arguments]
    known = [path for path in paths if path]
    if not known or len(known) < len(paths):
        return None
    return tuple(GivenParameters(passed.location, path) for path in known)


def unread_includes(workspace: Workspace, launch: Launch) -> Iterator[Unread]:
    """Yield the included launch files of known packages of which it is not known what they open."""
    own_packages = workspace.own_packages
    for passed in launch.passed:
        package, file = _included_file(passed)
        is_known = launch_file_is_known(package, file) or file not in package_row(package).launch
        if passed.when is not False and not is_known and package not in own_packages:
            reason = f"what {file} of {package} starts is not known"
            yield Unread(reason, passed.location)


def _included_file(passed: PassedArguments) -> tuple[str, str]:
    """Return the package and the name of an included launch file."""
    package, _, file = passed.path.rpartition("share/")[2].partition("/launch/")
    return package, file
