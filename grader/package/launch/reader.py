"""Read a launch file in any of its languages, and the launch files that it includes."""

import posixpath
import re
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cache
from operator import attrgetter
from pathlib import PurePosixPath

from grader.package.launch.actions import CIRCULAR_INCLUDE, ActionVisitor, Include
from grader.package.launch.frontend import read_frontend
from grader.package.launch.frontend_actions import actions_of
from grader.package.launch.model import Context, Findings, Launch, LaunchFault, StartedNode
from grader.package.launch.places import HOME, PREFIX, SHARE, WORKING_FOLDER
from grader.package.setup_py import location_in
from grader.reuse import reuse
from grader.source import Location, Source
from grader.static_python.evaluation import Evaluation, FunctionTable, record
from grader.static_python.imports import USUAL_NAMES
from grader.static_python.interpreter import Interpreter
from grader.static_python.library import standard_functions
from grader.static_python.parse import START, SyntaxFault, parse
from grader.static_python.values import Call, Function, QualifiedName, Unknown, Value, path_text

_ENTRY = "generate_launch_description"
_MODULE = "python_launch_file"  # the __name__ of a launch file
_MAX_INCLUDES = 10
_JOINED = ("nodes", "references", "faults", "unknown")  # what a launch file shares with those that it includes
_AMENT_INDEX = ("ament_index_python", "ament_index_python.packages")
_RECORDED = (
    "launch.LaunchDescription.add_action", "launch.LaunchDescription.add_entity", "builtins.open", "builtins.open.read",
    "builtins.open.__enter__", "xacro.process_file", "xacro.process_file.toxml", "xacro.process_file.toprettyxml",
    "launch.substitutions.LaunchConfiguration.perform", "xacro.parse", "xacro.process_doc", "xacro.parse.toxml",
)  # fmt: skip
_FIND = [f"launch_ros.substitutions.{module}FindPackageShare.find" for module in ("", "find_package.")]

# Returns the bytes of an installed file and its path in the submission, by its path below the prefix; None for other
# files.
Opener = Callable[[str], "tuple[bytes, str] | None"]


def read_launch(data: bytes, path: str, installed: str, opener: Opener) -> Launch:
    """Read a launch file and evaluate it. `installed` is its path below the prefix after a build. Never raises."""
    return _read_alone(data, path, installed) or _LaunchReader(opener).read(data, path, installed)


@reuse
def _read_alone(data: bytes, path: str, installed: str) -> Launch | None:
    """Return a launch file; None for one that includes others."""
    included: list[str] = []
    launch = _LaunchReader(included.append).read(data, path, installed)
    return launch if not included else None


@dataclass(slots=True)
class _LaunchReader:
    """A reader of a launch file and a limited number of included ones."""

    opener: Opener
    includes_left: int = _MAX_INCLUDES
    open: list[str] = field(default_factory=list)  # the files that are being read, each included by the one before

    def read(self, data: bytes, path: str, installed: str, arguments: Context | None = None) -> Launch:
        """Return a launch file together with those that it includes."""
        context = arguments or Context(posixpath.dirname(f"{PREFIX}/{installed}"))
        included: list[Launch] = []

        def include(target: str, arguments: Context) -> str:
            return self.include(posixpath.normpath(target).removeprefix(PREFIX + "/"), arguments, included)

        self.open.append(installed)
        suffix = PurePosixPath(path).suffix.lower()
        is_xml = suffix == ".xml" or (suffix in (".launch", "") and data.lstrip().startswith(b"<"))
        if is_xml or suffix in (".yaml", ".yml"):
            own = _frontend(data, path, context, include, is_yaml=not is_xml)
        else:
            own = _python(data, path, installed, context, include)
        self.open.pop()
        for launch in included:
            joined = {name: getattr(own, name) + getattr(launch, name) for name in _JOINED}
            own = replace(own, **joined)
        return own

    def include(self, target: str, arguments: Context, included: list[Launch]) -> str:
        """Read an included file; return why it is not read, or nothing."""
        if target in self.open:
            return CIRCULAR_INCLUDE
        found = self.opener(target)
        if found is None:
            return f"it includes {target}, which the submission does not install"
        if self.includes_left == 0:
            return f"it includes more than {_MAX_INCLUDES} launch files"
        self.includes_left -= 1
        launch = self.read(*found, target, arguments)
        faults = (*launch.faults, *filter(None, [launch.syntax]))
        if arguments.when is not True:  # an error in the file counts only if it is included
            launch, faults = replace(launch, unknown=(*launch.unknown, *faults)), ()
        included.append(replace(launch, faults=faults))
        return ""


def _frontend(data: bytes, path: str, context: Context, include: Include, *, is_yaml: bool) -> Launch:
    source = Source(path, data.decode("utf-8", "replace"))
    findings = Findings(lambda position: Location(path, position.line, position.column))
    root = read_frontend(data, source, findings, is_yaml=is_yaml)
    if isinstance(root, LaunchFault):
        return Launch(source, root)
    actions = actions_of(root, findings)
    unsupported, findings.unknown = findings.unknown, []
    visitor = ActionVisitor(findings, include, lambda _, at, __: Unknown("a function is not supported here", at))
    visitor.visit(Call("launch.LaunchDescription", [actions], {}, root.at), context, context.when)
    findings.unknown += unsupported
    return _launch(source, findings, ())


def _python(data: bytes, path: str, installed: str, context: Context, include: Include) -> Launch:
    code = parse(data, path)
    if isinstance(code, SyntaxFault):
        syntax = LaunchFault(f"Python cannot read the file: {code.message}", code.location)
        return Launch(code.source, syntax) if code.sure else Launch(code.source, unknown=(syntax,))
    interpreter = Interpreter(
        launch_functions(), {"__file__": f"{PREFIX}/{installed}", "__name__": _MODULE}, stand_ins=(PREFIX, HOME)
    )
    names = interpreter.run(code).names
    findings = Findings(lambda position: location_in(code.source, position))
    visitor = ActionVisitor(findings, include, interpreter.call_from_outside)
    match names.get(_ENTRY):
        case Function() as entry:
            description = interpreter.call_from_outside(entry, entry.at)
            if error := _description_error(description):
                findings.add_fault(error, entry.at)
            visitor.visit(description, context, context.when)
        case Unknown() | QualifiedName() | Call() as description:
            visitor.visit(description, context, context.when)
        case _ if interpreter.doubt is not None:
            findings.add_unknown("what it launches is known only at run time", START)
        case _:
            findings.add_fault(f"the file does not define the function {_ENTRY}, which ros2 launch calls", START)
    if interpreter.doubt is not None:
        findings.add_unknown(interpreter.doubt.reason, interpreter.doubt.at)
    for fault in interpreter.errors:
        findings.add_fault(fault.message, fault.at)
    nodes = [call for call in interpreter.calls if call.name.endswith(".Node") and id(call) not in visitor.visited]
    return _launch(code.source, findings, tuple(_forgotten(node, findings) for node in nodes))


def _description_error(value: Value) -> str:
    """Return what is wrong with the value of generate_launch_description, or nothing."""
    match value:
        case None:
            return f"{_ENTRY} does not return its LaunchDescription"
        case Call() if not value.name.startswith(("launch.actions.", "launch_ros.actions.")):
            return ""
        case str() | int() | float() | list() | tuple() | dict() | Call():
            return f"{_ENTRY} does not return a LaunchDescription([...])"
        case _:
            return ""


def _forgotten(node: Call, findings: Findings) -> StartedNode:
    given = (node.kwargs.get(name) for name in ("package", "executable"))
    package, executable = (value if isinstance(value, str) else "" for value in given)
    return StartedNode(package, executable, False, findings.locate(node.at))


def _launch(source: Source, findings: Findings, forgotten: tuple[StartedNode, ...]) -> Launch:
    order = attrgetter("location.line", "location.column", "message")
    return Launch(
        source=source,
        nodes=tuple(findings.nodes),
        references=tuple(findings.references),
        faults=tuple(sorted(set(findings.faults), key=order)),
        unknown=tuple(dict.fromkeys(findings.unknown)),
        forgotten=forgotten,
    )


@cache
def launch_functions() -> FunctionTable:
    """Return the functions by full name; the folders that they return are stand-ins."""
    return {
        **standard_functions(WORKING_FOLDER),
        **dict.fromkeys((name for name in USUAL_NAMES.values() if name.startswith("launch")), record),
        **dict.fromkeys(_RECORDED, record),
        **dict.fromkeys([*_FIND, *(f"{module}.get_package_share_directory" for module in _AMENT_INDEX)], _share),
        **dict.fromkeys((f"{module}.get_package_share_path" for module in _AMENT_INDEX), _share_path),
        **dict.fromkeys((f"{module}.get_package_prefix" for module in _AMENT_INDEX), lambda *_: PREFIX),
        "os.path.expanduser": _expanduser,
        "os.path.expandvars": lambda _, call: Unknown("the environment is known only at run time", call.at),
        "pathlib.Path.home": lambda *_: PurePosixPath(HOME),
    }


def _share(_: Evaluation, call: Call) -> Value:
    name = call.argument(0, "package_name", "package")
    if isinstance(name, str):
        return f"{SHARE}/{name}"
    return name if isinstance(name, Unknown) else Unknown("the package is known only at run time", call.at)


def _share_path(evaluation: Evaluation, call: Call) -> Value:
    found = _share(evaluation, call)
    return PurePosixPath(found) if isinstance(found, str) else found


def _expanduser(_: Evaluation, call: Call) -> Value:
    text = path_text(call.args[0]) if call.args else None
    return re.sub("^~", HOME, text) if text is not None else Unknown("a path is known only at run time", call.at)
