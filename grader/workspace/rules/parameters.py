"""Parameters: whether parameter files have some for the node that gets them.

It is compared as well whether own nodes declare them.
"""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from fnmatch import fnmatchcase
from itertools import chain

from grader.base.grouping import Strings
from grader.base.names import last_part, near
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.source import Location, Source
from grader.base.text import MAX_NAMED, enumerated, quoted
from grader.files.reading import URDF_LIMIT
from grader.ros.config.yaml_nodes import Visits, YamlFault, YamlNode, first_alias
from grader.ros.config.yaml_values import (
    PARAMETERS,
    YamlValue,
    is_misspelt_key,
    is_parameters,
    keys_of_sections,
    sections_in,
    values_in,
)
from grader.ros.known.package_rows import package_row, plugin_classes, usual_names
from grader.ros.known.parameter_rows import find_rows, row_for
from grader.ros.known.releases import RELEASES, Release, releases_with
from grader.ros.launch.launch_model import FileText, ParameterValue, StartedNode
from grader.ros.nodes.node_facts import NodeFacts
from grader.ros.package.mesh_content import LFS_POINTER
from grader.ros.package.package import Package
from grader.ros.xml.parsing import XmlFault, XmlFile
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.bridges import bridge_files
from grader.workspace.rules.names import (
    DEFINED,
    Compared,
    Definition,
    Facts,
    Mismatch,
    Mismatches,
    Open,
    Undecided,
    Use,
    charge_guess,
    warning,
)
from grader.workspace.rules.parameter_rules import (
    PARAMETER_REQUIRED,
    PARAMETER_TYPE,
    ParameterValues,
    names_of_types,
    type_in_words,
)
from grader.workspace.rules.renamed_nodes import key_of_program_name
from grader.workspace.rules.rule_table import NO_PARAMETER, Rule, Symptom
from grader.workspace.rules.shared_symptoms import (
    CLASS_DOES_NOT_EXIST,
    PARAMETERS_NOT_PARSED,
)

_OF_OPENCV = b"%YAML:"  # its FileStorage reads another YAML
_OF_EVERY_NODE = ("use_sim_time", "start_type_description_service")
_INPUT = on_use(r"(odom|imu|pose|twist)\d+_config")  # of robot_localization
_ROBOT = "robot_description"
_XACRO = "{http://www.ros.org/wiki/xacro}"
_MACRO = f"{_XACRO}macro"
_WITHOUT_LINKS = {_MACRO, f"{_XACRO}property", f"{_XACRO}arg", "material"}
_WILDCARD = on_use(r"[*?\[]")
_SEPARATORS = on_use(r"[:/]+")
# Keys of lists whose entries name sections beside them, in the files of Nav2, MoveIt and others.
_SOURCES = "observation_sources"
_LISTS = ("plugins", "navigators", _SOURCES, "filters", "controller_names")
_NOT_LISTS = ("plugin_lib_names",)


def parameter_facts(workspace: Workspace) -> Facts:
    """Yield what parameter files have for nodes, what own nodes declare, and lists of plugins."""
    yield from _unreadable_files(workspace)
    for _ in workspace.parameters.files:
        yield Compared("parameters")
    for path in _files_of_controllers(workspace):
        if workspace.installed.find_tree(path):
            yield Compared("parameters")
    for tree in parameter_trees(workspace):
        yield from _misplaced_keys(tree)
    for path, nodes in workspace.parameters.files.items():
        yield from _sections_of_others(workspace, path, nodes)
    for package, node in workspace.launches.placed_nodes:
        own_node = workspace.code.own_node(node)
        if own_node:
            yield from _declared(node, own_node)
            yield from _given(workspace, package, node, own_node)
    yield from _without_time(workspace)
    for path in workspace.parameters.files:
        yield from _filters(workspace.installed.find_tree(path))
    for package, node in workspace.launches.placed_nodes:
        yield from _robot_as_text(workspace, package, node)
        yield from _robot_as_argument(workspace, package, node)
    yield from _plugins(workspace)


_PARAMETER_FILE = Rule(
    "parameter-file",
    "parameters",
    NO_PARAMETER,
    "An installed YAML file can be parsed, and a parameter file has no aliases.",
    why=(
        "A node that gets the file ends at its start with 'Couldn't parse params file'. A "
        "launch file that reads it stops with a YAML error."
    ),
    symptoms=(PARAMETERS_NOT_PARSED,),
    wrong="""
pilot:
  ros__parameters:
	speed: 2.0
""",
    right="""
pilot:
  ros__parameters:
    speed: 2.0
""",
    frame="pilot.yaml",
    beside={
        "declare/pilot.py": "self.declare_parameter('speed', 1.0)",
        "tune/rover.launch.py": "",
    },
)


def _unreadable_files(workspace: Workspace) -> Mismatches:
    """Yield installed YAML files that cannot be parsed, and aliases in parameter files.

    rcl refuses aliases.

    That a file is not YAML is certain to be a mistake where a node gets it. Files of OpenCV and
    those that Git LFS has not fetched are no YAML of ROS 2, and those of bridges are compared by
    the rules of bridges.
    """
    files_of_bridges = bridge_files(workspace)
    for path, tree in workspace.installed.yaml.items():
        if not isinstance(tree, YamlFault) or path in files_of_bridges:
            continue
        is_given = path in workspace.parameters.files
        is_of_opencv = not is_given and workspace.folder.begins_with(path, _OF_OPENCV)
        if not is_of_opencv and not workspace.folder.begins_with(path, LFS_POINTER):
            message = f"this is not YAML: {tree}"
            yield Mismatch(_PARAMETER_FILE, message, tree.location, is_certain=is_given)
    for parameters in parameter_trees(workspace):
        alias = first_alias(parameters.source)
        if alias is not None:
            name, at = alias
            message = (
                f"ROS 2 reads no aliases in parameter files: write the value in place of *{name}"
            )
            yield Mismatch(_PARAMETER_FILE, message, at)


def parameter_trees(workspace: Workspace) -> Iterator[YamlNode]:
    """Yield the parameter files that nodes or controllers get.

    What components get, to which a container gives its own files, is not evaluated.
    """
    paths = []
    for path, nodes in workspace.parameters.files.items():
        if not _has_container(nodes):
            paths.append(path)
    for path in paths + _files_of_controllers(workspace):
        tree = workspace.installed.find_tree(path)
        if tree:
            yield tree


def _has_container(nodes: Sequence[StartedNode]) -> bool:
    return any(package_row(node.package).holds_nodes for node in nodes)


def _files_of_controllers(workspace: Workspace) -> list[str]:
    """Return the files that only controllers are given."""
    files = workspace.parameters.controller_files.difference(workspace.parameters.files)
    return sorted(files)


def _plugins(workspace: Workspace) -> Facts:
    """Yield what lists of plugins name, and plugins that pluginlib does not know.

    pluginlib does not know them as they are written.
    """
    sections_by_file = {
        tree.source.path: frozenset(_sections(tree))
        for tree in workspace.installed.trees
        if is_parameters(tree)
    }
    for tree in workspace.installed.trees:
        path = tree.source.path
        if path not in sections_by_file and "controller_names" not in tree.source.text:
            continue
        elsewhere: set[tuple[str, str]] = set()
        # A file that may be given along with others may leave sections to them.
        if not _is_given_alone(workspace, path):
            for other, sections in sections_by_file.items():
                if other != path:
                    elsewhere |= sections
        yield from _plugin_lists(tree, elsewhere)
        yield from _plugin_names(tree, workspace.releases)


def _mappings(tree: YamlNode) -> Iterator[tuple[str, Mapping[str, YamlNode]]]:
    """Yield the mappings in a file, each with the keys above it."""
    waiting = [("", tree)]
    visits = Visits()
    while waiting:
        above, node = waiting.pop()
        if isinstance(node.value, dict) and visits.enters(node):
            yield above, node.value
            for key, inner in node.value.items():
                waiting.append((f"{above}/{key.strip('/')}", inner))


def _sections(tree: YamlNode) -> Iterator[tuple[str, str]]:
    """Yield the names of the mappings in a file, each with the keys above it."""
    for above, mapping in _mappings(tree):
        for key, inner in mapping.items():
            if isinstance(inner.value, dict):
                yield above, key


def _is_given_alone(workspace: Workspace, path: str) -> bool:
    """Return whether a node gets no other file, and none that is not known, beside this one."""
    for node in workspace.parameters.files.get(path, ()):
        files = [given for given in node.parameters or () if given.path or given.unknown]
        if len(files) == 1:
            return True
    return False


def _sections_of_others(
    workspace: Workspace, path: str, nodes: Sequence[StartedNode]
) -> Mismatches:
    """Yield that a parameter file has something only for a node that is not given it.

    It has nothing for a node that is given it.
    """
    tree = workspace.installed.find_tree(path)
    if not tree:
        return
    for of_other in _meant_sections(workspace, path, tree, nodes):
        at = tree.key_location(*of_other.keys)
        started_at = of_other.node.location
        message = (
            f"there are parameters for {of_other.key}, but none for the node {of_other.name!r}, "
            "which gets this file"
        )
        wrong = Mismatch(_PARAMETER_NODE, message, at, started_at)
        renamed = of_other.name if of_other.is_renamed else None
        yield wrong.correcting(of_other.key, renamed, started_at)


class _SectionOfOther(Named):
    """A section that no node of its name reads, and a node without one that may be meant."""

    node: StartedNode
    name: str
    key: str
    keys: Strings
    is_renamed: bool  # whether the node is surely meant
    is_similar: bool  # whether its name is similar


def _meant_sections(
    workspace: Workspace, path: str, tree: YamlNode, nodes: Sequence[StartedNode]
) -> Iterator[_SectionOfOther]:
    """Yield the nodes that are given a file without a section for them, and the section meant.

    Nothing is said where a container gets the file, which it gives to its components, or where the
    name of a node that gets it is not known. A section with the name that its program gives the
    node is said of that name. Without a similar name, the section may be that of a node which is
    not in the workspace.
    """
    names = [name for name in map(workspace.code.find_name, nodes) if name is not None]
    if _has_container(nodes) or len(names) < len(nodes):
        return
    sections = {last_part(keys[-1]): keys for keys, _ in sections_in(tree) if keys}
    unread = _unread_sections(workspace, sections, names)
    lacking = _without_section(workspace, sections, names)
    is_only_pair = len(unread) == len(lacking) == 1
    if not unread:
        return
    for node, name in zip(nodes, names, strict=True):
        if name not in lacking or _is_renamed(workspace, tree, node):
            continue
        meant = _section_meant(workspace, path, node, name, unread)
        if meant is not None:
            key, is_similar = meant
            is_sure = is_similar or is_only_pair
            yield _SectionOfOther(node, name, key, sections[key], is_sure, is_similar)


def _name_in_files(workspace: Workspace, node: StartedNode, name: str) -> str:
    """Return the name of a node, or that of a section of its file whose name is similar."""
    for path in workspace.parameters.files_given(node) if workspace.reads_meant else ():
        tree = workspace.installed.find_tree(path)
        nodes = workspace.parameters.files.get(path, ())
        if tree:
            for of_other in _meant_sections(workspace, path, tree, nodes):
                if of_other.is_similar and of_other.node == node:
                    return of_other.key
    return name


def _section_meant(
    workspace: Workspace, path: str, node: StartedNode, name: str, unread: Sequence[str]
) -> tuple[str, bool] | None:
    """Return the section that a node without one may mean, and whether its name is similar.

    It is None if another node may read it.
    """
    charge_guess(workspace, unread)
    similar = near(name, unread)
    if similar is not None:
        return similar, True
    if _may_read_another(workspace, path, node):
        return None
    return unread[0], False


_PARAMETER_NODE = Rule(
    "parameter-node",
    "parameters",
    NO_PARAMETER,
    "A parameter file has a section for the node that gets it.",
    why=(
        "A node ignores sections with other names without a message. It starts with the "
        "defaults of its code, as ros2 param dump shows."
    ),
    wrong="""
pilott:
  ros__parameters:
    speed: 2.0
""",
    right="""
pilot:
  ros__parameters:
    speed: 2.0
""",
    frame="pilot.yaml",
    beside={
        "declare/pilot.py": "self.declare_parameter('speed', 1.0)",
        "tune/rover.launch.py": "",
    },
)


def _is_renamed(workspace: Workspace, tree: YamlNode, node: StartedNode) -> bool:
    """Return whether a file has a section for a node under the name that its program gives it."""
    keys = keys_of_sections(tree)
    workspace.charge(len(keys))
    return key_of_program_name(workspace, node, keys) is not None


def _may_read_another(workspace: Workspace, path: str, node: StartedNode) -> bool:
    """Return whether a section of a file may be that of a node which is not known.

    The node may be of the launch file to which the file is passed, or inside of a program of
    another package, or of a class of another package that the program makes.
    """
    if path in workspace.installed.passed_files:
        return True
    if workspace.find_package(node):
        return workspace.code.has_other_nodes(node)
    return "frames" not in package_row(node.package).without


def _without_section(
    workspace: Workspace, sections: Iterable[str], names: Sequence[str]
) -> set[str]:
    """Return the names of nodes for which a file has no section, and no pattern of their names."""
    patterns = [key for key in sections if _WILDCARD.search(key)]
    workspace.charge(len(names) * (1 + len(patterns)))
    lacking = set()
    for name in set(names).difference(sections):
        if not any(fnmatchcase(name, key) for key in patterns):
            lacking.add(name)
    return lacking


def _unread_sections(
    workspace: Workspace, sections: Iterable[str], names: Sequence[str]
) -> list[str]:
    """Return the keys of sections that neither the nodes of these names nor their children read."""
    children: set[str] = set()
    for name in set(names):
        children |= workspace.code.find_children(name)
    unread = []
    known_names = set(names)
    for key in sections:
        is_read = key in children or key in known_names
        if not is_read and _WILDCARD.search(key):
            workspace.charge(len(known_names))
            is_read = any(fnmatchcase(name, key) for name in known_names)
        if not is_read:
            unread.append(key)
    return unread


_PARAMETER_KEY = Rule(
    "parameter-key",
    "parameters",
    NO_PARAMETER,
    "The parameters of a node are below one key ros__parameters.",
    why=(
        "rcl refuses the whole file with an error such as 'Cannot have a value before "
        "ros__parameters'. The node ends at its start."
    ),
    symptoms=(PARAMETERS_NOT_PARSED,),
    wrong="""
pilot:
  speed: 2.0
""",
    right="""
pilot:
  ros__parameters:
    speed: 2.0
""",
    frame="pilot.yaml",
    beside={
        "declare/pilot.py": "self.declare_parameter('speed', 1.0)",
        "tune/rover.launch.py": "",
    },
)


def _misplaced_keys(tree: YamlNode) -> Mismatches:
    """Yield values of a parameter file that are not below ros__parameters.

    Keys ros__parameters that are misspelt, and those inside of others, are yielded too.
    """
    waiting = [("", tree, False)]
    visits = {True: Visits(), False: Visits()}  # by whether it is below a key ros__parameters
    while waiting:
        name, node, is_below = waiting.pop()
        if not visits[is_below].enters(node):
            continue
        if not isinstance(node.value, dict) or not node.value:
            if name and not is_below:
                message = f"{name} is not below a key ros__parameters, so rcl cannot read the file"
                yield Mismatch(_PARAMETER_KEY, message, node.location)
            continue
        for key, inner in node.value.items():
            mismatch = _misplaced_key(name, node, key, is_below=is_below)
            if mismatch:
                yield mismatch
            else:
                waiting.append((key, inner, is_below or key == PARAMETERS))


def _misplaced_key(name: str, node: YamlNode, key: str, *, is_below: bool) -> Mismatch | None:
    """Return what is wrong with a key of a mapping, which has a name."""
    if key == PARAMETERS and is_below:
        message = f"{name}: ros__parameters is inside of other ros__parameters"
        return Mismatch(_PARAMETER_KEY, message, node.key_location(key))
    inner = node.get(key)
    if not is_below and inner and is_misspelt_key(key, inner):
        message = f"{name}: rcl does not know the key {key!r}"
        wrong = Mismatch(_PARAMETER_KEY, message, node.key_location(key))
        return wrong.meaning(key, PARAMETERS)
    return None


def _declared(node: StartedNode, own_node: NodeFacts) -> Facts:
    """Yield the parameters that a node of the workspace declares and reads.

    One for which the node asks has_parameter() need not be declared.
    """
    owner = node.program_path
    guarded = {parameter.name for parameter in own_node.parameters if parameter.is_guard}
    for parameter in own_node.parameters:
        at = parameter.location
        if parameter.name is None:
            yield Open("parameter", owner)
        elif parameter.name in guarded and not parameter.is_declared:
            continue
        elif parameter.is_declared:
            yield Definition("parameter", parameter.name, at, owner)
        else:
            is_optional = not parameter.is_needed
            yield Use("parameter", parameter.name, at, "get_parameter", owner, is_optional)
    for name in _OF_EVERY_NODE:
        yield Definition("parameter", name, own_node.location, owner)


def _given(workspace: Workspace, package: Package, node: StartedNode, own_node: NodeFacts) -> Facts:
    """Yield the parameters that a node of the workspace is given."""
    owner = node.program_path
    if _may_declare_more(workspace, node, own_node):
        yield Open("parameter", owner)
    name_of_node = workspace.code.find_name(node)
    if name_of_node is None and any(given.path for given in node.parameters or ()):
        yield Undecided("parameters", f"the name of {node.executable} is computed")
        return
    name_in_files = _name_in_files(workspace, node, name_of_node or "")
    given = workspace.parameters.read_given(package, node, name_in_files)
    if given.unknown:
        yield Undecided("parameters", given.unknown)
    said = f"the node {name_of_node or node.executable!r}"
    yield from _parameter_uses(workspace, node, given.values, said)
    yield from _types_given(own_node, given.values)
    is_all = not given.unknown and node.arguments == () and name_of_node is not None
    yield from _not_given(workspace, node, own_node, given.values if is_all else None)


def _parameter_uses(
    workspace: Workspace, node: StartedNode, values: ParameterValues, said: str
) -> Iterator[Use | Mismatch]:
    """Yield the names of values that are for a node alone.

    What a file gives to every node, or to another of the same name, need not be declared by it.
    What another launch gives to a program of the same name that declares it does no harm.
    """
    owner = node.program_path
    shared = {*workspace.installed.wildcard_places(node), *_places_of_others(workspace, node)}
    own_node = workspace.code.own_node(node)
    # That the code reads it and does not declare it is a mistake of the code.
    read = set()
    declared = set()
    for parameter in own_node.parameters if own_node else ():
        if parameter.is_declared:
            declared.add(parameter.name)
        elif parameter.is_needed:
            read.add(parameter.name)
    for name, value in values.items():
        if name in read - declared:
            continue
        if value.location in shared or name.startswith("qos_overrides."):
            continue
        other = _other_declaring(workspace, node, name)
        if other is None or not own_node or name in declared:
            yield Use("parameter", name, value.name_location, said, owner)
        elif None not in declared and not _may_declare_more(workspace, node, own_node):
            message = (
                f"the program {node.executable!r} has no parameter {name!r}; {said} of {other!r} "
                "has it"
            )
            yield warning(DEFINED["parameter"], message, value.name_location)._replace(word=name)


def _may_declare_more(workspace: Workspace, node: StartedNode, own_node: NodeFacts) -> bool:
    """Return whether a node of the workspace may declare parameters that are not read."""
    package = workspace.find_package(node)
    assert package  # that has the code of the node
    nodes = workspace.code.by_package[package.name]
    return bool(own_node.doubts) or nodes.has_loose_declarations


def _places_of_others(workspace: Workspace, node: StartedNode) -> Iterator[Location]:
    """Yield the places of parameters that another node of the same name may declare.

    The node is of another program, or a controller, and gets the parameters.
    """
    for given in workspace.parameters.owners.get(workspace.code.find_name(node) or "", ()):
        if given.node.program == node.program:
            continue
        workspace.charge(len(given.values))
        declared = _declared_names(workspace, given.node)
        for name, value in given.values.items():
            may_be_declared = None in declared or name in declared
            if may_be_declared and value.location.path in workspace.installed.yaml:
                yield value.location


def _other_declaring(workspace: Workspace, node: StartedNode, name: str) -> str | None:
    """Return another program that is started as a node of the same name, and has a parameter."""
    for given in workspace.parameters.owners.get(workspace.code.find_name(node) or "", ()):
        facts = workspace.code.own_node(given.node)
        if not facts or given.node.executable == node.executable or name not in given.values:
            continue
        if any(each.name == name and each.is_declared for each in facts.parameters):
            return given.node.executable
    return None


def _declared_names(workspace: Workspace, node: StartedNode) -> set[str | None]:
    """Return the parameters that a node declares; with None where not all are known."""
    facts = workspace.code.own_node(node)
    if not facts or facts.doubts:
        return {None}
    return {parameter.name for parameter in facts.parameters}


def _not_given(
    workspace: Workspace,
    node: StartedNode,
    own_node: NodeFacts,
    values: ParameterValues | None,
) -> Mismatches:
    """Yield the parameters that a node declares without a value, reads, and is not given.

    rclpy and rclcpp raise ParameterUninitializedException. Nothing is said where `values` is
    None: the node may get more than is known.
    """
    if values is None:
        return
    read = {
        own_parameter.name
        for own_parameter in own_node.parameters
        if not own_parameter.is_declared and own_parameter.is_needed
    }
    is_certain = node.when is True and not own_node.doubts
    for parameter in own_node.parameters:
        name = parameter.name
        if parameter.is_unset and name in read and name not in values:
            named = workspace.code.find_name(node) or node.executable
            message = (
                f"the node {named!r} stops without a value of the parameter {name!r}, which it "
                f"declares without one ({parameter.location.file_and_line})"
            )
            yield Mismatch(
                PARAMETER_REQUIRED, message, node.location, parameter.location, is_certain
            )


def _types_given(node: NodeFacts, values: ParameterValues) -> Mismatches:
    """Yield the values of other types than a node declares."""
    for parameter in node.parameters:
        name = parameter.name or ""
        if parameter.is_declared and parameter.is_plain and name in values:
            yield from _other_type(
                name,
                values[name],
                type_in_words(parameter.default),
                parameter.location,
                is_certain=not node.doubts,
            )


def _without_time(workspace: Workspace) -> Mismatches:
    """Yield that `use_sim_time`, which every node declares, is given no boolean."""
    for given in chain.from_iterable(workspace.parameters.owners.values()):
        value = given.values.get("use_sim_time")
        if value:
            yield from _other_type("use_sim_time", value, type_in_words(True), at=None)


def _other_type(
    name: str,
    given: ParameterValue,
    declared: str,
    at: Location | None,
    *,
    is_certain: bool = True,
    reader: str = "its node",
) -> Mismatches:
    """Yield that a parameter is given a value of another type than the node declares."""
    actual = type_in_words(given.value)
    if not declared or not actual or declared == actual:
        return
    there = f" ({at.file_and_line})" if at else ""
    message = (
        f"the parameter {name!r} is given {actual}{given.remark}; {reader} declares "
        f"{declared}{there}, and stops"
    )
    word = name if not given.named_at else ""
    names = (name, *names_of_types(declared, actual))
    yield Mismatch(PARAMETER_TYPE, message, given.location, at, is_certain, word=word, names=names)


_FILTER_SIZE = Rule(
    "filter-size",
    "parameters",
    NO_PARAMETER,
    "An input of a robot_localization filter has 15 values.",
    why=(
        "robot_localization reads each value by its position and does not check their number. A"
        " missing value shifts the others or is read beyond the end."
    ),
    wrong="""
ekf:
  ros__parameters:
    odom0: odom
    odom0_config: [true, true, false, false, false, true,
                   true, false, false, false, false, true, false, false]
""",
    right="""
ekf:
  ros__parameters:
    odom0: odom
    odom0_config: [true, true, false, false, false, true,
                   true, false, false, false, false, true, false, false, false]
""",
    frame="ekf.yaml",
    beside={
        "rover.launch.py": """
Node(
    package='robot_localization',
    executable='ekf_node',
    name='ekf',
    parameters=[os.path.join(share, 'config', 'ekf.yaml')],
),
""",
    },
)


def _filters(tree: YamlNode | None) -> Facts:
    """Yield which values of an input a filter of robot_localization takes, if not 15."""
    for _, section in sections_in(tree) if tree else ():
        for value in values_in(section):
            count = len(value.node.items)
            if value.keys and _INPUT.fullmatch(value.keys[-1]) and count not in (0, 15):
                message = (
                    f"{value.keys[-1]} has {count} values; it needs 15: x y z, angles, their "
                    "rates and accelerations"
                )
                yield Mismatch(_FILTER_SIZE, message, value.node.location)


_ROBOT_TEXT = Rule(
    "robot-text",
    "parameters",
    NO_PARAMETER,
    "robot_description is the text of a robot.",
    why=(
        "robot_state_publisher parses the path as XML and ends with 'Unable to initialize "
        "urdf::model from robot description'."
    ),
    symptoms=(
        Symptom(
            "document-empty",
            pattern=r"Error document empty\.|XML_ERROR_EMPTY_DOCUMENT",
            source="ros/urdfdom 9a1f5b4, urdf_parser/src/model.cpp:101",
            sentence="robot_description is no XML.",
            example="Error: Error=XML_ERROR_EMPTY_DOCUMENT ErrorID=13 (0xd) Line number=0",
        ),
    ),
    wrong="""
Node(
    package='robot_state_publisher',
    executable='robot_state_publisher',
    parameters=[{'robot_description': os.path.join(share, 'urdf', 'rover.urdf')}],
),
""",
    right="""
Node(
    package='robot_state_publisher',
    executable='robot_state_publisher',
    parameters=[{'robot_description': robot}],
),
""",
)


def _robot_as_text(workspace: Workspace, package: Package, node: StartedNode) -> Facts:
    """Yield that a program that needs the text of a robot gets a path in its place."""
    row = row_for(node.program_path, _ROBOT)
    if not row or not row.is_required or node.arguments != ():
        return
    robot = workspace.parameters.given_to(package, node).values.get(_ROBOT)
    if robot and isinstance(robot.value, FileText):
        yield from _file_as_text(workspace, node, robot.location, robot.value)
    if robot and isinstance(robot.value, str):
        text = robot.value.strip()
        if text and not text.startswith("<"):
            advice = "give it the content of the file, not the path"
            message = f"robot_description is no XML, so {node.executable} stops: {advice}"
            yield Mismatch(_ROBOT_TEXT, message, robot.location)


def _file_as_text(workspace: Workspace, node: StartedNode, at: Location, text: FileText) -> Facts:
    """Yield what is wrong with the file whose text a program gets.

    It reads an SDF with the plug-in sdformat_urdf, which a package then declares.
    """
    contents = text.contents
    name = last_part(contents.path)
    is_read = any(package.depends_on("sdformat_urdf") for package in workspace.packages)
    if name.endswith((".sdf", ".world")) and not is_read:
        message = (
            f"robot_description is the text of {name}, which is SDF, and {node.executable} reads "
            "URDF"
        )
        yield Mismatch(_ROBOT_TEXT, message, Location(at.path, *text.at))
    path = workspace.installed.find_source(contents.path)
    data = workspace.tree.read(path, URDF_LIMIT) if path is not None else None
    if path is not None and data is not None:
        if contents.by != "xacro":
            yield from _xacro_as_text(node, at, path, data)
        yield from _only_macros(node, at, path, data)


_ROBOT_EXPANDED = Rule(
    "robot-expanded",
    "parameters",
    NO_PARAMETER,
    "The text of a robot is what xacro makes of its file.",
    why=(
        "Parsers of URDF know no macros and no ${...}. robot_state_publisher stops, or it "
        "publishes a robot without the links that macros add."
    ),
    wrong="""
Node(
    package='robot_state_publisher',
    executable='robot_state_publisher',
    parameters=[{
        'robot_description': open(os.path.join(share, 'urdf', 'rover.urdf.xacro')).read(),
    }],
),
""",
    right="""
Node(
    package='robot_state_publisher',
    executable='robot_state_publisher',
    parameters=[{'robot_description': robot}],
),
""",
    beside={
        "arm/rover.urdf": "",
        "rover.urdf.xacro": """
<robot name="rover" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="size" value="0.3"/>
  <link name="base_link"/>
</robot>
""",
    },
)


def _xacro_as_text(node: StartedNode, at: Location, path: str, data: bytes) -> Facts:
    """Yield that a program gets the text of a xacro file, whose tags only xacro expands."""
    first, *others = data.split(b"<!--")
    written = [first, *(text.partition(b"-->")[2] for text in others)]
    if not any(b"<xacro:" in text for text in written):
        return
    name = last_part(path)
    message = (
        f"robot_description is the text of {name}, which is xacro, and {node.executable} does not "
        "expand it: give it Command(['xacro ', path])"
    )
    yield Mismatch(_ROBOT_EXPANDED, message, at, Location(path, 1, 1))


_ROBOT_LINKS = Rule(
    "robot-links",
    "parameters",
    NO_PARAMETER,
    "The file of a robot that a launch file starts has links.",
    why=(
        "A robot without a link has no root, so the parser refuses it. robot_state_publisher "
        "ends at its start, and nothing publishes the robot."
    ),
    wrong="""
<robot name="rover" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="body" params="size">
    <link name="base_link"/>
  </xacro:macro>
</robot>
""",
    right="""
<robot name="rover" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="body" params="size">
    <link name="base_link"/>
  </xacro:macro>
  <xacro:body size="0.3"/>
</robot>
""",
    frame="rover.urdf.xacro",
    beside={
        "xacro/rover.launch.py": """
import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.substitutions import Command
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description():
    path = os.path.join(get_package_share_directory('rover'), 'urdf', 'rover.urdf.xacro')
    robot = ParameterValue(Command(['xacro ', path]), value_type=str)
    return LaunchDescription([
        Node(
            package='robot_state_publisher',
            executable='robot_state_publisher',
            parameters=[{'robot_description': robot}],
        ),
    ])
""",
    },
    at="launch/rover.launch.py",
)


def _only_macros(node: StartedNode, at: Location, path: str, data: bytes) -> Facts:
    """Yield that a program gets a robot from a file that defines macros and calls none."""
    if b"macro" not in data:
        return
    try:
        elements = list(XmlFile(data, Source.decoded(path, data)).root)
    except XmlFault:  # a problem of the file
        return
    tags = {element.tag for element in elements if isinstance(element.tag, str)}
    macros = [element.get("name") or "" for element in elements if element.tag == _MACRO]
    if macros and tags <= _WITHOUT_LINKS:
        named = enumerated([quoted(name) for name in macros], MAX_NAMED)
        message = (
            f"{path.rpartition('/')[2]} only defines {named} and calls no macro, so the robot has "
            f"no link and {node.executable} stops: call the macro in the file"
        )
        yield Mismatch(_ROBOT_LINKS, message, at, Location(path, 1, 1))


def _robot_as_argument(workspace: Workspace, package: Package, node: StartedNode) -> Facts:
    """Yield that a program is given a robot's file as an argument that it does not read.

    No stated release of the program reads it.
    """
    words = [word for word in node.arguments or () if word is not None]
    if not words or not words[0].endswith((".urdf", ".xacro", ".xml")):
        return
    having = releases_with("program argument", f"{node.program_path} URDF")
    stated = workspace.releases
    if not having or not stated or any(release in having for release in stated):
        return
    if _ROBOT not in workspace.parameters.given_to(package, node).values:
        message = (
            f"{node.executable} takes no file as an argument from "
            f"{RELEASES[RELEASES.index(having[-1]) + 1].title()} on, so it has no robot: give it "
            "the parameter robot_description, with the content of the file"
        )
        yield Mismatch(_ROBOT_TEXT, message, node.location)


def _plugin_lists(tree: YamlNode, elsewhere: Collection[tuple[str, str]]) -> Facts:
    """Yield the entries of lists of plugins that have no section.

    There is none beside them, and none at the same place elsewhere.
    """
    for above, mapping in _mappings(tree):
        for fact in _lists_of_plugins(tree.source.path, mapping):
            if not isinstance(fact, Use):
                yield fact
            elif (above, fact.name) not in elsewhere:
                yield from _missing_section(fact, mapping)


def _lists_of_plugins(path: str, mapping: Mapping[str, YamlNode]) -> Iterator[Definition | Use]:
    """Yield the sections of plugins in a mapping, and the entries of its lists of plugins."""
    sections = {key: node for key, node in mapping.items() if isinstance(node.value, dict)}
    for key, inner in mapping.items() if sections else ():
        if key in _NOT_LISTS or not (key in _LISTS or key.endswith("_plugins")):
            continue
        owner = f"{path}:{inner.location.line}"
        for name, node in sections.items():
            yield Definition("plugin section", name, node.location, owner)
        listed = list(_listed(key, inner))
        names = [name for name, _ in listed]
        # Then only a section that is nearly called so is wrong.
        is_default = not sections.keys() >= set(names) and _is_default(key, names)
        for name, at in listed:
            use = Use("plugin section", name, at, key, owner, optional=is_default)
            yield use._replace(taken=frozenset(names))


def _missing_section(use: Use, mapping: Mapping[str, YamlNode]) -> Iterator[Use | Mismatch]:
    """Yield that the section of a plugin is in one that is beside its list, or else its use.

    Sections without any class are of no plugins: what reads them may find them there.
    """
    if use.optional or use.name in mapping:
        yield use
        return
    holders = _sections_with(use.name, mapping)
    if len(holders) != 1:
        yield use
        return
    [(holder, section)] = holders.items()
    sections = [section, *mapping.values()]
    if use.said != _SOURCES and all(not one.get("plugin") for one in sections):
        return
    message = f"the section {use.name!r} is in {holder!r}, but belongs beside {use.said}"
    is_layer = holder.endswith("layer") or mapping[holder].get("plugin") is not None
    if use.said == _SOURCES and is_layer:
        message = (
            f"{_SOURCES} belongs in {holder!r}, where {use.name!r} is; the costmap does not read "
            "it here"
        )
    yield Mismatch(DEFINED["plugin section"], message, use.location, word=use.name)


def _sections_with(name: str, mapping: Mapping[str, YamlNode]) -> dict[str, YamlNode]:
    """Return the sections of a name in the sections of a mapping, by the names of these."""
    sections = {}
    for holder, beside in mapping.items():
        inner = beside.get(name)
        if inner and isinstance(inner.value, dict):
            sections[holder] = inner
    return sections


def _is_default(key: str, names: Sequence[str]) -> bool:
    """Return whether a list is the default of a parameter, whose plugins need no sections.

    The nodes of Nav2 declare the types of these themselves, and compare the whole list, in its
    order (nav2_costmap_2d/src/costmap_2d_ros.cpp, nav2_planner/src/planner_server.cpp).
    """
    for node in dict.fromkeys(usual_names().values()):
        for row in find_rows(node):
            if row.name == key and row.default == names:
                return True
    return False


def _listed(key: str, node: YamlNode) -> Iterator[tuple[str, Location]]:
    """Yield the names of sections in a list of plugins; a name with a separator is a class."""
    texts = [(item.text or "", item.location) for item in node.items]
    if node.text is not None and key == _SOURCES:
        texts = [(word, node.location) for word in node.text.split()]
    for text, at in texts:
        if text and "/" not in text and "::" not in text:
            yield text, at


_PLUGIN_NAME = Rule(
    "plugin-name",
    "parameters",
    NO_PARAMETER,
    "The class of a plugin is one that exists.",
    why=(
        "pluginlib prints that the class does not exist, with the declared types. The node is "
        "not configured, and the lifecycle manager aborts the start of Nav2."
    ),
    symptoms=(CLASS_DOES_NOT_EXIST,),
    wrong="""
plugins: [obstacle_layer]
obstacle_layer:
  plugin: nav2_costmap_2d/ObstacleLayer
""",
    right="""
plugins: [obstacle_layer]
obstacle_layer:
  plugin: nav2_costmap_2d::ObstacleLayer
""",
    frame="costmap.yaml",
)


def _plugin_names(tree: YamlNode, releases: Collection[Release]) -> Facts:
    """Yield plugins that are written with other separators than pluginlib knows them by.

    pluginlib knows them so in every release that the file may be for.
    """
    values = [value for value in values_in(tree) if value.keys[-1:] == ("plugin",)]
    if not values:
        return
    names = {_SEPARATORS.sub("::", name): name for name in plugin_classes()}
    possible = _releases_of_plugins([value.node.text or "" for value in values], releases)
    if not releases:
        yield from _plugins_of_two_releases(values)
    for value in values:
        text = value.node.text or ""
        meant = names.get(_SEPARATORS.sub("::", text))
        if meant is None or meant == text:
            continue
        having = releases_with("plugin", text)
        if not set(possible).isdisjoint(having) or (having and not releases):
            yield Compared("parameters")  # of another release, at most
            continue
        message = f"{value.said}: there is no plugin {text!r}"
        yield Mismatch(_PLUGIN_NAME, message, value.node.location).meaning(text, meant)


def _plugins_of_two_releases(values: Sequence[YamlValue]) -> Mismatches:
    """Yield the plugin of the newest release in a file, beside one that this has no more."""
    named = []
    for value in values:
        having = releases_with("plugin", value.node.text or "")
        if having:
            named.append((value, [RELEASES.index(release) for release in having]))
    if not named:
        return
    newest, of_newest = max(named, key=lambda each: each[1][0])
    oldest, of_oldest = min(named, key=lambda each: each[1][-1])
    if of_oldest[-1] >= of_newest[0]:
        return
    there = oldest.node.location
    message = (
        f"{newest.node.text!r} is a plugin from {RELEASES[of_newest[0]].title()} on, and "
        f"{oldest.node.text!r} ({there.file_and_line}) until {RELEASES[of_oldest[-1]].title()}: "
        "no release has both"
    )
    yield Mismatch(_PLUGIN_NAME, message, newest.node.location, there)


def _releases_of_plugins(names: Sequence[str], releases: Collection[Release]) -> Sequence[Release]:
    """Return the releases that a file may be for: it has a plugin that none before has."""
    first = 0
    for name in names:
        having = releases_with("plugin", name)
        if any(release in having for release in releases or having):
            first = max(first, RELEASES.index(having[0]))
    return RELEASES[first:]
