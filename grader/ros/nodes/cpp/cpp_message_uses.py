"""The fields that functions in C++ use of messages, services and actions of certain type.

The type is certain of parameters and local variables that are declared once with it.
"""

from collections import Counter
from collections.abc import Iterator

from grader.base.grouping import Strings
from grader.base.patterns import on_use
from grader.ros.cpp.declarations import (
    CONDITIONS,
    CppFunction,
    declared_in,
    name_in,
    plain,
    plain_name,
    short_name,
)
from grader.ros.cpp.syntax import CppNode
from grader.ros.cpp.unit import CppUnit, called_name, template_arguments
from grader.ros.nodes.message_uses import ITEM
from grader.ros.nodes.node_facts import FieldUse

_TYPE = on_use(
    r"(?P<package>\w+)::(?P<kind>msg|srv|action)::(?P<name>[A-Z]\w*)"
    r"(?:::(?P<section>Request|Response|Goal|Result|Feedback))?"
    r"(?P<pointer>::(?:Const)?(?:Shared|Unique)Ptr)?"
)
_POINTERS = ("shared_ptr", "unique_ptr", "make_shared", "make_unique")
_DECLARING = ("parameter_declaration", "optional_parameter_declaration", "declaration")
_LOOPS = ("for_range_loop",)  # whose variable is declared by the loop itself
_MAX_PATH = 9


def cpp_field_uses(function: CppFunction, unit: CppUnit) -> Iterator[FieldUse]:
    """Yield the fields that a function uses, down to the last one that is certain to be a field."""
    if function.is_template:
        return
    types = _types_in(function, unit)
    if not types:
        return
    for node in _unconditional(function.node):
        # What is called is a method, of a list or a pointer.
        is_called = node.parent.kind == "call_expression" and node.field == "function"
        if node.kind != "field_expression" or is_called:
            continue
        root, path = _split_members(node)
        if root in types:
            yield FieldUse(types[root], path, node.child("field").location)


def _unconditional(function: CppNode) -> Iterator[CppNode]:
    """Yield the nodes in a function that the preprocessor never leaves out."""
    nodes = function.file.nodes
    index = function.index
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
    types = {}
    scopes = function.inner_scopes
    for node in function.node.walk():
        if node.kind in _LOOPS:
            declared[name_in(node.child("declarator")).text] += 1
        if node.kind not in _DECLARING:
            continue
        for name, value in declared_in(node):
            declared[name.text] += 1
            type_found = _read_type(node, value, unit, scopes)
            if type_found is not None:
                types[name.text] = type_found
    return {name: type_name for name, type_name in types.items() if declared[name] == 1}


def _read_type(declaration: CppNode, value: CppNode, unit: CppUnit, scopes: Strings) -> str | None:
    """Return the type that a declaration gives its variables; None for any other type."""
    kind = declaration.child("type")
    written = kind.text
    if kind.kind == "placeholder_type_specifier":
        written = _type_made(value)
    name = plain(written)
    if short_name(name) in _POINTERS:
        arguments = written.partition("<")[2].rpartition(">")[0]
        name = plain(arguments.strip().removeprefix("const ").removesuffix(" const"))
    match = _TYPE.fullmatch(unit.meanings(name, scopes)[0])
    if not match:
        return None
    section = f".{match['section']}" if match["section"] else ""
    return f"{match['package']}.{match['kind']}.{match['name']}{section}"


def _type_made(value: CppNode) -> str:
    """Return the type of the object that a value makes: `Twist()`, `make_shared<Twist>()`."""
    if value.kind == "compound_literal_expression":
        return value.child("type").text
    if value.kind != "call_expression":
        return ""
    types = template_arguments(value)
    name = called_name(value)
    if short_name(name) in _POINTERS:
        return types[0] if types else ""
    function = value.child("function")
    is_name = function.kind != "field_expression" and not types
    return plain_name(function) if is_name else ""


def _split_members(node: CppNode) -> tuple[str, Strings]:
    """Return the variable that a chain of members begins with, and the names of the fields.

    The variable is empty where something else is in between.
    """
    path: list[str] = []
    inner = node
    while inner.kind != "identifier" and len(path) < _MAX_PATH:
        owner = inner.child("argument")
        field = inner.child("field")
        if inner.kind == "subscript_expression":
            path.append(ITEM)
        elif field.kind != "field_identifier" or inner.kind != "field_expression":
            return "", ()
        elif b"*" in inner.file.data[owner.end : field.start]:
            return "", ()  # a pointer to a member
        else:
            path.append(field.text)
        inner = owner
    return inner.text if inner.kind == "identifier" else "", tuple(reversed(path))
