"""The nodes that a launch file starts, by Node or a command, and the files that they are given."""

import re

from grader.names import did_you_mean
from grader.package.launch.command_words import command_words, items_in
from grader.package.launch.commands import PART_UNKNOWN
from grader.package.launch.model import STATE_PUBLISHER, Contents, Context, Findings, NamedFile, StartedNode
from grader.package.launch.substitutions import resolve
from grader.static_python.values import UNKNOWN_KEYS, Call, Unknown, Value

# The arguments of launch_ros.actions.Node, and those that it passes on to launch.actions.ExecuteProcess (ROS 2 Jazzy).
_NODE_ARGUMENTS = frozenset(
    {"package", "executable", "name", "namespace", "exec_name", "parameters", "remappings", "ros_arguments",
     "arguments", "prefix", "cwd", "env", "additional_env", "shell", "sigterm_timeout", "sigkill_timeout",
     "emulate_tty", "output", "output_format", "cached_output", "log_cmd", "on_exit", "respawn", "respawn_delay",
     "respawn_max_retries", "condition", "autostart", UNKNOWN_KEYS}
)  # fmt: skip
_RVIZ = "rviz2"
# The errors where robot_description is given a call whose last method is missing.
_UNFINISHED = {
    "xacro.process_file": (
        "robot_description is given a document, not its text: add .toxml() to xacro.process_file(...)"
    ),
    "builtins.open": "robot_description is given an open file, not its contents: add .read() to open(...)",
}


def start_node(findings: Findings, call: Call, context: Context, when: bool | None) -> None:
    """Add the node that a Node action starts, and the files that it is given."""
    for name in call.kwargs.keys() - _NODE_ARGUMENTS:
        context.add_error(f"Node has no argument {name!r}{did_you_mean(name, _NODE_ARGUMENTS)}", call.at)
    if call.args:
        context.add_error("Node takes keyword arguments only: package=..., executable=...", call.at)
    if call.kwargs.keys().isdisjoint(("executable", "node_executable", UNKNOWN_KEYS)):
        context.add_error("a node has no executable: add executable=...", call.at)
    no_package = Unknown("a node without a package is a program of the machine", call.at)
    package = resolve(call.kwargs.get("package", no_package), context)
    executable = resolve(call.kwargs.get("executable", call.kwargs.get("node_executable")), context)
    if isinstance(package, str) and isinstance(executable, str):
        _start(findings, package, executable, call, context, when)
        return
    unknown = executable if isinstance(package, str) else package
    reason = "the program of a node is known only at run time"
    findings.add_unknown(unknown.reason if isinstance(unknown, Unknown) else reason, call.at)


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


def _start(findings: Findings, package: str, executable: str, call: Call, context: Context, when: bool | None) -> None:
    prefix = _frame_prefix(call, context) if executable == STATE_PUBLISHER else ""
    findings.nodes.append(StartedNode(package, executable, when, findings.locate(call.at), prefix))
    if when is False:
        return
    for name in ("parameters", "arguments", "remappings"):
        if isinstance(call.kwargs.get(name), str if name == "arguments" else str | dict):
            context.add_error(f"{name} has to be a list: put [ ] around it", call.at)
    if executable == STATE_PUBLISHER:
        _find_description(findings, call, context)
    elif executable == _RVIZ:
        _find_configuration(findings, call, context)


def _as_node(call: Call, words: list[str]) -> Call:
    """Return a command as the Node action that starts the same."""
    unknown = Unknown("a part of the command is known only at run time", call.at)
    arguments: list[Value] = [unknown if word == PART_UNKNOWN else word for word in words]
    return Call(call.name, [], {"arguments": arguments}, call.at)


def _frame_prefix(call: Call, context: Context) -> str | None:
    """Return the parameter frame_prefix of a node."""
    tables = [table for table in items_in(call.kwargs.get("parameters")) if isinstance(table, dict)]
    given: list[Value] = [table["frame_prefix"] for table in tables if "frame_prefix" in table]
    for name in ("arguments", "ros_arguments"):
        words = command_words(call.kwargs.get(name), context)
        given += [word.partition(":=")[2] for word in words if word.startswith("frame_prefix:=")]
    found = resolve(given[-1], context) if given else ""
    return found if isinstance(found, str) and PART_UNKNOWN not in found else None


def _find_description(findings: Findings, call: Call, context: Context) -> None:
    """Add the file that robot_state_publisher gets the robot from."""
    parameters = items_in(call.kwargs.get("parameters"))
    tables = [table for table in parameters if isinstance(table, dict)]
    descriptions = [table["robot_description"] for table in tables if "robot_description" in table]
    if descriptions:
        _refer_description(findings, descriptions[-1], call, context)
        return
    unclear = next((value for value in parameters if not isinstance(value, dict) or UNKNOWN_KEYS in value), None)
    words = command_words(call.kwargs.get("arguments"), context)
    end = words.index("--ros-args") if "--ros-args" in words else len(words)
    files = [word for word in words[:end] if not word.startswith("-")]
    others = words or unclear is not None or {UNKNOWN_KEYS, "ros_arguments"} & call.kwargs.keys()
    if isinstance(unclear, Unknown):
        findings.refer("urdf", unclear, call)
    elif files and files[0] != PART_UNKNOWN:
        findings.refer("urdf", files[0], call)
    elif others or findings.sets_parameters:
        findings.refer("urdf", Unknown("its parameters are known only at run time", call.at), call)
    else:
        message = "robot_state_publisher is started without robot_description: it has no robot to publish"
        findings.refer("urdf", None, call, wrong=message)


def _refer_description(findings: Findings, value: Value, call: Call, context: Context) -> None:
    if isinstance(value, Call) and value.name in _UNFINISHED:
        findings.refer("urdf", None, call, value, wrong=_UNFINISHED[value.name])
        return
    match description := resolve(value, context):
        case Contents(path=path, by=by) if by != "xacro" and path.endswith(".xacro"):
            name = path.rpartition("/")[2]
            message = f"{name} is read without xacro; if it uses xacro, write Command(['xacro ', ...])"
            findings.references.append(NamedFile("urdf", path, findings.locate(call.at), message, sure=False, by=by))
        case str() if "<robot" not in description:
            message = "robot_description is given the path of the URDF, not its contents: read the file first"
            findings.refer("urdf", None, call, value, wrong=message)
        case Contents() | Unknown():
            findings.refer("urdf", description, call, value)


def _find_configuration(findings: Findings, call: Call, context: Context) -> None:
    """Add the configuration that RViz opens."""
    arguments = call.kwargs.get("arguments", call.kwargs.get(UNKNOWN_KEYS))
    if isinstance(arguments, Unknown):
        findings.refer("rviz", arguments, call)
        return
    words = command_words(arguments, context)
    path = _display_config(words)
    if path is None and PART_UNKNOWN not in words:
        message = (
            "rviz2 is started without -d and a file, so it opens its own default instead of the lab's configuration"
        )
        findings.refer("rviz", None, call, wrong=message)
    elif path is None or PART_UNKNOWN in path:
        resolved = (resolve(piece, context) for piece in items_in(arguments))
        unknown = (piece for piece in resolved if isinstance(piece, Unknown))
        unnamed = Unknown("the file that it opens is known only at run time", call.at)
        findings.refer("rviz", next(unknown, unnamed), call)
    elif path != path.lstrip():
        findings.refer("rviz", None, call, wrong="'-d' and the path have to be two items of arguments: ['-d', path]")
    elif path:
        findings.refer("rviz", path, call)
    else:
        findings.refer("rviz", None, call, wrong="rviz2 is given -d without the path of a file")


def _display_config(words: list[str]) -> str | None:
    for index, word in enumerate(words):
        if word in ("-d", "--display-config"):
            return "".join(words[index + 1 : index + 2])
        if option := re.match(r"--display-config=|-d=?", word):
            return word[option.end() :]
    return None
