"""Nodes whose class is derived from another class of the package: what that declares and opens.

A class adds what its base class does if it has no other base, calls the constructor of the base
once, and replaces nothing that decides what the base does. All others keep their doubt.
"""

import ast
from collections.abc import Iterator, Mapping, Sequence

from grader.base.records import Named
from grader.base.source import Location
from grader.ros.nodes.message_uses import Evaluate, given_argument
from grader.ros.nodes.node_facts import NodeFacts
from grader.ros.nodes.python.called_functions import list_methods
from grader.ros.nodes.python.rclpy_names import NODE_CLASSES
from grader.ros.python.constants import dotted
from grader.ros.python.parse import own_nodes
from grader.ros.python.walking import walk

_MAX_DEPTH = 8  # of classes derived from each other


class OwnClass(Named):
    """A class of a module: its syntax, the full names of its bases, and its file.

    `evaluate` gives the values of expressions in its constructor.
    """

    node: ast.ClassDef
    bases: Sequence[str | None]
    path: str
    evaluate: Evaluate


_Classes = Mapping[str, OwnClass]


class _Constructor(Named):
    """The constructor of a class, and how it calls that of its base.

    `first` is the position of the first argument of the call behind self.
    """

    function: ast.FunctionDef
    call: ast.Call
    first: int
    evaluate: Evaluate


def with_inherited(
    nodes: Sequence[NodeFacts], classes: _Classes, options: Sequence[str | None]
) -> list[NodeFacts]:
    """Return nodes with what their base classes of the package declare and open.

    `classes` are those of the package by their full names; `options` are arguments of Node that
    leave open what it does.
    """
    by_name = {node.class_name: node for node in nodes if node.class_name}
    return [_joined(node, by_name, classes, options) or node for node in nodes]


def _joined(
    node: NodeFacts,
    by_name: Mapping[str, NodeFacts],
    classes: _Classes,
    options: Sequence[str | None],
) -> NodeFacts | None:
    """Return a node with what its base classes add; None if that is not known."""
    chain = _base_classes(node.class_name, classes)
    if len(chain) < 2 or any(name not in by_name for name in chain):
        return None
    constructors = _list_constructors([classes[name] for name in chain])
    if not constructors or _is_any_replaced(chain, by_name, classes):
        return None
    return _add_bases(
        node._replace(name=_passed_name(constructors), named_at=None),
        [by_name[name] for name in chain],
        is_settled=len(constructors) == len(chain)
        and _takes_more(constructors[-1])
        and not _gives_more(constructors[:-1], options),
    )


def _add_bases(node: NodeFacts, facts: Sequence[NodeFacts], *, is_settled: bool) -> NodeFacts:
    """Return a node with the facts of its bases; `is_settled`: no argument leaves a doubt."""
    endpoints = list(node.endpoints)
    parameters = list(node.parameters)
    timers = list(node.timers)
    frames = list(node.frames)
    transforms = list(node.transforms)
    doubts = list(node.doubts)
    for base in facts[1:]:
        endpoints += base.endpoints
        parameters += base.parameters
        timers += base.timers
        frames += base.frames
        transforms += base.transforms
        doubts += base.doubts
    settled = ("base class", "more arguments") if is_settled else ("base class",)
    return node._replace(
        endpoints=tuple(endpoints),
        parameters=tuple(parameters),
        timers=tuple(timers),
        frames=tuple(frames),
        transforms=tuple(transforms),
        doubts=tuple(doubt for doubt in doubts if doubt.of not in settled),
    )


def _is_any_replaced(
    chain: Sequence[str], by_name: Mapping[str, NodeFacts], classes: _Classes
) -> bool:
    """Return whether a class of a chain replaces what decides about one of its bases."""
    for index, derived in enumerate(chain):
        for base in chain[index + 1 :]:
            if _replaces(classes[derived], classes[base], by_name[base]):
                return True
    return False


def _list_constructors(chain: Sequence[OwnClass]) -> list[_Constructor]:
    """Return the constructors of a class and its bases; none if one may do something else."""
    constructors = []
    for own_class in chain:
        if "__init__" not in list_methods(own_class.node):
            continue  # that of the base is called
        constructor = _find_constructor(own_class)
        if not constructor:
            return []
        constructors.append(constructor)
    return constructors


def _base_classes(name: str, classes: _Classes) -> list[str]:
    """Return a class and its bases in the package, if the last one is derived from rclpy's only."""
    chain: list[str] = []
    while name in classes and name not in chain and len(chain) < _MAX_DEPTH:
        chain.append(name)
        own_class = classes[name]
        if len(own_class.bases) != 1 or own_class.node.keywords or own_class.node.decorator_list:
            return []
        [base] = own_class.bases
        if base in NODE_CLASSES:
            return chain
        name = base or ""
    return []


def _replaces(derived: OwnClass, base: OwnClass, of_base: NodeFacts) -> bool:
    """Return whether a class replaces what decides what its base declares and opens.

    It is an attribute that the base reads, or a method in which the base does so.
    """
    methods = list_methods(base.node)
    own_methods = list_methods(derived.node)
    lines = [at.line for at in _list_places(of_base) if at.path == base.path]
    read = _read_attributes(base.node)
    for name in _replaced_names(derived.node):
        if name in read and name not in own_methods:
            return True
        method = methods.get(name)
        if method:
            inside = range(method.lineno, (method.end_lineno or method.lineno) + 1)
            if any(line in inside for line in lines):
                return True
    return False


def _list_places(node: NodeFacts) -> Iterator[Location]:
    """Yield where a class declares and opens what it does."""
    for endpoint in node.endpoints:
        yield endpoint.location
    for parameter in node.parameters:
        yield parameter.location
    for timer in node.timers:
        yield timer.location
    for frame in node.frames:
        yield frame.location
    for transform in node.transforms:
        yield transform.location


def _read_attributes(node: ast.ClassDef) -> set[str]:
    """Return the attributes of self that a class names."""
    names = set()
    for part in walk(node):
        if isinstance(part, ast.Attribute) and dotted(part.value) == "self":
            names.add(part.attr)
    return names


def _replaced_names(node: ast.ClassDef) -> Iterator[str]:
    """Yield the names that a class gives its attributes and methods, but for its constructor."""
    for part in own_nodes(node):
        match part:
            case ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name):
                if name != "__init__":
                    yield name
            case ast.Name(id=name, ctx=ast.Store()):
                yield name
    for part in walk(node):
        match part:
            case ast.Attribute(value=ast.Name(id="self"), attr=name, ctx=ast.Store()):
                yield name


def _find_constructor(own_class: OwnClass) -> _Constructor | None:
    """Return the constructor of a class that surely calls that of its base once."""
    function = list_methods(own_class.node).get("__init__")
    if not function or function.decorator_list:
        return None
    calls = [
        node
        for node in walk(own_class.node)
        if isinstance(node, ast.Call) and getattr(node.func, "attr", "") == "__init__"
    ]
    statements = [each.value for each in function.body if isinstance(each, ast.Expr)]
    if len(calls) != 1 or calls[0] not in statements:
        return None
    [call] = calls
    assert isinstance(call.func, ast.Attribute)
    is_super = isinstance(call.func.value, ast.Call) and dotted(call.func.value.func) == "super"
    return _Constructor(function, call, 0 if is_super else 1, own_class.evaluate)


def _takes_more(constructor: _Constructor) -> bool:
    """Return whether a constructor passes on what its own ** takes, and nothing else by **."""
    taken = constructor.function.args.kwarg
    passed = [keyword.value for keyword in constructor.call.keywords if keyword.arg is None]
    return taken is not None and [dotted(value) for value in passed] == [taken.arg]


def _gives_more(constructors: Sequence[_Constructor], options: Sequence[str | None]) -> bool:
    """Return whether calls of the constructor of a base give Node one of some options."""
    for constructor in constructors:
        for keyword in constructor.call.keywords:
            is_off = isinstance(keyword.value, ast.Constant) and keyword.value.value is False
            if keyword.arg in options and not is_off:
                return True
    return False


def _passed_name(constructors: Sequence[_Constructor]) -> str | None:
    """Return the name that a node gets: what the last constructor gives Node, or what it is given.

    The constructors are those of a class and its bases, in this order.
    """
    wanted = "node_name"
    position = 0
    default = None
    for constructor in reversed(constructors):
        given = given_argument(constructor.call, position + constructor.first, wanted) or default
        value = constructor.evaluate(given) if given else None
        if isinstance(value, str):
            return value
        parameters = constructor.function.args.args
        names = [parameter.arg for parameter in parameters]
        if not isinstance(given, ast.Name) or given.id not in names[1:]:
            return None
        if any(isinstance(each, ast.Name) and each.id == given.id for each in _stored(constructor)):
            return None
        wanted = given.id
        position = names.index(given.id) - 1
        behind = names.index(given.id) - len(names)
        defaults = constructor.function.args.defaults
        default = defaults[behind] if -behind <= len(defaults) else None
    return None


def _stored(constructor: _Constructor) -> Iterator[ast.AST]:
    """Yield the names that a constructor binds."""
    for node in walk(constructor.function):
        if isinstance(getattr(node, "ctx", None), ast.Store | ast.Del):
            yield node
