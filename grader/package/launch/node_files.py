"""The files that nodes are given: the robot of robot_state_publisher, and the configuration of RViz."""

import re
from typing import Any

from grader.package.launch.commands import PART_UNKNOWN
from grader.package.launch.model import (
    Contents,
    Context,
    Findings,
    LaunchSignal,
    NamedFile,
    Resolved,
)
from grader.package.launch.parameters import tables_in
from grader.package.launch.substitutions import resolve
from grader.package.launch.value_types import OPENED, TYPED
from grader.static_python.parse import Position
from grader.static_python.values import Call, Unknown, Value


def attempt(value: Value, context: Context, at: Position) -> Resolved:
    """Return the text of a value; Unknown where launch may fail, which is added elsewhere."""
    try:
        return resolve(value, context, at) if value is not None else Unknown("there is none", at)
    except LaunchSignal as signal:
        return Unknown(str(signal), signal.at)


def words_of(value: Value, context: Context, at: Position) -> list[str]:
    """Return the words of a command, of which each item of a list is one."""
    items = value if isinstance(value, list | tuple | str) else [value] if value is not None else []
    texts = [attempt(item, context, at) for item in items]
    return [text if isinstance(text, str) else PART_UNKNOWN for text in texts]


def inner_value(value: Value) -> Value:
    """Return the value in ParameterValue; another value as it is."""
    return value.kwargs["value"] if isinstance(value, Call) and value.name in TYPED else value


def find_description(findings: Findings, call: Call, context: Context) -> None:
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
    words = words_of(call.kwargs.get("arguments"), context, call.at)
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
    value = inner_value(value)
    if isinstance(value, Call) and value.name in OPENED:
        findings.refer("urdf", None, call, value, wrong=f"robot_description is given {OPENED[value.name]}")
        return
    if isinstance(value, list | tuple) and not any(isinstance(it, Call) for it in value):
        findings.add_doubt("a robot_description that is a list is not evaluated", call.at)
        findings.refer("urdf", Unknown("robot_description is a list", call.at), call)
        return
    found = attempt(value, context, call.at)
    match found:
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
        case Contents() | Unknown() as description:
            findings.refer("urdf", description, call, value)


def find_configuration(findings: Findings, call: Call, context: Context) -> None:
    """Add the configuration that RViz opens."""
    arguments = call.kwargs.get("arguments")
    if isinstance(arguments, Unknown):
        findings.refer("rviz", arguments, call)
        return
    words = words_of(arguments, context, call.at)
    path = _display_config(words)
    if path is None and PART_UNKNOWN not in words:
        message = (
            "rviz2 is started without -d and a file, so it opens its own default instead of the lab's configuration"
        )
        findings.refer("rviz", None, call, wrong=message)
    elif path is None or PART_UNKNOWN in path:
        pieces = arguments if isinstance(arguments, list | tuple) else []
        found = (attempt(piece, context, call.at) for piece in pieces)
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
