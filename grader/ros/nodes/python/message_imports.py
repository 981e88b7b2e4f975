"""Imports of messages from a module that does not have them: `from std_msgs import String`."""

import ast
from collections.abc import Iterator

from grader.ros.known.package_tables import INTERFACE_KINDS, interface_table
from grader.ros.nodes.node_facts import CodeFault
from grader.ros.python.parse import Code, location_in, position_of


def wrong_imports(code: Code) -> Iterator[CodeFault]:
    """Yield the first import of a well-known message that certainly fails.

    Only statements of the module itself count: others may be prepared for a failure.
    """
    for statement in code.tree.body:
        if isinstance(statement, ast.ImportFrom) and statement.module and not statement.level:
            message = _why_wrong(statement.module, [name.name for name in statement.names])
            if message:
                at = location_in(code.source, position_of(statement))
                yield CodeFault("name-binding", message, at)
                return


def _why_wrong(module: str, names: list[str]) -> str:
    """Return why an import fails; empty for one that does not, or of which it is not known."""
    package, _, section = module.partition(".")
    if section.partition(".")[0] in INTERFACE_KINDS:
        return ""
    for kind, known in (interface_table(package) or {}).items():
        for name in names:
            if name in known:
                return f"{module} has no {name}: write from {package}.{kind} import {name}"
    return ""
