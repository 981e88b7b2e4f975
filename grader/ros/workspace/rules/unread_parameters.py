"""Parameters that a node in Python declares, and that no code of its package reads."""

import re
from collections import Counter
from collections.abc import Iterator, Mapping

from grader.base.source import Location
from grader.ros.nodes.node_facts import PackageNodes
from grader.ros.workspace.model.workspace import Workspace
from grader.ros.workspace.rules.names import Compared, Fact, warning
from grader.ros.workspace.rules.rule_table import PARAMETER_READ

_TEXT = re.compile(r"[\"']([\w./]++)[\"']")
_STATEMENT = "self.declare_parameter("  # begins a declaration whose value nothing uses
# With one of these, code may read parameters whose names are not written.
_READS_OTHERS = (
    *("get_parameters(", "get_parameters_by_prefix", "_parameters", "describe_parameters"),
    *("get_parameter(name", "get_parameter(param", "get_parameter(key", "get_parameter(f"),
)


def unread_parameter_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield the parameters whose names nothing but their declaration has.

    Nothing is said in a package whose code may read all parameters.
    """
    for package in workspace.packages:
        texts: dict[str, str] = {}
        for source in workspace.texts.sources_of(package, (".py",)):
            texts[source.path] = source.text
        declared = _declared_in(workspace.code.by_package[package.name], texts)
        if not declared or any(word in text for word in _READS_OTHERS for text in texts.values()):
            continue
        yield Compared("words")
        counts = Counter[str]()
        for text in texts.values():
            counts.update(_TEXT.findall(text))
        lines = {path: text.split("\n") for path, text in texts.items()}
        for at, name in declared.items():
            line = lines[at.path][at.line - 1].strip()
            is_used = line.endswith((".value", "_value")) or not line.startswith(_STATEMENT)
            if counts[name] == 1 and not is_used:
                message = f"nothing reads the parameter {name!r}, which is declared here"
                yield warning(PARAMETER_READ, message, at)


def _declared_in(code: PackageNodes, texts: Mapping[str, str]) -> dict[Location, str]:
    """Return the parameters that nodes in some texts declare."""
    declared = {}
    for node in code.nodes:
        for parameter in node.parameters:
            is_here = parameter.location.path in texts
            if parameter.is_declared and parameter.name is not None and is_here:
                declared[parameter.location] = parameter.name
    return declared
