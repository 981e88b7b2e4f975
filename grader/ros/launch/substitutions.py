"""The texts of substitutions, as launch evaluates them, and the files that their commands print."""

import posixpath
import re
import shlex
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from math import isclose
from pathlib import PurePosixPath

from grader.base.grouping import as_list, texts_among
from grader.base.names import last_part
from grader.base.records import Record
from grader.base.text import enumerated
from grader.ros.config.yaml_nodes import yaml_value
from grader.ros.installation.places import HOME, PREFIX, SHARE
from grader.ros.known.package_rows import find_programs, package_row
from grader.ros.known.python_names import python_names
from grader.ros.known.releases import RELEASES
from grader.ros.launch.launch_model import Contents, Context, FileText, Resolved
from grader.ros.python.budget import Budget, OutOfBudget
from grader.ros.python.builtins import BUILTINS, MATH
from grader.ros.python.expressions import evaluate
from grader.ros.python.parse import START, Position
from grader.ros.python.values import (
    MAX_TEXT,
    Call,
    EvaluationFails,
    EvaluationSignal,
    MissingDeclaration,
    MissingValue,
    Namespace,
    Undetermined,
    Unknown,
    Value,
    charge_str,
)

_BOOLEANS = {"true": True, "1": True, "false": False, "0": False}
_OF_CMAKE = b"<build_type>ament_cmake</build_type>"
_MAX_DEPTH, _WORK = 40, 10_000  # of substitutions in others, and of an expression
_TOO_DEEP = "a substitution that is nested so deeply is not evaluated"
TEXT_PARTS = (str, PurePosixPath, Call, Unknown)  # of which a text may consist
PART_UNKNOWN = "\0"  # stands in a command for a part that is unknown
_PROGRAMS = frozenset({"xacro", "cat", "ros2", "python3", "bash", "sh", "echo", "env", "rviz2"})


@contextmanager
def located(at: Position) -> Iterator[None]:
    """Give signals a place that have none."""
    try:
        yield
    except EvaluationSignal as signal:
        signal.at = signal.at or at
        raise


def resolve(value: Value, context: Context, at: Position, depth: int = 0) -> Resolved:
    """Return the text of a value, or the contents of a file.

    Returns Unknown where it certainly is a text, but not known.

    Raises EvaluationFails where launch certainly raises an error, Undetermined where it may.
    """
    try:
        context.budget.charge(1)
    except OutOfBudget:
        raise Undetermined(_TOO_DEEP) from None
    if depth > _MAX_DEPTH:
        raise Undetermined(_TOO_DEEP)
    match value:
        case FileText(contents=contents):
            context.reads.append((contents, value.at))
            return contents
        case str() | Contents() | Unknown():
            return value
        case PurePosixPath():
            return str(value)
        case Call():
            return _Substitution(value, context, depth).value()
        case list() | tuple() | dict() | set():
            return _joined_text([resolve(part, context, at, depth + 1) for part in value], at)
    raise Undetermined("the text of this value is not evaluated")


def listed(value: Value) -> Sequence[Value]:
    """Return the parts of a value that may be one, or a list of them."""
    return value if isinstance(value, list | tuple) else [value]


def _joined_text(parts: list[Resolved], at: Position) -> Resolved:
    if len(parts) == 1:
        return parts[0]
    texts = texts_among(parts)
    if len(texts) < len(parts):
        unknown = (part for part in parts if isinstance(part, Unknown))
        return next(unknown, Unknown("the content of a file is part of a string", at))
    if sum(map(len, texts)) > MAX_TEXT:
        raise Undetermined("a string grows too long")
    return "".join(texts)


def known_text(value: Value, context: Context) -> str:
    """Return the text of a value. Raises Undetermined where it is not known."""
    text = resolve(value, context, START)
    if isinstance(text, str):
        return text
    raise not_a_text(text)


def not_a_text(value: Contents | Unknown) -> Undetermined:
    """Return the signal that a text is needed in place of a value."""
    if isinstance(value, Unknown):
        return value.as_signal()
    return Undetermined("the content of a file is used as a text")


def boolean(text: str) -> bool:
    """Return the value of a text as launch reads it where it wants a boolean.

    It reads it by the rules of YAML.
    """
    truth = _BOOLEANS[text] if text in ("0", "1") else None
    if truth is None and len(text) < 20:
        with suppress(ValueError):
            truth = yaml_value(text)
    if not isinstance(truth, bool):
        raise EvaluationFails(f"{text[:40]!r} is neither true nor false")
    return truth


def condition_holds(given: Call, context: Context) -> bool:
    """Return whether a condition of `CONDITIONS` holds. Raises EvaluationSignal."""
    with located(given.at):
        return _holds(given, context)


def _holds(given: Call, context: Context) -> bool:
    kind = given.short
    if kind in ("IfCondition", "UnlessCondition"):
        text = known_text(given.kwargs["predicate_expression"], context)
        holds = _BOOLEANS.get(text.strip().lower())
        if holds is None:
            raise EvaluationFails(f"a condition is {text[:40]!r}, expected true or false")
        return holds == (kind == "IfCondition")
    name = given.kwargs["launch_configuration_name"]
    wanted = given.kwargs["expected_value"]
    expected = known_text(wanted, context) if wanted is not None else None
    argument = (
        context.arguments.get(name) if isinstance(name, str) else None
    )  # no other object is the key of one
    if (
        isinstance(name, Unknown)
        or (argument is None and context.has_others)
        or not isinstance(argument, str | None)
    ):
        raise Undetermined("the launch configuration of this condition is not evaluated")
    return (argument == expected) == (kind == "LaunchConfigurationEquals")


class _Substitution(Record):
    call: Call
    context: Context
    depth: int

    @property
    def at(self) -> Position:
        return self.call.at

    def value(self) -> Resolved:
        perform = PERFORMS.get(self.call.short)
        with located(self.at):
            if perform is None:
                raise Undetermined(f"{self.call.short} is not evaluated")
            return perform(self)

    def resolve(self, value: Value) -> Resolved:
        return resolve(value, self.context, self.at, self.depth + 1)

    def argument(self, name: str, default: Value = "") -> Resolved:
        return self.resolve(self.call.kwargs.get(name, default))

    def known_argument(self, name: str) -> str:
        return known_text(self.call.kwargs[name], self.context)

    def texts(self, *values: Value) -> list[str] | Unknown:
        """Return the texts of some values; Unknown if one of them is."""
        results = [self.resolve(value) for value in values]
        unknown = next((result for result in results if isinstance(result, Unknown)), None)
        texts = texts_among(results)
        if len(texts) == len(results):
            return texts
        return unknown or Unknown("the content of a file is used", self.at)

    def configuration(self) -> Resolved:
        name = self.argument("variable_name")
        arguments = self.context.arguments
        if not isinstance(name, str):
            raise Undetermined("the name of a launch configuration is not evaluated")
        if name in arguments:
            return arguments[name]
        default = self.call.kwargs.get("default")
        if self.context.has_others:
            raise Undetermined(
                f"whether {name!r} is declared in a file that is not submitted is not evaluated",
            )
        if default is not None:
            items = listed(default)
            return self.resolve(
                [item if isinstance(item, TEXT_PARTS) else str(item) for item in items]
            )
        message = (
            f"the launch argument {name!r} is used, but DeclareLaunchArgument does not declare "
            "it before"
        )
        raise MissingDeclaration(message)

    def variable(self) -> Resolved:
        name = self.argument("name")
        default = self.call.kwargs.get("default_value")
        if name == "HOME":
            return HOME
        if default is None:
            raise Undetermined(f"whether the environment variable {name!r} is set is not evaluated")
        self.resolve(default)
        return Unknown("the environment is not evaluated", self.at)

    def path(self) -> Resolved:
        given = self.call.kwargs
        if "substitutions" in given:
            texts = self.texts(*listed(given["substitutions"]))
        else:
            texts = self.texts(given["path"])  # of a PathSubstitution
        if isinstance(texts, Unknown):
            return texts
        if not texts:
            raise EvaluationFails("PathJoinSubstitution is given no path")
        return posixpath.join(*texts)

    def joined_strings(self) -> Resolved:
        texts = self.texts(*listed(self.call.kwargs["substitutions"]))
        delimiter = self.argument("delimiter")
        if isinstance(texts, Unknown):
            return texts
        if not isinstance(delimiter, str):
            raise Undetermined("the delimiter of these strings is not evaluated")
        return delimiter.join(texts)

    def package_folder(self) -> Resolved:
        package = self.argument("package")
        if isinstance(package, Unknown):
            return package
        meant = self.context.machine.misspelt_package(package) if isinstance(package, str) else None
        if meant is not None:
            self.context.faults.append((no_package(str(package), meant), self.at))
            return f"{SHARE}/{meant}"
        if not isinstance(package, str) or not self.context.machine.has_package(package):
            shown = repr(package) if isinstance(package, str) else "that is read from a file"
            raise Undetermined(f"whether the package {shown} is installed is not evaluated")
        return f"{SHARE}/{package}"

    def package_prefix(self) -> Resolved:
        folder = self.package_folder()
        return PREFIX if isinstance(folder, str) else folder

    def program(self) -> Resolved:
        name = self.argument("name")
        if isinstance(name, str) and name not in _PROGRAMS:
            raise Undetermined(f"whether the program {name!r} is installed is not evaluated")
        return name

    def command(self) -> Resolved:
        mode = self.argument("on_stderr", "fail")
        if isinstance(mode, str) and mode not in ("fail", "ignore", "warn", "capture"):
            raise EvaluationFails("on_stderr is one of fail, ignore, warn, capture")
        texts = [self.resolve(part) for part in listed(self.call.kwargs["command"])]
        contents = _command_output(texts, stops_at_stderr=mode == "fail")
        self.context.reads.append((contents, self.at))
        return contents

    def expression(self) -> Resolved:
        texts = self.texts(self.call.kwargs["expression"])
        if isinstance(texts, Unknown):
            raise Undetermined(f"this expression is not evaluated: {texts.reason}")
        modules = self.texts(*listed(self.call.kwargs.get("python_modules", ["math"])))
        if modules != ["math"]:
            raise Undetermined("the modules of this expression are not evaluated")
        return _expression_text(texts[0], self.context)

    def is_true(self, name: str) -> bool:
        """Return an argument that is read as a boolean."""
        return boolean(self.known_argument(name))

    def both(self) -> str:
        left = self.is_true("left")
        right = self.is_true("right")
        return str(left and right).lower()

    def either(self) -> str:
        left = self.is_true("left")
        right = self.is_true("right")
        return str(left or right).lower()

    def choice(self) -> Resolved:
        return self.argument("if_value" if self.is_true("condition") else "else_value")

    def equals(self) -> str:
        """Return whether two texts are equal: as booleans, as numbers, or as they are."""
        left, right = (self.compared(name) for name in ("left", "right"))
        if left.lower() in _BOOLEANS and right.lower() in _BOOLEANS:
            return str(_BOOLEANS[left.lower()] == _BOOLEANS[right.lower()]).lower()
        with suppress(ValueError):
            return str(isclose(float(left), float(right))).lower()
        return str(left == right).lower()

    def compared(self, name: str) -> str:
        value = self.call.kwargs[name]
        if value is None:
            value = ""
        elif isinstance(value, bool):
            value = str(value).lower()
        elif isinstance(value, int | float):
            value = str(value)
        elif not all(isinstance(part, TEXT_PARTS) for part in as_list(value)):
            raise Undetermined("the text of a list in this substitution is not evaluated")
        return known_text(value, self.context)

    def file_content(self) -> Contents:
        contents = Contents(self.known_argument("path"), "open")
        self.context.reads.append((contents, self.at))
        return contents

    def executable(self) -> Resolved:
        """Return the path of a program of a package. Raises EvaluationSignal."""
        package = self.known_argument("package")
        name = self.known_argument("executable")
        check_program(package, name, self.context)
        return f"{PREFIX}/lib/{package}/{name}"


def no_package(name: str, meant: str) -> str:
    """Return the error of a package that is not there."""
    return f"there is no package {name!r}; did you mean {meant!r}?"


def check_program(package: str, name: str, context: Context) -> None:
    """Raise EvaluationFails if a package certainly has no such program.

    Raises Undetermined if this is not known.
    """
    if not context.machine.has_package(package):
        raise Undetermined(f"whether the package {package!r} is installed is not evaluated")
    is_there = context.machine.has_program(package, name)
    if is_there is None:
        raise Undetermined(f"whether {package!r} has the program {name!r} is not evaluated")
    if not is_there:
        others = enumerated(find_programs(package)) or "none"
        manifest = context.machine.open_installed(f"share/{package}/package.xml")
        where = f" in lib/{package}"
        if manifest is not None and _OF_CMAKE in manifest[0]:
            where += ": see install(PROGRAMS ...) and install(TARGETS ...) in CMakeLists.txt"
        elif manifest is not None:
            where += ": see console_scripts of setup.py, and install_scripts of setup.cfg"
        known = f"; it has {others}" if package_row(package).is_installed else where
        raise EvaluationFails(f"the package {package!r} has no program {name!r}{known}")


# The conditions that are evaluated.
CONDITIONS = (
    "IfCondition",
    "UnlessCondition",
    "LaunchConfigurationEquals",
    "LaunchConfigurationNotEquals",
)
# The substitutions that are evaluated.
PERFORMS: Mapping[str, Callable[[_Substitution], Resolved]] = {
    "TextSubstitution": lambda substitution: substitution.argument("text"),
    "LaunchConfiguration": _Substitution.configuration,
    "PathJoinSubstitution": _Substitution.path,
    "PathSubstitution": _Substitution.path,
    "StringJoinSubstitution": _Substitution.joined_strings,
    "Command": _Substitution.command,
    "PythonExpression": _Substitution.expression,
    "FindPackageShare": _Substitution.package_folder,
    "FindPackagePrefix": _Substitution.package_prefix,
    "FindExecutable": _Substitution.program,
    "EnvironmentVariable": _Substitution.variable,
    "ThisLaunchFileDir": lambda substitution: posixpath.dirname(substitution.context.path),
    "ThisLaunchFile": lambda substitution: substitution.context.path,
    "AndSubstitution": _Substitution.both,
    "OrSubstitution": _Substitution.either,
    "NotSubstitution": lambda substitution: str(not substitution.is_true("value")).lower(),
    "IfElseSubstitution": _Substitution.choice,
    "EqualsSubstitution": _Substitution.equals,
    "FileContent": _Substitution.file_content,
    "NotEqualsSubstitution": lambda substitution: (
        "false" if substitution.equals() == "true" else "true"
    ),
    "ExecutableInPackage": _Substitution.executable,
}


def _expression_text(text: str, context: Context) -> str:
    """Return the value of a PythonExpression as a text. Raises EvaluationSignal."""
    budget = Budget(_WORK, whole=context.budget.whole)
    try:
        return charge_str(evaluate(text, _find_name, budget))
    except EvaluationFails as error:
        raise EvaluationFails(f"the expression {text[:60]!r} fails: {error}") from None
    except (Undetermined, OutOfBudget) as error:
        raise Undetermined(f"this expression is not evaluated: {error}") from None
    finally:
        context.budget.left -= budget.used


def _find_name(name: str) -> Value:
    if name in BUILTINS or name in MATH:
        return MATH.get(name, BUILTINS.get(name))
    if name == "math":
        return Namespace("math", MATH.__getitem__)
    if name in python_names("builtins", RELEASES) or name.startswith("__"):
        raise Undetermined(f"the name {name!r} is not evaluated")
    raise EvaluationFails(f"the name {name!r} is not defined")


def _command_output(texts: Sequence[Resolved], *, stops_at_stderr: bool) -> Contents:
    """Return the contents of the file that a command prints, whose parts have these texts.

    Raises EvaluationSignal.
    """
    command = "".join(text if isinstance(text, str) else PART_UNKNOWN for text in texts).strip()
    words = _split_command(command[:MAX_TEXT])
    if words[:3] == ["ros2", "run", "xacro"]:
        words = words[3:]
    if words == ["xacro"] and "" in texts:
        raise MissingValue("xacro is given no file: the text of a launch argument is empty")
    check_xacro_words(words)
    contents = printed_file(words)
    if not contents:
        unknown = next((text.reason for text in texts if isinstance(text, Unknown)), "")
        raise Undetermined(
            f"the output of this command is not evaluated{unknown and ': ' + unknown}"
        )
    if contents.by != "xacro" or not stops_at_stderr:
        return contents
    return replace(
        contents, stops_at_stderr=True, is_deprecated=not {"-i", "--inorder"}.isdisjoint(words)
    )


def _split_command(command: str) -> list[str]:
    """Return the words of a command line, of which there is one. Raises EvaluationFails."""
    if glued := re.match(r"(xacro|cat)(?=/)", command):
        raise EvaluationFails(
            f"a space is missing between {glued[1]} and the path: write '{glued[1]} '"
        )
    try:
        words = shlex.split(command)
    except ValueError:
        raise EvaluationFails("the quotes in this command are not closed") from None
    if not words:
        raise EvaluationFails("this command is empty")
    return words


def check_xacro_words(words: Sequence[str]) -> None:
    """Raise EvaluationFails for a wrong command of xacro.

    Such a command certainly has not one file, or an argument that is none.
    """
    program = posixpath.basename(words[0]).removesuffix(".py") if words else ""
    if program != "xacro" or any(word.startswith("-") for word in words):
        return
    _check_spaces(words[1:])
    if any(PART_UNKNOWN in word for word in words):
        return
    files = [word for word in words[1:] if ":=" not in word]
    if not files:
        raise EvaluationFails("xacro is given no file")
    if len(files) > 1:
        named = enumerated(map(posixpath.basename, files))
        raise EvaluationFails(f"xacro takes one file, and is given {named}")


def _check_spaces(words: Sequence[str]) -> None:
    """Raise EvaluationFails for a word that is several, because a space is missing."""
    for word in words:
        name, is_given, value = word.partition(":=")
        path = re.match(r"[^/\n]*+/.*\.(?:xacro|urdf)", name) if is_given else None
        if path:
            before = posixpath.basename(path[0])
            after = f"{name[path.end() :]}:="
            raise EvaluationFails(f"a space is missing between {before} and {after}")
        if ":=" in value:
            raise EvaluationFails(f"a space is missing between the arguments in {word[:60]!r}")


def printed_file(words: list[str]) -> Contents | None:
    """Return the contents of the one file that xacro or cat prints; None for any other command."""
    program = last_part(words[0]).removesuffix(".py") if words else ""
    file = _only_file(words[1:])
    if file is None or "-o" in words:
        return None
    if program == "cat" and words[1:] == [file]:
        return Contents(file, "cat")
    if program != "xacro":
        return None
    arguments = []
    for word in words[1:]:
        name, is_given, text = word.partition(":=")
        if is_given:
            arguments.append((name, None if PART_UNKNOWN in text else text))
    return Contents(file, "xacro", tuple(arguments))


def _only_file(words: list[str]) -> str | None:
    """Return the one file among words; None if there are others, or a part is unknown."""
    files = [word for word in words if not word.startswith("-") and ":=" not in word]
    if len(files) != 1 or not files[0] or PART_UNKNOWN in files[0]:
        return None
    return files[0]
