"""Parameters that a node in Python declares, and that no code of its package reads."""

import re
from collections import Counter
from collections.abc import Iterator

from grader.ros.workspace.model.workspace import Workspace
from grader.ros.workspace.rules.names import Compared, Fact, warning
from grader.ros.workspace.rules.rule_table import PARAMETER_READ

_TEXT = re.compile(r"[\"']([\w./]++)[\"']")
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
        sources = [*workspace.texts.sources_of(package, (".py",))]
        texts = {source.path: source.text for source in sources}
        code = workspace.code.by_package[package.name]
        declared = [
            parameter
            for node in code.nodes
            for parameter in node.parameters
            if parameter.is_declared and parameter.location.path in texts
        ]
        if not declared or any(word in text for word in _READS_OTHERS for text in texts.values()):
            continue
        yield Compared("words")
        counts = Counter(name for text in texts.values() for name in _TEXT.findall(text))
        for at, parameter in {each.location: each for each in declared}.items():
            lines = texts[at.path].split("\n")[at.line - 1 : at.line]
            is_statement = lines and lines[0].lstrip().startswith("self.declare_parameter(")
            is_chained = bool(lines) and lines[0].rstrip().endswith((".value", "_value"))
            if counts[parameter.name or ""] == 1 and is_statement and not is_chained:
                message = f"nothing reads the parameter {parameter.name!r}, which is declared here"
                yield warning(PARAMETER_READ, message, at)
