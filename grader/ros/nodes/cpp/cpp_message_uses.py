"""The fields that functions in C++ use of messages, services and actions of certain type.

The type is certain of parameters and local variables that are declared once with it.
"""

import re
from collections import Counter
from collections.abc import Iterator

from grader.ros.cpp.declarations import (
    CONDITIONS,
    CppFunction,
    declared_in,
    name_in,
    plain,
    plain_name,
)
from grader.ros.cpp.syntax import CppNode
from grader.ros.cpp.unit import CppUnit, called_name, template_arguments
from grader.ros.nodes.message_uses import ITEM
from grader.ros.nodes.node_facts import FieldUse

_TYPE = re.compile(
    r"(?P<package>\w+)::(?P<kind>msg|srv|action)::(?P<name>[A-Z]\w*)"
    r"(?:::(?P<section>Request|Response|Goal|Result|Feedback))?"
    r"(?P<pointer>::(?:Const)?(?:Shared|Unique)Ptr)?"
)
_POINTERS = ("shared_ptr", "unique_ptr", "make_shared", "make_unique")
_DECLARING = ("parameter_declaration", "optional_parameter_declaration", "declaration")
_LOOPS = ("for_range_loop",)  # whose variable is declared by the loop itself
_MAX_PATH = 10


def cpp_field_uses(function: CppFunction, unit: CppUnit) -> Iterator[FieldUse]:
    """Yield the fields that a function uses, down to the last one that is certain to be a field."""
    if function.is_template:
        return
    types = _types_in(function, unit)
    if not types:
        return
    for node in _unconditional(function.node):
        if node.kind != "field_expression" or _is_method(node):
            continue
        root, path = _split_members(node)
        field = node.child("field")
        if root is not None and field is not None and path and root.text in types:
            yield FieldUse(types[root.text], path, field.location)


def _is_method(member: CppNode) -> bool:
    """Return whether a member is called: it is a method, of a list or a pointer."""
    around = member.parent
    is_called = around is not None and around.kind == "call_expression"
    return is_called and member.field == "function"


def _unconditional(function: CppNode) -> Iterator[CppNode]:
    """Yield the nodes in a function that the preprocessor never leaves out."""
    nodes, index = function.file.nodes, function.index
    while index < function.behind:
        node = nodes[index]
        if node.kind in CONDITIONS:
            index = node.behind
        else:
            yield node
            index += 1


def _types_in(function: CppFunction, unit: CppUnit) -> dict[str, str]:
    """Return the types of the parameters and variables of a function that are declared once.

    They are names of classes in Python: geometry_msgs.msg.Twist.
    """
    declared = Counter[str]()
    types: dict[str, str] = {}
    scopes = unit.list_scopes(function)
    for node in function.node.walk():
        if node.kind in _LOOPS:
            declarator = node.child("declarator")
            name = name_in(declarator) if declarator is not None else None
            if name is not None:
                declared[name.text] += 1
        if node.kind not in _DECLARING:
            continue
        for name, value in declared_in(node):
            declared[name.text] += 1
            type_found = _read_type(node, value, unit, scopes)
            if type_found is not None:
                types[name.text] = type_found
    return {name: type_name for name, type_name in types.items() if declared[name] == 1}


def _read_type(
    declaration: CppNode, value: CppNode | None, unit: CppUnit, scopes: tuple[str, ...]
) -> str | None:
    """Return the type that a declaration gives its variables; None for any other type."""
    kind = declaration.child("type")
    if kind is None:
        return None
    written = kind.text
    if kind.kind == "placeholder_type_specifier":
        written = _type_made(value)
    name = plain(written)
    if name.rpartition("::")[2] in _POINTERS:
        arguments = written.partition("<")[2].rpartition(">")[0]
        name = plain(arguments.strip().removeprefix("const ").removesuffix(" const"))
    match = _TYPE.fullmatch(unit.meanings(name, scopes)[0])
    if match is None:
        return None
    section = f".{match['section']}" if match["section"] else ""
    return f"{match['package']}.{match['kind']}.{match['name']}{section}"


def _type_made(value: CppNode | None) -> str:
    """Return the type of the object that a value makes: `Twist()`, `make_shared<Twist>()`."""
    if value is None:
        return ""
    if value.kind == "compound_literal_expression":
        kind = value.child("type")
        return kind.text if kind is not None else ""
    if value.kind != "call_expression":
        return ""
    types = template_arguments(value)
    name = called_name(value)
    if name.rpartition("::")[2] in _POINTERS:
        return types[0] if types else ""
    function = value.child("function")
    is_name = function is not None and function.kind != "field_expression"
    return plain_name(function) if is_name and function is not None and not types else ""


def _split_members(node: CppNode) -> tuple[CppNode | None, tuple[str, ...]]:
    """Return the variable that a chain of members begins with, and the names of the fields.

    There is no variable where something else is in between.
    """
    path: list[str] = []
    inner: CppNode | None = node
    while inner is not None and len(path) < _MAX_PATH:
        if inner.kind == "identifier":
            return inner, tuple(reversed(path))
        if inner.kind == "field_expression":
            owner, field = inner.child("argument"), inner.child("field")
            if owner is None or field is None or field.kind != "field_identifier":
                return None, ()
            if b"*" in inner.file.data[owner.end : field.start]:
                return None, ()  # a pointer to a member
            path.append(field.text)
        elif inner.kind == "subscript_expression":
            path.append(ITEM)
        else:
            return None, ()
        inner = inner.child("argument")
    return None, ()
