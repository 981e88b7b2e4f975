"""Objects in C++ functions: where they are made, and what is given them."""

from collections.abc import Collection
from itertools import islice

from grader.ros.cpp.declarations import (
    declared_in,
    is_argument,
    name_in,
    plain,
    plain_name,
    short_name,
)
from grader.ros.cpp.syntax import NO_NODE, CppNode
from grader.ros.cpp.unit import called_name, template_arguments

_MAKERS = ("make_shared", "make_unique")
# What returns the pointer that it is given.
_WRAPPERS = ("move", "forward", "ref", "shared_ptr", "static_pointer_cast", "dynamic_pointer_cast")
_SAME = ("pointer_expression", "parenthesized_expression", "initializer_list")
_INITIALIZED = ("field_initializer", "init_declarator")


def class_written(node: CppNode) -> str:
    """Return the class of which something makes an object, as it is written.

    It is empty for something else.
    """
    if node.kind == "call_expression":
        owner, _, short = called_name(node).rpartition("::")
        if short not in _MAKERS:
            return ""
        types = template_arguments(node)
        return types[0] if types else owner
    kind = node.child("type")
    is_object = node.kind == "new_expression" or (
        node.kind == "declaration" and _declares_object(node)
    )
    return kind.text if is_object else ""


def _declares_object(declaration: CppNode) -> bool:
    """Return whether a declaration makes an object: no function, pointer or reference."""
    kinds = ("declaration", "init_declarator", "function_declarator")
    return any(name.parent.kind in kinds for name, _ in declared_in(declaration))


def made_in(parent: CppNode) -> CppNode:
    """Return what makes the object that a variable is declared with: a call, or the declaration."""
    if parent.kind == "init_declarator":
        value = parent.child("value")
        is_call = value.kind in ("call_expression", "new_expression")
        return value if is_call else parent.parent
    return parent


def find_variable(made: CppNode) -> CppNode:
    """Return the name of the variable that an object is made for; NO_NODE without one."""
    if made.kind == "declaration":
        return next((name for name, _ in declared_in(made)), NO_NODE)
    parent = made.parent
    if parent.kind == "init_declarator":
        return name_in(parent.child("declarator"))
    if parent.kind == "assignment_expression":
        return _last_name(parent.child("left"))
    return NO_NODE


def _last_name(node: CppNode) -> CppNode:
    """Return the name of a variable or member: of `this->node_`, `node_`."""
    if node.kind == "field_expression":
        return node.child("field")
    return node if node.kind == "identifier" else NO_NODE


def find_object(use: CppNode, same: Collection[str]) -> CppNode:
    """Return the expression that is the object whose name is written.

    The name may be followed by calls of the methods that return the object.
    """
    node = use.parent if use.field == "field" else use
    around = node.parent
    is_self = around.child("field").text in same and node.field == "argument"
    return around.parent if is_self else node


def find_taker(node: CppNode) -> str | None:
    """Return the name of what is given an object as an argument; None where nothing is."""
    if is_argument(node):
        around = list(islice(node.ancestors(), 2))
        return _type_made(around[-1])
    argument = node
    while argument.parent.kind in _SAME:
        argument = argument.parent
    given = argument.parent
    if argument.kind == "initializer_list" and given.kind in _INITIALIZED:
        return _type_made(given)
    return _name_called(given.parent) if given.kind == "argument_list" else None


def _name_called(call: CppNode) -> str | None:
    """Return the name of what gets the arguments of a call, or the class that it makes."""
    if call.kind != "call_expression":
        return _type_made(call)
    name = called_name(call)
    short = short_name(name)
    if short in _WRAPPERS:
        return find_taker(call)
    types = template_arguments(call)
    return plain(types[0]) if short in _MAKERS and types else name


def _type_made(node: CppNode) -> str:
    """Return the type of an object that gets arguments where it is declared."""
    for around in (node, *node.ancestors()):
        kind = around.child("type")
        if kind:
            return plain_name(kind)
        if around.kind in ("field_initializer", "compound_statement"):
            break
    return node.children[0].text if node.children else "an object"
