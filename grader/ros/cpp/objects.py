"""Objects in C++ functions: where they are made, and what is given them."""

from collections.abc import Collection
from itertools import islice

from grader.ros.cpp.declarations import declared_in, is_argument, name_in, plain, plain_name
from grader.ros.cpp.syntax import CppNode
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
    return kind.text if kind is not None and is_object else ""


def _declares_object(declaration: CppNode) -> bool:
    """Return whether a declaration makes an object: no function, pointer or reference."""
    kinds = ("declaration", "init_declarator", "function_declarator")
    for name, _ in declared_in(declaration):
        if name.parent is not None and name.parent.kind in kinds:
            return True
    return False


def made_in(parent: CppNode) -> CppNode:
    """Return what makes the object that a variable is declared with: a call, or the declaration."""
    if parent.kind == "init_declarator":
        value = parent.child("value")
        is_call = value is not None and value.kind in ("call_expression", "new_expression")
        if value is not None and is_call:
            return value
        return parent.parent or parent
    return parent


def find_variable(made: CppNode) -> CppNode | None:
    """Return the name of the variable that an object is made for; None without one."""
    if made.kind == "declaration":
        return next((name for name, _ in declared_in(made)), None)
    parent = made.parent
    if parent is not None and parent.kind == "init_declarator":
        declarator = parent.child("declarator")
        return name_in(declarator) if declarator is not None else None
    if parent is not None and parent.kind == "assignment_expression":
        return _last_name(parent.child("left"))
    return None


def _last_name(node: CppNode | None) -> CppNode | None:
    """Return the name of a variable or member: of `this->node_`, `node_`."""
    if node is not None and node.kind == "field_expression":
        return node.child("field")
    return node if node is not None and node.kind == "identifier" else None


def find_object(use: CppNode, same: Collection[str]) -> CppNode:
    """Return the expression that is the object whose name is written.

    The name may be followed by calls of the methods that return the object.
    """
    node = use
    if use.field == "field" and use.parent is not None:
        node = use.parent
    around = node.parent
    field = around.child("field") if around is not None else None
    is_self = field is not None and field.text in same and node.field == "argument"
    if is_self and around is not None and around.parent is not None:
        return around.parent
    return node


def find_taker(node: CppNode) -> str | None:
    """Return the name of what is given an object as an argument; None where nothing is."""
    if is_argument(node):
        around = [*islice(node.ancestors(), 2)]
        return _type_made(around[-1])
    argument = node
    while argument.parent is not None and argument.parent.kind in _SAME:
        argument = argument.parent
    given = argument.parent
    if given is None or given.parent is None:
        return None
    if argument.kind == "initializer_list" and given.kind in _INITIALIZED:
        return _type_made(given)
    return _name_called(given.parent) if given.kind == "argument_list" else None


def _name_called(call: CppNode) -> str | None:
    """Return the name of what gets the arguments of a call, or the class that it makes."""
    if call.kind != "call_expression":
        return _type_made(call)
    name = called_name(call)
    short = name.rpartition("::")[2]
    if short in _WRAPPERS:
        return find_taker(call)
    types = template_arguments(call)
    return plain(types[0]) if short in _MAKERS and types else name


def _type_made(node: CppNode) -> str:
    """Return the type of an object that gets arguments where it is declared."""
    for around in (node, *node.ancestors()):
        kind = around.child("type")
        if kind is not None:
            return plain_name(kind)
        if around.kind in ("field_initializer", "compound_statement"):
            break
    return node.children[0].text if node.children else "an object"
