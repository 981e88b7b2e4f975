"""Mutants of the code of nodes in Python and C++, and of messages, services and actions."""

import ast
import re
from collections.abc import Collection, Iterable, Iterator
from itertools import pairwise

from grader.base.grouping import StringsByName
from grader.base.names import last_part
from grader.base.patterns import on_use
from grader.base.source import Location, Source
from grader.base.toml_file import toml_literal
from grader.lab.authoring.mutants import (
    MAX_LABEL,
    MutantEdit,
    MutantEdits,
    misspelt,
)
from grader.lab.submission.submission import Submission
from grader.ros.nodes.node_facts import NodeFacts
from grader.ros.package.package import CMAKE
from grader.ros.python.python_file import PythonFile
from grader.workspace.rules.rule_table import Family

_FIELD = on_use(r"(?m)^[\w/<=\[\]]+[ \t]+([a-z]\w*)[ \t]*(?=$|#| )")
_SEPARATOR = on_use(r"(?m)^---$\n?")
_TYPE = on_use(
    r"(?m)^((?:bool|byte|char|string|u?int(?:8|16|32|64)|float(?:32|64)))[ \t]+([a-z]\w*)"
)
_CPP = (".cpp", ".cc", ".cxx", ".hpp", ".h")
_CPP_STATEMENTS = {
    "spin removed": re.compile(r"(?m)^[ \t]*(?:rclcpp::spin|\w+\.spin)\([^;{}]*;"),
    "init removed": re.compile(r"(?m)^[ \t]*rclcpp::init\([^;{}]*;"),
    "declaration removed": re.compile(
        r"(?m)^[ \t]*(?:this->)?declare_parameter(?:<[^;{}]*>)?\([^;{}]*;"
    ),
}
# What a server does with goals, by the argument of serves_action: what it does no longer.
_FEEDBACK = on_use(r"(?m)^[ \t]*+([^\n(]*publish_feedback\([^\n]*+)$")
_ANSWERS = {
    "cancel": ("cancel rejected", on_use(r"\bCancelResponse(?:\.|::)(ACCEPT)\b"), "REJECT"),
    "rejects": ("goal accepted", on_use(r"\bGoalResponse(?:\.|::)(REJECT)\b"), "ACCEPT"),
}
_READ = on_use(
    r"(?:self\.|this->)?get_parameter\(\s*+[\"']([^\"'\n]++)[\"']\s*+\)\.(?:value|as_\w++\(\))"
)
_GENERATED = on_use(r"\"?\b((?:msg|srv|action)/\w+\.(?:msg|srv|action))\b\"?")
# Statements of rclpy without which a node does not work, and what each is.
_STATEMENTS = {"init": "init", "__init__": "constructor", "declare_parameter": "declaration"}
_BEST_EFFORT = "qos_profile_sensor_data"  # where a file imports it
_CALLBACKS = {"create_timer": 1, "create_subscription": 2, "create_service": 2, "ActionServer": 3}
# A statement of a node that needs what super().__init__() makes.
_NEEDS_NODE = on_use(r"(?:self\.\w+ = )?self\.(?:create_|declare_|get_parameter)")


def node_changes(
    submission: Submission, source: Source, families: Collection[Family]
) -> MutantEdits:
    """Yield the changes of a file that a criterion about interfaces, or about code, should find."""
    if "interfaces" in families:
        yield from _interface_changes(source)
    if source.path.endswith(_CPP) and "code" in families and "rclcpp" in source.text:
        yield from _cpp_changes(source)
    if not source.path.endswith(".py"):
        return
    if "interfaces" in families:
        for nodes in submission.workspace.code.by_package.values():
            for use in nodes.field_uses:
                if use.type.endswith(".GoalHandle") and len(use.path) == 1:
                    continue  # an attribute of rclpy's
                yield from _misspelt_at(source, use.location, use.path[-1])
            for node_import in nodes.imports:
                yield from _misspelt_at(
                    source, node_import.location, node_import.name.split(".")[-1]
                )
    if "code" in families and "rclpy" in source.text:
        yield from _code_changes(PythonFile(source))


def type_changes(source: Source, topics: Collection[str]) -> MutantEdits:
    """Yield that a node in Python opens one of these topics with another type that it imports."""
    if not source.path.endswith(".py") or "rclpy" not in source.text:
        return
    file = PythonFile(source)
    types = []
    for imported in file.imports:
        if isinstance(imported, ast.ImportFrom) and (imported.module or "").endswith(".msg"):
            types += [alias.asname or alias.name for alias in imported.names]
    for node in file.nodes:
        match node:
            case ast.Call(
                func=ast.Attribute(attr="create_publisher" | "create_subscription"),
                args=[ast.Name(id=name) as kind, ast.Constant(value=str(topic)), *_],
            ) if last_part(topic) in topics:
                for other in [other for other in types if other != name][:1]:
                    place = f"{topic} {name}"
                    yield MutantEdit("type of a topic changed", place, *file.span(kind), other)


def goal_changes(source: Source, asked: Collection[str]) -> MutantEdits:
    """Yield that a server no longer does with goals what serves_action asks for."""
    nothing = "pass" if source.path.endswith(".py") else ";"
    changes = {"feedback": ("feedback removed", _FEEDBACK, nothing), **_ANSWERS}
    for argument in asked:
        mutation, pattern, new = changes[argument]
        for match in pattern.finditer(source.text):
            place = f"line {source.at(match.start(1)).line}"
            yield MutantEdit(mutation, place, *match.span(1), new)


def defaults_in(nodes: Iterable[NodeFacts], names: Collection[str]) -> dict[str, str]:
    """Return the defaults of these parameters of nodes, as code has them, by their names."""
    defaults = {}
    for parameter in (parameter for node in nodes for parameter in node.parameters):
        name = parameter.name or ""
        if name in names and type(parameter.default) in (int, float, str):
            defaults[name] = toml_literal(parameter.default)
    return defaults


def default_changes(source: Source, defaults: StringsByName) -> MutantEdits:
    """Yield that the default of a parameter is used where its value is read."""
    for match in _READ.finditer(source.text):
        if match[1] in defaults:
            yield MutantEdit("parameter ignored", match[1], *match.span(), defaults[match[1]])


def _cpp_changes(source: Source) -> MutantEdits:
    """Yield the changes of a node in C++.

    rclcpp is not initialised, nothing spins, a parameter is not declared, or a callback returns
    too early.
    """
    for mutation, pattern in _CPP_STATEMENTS.items():
        for match in pattern.finditer(source.text):
            place = " ".join(match[0].split())[:MAX_LABEL]
            yield MutantEdit(mutation, place, *match.span(), "")


def _interface_changes(source: Source) -> MutantEdits:
    """Yield the changes of an interface.

    Each field is misspelt or of another type, each separator is removed, and each interface is
    not generated.
    """
    if source.path.endswith(CMAKE):
        for named in _GENERATED.finditer(source.text):
            yield MutantEdit("interface not generated", named[1], *named.span(1), "")
    if not source.path.endswith((".msg", ".srv", ".action")):
        return
    for match in _FIELD.finditer(source.text):
        yield MutantEdit("field renamed", match[1], *match.span(1), misspelt(match[1]))
    for match in _TYPE.finditer(source.text):
        other = "string" if match[1] != "string" else "int32"
        yield MutantEdit("field type changed", match[2], *match.span(1), other)
    for match in _SEPARATOR.finditer(source.text):
        yield MutantEdit("separator removed", "", *match.span(), "")


def _misspelt_at(source: Source, at: Location, name: str) -> MutantEdits:
    """Yield that a name is misspelt where it is used."""
    if at.path != source.path:
        return
    start = source.start_offset(at)
    if source.text.startswith(name, start):
        yield MutantEdit("name misspelt", name, start, start + len(name), misspelt(name))


def _code_changes(file: PythonFile) -> MutantEdits:
    """Yield that nothing spins, a callback is called, or a response is not returned."""
    answering = set()
    for node in file.nodes:
        match node:
            case ast.Expr(value=ast.Call(func=ast.Attribute(attr="spin"))):
                yield _removed(file, "spin removed", node)
            case ast.Call(func=ast.Attribute(attr=name) | ast.Name(id=name)) if name in _CALLBACKS:
                given = node.args[_CALLBACKS[name] :][:1]
                for callback in given:
                    text = file.segment(callback)
                    if isinstance(callback, ast.Attribute):
                        place = f"{name} {text}"
                        call = f"{text}()"
                        yield MutantEdit("callback called", place, *file.span(callback), call)
                        if name in ("create_service", "ActionServer"):
                            answering.add(callback.attr)
    yield from _call_changes(file)
    yield from _return_changes(file, answering)
    yield from _parameter_changes(file)
    yield from _instance_changes(file)
    yield from _order_changes(file)


def _return_changes(file: PythonFile, answering: Collection[str]) -> MutantEdits:
    """Yield that one of these callbacks does not return its response."""
    for node in file.nodes:
        if isinstance(node, ast.FunctionDef) and node.name in answering:
            last = node.body[-1]
            if isinstance(last, ast.Return):
                span = file.span(last)
                yield MutantEdit("response not returned", node.name, *span, "pass")
                yield MutantEdit("response replaced", node.name, *span, "return True")


def _parameter_changes(file: PythonFile) -> MutantEdits:
    """Yield that a callback lacks its last parameter, or has one more.

    A callback of a subscription may have one more.
    """
    functions = {node.name: node for node in file.nodes if isinstance(node, ast.FunctionDef)}
    for node in file.nodes:
        match node:
            case ast.Call(func=ast.Attribute(attr=called) | ast.Name(id=called), args=given):
                callbacks = given[_CALLBACKS[called] :][:1] if called in _CALLBACKS else []
            case _:
                continue
        for callback in callbacks:
            is_method = isinstance(callback, ast.Attribute)
            name = getattr(callback, "attr", getattr(callback, "id", ""))
            if name in functions:
                places = _parameter_places(file, functions[name], is_method=is_method)
                for mutation, start, end, new in places:
                    if called != "create_subscription" or not new:
                        yield MutantEdit(mutation, name, start, end, new)


def _parameter_places(
    file: PythonFile, function: ast.FunctionDef, *, is_method: bool
) -> Iterator[tuple[str, int, int, str]]:
    """Yield the changes of the parameters of a callback that takes a fixed number."""
    parameters = function.args
    names = parameters.args
    if function.decorator_list or parameters.defaults or parameters.vararg or not names:
        return
    _, end = file.span(names[-1])
    yield "callback parameter added", end, end, ", event"
    if len(names) > max(is_method, 1):
        yield "callback parameter removed", file.span(names[-2])[1], end, ""


def _instance_changes(file: PythonFile) -> MutantEdits:
    """Yield that a message or a node is replaced by its class."""
    made = {}  # the classes of variables
    for node in file.nodes:
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Call(func=ast.Name(id=kind))):
                made[name] = kind
    for node in file.nodes:
        match node:
            case ast.Call(func=ast.Attribute(attr="publish" | "spin" as method), args=[given]):
                called = given.func if isinstance(given, ast.Call) else given
                name = called.id if isinstance(called, ast.Name) else ""
                kind = name if isinstance(given, ast.Call) else made.get(name, "")
                if kind[:1].isupper():
                    mutation = "message" if method == "publish" else "spin"
                    place = file.segment(node)[:MAX_LABEL]
                    yield MutantEdit(f"{mutation} of a class", place, *file.span(given), kind)


def _order_changes(file: PythonFile) -> MutantEdits:
    """Yield that a node declares or opens something before its base class is initialised."""
    for node in file.nodes:
        if not isinstance(node, ast.FunctionDef) or node.name != "__init__":
            continue
        for first, second in pairwise(node.body):
            texts = file.segment(first), file.segment(second)
            if "super().__init__(" in texts[0] and _NEEDS_NODE.match(texts[1]):
                (start, between), (behind, end) = file.span(first), file.span(second)
                swapped = f"{texts[1]}{file.text[between:behind]}{texts[0]}"
                place = texts[1][:MAX_LABEL]
                yield MutantEdit("constructor after its use", place, start, end, swapped)


def _call_changes(file: PythonFile) -> MutantEdits:
    """Yield the changes of calls of rclpy.

    A statement is missing, a quality of service is another one, or a call of a service waits.
    """
    for node in file.nodes:
        match node:
            case ast.Expr(value=ast.Call(func=ast.Attribute(attr=name))) if name in _STATEMENTS:
                yield _removed(file, f"{_STATEMENTS[name]} removed", node)
            case ast.Call(func=ast.Attribute(attr=name), args=[_, _, *_, quality]):
                yield from _requalified(file, node, quality, name)
            case ast.Attribute(attr="call_async"):
                _, end = file.span(node)
                place = file.segment(node)[:MAX_LABEL]
                yield MutantEdit("call awaited", place, end - len("call_async"), end, "call")


def _removed(file: PythonFile, mutation: str, node: ast.Expr) -> MutantEdit:
    """Return that a statement is missing."""
    place = file.segment(node)[:MAX_LABEL]
    return MutantEdit(mutation, place, *file.span(node), "pass")


def _requalified(file: PythonFile, call: ast.Call, quality: ast.expr, name: str) -> MutantEdits:
    """Yield that a publisher is best effort, a subscription to one reliable, or a depth a text."""
    is_depth = isinstance(quality, ast.Constant)
    new = ""
    if name == "create_publisher" and is_depth and _BEST_EFFORT in file.text:
        new = _BEST_EFFORT
    elif name == "create_subscription" and not is_depth:
        new = "10"
    place = file.segment(call)[:MAX_LABEL]
    if is_depth and name in ("create_publisher", "create_subscription"):
        text = f"'{file.segment(quality)}'"
        yield MutantEdit("quality of service as text", place, *file.span(quality), text)
    if new:
        yield MutantEdit("quality of service changed", place, *file.span(quality), new)
