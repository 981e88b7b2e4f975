"""The texts of launch's substitutions, with the launch configurations so far."""

import posixpath
from collections.abc import Callable
from dataclasses import dataclass

from grader.package.launch.commands import command_output, contents_of
from grader.package.launch.expression import expression_text
from grader.package.launch.model import Contents, Context, LaunchFails, NotEvaluated, Resolved
from grader.package.launch.places import HOME, PREFIX, SHARE
from grader.package.launch.truth import are_equal, boolean, operand
from grader.package.launch.value_types import gives_text
from grader.static_python.parse import Position
from grader.static_python.values import (
    MAX_TEXT,
    UNKNOWN_KEYS,
    Call,
    Unknown,
    Value,
)

_MAX_DEPTH, _WORK = 40, 10_000  # of substitutions in others, and of an expression
_PROGRAMS = frozenset({"xacro", "cat", "ros2", "python3", "bash", "sh", "echo", "env", "rviz2"})


def resolve(value: Value, context: Context, at: Position, depth: int = 0) -> Resolved:
    """Return the text of a value, or the contents of a file; Unknown where it certainly is a text, but not known.

    Raises LaunchFails where launch certainly raises an error, NotEvaluated where it may.
    """
    context.around.steps_left -= 1
    if depth > _MAX_DEPTH or context.around.steps_left < 0:
        raise NotEvaluated("a substitution that is nested so deeply is not evaluated", at)
    match value:
        case str() | Contents() | Unknown():
            return value
        case Call() if value.name.endswith(".perform"):
            return resolve(value.owner if value.owner is not None else value.args[-1], context, at, depth + 1)
        case Call() if gives_text(value.name) or value.name.startswith("xacro."):
            return contents_of(value, context)
        case Call():
            return _Substitution(value, context, depth).value()
        case list() | tuple() | dict() | set():
            return _joined([resolve(part, context, at, depth + 1) for part in value], at)
    raise NotEvaluated("the text of this value is not evaluated", at)


def _joined(parts: list[Resolved], at: Position) -> Resolved:
    if len(parts) == 1:
        return parts[0]
    texts = [part for part in parts if isinstance(part, str)]
    if len(texts) < len(parts):
        unknown = (part for part in parts if isinstance(part, Unknown))
        return next(unknown, Unknown("the content of a file is part of a string", at))
    if sum(map(len, texts)) > MAX_TEXT:
        raise NotEvaluated("a string grows too long", at)
    return "".join(texts)


def known_text(value: Value, context: Context, at: Position) -> str:
    """Return the text of a value. Raises NotEvaluated where it is not known."""
    found = resolve(value, context, at)
    if isinstance(found, str):
        return found
    raise NotEvaluated(found.reason if isinstance(found, Unknown) else "the content of a file is used as a text", at)


@dataclass(slots=True)
class _Substitution:
    call: Call
    context: Context
    depth: int

    def value(self) -> Resolved:
        perform = _PERFORMS.get(self.call.name.rpartition(".")[2])
        if perform is None:
            raise NotEvaluated(f"{self.call.name.rpartition('.')[2]} is not evaluated", self.call.at)
        return perform(self)

    def resolve(self, value: Value) -> Resolved:
        return resolve(value, self.context, self.call.at, self.depth + 1)

    def argument(self, name: str, default: Value = "") -> Resolved:
        return self.resolve(self.call.kwargs.get(name, default))

    def texts(self, *values: Value) -> list[str] | Unknown:
        """Return the texts of some values; Unknown if one of them is."""
        found = [self.resolve(value) for value in values]
        unknown = next((it for it in found if isinstance(it, Unknown)), None)
        texts = [it for it in found if isinstance(it, str)]
        return texts if len(texts) == len(found) else unknown or Unknown("the content of a file is used", self.call.at)

    def booleans(self, *values: Value) -> list[bool]:
        texts = self.texts(*values)
        if isinstance(texts, Unknown):
            raise NotEvaluated(texts.reason, texts.at)
        return [boolean(text, self.call.at) for text in texts]

    def combined(self, function: Callable[[list[bool]], bool]) -> str:
        names = [name for name in ("value", "left", "right") if name in self.call.kwargs]
        operands = [*(self.call.kwargs[name] for name in names), *self.call.args]
        return str(function(self.booleans(*operands))).lower()

    def compared(self, *, equal: bool) -> Resolved:
        texts = self.texts(*(operand(self.call.kwargs[name]) for name in ("left", "right")))
        return texts if isinstance(texts, Unknown) else str(are_equal(*texts) == equal).lower()

    def if_else(self) -> Resolved:
        is_chosen = self.booleans(self.call.kwargs["condition"])[0]
        return self.argument("if_value" if is_chosen else "else_value")

    def configuration(self) -> Resolved:
        name, arguments = self.argument("variable_name"), self.context.arguments
        if not isinstance(name, str):
            raise NotEvaluated("the name of a launch configuration is not evaluated", self.call.at)
        if name in arguments:
            return arguments[name]
        default = self.call.kwargs.get("default")
        if UNKNOWN_KEYS in arguments:
            raise NotEvaluated(
                f"whether {name!r} is declared in a file that is not submitted is not evaluated", self.call.at
            )
        if default is not None:
            items = default if isinstance(default, list | tuple) else [default]
            return self.resolve([item if isinstance(item, str | Call | Unknown) else str(item) for item in items])
        message = f"the launch argument {name!r} is used, but DeclareLaunchArgument does not declare it before"
        raise LaunchFails(message, self.call.at)

    def variable(self) -> Resolved:
        default = self.call.kwargs.get("default_value")
        found = self.resolve(default) if default is not None else None
        name = self.argument("name")
        if isinstance(name, str) and name in self.context.environment:
            value = self.context.environment[name]
            if value is None and found is None:
                raise LaunchFails(f"the environment variable {name!r} is not set", self.call.at)
            return value if value is not None else found or ""
        if name == "HOME":
            return HOME
        if found is None:
            raise NotEvaluated(f"whether the environment variable {name!r} is set is not evaluated", self.call.at)
        return Unknown("the environment is not evaluated", self.call.at)

    def path(self) -> Resolved:
        parts = self.call.kwargs["substitutions"]
        texts = self.texts(*(parts if isinstance(parts, list | tuple) else [parts]))
        if isinstance(texts, Unknown):
            return texts
        if not texts:
            raise LaunchFails("PathJoinSubstitution is given no path", self.call.at)
        return posixpath.join(*texts)

    def package_folder(self) -> Resolved:
        package = self.argument("package")
        if isinstance(package, Unknown):
            return package
        if not isinstance(package, str) or not self.context.around.is_installed(package):
            shown = repr(package) if isinstance(package, str) else "that is read from a file"
            raise NotEvaluated(f"whether the package {shown} is installed is not evaluated", self.call.at)
        return f"{SHARE}/{package}" if self.call.name.endswith("Share") else PREFIX

    def executable(self) -> Resolved:
        folder, texts = self.package_folder(), self.texts(*map(self.call.kwargs.get, ("executable", "package")))
        return f"{folder}/lib/{texts[1]}/{texts[0]}" if isinstance(texts, list) else texts

    def program(self) -> Resolved:
        name = self.argument("name")
        if isinstance(name, str) and name not in _PROGRAMS:
            raise NotEvaluated(f"whether the program {name!r} is installed is not evaluated", self.call.at)
        return name

    def command(self) -> Resolved:
        mode = self.argument("on_stderr", "fail")
        if isinstance(mode, str) and mode not in ("fail", "ignore", "warn", "capture"):
            raise LaunchFails("on_stderr is one of fail, ignore, warn, capture", self.call.at)
        parts = self.call.kwargs["command"]
        texts = [self.resolve(piece) for piece in (parts if isinstance(parts, list | tuple) else [parts])]
        return self.read(command_output(texts, self.call.at))

    def read(self, contents: Contents) -> Contents:
        self.context.reads.append((contents, self.call.at))
        return contents

    def file_content(self) -> Resolved:
        path = self.argument("path")
        return self.read(Contents(path, "open")) if isinstance(path, str) else path

    def expression(self) -> Resolved:
        texts = self.texts(self.call.kwargs["expression"])
        if isinstance(texts, Unknown):
            raise NotEvaluated(f"this expression is not evaluated: {texts.reason}", self.call.at)
        return expression_text(texts[0], self.call.kwargs.get("python_modules", ["math"]), self.call.at, self.context)


_PERFORMS: dict[str, Callable[[_Substitution], Resolved]] = {
    "TextSubstitution": lambda it: it.argument("text"),
    "LaunchConfiguration": _Substitution.configuration,
    "PathJoinSubstitution": _Substitution.path,
    "Command": _Substitution.command,
    "PythonExpression": _Substitution.expression,
    "FindPackageShare": _Substitution.package_folder,
    "FindPackagePrefix": _Substitution.package_folder,
    "FindPackage": _Substitution.package_folder,
    "ExecutableInPackage": _Substitution.executable,
    "FindExecutable": _Substitution.program,
    "EnvironmentVariable": _Substitution.variable,
    "FileContent": _Substitution.file_content,
    "ThisLaunchFile": lambda it: it.context.path,
    "ThisLaunchFileDir": lambda it: posixpath.dirname(it.context.path),
    "AnonName": lambda it: it.argument("name") and Unknown("an anonymous name is not evaluated", it.call.at),
    "LaunchLogDir": lambda it: Unknown("the folder of the log is not evaluated", it.call.at),
    "EqualsSubstitution": lambda it: it.compared(equal=True),
    "NotEqualsSubstitution": lambda it: it.compared(equal=False),
    "NotSubstitution": lambda it: it.combined(lambda values: not values[0]),
    "AndSubstitution": lambda it: it.combined(all),
    "OrSubstitution": lambda it: it.combined(any),
    "AllSubstitution": lambda it: it.combined(all),
    "AnySubstitution": lambda it: it.combined(any),
    "IfElseSubstitution": _Substitution.if_else,
}
