"""Read a launch file in any of its languages, and the launch files that it includes."""

import posixpath
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from operator import attrgetter, methodcaller
from pathlib import PurePosixPath

from grader.package.launch.actions import CIRCULAR_INCLUDE, KINDS
from grader.package.launch.api import DESCRIPTION, is_a
from grader.package.launch.model import Context, Findings, Installation, Launch, LaunchFault, StartedNode
from grader.package.launch.places import PREFIX
from grader.package.launch.python_file import PythonLaunchFile
from grader.package.launch.value_types import kind_of
from grader.package.launch.visitor import ActionVisitor, Include
from grader.package.setup_py import location_in
from grader.python.parse import START, SyntaxFault, parse
from grader.python.values import Call, Function, Unknown, Value
from grader.source import Location, Source

_ENTRY = "generate_launch_description"
_NODE = "launch_ros.actions.node.Node"
_MAX_INCLUDES = 10
# What a launch file shares with those that it includes.
_JOINED = ("nodes", "references", "faults", "unknown", "doubts")
_MAX_KEPT = 4  # launch files


class _Recorder:
    """An installation that records what is asked of it. With the same answers, a launch file is evaluated alike."""

    def __init__(self, installation: Installation) -> None:
        self._installation = installation
        self._answers: list[tuple[Callable[[Installation], object], object]] = []

    def open_installed(self, path: str) -> tuple[bytes, str] | None:
        """Return an installed file."""
        found = self._installation.open_installed(path)
        self._answers.append((methodcaller("open_installed", path), found))
        return found

    def has_package(self, name: str) -> bool:
        """Return whether a package certainly is on the machine."""
        found = self._installation.has_package(name)
        self._answers.append((methodcaller("has_package", name), found))
        return found

    def has_program(self, package: str, name: str) -> bool | None:
        """Return whether a package has a program."""
        found = self._installation.has_program(package, name)
        self._answers.append((methodcaller("has_program", package, name), found))
        return found

    def is_equal(self, other: Installation) -> bool:
        """Return whether another installation answers alike."""
        return all(question(other) == answer for question, answer in self._answers)


# The results of the last launch files: those of a handout are read again, and all while hints are searched.
_KEPT: dict[tuple[bytes, str, str], tuple[_Recorder, Launch]] = {}


def read_launch(data: bytes, path: str, installed: str, installation: Installation) -> Launch:
    """Read a launch file and evaluate it. Never raises.

    Args:
        data: The file's contents.
        path: Its path in the submission.
        installed: Its path below the prefix after a build.
        installation: What is installed besides.
    """
    key = (data, path, installed)
    if key in _KEPT and _KEPT[key][0].is_equal(installation):
        return _KEPT[key][1]
    recorder = _Recorder(installation)
    launch = _LaunchReader().read(data, path, installed, Context(f"{PREFIX}/{installed}", recorder))
    _KEPT.pop(key, None)
    if len(_KEPT) >= _MAX_KEPT:
        del _KEPT[next(iter(_KEPT))]
    _KEPT[key] = (recorder, launch)
    return launch


@dataclass(slots=True)
class _LaunchReader:
    """A reader of a launch file and a limited number of included ones."""

    includes_left: int = _MAX_INCLUDES
    open: list[str] = field(default_factory=list)  # the files that are being read, each included by the one before

    def read(self, data: bytes, path: str, installed: str, context: Context) -> Launch:
        """Return a launch file together with those that it includes."""
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

    def include(self, target: str, context: Context, included: list[Launch]) -> str:
        """Read an included file; return why it is not read, or nothing."""
        if target in self.open:
            return CIRCULAR_INCLUDE
        found = context.installation.open_installed(target)
        if found is None:
            return f"it includes {target}, which the submission does not install"
        if self.includes_left == 0:
            return f"it includes more than {_MAX_INCLUDES} launch files"
        self.includes_left -= 1
        launch = self.read(*found, target, context)
        faults = (*launch.faults, *filter(None, [launch.syntax]))
        if context.when is not True:  # an error in the file counts only if it is included
            launch = replace(launch, doubts=(*launch.doubts, *faults), unknown=(*launch.unknown, *faults))
            faults = ()
        included.append(replace(launch, faults=faults))
        return ""


def _frontend(data: bytes, path: str, context: Context, include: Include, *, is_yaml: bool) -> Launch:
    from grader.package.launch.frontend import read_frontend  # late: most launch files are Python
    from grader.package.launch.frontend_actions import actions_of

    source = Source(path, data.decode("utf-8", "replace"))
    findings = Findings(lambda position: Location(path, position.line, position.column))
    root = read_frontend(data, source, is_yaml=is_yaml)
    if isinstance(root, LaunchFault):
        return Launch(source, root)
    if root.error:
        findings.add_fault(root.error, root.at)
    actions = actions_of(root, findings)
    visitor = ActionVisitor(
        findings, include, lambda _, at, *__: Unknown("a function is not evaluated here", at), KINDS
    )
    visitor.launch(Call(DESCRIPTION, [], {"initial_entities": actions}, root.at), context, root.at)
    return _launch(source, findings, ())


def _python(data: bytes, path: str, installed: str, context: Context, include: Include) -> Launch:
    code = parse(data, path)
    if isinstance(code, SyntaxFault):
        syntax = LaunchFault(f"Python cannot read the file: {code.message}", code.location)
        return Launch(code.source, syntax) if code.sure else Launch(code.source, unknown=(syntax,), doubts=(syntax,))
    findings = Findings(lambda position: location_in(code.source, position))
    file = PythonLaunchFile(context)
    entry = file.run(code, installed).get(_ENTRY)
    visitor = ActionVisitor(findings, include, file.call, KINDS)
    interpreter = file.interpreter
    if isinstance(entry, Function):
        description = file.call(entry, entry.at, (), context)
        error = _description_error(description)
        if error:
            findings.add_fault(error, entry.at)
        elif not isinstance(description, Unknown) or interpreter.doubt is None:
            visitor.launch(description, context, entry.at)
    elif interpreter.doubt is None and not interpreter.errors:
        message = f"the file does not define the function {_ENTRY}, which ros2 launch calls"
        if entry is None:
            findings.add_fault(message, START)
        else:
            findings.add_undecided(f"{_ENTRY}, which the file does not define itself, is not evaluated", START)
    _add_python(findings, file)
    nodes = [call for call in interpreter.calls if call.name == _NODE and id(call) not in visitor.visited]
    return _launch(code.source, findings, tuple(_forgotten(node, findings) for node in nodes))


def _add_python(findings: Findings, file: PythonLaunchFile) -> None:
    """Add what Python raises, what is not evaluated, and what the file reads."""
    interpreter = file.interpreter
    if interpreter.doubt is not None:
        findings.add_undecided(interpreter.doubt.reason, interpreter.doubt.at)
    if interpreter.errors:  # the description is not loaded, so what is wrong with the rest of it does not count
        findings.faults, findings.doubts = [], []
    for fault in interpreter.errors:
        findings.add_fault(fault.message, fault.at)
    for contents, at in file.reads:
        findings.refer("read", contents, Call("", [], {}, at))


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
            return f"{_ENTRY} does not return a LaunchDescription([...]), but {kind_of(value)}"


def _forgotten(node: Call, findings: Findings) -> StartedNode:
    given = (node.kwargs.get(name) for name in ("package", "executable"))
    package, executable = (value if isinstance(value, str) else "" for value in given)
    return StartedNode(package, executable, False, findings.locate(node.at))


def _launch(source: Source, findings: Findings, forgotten: tuple[StartedNode, ...]) -> Launch:
    named = {reference.path for reference in findings.references if reference.purpose != "read"}
    references = [it for it in findings.references if it.purpose != "read" or it.path not in named]
    order = attrgetter("location.line", "location.column", "message")
    return Launch(
        source=source,
        nodes=tuple(findings.nodes),
        references=tuple(dict.fromkeys(references)),
        faults=tuple(sorted(set(findings.faults), key=order)),
        unknown=tuple(dict.fromkeys(findings.unknown)),
        doubts=tuple(dict.fromkeys(findings.doubts)),
        forgotten=forgotten,
    )
