"""What only one machine has: paths in a home folder, and environment variables without default."""

import re
from collections.abc import Collection, Iterator, Sequence
from functools import cached_property

from grader.base.patterns import on_use
from grader.base.source import Location, Source
from grader.base.text import counted, cut, enumerated, quoted
from grader.ros.known.releases import RELEASES, Release
from grader.ros.known.ros_machine import ros_machine
from grader.ros.launch.launch_model import Launch
from grader.ros.python.parse import Code, lines_of_docstrings, parse
from grader.workspace.model.stated_releases import releases_in_path
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    Mismatches,
    warning,
)
from grader.workspace.rules.rule_table import (
    ONE_MACHINE,
    Rule,
    Symptom,
)

# A folder of a user, or a workspace of root.
_HOME = on_use(
    r"(?<![\w$}/.:])(?:file://)?"
    r"(/(?:(?:home|Users)/[\w.-]+|root(?=/[\w./-]*/(?:src|install)/))/[^\s\"'<>,;:)}\]]*)"
)
# A folder of a workspace: /ros2_ws/src/rover/map.yaml.
_WORKSPACE = on_use(r"ws/(?:src|install)/[^\s\"'<>,;:)}\]]*+")
_BEFORE = on_use(r"(?<![\w~$}.:/-])((?:/[\w.-]*+)+)\Z")
_PLACEHOLDERS = on_use(r"^/(?:home|Users)/(?:user|username|you|your[\w-]*|<.*)/")
# A file in the folder of a release: /opt/ros/humble/share/nav2_bt_navigator/tree.xml.
_OF_RELEASE = on_use(
    rf"(?<![\w/.-])/opt/ros/(?P<release>{'|'.join(RELEASES)})/share/[^\s\"'<>,;:)}}\]]*+"
)
_TEXTS = (
    *(".yaml", ".yml", ".urdf", ".xacro", ".sdf", ".world", ".json", ".lua"),
    *(".py", ".cpp", ".hpp", ".cc", ".h"),
)
_ENVIRONMENT = on_use(
    r"\bos\.environ\[\s*[\"'](?P<python>\w+)[\"']\s*\](?!\s*=[^=])"
    r"|\bEnvironmentVariable\(\s*(?:name\s*=\s*)?[\"'](?P<launch>\w+)[\"']\s*,?\s*\)"
    r"|\$\(env (?P<xml>\w+)\s*\)"
)
_MAX_SHOWN = 60  # characters of a path


class _TopicNames:
    """The names of topics and services in a workspace, which may be like paths: /home/arm/done."""

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace

    def __contains__(self, path: str) -> bool:
        """Return whether a text is one of the names, or the namespace of one."""
        name = path.rstrip("/")
        return any(f"{other}/".startswith(f"{name}/") for other in self._names)

    @cached_property
    def _names(self) -> set[str]:
        names: set[str | None] = set()
        for facts in self._workspace.code.nodes:
            names.update(endpoint.name for endpoint in facts.endpoints)
        for node in self._workspace.launches.nodes:
            names.add(node.namespace)
            for rule in node.remaps or ():
                names.update(rule)
        return {name for name in names if name is not None}


def machine_facts(workspace: Workspace) -> Facts:
    """Yield paths in home folders and environment variables that a launch file needs.

    A path in somebody's home folder is yielded once a file. Names of topics and services are no
    paths, nor is what comments and docstrings say.

    So is one in the folder of another release of ROS 2 than the workspace is for.

    Those of a launch file at which it reads files are problems of this file, and not yielded.
    """
    topics = _TopicNames(workspace)
    launches = {}
    for package, path, launch in workspace.launches.files:
        launches[package.path(path)] = launch
        yield from _home_values(launch, topics)
    for package in workspace.packages:
        for source in workspace.texts.read_sources(package, _TEXTS):
            if source.path not in launches:
                yield Compared("machine")
                yield from _home_paths(source, (), topics)
                yield from _release_paths(source, workspace.releases)
        for source in workspace.texts.launch_sources(package):
            if source.path in launches:
                yield from _home_paths(source, _said_paths(launches[source.path]), topics)
                yield from _release_paths(source, workspace.releases)
    yield from _variables(workspace)


def _machine_paths(text: str) -> Iterator[tuple[str, int]]:
    """Yield the paths in home folders, and in workspaces at the root of a machine; with offsets."""
    ends = set()
    for path in _HOME.finditer(text):
        ends.add(path.end())
        yield path[1], path.start(1)
    for path in _WORKSPACE.finditer(text):
        start = max(0, path.start() - _MAX_SHOWN)
        before = _BEFORE.search(text[start : path.start()])
        if before and path.end() not in ends:
            yield f"{before[1]}{path[0]}", start + before.start(1)


_HOME_PATH = Rule(
    "home-path",
    "machine",
    ONE_MACHINE,
    "No file names a folder of one user's machine.",
    why=(
        "The folder does not exist for another user, in a container or on the robot. The "
        "program stops there or runs without the file."
    ),
    wrong="self.path = '/home/ann/rover/map.yaml'",
    right="self.path = 'map.yaml'",
    frame="tick/pilot.py",
)


def _home_values(launch: Launch, topics: _TopicNames) -> Mismatches:
    """Yield the first value of a parameter in a launch file that is a path in a home folder."""
    said = {reference.location for reference in launch.references}
    for node in launch.nodes:
        for given in node.parameters or ():
            for value in given.values.values():
                text = value.value if isinstance(value.value, str) else ""
                is_home = (
                    any(offset == 0 for _, offset in _machine_paths(text))
                    and not _PLACEHOLDERS.match(text)
                    and text not in topics
                )
                if is_home and value.location.path == launch.source.path:
                    if value.location not in said:
                        shown = quoted(cut(text, _MAX_SHOWN))
                        message = f"the path {shown} is of one machine"
                        yield warning(_HOME_PATH, message, value.location)
                    return


def _said_paths(launch: Launch) -> list[str]:
    """Return what is said already of the paths in a launch file."""
    said = [reference.reason or reference.path or "" for reference in launch.references]
    for node in launch.nodes:
        for given in node.parameters or ():
            said += [given.path, *(str(value.value) for value in given.values.values())]
    return said


_RELEASE_PATH = Rule(
    "release-path",
    "machine",
    ONE_MACHINE,
    "Files of ROS 2 are found by packages, and not in a release's folder.",
    why=(
        "The folder is missing where another release is installed, so the file is not found. If"
        " both are installed, the file may not fit the nodes."
    ),
    wrong="""
self.tree = '/opt/ros/humble/share/nav2_bt_navigator/behavior_trees/follow_point.xml'
""",
    right="self.tree = 'follow_point.xml'",
    frame="tick/pilot.py",
)


def _release_paths(source: Source, releases: Sequence[Release]) -> Mismatches:
    """Yield the first path of a file in the folder of another release than the workspace is for.

    Code that names the right release, or asks for it, may choose between paths.
    """
    allowed = {*releases, *releases_in_path(source.path)}
    lowered = source.text.lower()
    if any(word in lowered for word in ("ros_distro", *releases)):
        return
    for path in _OF_RELEASE.finditer(source.text) if releases else ():
        if path["release"] not in allowed and _is_code(source, path.start()):
            stated = enumerated(releases, word="or")
            message = (
                f"the path {quoted(cut(path[0], _MAX_SHOWN))} is of {path['release']}, the "
                f"workspace is for {stated}: find the package in place of it"
            )
            yield warning(_RELEASE_PATH, message, source.at(path.start()))
            return


def _is_code(source: Source, offset: int) -> bool:
    """Return whether a place is in no comment and no docstring."""
    if _is_in_comment(source.text, offset):
        return False
    return source.at(offset).line not in _lines_of_docstrings(source)


def _lines_of_docstrings(source: Source) -> Collection[int]:
    """Return the lines that docstrings have in a file; none if it is not Python."""
    if not source.path.endswith(".py"):
        return ()
    code = parse(source.text.encode("utf-8", "replace"), source.path)
    return lines_of_docstrings(code) if isinstance(code, Code) else ()


def _home_paths(source: Source, said: Collection[str], topics: _TopicNames) -> Mismatches:
    """Yield that a file names paths in somebody's home folder, at the first of them.

    Those that are part of what is said otherwise do not count.
    """
    paths = []
    for path, offset in _machine_paths(source.text):
        is_said = _PLACEHOLDERS.match(path) or any(path in text for text in said)
        is_comment = _is_in_comment(source.text, offset)
        if not is_said and not is_comment and path not in topics:
            paths.append((offset, path))
    if paths:
        lines = _lines_of_docstrings(source)
        paths = [(at, path) for at, path in paths if source.at(at).line not in lines]
    if paths:
        offset, first = min(paths)
        message = f"the path {quoted(cut(first, _MAX_SHOWN))} is of one machine"
        if len(paths) > 1:
            message += f"; the file has {len(paths)} such paths"
        yield warning(_HOME_PATH, message, source.at(offset))


def _is_in_comment(text: str, offset: int) -> bool:
    """Return whether a line is a comment up to a place."""
    start = text.rfind("\n", 0, offset) + 1
    return text[start:offset].lstrip().startswith(("#", "//", "*", "<!--", "--"))


_ENVIRONMENT_VARIABLE = Rule(
    "environment-variable",
    "machine",
    ONE_MACHINE,
    "A launch file gives an environment variable a default.",
    why=(
        "Where the variable is not set, ros2 launch stops with an error such as KeyError. It "
        "works only in a shell that sets the variable."
    ),
    symptoms=(
        Symptom(
            "environment-variable",
            pattern=r"environment variable '(?P<variable>\w{1,200}+)' does not exist",
            source="ros2/launch 02595baf, launch/launch/substitutions/environment_variable.py:101",
            sentence="A launch file reads an environment variable that is not set.",
            example="environment variable 'TURTLEBOT3_MODEL' does not exist",
            within=("variable",),
        ),
        Symptom(
            "key-error",
            pattern=r"KeyError: '(?P<variable>\w{1,200}+)'",
            source="python/cpython v3.11.7, Lib/os.py:679",
            sentence="An environment variable, or a key of a dictionary, is missing.",
            example="KeyError: 'ROBOT_MODEL'",
            within=("variable",),
        ),
    ),
    wrong="Node(package='turtlesim', executable='turtlesim_node', name=os.environ['ROVER']),",
    right="""
Node(package='turtlesim', executable='turtlesim_node', name=os.environ.get('ROVER', 'rover')),
""",
)


def _variables(workspace: Workspace) -> Mismatches:
    """Yield the environment variables that launch files need, and do not set or look for.

    Each is yielded once, with the first file that needs it.
    """
    places: dict[str, list[Location]] = {}
    for package in workspace.packages:
        for source in workspace.texts.launch_sources(package):
            for name, at in _needed_variables(source):
                places.setdefault(name, []).append(at)
    for name, needed_at in places.items():
        others = len(needed_at) - 1
        too = f"; {counted(others, 'other launch file needs', 'other launch files need')} it too"
        message = (
            f"the launch file ends with an error where the environment variable {name} is not set: "
            f"give it a default{too if others else ''}"
        )
        yield warning(_ENVIRONMENT_VARIABLE, message, needed_at[0])


def _needed_variables(source: Source) -> Iterator[tuple[str, Location]]:
    """Yield the environment variables without which a launch file ends, each once."""
    seen = set()
    for match in _ENVIRONMENT.finditer(source.text):
        name = match["python"] or match["launch"] or match["xml"]
        is_known = name in ros_machine().environment or name in seen
        seen.add(name)
        if not is_known and not _is_handled(source.text, name):
            yield name, source.at(match.start())


def _is_handled(text: str, name: str) -> bool:
    """Return whether a text sets a variable, or asks whether it is set."""
    word = rf"[\"']{name}[\"']"
    handled = (
        rf"{word}\s+(?:not\s+)?in\s+os\.environ|os\.environ\[{word}\]\s*=[^=]"
        rf"|SetEnvironmentVariable\(\s*(?:name\s*=\s*)?{word}|<set_env\s+name={word}"
        rf"|environ\.(?:get|setdefault)\(\s*{word}|except\s+\(?KeyError"
    )
    return re.search(handled, text) is not None
