"""The nodes that a launch file starts, by Node or a command, and the files that they are given."""

import re
import shlex
from typing import Any

from grader.package.launch.commands import PART_UNKNOWN
from grader.package.launch.model import (
    STATE_PUBLISHER,
    Contents,
    Context,
    Findings,
    LaunchFails,
    LaunchSignal,
    NamedFile,
    NotEvaluated,
    Resolved,
    StartedNode,
)
from grader.package.launch.parameters import tables_in
from grader.package.launch.substitutions import known_text, resolve
from grader.package.launch.value_types import TYPED, items_in
from grader.static_python.parse import Position
from grader.static_python.values import Call, Unknown, Value

_RVIZ = "rviz2"
_OUTPUTS = ("screen", "log", "both", "own_log", "full")
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_NAMESPACE = re.compile(r"/|(/[A-Za-z_][A-Za-z0-9_]*)+")
# The errors where robot_description is given a call whose last method is missing.
_UNFINISHED = {
    "xacro.process_file": (
        "robot_description is given a document, not its text: add .toxml() to xacro.process_file(...)"
    ),
    "builtins.open": "robot_description is given an open file, not its contents: add .read() to open(...)",
}


def absolute_namespace(before: Resolved, pushed: str, at: Position) -> str:
    """Return a namespace below another. Raises LaunchSignal."""
    if not isinstance(before, str) or "<" in pushed:  # of the stand-in for a folder
        raise NotEvaluated("the namespace is not evaluated", at)
    full = pushed if pushed.startswith("/") or not before else f"{before if before != '/' else ''}/{pushed}"
    absolute = full if full.startswith("/") else f"/{full}"
    absolute = absolute.rstrip("/") if absolute != "/" and full.rstrip("/") else absolute
    if _NAMESPACE.fullmatch(absolute) is None:
        raise LaunchFails(f"the namespace {absolute!r} is not valid", at)
    return absolute


def evaluate_process(call: Call, context: Context) -> None:
    """Evaluate what launch does with the arguments of a process besides their texts. Raises LaunchSignal."""
    if "cmd" in call.kwargs and not items_in(call.kwargs["cmd"]):
        raise LaunchFails("cmd is empty", call.at)
    try:
        shlex.split(known_text(call.kwargs.get("prefix") or "", context, call.at))
    except ValueError:
        raise LaunchFails("the quotes in a prefix are not closed", call.at) from None
    output = call.kwargs.get("output", "log")
    if not isinstance(output, dict) and (text := known_text(output, context, call.at)) not in _OUTPUTS:
        raise LaunchFails(f"output={text!r} is not one of {', '.join(_OUTPUTS)}", call.at)
    if isinstance(output, dict) and not output.keys() <= {"stdout", "stderr", "both"}:
        raise LaunchFails("output has the keys stdout, stderr and both only", call.at)


def evaluate_node(call: Call, context: Context) -> None:
    """Evaluate what launch_ros does with the arguments of a node besides their texts. Raises LaunchSignal."""
    evaluate_process(call, context)
    name, namespace = call.kwargs.get("name"), call.kwargs.get("namespace")
    if name is not None and _NAME.fullmatch(text := known_text(name, context, call.at)) is None:
        raise LaunchFails(f"the name of the node, {text!r}, is not valid: use letters, digits and _", call.at)
    before = context.arguments.get("ros_namespace", "")
    if namespace is not None:
        absolute_namespace(before, known_text(namespace, context, call.at), call.at)
    if call.kwargs.get("ros_arguments") is not None and not isinstance(call.kwargs["ros_arguments"], list):
        raise LaunchFails("ros_arguments has to be a list: put [ ] around it", call.at)
    package = call.kwargs.get("package")
    if package is not None:
        text = known_text(package, context, call.at)
        program = known_text(call.kwargs["executable"], context, call.at)
        if not context.around.is_installed(text):
            raise NotEvaluated(f"whether the package {text!r} is installed is not evaluated", call.at)
        if context.around.has_program(text, program) is not True:
            reason = f"{text!r} has no program {program!r}"
            if context.around.has_program(text, program) is None:
                raise NotEvaluated(f"whether {reason} is not evaluated".replace(" has no ", " has the "), call.at)
            raise LaunchFails(f"the package {reason}", call.at)


def start_node(findings: Findings, call: Call, context: Context, when: bool | None) -> None:
    """Add the node that a Node action starts, and the files that it is given."""
    own = call.kwargs.get("package")
    if own is None:
        words = _words(
            [call.kwargs["executable"], *(items_in(call.kwargs.get("arguments") or []) or [])], context, call.at
        )
        if words[0] == _RVIZ:
            _start(findings, _RVIZ, _RVIZ, call, context, when)
            return
    package, executable = _attempt(own, context, call.at), _attempt(call.kwargs["executable"], context, call.at)
    if isinstance(package, str) and isinstance(executable, str) and own is not None:
        _start(findings, package, executable, call, context, when)
        return
    unknown = executable if own is not None and isinstance(package, str) else package
    reason = (
        "a node without a package is a program of the machine"
        if own is None
        else "the program of a node is not evaluated"
    )
    findings.add_unknown(unknown.reason if own is not None and isinstance(unknown, Unknown) else reason, call.at)


def start_process(findings: Findings, call: Call, context: Context, when: bool | None) -> None:
    """Add the node that a command starts: ros2 run, or rviz2."""
    words = _words(call.kwargs["cmd"], context, call.at)
    if call.kwargs.get("shell") is True:
        words = " ".join(words).split()
    match words:
        case ["ros2", "run", package, executable, *rest]:
            _start(findings, package, executable, _as_node(call, rest), context, when)
        case ["rviz2" as executable, *rest]:
            _start(findings, executable, executable, _as_node(call, rest), context, when)
        case ["ros2", "launch", *_] if when is not False:
            findings.add_unknown("it starts another ros2 launch", call.at)


def _attempt(value: Value, context: Context, at: Position) -> Resolved:
    """Return the text of a value; Unknown where launch may fail, which is added elsewhere."""
    try:
        return resolve(value, context, at) if value is not None else Unknown("there is none", at)
    except LaunchSignal as signal:
        return Unknown(str(signal), signal.at)


def _words(value: Value, context: Context, at: Position) -> list[str]:
    """Return the words of a command, of which each item of a list is one."""
    items = value if isinstance(value, list | tuple | str) else [value] if value is not None else []
    texts = [_attempt(item, context, at) for item in items]
    return [text if isinstance(text, str) else PART_UNKNOWN for text in texts]


def _start(findings: Findings, package: str, executable: str, call: Call, context: Context, when: bool | None) -> None:
    prefix = _frame_prefix(call, context) if executable == STATE_PUBLISHER else ""
    findings.nodes.append(StartedNode(package, executable, when, findings.locate(call.at), prefix))
    if when is not False and executable == STATE_PUBLISHER:
        _find_description(findings, call, context)
    elif when is not False and executable == _RVIZ:
        _find_configuration(findings, call, context)


def _as_node(call: Call, words: list[str]) -> Call:
    """Return a command as the Node action that starts the same."""
    unknown = Unknown("a part of the command is known only at run time", call.at)
    arguments: list[Value] = [unknown if word == PART_UNKNOWN else word for word in words]
    return Call(call.name, [], {"arguments": arguments}, call.at)


def _frame_prefix(call: Call, context: Context) -> str | None:
    """Return the parameter frame_prefix of a node."""
    given = [table["frame_prefix"] for table in tables_in(call.kwargs.get("parameters")) if "frame_prefix" in table]
    for name in ("arguments", "ros_arguments"):
        words = _words(call.kwargs.get(name), context, call.at)
        given += [word.partition(":=")[2] for word in words if word.startswith("frame_prefix:=")]
    found = _attempt(_inner(given[-1]), context, call.at) if given else ""
    return found if isinstance(found, str) and PART_UNKNOWN not in found else None


def _inner(value: Value) -> Value:
    return value.kwargs["value"] if isinstance(value, Call) and value.name in TYPED else value


def _find_description(findings: Findings, call: Call, context: Context) -> None:
    """Add the file that robot_state_publisher gets the robot from."""
    parameters = call.kwargs.get("parameters") or []
    descriptions = [table["robot_description"] for table in tables_in(parameters) if "robot_description" in table]
    if descriptions:
        _refer_description(findings, descriptions[-1], call, context)
        return
    nested = Unknown("parameters in a dict in a dict are not evaluated", call.at)
    unclear = next(
        (nested if isinstance(it, dict) else it for it in parameters if not isinstance(it, dict) or _has_dict(it)), None
    )
    words = _words(call.kwargs.get("arguments"), context, call.at)
    end = words.index("--ros-args") if "--ros-args" in words else len(words)
    files = [word for word in words[:end] if not word.startswith("-")]
    if isinstance(unclear, Unknown):
        findings.refer("urdf", unclear, call)
    elif files and files[0] != PART_UNKNOWN:
        findings.refer("urdf", files[0], call)
    elif words or unclear is not None or "ros_arguments" in call.kwargs or findings.sets_parameters:
        findings.refer("urdf", Unknown("its parameters are known only at run time", call.at), call)
    else:
        message = "robot_state_publisher is started without robot_description: it has no robot to publish"
        findings.refer("urdf", None, call, wrong=message)


def _has_dict(table: dict[Any, Value]) -> bool:
    return any(isinstance(value, dict) for value in table.values())


def _refer_description(findings: Findings, value: Value, call: Call, context: Context) -> None:
    value = _inner(value)
    if isinstance(value, Call) and value.name in _UNFINISHED:
        findings.refer("urdf", None, call, value, wrong=_UNFINISHED[value.name])
        return
    if isinstance(value, list | tuple) and not any(isinstance(it, Call) for it in value):
        findings.add_doubt("a robot_description that is a list is not evaluated", call.at)
        findings.refer("urdf", Unknown("robot_description is a list", call.at), call)
        return
    found = _attempt(value, context, call.at)
    match _origin(found, context, call.at) if isinstance(found, str) else found:
        case Contents(path=path, by=by) if by != "xacro" and path.endswith(".xacro"):
            name = path.rpartition("/")[2]
            message = f"{name} is read without xacro; if it uses xacro, write Command(['xacro ', ...])"
            findings.references.append(NamedFile("urdf", path, findings.locate(call.at), message, sure=False, by=by))
        case str():
            message = "robot_description is given the path of the URDF, not its contents: read the file first"
            findings.refer("urdf", None, call, value, wrong=message)
        case Contents() | Unknown() as description:
            findings.refer("urdf", description, call, value)


def _origin(text: str, context: Context, at: Position) -> Resolved:
    """Return the file that a text was read from; a text that is no robot is returned as it is."""
    texts = context.around.texts
    if text in texts:
        return Contents(texts[text], "open")
    files = [path for read, path in texts.items() if "<robot" in read]
    part = Unknown("robot_description is given a part of the text of a file, which is not evaluated", at)
    if "<robot" in text:
        return (
            Contents(files[0], "open")
            if len(files) == 1
            else Unknown("a robot that the launch file contains is not evaluated", at)
        )
    return part if not text or any(text in read for read in texts) else text


def _find_configuration(findings: Findings, call: Call, context: Context) -> None:
    """Add the configuration that RViz opens."""
    arguments = call.kwargs.get("arguments")
    if isinstance(arguments, Unknown):
        findings.refer("rviz", arguments, call)
        return
    words = _words(arguments, context, call.at)
    path = _display_config(words)
    if path is None and PART_UNKNOWN not in words:
        message = (
            "rviz2 is started without -d and a file, so it opens its own default instead of the lab's configuration"
        )
        findings.refer("rviz", None, call, wrong=message)
    elif path is None or PART_UNKNOWN in path:
        pieces = arguments if isinstance(arguments, list | tuple) else []
        found = (_attempt(piece, context, call.at) for piece in pieces)
        unnamed = Unknown("the file that it opens is known only at run time", call.at)
        findings.refer("rviz", next((it for it in found if isinstance(it, Unknown)), unnamed), call)
    elif path.startswith("/") and f"-d{path}" in words:
        message = "whether rviz2 takes -d and a path as one word is not evaluated"
        findings.refer("rviz", Unknown(message, call.at), call)
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
