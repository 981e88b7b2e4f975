"""Read a launch file in any of its languages, and the launch files that it includes.

One in Python is evaluated without running it: `_PythonLaunchFile` gives what the functions that it
calls return.
"""

import posixpath
import re
import shlex
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import field
from pathlib import PurePosixPath
from typing import Any

from grader.base.grouping import StringsByName, distinct
from grader.base.merge_conflicts import resolve_conflicts
from grader.base.names import closest
from grader.base.records import Record
from grader.base.reuse import Answers, Memory
from grader.base.source import Location, Source
from grader.base.text import last_part
from grader.ros.config.yaml_nodes import yaml_value
from grader.ros.installation.places import HOME, PREFIX, SHARE, WORKING_FOLDER
from grader.ros.known.releases import Releases
from grader.ros.launch.actions import ActionVisitor, Include, NotIncluded
from grader.ros.launch.call_arguments import (
    PARTIAL,
    LaunchFunctions,
    describe_kind,
    join_path,
    texts_from_paths,
)
from grader.ros.launch.launch_classes import (
    DESCRIPTION,
    JOINED_PATH,
    PATH,
    SUBSTITUTION,
    class_named,
    exports,
    is_a,
)
from grader.ros.launch.launch_model import (
    MAX_STEPS,
    ORDER,
    Contents,
    Context,
    FileText,
    Findings,
    Launch,
    LaunchFault,
    LoadedComponent,
    Machine,
    NamedFile,
    StartedNode,
    StuckNode,
    UnknownText,
    texts_by_name,
)
from grader.ros.launch.lifecycle_events import find_stuck
from grader.ros.launch.machine_recorder import MachineRecorder
from grader.ros.launch.substitutions import (
    PART_UNKNOWN,
    check_xacro_words,
    no_package,
    printed_file,
    resolve,
)
from grader.ros.python.budget import Budget
from grader.ros.python.evaluation import Evaluation, record
from grader.ros.python.interpreter import MAX_FILE_STEPS, SEARCHED_VARIABLES, Interpreter
from grader.ros.python.library import standard_functions
from grader.ros.python.parse import START, Code, Position, SyntaxFault, location_in, parse
from grader.ros.python.values import (
    MAX_TEXT,
    Call,
    EvaluationFails,
    Function,
    FunctionTable,
    QualifiedName,
    Undetermined,
    Unknown,
    Value,
    known,
    path_text,
)

_MODULE_NAME = "python_launch_file"  # the __name__ of a launch file
_AMENT_INDEX = ("ament_index_python", "ament_index_python.packages")
_RECORDED = ("builtins.open.close", "builtins.open.__enter__", PARTIAL)
_TEXTS = [
    f"{name}.{method}"
    for name in ("xacro.process_file", "xacro.parse")
    for method in ("toxml", "toprettyxml")
]
_ELEMENT_TREE = "xml.etree.ElementTree"
_MINIDOM = "xml.dom.minidom"
_PARSERS = (f"{_ELEMENT_TREE}.parse", f"{_MINIDOM}.parse")
# A file that is opened to be written, and the modes of open for it.
_WRITTEN = "io.TextIOWrapper"
_WRITES = ("w", "wt", "a", "at", "x", "xt")
# What tells for which nodes an event is meant.
_MATCHERS = (
    "launch.events.matches_action",
    "launch.events.matchers.matches_action",
    "launch_ros.events.matches_node_name",
    "launch_ros.events.lifecycle.matches_node_name",
)
_ENTRY = "generate_launch_description"
_NODE = "launch_ros.actions.node.Node"
_MOVEIT = "moveit_configs_utils"
# Substitutions of Nav2: the files that they write, or whether a file has a node.
_NAVIGATION = "nav2_common.launch"
_OF_NAVIGATION = ("RewrittenYaml", "ReplaceString", "HasNodeParams")
_CONFIGURATION = "launch.substitutions.launch_configuration.LaunchConfiguration"
# The first release whose updates take a path as a substitution: launch 1.0.14.
_PATHS_SINCE = "humble"
_MAX_INCLUDES = 40
# What a launch file shares with those that it includes.
_JOINED = (
    *("nodes", "references", "faults", "unknown", "doubts", "declared", "values", "passed"),
    *("components", "containers", "later", "stuck"),
)


_NO_ARGUMENTS: StringsByName = {}


def read_launch(
    data: bytes,
    path: str,
    installed: str,
    machine: Machine,
    arguments: StringsByName = _NO_ARGUMENTS,
    memory: Memory | None = None,
    work: Budget | None = None,
    releases: Releases = (),
) -> Launch:
    """Read a launch file and evaluate it. It never raises.

    Args:
        data: The file's contents.
        path: Its path in the workspace.
        installed: Its path below the prefix after a build.
        machine: What is installed besides.
        arguments: The launch arguments that it is given.
        memory: The launch files that were read before.
        work: The budget of all files of the workspace.
        releases: The releases whose Python reads it; none: that of Jazzy.
    """
    work = work or Budget()

    def read(answers: Answers[Machine]) -> Launch:
        context = Context(
            f"{PREFIX}/{installed}",
            MachineRecorder(answers),
            dict(arguments),
            given=frozenset(arguments),
            budget=Budget(MAX_STEPS, whole=work),
            releases=releases,
        )
        return _LaunchReader().read(data, path, installed, context)

    key = (data, path, installed, tuple(arguments.items()), releases)
    return (memory or Memory()).recall(key, machine, work, read)


class _LaunchReader(Record, frozen=False):
    """A reader of a launch file and a limited number of included ones."""

    includes_left: int = _MAX_INCLUDES
    open: list[str] = field(
        default_factory=list
    )  # the files that are being read, each included by the one before

    def read(self, data: bytes, path: str, installed: str, context: Context) -> Launch:
        """Return a launch file together with those that it includes."""
        included: list[Launch] = []

        def include(target: str, arguments: Context) -> NotIncluded | None:
            return self.include(
                posixpath.normpath(target).removeprefix(PREFIX + "/"), arguments, included
            )

        self.open.append(installed)
        suffix = PurePosixPath(path).suffix.lower()
        is_xml = suffix == ".xml" or (suffix in (".launch", "") and data.lstrip().startswith(b"<"))
        if is_xml or suffix in (".yaml", ".yml"):
            launch_read = _read_entities(data, path, context, include, is_yaml=not is_xml)
        else:
            launch_read = _read_python(data, path, installed, context, include)
        self.open.pop()
        for launch in included:
            joined = {name: getattr(launch_read, name) + getattr(launch, name) for name in _JOINED}
            launch_read = launch_read._replace(**joined)
        return launch_read

    def include(self, target: str, context: Context, included: list[Launch]) -> NotIncluded | None:
        """Read an included file; return why it is not read."""
        if target in self.open:
            return NotIncluded("it includes itself", is_circular=True)
        opened = context.machine.open_installed(target)
        if opened is None:
            return NotIncluded(f"it includes {target}, which the submission does not install")
        if self.includes_left == 0:
            return NotIncluded(f"it includes more than {_MAX_INCLUDES} launch files")
        self.includes_left -= 1
        launch = self.read(*opened, target, context)
        faults = launch.faults if not launch.syntax else (*launch.faults, launch.syntax)
        if context.when is not True:  # an error in the file counts only if it is included
            launch = launch._replace(
                doubts=launch.doubts + faults, unknown=launch.unknown + faults, later=()
            )
            faults = ()
        included.append(launch._replace(faults=faults))
        return None


def _read_entities(
    data: bytes, path: str, context: Context, include: Include, *, is_yaml: bool
) -> Launch:
    from grader.ros.launch.frontend import find_later_words, read_actions, read_frontend

    source = Source.decoded(path, data)
    findings = Findings(lambda position: Location(path, position.line, position.column))
    resolved = resolve_conflicts(data)
    if resolved:
        findings.add_fault(resolved.message, Position(resolved.line, 1))
        data = resolved.data
        source = Source.decoded(path, data)
    root = read_frontend(data, source, is_yaml=is_yaml)
    if isinstance(root, LaunchFault):
        return Launch(source, root)
    if root.error:
        findings.add_fault(root.error, root.at)
    actions = read_actions(root, findings)
    find_later_words(root, findings)
    visitor = ActionVisitor(
        findings, include, lambda _, at, *__: Unknown("a function is not evaluated here", at)
    )
    visitor.launch(Call(DESCRIPTION, [], {"initial_entities": actions}, root.at), context, root.at)
    return _make_launch(source, findings, ())


def _read_python(
    data: bytes, path: str, installed: str, context: Context, include: Include
) -> Launch:
    code = parse(data, path, context.releases)
    if isinstance(code, SyntaxFault):
        if code.is_certain:
            syntax = LaunchFault(f"Python cannot read the file: {code.message}", code.location)
            return Launch(code.source, syntax)
        return Launch(code.source, unread=code.message)
    findings = Findings(lambda position: location_in(code.source, position))
    file = _PythonLaunchFile(context)
    entry = file.run(code, installed).get(_ENTRY)
    visitor = ActionVisitor(findings, include, file.call)
    if isinstance(entry, Function):
        _call_entry(file, entry, visitor, context)
    else:
        _add_missing_entry(file, findings, is_bound=entry is not None)
    _add_python(findings, file)
    if code.conflict is not None:
        findings.add_fault(*code.conflict)
    nodes = []
    for call in file.interpreter.calls:
        if call.name == _NODE and call not in visitor.visited:
            nodes.append(_forgotten_node(call, findings))
    return _make_launch(code.source, findings, tuple(nodes))


def _call_entry(
    file: "_PythonLaunchFile", entry: Function, visitor: ActionVisitor, context: Context
) -> None:
    """Execute the description that the function of a launch file returns."""
    description = file.call(entry, entry.at, (), context)
    error = _description_error(description)
    if error:
        visitor.findings.add_fault(error, entry.at)
    elif (
        not isinstance(description, Unknown) or description.candidates or not file.interpreter.doubt
    ):
        visitor.launch(description, context, entry.at)


def _add_missing_entry(file: "_PythonLaunchFile", findings: Findings, *, is_bound: bool) -> None:
    """Add that a file does not define the function that ros2 launch calls."""
    if file.interpreter.doubt or file.interpreter.errors:
        return
    if is_bound:
        message = f"{_ENTRY}, which the file does not define itself, is not evaluated"
        findings.add_undecided(message, START)
    else:
        message = f"the file does not define the function {_ENTRY}, which ros2 launch calls"
        functions = {
            name: value.at
            for name, value in file.interpreter.module.names.items()
            if isinstance(value, Function)
        }
        meant = closest(_ENTRY, functions)
        if meant is None:
            findings.add_fault(message, START)
        else:
            at = functions[meant]._replace(column=functions[meant].column + len("def "))
            findings.add_fault(message, at, hint=f"; did you mean it by {meant!r}?")


def _add_python(findings: Findings, file: "_PythonLaunchFile") -> None:
    """Add what Python raises, what is not evaluated, and what the file reads."""
    interpreter = file.interpreter
    if interpreter.doubt:
        doubt = interpreter.doubt
        findings.add_unknown(doubt.reason, doubt.at, follows_error=doubt.follows_error)
        findings.add_doubt(doubt.reason, doubt.at)
    for unread in interpreter.unread:
        findings.add_unknown(unread.reason, unread.at, follows_error=unread.follows_error)
    if (
        interpreter.errors
    ):  # the description is not loaded, so what is wrong with the rest of it does not count
        findings.faults = []
        findings.doubts = []
    for fault in interpreter.errors:
        findings.add_fault(fault.message, fault.at, fault.lacks, fault.argument)
    for contents, at in file.reads:
        findings.refer("read", contents, Call("", [], {}, at))
    for call in interpreter.calls:
        cls = class_named(call.name)
        if not cls:
            continue
        if cls.since:
            findings.add_later(f"there is no class {cls.short!r} of launch", cls.since, call.at)
        for name in texts_from_paths(cls, call):
            what = f"{name} of {cls.short} takes no path"
            at = call.places.get(name, call.at)
            findings.add_later(what, _PATHS_SINCE, at, ": write str(...) around it")


def _description_error(value: Value) -> str:
    """Return what is wrong with the value of generate_launch_description, or nothing."""
    match value:
        case None:
            return f"{_ENTRY} does not return its LaunchDescription"
        case Unknown():
            return ""
        case Call() if is_a(value.name, DESCRIPTION):
            return ""
        case _:
            return (
                f"{_ENTRY} does not return a LaunchDescription([...]), but {describe_kind(value)}"
            )


def _forgotten_node(node: Call, findings: Findings) -> StartedNode:
    given = (node.kwargs.get(name) for name in ("package", "executable"))
    package, executable = (value if isinstance(value, str) else "" for value in given)
    return StartedNode(package, executable, False, findings.locate(node.at))


def _distinct_components(findings: Findings) -> tuple[LoadedComponent, ...]:
    """Return the components, each once; the values of their parameters have no hash."""
    components: dict[tuple[LoadedComponent, str], LoadedComponent] = {}
    for component in findings.components:
        key = (component._replace(node=None), repr(component.node))
        components.setdefault(key, component)
    return tuple(components.values())


def _make_launch(source: Source, findings: Findings, forgotten: tuple[StartedNode, ...]) -> Launch:
    return Launch(
        source=source,
        nodes=tuple(findings.nodes),
        references=distinct(_list_references(findings)),
        faults=tuple(sorted(set(findings.faults), key=ORDER)),
        unknown=distinct(findings.unknown),
        doubts=distinct(findings.doubts),
        declared=distinct(findings.declared),
        values=tuple(findings.values),
        passed=distinct(findings.passed),
        commands=distinct(findings.commands),
        components=_distinct_components(findings),
        containers=distinct(findings.containers),
        forgotten=forgotten,
        later=distinct(findings.later),
        stuck=tuple(_list_stuck(findings)),
    )


def _list_stuck(findings: Findings) -> Iterator[StuckNode]:
    """Yield the nodes that the events of a launch file certainly do not activate."""
    for event, state in find_stuck(findings.state_events):
        waiting = event.handler or event.event
        yield StuckNode(findings.locate(event.node.at), state, findings.locate(waiting.at))


def _list_references(findings: Findings) -> list[NamedFile]:
    """Return the files that are named, each that is read and used only for its use."""
    named = set()
    for reference in findings.references:
        if reference.purpose not in ("read", "parameters"):
            named.add(reference.path)
    return [
        other for other in findings.references if other.purpose != "read" or other.path not in named
    ]


class _PythonLaunchFile(Record, frozen=False):
    """The evaluation of a launch file.

    `context` is that of the action which calls one of its functions.
    """

    context: Context
    reads: list[tuple[Contents, Position]] = field(
        default_factory=list
    )  # what it certainly reads while it is loaded
    interpreter: Interpreter = field(init=False)
    moveit: FunctionTable = field(
        default_factory=dict
    )  # the functions of MoveIt's package, if the file uses it

    def run(self, code: Code, installed: str) -> dict[str, Value]:
        """Evaluate the file, and return its names."""
        names = {"__file__": f"{PREFIX}/{installed}", "__name__": _MODULE_NAME}
        known: dict[str, Collection[str]] = {
            module: exported.keys() for module, exported in exports().items()
        }
        if _NAVIGATION in code.text:
            names_of_navigation = (*_OF_NAVIGATION, "LaunchConfigAsBool", "ParseMultiRobotPose")
            known = {"nav2_common": ("launch",), _NAVIGATION: names_of_navigation, **known}
        if _MOVEIT in code.text:
            from grader.ros.launch.moveit_configs import (  # late: few files use it
                MoveItConfigurations,
                moveit_exports,
            )

            known = {**moveit_exports(), **known}
            self.moveit = MoveItConfigurations(lambda: self.context, self.reads).functions()
        # Users import a name from a package, not from a module that happens to import it as well.
        packages = {module.rpartition(".")[0] for module in known}
        packages_last = sorted(
            known.items(), key=lambda export: (-export[0].count("."), export[0] in packages)
        )
        functions = self._functions()
        self.interpreter = Interpreter(
            functions,
            names,
            stand_ins=(PREFIX, HOME),
            exports=dict(packages_last),
            budget=Budget(MAX_FILE_STEPS, whole=self.context.budget.whole),
            goes_on=True,
        )
        return self.interpreter.run(code).names

    def call(
        self,
        function: Function | Call,
        at: Position,
        args: Sequence[Value] | None,
        context: Context,
        named: Mapping[str, Value] = _NO_ARGUMENTS,
    ) -> Value:
        """Return the value of a call of a function of the file, in an action's context."""
        before = self.context
        self.context = context
        try:
            return self.interpreter.call_from_outside(function, at, args, named)
        finally:
            self.context = before

    def _functions(self) -> FunctionTable:
        functions: dict[str, Any] = {
            **standard_functions(WORKING_FOLDER),
            **self.moveit,
            **dict.fromkeys(_RECORDED, record),
            f"{DESCRIPTION}.add_action": _add_action,
            f"{DESCRIPTION}.add_entity": _add_action,
            f"{JOINED_PATH}.__truediv__": join_path,
        }
        classes: set[str] = set()
        for names in exports().values():
            classes.update(names.values())
        for full in classes:
            if is_a(full, SUBSTITUTION):
                functions[f"{full}.perform"] = self._perform
            if is_a(full, PATH):
                functions[f"{full}.__truediv__"] = join_path
        for module in _AMENT_INDEX:
            functions[f"{module}.get_package_share_directory"] = self._share
            functions[f"{module}.get_package_share_path"] = self._share_path
            functions[f"{module}.get_package_prefix"] = self._prefix
        functions |= {
            "launch_ros.substitutions.find_package.FindPackageShare.find": self._share,
            "builtins.open": self._open,
            "builtins.open.read": self._text,
            "pathlib.Path.read_text": self._open_path,
            "pathlib.Path.open": self._open_path,
            "pathlib.Path.exists": self._exists,
            "pathlib.Path.home": lambda *_: PurePosixPath(HOME),
            "os.path.exists": self._exists,
            "os.path.isfile": self._exists,
            "os.path.join": _join_paths,
            "os.path.expanduser": _expand_user,
            "os.environ.__getitem__": _read_variable,
            "os.environ.get": _read_variable,
            "os.getenv": _read_variable,
            "os.environ.__setitem__": _set_variable,
            "os.environ.setdefault": _set_variable,
            f"{_NAVIGATION}.LaunchConfigAsBool": _configuration,
            **dict.fromkeys(
                (f"{_NAVIGATION}.{name}" for name in _OF_NAVIGATION), _text_of_navigation
            ),
            "xacro.process_file": self._xacro,
            "xacro.process": self._xacro,
            "xacro.parse": self._xacro,
            "xacro.process_doc": _process_doc,
            **dict.fromkeys(_TEXTS, self._text),
            **dict.fromkeys(_PARSERS, self._xml),
            f"{_ELEMENT_TREE}.parse.getroot": lambda _, call: call.owner,
            f"{_ELEMENT_TREE}.tostring": self._text_of_tree,
            f"{_ELEMENT_TREE}.tostring.decode": lambda _, call: _document_text(call.owner),
            **{
                f"{_MINIDOM}.parse.{method}": lambda _, call: _document_text(call.owner)
                for method in ("toxml", "toprettyxml")
            },
            **dict.fromkeys(("yaml.safe_load", "yaml.load"), self._load_yaml),
            "subprocess.check_output": self._check_output,
            "subprocess.check_output.decode": lambda _, call: _printed_text(call.owner),
            **dict.fromkeys(("sys.exit", "builtins.exit", "builtins.quit"), _leave),
            **dict.fromkeys(_MATCHERS, record),
            f"{_WRITTEN}.__enter__": record,
            f"{_WRITTEN}.read": _fail_to_read,
        }
        return LaunchFunctions(functions)

    def _perform(self, _: Evaluation, call: Call) -> Value:
        """Return the text of a substitution as Python gets it."""
        try:
            result = resolve(call.owner, self.context, call.at)
        except Undetermined as error:
            error.at = None  # at this call, not at the substitution
            raise
        reason = "the content of a file is not evaluated"
        if isinstance(result, Contents):
            return FileText(reason=reason, at=call.at, contents=result)
        return result

    def _text(self, evaluation: Evaluation, call: Call) -> Value:
        """Return the text of a file that is expanded, or read for the first time."""
        opened = call.owner
        if not opened or call.args:
            raise Undetermined("a part of the text of a file is not evaluated")
        if call.name.endswith(".read"):
            if any(not before.name.endswith("__enter__") for before in opened.method_calls):
                raise Undetermined("a file that is closed or read once more is not evaluated")
            record(evaluation, call)
        return FileText(
            reason="the content of a file is not evaluated",
            at=opened.at,
            contents=_contents_read(opened),
        )

    def _load_yaml(self, evaluation: Evaluation, call: Call) -> Value:
        """Return the value of a file or text in YAML."""
        given = call.argument(0, "stream")
        if isinstance(given, Call) and given.name == "builtins.open":
            given = self._text(evaluation, Call("builtins.open.read", [], {}, call.at, given))
        if isinstance(given, FileText) and given.contents.by == "open":
            given = self.context.find_text(given.contents.path)
        text = known(given)
        if not isinstance(text, str) or len(text) > MAX_TEXT or "<<" in text:
            raise Undetermined("what yaml reads is not evaluated")
        try:
            return evaluation.budget.checked(yaml_value(text))
        except ValueError:
            raise EvaluationFails("what yaml reads is not YAML") from None

    def _package(self, evaluation: Evaluation, call: Call) -> str:
        name = known(call.argument(0, "package_name", "package"))
        if not isinstance(name, str):
            raise EvaluationFails("the name of a package is a string")
        meant = self.context.machine.misspelt_package(name)
        if meant is not None:
            evaluation.error(no_package(name, meant), call.at)
            return meant
        if not self.context.machine.has_package(name):
            evaluation.doubted(
                Unknown(f"whether the package {name!r} is installed is not evaluated", call.at)
            )
        return name

    def _share(self, evaluation: Evaluation, call: Call) -> Value:
        return f"{SHARE}/{self._package(evaluation, call)}"

    def _prefix(self, evaluation: Evaluation, call: Call) -> Value:
        self._package(evaluation, call)
        return PREFIX

    def _share_path(self, evaluation: Evaluation, call: Call) -> Value:
        return PurePosixPath(self._share(evaluation, call))

    def _open(self, evaluation: Evaluation, call: Call) -> Value:
        file = call.argument(0, "file")
        mode = known(call.argument(1, "mode"))
        path = path_text(file if isinstance(file, Call) and class_named(file.name) else known(file))
        if path is None:
            raise EvaluationFails(
                "open takes a path, not a substitution: use Command(['cat ', ...])"
            )
        encoding = known(call.argument(3, "encoding"))
        others = call.kwargs.keys() - {"file", "mode", "encoding"}
        is_utf8 = encoding is None or str(encoding).lower().replace("_", "-") in ("utf-8", "utf8")
        if mode in _WRITES:
            call.name = _WRITTEN
            call.args = []
            call.kwargs = {}
            return record(evaluation, call)
        if mode not in (None, "r", "rt") or not is_utf8 or others or len(call.args) > 2:
            raise Undetermined("this use of open is not evaluated", call.at, is_final=True)
        if evaluation.attempts and self.context.find_text(path) is None:
            raise Undetermined(
                "whether the file of this try is there is not evaluated", call.at, is_final=True
            )
        self.reads.append((Contents(path, "open"), call.at))
        call.name = "builtins.open"
        call.args = [path]
        call.kwargs = {}
        return record(evaluation, call)

    def _open_path(self, evaluation: Evaluation, call: Call) -> Value:
        if not call.name.endswith("read_text"):
            return self._open(evaluation, call)
        opened = self._open(
            evaluation, Call("", [call.args[0], "r", *call.args[1:]], call.kwargs, call.at)
        )
        return self._text(evaluation, Call("builtins.open.read", [], {}, call.at, opened))

    def _check_output(self, evaluation: Evaluation, call: Call) -> Value:
        """Return what a command prints that prints a file: as bytes, or as a text."""
        given = known(call.argument(0, "args"))
        is_text = False
        for name in ("text", "universal_newlines", "encoding"):
            is_text |= bool(known(call.kwargs.get(name)))
        others = call.kwargs.keys() - {"args", "text", "universal_newlines", "encoding", "shell"}
        if isinstance(given, str) and known(call.kwargs.get("shell")) is True:
            with suppress(ValueError):
                given = shlex.split(given)
        items = given if isinstance(given, list | tuple) else []
        words = [path_text(known(item)) or PART_UNKNOWN for item in items]
        check_xacro_words(words)
        contents = printed_file(words)
        if not contents or others or len(call.args) > 1:
            raise Undetermined("this use of subprocess is not evaluated", call.at, is_final=True)
        self.reads.append((contents, call.at))
        call.args = [words]
        call.kwargs = {}
        return _printed_text(call) if is_text else record(evaluation, call)

    def _exists(self, _: Evaluation, call: Call) -> Value:
        path = path_text(known(call.args[0])) or ""
        is_there = self.context.find_text(path) is not None
        if is_there:
            return True
        return Unknown(f"whether {posixpath.basename(path)} exists is not evaluated", call.at)

    def _xml(self, evaluation: Evaluation, call: Call) -> Value:
        """Return a document that Python's library parses from a file."""
        path = path_text(known(call.argument(0, "source", "file")))
        if path is None:
            raise Undetermined("what this document is read from is not evaluated")
        self.reads.append((Contents(path, "open"), call.at))
        call.args = [path]
        return record(evaluation, call)

    def _text_of_tree(self, evaluation: Evaluation, call: Call) -> Value:
        """Return the text of a tree of elements: as bytes, or as a text."""
        tree = call.argument(0, "element")
        if not isinstance(tree, Call) or tree.name != f"{_ELEMENT_TREE}.parse":
            raise Undetermined("the text of these elements is not evaluated")
        call.args = list(tree.args)
        if call.kwargs.get("encoding") == "unicode":
            return _document_text(call)
        return record(evaluation, call)

    def _xacro(self, evaluation: Evaluation, call: Call) -> Value:
        given = call.argument(0, "input_file_name")
        if isinstance(given, Call) and not given.name.startswith("builtins.open"):
            raise EvaluationFails(
                f"{call.name} takes a path, not a substitution: use Command(['xacro ', ...])"
            )
        if isinstance(given, Call):
            given = given.args[0] if given.args else None
        path = path_text(known(given))
        if path is None:
            raise Undetermined("what xacro reads is not evaluated")
        call.args = [path, *call.args[1:]]
        self.reads.append((Contents(path, "xacro"), call.at))
        if call.name == "xacro.process":
            return FileText(
                reason="the output of xacro is not evaluated",
                at=call.at,
                contents=_contents_read(call),
            )
        return record(evaluation, call)


def _document_text(document: Call | None) -> FileText:
    """Return the text of a document that was parsed from a file."""
    assert document
    contents = Contents(document.args[0], "open")
    return FileText("the content of a file is not evaluated", document.at, contents)


def _printed_text(call: Call | None) -> FileText:
    """Return the text that a recorded command prints."""
    contents = printed_file(call.args[0]) if call else None
    assert call
    assert contents
    return FileText(
        reason="the output of a command is not evaluated", at=call.at, contents=contents
    )


def _fail_to_read(_: Evaluation, call: Call) -> Value:
    raise EvaluationFails(
        "a file that is opened to be written is emptied, and cannot be read: leave out the mode",
        call.at,
    )


def _leave(_: Evaluation, call: Call) -> Value:
    raise EvaluationFails(
        f"{call.name.removeprefix('builtins.')}() ends ros2 launch here", call.at, SystemExit
    )


def _contents_read(call: Call) -> Contents:
    """Return what a call of open or xacro reads, as far as this is known."""
    given = call.kwargs.get("mappings")
    arguments = texts_by_name(given) if isinstance(given, dict) else ()
    return Contents(call.args[0], "xacro" if call.name.startswith("xacro.") else "open", arguments)


def _add_action(evaluation: Evaluation, call: Call) -> Value:
    """Record an action that is added to a description."""
    if len(call.args) + len(call.kwargs) != 1:
        raise EvaluationFails(f"{call.short} takes one action")
    call.args = list(map(evaluation.perhaps, [*call.args, *call.kwargs.values()]))
    record(evaluation, call)


def _process_doc(evaluation: Evaluation, call: Call) -> Value:
    """Give the document that xacro.parse() returns the arguments with which it is expanded."""
    document = call.argument(0, "doc")
    mappings = call.argument(1, "mappings")
    if isinstance(document, Call) and mappings is not None:
        document.kwargs["mappings"] = mappings
    record(evaluation, call)


def _read_variable(evaluation: Evaluation, call: Call) -> Value:
    """Return a variable of the environment: whether it is set is not known."""
    name = known(call.argument(0, "key"))
    default = known(call.argument(1, "default"))
    if name == "HOME":
        return HOME
    unknown = UnknownText("the environment is not evaluated", call.at)
    if call.name.endswith("__getitem__"):  # a KeyError, if it is not set
        return unknown if evaluation.guarded else evaluation.doubted(unknown)
    return unknown if isinstance(default, str) else Unknown(unknown.reason, call.at)


def _set_variable(_: Evaluation, call: Call) -> Value:
    """Set a variable of the environment, which decides nothing that is evaluated."""
    name = known(call.args[0]) if call.args else None
    if not isinstance(name, str) or name in SEARCHED_VARIABLES:
        raise Undetermined(f"what is found with another {name} is not evaluated", is_final=True)
    return UnknownText("the environment is not evaluated", call.at)


def _text_of_navigation(_: Evaluation, call: Call) -> Value:
    """Return the text of a substitution of Nav2, which is not known."""
    name = last_part(call.name)
    return UnknownText(f"{name} of nav2_common is not evaluated", call.at)


def _configuration(evaluation: Evaluation, call: Call) -> Value:
    """Return the launch configuration that a substitution of Nav2 reads as a truth value."""
    call.args = [call.argument(0, "name")]
    call.kwargs = {}
    return evaluation.call_value(QualifiedName(_CONFIGURATION), call)


def _join_paths(evaluation: Evaluation, call: Call) -> Value:
    """Return what os.path.join returns; it fails for substitutions."""
    if any(isinstance(value, Call) and class_named(value.name) is not None for value in call.args):
        raise EvaluationFails(
            "os.path.join takes strings, not substitutions: use PathJoinSubstitution([...])"
        )
    return evaluation.call_value(standard_functions(WORKING_FOLDER)["os.path.join"], call)


def _expand_user(_: Evaluation, call: Call) -> Value:
    """Return a path with the home folder in place of ~."""
    text = path_text(known(call.args[0])) if call.args else None
    if text is not None:
        return re.sub("^~", HOME, text)
    return Unknown("a path is not evaluated", call.at)
