"""Strings of Python launch files that nothing expands, and paths that lack a slash."""

import re
from collections.abc import Iterator

from grader.base.names import first_part
from grader.base.patterns import on_use
from grader.base.source import Location
from grader.base.text import quoted
from grader.ros.installation.places import SHARE
from grader.ros.launch.launch_model import Launch
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import Compared, Facts, Mismatch, Mismatches
from grader.workspace.rules.rule_table import NO_FILE, Rule

# The syntax of shells, and that of launch files in XML.
_UNEXPANDED = on_use(
    r"\$\((?:ros2|find|find-pkg-share|env|var|dirname|rospack)\b[^()]*+\)?|\$HOME\b"
)
_INSTALLED = on_use(rf"{re.escape(SHARE)}/([\w.-]+)")

_LAUNCH_TEXT = Rule(
    "launch-text",
    "files",
    NO_FILE,
    "Strings of a Python launch file have no syntax of a shell or of XML launch files.",
    why=(
        "Python and launch do not expand $(...) and $HOME in a string, and ros2 launch starts no "
        "shell. The program gets these characters, and does not find the file."
    ),
    wrong="Node(package='demo_nodes_cpp', executable='talker', arguments=['$HOME/launch']),",
    right="Node(package='demo_nodes_cpp', executable='talker', arguments=[share + '/launch']),",
)

_JOINED_PATH = Rule(
    "joined-path",
    "files",
    NO_FILE,
    "A path is joined with a slash behind the folder of a package.",
    why=(
        "The path names a folder beside that of the package, where no file is. The program ends "
        "with an error, or shows nothing."
    ),
    wrong="Node(package='demo_nodes_cpp', executable='talker', arguments=[share + 'launch']),",
    right="Node(package='demo_nodes_cpp', executable='talker', arguments=[share + '/launch']),",
)


def launch_text_facts(workspace: Workspace) -> Facts:
    """Yield strings of Python launch files that nothing expands, and paths without a slash.

    They are arguments and parameters of nodes, and what included launch files are given.
    """
    said = set[Location]()
    for launch in workspace.launches.outermost:
        for text, at in _list_texts(launch):
            if at.path.endswith(".py") and at not in said and not text.lstrip().startswith("<"):
                yield Compared("files")
                wrong = [*_unexpanded(text, at), *_without_slash(workspace, text, at)]
                said.update(mismatch.location for mismatch in wrong)
                yield from wrong


def _unexpanded(text: str, at: Location) -> Mismatches:
    """Yield that a text has the syntax of a shell, or of launch files in XML."""
    unexpanded = _UNEXPANDED.search(text)
    if unexpanded:
        message = f"{quoted(unexpanded[0])} is not expanded in a Python launch file"
        yield Mismatch(_LAUNCH_TEXT, message, at)


def _without_slash(workspace: Workspace, text: str, at: Location) -> Mismatches:
    """Yield that a path has the name of a file right behind the folder of an own package."""
    path = _INSTALLED.search(text)
    for package in workspace.packages if path else ():
        assert path
        rest = path[1].removeprefix(package.name or path[1])
        begins = [name for name in package.tree.files if first_part(name) == rest]
        if begins and rest != path[1]:
            message = (
                f"the path has no slash between the folder of {quoted(package.name)} and "
                f"{quoted(rest)}"
            )
            yield Mismatch(_JOINED_PATH, message, at)


def _list_texts(launch: Launch) -> Iterator[tuple[str, Location]]:
    """Yield the texts that a launch file gives to what it starts, with their places."""
    for node in launch.nodes:
        for word in node.arguments or ():
            yield word or "", node.location
        for given in node.parameters or ():
            for value in given.values.values():
                yield value.value if isinstance(value.value, str) else "", value.location
    for passed in launch.passed:
        yield from ((text or "", passed.location) for _, text in passed.values)
