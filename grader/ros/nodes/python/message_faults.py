"""Messages from a module without them, `from std_msgs import String`, and fields without a type."""

import ast
from collections.abc import Collection, Iterable, Iterator

from grader.base.source import Source
from grader.ros.interfaces.interface_types import Interface
from grader.ros.interfaces.known_interfaces import known_interfaces
from grader.ros.known.package_tables import INTERFACE_KINDS, interface_table
from grader.ros.known.releases import Release
from grader.ros.nodes.node_facts import CodeFault, FieldUse
from grader.ros.nodes.python.code_edits import CodeEdits
from grader.ros.nodes.used_fields import resolve_field
from grader.ros.python.parse import Code


def wrong_imports(code: Code) -> Iterator[CodeFault]:
    """Yield the first import of a well-known message that certainly fails.

    Only statements of the module itself count: others may be prepared for a failure.
    """
    for statement in code.tree.body:
        if isinstance(statement, ast.ImportFrom) and statement.module and not statement.level:
            message = _why_wrong(statement.module, [name.name for name in statement.names])
            if message:
                at = code.at(statement)
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


def wrong_fields(
    source: Source, uses: Iterable[FieldUse], releases: Collection[Release]
) -> Iterator[CodeFault]:
    """Yield the fields that well-known types do not have, where it is sure what is meant."""

    def find(package: str, name: str) -> Interface | None:
        return (known_interfaces(package, tuple(releases)) or {}).get(name)

    for use in uses:
        used = resolve_field(use, find)
        if used is None or not used.is_absent:
            continue
        meant = used.find_meant(find, is_sure=True)
        if meant is not None:
            start = source.offset(use.location.line, use.location.column)
            fixes = CodeEdits(source).rewrite(start, start + len(used.name), meant)
            message = f"{used.owner} has no {used.noun} {used.name}"
            yield CodeFault("interface-field", message, use.location, fixes=fixes)
