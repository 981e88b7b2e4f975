"""The parameters of well-known nodes, controllers and plugins, compared with what is read.

Files give the parameters; the nodes, controllers and plugins read them.

The rows are those of `ros/known/parameter_rows.py`.
"""

from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import suppress
from functools import lru_cache

from grader.base.errors import InputError
from grader.base.names import first_part, last_part
from grader.base.source import Location
from grader.ros.config.yaml_nodes import YamlFault, YamlNode, read_yaml
from grader.ros.config.yaml_values import values_in
from grader.ros.known.package_rows import controller_row, usual_names
from grader.ros.known.parameter_rows import node_rows
from grader.ros.known.releases import RELEASES, Release
from grader.ros.launch.launch_model import ParameterValue, StartedNode
from grader.ros.launch.node_parameters import value_in_file
from grader.ros.package.package import Package
from grader.ros.python.parse import START
from grader.ros.python.values import Unknown
from grader.workspace.graph.started_controllers import defined_controllers
from grader.workspace.model.stated_releases import deciding_launch_files, releases_in_path
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
)
from grader.workspace.rules.parameter_rules import GivenNode, ParameterValues, wrong_values

# The node that MoveIt's joint_limits.yaml is for, and where its table is among the parameters.
_MOVE_GROUP = "moveit_ros_move_group/move_group"
_LIMITS = ("robot_description_planning", "joint_limits")
_SWITCHES = ("has_velocity_limits", "has_acceleration_limits")
# Of a file of this form that xacro loads for the limits in a URDF: MoveIt has no limits of effort.
_OF_URDF = ("has_effort_limits", "max_effort")
_MAX_REPOS = 64 * 1024  # bytes of a file of vcstool
_WRITTEN_OTHERWISE = Unknown("a string in place of a list", START)
_COST_OF_VALUE = 20  # parts of comparing a value with the rows of its node


def known_parameter_facts(workspace: Workspace) -> Facts:
    """Yield wrong parameters of well-known nodes, controllers and plugins, each place once."""
    said = set()
    for given in _given_nodes(workspace):
        workspace.charge(1 + _COST_OF_VALUE * len(given.values))
        if any(value.named_at for value in given.values.values()):
            yield Compared("parameters")
        if workspace.robots.known:
            said |= _negative_lengths(given)
        releases = _find_releases(workspace, given)
        for mismatch in wrong_values(given, releases) if releases is not None else ():
            if mismatch.location not in said or mismatch.location == given.at:
                yield mismatch
            said.add(mismatch.location)


def _find_releases(workspace: Workspace, given: GivenNode) -> tuple[Release, ...] | None:
    """Return the releases that values may be for.

    These are the stated ones, and those that the files of the values are named after. The result
    is None if a launch file decides by the release what it gives.
    """
    stated = dict.fromkeys(workspace.releases)
    paths = {value.location.path for value in given.values.values()}
    if not paths.isdisjoint(deciding_launch_files(workspace)):
        return None
    for path in paths if stated else ():
        stated |= dict.fromkeys(releases_in_path(path))
    return tuple(sorted(stated, key=RELEASES.index))


def _negative_lengths(given: GivenNode) -> set[Location]:
    """Return the places of numbers of wheels that are negative, which is a mistake of values."""
    places = set()
    for name in controller_row(given.node).wheels:
        value = given.values.get(name)
        if value and isinstance(value.value, float) and value.value < 0.0:
            places.add(value.location)
    return places


def _given_nodes(workspace: Workspace) -> Iterator[GivenNode]:
    """Yield what nodes get.

    First comes that of launch files, then of controllers, then that in files of which no launch
    file of the workspace says who gets them.
    """
    in_files: set[str] = set()  # the parameters of move_group that are said of their files
    for given in _limits_of_moveit(workspace):
        in_files.update(given.values)
        yield given
    read = set()
    for given in [*_started(workspace), *_controllers(workspace)]:
        read |= {value.location for value in given.values.values()}
        kept = given.values
        if given.node == _MOVE_GROUP:
            kept = {name: value for name, value in kept.items() if name not in in_files}
        yield given._replace(values=kept)
    for given in _sections_by_name(workspace):
        if not any(value.location in read for value in given.values.values()):
            yield given


def _started(workspace: Workspace) -> Iterator[GivenNode]:
    """Yield the well-known nodes that launch files start."""
    given = []
    shared: Counter[Location] = Counter()
    for package, node in workspace.launches.placed_nodes:
        values = _find_values(workspace, package, node)
        if values is None:
            continue
        is_all, values_by_name = values
        at = node.location if is_all and node.when is True else None
        program = node.program_path
        said = repr(workspace.code.find_name(node) or node.executable)
        given.append(GivenNode(program, said, values_by_name, at))
        shared.update({value.location for value in values_by_name.values()})
    several = {place for place, count in shared.items() if count > 1}
    several |= _places_for_every_node(workspace)
    for each in given:
        if is_as_released(workspace, each.node):
            yield each._replace(shared=frozenset(several))


def _find_values(
    workspace: Workspace, package: Package, node: StartedNode
) -> tuple[bool, ParameterValues] | None:
    """Return the parameters of a node of another package, and whether it gets no others.

    The result is None for one of the workspace, and for one that is not known by its name.
    """
    if workspace.find_package(node):
        return None
    has_name = workspace.code.find_name(node) is not None and node.namespace is not None
    if not has_name and any(parameter.path for parameter in node.parameters or ()):
        return None  # any section may be its own
    given = workspace.parameters.given_in_code(package, node)
    return not given.unknown and node.arguments == (), _without_time(given.values)


def _without_time(values: ParameterValues) -> dict[str, ParameterValue]:
    """Return values without `use_sim_time`, which is asked for of every node."""
    return {name: value for name, value in values.items() if name != "use_sim_time"}


def _places_for_every_node(workspace: Workspace) -> frozenset[Location]:
    """Return the places of parameters that a file gives to all of several nodes."""
    places: frozenset[Location] = frozenset()
    for nodes in workspace.parameters.files.values():
        if len(nodes) > 1:
            places |= workspace.installed.wildcard_places(nodes[0])
    return places


def _controllers(workspace: Workspace) -> Iterator[GivenNode]:
    """Yield the controllers that launch files spawn."""
    for controller in defined_controllers(workspace):
        kind = controller.type.text or ""
        if not is_as_released(workspace, kind):
            continue
        for given in workspace.parameters.owners.get(controller.name, ()):
            # Another launch file may define another controller of this name.
            paths = {value.location.path for value in given.values.values()}
            if controller.location.path in paths:
                values = _without_wrong_lists(kind, _without_time(given.values))
                at = controller.location if not given.unknown else None
                shared = _places_for_any_name(workspace)
                yield GivenNode(kind, repr(controller.name), values, at, shared)


@lru_cache(maxsize=2)
def _places_for_any_name(workspace: Workspace) -> frozenset[Location]:
    """Return the places of the parameters that files give to nodes of any name."""
    places: set[Location] = set()
    for keys, section in workspace.installed.sections:
        if not keys or keys[-1].strip("/") in ("*", "**"):
            places.update(value.node.location for value in values_in(section))
    return frozenset(places)


def _without_wrong_lists(kind: str, values: ParameterValues) -> ParameterValues:
    """Return values without a string in place of a list of joints.

    Such a string is a mistake of controllers.
    """
    joints = controller_row(kind).joints
    kept = {}
    for name, value in values.items():
        is_wrong = name in joints and name.endswith("s") and isinstance(value.value, str)
        kept[name] = value._replace(value=_WRITTEN_OTHERWISE) if is_wrong else value
    return kept


def is_as_released(workspace: Workspace, node: str) -> bool:
    """Return whether a node or a class is the one of a release.

    No package of the workspace has it, and no file of repositories says that its source is built.
    """
    rows = node_rows(node)
    if not rows:
        return False
    package = first_part(node)
    is_own = package in workspace.own_packages or workspace.texts.has_plugin(node)
    repository = last_part(rows.source.partition(",")[0])
    return not is_own and repository not in _built_repositories(workspace)


@lru_cache(maxsize=2)
def _built_repositories(workspace: Workspace) -> frozenset[str]:
    """Return the names of the repositories that the files of vcstool list."""
    names = set()
    for path, file in workspace.tree.files.items():
        if not path.endswith(".repos"):
            continue
        with suppress(YamlFault, InputError):
            listed = read_yaml(file.read(_MAX_REPOS), path).get("repositories")
            for _, repository in listed.pairs if listed else ():
                url = repository.get("url")
                if url is not None and url.text:
                    names.add(last_part(url.text).removesuffix(".git"))
    return frozenset(names)


def _sections_by_name(workspace: Workspace) -> Iterator[GivenNode]:
    """Yield the sections of parameter files that have the name of a controller or a known node.

    A controller is defined in the same file; the name of a well-known node is its usual one.
    """
    usual = _usual_names(workspace) if workspace.installed.yaml else {}
    types = {
        (controller.location.path, controller.name): controller.type.text
        for controller in defined_controllers(workspace)
    }
    for keys, section in workspace.installed.sections:
        name = last_part(keys[-1]) if keys else ""
        known_node = types.get((section.source.path, name)) or usual.get(name, "")
        if known_node and is_as_released(workspace, known_node):
            values = _without_wrong_lists(known_node, _section_values(section))
            yield GivenNode(known_node, repr(name), values, None)


def _usual_names(workspace: Workspace) -> Mapping[str, str]:
    """Return the well-known nodes by their usual names, which no own node and no controller has."""
    usual = dict(usual_names())
    for node in workspace.launches.nodes:
        if workspace.find_package(node):
            usual.pop(workspace.code.find_name(node) or "", None)
    for controller in defined_controllers(workspace):
        usual.pop(controller.name, None)
    return usual


def _section_values(section: YamlNode, prefix: str = "") -> dict[str, ParameterValue]:
    """Return the values below a mapping by their dotted names, with where these end."""
    values = {}
    for value in values_in(section):
        mapping = section.find_mapping(value.keys) if value.keys else None
        is_plain = all(isinstance(item.value, str) for item in value.node.items)
        if mapping and is_plain:
            given = value_in_file(value.node, is_plain=False)
            at = mapping.key_location(value.keys[-1])
            values[prefix + ".".join(value.keys)] = given._replace(named_at=at)
    return values


def _limits_of_moveit(workspace: Workspace) -> Iterator[GivenNode]:
    """Yield the joint_limits.yaml of MoveIt, of a workspace with an SRDF.

    moveit_configs_utils gives the file to move_group.
    """
    if not workspace.texts.srdf_files:
        return
    for tree in workspace.installed.trees:
        table = tree.get(_LIMITS[1])
        if not table:
            continue
        keys = set()
        for limits in table.table.values():
            keys |= {key for key, _ in limits.pairs}
        if keys.intersection(_SWITCHES) and keys.isdisjoint(_OF_URDF):
            prefix = ".".join(_LIMITS) + "."
            values = _section_values(table, prefix)
            yield GivenNode(_MOVE_GROUP, "'move_group'", values, None, prefix=prefix)
