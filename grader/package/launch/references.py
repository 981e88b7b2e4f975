"""The files that the nodes of a launch file are given: the URDF of robot_state_publisher, the configuration of RViz."""

import re
import shlex

from grader.package.launch.model import Contents, Context, Findings, Reference
from grader.package.launch.places import SHARE
from grader.package.launch.substitutions import COMMAND_LINE, PART_UNKNOWN, resolve
from grader.static_python.values import UNKNOWN_KEYS, Call, Unknown, Value

STATE_PUBLISHER = "robot_state_publisher"
RVIZ = "rviz2"
# The errors where robot_description is given a call whose last method is missing.
_UNFINISHED = {
    "xacro.process_file": "robot_description is given a document, not its text: add .toxml() to xacro.process_file(...)",
    "builtins.open": "robot_description is given an open file, not its contents: add .read() to open(...)",
}


def find_description(findings: Findings, call: Call, context: Context) -> None:
    """Add the file that robot_state_publisher gets the robot from."""
    given = call.kwargs.get("parameters")
    parameters = given if isinstance(given, list | tuple) else [given] if given is not None else []
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
    description = resolve(value, context)
    match description:
        case Contents(path=path, by=by) if by != "xacro" and path.endswith(".xacro"):
            name = path.rpartition("/")[2]
            message = f"{name} is read without xacro; if it uses xacro, write Command(['xacro ', ...])"
            findings.references.append(Reference("urdf", path, findings.locate(call.at), message, sure=False, by=by))
        case str() if "<robot" not in description:
            message = "robot_description is given the path of the URDF, not its contents: read the file first"
            findings.refer("urdf", None, call, value, wrong=message)
        case Contents() | Unknown():
            findings.refer("urdf", description, call, value)


def find_configuration(findings: Findings, call: Call, context: Context) -> None:
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
        pieces = (resolve(piece, context) for piece in _pieces(arguments))
        unknown = (piece for piece in pieces if isinstance(piece, Unknown))
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


def find_urdf_launch(findings: Findings, name: str, call: Call, context: Context) -> tuple[str, ...]:
    """Add the files that urdf_launch's own launch files are given, and return the nodes that they start."""
    given = [context.arguments.get(key) for key in ("urdf_package", "urdf_package_path")]
    match [resolve(value, context) for value in given]:
        case [str() as package, str() as path]:
            findings.refer("urdf", Contents(f"{SHARE}/{package}/{path}", "xacro"), call)
        case values:
            unknown = next(value for value in values if not isinstance(value, str))
            if None in given or not isinstance(unknown, Unknown):
                message = "urdf_launch needs the arguments urdf_package and urdf_package_path"
                findings.refer("urdf", None, call, wrong=message)
            else:
                findings.refer("urdf", unknown, call)
    if name != "display":
        return (STATE_PUBLISHER,)
    opened = resolve(context.arguments.get("rviz_config", Contents("", "")), context)
    if not isinstance(opened, Contents):
        findings.refer("rviz", opened, call)
    else:
        message = "urdf_launch is included without rviz_config, so it opens its own configuration, not the lab's"
        findings.refer("rviz", None, call, wrong=message)
    return (STATE_PUBLISHER, "joint_state_publisher_gui", RVIZ)


def command_words(value: Value, context: Context) -> list[str]:
    """Return the words of a command: each item of a list is one word, a line of XML or YAML is split."""
    words: list[str] = []
    for piece in _pieces(value):
        if isinstance(piece, Call) and piece.name == COMMAND_LINE:
            words += _line_words(piece, context)
        else:
            words.append(_word(piece, context))
    return words


def _pieces(value: Value) -> list[Value] | tuple[Value, ...]:
    return value if isinstance(value, list | tuple) else [value] if value is not None else []


def _word(value: Value, context: Context) -> str:
    text = resolve(value, context)
    return text if isinstance(text, str) else PART_UNKNOWN


def _line_words(line: Call, context: Context) -> list[str]:
    """Return the words of a line as launch splits it: its strings are split, the values of substitutions are not."""
    words = [""]
    for piece in line.args:
        if not isinstance(piece, str):
            words[-1] += _word(piece, context)
            continue
        try:
            found = shlex.split(piece)
        except ValueError:
            message = "quotes cannot enclose a substitution in a line of arguments: remove them"
            context.add_error(message, line.at)
            found = piece.replace("'", " ").replace('"', " ").split()
        if piece[:1].isspace() or not found:
            words.append("")
        words[-1] += "".join(found[:1])
        words += [*found[1:], *([""] if piece[-1:].isspace() else [])]
    return [word for word in words if word]
