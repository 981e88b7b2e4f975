"""The nodes that a launch file starts, as launch_ros does.

They have their names, and the files that they are given.

These files are the robot and the configuration of RViz. The files in `ros/known/packages` list the
nodes that launch files of well-known packages start, which workspaces include but do not contain.
"""

import posixpath
import re
import shlex
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import Any

from grader.base.grouping import Strings
from grader.base.names import last_part
from grader.base.patterns import on_use
from grader.ros.installation.places import PREFIX, ROS, SHARE
from grader.ros.known.package_rows import package_row, program_row
from grader.ros.known.ros_machine import ros_machine
from grader.ros.launch.call_arguments import OPENED, TYPED, items_in
from grader.ros.launch.launch_model import (
    NAMESPACE,
    STATE_PUBLISHER,
    Contents,
    Context,
    FileText,
    Findings,
    GivenParameters,
    NamedFile,
    Purpose,
    Resolved,
    StartedNode,
    When,
)
from grader.ros.launch.node_parameters import (
    TO_ALL,
    list_controllers,
    parameters_in_words,
    remap_rules,
)
from grader.ros.launch.substitutions import PART_UNKNOWN, check_program, known_text, listed, resolve
from grader.ros.launch.valid_names import is_node_name
from grader.ros.python.parse import Position
from grader.ros.python.values import (
    Call,
    EvaluationFails,
    EvaluationSignal,
    Undetermined,
    Unknown,
    Value,
)

# the launch configuration that has what SetRemap gives to all nodes, as in launch_ros
REMAPS = "ros_remaps"
_RVIZ = "rviz2"
_GIVEN: Mapping[str, Purpose] = {
    STATE_PUBLISHER: "urdf",
    _RVIZ: "rviz",
}  # the nodes that are given a file
_OUTPUTS = ("screen", "log", "both", "own_log", "full")
_STARTS = on_use(rf"ros2\s++(?:run|launch|component\s++(?:load|standalone))|rviz2|{PART_UNKNOWN}")
# Debuggers, terminals and other programs that start the program behind them.
_PREFIXES = frozenset(
    {
        "gdb",
        "gdbserver",
        "lldb",
        "valgrind",
        "xterm",
        "gnome-terminal",
        "konsole",
        "terminator",
        "nice",
        "taskset",
        "sudo",
        "time",
        "strace",
        "ltrace",
        "perf",
        "stdbuf",
        "chrt",
        "env",
        "setsid",
        "rr",
        "heaptrack",
        "python3",
    }
)
_NAMESPACE = on_use(r"|/|/?[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*")


def start_node(
    findings: Findings,
    call: Call,
    context: Context,
    when: When,
    parameters: Iterable[GivenParameters] = (),
) -> None:
    """Add the node that a Node action starts, and the files that it is given.

    `parameters` are those that the action has for it.
    """
    package, executable = (
        _text_if_known(call.kwargs.get(name), context, call.at)
        for name in ("package", "executable")
    )
    if not isinstance(package, str) or not isinstance(executable, str):
        _add_unknown_program((package, executable), findings, call)
        return
    prefix = read_frame_prefix(call, context) if executable == STATE_PUBLISHER else ""
    node = StartedNode(package, executable, when, findings.locate(call.at), prefix)
    started = _add_names(node, call, context, findings, parameters)
    findings.nodes.append(started)
    if executable == "spawner":
        _refer_controllers(started, findings, call)
    if when is False:
        return
    if executable == STATE_PUBLISHER:
        find_description(findings, call, context)
    elif executable == _RVIZ:
        _find_configuration(findings, call, context)


def _add_unknown_program(
    program: Iterable[str | Contents | Unknown], findings: Findings, call: Call
) -> None:
    """Add why the program of a node is not known."""
    message = "the program of a node is not evaluated"
    for part in program:
        if isinstance(part, Unknown):
            message += f": {part.reason}"
            break
    findings.add_unknown(message.removesuffix(": "), call.at)


def _refer_controllers(spawner: StartedNode, findings: Findings, call: Call) -> None:
    """Add the files of parameters that the controllers of a spawner are given."""
    for controller in list_controllers(spawner) or ():
        for given in controller.parameters or ():
            findings.refer("parameters", given.path, call)


def _add_names(
    node: StartedNode,
    call: Call,
    context: Context,
    findings: Findings,
    own_parameters: Iterable[GivenParameters],
) -> StartedNode:
    """Return a node with its name, arguments, parameters and remappings.

    Also return whether it is given the robot itself.
    """
    words = _words_of_argument(call, "arguments", context)
    ros_words = []
    if "--ros-args" in words:
        ros_words = words[words.index("--ros-args") + 1 :]
    ros_words += _words_of_argument(call, "ros_arguments", context)
    rules = remap_rules(ros_words)
    # robot_state_publisher still reads a URDF whose path is its first argument.
    has_description = bool(words) and not words[0].startswith("-") and node.executable != _RVIZ
    for table in _tables_in(call.kwargs.get("parameters")):
        has_description |= "robot_description" in table
    # In the order of its command line.
    parameters = (
        *parameters_in_words(ros_words, node.location),
        *context.to_all.get(TO_ALL, ()),
        *own_parameters,
    )
    for given in parameters:
        if given.path:
            findings.refer("parameters", given.path, call)
    node = node._replace(
        has_description=has_description,
        node_name=_given_name(rules, call, context),
        arguments=tuple(None if PART_UNKNOWN in word else word for word in words),
        parameters=parameters,
        included_by=context.included_by,
        has_prefix=bool(call.kwargs.get("prefix")),
    )
    return _add_remaps(node, rules, words + ros_words, call, context)


def _add_remaps(
    node: StartedNode,
    rules: Sequence[tuple[str, str, str]],
    words: Sequence[str],
    call: Call,
    context: Context,
) -> StartedNode:
    """Return a node with its namespace and remappings.

    `rules` are those among the words of its command line.
    """
    remaps: list[Strings | None] = [(name, to) for name, _, to in rules]
    remaps += context.to_all.get(REMAPS, ())
    try:
        below = call.kwargs.get("namespace") or ""
        namespace: str | None = namespace_below(below, context)
        remaps += evaluate_remaps(call, context)
    except EvaluationSignal:
        return node._replace(namespace=None, remaps=None)
    for name, _, value in reversed(rules):
        if name == "__ns":  # the first rule counts
            namespace = value
    known = tuple(rule for rule in remaps if rule is not None)
    if len(known) < len(remaps) or any(PART_UNKNOWN in word for word in words):
        return node._replace(namespace=namespace, remaps=None)
    return node._replace(namespace=namespace, remaps=known)


def evaluate_remaps(call: Call, context: Context) -> list[Strings]:
    """Return the remappings that a Node action has. Raises EvaluationSignal."""
    remaps = []
    for rule in items_in(call.kwargs.get("remappings") or ()) or ():
        names = items_in(rule) or ()
        remaps.append(tuple(known_text(name, context) for name in names))
    return remaps


def _given_name(rules: Iterable[tuple[str, str, str]], call: Call, context: Context) -> str | None:
    """Return the name that a node is given; None where it is not known."""
    for name, _, value in rules:
        if name == "__node":
            return None if PART_UNKNOWN in value else value
    given = call.kwargs.get("name")
    text = _text_if_known(given, context, call.at) if given is not None else ""
    return text if isinstance(text, str) else None


def start_process(findings: Findings, call: Call, context: Context, when: When) -> list[str]:
    """Add the node that a command starts, if it does; else return the words of the command."""
    words = _words_of_command(call, context)
    if when is False:
        return words
    node = _node_of_command(words, call)
    if node:
        start_node(findings, node, context, when)
        return []
    if _STARTS.search(" ".join(words)):
        findings.add_unknown("the nodes that a command starts are not evaluated", call.at)
    return words


def _words_of_command(call: Call, context: Context) -> list[str]:
    words = _words_of_argument(call, "cmd", context)
    if call.kwargs.get("shell"):
        with suppress(ValueError):
            return shlex.split(" ".join(words))
    return words


def ends_by_itself(action: Value, context: Context) -> bool:
    """Return whether an action starts a program that certainly ends by itself."""
    if not isinstance(action, Call):
        return False
    if "cmd" in action.kwargs:
        words = _words_of_command(action, context)
    elif "executable" in action.kwargs:
        program = [action.kwargs.get("package"), action.kwargs["executable"]]
        words = ["ros2", "run", *_resolve_words(program, context, action.at)]
        words += _words_of_argument(action, "arguments", context)
    else:
        return False
    if words[:2] == ["ros2", "run"] and len(words) > 3:
        options = program_row(words[2], words[3]).ends_unless
        return options is not None and _lacks_options(words, options)
    for command, options in ros_machine().ending_commands.items():
        first = command.split()
        if words[: len(first)] == first:
            return _lacks_options(words, options)
    return False


def _lacks_options(words: Sequence[str], options: Sequence[str]) -> bool:
    """Return whether a command certainly has none of some options."""
    return not options or {PART_UNKNOWN, *options}.isdisjoint(words)


def _node_of_command(words: list[str], call: Call) -> Call | None:
    """Return the Node action that does the same as a command.

    Returns None for a command that is not known.
    """
    is_run = (
        words[:2] == ["ros2", "run"]
        and len(words) > 3
        and not any(word.startswith("-") for word in words[2:4])
    )
    if not is_run and words[:1] != [_RVIZ]:
        return None
    package, program, *arguments = words[2:] if is_run else [_RVIZ, *words]
    if PART_UNKNOWN in package + program:
        return None
    given = {
        "package": package,
        "executable": program,
        "arguments": arguments,
        "prefix": call.kwargs.get("prefix"),
    }
    return Call(call.name, [], given, call.at)


def evaluate_node(call: Call, context: Context) -> None:
    """Evaluate what launch_ros does with the arguments of a node besides their texts.

    Raises EvaluationSignal.
    """
    evaluate_process(call, context)
    name = call.kwargs.get("name")
    namespace = call.kwargs.get("namespace")
    if name is not None and not is_node_name(text := known_text(name, context)):
        raise EvaluationFails(
            f"the name of the node, {text!r}, is not valid: use letters, digits and _"
        )
    if namespace is not None or NAMESPACE in context.arguments:
        namespace_below(namespace or "", context)
    if call.kwargs.get("package") is not None:
        package = known_text(call.kwargs["package"], context)
        program = known_text(call.kwargs["executable"], context)
        check_program(package, program, context)


def evaluate_process(call: Call, context: Context) -> None:
    """Evaluate what launch does with the arguments of a process besides their texts.

    Raises EvaluationSignal.
    """
    if "cmd" in call.kwargs:
        if not items_in(call.kwargs["cmd"]):
            raise EvaluationFails("cmd is empty")
        words = _words_of_argument(call, "cmd", context)
        node = _node_of_command(words, call)
        if node:
            check_program(node.kwargs["package"], node.kwargs["executable"], context)
    try:
        prefix = shlex.split(known_text(call.kwargs.get("prefix") or "", context))
    except ValueError:
        raise EvaluationFails("the quotes in a prefix are not closed") from None
    if prefix and posixpath.basename(prefix[0]) not in _PREFIXES:
        raise Undetermined(
            f"whether the prefix {prefix[0][:40]!r} starts the program is not evaluated"
        )
    output = call.kwargs.get("output", "log")
    if isinstance(output, dict):
        if not output.keys() <= {"stdout", "stderr", "both"}:
            raise EvaluationFails("output has the keys stdout, stderr and both only")
        return
    text = known_text(output, context)
    if text not in _OUTPUTS:
        raise EvaluationFails(f"output={text!r} is not one of {', '.join(_OUTPUTS)}")


def namespace_below(value: Value, context: Context) -> str:
    """Return a namespace below the one that the launch file has set. Raises EvaluationSignal."""
    text = known_text(value, context)
    above = context.arguments.get(NAMESPACE, "")
    if re.search(r"[^\w/~{}]|[^\x00-\x7f]", text):
        raise EvaluationFails(
            f"the namespace {text[:40]!r} is not valid: use letters, digits, _ and /"
        )
    if not _NAMESPACE.fullmatch(text) or not isinstance(above, str):
        raise Undetermined(f"whether the namespace {text[:40]!r} is valid is not evaluated")
    if text.startswith("/"):
        return text
    return "/".join(filter(None, (above.removesuffix("/"), text)))


def read_frame_prefix(call: Call, context: Context) -> str | None:
    """Return the parameter frame_prefix of a node or a component."""
    given = [
        table["frame_prefix"]
        for table in _tables_in(call.kwargs.get("parameters"))
        if "frame_prefix" in table
    ]
    words = _words_of_argument(call, "arguments", context)
    given += [word.partition(":=")[2] for word in words if word.startswith("frame_prefix:=")]
    prefix = _text_if_known(_inner_value(given[-1]), context, call.at) if given else ""
    if isinstance(prefix, str) and PART_UNKNOWN not in prefix:
        return prefix
    return None


def find_description(findings: Findings, call: Call, context: Context) -> None:
    """Add the file that robot_state_publisher gets the robot from."""
    parameters = listed(call.kwargs.get("parameters") or [])
    tables = [table for table in _tables_in(parameters) if "robot_description" in table]
    if tables:
        _refer_description(findings, tables[-1]["robot_description"], call, context)
        return
    given = _description_besides(parameters, findings, call, context)
    if given is not None:
        findings.refer("urdf", given, call)
        return
    message = "robot_state_publisher is started without robot_description"
    if any(isinstance(parameter, set) for parameter in parameters):
        message += ": { , } is a set, and a table has a colon: {'robot_description': ...}"
    else:
        message += ": it has no robot to publish"
    findings.refer("urdf", None, call, wrong=message)


def _description_besides(
    parameters: Sequence[Value], findings: Findings, call: Call, context: Context
) -> str | Unknown | None:
    """Return where robot_state_publisher gets the robot from, if no table has it.

    Returns Unknown where that is not known, None if it gets none.
    """
    words = _words_of_argument(call, "arguments", context)
    for parameter in parameters:
        if isinstance(parameter, Unknown):
            return parameter
    file = _first_file(words)
    if file is not None and file != PART_UNKNOWN:
        return file
    is_clear = all(map(_is_flat, parameters))
    if words or not is_clear or "ros_arguments" in call.kwargs or findings.sets_parameters:
        return Unknown("its parameters are known only at run time", call.at)
    return None


def _first_file(words: Sequence[str]) -> str | None:
    """Return the first word of a command line before --ros-args that is no option."""
    for word in words:
        if word == "--ros-args":
            return None
        if not word.startswith("-"):
            return word
    return None


def _is_flat(parameter: Value) -> bool:
    """Return whether parameters are a dict that contains no other, or no table at all."""
    if isinstance(parameter, set) and any(isinstance(part, FileText) for part in parameter):
        return True
    if not isinstance(parameter, dict):
        return False
    return not any(isinstance(value, dict) for value in parameter.values())


def _refer_description(findings: Findings, value: Value, call: Call, context: Context) -> None:
    value = _inner_value(value)
    if isinstance(value, Call) and value.name in OPENED:
        findings.refer(
            "urdf", None, call, value, wrong=f"robot_description is given {OPENED[value.name]}"
        )
        return
    if isinstance(value, list | tuple) and not any(isinstance(element, Call) for element in value):
        findings.add_doubt("a robot_description that is a list is not evaluated", call.at)
        findings.refer("urdf", Unknown("robot_description is a list", call.at), call)
        return
    match text := _text_if_known(value, context, call.at):
        case Contents(path=path, by=by) if (
            by != "xacro" and path.endswith(".xacro") and context.find_text(path) is None
        ):
            name = last_part(path)
            message = (
                f"{name} is read without xacro; if it uses xacro, write Command(['xacro ', ...])"
            )
            findings.references.append(
                NamedFile("urdf", path, findings.locate(call.at), message, is_certain=False, by=by)
            )
        case str() if "<robot" in text or not text.strip():
            reason = "a robot that the launch file contains is not evaluated"
            findings.refer("urdf", Unknown(reason, call.at), call, value)
        case str():
            message = (
                "robot_description is given the path of the URDF, not its contents: read the "
                "file first"
            )
            if re.fullmatch(r"\w+", text):
                message = (
                    f"robot_description is given the text {text[:40]!r}: write the variable "
                    "without quotes"
                )
            findings.refer("urdf", None, call, value, wrong=message)
        case _:
            findings.refer("urdf", text, call, value)


def _find_configuration(findings: Findings, call: Call, context: Context) -> None:
    """Add the configuration that RViz opens."""
    arguments = call.kwargs.get("arguments")
    if isinstance(arguments, Unknown):
        findings.refer("rviz", arguments, call)
        return
    if isinstance(arguments, str):
        at = call.places.get("arguments", call.at)
        message = (
            "arguments is a string, of which each letter is an argument; write a list: ['-d', path]"
        )
        findings.refer("rviz", None, Call("", [], {}, at), wrong=message)
        return
    words = _resolve_words(arguments, context, call.at)
    path = _display_config(words)
    if path is None and PART_UNKNOWN not in words:
        message = (
            "rviz2 is started without -d and a file, so it opens its own default instead of the "
            "lab's configuration"
        )
        findings.refer("rviz", None, call, wrong=message)
    elif path is None or PART_UNKNOWN in path:
        findings.refer("rviz", _unknown_configuration(arguments, call, context), call)
    elif path != path.lstrip():
        message = "'-d' and the path have to be two items of arguments: ['-d', path]"
        findings.refer("rviz", None, call, wrong=message)
    elif path:
        findings.refer("rviz", path, call)
    else:
        findings.refer("rviz", None, call, wrong="rviz2 is given -d without the path of a file")


def _unknown_configuration(arguments: Value, call: Call, context: Context) -> Unknown:
    """Return why it is not known which file RViz opens: the first reason in its arguments."""
    if isinstance(arguments, list | tuple):
        for piece in arguments:
            text = _text_if_known(piece, context, call.at)
            if isinstance(text, Unknown):
                return text
    return Unknown("which file rviz2 opens is not evaluated", call.at)


def _display_config(words: list[str]) -> str | None:
    """Return what follows -d; of several, the last counts, as for Qt's parser."""
    path = None
    for index, word in enumerate(words):
        if word in ("-d", "--display-config"):
            path = "".join(words[index + 1 : index + 2])
        elif word.startswith("--display-config="):
            path = word.removeprefix("--display-config=")
        elif word.startswith("-d"):
            is_path = word[2:3].isspace() or word[2:3] == "/"
            path = word.removeprefix("-d") if is_path else PART_UNKNOWN
    return path


def _text_if_known(value: Value, context: Context, at: Position) -> Resolved:
    """Return the text of a value; Unknown where launch may fail, which is added elsewhere."""
    try:
        if value is not None:
            return resolve(value, context, at)
        return Unknown("there is none", at)
    except EvaluationSignal as signal:
        return signal.as_unknown(at)


def _resolve_words(value: Value, context: Context, at: Position) -> list[str]:
    """Return the words of a command, of which each item of a list is one."""
    items = value
    if not isinstance(value, list | tuple | str):
        items = [] if value is None else [value]
    texts = [_text_if_known(item, context, at) for item in items]
    return [text if isinstance(text, str) else PART_UNKNOWN for text in texts]


def _words_of_argument(call: Call, name: str, context: Context) -> list[str]:
    """Return the words that an argument of an action lists; none if it is not given."""
    return _resolve_words(call.kwargs.get(name), context, call.at)


def _inner_value(value: Value) -> Value:
    """Return the value in ParameterValue; another value as it is."""
    if isinstance(value, Call) and value.name in TYPED:
        return value.kwargs["value"]
    return value


def _tables_in(parameters: Value) -> Iterator[dict[Any, Value]]:
    """Yield the dicts among the parameters of a node."""
    if isinstance(parameters, list):
        yield from (table for table in parameters if isinstance(table, dict))


def is_of_ros(package: str) -> bool:
    """Return whether a package is on every machine that runs ROS 2."""
    row = package_row(package)
    return row.is_installed or bool(row.launch)


def start_known_file(findings: Findings, path: str, call: Call, context: Context) -> bool:
    """Add what an included launch file of a well-known package starts.

    Returns whether the path is that of one.
    """
    prefix, _, name = path.rpartition("/share/")
    package, _, file = name.partition("/launch/")
    if not prefix.startswith((PREFIX, ROS)):
        return False
    launch = package_row(package).launch.get(file)
    if not launch:
        return False
    nodes = launch.starts
    above = context.arguments.get(NAMESPACE, "")
    namespace = above if isinstance(above, str) else None
    findings.nodes += [
        StartedNode(node, node, context.when, findings.locate(call.at), namespace=namespace)
        for node in nodes
    ]
    for node in nodes:
        if node in _GIVEN and package != "urdf_launch":
            findings.refer(
                _GIVEN[node], Unknown(f"{name} decides which file {node} gets", call.at), call
            )
    if package == "urdf_launch":
        _refer_known_files(findings, call, context, is_shown=_RVIZ in nodes)
    return True


def _refer_known_files(findings: Findings, call: Call, context: Context, *, is_shown: bool) -> None:
    """Add the files that the arguments of urdf_launch name."""
    given = [context.arguments.get(key) for key in ("urdf_package", "urdf_package_path")]
    match given:
        case [str() as package, str() as urdf]:
            findings.refer("urdf", Contents(f"{SHARE}/{package}/{urdf}", "xacro"), call)
        case _:
            unknown = next(value for value in given if not isinstance(value, str))
            is_missing = None in given or isinstance(unknown, Contents)
            message = "urdf_launch needs the arguments urdf_package and urdf_package_path"
            findings.refer("urdf", None if is_missing else unknown, call, wrong=message)
    opened = context.arguments.get("rviz_config")
    if is_shown and opened is None:
        message = (
            "urdf_launch is included without rviz_config, so it opens its own configuration, "
            "not the lab's"
        )
        findings.refer("rviz", None, call, wrong=message)
    elif is_shown:
        findings.refer("rviz", opened, call)
