"""Launch files in Python, evaluated without running them: what they create, and what the functions they call give."""

import posixpath
from collections.abc import Sequence
from dataclasses import dataclass, field
from io import StringIO
from pathlib import PurePosixPath

from grader.package.launch.api import CONDITION, DESCRIPTION, SUBSTITUTION, class_named, exports, is_a
from grader.package.launch.model import Contents, Context, LaunchFails, LaunchSignal
from grader.package.launch.places import HOME, PREFIX, SHARE, WORKING_FOLDER
from grader.package.launch.python_functions import (
    LaunchFunctions,
    add_action,
    expand_user,
    expand_variables,
    join_paths,
    known_call,
    safe_load,
    variable,
)
from grader.package.launch.substitutions import resolve
from grader.package.launch.truth import condition
from grader.static_python.evaluation import Evaluation, FunctionTable, record
from grader.static_python.interpreter import Interpreter
from grader.static_python.knowledge import known, path_text
from grader.static_python.library import standard_functions
from grader.static_python.parse import Code, Position
from grader.static_python.values import Call, ExpressionFails, Function, Undetermined, Unknown, Value

_MODULE = "python_launch_file"  # the __name__ of a launch file
_AMENT_INDEX = ("ament_index_python", "ament_index_python.packages")
_RECORDED = (
    "builtins.open.read", "builtins.open.close", "builtins.open.__enter__", "xacro.process_file.toxml",
    "xacro.process_file.toprettyxml", "xacro.process_doc", "xacro.parse.toxml", "xacro.parse.toprettyxml",
    "typing.List.__getitem__", "launch.logging.get_logger",
    *(f"launch.logging.get_logger.{name}" for name in ("debug", "info", "warning", "error")),
)  # fmt: skip


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
        find = [
            f"launch_ros.substitutions.find_package.{name}"
            for name in ("FindPackageShare.find", "FindPackagePrefix.find")
        ]
        adds = [f"{DESCRIPTION}.{name}" for name in ("add_action", "add_entity")]
        return LaunchFunctions(
            {
                **standard_functions(WORKING_FOLDER),
                **dict.fromkeys(_RECORDED, record),
                **dict.fromkeys(adds, add_action),
                **dict.fromkeys(_methods("perform", SUBSTITUTION), self._perform),
                **dict.fromkeys(_methods("evaluate", CONDITION), self._evaluate),
                "launch.launch_context.LaunchContext.perform_substitution": self._perform_argument,
                "launch.utilities.perform_substitutions": self._perform_argument,
                **dict.fromkeys([find[0], *(f"{it}.get_package_share_directory" for it in _AMENT_INDEX)], self._share),
                **dict.fromkeys((f"{it}.get_package_share_path" for it in _AMENT_INDEX), self._share_path),
                **dict.fromkeys([find[1], *(f"{it}.get_package_prefix" for it in _AMENT_INDEX)], self._prefix),
                **dict.fromkeys(("builtins.open", "io.open", "codecs.open"), self._open),
                **dict.fromkeys(("pathlib.Path.read_text", "pathlib.Path.open"), self._open_path),
                **dict.fromkeys(("os.path.exists", "os.path.isfile", "pathlib.Path.exists"), self._exists),
                **dict.fromkeys(("xacro.process_file", "xacro.process", "xacro.parse"), self._xacro),
                **dict.fromkeys(("yaml.safe_load", "yaml.load"), safe_load),
                **dict.fromkeys(("os.environ.__getitem__", "os.environ.get", "os.getenv"), variable),
                "os.path.join": join_paths,
                "os.path.expanduser": expand_user,
                "os.path.expandvars": expand_variables,
                "pathlib.Path.home": lambda *_: PurePosixPath(HOME),
            }
        )

    def _resolved(self, value: Value, evaluation: Evaluation, call: Call) -> Value:
        """Return the text of a substitution as Python gets it; of the contents of a file, the call itself."""
        try:
            found = resolve(value, self.context, call.at)
        except LaunchSignal as signal:
            kind = ExpressionFails if isinstance(signal, LaunchFails) else Undetermined
            raise kind(str(signal)) from None
        if isinstance(found, Contents):
            text = self.context.around.read(found.path) if found.by != "xacro" else None
            return text if text is not None else record(evaluation, call)
        return found

    def _perform(self, evaluation: Evaluation, call: Call) -> Value:
        return self._resolved(call.owner, evaluation, call)

    def _perform_argument(self, evaluation: Evaluation, call: Call) -> Value:
        return self._resolved(known_call(call.args[-1] if call.args else None), evaluation, call)

    def _evaluate(self, evaluation: Evaluation, call: Call) -> Value:
        if call.owner is None or "predicate_expression" not in call.owner.kwargs:
            raise Undetermined("this condition is not evaluated")
        text = self._resolved(call.owner.kwargs["predicate_expression"], evaluation, call)
        if not isinstance(text, str):
            return text
        try:
            return condition(text, call.at) == call.owner.name.endswith("IfCondition")
        except LaunchFails as error:
            raise ExpressionFails(str(error)) from None

    def _package(self, evaluation: Evaluation, call: Call) -> str:
        name = known(call.argument(0, "package_name", "package"))
        if not isinstance(name, str):
            raise ExpressionFails("the name of a package is a string")
        if not self.context.around.is_installed(name):
            evaluation.doubted(Unknown(f"whether the package {name!r} is installed is not evaluated", call.at))
        return name

    def _share(self, evaluation: Evaluation, call: Call) -> Value:
        return f"{SHARE}/{self._package(evaluation, call)}"

    def _share_path(self, evaluation: Evaluation, call: Call) -> Value:
        return PurePosixPath(self._share(evaluation, call))

    def _prefix(self, evaluation: Evaluation, call: Call) -> Value:
        self._package(evaluation, call)
        return PREFIX

    def _open(self, evaluation: Evaluation, call: Call) -> Value:
        file, position = call.argument(0, "file", "filename"), 2 if call.name.startswith("codecs") else 3
        path = path_text(file if isinstance(file, Call) and class_named(file.name) is not None else known(file))
        if path is None:
            raise ExpressionFails("open takes a path, not a substitution: use Command(['cat ', ...])")
        mode, encoding = known(call.argument(1, "mode")), known(call.argument(position, "encoding"))
        errors = known(call.argument(position + 1, "errors"))
        if not isinstance(mode, str | None) or set(mode or "r") & set("wax+"):
            raise Undetermined("a launch file that writes files is not evaluated")
        is_utf8 = encoding is None or str(encoding).lower().replace("_", "-") in ("utf-8", "utf8")
        by = "open" if is_utf8 and errors in (None, "strict") and "b" not in (mode or "") else "decode"
        self.reads.append((Contents(path, by), call.at))
        text = self.context.around.read(path) if by == "open" else None
        if text is None:
            call.name, call.args, call.kwargs = "builtins.open", [path], {"by": by}
            return record(evaluation, call)
        self.context.around.texts.setdefault(text, path)
        return StringIO(text)

    def _open_path(self, evaluation: Evaluation, call: Call) -> Value:
        is_read = call.name.endswith("read_text")
        inner = [call.args[0], *(["r"] if is_read else []), *call.args[1:]]
        found = self._open(evaluation, Call("builtins.open", inner, call.kwargs, call.at))
        if isinstance(found, StringIO):
            return found.read() if is_read else found
        return record(evaluation, Call("builtins.open.read", [], {}, call.at, found)) if is_read else found

    def _exists(self, _: Evaluation, call: Call) -> Value:
        path = path_text(known(call.args[0])) or ""
        is_there = self.context.around.read(path) is not None
        return True if is_there else Unknown(f"whether {posixpath.basename(path)} exists is not evaluated", call.at)

    def _xacro(self, evaluation: Evaluation, call: Call) -> Value:
        given = call.argument(0, "input_file_name")
        if isinstance(given, Call) and not given.name.startswith("builtins.open"):
            raise ExpressionFails(f"{call.name} takes a path, not a substitution: use Command(['xacro ', ...])")
        if isinstance(given, StringIO):
            given = self.context.around.texts.get(given.getvalue())
        elif isinstance(given, Call):
            given = given.args[0] if given.args else None
        path = path_text(known(given))
        if path is None:
            raise Undetermined("what xacro reads is not evaluated")
        call.args = [path, *call.args[1:]]
        self.reads.append((Contents(path, "xacro"), call.at))
        return record(evaluation, call)


def _methods(name: str, base: str) -> list[str]:
    """Return the full names of a method of each class with a base."""
    classes = {full for names in exports().values() for full in names.values() if full}
    return [f"{full}.{name}" for full in sorted(classes) if is_a(full, base)]
