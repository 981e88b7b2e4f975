"""Constructors of nodes that use the node before its base class is initialised, or without that."""

import ast
from collections.abc import Collection

from grader.base.problems import NO_FIXES
from grader.ros.nodes.node_facts import (
    CodeFault,
    CodeFaults,
)
from grader.ros.nodes.python.called_functions import list_methods, names_in_class
from grader.ros.nodes.python.code_edits import CodeEdits
from grader.ros.nodes.python.rclpy_names import HARMLESS
from grader.ros.python.constants import dotted, last_name
from grader.ros.python.parse import AnyFunction, Code
from grader.ros.python.walking import children, walk

# Methods of rclpy's Node that read attributes which its constructor sets: rclpy/node.py of
# ros2/rclpy, from Humble to Rolling.
_NEED_NODE = frozenset(
    {
        *("create_publisher", "create_subscription", "create_service", "create_client"),
        *("create_timer", "create_rate", "create_lifecycle_publisher"),
        *("declare_parameter", "declare_parameters", "get_parameter", "get_parameters"),
        *("get_parameter_or", "has_parameter", "set_parameters"),
        *("add_on_set_parameters_callback", "get_logger", "get_clock", "get_name"),
        *("get_namespace", "get_topic_names_and_types", "destroy_node"),
    }
)
# What is evaluated later, or perhaps not at all, or of which errors may be suppressed.
_UNCERTAIN = (
    *(ast.With, ast.AsyncWith),
    *(ast.If, ast.For, ast.AsyncFor, ast.While, ast.Try, ast.Match, ast.IfExp, ast.BoolOp),
    *(ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef, ast.Lambda, ast.comprehension),
)


def early_uses(
    code: Code,
    owner: ast.ClassDef,
    node_name: str,
    replaced: Collection[str],
    bases: Collection[str],
    spun: Collection[str],
) -> CodeFaults:
    """Yield the first call in a constructor that needs what super().__init__() makes.

    Without such a call, yield that super().__init__() is missing in a class that is `spun`.
    `owner` is a class whose only base is a node of rclpy, `replaced` are attributes that code sets.
    `bases` are the classes that others inherit: the constructors of these may make the node.
    """
    constructor = list_methods(owner).get("__init__")
    if not constructor or _is_made_elsewhere(owner, constructor, bases):
        return
    when = "called later"
    fixes = NO_FIXES
    if not _initialises(constructor):
        when = "not called"
        statement = f"super().__init__({node_name})"
        fixes = CodeEdits(code.source).add_first(constructor.body, statement)
    known = names_in_class(owner).union(replaced)
    called = None
    for statement_before in _statements_before(constructor):
        called = called or _first_need(statement_before, owner, known)
    if called:
        message = (
            f"{dotted(called.func)}() needs what super().__init__() makes, which is {when}: "
            "Python raises an AttributeError; call super().__init__() first"
        )
        yield CodeFault("constructor-order", message, code.at(called), fixes=fixes)
    elif owner.name in spun and when == "not called":
        message = f"super().__init__() is missing in the class {owner.name}, so it is no node"
        yield CodeFault("constructor-order", message, code.at(constructor), fixes=fixes)


def _is_made_elsewhere(
    owner: ast.ClassDef,
    constructor: AnyFunction,
    bases: Collection[str],
) -> bool:
    """Return whether something besides a constructor may make the node."""
    others = [method for method in list_methods(owner).values() if method is not constructor]
    if any(map(_initialises, others)):
        return True
    return not _initialises(constructor) and (
        owner.name in bases or _may_be_made(owner, constructor)
    )


def _statements_before(constructor: AnyFunction) -> list[ast.stmt]:
    """Return the statements before that with super().__init__(); all where there is none."""
    for position, statement in enumerate(constructor.body):
        if _initialises(statement):
            return constructor.body[:position]
    return constructor.body


def _may_be_made(owner: ast.ClassDef, constructor: AnyFunction) -> bool:
    """Return whether something else may make the node: a decorator, or a function that gets it."""
    if owner.decorator_list or constructor.decorator_list or "__new__" in list_methods(owner):
        return True
    for node in walk(constructor):
        if isinstance(node, ast.Call) and last_name(node.func) not in HARMLESS:
            given = [*node.args, *(keyword.value for keyword in node.keywords)]
            if "self" in map(dotted, given):
                return True
        if isinstance(node, ast.Raise) or dotted(node) == "super":
            return True
    return False


def _initialises(node: ast.AST) -> bool:
    """Return whether code may call the constructor of a base class."""
    return any(isinstance(part, ast.Attribute) and part.attr == "__init__" for part in walk(node))


def _first_need(
    statement: ast.stmt, owner: ast.ClassDef, known: Collection[str]
) -> ast.Call | None:
    """Return the first call of a method that needs the node; also in methods that are called."""
    methods = list_methods(owner)
    entered = set()
    pending: list[ast.AST] = [statement]
    while pending:
        node = pending.pop(0)
        if isinstance(node, _UNCERTAIN):
            continue
        pending = children(node) + pending
        if not isinstance(node, ast.Call) or not dotted(node.func).startswith("self."):
            continue
        name = dotted(node.func)[5:]
        if name in _NEED_NODE and name not in known:
            return node
        method = methods.get(name)
        if method and name not in entered and _runs_when_called(method):
            entered.add(name)
            pending += method.body
    return None


def _runs_when_called(method: ast.FunctionDef) -> bool:
    """Return whether a call runs the body of a method: it is not decorated, and no generator."""
    yields = any(isinstance(part, ast.Yield | ast.YieldFrom) for part in walk(method))
    return not yields and not method.decorator_list
