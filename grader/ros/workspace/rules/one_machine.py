"""What only one machine has: paths in a home folder, and environment variables without default."""

import re
from collections.abc import Iterator

from grader.base.source import Source
from grader.base.text import cut, quoted
from grader.ros.known.ros_machine import ros_machine
from grader.ros.workspace.model.workspace import Workspace
from grader.ros.workspace.rules.names import Compared, Fact, Mismatch, warning
from grader.ros.workspace.rules.rule_table import (
    ENVIRONMENT_VARIABLE,
    HOME_PATH,
)

_HOME = re.compile(r"(?<![\w$}/.:])(?:file://)?(/(?:home|Users)/[\w.-]+/[^\s\"'<>,;:)}\]]*)")
_PLACEHOLDERS = re.compile(r"^/(?:home|Users)/(?:user|username|you|your[\w-]*|<.*)/")
_TEXTS = (".yaml", ".yml", ".urdf", ".xacro", ".sdf", ".world", ".py", ".cpp", ".hpp")
_ENVIRONMENT = re.compile(
    r"\bos\.environ\[\s*[\"'](?P<python>\w+)[\"']\s*\](?!\s*=[^=])"
    r"|\bEnvironmentVariable\(\s*(?:name\s*=\s*)?[\"'](?P<launch>\w+)[\"']\s*,?\s*\)"
    r"|\$\(env (?P<xml>\w+)\s*\)"
)
_MAX_SHOWN = 60  # characters of a path


def machine_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield paths in home folders and environment variables that a launch file needs.

    A path in somebody's home folder is yielded once a file.

    Paths in launch files are problems of these files.
    """
    launch_files = {package.path(path) for package, path, _ in workspace.launches.files}
    for package in workspace.packages:
        for source in workspace.texts.sources_of(package, _TEXTS):
            if source.path not in launch_files:
                yield Compared("machine")
                yield from _home_paths(source)
    for package in workspace.packages:
        for source in workspace.texts.launch_sources(package):
            yield from _variables(source)


def _home_paths(source: Source) -> Iterator[Mismatch]:
    """Yield that a file names paths in somebody's home folder, at the first of them."""
    paths = [path for path in _HOME.finditer(source.text) if not _PLACEHOLDERS.match(path[1])]
    if paths:
        message = f"the path {quoted(cut(paths[0][1], _MAX_SHOWN))} is of one machine"
        if len(paths) > 1:
            message += f"; the file has {len(paths)} such paths"
        yield warning(HOME_PATH, message, source.at(paths[0].start(1)))


def _variables(source: Source) -> Iterator[Mismatch]:
    """Yield the environment variables that a launch file needs, and does not set or look for."""
    seen: set[str] = set()
    for match in _ENVIRONMENT.finditer(source.text):
        name = match["python"] or match["launch"] or match["xml"]
        if name in ros_machine().environment or name in seen:
            continue
        seen.add(name)
        if _is_handled(source.text, name):
            continue
        message = (
            f"the launch file ends with an error where the environment variable {name} is not set: "
            "give it a default"
        )
        yield warning(ENVIRONMENT_VARIABLE, message, source.at(match.start()))


def _is_handled(text: str, name: str) -> bool:
    """Return whether a text sets a variable, or asks whether it is set."""
    word = rf"[\"']{name}[\"']"
    handled = (
        rf"{word}\s+(?:not\s+)?in\s+os\.environ|os\.environ\[{word}\]\s*=[^=]"
        rf"|SetEnvironmentVariable\(\s*(?:name\s*=\s*)?{word}|<set_env\s+name={word}"
        rf"|environ\.(?:get|setdefault)\(\s*{word}|except\s+\(?KeyError"
    )
    return re.search(handled, text) is not None
