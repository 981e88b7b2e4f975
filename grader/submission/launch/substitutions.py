"""What launch's substitutions come to, with the defaults of the launch arguments."""

import posixpath
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import PurePosixPath

from grader.submission.launch.places import HOME, PREFIX, SHARE
from grader.submission.python.values import Made, Spot, Unknown, Value

UNTOLD = "\0"  # stands in a command for a part that cannot be told
_MOST_DEPTH = 40
_XACRO = re.compile(r"(?:\S*/)?(?:ros2\s+run\s+xacro\s+)?xacro(?:\.py)?\s+(?P<path>\S+)")
_CAT = re.compile(r"(?:\S*/)?(?:cat|type)\s+(?P<path>\S+)")
_GLUED = re.compile(r"(?:xacro|cat)/")


@dataclass(frozen=True, slots=True)
class Contents:
    """What is in a file, read by open, cat or xacro."""

    path: str
    by: str


@dataclass(slots=True)
class Context:
    """The launch arguments that are known so far, and the folder of the launch file as it is installed."""

    folder: str
    arguments: dict[str, Value] = field(default_factory=dict)
    undeclared: list[tuple[str, Spot]] = field(default_factory=list)
    wrong: list[tuple[str, Spot]] = field(default_factory=list)


def resolve(value: Value, context: Context, depth: int = 0) -> "str | Contents | Unknown":
    """The text that a value comes to, or what is in a file; Unknown, with the reason, where only a run would tell."""
    if depth > _MOST_DEPTH:
        return Unknown("it is too deeply nested", Spot(1, 1))
    match value:
        case str() | int() | float() | PurePosixPath():
            return str(value)
        case Unknown():
            return value
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
    return text


def _made(made: Made, context: Context, depth: int) -> "str | Contents | Unknown":
    def of(position: int, *names: str) -> "str | Contents | Unknown":
        return resolve(made.argument(position, *names), context, depth + 1)

    last = made.name.rpartition(".")[2]
    match last:
        case "TextSubstitution":
            return of(0, "text")
        case "LaunchConfiguration":
            return _configuration(made, context, depth)
        case "PathJoinSubstitution":
            return _path(made.argument(0, "substitutions"), context, depth, made.at)
        case "PathSubstitution" | "ParameterValue" | "ParameterFile" | "AnyLaunchDescriptionSource":
            return of(0, "path", "value", "param_file", "location")
        case "PythonLaunchDescriptionSource" | "XMLLaunchDescriptionSource" | "YAMLLaunchDescriptionSource":
            return of(0, "location")
        case "FrontendLaunchDescriptionSource":
            return of(0, "location")
        case "truediv":
            return _path(made.args, context, depth, made.at)
        case (
            "FindPackageShare" | "FindPackageShareDirectory" | "get_package_share_directory" | "get_package_share_path"
        ):
            return below(SHARE, of(0, "package", "package_name"))
        case "FindPackagePrefix" | "FindPackage" | "get_package_prefix":
            package = of(0, "package", "package_name")
            return PREFIX if isinstance(package, str) else package
        case "join" if made.name == "os.path.join":
            return _wrongly_joined(made, context, depth)
        case "ThisLaunchFileDir" | "ThisLaunchFile":
            return context.folder
        case "FindExecutable":
            return of(0, "name")
        case "Command":
            return _command(made, context, depth)
        case "process_file":
            path = of(0, "input_file_name")
            return Contents(path, "xacro") if isinstance(path, str) else path
        case "parse":  # xacro.parse(open(path)), or of what is in it
            return _reread(of(0), "xacro")
        case "open" if made.name in ("builtins.open", "io.open", "codecs.open"):
            path = of(0, "file")
            return Contents(path, "open") if isinstance(path, str) else path
        case "EnvironmentVariable" | "getenv" | "environ[]" | "get" if "nviron" in made.name or last == "getenv":
            return HOME if made.args and made.args[0] == "HOME" else Unknown("it depends on the environment", made.at)
        case "expanduser":
            text = of(0)
            return text.replace("~", HOME, 1) if isinstance(text, str) and text.startswith("~") else text
        case "home" if made.name.startswith("pathlib."):
            return HOME
        case "perform" | "read" | "toxml" | "toprettyxml" | "documentElement" | "decode" | "strip" | "replace":
            return resolve(made.owner, context, depth + 1)
        case _:
            return Unknown(f"what {last} gives is told only by a run", made.at)


def _wrongly_joined(made: Made, context: Context, depth: int) -> "str | Contents | Unknown":
    """os.path.join of something that is no text before the launch runs."""
    objects = [each for each in made.args if isinstance(each, Made)]
    if all(each.name.endswith((".perform", ".find")) for each in objects):
        return _path(made.args, context, depth, made.at)
    if any(each.name.startswith(("launch.", "launch_ros.")) for each in objects):
        context.wrong.append(("os.path.join takes texts, not substitutions: use PathJoinSubstitution([...])", made.at))
        return _path(made.args, context, depth, made.at)
    return Unknown("a part of this path is told only by a run", made.at)


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
        value = context.arguments[name]
        if value is None:
            return Unknown(f"the launch argument {name!r} has no default", made.at)
        return resolve(value, context, depth + 1)
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
    return posixpath.join(*texts) if texts else Unknown("an empty path", spot)


def _command(made: Made, context: Context, depth: int) -> "str | Contents | Unknown":
    """What a command prints: the file that it reads, for xacro and cat."""
    parts = made.argument(0, "command")
    pieces = parts if isinstance(parts, list | tuple) else [parts]
    texts = [resolve(piece, context, depth + 1) for piece in pieces]
    unknown = next((text for text in texts if isinstance(text, Unknown)), None)
    command = "".join(text if isinstance(text, str) else UNTOLD for text in texts).strip()
    if _GLUED.match(command):
        program = command.split("/")[0]
        context.wrong.append((f"a space is missing between {program} and the path: write '{program} '", made.at))
        command = command.replace(program, program + " ", 1)
    for pattern, by in ((_XACRO, "xacro"), (_CAT, "cat")):
        found = pattern.match(command)
        if found is None:
            continue
        path = found["path"].strip("'\"")
        if UNTOLD in path:
            return unknown or Unknown("which file is read is told only by a run", made.at)
        return Contents(path, by)
    return unknown or Unknown("what this command prints is told only by a run", made.at)


def holds(condition: Value, context: Context) -> bool | None:
    """Whether a condition of a node holds with the defaults; None where only a run would tell."""
    if condition is None:
        return True
    if not isinstance(condition, Made):
        return None
    last = condition.name.rpartition(".")[2]
    if last in ("IfCondition", "UnlessCondition"):
        known = _truth(resolve(condition.argument(0, "predicate_expression"), context))
        return known if known is None or last == "IfCondition" else not known
    if last in ("LaunchConfigurationEquals", "LaunchConfigurationNotEquals"):
        name = condition.argument(0, "launch_configuration_name")
        value = resolve(condition.argument(1, "expected_value"), context)
        actual = resolve(context.arguments.get(name) if isinstance(name, str) else None, context)
        if not isinstance(value, str) or not isinstance(actual, str):
            return None
        return (value == actual) == (last == "LaunchConfigurationEquals")
    return None


def _truth(value: "str | Contents | Unknown") -> bool | None:
    if not isinstance(value, str):
        return None
    return {"true": True, "1": True, "false": False, "0": False}.get(value.strip().lower())


def arguments_of(given: Value) -> Mapping[str, Value] | None:
    """The launch arguments that an include passes on; None where they cannot be told."""
    if given is None:
        return {}
    if isinstance(given, dict):
        return {str(name): value for name, value in given.items()}
    if not isinstance(given, list | tuple) or not all(
        isinstance(each, list | tuple) and len(each) == 2 for each in given
    ):
        return None
    return {str(name): value for name, value in given}
