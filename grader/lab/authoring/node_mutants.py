"""Mutants of the code of nodes, and of messages, services and actions."""

import ast
import re
from collections.abc import Collection, Iterator

from grader.base.source import Location, Source
from grader.lab.authoring.mutants import MAX_LABEL, MutantEdit, misspelt
from grader.lab.submission.submission import Submission
from grader.ros.python.python_file import PythonFile
from grader.ros.workspace.names import Family

_INTERFACES = (".msg", ".srv", ".action")
_FIELD = re.compile(r"(?m)^[\w/<=\[\]]+[ \t]+([a-z]\w*)[ \t]*(?=$|#| )")
_SEPARATOR = re.compile(r"(?m)^---$\n?")
_CALLBACKS = {"create_timer": 1, "create_subscription": 2, "create_service": 2, "ActionServer": 3}
_ANSWERING = ("create_service", "ActionServer")


def node_changes(
    submission: Submission, source: Source, label: str, families: Collection[Family]
) -> Iterator[MutantEdit]:
    """Yield the changes of a file that a criterion about interfaces, or about code, should find."""
    if source.path.endswith(_INTERFACES) and "interfaces" in families:
        yield from _interface_changes(source, label)
    if not source.path.endswith(".py"):
        return
    if "interfaces" in families:
        for nodes in submission.workspace.nodes_by_package.values():
            for use in nodes.field_uses:
                if use.type.endswith(".GoalHandle") and len(use.path) == 1:
                    continue  # an attribute of rclpy's
                yield from _misspelt_at(source, label, use.location, use.path[-1])
            for found in nodes.imports:
                yield from _misspelt_at(source, label, found.location, found.name.split(".")[-1])
    if "code" in families and "rclpy" in source.text:
        yield from _code_changes(PythonFile(source), label)


def _interface_changes(source: Source, label: str) -> Iterator[MutantEdit]:
    """Yield that each field is misspelt, and each separator removed."""
    for found in _FIELD.finditer(source.text):
        yield MutantEdit("field renamed", f"{label} {found[1]}", *found.span(1), misspelt(found[1]))
    for found in _SEPARATOR.finditer(source.text):
        yield MutantEdit("separator removed", label, *found.span(), "")


def _misspelt_at(source: Source, label: str, at: Location, name: str) -> Iterator[MutantEdit]:
    """Yield that a name is misspelt where it is used."""
    if at.path != source.path:
        return
    start = source.offset(at.line, at.column)
    if source.text.startswith(name, start):
        end = start + len(name)
        yield MutantEdit("name misspelt", f"{label} {name}", start, end, misspelt(name))


def _code_changes(file: PythonFile, label: str) -> Iterator[MutantEdit]:
    """Yield that nothing spins, a callback is called, or a response is not returned."""
    answering: set[str] = set()
    for node in file.nodes:
        match node:
            case ast.Expr(value=ast.Call(func=ast.Attribute(attr="spin"))):
                place = f"{label} {file.segment(node)[:MAX_LABEL]}"
                yield MutantEdit("spin removed", place, *file.span(node), "pass")
            case ast.Call(func=ast.Attribute(attr=name) | ast.Name(id=name)) if name in _CALLBACKS:
                given = node.args[_CALLBACKS[name] :][:1]
                for callback in given:
                    text = file.segment(callback)
                    if isinstance(callback, ast.Attribute):
                        place = f"{label} {name} {text}"
                        yield MutantEdit(
                            "callback called", place, *file.span(callback), f"{text}()"
                        )
                    if isinstance(callback, ast.Attribute) and name in _ANSWERING:
                        answering.add(callback.attr)
    for node in file.nodes:
        if isinstance(node, ast.FunctionDef) and node.name in answering:
            last = node.body[-1]
            if isinstance(last, ast.Return):
                place = f"{label} {node.name}"
                yield MutantEdit("response not returned", place, *file.span(last), "pass")
