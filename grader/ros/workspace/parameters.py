"""Parameters: whether parameter files have some for the node that gets them, and whether own
nodes declare them.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from fnmatch import fnmatchcase
from functools import partial
from itertools import chain
from typing import Any

from grader.base.names import closest, near
from grader.base.source import Location
from grader.ros.config.yaml_nodes import YamlFault, YamlNode, first_alias
from grader.ros.config.yaml_values import (
    PARAMETERS,
    is_misspelt_key,
    is_parameters,
    sections_in,
    values_in,
)
from grader.ros.known.known import known
from grader.ros.launch.launch_model import ParameterValue, StartedNode
from grader.ros.launch.node_parameters import parameters_of
from grader.ros.package.installed_files import open_meant
from grader.ros.package.package import Package
from grader.ros.package.python_nodes import PythonNode
from grader.ros.workspace.bridges import bridge_files
from grader.ros.workspace.names import (
    Compared,
    Definition,
    Fact,
    Mismatch,
    Open,
    Undecided,
    Use,
    corrections,
    place_text,
)
from grader.ros.workspace.workspace import Workspace

_TYPES = {
    bool: "a boolean",
    int: "an integer",
    float: "a double",
    str: "a string",
}  # as ROS 2 calls them
_OF_EVERY_NODE = ("use_sim_time", "start_type_description_service")
_INPUT = re.compile(r"(odom|imu|pose|twist)\d+_config")  # of robot_localization
_SEPARATORS = re.compile(r"[:/]+")
# Keys of lists whose entries name sections beside them, in the files of Nav2, MoveIt and others.
_LISTS = ("plugins", "navigators", "observation_sources", "filters", "controller_names")
_NOT_LISTS = ("plugin_lib_names",)


def parameter_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield what parameter files have for nodes, what own nodes declare, and lists of plugins."""
    of_bridges = bridge_files(workspace)
    for path, tree in workspace.yaml_files.items():
        if isinstance(tree, YamlFault) and path not in of_bridges:
            is_sure = path in workspace.parameter_files
            yield Mismatch(
                "parameters", f"this is not YAML: {tree}", tree.location, is_sure=is_sure
            )
    for path, nodes in workspace.parameter_files.items():
        yield Compared("parameters")
        yield from _file_given(workspace, path, nodes)
    yield from _controllers_given(workspace)
    for package, node in workspace.nodes:
        own = workspace.python_node(node)
        if own is not None:
            yield from _declared(workspace, package, node, own)
    yield from _without_time(workspace)
    for path in workspace.parameter_files:
        yield from _filters(workspace.yaml_files.get(path))
    for package, node in workspace.nodes:
        yield from _required(workspace, package, node)
    sections = {
        path: frozenset(_sections(tree)) for path, tree in workspace.trees if is_parameters(tree)
    }
    for path, tree in workspace.trees:
        if is_parameters(tree) or "controller_names" in tree.source.text:
            # A file that may be given along with others may leave sections to them.
            others = (
                it
                for other, it in sections.items()
                if other != path and not _is_given_alone(workspace, path)
            )
            yield from _plugin_lists(tree, frozenset().union(*others))
            yield from _plugin_names(tree)


def _sections(node: YamlNode, above: str = "") -> Iterator[tuple[str, str]]:
    """Yield the names of the mappings in a file, each with the keys above it."""
    for key, inner in node.value.items() if isinstance(node.value, dict) else ():
        if isinstance(inner.value, dict):
            yield above, key
            yield from _sections(inner, f"{above}/{key.strip('/')}")


def _is_given_alone(workspace: Workspace, path: str) -> bool:
    nodes = workspace.parameter_files.get(path, ())
    return any(
        sum(bool(it.path or it.unknown) for it in node.parameters or ()) == 1 for node in nodes
    )


def _file_given(workspace: Workspace, path: str, nodes: Sequence[StartedNode]) -> Iterator[Fact]:
    """Yield that a parameter file has nothing for a node that is given it, but for a node that
    is not.
    """
    tree = workspace.yaml_files.get(path)
    # A container gives it to the components that are loaded into it.
    if not isinstance(tree, YamlNode) or any(
        node.package in ("ros_gz_bridge", "rclcpp_components") for node in nodes
    ):
        return
    yield from _misplaced(tree)
    names = [(node, workspace.name_of(node)) for node in nodes]
    sections = {keys[-1].rpartition("/")[2]: keys for keys, _ in sections_in(tree) if keys}
    read = [name for _, name in names if name is not None]
    if len(read) < len(names) or not sections:
        return
    own = {child for name in read for child in workspace.children_of(name)}
    unread = [
        key
        for key in sections
        if key not in own and not any(fnmatchcase(name, key) for name in read)
    ]
    is_passed = any(
        workspace.source_of(value or "") == path
        for _, _, launch in workspace.launches
        for passed in launch.passed
        for _, value in passed.values
    )
    lacking = {
        name for name in read if not any(fnmatchcase(name, key) or key == "**" for key in sections)
    }
    for node, name in names:
        if name in lacking and unread:
            meant = near(name or "", unread)
            is_known = (
                workspace.package_of(node) is not None or node.package in known()["without_frames"]
            )
            if meant is None and (is_passed or not is_known):
                continue  # the others may be of nodes that are not submitted
            key, is_one = meant or unread[0], meant is not None or len(unread) == len(lacking) == 1
            message = (
                f"there are parameters for {key}, but none for the node {name!r}, which gets "
                "this file"
            )
            at = tree.key_location(*sections[key])
            either = corrections(key, at, name if is_one else None, node.location)
            yield Mismatch("parameters", message, at, node.location, True, either)


def _controllers_given(workspace: Workspace) -> Iterator[Fact]:
    """Yield what is misplaced in files that only controllers are given."""
    for path in sorted(workspace.controller_files.difference(workspace.parameter_files)):
        tree = workspace.yaml_files.get(path)
        if isinstance(tree, YamlNode):
            yield Compared("parameters")
            yield from _misplaced(tree)


def _misplaced(tree: YamlNode) -> Iterator[Fact]:
    """Yield aliases, values that are not below ros__parameters, and ros__parameters inside of
    ros__parameters.
    """
    alias = first_alias(tree.source)
    if alias is not None:
        name, at = alias
        yield Mismatch(
            "parameters",
            f"ROS 2 reads no aliases in parameter files: write the value in place of *{name}",
            at,
        )
    waiting: list[tuple[str, YamlNode, bool]] = [("", tree, False)]
    while waiting:
        name, node, is_below = waiting.pop()
        if isinstance(node.value, dict) and node.value:
            for key, inner in node.value.items():
                if key == PARAMETERS and is_below:
                    message = f"{name}: ros__parameters is inside of other ros__parameters"
                    yield Mismatch("parameters", message, node.key_location(key))
                elif not is_below and is_misspelt_key(key, inner):
                    message = (
                        f"{name}: rcl does not know the key {key!r}; did you mean {PARAMETERS!r}?"
                    )
                    at = node.key_location(key)
                    yield Mismatch(
                        "parameters", message, at, corrections=corrections(key, at, PARAMETERS)
                    )
                else:
                    waiting.append((key, inner, is_below or key == PARAMETERS))
        elif not is_below and name:
            message = f"{name} is not below a key ros__parameters, so rcl cannot read the file"
            yield Mismatch("parameters", message, node.location)


def _declared(
    workspace: Workspace, package: Package, node: StartedNode, own: PythonNode
) -> Iterator[Fact]:
    """Yield the parameters that a node of the workspace declares, reads and is given."""
    owner = f"{node.package}/{node.executable}"
    for it in own.parameters:
        if it.name is None:
            yield Open("parameter", owner)
        elif it.is_declared:
            yield Definition("parameter", it.name, it.location, owner)
    yield from (Definition("parameter", name, own.location, owner) for name in _OF_EVERY_NODE)
    if own.doubts:
        yield Open("parameter", owner)
    for it in own.parameters:
        if it.name is not None and not it.is_declared:
            yield Use("parameter", it.name, it.location, "get_parameter", owner)
    found = parameters_of(
        node, partial(open_meant, package, absent_are_empty=True), own.name or "", is_python=True
    )
    if found.unknown:
        yield Undecided("parameters", found.unknown)
    wide = workspace.wildcard_places(node)
    for name, value in found.values.items():
        if value.location not in wide and not name.startswith("qos_overrides."):
            yield Use(
                "parameter", name, value.location, f"the node {workspace.name_of(node)!r}", owner
            )
    yield from _types_given(own, found.values)


def _types_given(own: PythonNode, values: Mapping[str, ParameterValue]) -> Iterator[Mismatch]:
    """Yield the values of other types than a node declares."""
    for it in [it for it in own.parameters if it.is_declared and it.is_plain]:
        given = values.get(it.name or "")
        if given is not None:
            yield from _of_other_type(
                it.name or "", given, it.default, it.location, is_sure=not own.doubts
            )


def _without_time(workspace: Workspace) -> Iterator[Mismatch]:
    """Yield that a parameter file gives `use_sim_time`, which every node declares, no boolean."""
    for found in chain.from_iterable(workspace.parameter_owners.values()):
        if (given := found.values.get("use_sim_time")) is not None:
            yield from _of_other_type("use_sim_time", given, default=True, at=None)


def _of_other_type(
    name: str, given: ParameterValue, default: Any, at: Location | None, *, is_sure: bool = True
) -> Iterator[Mismatch]:
    """Yield that a parameter file gives a parameter a value of another type than the node
    declares.
    """
    declared, actual = _type_of(default), _type_of(given.value)
    if (
        declared
        and actual
        and declared != actual
        and given.location.path.endswith((".yaml", ".yml"))
    ):
        there = f" ({place_text(at)})" if at is not None else ""
        message = (
            f"the parameter {name!r} is given {actual}; its node declares {declared}{there}, "
            "and stops"
        )
        yield Mismatch("parameters", message, given.location, at, is_sure)


def _type_of(value: Any) -> str:
    """Return the type that ROS 2 gives a value, in words; empty where it is not known."""
    if isinstance(value, list | tuple):
        kinds = {_type_of(it) for it in value}
        if len(kinds) == 1 and kinds != {""}:
            return f"a list of {kinds.pop().partition(' ')[2]}s"
        return ""
    return _TYPES.get(type(value), "")


def _filters(tree: YamlNode | YamlFault | None) -> Iterator[Fact]:
    """Yield which values of an input a filter of robot_localization takes, where there are not 15
    of them.
    """
    for _, section in sections_in(tree) if isinstance(tree, YamlNode) else ():
        for value in values_in(section):
            count = len(value.node.items)
            if value.keys and _INPUT.fullmatch(value.keys[-1]) and count not in (0, 15):
                message = (
                    f"{value.keys[-1]} has {count} values; it needs 15: x y z, angles, their "
                    "rates and accelerations"
                )
                yield Mismatch("parameters", message, value.node.location)


def _required(workspace: Workspace, package: Package, node: StartedNode) -> Iterator[Fact]:
    """Yield the parameters that a program of another package needs, and does not get as it needs
    them.
    """
    needed = known()["required_parameters"].get(f"{node.package}/{node.executable}", ())
    if needed and node.arguments == ():
        found = parameters_of(
            node, partial(open_meant, package), workspace.name_of(node) or "", is_python=False
        )
        for name in [it for it in needed if it not in found.values and not found.unknown]:
            guess = closest(name, found.values)
            if guess is not None:
                either = corrections(guess, found.values[guess].location, name)
            else:
                either = ()
            there = f"; did you mean it by {guess!r}?" if guess is not None else ""
            message = (
                f"{node.executable} stops without the parameter {name}, which it does not "
                f"get{there}"
            )
            yield Mismatch("parameters", message, node.location, corrections=either)
        robot = found.values.get("robot_description")
        text = robot.value.strip() if robot is not None and isinstance(robot.value, str) else ""
        if robot is not None and text and not text.startswith("<"):
            advice = "give it the content of the file, not the path"
            message = f"robot_description is no XML, so {node.executable} stops: {advice}"
            yield Mismatch("parameters", message, robot.location)


def _plugin_lists(tree: YamlNode, elsewhere: frozenset[tuple[str, str]]) -> Iterator[Fact]:
    """Yield the entries of lists of plugins that have no section beside them, and none at the same
    place elsewhere.
    """
    waiting = [("", tree)]
    while waiting:
        above, node = waiting.pop()
        if not isinstance(node.value, dict):
            continue
        waiting += [(f"{above}/{key.strip('/')}", inner) for key, inner in node.value.items()]
        sections = {
            key: inner.location
            for key, inner in node.value.items()
            if isinstance(inner.value, dict)
        }
        for key, inner in node.value.items():
            if not sections or key in _NOT_LISTS or not (key in _LISTS or key.endswith("_plugins")):
                continue
            texts = [(it.text or "", it.location) for it in inner.items]
            if inner.text is not None and key == "observation_sources":
                texts = [(word, inner.location) for word in inner.text.split()]
            owner = f"{tree.source.path}:{inner.location.line}"
            yield from (
                Definition("plugin section", name, at, owner) for name, at in sections.items()
            )
            for text, at in texts:
                if text and "/" not in text and "::" not in text and (above, text) not in elsewhere:
                    yield Use("plugin section", text, at, key, owner)


def _plugin_names(tree: YamlNode) -> Iterator[Fact]:
    """Yield plugins that are written with other separators than pluginlib knows them by."""
    names = {_SEPARATORS.sub("::", name): name for name in known()["plugins"]}
    values = [it for it in values_in(tree) if it.keys[-1:] == ("plugin",)]
    older = tuple(known()["slash_before_jazzy"])
    # A file for an older release, which other launch files may choose, writes all of these with a
    # slash.
    is_of_jazzy = any(
        "::" in (it.node.text or "") and (it.node.text or "").startswith(older) for it in values
    )
    for value in values:
        text = value.node.text or ""
        meant = names.get(_SEPARATORS.sub("::", text))
        if meant is not None and meant != text:
            message = f"{value.said}: there is no plugin {text!r}; did you mean {meant!r}?"
            is_sure = is_of_jazzy or not text.startswith(older)
            at = value.node.location
            yield Mismatch("parameters", message, at, None, is_sure, corrections(text, at, meant))
