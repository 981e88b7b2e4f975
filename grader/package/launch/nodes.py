"""The nodes that a launch file starts: by Node, by a command, or by urdf_launch."""

import re

from grader.names import did_you_mean
from grader.package.launch.commands import PART_UNKNOWN
from grader.package.launch.context import Context
from grader.package.launch.findings import Findings
from grader.package.launch.model import StartedNode
from grader.package.launch.references import (
    RVIZ,
    STATE_PUBLISHER,
    command_words,
    find_configuration,
    find_description,
    find_urdf_launch,
)
from grader.package.launch.substitutions import resolve
from grader.static_python.positions import START
from grader.static_python.values import UNKNOWN_KEYS, Call, Unknown, Value

# The arguments of launch_ros.actions.Node, and those that it passes on to launch.actions.ExecuteProcess (ROS 2 Jazzy).
_NODE_ARGUMENTS = frozenset(
    {"package", "executable", "name", "namespace", "exec_name", "parameters", "remappings", "ros_arguments", "arguments",
     "prefix", "cwd", "env", "additional_env", "shell", "sigterm_timeout", "sigkill_timeout", "emulate_tty", "output",
     "output_format", "cached_output", "log_cmd", "on_exit", "respawn", "respawn_delay", "respawn_max_retries", "condition",
     "autostart", UNKNOWN_KEYS}
)  # fmt: skip
_NO_PACKAGE = Unknown("a node without a package is a program of the machine", START)
# The launch files of the ROS 2 package urdf_launch; what they start is known.
_URDF_LAUNCH = re.compile(r".*/share/urdf_launch/launch/(?P<name>display|description)\.launch\.py")


def start_node(findings: Findings, call: Call, context: Context, when: bool | None) -> None:
    """Add the node that a Node action starts, and the files that it is given."""
    for name in call.kwargs.keys() - _NODE_ARGUMENTS:
        context.add_error(f"Node has no argument {name!r}{did_you_mean(name, _NODE_ARGUMENTS)}", call.at)
    if call.args:
        context.add_error("Node takes keyword arguments only: package=..., executable=...", call.at)
    if call.kwargs.keys().isdisjoint(("executable", "node_executable", UNKNOWN_KEYS)):
        context.add_error("a node has no executable: add executable=...", call.at)
    package = resolve(call.kwargs.get("package", _NO_PACKAGE), context)
    executable = resolve(call.kwargs.get("executable", call.kwargs.get("node_executable")), context)
    if isinstance(package, str) and isinstance(executable, str):
        _start(findings, package, executable, call, context, when)
        return
    unknown = executable if isinstance(package, str) else package
    findings.add_unknown(
        unknown.reason if isinstance(unknown, Unknown) else "the program of a node is known only at run time", call.at
    )


def start_process(findings: Findings, call: Call, context: Context, when: bool | None) -> None:
    """Add the node that a command starts: ros2 run, or rviz2."""
    words = command_words(call.argument(0, "cmd"), context)
    if call.kwargs.get("shell") is True:
        words = " ".join(words).split()
    match words:
        case ["ros2", "run", package, executable, *rest]:
            _start(findings, package, executable, _as_node(call, rest), context, when)
        case ["rviz2" as executable, *rest]:
            _start(findings, executable, executable, _as_node(call, rest), context, when)
        case ["ros2", "launch", *_] if when is not False:
            findings.add_unknown("it starts another ros2 launch", call.at)


def start_urdf_launch(findings: Findings, path: str, call: Call, context: Context) -> bool:
    """Add what an included launch file of urdf_launch starts; return whether the path is one of these files."""
    known = _URDF_LAUNCH.fullmatch(path)
    if known is None:
        return False
    for node in find_urdf_launch(findings, known["name"], call, context):
        findings.nodes.append(StartedNode(node, node, context.when, findings.locate(call.at)))
    return True


def _start(findings: Findings, package: str, executable: str, call: Call, context: Context, when: bool | None) -> None:
    findings.nodes.append(StartedNode(package, executable, when, findings.locate(call.at)))
    if when is False:
        return
    for name in ("parameters", "arguments", "remappings"):
        if isinstance(call.kwargs.get(name), str | dict):
            context.add_error(f"{name} has to be a list: put [ ] around it", call.at)
    if executable == STATE_PUBLISHER:
        find_description(findings, call, context)
    elif executable == RVIZ:
        find_configuration(findings, call, context)


def _as_node(call: Call, words: list[str]) -> Call:
    """Return a command as the Node action that starts the same."""
    unknown = Unknown("a part of the command is known only at run time", call.at)
    arguments: list[Value] = [unknown if word == PART_UNKNOWN else word for word in words]
    return Call(call.name, [], {"arguments": arguments}, call.at)
