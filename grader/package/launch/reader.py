"""Read a launch file in any of its languages, and the launch files that it includes."""

import posixpath
from collections.abc import Callable
from dataclasses import replace
from pathlib import PurePosixPath

from grader.package.launch.actions import CIRCULAR_INCLUDE, ActionVisitor, Include
from grader.package.launch.context import Context
from grader.package.launch.findings import Findings
from grader.package.launch.frontend import read_frontend
from grader.package.launch.frontend_actions import actions_of
from grader.package.launch.functions import launch_functions
from grader.package.launch.model import Launch, LaunchFault, StartedNode
from grader.package.launch.places import PREFIX
from grader.package.setup_py import location_in
from grader.source import Location, Source
from grader.static_python.interpreter import Interpreter
from grader.static_python.parse import SyntaxFault, parse
from grader.static_python.positions import START
from grader.static_python.values import Call, Function, QualifiedName, Unknown, Value

_ENTRY = "generate_launch_description"
_MODULE = "python_launch_file"  # the __name__ of a launch file
_MAX_INCLUDES = 10

# Returns the bytes of an installed file and its path in the submission, by its path below the prefix; None for other files.
Opener = Callable[[str], "tuple[bytes, str] | None"]


def read_launch(data: bytes, path: str, installed: str, opener: Opener) -> Launch:
    """Read a launch file and evaluate it. `installed` is its path below the prefix after a build. Never raises."""
    context = Context(posixpath.dirname(f"{PREFIX}/{installed}"))
    return _LaunchReader(opener).read(data, path, installed, context)


class _LaunchReader:
    """A reader of a launch file and a limited number of included ones."""

    def __init__(self, opener: Opener) -> None:
        self.opener = opener
        self.includes_left = _MAX_INCLUDES
        self.open: list[str] = []  # the launch files that are being read, each included by the one before

    def read(self, data: bytes, path: str, installed: str, context: Context) -> Launch:
        """Return a launch file together with those that it includes."""
        included: list[Launch] = []

        def include(target: str, arguments: Context) -> str:
            return self.include(posixpath.normpath(target).removeprefix(PREFIX + "/"), arguments, included)

        self.open.append(installed)
        suffix = PurePosixPath(path).suffix.lower()
        if suffix in (".xml", ".yaml", ".yml"):
            own = _frontend(data, path, context, include, is_yaml=suffix != ".xml")
        else:
            own = _python(data, path, installed, context, include)
        self.open.pop()
        launches = (own, *included)
        return replace(
            own,
            nodes=tuple(node for launch in launches for node in launch.nodes),
            references=tuple(reference for launch in launches for reference in launch.references),
            faults=tuple(fault for launch in launches for fault in launch.faults),
            unknown=tuple(unknown for launch in launches for unknown in launch.unknown),
        )

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
    frontend = read_frontend(data, path, is_yaml=is_yaml)
    if frontend.root is None:
        return Launch(path, frontend.source, frontend.syntax)
    findings = Findings(lambda position: Location(path, position.line, position.column))
    visitor = ActionVisitor(findings, include, lambda _, at, __: Unknown("a function is not supported here", at))
    actions = actions_of(frontend.root, frontend)
    visitor.visit(Call("launch.LaunchDescription", [actions], {}, frontend.root.at), context, context.when)
    for message, at in frontend.errors:
        findings.add_fault(message, at)
    findings.unknown += [LaunchFault(reason, findings.locate(at)) for reason, at in frontend.unknown]
    return _launch(path, frontend.source, findings, ())


def _python(data: bytes, path: str, installed: str, context: Context, include: Include) -> Launch:
    code = parse(data, path)
    if isinstance(code, SyntaxFault):
        return Launch(path, code.source, LaunchFault(f"Python cannot read the file: {code.message}", code.location))
    interpreter = Interpreter(launch_functions(), {"__file__": f"{PREFIX}/{installed}", "__name__": _MODULE})
    names = interpreter.run(code).names
    findings = Findings(lambda position: location_in(code.source, position))
    visitor = ActionVisitor(findings, include, interpreter.call_from_outside)
    match names.get(_ENTRY):
        case Function() as entry:
            description = interpreter.call_from_outside(entry, entry.at)
            error = _description_error(description)
            if error:
                findings.add_fault(error, entry.at)
            visitor.visit(description, context, context.when)
        case Unknown() | QualifiedName() | Call() as description:
            visitor.visit(description, context, context.when)
        case _ if interpreter.stop_reason or "*" in names:
            findings.unknown.append(LaunchFault("what it launches is known only at run time", Location(path, 1, 1)))
        case _:
            findings.add_fault(f"the file does not define the function {_ENTRY}, which ros2 launch calls", START)
    if interpreter.stop_reason:
        findings.unknown.append(LaunchFault(interpreter.stop_reason, Location(path, 1, 1)))
    for fault in interpreter.errors:
        findings.add_fault(fault.message, fault.at)
    nodes = [call for call in interpreter.calls if call.name.endswith(".Node") and id(call) not in visitor.visited]
    return _launch(path, code.source, findings, tuple(_forgotten(node, findings) for node in nodes))


def _description_error(value: Value) -> str:
    """Return what is wrong with the value of generate_launch_description, or nothing."""
    match value:
        case None:
            return f"{_ENTRY} does not return its LaunchDescription"
        case str() | int() | float() | list() | tuple() | dict():
            return f"{_ENTRY} does not return a LaunchDescription([...])"
        case Call() if value.name.startswith(("launch.actions.", "launch_ros.actions.")):
            return f"{_ENTRY} does not return a LaunchDescription([...])"
        case _:
            return ""


def _forgotten(node: Call, findings: Findings) -> StartedNode:
    given = (node.kwargs.get(name) for name in ("package", "executable"))
    package, executable = (value if isinstance(value, str) else "" for value in given)
    return StartedNode(package, executable, False, findings.locate(node.at))


def _launch(path: str, source: Source, findings: Findings, forgotten: tuple[StartedNode, ...]) -> Launch:
    def order(fault: LaunchFault) -> tuple[int, int, str]:
        return fault.location.line, fault.location.column, fault.message

    return Launch(
        path=path,
        source=source,
        nodes=tuple(findings.nodes),
        references=tuple(findings.references),
        faults=tuple(sorted(set(findings.faults), key=order)),
        unknown=tuple(dict.fromkeys(findings.unknown)),
        forgotten=forgotten,
    )
