"""The nodes that a launch file starts, and the files that they are given: the robot, the configuration of RViz."""

import re
import shlex

from grader.package.launch.model import STATE_PUBLISHER, Contents, Context, Findings, NamedFile, Resolved, StartedNode
from grader.package.launch.parameters import tables_in
from grader.package.launch.substitutions import PART_UNKNOWN, known_text, resolve
from grader.package.launch.value_types import OPENED, TYPED, items_in
from grader.python.parse import Position
from grader.python.values import Call, EvaluationFails, EvaluationSignal, Undetermined, Unknown, Value

_RVIZ = "rviz2"
_OUTPUTS = ("screen", "log", "both", "own_log", "full")
_STARTS = re.compile(rf"ros2\s+(run|launch)|rviz2|{PART_UNKNOWN}")
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_NAMESPACE = re.compile(r"|/|/?[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*")


def check_namespace(value: Value, context: Context, at: Position) -> None:
    """Raise Undetermined for a namespace that may not be valid, or stands below one that the file itself sets."""
    text = known_text(value, context, at)
    if _NAMESPACE.fullmatch(text) is None or isinstance(context.arguments.get("ros_namespace"), str):
        raise Undetermined(f"whether the namespace {text!r} is valid is not evaluated", at)


def evaluate_process(call: Call, context: Context) -> None:
    """Evaluate what launch does with the arguments of a process besides their texts. Raises EvaluationSignal."""
    if "cmd" in call.kwargs and not items_in(call.kwargs["cmd"]):
        raise EvaluationFails("cmd is empty", call.at)
    try:
        shlex.split(known_text(call.kwargs.get("prefix") or "", context, call.at))
    except ValueError:
        raise EvaluationFails("the quotes in a prefix are not closed", call.at) from None
    output = call.kwargs.get("output", "log")
    if not isinstance(output, dict) and (text := known_text(output, context, call.at)) not in _OUTPUTS:
        raise EvaluationFails(f"output={text!r} is not one of {', '.join(_OUTPUTS)}", call.at)
    if isinstance(output, dict) and not output.keys() <= {"stdout", "stderr", "both"}:
        raise EvaluationFails("output has the keys stdout, stderr and both only", call.at)


def evaluate_node(call: Call, context: Context) -> None:
    """Evaluate what launch_ros does with the arguments of a node besides their texts. Raises EvaluationSignal."""
    evaluate_process(call, context)
    name, namespace = call.kwargs.get("name"), call.kwargs.get("namespace")
    if name is not None and _NAME.fullmatch(text := known_text(name, context, call.at)) is None:
        raise EvaluationFails(f"the name of the node, {text!r}, is not valid: use letters, digits and _", call.at)
    if namespace is not None or "ros_namespace" in context.arguments:
        check_namespace(namespace or "", context, call.at)
    if call.kwargs.get("ros_arguments") is not None:
        raise Undetermined("ros_arguments are not evaluated", call.at)
    package = call.kwargs.get("package")
    if package is not None:
        text = known_text(package, context, call.at)
        program = known_text(call.kwargs["executable"], context, call.at)
        if not context.installation.has_package(text):
            raise Undetermined(f"whether the package {text!r} is installed is not evaluated", call.at)
        if context.installation.has_program(text, program) is not True:
            reason = f"{text!r} has no program {program!r}"
            if context.installation.has_program(text, program) is None:
                raise Undetermined(f"whether {reason} is not evaluated".replace(" has no ", " has the "), call.at)
            raise EvaluationFails(f"the package {reason}", call.at)


def start_node(findings: Findings, call: Call, context: Context, when: bool | None) -> None:
    """Add the node that a Node action starts, and the files that it is given."""
    package, executable = (_attempt(call.kwargs.get(name), context, call.at) for name in ("package", "executable"))
    if not isinstance(package, str) or not isinstance(executable, str):
        unknown = next((it.reason for it in (package, executable) if isinstance(it, Unknown)), "")
        findings.add_unknown(f"the program of a node is not evaluated: {unknown}".removesuffix(": "), call.at)
        return
    prefix = _frame_prefix(call, context) if executable == STATE_PUBLISHER else ""
    findings.nodes.append(StartedNode(package, executable, when, findings.locate(call.at), prefix))
    if when is not False and executable == STATE_PUBLISHER:
        _find_description(findings, call, context)
    elif when is not False and executable == _RVIZ:
        _find_configuration(findings, call, context)


def start_process(findings: Findings, call: Call, context: Context, when: bool | None) -> None:
    """Add that a command starts nodes, if it does."""
    words = " ".join(_words_of(call.kwargs["cmd"], context, call.at))
    if when is not False and _STARTS.search(words):
        findings.add_unknown("the nodes that a command starts are not evaluated", call.at)


def _frame_prefix(call: Call, context: Context) -> str | None:
    """Return the parameter frame_prefix of a node."""
    given = [table["frame_prefix"] for table in tables_in(call.kwargs.get("parameters")) if "frame_prefix" in table]
    words = _words_of(call.kwargs.get("arguments"), context, call.at)
    given += [word.partition(":=")[2] for word in words if word.startswith("frame_prefix:=")]
    found = _attempt(_inner_value(given[-1]), context, call.at) if given else ""
    return found if isinstance(found, str) and PART_UNKNOWN not in found else None


def _attempt(value: Value, context: Context, at: Position) -> Resolved:
    """Return the text of a value; Unknown where launch may fail, which is added elsewhere."""
    try:
        return resolve(value, context, at) if value is not None else Unknown("there is none", at)
    except EvaluationSignal as signal:
        return Unknown(str(signal), signal.at or at)


def _words_of(value: Value, context: Context, at: Position) -> list[str]:
    """Return the words of a command, of which each item of a list is one."""
    items = value if isinstance(value, list | tuple | str) else [value] if value is not None else []
    texts = [_attempt(item, context, at) for item in items]
    return [text if isinstance(text, str) else PART_UNKNOWN for text in texts]


def _inner_value(value: Value) -> Value:
    """Return the value in ParameterValue; another value as it is."""
    return value.kwargs["value"] if isinstance(value, Call) and value.name in TYPED else value


def _find_description(findings: Findings, call: Call, context: Context) -> None:
    """Add the file that robot_state_publisher gets the robot from."""
    given = call.kwargs.get("parameters") or []
    parameters = given if isinstance(given, list | tuple) else [given]
    descriptions = [table["robot_description"] for table in tables_in(parameters) if "robot_description" in table]
    if descriptions:
        _refer_description(findings, descriptions[-1], call, context)
        return
    unknown = next((it for it in parameters if isinstance(it, Unknown)), None)
    is_clear = all(isinstance(it, dict) and not any(isinstance(own, dict) for own in it.values()) for it in parameters)
    words = _words_of(call.kwargs.get("arguments"), context, call.at)
    end = words.index("--ros-args") if "--ros-args" in words else len(words)
    files = [word for word in words[:end] if not word.startswith("-")]
    if unknown is not None:
        findings.refer("urdf", unknown, call)
    elif files and files[0] != PART_UNKNOWN:
        findings.refer("urdf", files[0], call)
    elif words or not is_clear or "ros_arguments" in call.kwargs or findings.sets_parameters:
        findings.refer("urdf", Unknown("its parameters are known only at run time", call.at), call)
    else:
        message = "robot_state_publisher is started without robot_description: it has no robot to publish"
        findings.refer("urdf", None, call, wrong=message)


def _refer_description(findings: Findings, value: Value, call: Call, context: Context) -> None:
    value = _inner_value(value)
    if isinstance(value, Call) and value.name in OPENED:
        findings.refer("urdf", None, call, value, wrong=f"robot_description is given {OPENED[value.name]}")
        return
    if isinstance(value, list | tuple) and not any(isinstance(it, Call) for it in value):
        findings.add_doubt("a robot_description that is a list is not evaluated", call.at)
        findings.refer("urdf", Unknown("robot_description is a list", call.at), call)
        return
    match found := _attempt(value, context, call.at):
        case Contents(path=path, by=by) if by != "xacro" and path.endswith(".xacro"):
            name = path.rpartition("/")[2]
            message = f"{name} is read without xacro; if it uses xacro, write Command(['xacro ', ...])"
            findings.references.append(NamedFile("urdf", path, findings.locate(call.at), message, sure=False, by=by))
        case str() if "<robot" in found or not found.strip():
            reason = "a robot that the launch file contains is not evaluated"
            findings.refer("urdf", Unknown(reason, call.at), call, value)
        case str():
            message = "robot_description is given the path of the URDF, not its contents: read the file first"
            findings.refer("urdf", None, call, value, wrong=message)
        case _:
            findings.refer("urdf", found, call, value)


def _find_configuration(findings: Findings, call: Call, context: Context) -> None:
    """Add the configuration that RViz opens."""
    arguments = call.kwargs.get("arguments")
    if isinstance(arguments, Unknown):
        findings.refer("rviz", arguments, call)
        return
    words = _words_of(arguments, context, call.at)
    path = _display_config(words)
    if path is None and PART_UNKNOWN not in words:
        message = (
            "rviz2 is started without -d and a file, so it opens its own default instead of the lab's configuration"
        )
        findings.refer("rviz", None, call, wrong=message)
    elif path is None or PART_UNKNOWN in path:
        pieces = arguments if isinstance(arguments, list | tuple) else []
        found = (_attempt(piece, context, call.at) for piece in pieces)
        unnamed = Unknown("which file rviz2 opens is not evaluated", call.at)
        findings.refer("rviz", next((it for it in found if isinstance(it, Unknown)), unnamed), call)
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
        if word.startswith(("-d", "--display-config")):
            return word.removeprefix("-d") if word[2:3].isspace() else PART_UNKNOWN
    return None
