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
_STARTS = re.compile(rf"ros2\s+(run|launch)|rviz2|{PART_UNKNOWN}")
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_NAMESPACE = re.compile(r"|/|/?[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*")


def check_namespace(value: Value, context: Context, at: Position) -> None:
    """Raise NotEvaluated for a namespace that may not be valid, or stands below one that the file itself sets."""
    text = known_text(value, context, at)
    if _NAMESPACE.fullmatch(text) is None or isinstance(context.arguments.get("ros_namespace"), str):
        raise NotEvaluated(f"whether the namespace {text!r} is valid is not evaluated", at)


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
    if namespace is not None or "ros_namespace" in context.arguments:
        check_namespace(namespace or "", context, call.at)
    if call.kwargs.get("ros_arguments") is not None:
        raise NotEvaluated("ros_arguments are not evaluated", call.at)
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
    package, executable = (attempt(call.kwargs.get(name), context, call.at) for name in ("package", "executable"))
    if not isinstance(package, str) or not isinstance(executable, str):
        unknown = next((it.reason for it in (package, executable) if isinstance(it, Unknown)), "")
        findings.add_unknown(f"the program of a node is not evaluated: {unknown}".removesuffix(": "), call.at)
        return
    prefix = _frame_prefix(call, context) if executable == STATE_PUBLISHER else ""
    findings.nodes.append(StartedNode(package, executable, when, findings.locate(call.at), prefix))
    if when is not False and executable == STATE_PUBLISHER:
        find_description(findings, call, context)
    elif when is not False and executable == _RVIZ:
        find_configuration(findings, call, context)


def start_process(findings: Findings, call: Call, context: Context, when: bool | None) -> None:
    """Add that a command starts nodes, if it does."""
    words = " ".join(words_of(call.kwargs["cmd"], context, call.at))
    if when is not False and _STARTS.search(words):
        findings.add_unknown("the nodes that a command starts are not evaluated", call.at)


def _frame_prefix(call: Call, context: Context) -> str | None:
    """Return the parameter frame_prefix of a node."""
    given = [table["frame_prefix"] for table in tables_in(call.kwargs.get("parameters")) if "frame_prefix" in table]
    for name in ("arguments", "ros_arguments"):
        words = words_of(call.kwargs.get(name), context, call.at)
        given += [word.partition(":=")[2] for word in words if word.startswith("frame_prefix:=")]
    found = attempt(inner_value(given[-1]), context, call.at) if given else ""
    return found if isinstance(found, str) and PART_UNKNOWN not in found else None
