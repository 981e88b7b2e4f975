"""Parameters that a node in Python declares, and that no code of its package reads."""

from collections import Counter
from collections.abc import Mapping, Sequence

from grader.base.patterns import on_use
from grader.base.source import Location
from grader.ros.nodes.node_facts import PackageNodes
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    warning,
)
from grader.workspace.rules.rule_table import (
    UNREAD,
    Rule,
)

_TEXT = on_use(r"[\"']([\w./]++)[\"']")
_STATEMENT = "self.declare_parameter("  # begins a declaration whose value nothing uses
# With one of these, code may read parameters whose names are not written.
_READS_OTHERS = on_use(
    r"get_parameters\(|get_parameters_by_prefix|_parameters|describe_parameters"
    r"|get_parameter\((?!\s*+[\"'][\w./]++[\"']\s*+\))"
)


_PARAMETER_READ = Rule(
    "parameter-read",
    "words",
    UNREAD,
    "Code reads the parameters that it declares.",
    why=(
        "ros2 param set succeeds, and the behaviour of the node stays the same. A value in a "
        "launch file has no effect either."
    ),
    wrong="""
def __init__(self):
    super().__init__('pilot')
    self.declare_parameter('speed', 1.0)
""",
    right="""
def __init__(self):
    super().__init__('pilot')
    self.declare_parameter('speed', 1.0)
    self.speed = self.get_parameter('speed').value
""",
    frame="pilot.py",
)


def unread_parameter_facts(workspace: Workspace) -> Facts:
    """Yield the parameters whose names nothing but their declaration has.

    Nothing is said in a package whose code may read all parameters.
    """
    for package in workspace.packages:
        texts = {}
        for source in workspace.texts.read_sources(package, (".py",)):
            texts[source.path] = source.text
        declared = _declared_in(workspace.code.by_package[package.name], texts)
        if not declared or any(map(_READS_OTHERS.search, texts.values())):
            continue
        yield Compared("words")
        counts = Counter[str]()
        for text in texts.values():
            counts.update(_TEXT.findall(text))
        lines = {path: text.split("\n") for path, text in texts.items()}
        for at, name in declared.items():
            if counts[name] == 1 and _is_statement(lines[at.path][at.line - 1 :], name):
                message = f"nothing reads the parameter {name!r}, which is declared here"
                yield warning(_PARAMETER_READ, message, at)


def _is_statement(lines: Sequence[str], name: str) -> bool:
    """Return whether a line is nothing but the declaration of a parameter by its name."""
    line = lines[0].strip()
    is_whole = line.startswith(_STATEMENT) and line.endswith(")")
    is_named = f"{name!r}" in line or f'"{name}"' in line
    is_continued = lines[1:] and lines[1].lstrip().startswith(".")
    return is_whole and is_named and line.count("(") == line.count(")") and not is_continued


def _declared_in(code: PackageNodes, texts: Mapping[str, str]) -> dict[Location, str]:
    """Return the parameters that nodes in some texts declare."""
    declared = {}
    for node in code.nodes:
        for parameter in node.parameters:
            is_here = parameter.location.path in texts
            if parameter.is_declared and parameter.name is not None and is_here:
                declared[parameter.location] = parameter.name
    return declared
