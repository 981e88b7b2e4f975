"""Launch files in Python, evaluated without running them: what they create, and what the functions they call give."""

import posixpath
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import PurePosixPath

from grader.package.launch.api import DESCRIPTION, SUBSTITUTION, class_named, exports, is_a
from grader.package.launch.arguments import LaunchFunctions
from grader.package.launch.model import Contents, Context, FileText, UnknownText
from grader.package.launch.places import HOME, PREFIX, SHARE, WORKING_FOLDER
from grader.package.launch.substitutions import resolve
from grader.python.evaluation import Evaluation, record
from grader.python.interpreter import Interpreter
from grader.python.library import standard_functions
from grader.python.parse import Code, Position
from grader.python.values import (
    Call,
    EvaluationFails,
    Function,
    FunctionTable,
    Undetermined,
    Unknown,
    Value,
    known,
    path_text,
)

_MODULE = "python_launch_file"  # the __name__ of a launch file
_AMENT_INDEX = ("ament_index_python", "ament_index_python.packages")
_RECORDED = ("builtins.open.close", "builtins.open.__enter__", "xacro.process_doc")
_TEXTS = [f"{name}.{method}" for name in ("xacro.process_file", "xacro.parse") for method in ("toxml", "toprettyxml")]


@dataclass(slots=True)
class PythonLaunchFile:
    """The evaluation of a launch file; `context` is that of the action which calls one of its functions."""

    context: Context
    reads: list[tuple[Contents, Position]] = field(default_factory=list)  # what it certainly reads while it is loaded
    interpreter: Interpreter = field(init=False)

    def run(self, code: Code, installed: str) -> dict[str, Value]:
        """Evaluate the file, and return its names."""
        names = {"__file__": f"{PREFIX}/{installed}", "__name__": _MODULE}
        packages_last = sorted(exports().items(), key=lambda it: -it[0].count("."))
        known_names = {module: own.keys() for module, own in packages_last}
        self.interpreter = Interpreter(self._functions(), names, stand_ins=(PREFIX, HOME), exports=known_names)
        return self.interpreter.run(code).names

    def call(self, function: Function, at: Position, args: Sequence[Value] | None, context: Context) -> Value:
        """Return the value of a call of one of the file's functions, in the context of an action."""
        before, self.context = self.context, context
        try:
            return self.interpreter.call_from_outside(function, at, args)
        finally:
            self.context = before

    def _functions(self) -> FunctionTable:
        adds = [f"{DESCRIPTION}.{name}" for name in ("add_action", "add_entity")]
        classes = {full for names in exports().values() for full in names.values() if full}
        performs = [f"{full}.perform" for full in sorted(classes) if is_a(full, SUBSTITUTION)]
        return LaunchFunctions(
            {
                **standard_functions(WORKING_FOLDER),
                **dict.fromkeys(_RECORDED, record),
                **dict.fromkeys(adds, _add_action),
                **dict.fromkeys(performs, self._perform),
                **dict.fromkeys((f"{it}.get_package_share_directory" for it in _AMENT_INDEX), self._share),
                **dict.fromkeys((f"{it}.get_package_share_path" for it in _AMENT_INDEX), self._share_path),
                "launch_ros.substitutions.find_package.FindPackageShare.find": self._share,
                "builtins.open": self._open,
                **dict.fromkeys(("pathlib.Path.read_text", "pathlib.Path.open"), self._open_path),
                **dict.fromkeys(("os.path.exists", "os.path.isfile", "pathlib.Path.exists"), self._exists),
                **dict.fromkeys(("xacro.process_file", "xacro.process", "xacro.parse"), self._xacro),
                **dict.fromkeys(("builtins.open.read", *_TEXTS), self._text),
                **dict.fromkeys(("os.environ.__getitem__", "os.environ.get", "os.getenv"), _variable),
                "os.path.join": _join_paths,
                "os.path.expanduser": _expand_user,
                "pathlib.Path.home": lambda *_: PurePosixPath(HOME),
            }
        )

    def _perform(self, _: Evaluation, call: Call) -> Value:
        """Return the text of a substitution as Python gets it."""
        try:
            found = resolve(call.owner, self.context, call.at)
        except Undetermined as error:  # at this call, not at the substitution
            raise Undetermined(str(error)) from None
        reason = "the content of a file is not evaluated"
        return FileText(reason=reason, at=call.at, contents=found) if isinstance(found, Contents) else found

    def _text(self, evaluation: Evaluation, call: Call) -> Value:
        """Return the text of a file that is expanded, or read for the first time."""
        opened = call.owner
        if opened is None or call.args:
            raise Undetermined("a part of the text of a file is not evaluated")
        if call.name.endswith(".read"):
            if any(not before.name.endswith("__enter__") for before in opened.method_calls):
                raise Undetermined("a file that is closed or read once more is not evaluated")
            record(evaluation, call)
        return FileText(reason="the content of a file is not evaluated", at=opened.at, contents=_contents(opened))

    def _package(self, evaluation: Evaluation, call: Call) -> str:
        name = known(call.argument(0, "package_name", "package"))
        if not isinstance(name, str):
            raise EvaluationFails("the name of a package is a string")
        if not self.context.installation.has_package(name):
            evaluation.doubted(Unknown(f"whether the package {name!r} is installed is not evaluated", call.at))
        return name

    def _share(self, evaluation: Evaluation, call: Call) -> Value:
        return f"{SHARE}/{self._package(evaluation, call)}"

    def _share_path(self, evaluation: Evaluation, call: Call) -> Value:
        return PurePosixPath(self._share(evaluation, call))

    def _open(self, evaluation: Evaluation, call: Call) -> Value:
        file, mode = call.argument(0, "file"), known(call.argument(1, "mode"))
        path = path_text(file if isinstance(file, Call) and class_named(file.name) is not None else known(file))
        if path is None:
            raise EvaluationFails("open takes a path, not a substitution: use Command(['cat ', ...])")
        encoding = known(call.argument(3, "encoding"))
        others = call.kwargs.keys() - {"file", "mode", "encoding"}
        is_utf8 = encoding is None or str(encoding).lower().replace("_", "-") in ("utf-8", "utf8")
        if mode not in (None, "r", "rt") or not is_utf8 or others or len(call.args) > 2:
            raise Undetermined("this use of open is not evaluated", call.at, is_final=True)
        self.reads.append((Contents(path, "open"), call.at))
        call.name, call.args, call.kwargs = "builtins.open", [path], {}
        return record(evaluation, call)

    def _open_path(self, evaluation: Evaluation, call: Call) -> Value:
        if not call.name.endswith("read_text"):
            return self._open(evaluation, call)
        opened = self._open(evaluation, Call("", [call.args[0], "r", *call.args[1:]], call.kwargs, call.at))
        return self._text(evaluation, Call("builtins.open.read", [], {}, call.at, opened))

    def _exists(self, _: Evaluation, call: Call) -> Value:
        path = path_text(known(call.args[0])) or ""
        is_there = self.context.text_of(path) is not None
        return True if is_there else Unknown(f"whether {posixpath.basename(path)} exists is not evaluated", call.at)

    def _xacro(self, evaluation: Evaluation, call: Call) -> Value:
        given = call.argument(0, "input_file_name")
        if isinstance(given, Call) and not given.name.startswith("builtins.open"):
            raise EvaluationFails(f"{call.name} takes a path, not a substitution: use Command(['xacro ', ...])")
        if isinstance(given, Call):
            given = given.args[0] if given.args else None
        path = path_text(known(given))
        if path is None:
            raise Undetermined("what xacro reads is not evaluated")
        call.args = [path, *call.args[1:]]
        self.reads.append((Contents(path, "xacro"), call.at))
        if call.name == "xacro.process":
            return FileText(reason="the output of xacro is not evaluated", at=call.at, contents=_contents(call))
        return record(evaluation, call)


def _contents(call: Call) -> Contents:
    """Return what a call of open or xacro reads, as far as this is known."""
    given = call.kwargs.get("mappings")
    pairs = given.items() if isinstance(given, dict) else ()
    arguments = tuple((str(name), value if isinstance(value, str) else None) for name, value in pairs)
    return Contents(call.args[0], "xacro" if call.name.startswith("xacro.") else "open", arguments)


def _add_action(evaluation: Evaluation, call: Call) -> Value:
    """Record an action that is added to a description."""
    if len(call.args) + len(call.kwargs) != 1:
        raise EvaluationFails(f"{call.name.rpartition('.')[2]} takes one action")
    record(evaluation, call)


def _variable(_: Evaluation, call: Call) -> Value:
    """Return a variable of the environment: whether it is set is not known."""
    name, default = known(call.argument(0, "key")), known(call.argument(1, "default"))
    if name == "HOME":
        return HOME
    reason = "the environment is not evaluated"
    if call.name.endswith("__getitem__"):
        raise Undetermined(reason)
    return (UnknownText if isinstance(default, str) else Unknown)(reason, call.at)


def _join_paths(evaluation: Evaluation, call: Call) -> Value:
    """Return what os.path.join returns; it fails for substitutions."""
    if any(isinstance(value, Call) and class_named(value.name) is not None for value in call.args):
        raise EvaluationFails("os.path.join takes strings, not substitutions: use PathJoinSubstitution([...])")
    return evaluation.call_value(standard_functions(WORKING_FOLDER)["os.path.join"], call)


def _expand_user(_: Evaluation, call: Call) -> Value:
    """Return a path with the home folder in place of ~."""
    text = path_text(known(call.args[0])) if call.args else None
    return re.sub("^~", HOME, text) if text is not None else Unknown("a path is not evaluated", call.at)
