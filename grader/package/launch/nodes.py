"""The nodes that a launch file starts, by Node or a command, and the files that they are given."""

import re
import shlex

from grader.package.launch.commands import PART_UNKNOWN
from grader.package.launch.model import (
    STATE_PUBLISHER,
    Context,
    Findings,
    LaunchFails,
    NotEvaluated,
    Resolved,
    StartedNode,
)
from grader.package.launch.node_files import attempt, find_configuration, find_description, inner_value, words_of
from grader.package.launch.parameters import tables_in
from grader.package.launch.substitutions import known_text
from grader.package.launch.value_types import items_in
from grader.static_python.parse import Position
from grader.static_python.values import Call, Unknown, Value

_RVIZ = "rviz2"
_OUTPUTS = ("screen", "log", "both", "own_log", "full")
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_NAMESPACE = re.compile(r"/|(/[A-Za-z_][A-Za-z0-9_]*)+")


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
        words = words_of(
            [call.kwargs["executable"], *(items_in(call.kwargs.get("arguments") or []) or [])], context, call.at
        )
        if words[0] == _RVIZ:
            _start(findings, _RVIZ, _RVIZ, call, context, when)
            return
    package, executable = attempt(own, context, call.at), attempt(call.kwargs["executable"], context, call.at)
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
    words = words_of(call.kwargs["cmd"], context, call.at)
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
    if when is not False and executable == STATE_PUBLISHER:
        find_description(findings, call, context)
    elif when is not False and executable == _RVIZ:
        find_configuration(findings, call, context)


def _as_node(call: Call, words: list[str]) -> Call:
    """Return a command as the Node action that starts the same."""
    unknown = Unknown("a part of the command is known only at run time", call.at)
    arguments: list[Value] = [unknown if word == PART_UNKNOWN else word for word in words]
    return Call(call.name, [], {"arguments": arguments}, call.at)


def _frame_prefix(call: Call, context: Context) -> str | None:
    """Return the parameter frame_prefix of a node."""
    given = [table["frame_prefix"] for table in tables_in(call.kwargs.get("parameters")) if "frame_prefix" in table]
    for name in ("arguments", "ros_arguments"):
        words = words_of(call.kwargs.get(name), context, call.at)
        given += [word.partition(":=")[2] for word in words if word.startswith("frame_prefix:=")]
    found = attempt(inner_value(given[-1]), context, call.at) if given else ""
    return found if isinstance(found, str) and PART_UNKNOWN not in found else None
