"""What launch's substitutions come to, with the defaults of the launch arguments."""

import posixpath
import re
import shlex
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import PurePosixPath

from grader.package.launch.places import HOME, PREFIX, SHARE
from grader.package.launch.truths import LOGIC, logical, operands_of
from grader.static_python.machine import Machine
from grader.static_python.methods import as_text
from grader.static_python.parse import SyntaxFault, parse
from grader.static_python.values import Made, Spot, Unknown, Value

CMDLINE = "launch.frontend.command line"  # a line that is split into words, as XML and YAML have them
UNTOLD = "\0"  # stands in a command for a part that cannot be told
_MOST_DEPTH = 40
_MOST_STEPS = 50_000
_MOST_TEXT = 100_000
_MOST_EXPRESSION = 1_000
_GLUED = re.compile(r"(?:xacro|cat)/")
_PERFORMED = (".perform", ".find")


@dataclass(frozen=True, slots=True)
class Contents:
    """What is in a file, read by open, cat or xacro."""

    path: str
    by: str


@dataclass(slots=True)
class Context:
    """The launch arguments that are known so far, and the folder of the launch file as it is installed.

    `when` tells whether the file is launched at all; `left` counts down the steps, also for the files that are included.
    """

    folder: str
    arguments: dict[str, Value] = field(default_factory=dict)
    undeclared: list[tuple[str, Spot]] = field(default_factory=list)
    wrong: list[tuple[str, Spot]] = field(default_factory=list)
    when: bool | None = True
    left: list[int] = field(default_factory=lambda: [_MOST_STEPS])


def resolve(value: Value, context: Context, depth: int = 0) -> "str | Contents | Unknown":
    """The text that a value comes to, or what is in a file; Unknown, with the reason, where only a run would tell."""
    context.left[0] -= 1
    if depth > _MOST_DEPTH or context.left[0] < 0:
        return Unknown("it is too deeply nested", Spot(1, 1))
    match value:
        case Contents() | Unknown():
            return value
        case str() | int() | float() | PurePosixPath():
            text = as_text(value)
            return text if text is not None else Unknown("it is too long a number", Spot(1, 1))
        case list() | tuple():
            return _joined(value, context, depth)
        case Made():
            return _made(value, context, depth)
        case _:
            return Unknown("this is not followed as a text", Spot(1, 1))


def _joined(parts: list[Value] | tuple[Value, ...], context: Context, depth: int) -> "str | Contents | Unknown":
    if len(parts) == 1:
        return resolve(parts[0], context, depth + 1)
    text = ""
    for part in parts:
        piece = resolve(part, context, depth + 1)
        if not isinstance(piece, str):
            return piece if isinstance(piece, Unknown) else Unknown("the content of a file is part of it", Spot(1, 1))
        text += piece
        if len(text) > _MOST_TEXT:
            return Unknown("it grows too long", Spot(1, 1))
    return text


def _made(made: Made, context: Context, depth: int) -> "str | Contents | Unknown":
    def of(position: int, *names: str) -> "str | Contents | Unknown":
        return resolve(made.argument(position, *names), context, depth + 1)

    last = made.name.rpartition(".")[2]
    match last:
        case _ if made.name == CMDLINE:
            return _joined(made.args, context, depth)
        case "TextSubstitution":
            return of(0, "text")
        case "LaunchConfiguration":
            return _configuration(made, context, depth)
        case "PathJoinSubstitution" if len(made.args) > 1:
            context.wrong.append(("PathJoinSubstitution takes one list: put [ ] around the parts of the path", made.at))
            return _path(made.args, context, depth, made.at)
        case "PathJoinSubstitution":
            return _path(made.argument(0, "substitutions"), context, depth, made.at)
        case "PathSubstitution" | "ParameterValue" | "ParameterFile":
            return of(0, "path", "value", "param_file")
        case _ if last.endswith("LaunchDescriptionSource"):
            return of(0, "launch_file_path", "location")
        case "truediv":
            return _path(made.args, context, depth, made.at)
        case (
            "FindPackageShare" | "FindPackageShareDirectory" | "get_package_share_directory" | "get_package_share_path"
        ):
            return below(SHARE, of(0, "package", "package_name"))
        case "FindPackagePrefix" | "FindPackage" | "get_package_prefix":
            package = of(0, "package", "package_name")
            return PREFIX if isinstance(package, str) else package
        case "ThisLaunchFileDir":
            return context.folder
        case "FindExecutable":
            return of(0, "name")
        case "Command":
            return _command(made, context, depth)
        case "FileContent":
            path = of(0, "path")
            return Contents(path, "open") if isinstance(path, str) else path
        case "PythonExpression":
            return _expression(of(0, "expression"), made.at)
        case _ if last in LOGIC:
            return logical(last, [resolve(each, context, depth + 1) for each in operands_of(made)], made.at)
        case _:
            return _of_python(made, last, context, depth)


def _of_python(made: Made, last: str, context: Context, depth: int) -> "str | Contents | Unknown":
    """What a function of Python's or xacro's gives; Unknown for all others."""

    def of(position: int, *names: str) -> "str | Contents | Unknown":
        return resolve(made.argument(position, *names), context, depth + 1)

    match last:
        case "join" if made.name == "os.path.join":
            _needs_texts(made.args, "os.path.join takes texts, not substitutions: use PathJoinSubstitution([...])",
                         made, context)  # fmt: skip
            return _path(made.args, context, depth, made.at)
        case "process_file" | "process" if made.name.startswith("xacro."):
            _needs_texts(made.args[:1], f"xacro.{last} takes a path, not a substitution: use Command(['xacro ', ...])",
                         made, context)  # fmt: skip
            path = of(0, "input_file_name")
            return Contents(path, "xacro") if isinstance(path, str) else path
        case "parse":  # xacro.parse(open(path)), or of what is in it
            return _reread(of(0), "xacro")
        case "open" if made.name in ("builtins.open", "io.open", "codecs.open"):
            _needs_texts(made.args[:1], "open takes a path, not a substitution: use Command(['cat ', ...])",
                         made, context)  # fmt: skip
            path = of(0, "file")
            return Contents(path, "open") if isinstance(path, str) else path
        case "EnvironmentVariable" | "getenv" | "environ[]" | "get" if "nviron" in made.name or last == "getenv":
            return HOME if of(0, "name") == "HOME" else Unknown("it depends on the environment", made.at)
        case "expanduser":
            text = of(0)
            return text.replace("~", HOME, 1) if isinstance(text, str) and text.startswith("~") else text
        case "home" if made.name.startswith("pathlib."):
            return HOME
        case "perform" | "read" | "toxml" | "toprettyxml" | "documentElement" | "decode" | "strip":
            return resolve(made.owner, context, depth + 1)
        case _:
            return Unknown(f"what {last} gives is told only by a run", made.at)


def _needs_texts(values: Iterable[Value], message: str, made: Made, context: Context) -> None:
    """Note that a function of Python's gets a substitution, which is no text before the launch runs."""
    if any(
        isinstance(each, Made)
        and each.name.startswith(("launch.", "launch_ros."))
        and not each.name.endswith(_PERFORMED)
        for each in values
    ):
        context.wrong.append((message, made.at))


def _reread(value: "str | Contents | Unknown", by: str) -> "str | Contents | Unknown":
    return Contents(value.path, by) if isinstance(value, Contents) else value


def below(folder: str, name: "str | Contents | Unknown") -> "str | Contents | Unknown":
    """A path below a folder."""
    return f"{folder}/{name}" if isinstance(name, str) else name


def _configuration(made: Made, context: Context, depth: int) -> "str | Contents | Unknown":
    name = resolve(made.argument(0, "variable_name"), context, depth + 1)
    if not isinstance(name, str):
        return name
    if name in context.arguments:
        return resolve(context.arguments[name], context, depth + 1)
    default = made.argument(1, "default")
    if default is not None:
        return resolve(default, context, depth + 1)
    context.undeclared.append((name, made.at))
    return Unknown(f"the launch argument {name!r} is not declared", made.at)


def _path(parts: Value, context: Context, depth: int, spot: Spot) -> "str | Contents | Unknown":
    if not isinstance(parts, list | tuple):
        return resolve(parts, context, depth + 1)
    texts: list[str] = []
    for part in parts:
        text = resolve(part, context, depth + 1)
        if not isinstance(text, str):
            return text if isinstance(text, Unknown) else Unknown("the content of a file is part of a path", spot)
        texts.append(text)
    if sum(map(len, texts)) > _MOST_TEXT:
        return Unknown("it grows too long", spot)
    return posixpath.join(*texts) if texts else Unknown("an empty path", spot)


def _command(made: Made, context: Context, depth: int) -> "str | Contents | Unknown":
    """What a command prints: the file that it reads, for xacro and cat."""
    parts = made.argument(0, "command")
    pieces = parts if isinstance(parts, list | tuple) else [parts]
    texts = [resolve(piece, context, depth + 1) for piece in pieces]
    unknown = next((text for text in texts if isinstance(text, Unknown)), None)
    command = "".join(text if isinstance(text, str) else UNTOLD for text in texts).strip()[:_MOST_TEXT]
    if _GLUED.match(command):
        program = command.split("/")[0]
        context.wrong.append((f"a space is missing between {program} and the path: write '{program} '", made.at))
        command = command.replace(program, program + " ", 1)
    try:
        words = shlex.split(command)
    except ValueError:
        context.wrong.append(("the quotes in this command are not closed", made.at))
        return Unknown("the quotes in this command are not closed", made.at)
    by, path = _file_read(words)
    if path is None or UNTOLD in path:
        return unknown or Unknown("what this command prints is told only by a run", made.at)
    return Contents(path, by)


def _file_read(words: list[str]) -> tuple[str, str | None]:
    """Which program reads a file, and which file: of a call of xacro or cat."""
    if words[:3] == ["ros2", "run", "xacro"]:
        words = words[3:]
    program = words[0].rpartition("/")[2].removesuffix(".py") if words else ""
    if program not in ("xacro", "cat", "type") or "-o" in words:
        return "", None
    files = [word for word in words[1:] if not word.startswith("-") and ":=" not in word]
    return ("xacro" if program == "xacro" else "cat"), (files[0] if len(files) == 1 else None)


def _expression(text: "str | Contents | Unknown", spot: Spot) -> "str | Contents | Unknown":
    """What a Python expression comes to that has only plain values in it."""
    unknown = Unknown("what this expression comes to is told only by a run", spot)
    if not isinstance(text, str) or len(text) > _MOST_EXPRESSION:
        return text if isinstance(text, Unknown) else unknown
    code = parse(f"value = ({text}\n)".encode("utf-8", "replace"), "")
    if isinstance(code, SyntaxFault):
        return unknown
    machine = Machine(code, {}, special={})
    value = machine.run().names.get("value")
    plain = as_text(value) if value is not None and not machine.faults and not machine.stopped else None
    return plain if plain is not None else unknown


def arguments_of(given: Value, context: Context, spot: Spot) -> dict[str, Value] | None:
    """The launch arguments that an include passes on, with what they come to; None where they cannot be told."""
    if given is None:
        return {}
    if isinstance(given, dict):
        context.wrong.append(("launch_arguments is given a dict: write .items() behind it", spot))
        given = list(given.items())
    if not isinstance(given, list | tuple) or not all(
        isinstance(each, list | tuple) and len(each) == 2 for each in given
    ):
        return None
    named = [(resolve(name, context), resolve(value, context)) for name, value in given]
    return {name: value for name, value in named if isinstance(name, str)}
