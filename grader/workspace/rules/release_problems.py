"""Names of other releases of ROS 2 than those that a workspace is for."""

import re
from collections.abc import Iterator, Mapping

from grader.base.errors import NotDecided
from grader.base.names import first_part, last_part
from grader.base.patterns import on_use
from grader.base.problems import Problem
from grader.base.source import Location
from grader.ros.config.yaml_nodes import YamlNode
from grader.ros.config.yaml_values import sections_in, values_in
from grader.ros.known.releases import NameKind, names_without, other_name
from grader.ros.xml.elements import first_text
from grader.workspace.graph.graph import make_graph
from grader.workspace.graph.launch_graph import connections_in
from grader.workspace.graph.started_controllers import defined_controllers
from grader.workspace.model.stated_releases import deciding_launch_files, releases_in_path
from grader.workspace.model.text_files import CPP_ENDINGS
from grader.workspace.model.workspace import Workspace
from grader.workspace.model.workspace_folder import TOO_MUCH
from grader.workspace.rules.name_problems import name_problems
from grader.workspace.rules.names import Agreement
from grader.workspace.rules.reading import read_agreement
from grader.workspace.rules.rule_table import OTHER_RELEASE, UNCOMPARED, Rule
from grader.workspace.rules.shared_symptoms import (
    CLASS_DOES_NOT_EXIST,
)

_DEPENDENCY = on_use(r"<\w*depend>\s*([\w-]+)\s*</")
_PLUGIN_KEYS = ("plugin", "robot_model_type")


_NAMES_COMPARED = Rule(
    "names-compared",
    "files",
    UNCOMPARED,
    "All names of a workspace are compared.",
    why=(
        "Mistakes in the remaining names appear only when the workspace runs. A rubric leaves "
        "these names to manual grading."
    ),
    wrong="""
*[Node(package='arm', executable='driver', name='driver_%d' % i) for i in range(2000)],
""",
    right="""
*[Node(package='arm', executable='driver', name='driver_%d' % i) for i in range(5)],
""",
    at="launch/rover.launch.py",
)


def compared_names(workspace: Workspace) -> Iterator[Problem]:
    """Yield the names of a workspace that do not agree, then those of other releases."""
    agreement = read_agreement(workspace)
    yield from name_problems(workspace)
    try:
        yield from _release_problems(workspace, agreement)
    except NotDecided:
        assert workspace.folder.is_spent
    if workspace.folder.is_spent:
        start = Location(next(iter(workspace.tree.files), ""), 1, 1)
        yield _NAMES_COMPARED.problem(f"not all names are compared: {TOO_MUCH}", start)


_NAME_RELEASE = Rule(
    "name-release",
    "words",
    OTHER_RELEASE,
    "Packages, programs, controllers, plugins and topics are of the stated release.",
    why=(
        "The installed packages do not have the name: ros2 launch or pluginlib reports that it "
        "is not found, or messages go to a topic without a reader."
    ),
    symptoms=(CLASS_DOES_NOT_EXIST,),
    wrong="""
planner_plugins: [GridBased]
GridBased:
  plugin: nav2_navfn_planner/NavfnPlanner
""",
    right="""
planner_plugins: [GridBased]
GridBased:
  plugin: nav2_navfn_planner::NavfnPlanner
""",
    frame="costmap.yaml",
)


def _release_problems(workspace: Workspace, agreement: Agreement) -> list[Problem]:
    """Return the names that no stated release has, each once in a file.

    Those that are said not to agree are not among them.
    """
    if not workspace.releases:
        return []
    said = {
        mismatch.location for mismatch in agreement.mismatches if mismatch.family != "dependencies"
    }
    deciding = deciding_launch_files(workspace)
    problems: dict[tuple[str, str], Problem] = {}
    for reader in _READERS:
        for kind, name, at, owner in reader(workspace):
            if at in said or at.path in deciding:
                continue
            releases = {*workspace.releases, *releases_in_path(at.path)}
            other = other_name(kind, name, releases, shown=owner)
            if other:
                problem = _NAME_RELEASE.problem(other.message, at, kind)
                problems.setdefault((other.message, at.path), problem)
    return sorted(
        problems.values(),
        key=lambda release_problem: (
            release_problem.location.path,
            release_problem.location.line,
            release_problem.location.column,
        ),
    )


_Use = tuple[NameKind, str, Location, str]  # with the start of the name that is not shown


def _uses_in_robots(workspace: Workspace) -> Iterator[_Use]:
    """Yield the plugins of Gazebo and of ros2_control that robots load, but for own ones."""
    own_packages = workspace.own_packages
    for robot in workspace.robots.known:
        for element in robot.root.iter("plugin"):
            name = element.get("filename", "") or first_text(element)
            package = first_part(name).removeprefix("lib").removesuffix(".so")
            if package not in own_packages:
                yield "plugin", name, robot.place(element), ""


def _uses_in_yaml(workspace: Workspace) -> Iterator[_Use]:
    """Yield the plugins, controllers and parameters in YAML files."""
    types = {}
    for controller in defined_controllers(workspace):
        types[controller.name] = controller.type.text or ""
        if not workspace.texts.has_plugin(types[controller.name]):
            yield "controller", types[controller.name], controller.type.location, ""
    for tree in workspace.installed.trees:
        for value in values_in(tree):
            if value.keys and value.keys[-1] in _PLUGIN_KEYS:
                yield "plugin", value.node.text or "", value.node.location, ""
        yield from _parameters_in(tree, types)


def _parameters_in(tree: YamlNode, types: Mapping[str, str]) -> Iterator[_Use]:
    """Yield the parameters in a YAML file, of the types that controllers have by their names."""
    for keys, section in sections_in(tree):
        name = last_part(keys[-1]) if keys else ""
        owner = f"{types.get(name, name)}/"
        for value in values_in(section):
            yield "parameter", owner + ".".join(value.keys), value.node.location, owner


def _uses_in_launch_files(workspace: Workspace) -> Iterator[_Use]:
    """Yield the packages, programs and launch files in launch files."""
    for package, node in workspace.launches.placed_nodes:
        if not package.find(node.package):
            yield "package", node.package, node.location, ""
            owner = f"{node.package}/"
            yield "program", f"{owner}{node.executable}", node.location, owner
    for package, _, launch in workspace.launches.files:
        for passed in launch.passed:
            parts = passed.path.split("/")
            if parts[0] == "share" and len(parts) > 1 and not package.find(parts[1]):
                yield "package", parts[1], passed.location, ""
                owner = f"{parts[1]}/"
                yield "launch file", owner + parts[-1], passed.location, owner


def _topics_of_controllers(workspace: Workspace) -> Iterator[_Use]:
    """Yield the topics that are those of controllers, by their names.

    One that something publishes and something else reads needs no controller.
    """
    types = {defined.name: defined.type.text or "" for defined in defined_controllers(workspace)}
    met = _met_topics(workspace) if types else set()
    for topic, at in _topics(workspace) if types else ():
        controller, _, last = topic.strip("/ ").rpartition("/")
        owner = types.get(last_part(controller), "")
        if owner and f"/{controller}/{last}" not in met:
            yield "topic", f"{owner}/{last}", at, f"{owner}/"


def _met_topics(workspace: Workspace) -> set[str]:
    """Return the topics on which the nodes of a launch file meet."""
    met = set[str]()
    for launched in make_graph(workspace).launched:
        met.update(connection.name for connection in connections_in(launched))
    return met


def _topics(workspace: Workspace) -> Iterator[tuple[str, Location]]:
    """Yield the topics that remappings and own nodes in Python name."""
    for robot in workspace.robots.known:
        for element in robot.root.iter("remapping"):
            for topic in (element.text or "").split(":="):
                yield topic, robot.place(element)
    for node in workspace.launches.nodes:
        for names in node.remaps or ():
            yield from ((topic, node.location) for topic in names)
        facts = workspace.code.own_node(node)
        for endpoint in facts.endpoints if facts else ():
            yield node.topic(endpoint.name or "") or "", endpoint.location


def _declared(workspace: Workspace) -> Iterator[_Use]:
    """Yield the packages that package.xml declares without a condition."""
    for package in workspace.packages:
        manifest = package.manifest
        if not manifest:
            continue
        for match in _DEPENDENCY.finditer(manifest.source.text):
            name = match[1]
            if name in manifest.dependencies and not package.find(name):
                yield "package", name, manifest.source.at(match.start(1)), ""


def _uses_in_code(workspace: Workspace) -> Iterator[_Use]:
    """Yield the classes in C++ that no stated release has; the others are not looked for."""
    names = names_without("class", workspace.releases)
    if not names:
        return
    pattern = re.compile(rf"//[^\n]*|/\*.*?(?:\*/|\Z)|\b({'|'.join(names)})\b", re.DOTALL)
    for source in workspace.texts.every_source(CPP_ENDINGS):
        for match in pattern.finditer(source.text):
            if match[1] is not None:  # not of a comment
                yield "class", match[1], source.at(match.start()), ""


_READERS = (
    _uses_in_code,
    _uses_in_robots,
    _uses_in_yaml,
    _uses_in_launch_files,
    _topics_of_controllers,
    _declared,
)
