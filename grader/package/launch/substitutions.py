"""The values of launch's substitutions, with the defaults of the launch arguments."""

import posixpath
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import PurePosixPath

from grader.package.launch.booleans import BOOLEAN_SUBSTITUTIONS, boolean_substitution, operands_of
from grader.package.launch.commands import command_output, opened_by
from grader.package.launch.model import Contents, Context, Resolved
from grader.package.launch.places import HOME, PREFIX, SHARE
from grader.static_python.budget import Budget, OutOfBudget
from grader.static_python.builtins import BUILTINS
from grader.static_python.expressions import evaluate
from grader.static_python.parse import START
from grader.static_python.values import (
    MAX_TEXT,
    UNKNOWN_KEYS,
    Call,
    ExpressionFails,
    Undetermined,
    Unknown,
    Value,
    as_text,
    str_of,
)

COMMAND_LINE = "launch.frontend.command line"  # a line that is split into words, as in XML and YAML
_MAX_DEPTH, _WORK = 40, 10_000  # of substitutions in others, and of an expression
# Methods whose result is the text, or the contents, of the object that they are called on.
_OF_OWNER = ("perform", "read", "toxml", "toprettyxml", "documentElement", "decode", "strip")
_PACKAGE_FOLDERS = (
    "FindPackageShare", "FindPackageShareDirectory", "get_package_share_directory", "get_package_share_path",
    "FindPackagePrefix", "FindPackage", "get_package_prefix",
)  # fmt: skip


def resolve(value: Value, context: Context, depth: int = 0) -> Resolved:
    """Return the text of a value, or the contents of a file; Unknown where this is known only at run time."""
    context.steps_left[0] -= 1
    if depth > _MAX_DEPTH or context.steps_left[0] < 0:
        return Unknown("a substitution is too deeply nested", START)
    found: Resolved | None = None
    reason = "the text of this value is known only at run time"
    match value:
        case Contents() | Unknown():
            found = value
        case str() | int() | float() | PurePosixPath():
            found, reason = as_text(value), "a number is too long"
        case [part]:
            found = resolve(part, context, depth + 1)
        case list() | tuple():
            texts = _texts(value, context, depth)
            found = "".join(texts) if isinstance(texts, list) else texts
        case Call():
            found = _Substitution(value, context, depth).value()
    return found if found is not None else Unknown(reason, START)


def _texts(parts: list[Value] | tuple[Value, ...], context: Context, depth: int) -> list[str] | Unknown:
    """Return the texts of some parts; Unknown if one is unknown or the contents of a file."""
    texts: list[str] = []
    length = 0
    for part in parts:
        text = resolve(part, context, depth + 1)
        if not isinstance(text, str):
            return text if isinstance(text, Unknown) else Unknown("the content of a file is part of a string", START)
        texts.append(text)
        length += len(text)
        if length > MAX_TEXT:
            return Unknown("a string grows too long", START)
    return texts


@dataclass(slots=True)
class _Substitution:
    """A call of a substitution, or of a function that Python, xacro or ament_index has for the same purpose."""

    call: Call
    context: Context
    depth: int

    def value(self) -> Resolved:
        """Return the text that the call gives, or the contents of a file."""
        name = self.call.name.rpartition(".")[2]
        if name in _METHODS:
            return _METHODS[name](self)
        if name.endswith("LaunchDescriptionSource"):
            return self.argument("launch_file_path", "location")
        if name in BOOLEAN_SUBSTITUTIONS:
            operands = [self.resolve(operand) for operand in operands_of(self.call)]
            return boolean_substitution(name, operands, self.call.at)
        return self.python_function(name)

    def python_function(self, name: str) -> Resolved:
        """Return what a function of Python or xacro gives; Unknown for all others."""
        full = self.call.name
        match name:
            case "join" if full == "os.path.join":
                self.needs_texts("os.path.join takes strings, not substitutions: use PathJoinSubstitution([...])")
                return self.path(self.call.args)
            case "process_file" | "process" if full.startswith("xacro."):
                self.needs_texts(f"xacro.{name} takes a path, not a substitution: use Command(['xacro ', ...])", 1)
                return self.contents("xacro", "input_file_name", arguments=self.mappings())
            case "open" if full in ("builtins.open", "io.open", "codecs.open"):
                self.needs_texts("open takes a path, not a substitution: use Command(['cat ', ...])", 1)
                return self.contents(opened_by(self.call), "file", "filename")
            case "EnvironmentVariable" | "getenv" | "environ[]" | "get" if "nviron" in full or name == "getenv":
                is_home = self.argument("name") == "HOME"
                return HOME if is_home else Unknown("the environment is known only at run time", self.call.at)
        return Unknown(f"the result of {name} is known only at run time", self.call.at)

    def parse(self) -> Resolved:
        """Return what xacro.parse gives, of an open file or of the contents."""
        opened = self.argument()
        return Contents(opened.path, "xacro") if isinstance(opened, Contents) else opened

    def expanduser(self) -> Resolved:
        """Return a path with the home folder instead of ~."""
        text = self.argument()
        return text.replace("~", HOME, 1) if isinstance(text, str) and text.startswith("~") else text

    def resolve(self, value: Value) -> Resolved:
        return resolve(value, self.context, self.depth + 1)

    def argument(self, *names: str) -> Resolved:
        return self.resolve(self.call.argument(0, *names))

    def contents(self, by: str, *names: str, arguments: tuple[tuple[str, str | None], ...] = ()) -> Resolved:
        path = self.argument(*names)
        return Contents(path, by, arguments) if isinstance(path, str) else path

    def mappings(self) -> tuple[tuple[str, str | None], ...]:
        """Return the arguments that xacro.process_file gets."""
        given = self.call.kwargs.get("mappings")
        values = {name: self.resolve(value) for name, value in given.items()} if isinstance(given, dict) else {}
        return tuple((name, value if isinstance(value, str) else None) for name, value in values.items())

    def needs_texts(self, message: str, count: int | None = None) -> None:
        """Add an error if a function of Python gets a substitution: without .perform or .find it has no text yet."""
        names = [value.name for value in self.call.args[:count] if isinstance(value, Call)]
        if any(it.startswith(("launch.", "launch_ros.")) and not it.endswith((".perform", ".find")) for it in names):
            self.context.add_error(message, self.call.at)

    def path(self, parts: Value) -> Resolved:
        if not isinstance(parts, list | tuple):
            return self.resolve(parts)
        texts = _texts(parts, self.context, self.depth)
        if isinstance(texts, Unknown):
            return texts
        return posixpath.join(*texts) if texts else Unknown("a path is empty", self.call.at)

    def joined_path(self) -> Resolved:
        if len(self.call.args) > 1:
            message = "PathJoinSubstitution takes one list: put [ ] around the parts of the path"
            self.context.add_error(message, self.call.at)
            return self.path(self.call.args)
        return self.path(self.call.argument(0, "substitutions"))

    def package_folder(self) -> Resolved:
        package = self.argument("package", "package_name")
        is_share = "share" in self.call.name.rpartition(".")[2].lower()
        folder = f"{SHARE}/{package}" if is_share else PREFIX
        return folder if isinstance(package, str) else package

    def executable(self) -> Resolved:
        names = [self.argument("executable"), self.resolve(self.call.argument(1, "package"))]
        unknown = next((name for name in names if not isinstance(name, str)), None)
        return f"{PREFIX}/lib/{names[1]}/{names[0]}" if unknown is None else unknown

    def configuration(self) -> Resolved:
        name = self.argument("variable_name")
        if not isinstance(name, str):
            return name
        value = self.context.arguments.get(name, self.call.argument(1, "default"))
        if value is not None or name in self.context.arguments:
            return self.resolve(value)
        if UNKNOWN_KEYS in self.context.arguments:
            return Unknown(f"the launch argument {name!r} may be declared in an included file", self.call.at)
        message = f"the launch argument {name!r} is used, but DeclareLaunchArgument does not declare it before"
        self.context.add_error(message, self.call.at)
        return Unknown(f"the launch argument {name!r} is not declared", self.call.at)

    def command(self) -> Resolved:
        """Return the contents of the file that a command prints, for xacro and cat."""
        parts = self.call.argument(0, "command")
        texts = [self.resolve(piece) for piece in (parts if isinstance(parts, list | tuple) else [parts])]
        return command_output(texts, self.context, self.call.at)

    def expression(self) -> Resolved:
        """Return the value of a Python expression that contains plain values only."""
        text = self.argument("expression")
        unknown = Unknown("the value of this expression is known only at run time", self.call.at)
        if not isinstance(text, str):
            return text if isinstance(text, Unknown) else unknown
        budget = Budget(_WORK)
        try:
            return str_of(evaluate(text, _builtin, budget))
        except (ExpressionFails, Undetermined, OutOfBudget):
            return unknown
        finally:
            self.context.steps_left[0] -= budget.used


def _builtin(name: str) -> Value:
    if name not in BUILTINS:
        raise Undetermined(f"the name {name} is known only at run time")
    return BUILTINS[name]


_METHODS: dict[str, Callable[[_Substitution], Resolved]] = {
    **dict.fromkeys(_OF_OWNER, lambda substitution: substitution.resolve(substitution.call.owner)),
    **dict.fromkeys(_PACKAGE_FOLDERS, _Substitution.package_folder),
    COMMAND_LINE.rpartition(".")[2]: lambda substitution: substitution.resolve(substitution.call.args or ""),
    "TextSubstitution": lambda substitution: substitution.argument("text"),
    "PathSubstitution": lambda substitution: substitution.argument("path"),
    "ParameterValue": lambda substitution: substitution.argument("value"),
    "ParameterFile": lambda substitution: substitution.argument("param_file"),
    "FindExecutable": lambda substitution: substitution.argument("name"),
    "ExecutableInPackage": _Substitution.executable,
    "LaunchConfiguration": _Substitution.configuration,
    "PathJoinSubstitution": _Substitution.joined_path,
    "ThisLaunchFileDir": lambda substitution: substitution.context.folder,
    "Command": _Substitution.command,
    "parse": _Substitution.parse,
    "expanduser": _Substitution.expanduser,
    "FileContent": lambda substitution: substitution.contents("open", "path"),
    "PythonExpression": _Substitution.expression,
    "truediv": lambda substitution: substitution.path(substitution.call.args),
}
