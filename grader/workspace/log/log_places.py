"""Where the files of a workspace say why a message of a log was said, besides findings of rules."""

import re
from collections.abc import Callable, Iterator
from itertools import pairwise

from grader.base.errors import NotDecided
from grader.base.names import last_part
from grader.base.patterns import on_use
from grader.base.source import Location
from grader.base.text import enumerated, quoted
from grader.ros.known.released import is_released
from grader.ros.launch.launch_model import Launch
from grader.ros.package.package import CMAKE, MANIFEST, SETUP, Package
from grader.workspace.graph.launch_graph import GraphTransform
from grader.workspace.graph.transform_edges import edges_in
from grader.workspace.log.known_messages import KnownMessage, PlacedAnswer
from grader.workspace.log.robot_places import (
    find_hardware_without_plugin,
    find_invalid_inertias,
    find_systems_without_states,
)
from grader.workspace.model.launches import CONTROL_NODE, MANAGER, SPAWNERS
from grader.workspace.opening.opened import OpenedWorkspace

_PACKAGES = on_use(r"^[ \t]*+packages[ \t]*+=", re.MULTILINE)
_DESCRIPTION = "robot_description"
_QUOTED_DESCRIPTION = on_use(rf"[\"']{_DESCRIPTION}[\"']")
_COMMAND = on_use(r"\bCommand\(")
_TEXTS = (
    *(".urdf", ".xacro", ".sdf", ".world", ".srdf", ".rviz", ".yaml", ".yml", ".xml", ".py"),
    *(".txt", ".cpp", ".hpp", ".h"),
)
_MAX_PUBLISHERS = 3  # of a frame, that are named
_MAX_TEXT = 512 * 1024  # bytes of a file in which a line is searched


def search_place(opened: OpenedWorkspace, known: KnownMessage) -> Iterator[PlacedAnswer]:
    """Return what the place of a row says of a message; nothing where the files do not prove it.

    Raises NotDecided where the budget of the workspace is spent.
    """
    place = known.row.place
    if place in _PLACES:
        yield from map(known.placed, _PLACES[place](opened, known))
    elif place in _SEARCHES:
        yield from _SEARCHES[place](opened, known)


def _find_text(opened: OpenedWorkspace, known: KnownMessage) -> Iterator[Location]:
    """Yield the first place of a text with the names of a message in each file of the packages."""
    names = {group: re.escape(name) for group, name in known.groups.items()}
    text = re.compile(known.row.key.format_map(names))
    for package in opened.packages:
        for source in opened.workspace.texts.read_sources(package, _TEXTS):
            match = text.search(source.text)
            if match:
                yield source.at(match.start())


def _of_package(opened: OpenedWorkspace, known: KnownMessage) -> Iterator[PlacedAnswer]:
    """Yield that a package is ignored or not built, or that it is not installed and needed."""
    name = known.groups["package"]
    for package in opened.packages:
        if name == package.name:
            folder = package.folder or "the folder"
            text = (
                f"the package is in {folder}, so it is not built, or install/setup.bash is not "
                "sourced in this terminal"
            )
            if package.ignored_by:
                text = f"colcon does not build {quoted(name)} because of this file: remove it"
            path = package.ignored_by or package.path(MANIFEST)
            yield PlacedAnswer(Location(path, 1, 1), text)
            return
    releases = opened.workspace.releases
    distro = releases[0] if len(releases) == 1 else "DISTRO"
    text = f"neither the workspace nor ROS 2 {distro.title()} has a package {quoted(name)}"
    if is_released(name, releases):
        apt = f"sudo apt install ros-{distro}-{name.replace('_', '-')}"
        text = f"the package {quoted(name)} is not installed: {apt}"
    for package, place in _find_uses(opened, name):
        lacking = f"; package.xml of {quoted(package.name)} does not declare it"
        is_declared = package.depends_on(name) or not is_released(name, releases)
        yield PlacedAnswer(place, text if is_declared else text + lacking)


def _find_uses(opened: OpenedWorkspace, name: str) -> Iterator[tuple[Package, Location]]:
    """Yield the packages that start a node of a package, or whose builds look for it."""
    for package, node in opened.workspace.launches.placed_nodes:
        if node.package == name:
            yield package, node.location
    sought = re.compile(rf"(?i)\bfind_package[ \t]*+\([ \t]*+{re.escape(name)}(?![\w-])")
    for package in opened.packages:
        text = package.tree.read(CMAKE, _MAX_TEXT)
        place = _line_with(sought, package.path(CMAKE), text) if text is not None else None
        if place:
            yield package, place


def _find_parameter(opened: OpenedWorkspace, known: KnownMessage) -> Iterator[Location]:
    """Yield where a parameter is missing: the section around it is there."""
    *above, last = known.row.key.split("/")
    keys = [part.format_map(known.groups) for part in above]
    for tree in opened.workspace.installed.trees:
        section = tree.get(*keys)
        name = last.format_map(known.groups)
        if not section or not isinstance(section.value, dict) or name in section.value:
            continue
        if name != last and keys == above and not tree.get(name):
            continue  # the file says nothing of it
        yield tree.key_location(*keys)


def _find_packages_of_module(opened: OpenedWorkspace, known: KnownMessage) -> Iterator[Location]:
    """Yield that setup.py does not install a module that its package has."""
    path = known.groups["module"].replace(".", "/")
    for package in opened.packages:
        is_there = f"{path}.py" in package.tree.files or f"{path}/__init__.py" in package.tree.files
        setup = package.tree.read(SETUP, _MAX_TEXT)
        installation = package.installation
        if not is_there or setup is None or not installation:
            continue
        if known.groups["module"] in installation.packages:
            continue
        place = _line_with(_PACKAGES, package.path(SETUP), setup)
        if place and "/" in path:
            yield place


def _line_with(pattern: "re.Pattern[str]", path: str, data: bytes) -> Location | None:
    text = data.decode("utf-8", "replace")
    match = pattern.search(text)
    if not match:
        return None
    return Location(path, text.count("\n", 0, match.end()) + 1, 1)


def _find_frame(opened: OpenedWorkspace, known: KnownMessage) -> Iterator[Location]:
    """Yield the Fixed Frame of RViz, if nothing publishes it that launch files may start."""
    frame = known.groups["frame"]
    if not known.row.otherwise or opened.workspace.launches.has_more_nodes:
        return
    if _list_edges(opened, frame):
        return
    fixed = re.compile(rf"^ *+Fixed Frame: {re.escape(frame)}$", re.MULTILINE)
    for path in opened.whole_tree.files:
        source = opened.source(path) if path.endswith(".rviz") else None
        match = fixed.search(source.text) if source else None
        if source and match:
            yield source.at(match.end())


def _find_robot_parameter(opened: OpenedWorkspace, _: KnownMessage) -> Iterator[Location]:
    """Yield where a launch file gives the text of a robot without saying that it is a text."""
    for package in opened.packages:
        for source in opened.workspace.texts.launch_sources(package):
            match = _QUOTED_DESCRIPTION.search(source.text)
            if match and "ParameterValue" not in source.text:
                yield source.at(match.start())


def _of_manager(opened: OpenedWorkspace, known: KnownMessage) -> Iterator[PlacedAnswer]:
    """Yield the spawners that ask another controller manager than their launch file starts."""
    asked = known.groups["manager"].removesuffix("/list_controllers")
    for launch in opened.workspace.launches.outermost:
        managers = _find_managers(launch)
        for name, at in managers.items() if asked not in managers else ():
            text = (
                f"the spawner asks {asked}, but the controller manager is {name} "
                f"({at.file_and_line}): give both one namespace, or use --controller-manager"
            )
            for node in launch.nodes:
                if node.executable in SPAWNERS:
                    yield PlacedAnswer(node.location, text)


def _find_managers(launch: Launch) -> dict[str, Location]:
    """Return the places of the controller managers that a launch file starts, by their names."""
    managers = {}
    for node in launch.nodes:
        if node.executable == CONTROL_NODE and node.namespace is not None:
            managers[node.full_name(node.node_name or MANAGER)] = node.location
    return managers


def _of_description(opened: OpenedWorkspace, known: KnownMessage) -> Iterator[PlacedAnswer]:
    """Yield the programs that read a robot from a topic that their launch file does not publish."""
    asked = known.groups.get("topic", _DESCRIPTION)
    for launch in opened.workspace.launches.outermost:
        published = {}
        for node in launch.nodes:
            if node.is_state_publisher:
                published[node.topic(_DESCRIPTION)] = node.location
        for node in launch.nodes if published and None not in published else ():
            words = dict(pairwise([*(node.arguments or ()), ""]))
            read = [node.topic(asked), node.topic(f"~/{asked}")]
            spawned = (words.get("-topic") or "").strip("/")
            is_reader = spawned == asked or node.executable == CONTROL_NODE
            if is_reader and published.keys().isdisjoint(read):
                topics = [f"{name} ({at.file_and_line})" for name, at in published.items()]
                text = f"{node.executable} reads {read[0]}; the robot is on {enumerated(topics)}"
                yield PlacedAnswer(node.location, text)


def _find_spaced_commands(opened: OpenedWorkspace, known: KnownMessage) -> Iterator[Location]:
    """Yield where a launch file gives a command a path that has a space on this machine."""
    name = last_part(known.groups["path"])
    if " " not in known.groups["path"]:
        return
    for package in opened.packages:
        for source in opened.workspace.texts.launch_sources(package):
            match = _COMMAND.search(source.text) if name in source.text else None
            if match:
                yield source.at(match.start())


def paths_of_publishers(opened: OpenedWorkspace, frame: str) -> frozenset[str]:
    """Return the parameter files of the nodes that publish a frame, in the workspace.

    Raises NotDecided where the budget of the workspace is spent.
    """
    places = {edge.location[:2] for edge in _list_edges(opened, frame)}
    paths = set()
    for node in opened.workspace.launches.nodes:
        for given in node.parameters or () if node.location[:2] in places else ():
            paths.add(opened.workspace.installed.find_source(given.path))
    return frozenset(path for path in paths if path is not None)


def say_publishers(opened: OpenedWorkspace, frame: str) -> str:
    """Return what the launch files start that publishes a frame, as a sentence after another."""
    try:
        edges = _list_edges(opened, frame)
    except NotDecided:
        return ""
    by = dict.fromkeys(f"{edge.by} ({edge.location.file_and_line})" for edge in edges)
    if by:
        return f" {quoted(frame)} is published by {enumerated(by, _MAX_PUBLISHERS)}."
    return f" Nothing that is known of the launch files publishes {quoted(frame)}."


def _list_edges(opened: OpenedWorkspace, frame: str) -> list[GraphTransform]:
    """Return the transforms with a frame that launch files have published. Raises NotDecided."""
    edges = []
    for number, _ in enumerate(opened.workspace.launches.roots):
        for edge in edges_in(opened.workspace, number):
            if frame in (edge.parent, edge.child):
                edges.append(edge)
    return edges


_Search = Callable[[OpenedWorkspace, KnownMessage], Iterator[PlacedAnswer]]
_SEARCHES = {
    "package": _of_package,
    "manager": _of_manager,
    "description": _of_description,
}
_Find = Callable[[OpenedWorkspace, KnownMessage], Iterator[Location]]
# The places of which the row says what is wrong there.
_PLACES = {
    "parameter": _find_parameter,
    "module": _find_packages_of_module,
    "spaced path": _find_spaced_commands,
    "robot parameter": _find_robot_parameter,
    "frame": _find_frame,
    "text": _find_text,
    "hardware": find_hardware_without_plugin,
    "states": find_systems_without_states,
    "inertia": find_invalid_inertias,
}
