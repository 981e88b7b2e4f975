"""The names of topics, services and actions that Python code makes of values at the start.

These are what depends on the node as it is started: its name, its namespace, and the values of
its parameters.
"""

import ast
import re
import sys
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import TypeVar

from grader.base.patterns import on_use
from grader.base.records import Named
from grader.ros.nodes.message_uses import Evaluate
from grader.ros.nodes.node_facts import NamePart, NameParts
from grader.ros.python.constants import count_stored, dotted, make_order
from grader.ros.python.values import Call
from grader.ros.python.walking import walk

_Expressions = Mapping[str, ast.expr]

_MAX_DEPTH = 12  # of names that are bound to expressions with names
_MAX_ITEMS = 20  # of a list that a loop goes through
_MAX_PARTS = 20
_UNKNOWN = NamePart("unknown")
_FIELD = on_use(r"\{(\d*)\}|\{\{|\}\}|\{[^{}]*\}")
_PERCENT = on_use(r"%([sdi%])|%")
_OF_NODE = {
    "get_name": NamePart("node name"),
    "get_namespace": NamePart("namespace"),
}
_METHODS = ("get_parameter", "declare_parameter")
_VALUES = ("value", "string_value", "string_array_value", "integer_value")
_PARAMETER_CALLBACKS = ("add_on_set_parameters_callback", "add_post_set_parameters_callback")


_Found = TypeVar("_Found")


class _Loop(Named):
    """A loop through a list; its name is not bound to one item outside of these lines."""

    items: ast.expr
    first: int
    last: int


class Bindings(Named):
    """What names are bound to once: the expressions, and those of lists that loops go through."""

    values: _Expressions
    loops: Mapping[str, _Loop]

    def within(self, inner: "Bindings") -> "Bindings":
        """Return these names with those of a scope inside of theirs, which hide them."""
        return Bindings({**self.values, **inner.values}, {**self.loops, **inner.loops})


def bindings(nodes: Iterable[ast.AST], *, of_self: bool = False) -> Bindings:
    """Return what names in a function, or attributes of self in a class, are bound to once.

    A callback of parameters binds an attribute anew only after the node is started.
    """
    ordered = sorted(nodes, key=make_order)
    if of_self:
        later = _nodes_of_parameter_callbacks(ordered)
        ordered = [node for node in ordered if node not in later]
    values = {}
    loops = {}
    for node in ordered:
        match node:
            case (
                ast.Assign(targets=[target], value=value)
                | ast.AnnAssign(target=target, value=ast.expr() as value)
            ):
                values[dotted(target)] = value
            case ast.For() | ast.comprehension():
                name, loop = _looped(node)
                loops[name] = loop
    once = {name for name, count in count_stored(ordered).items() if count == 1}
    if of_self:
        once = {name for name in once if name.startswith("self.")}
    return Bindings(_only(values, once), _only(loops, once))


def _nodes_of_parameter_callbacks(nodes: Sequence[ast.AST]) -> set[ast.AST]:
    """Return all nodes of the methods that a class is told of set parameters by."""
    names = set()
    for node in nodes:
        match node:
            case ast.Call(
                func=ast.Attribute(attr=registers),
                args=[ast.Attribute(value=ast.Name(id="self"), attr=method), *_],
            ) if registers in _PARAMETER_CALLBACKS:
                names.add(method)
    inside = set()
    for node in nodes if names else ():
        if isinstance(node, ast.FunctionDef) and node.name in names:
            inside.update(walk(node))
    return inside


def _only(constants: Mapping[str, _Found], names: Collection[str]) -> dict[str, _Found]:
    return {name: value for name, value in constants.items() if name in names}


def _looped(node: ast.For | ast.comprehension) -> tuple[str, _Loop]:
    """Return the name that a loop gives each item of a list; of enumerate() that of the item."""
    first = 0
    last = sys.maxsize
    if isinstance(node, ast.For):
        first = node.lineno
        last = max(statement.end_lineno or statement.lineno for statement in node.body)
    match node.target, node.iter:
        case ast.Tuple(elts=[_, named]), ast.Call(func=ast.Name(id="enumerate"), args=[items]):
            return dotted(named), _Loop(items, first, last)
    return dotted(node.target), _Loop(node.iter, first, last)


class EndpointNames:
    """Reads names in one function."""

    def __init__(self, known: Bindings, evaluate: Evaluate) -> None:
        self._known = known
        self._evaluate = evaluate

    def read(self, node: ast.expr) -> Iterator[NameParts]:
        """Yield the parts of a name.

        A name in a loop through a list in the code is yielded once for each item.
        """
        names = {name.id for name in walk(node) if isinstance(name, ast.Name)}
        for name in sorted(names):
            loop = self._loop(name, node)
            items = self._items(loop.items if loop else None)
            if items is not None:
                for item in items[:_MAX_ITEMS]:
                    yield self._joined(self._parts(node, {name: item}))
                return
        yield self._joined(self._parts(node, {}))

    def _loop(self, name: str, node: ast.expr) -> _Loop | None:
        """Return the loop that an expression is in and that binds a name."""
        loop = self._known.loops.get(name)
        if loop and loop.first <= node.lineno <= loop.last:
            return loop
        return None

    def _items(self, node: ast.expr | None) -> list[ast.expr] | None:
        """Return the items of a list that is written in the code; None for any other list."""
        for _ in range(_MAX_DEPTH):
            match node:
                case ast.List(elts=items) | ast.Tuple(elts=items):
                    return items
                case ast.Dict(keys=keys):
                    return [key for key in keys if key]
                case ast.Name() | ast.Attribute():
                    node = self._known.values.get(dotted(node))
                case _:
                    return None
        return None

    def _joined(self, parts: Iterable[NamePart]) -> NameParts:
        """Return parts, of which no two texts follow each other."""
        joined: list[NamePart] = []
        for part in parts:
            if joined and joined[-1].kind == part.kind == "text":
                joined[-1] = NamePart("text", joined[-1].text + part.text)
            elif len(joined) < _MAX_PARTS:
                joined.append(part)
            else:
                joined[-1] = _UNKNOWN
        return tuple(joined)

    def _parts(self, node: ast.expr, items: _Expressions, depth: int = 0) -> Iterator[NamePart]:
        """Yield the parts of an expression; `items` are what the names of loops are."""
        value = self._evaluate(node)
        if isinstance(value, str | int) and not isinstance(value, bool):
            yield NamePart("text", str(value))
            return
        if depth > _MAX_DEPTH:
            yield _UNKNOWN
            return
        match node:
            case ast.JoinedStr(values=values):
                for each in values:
                    yield from self._parts(each, items, depth + 1)
            case ast.FormattedValue(value=inner, conversion=-1, format_spec=None):
                yield from self._parts(inner, items, depth + 1)
            case ast.BinOp(left=left, op=ast.Add(), right=right):
                yield from self._parts(left, items, depth + 1)
                yield from self._parts(right, items, depth + 1)
            case ast.BinOp(left=ast.Constant(value=str(text)), op=ast.Mod(), right=right):
                given = right.elts if isinstance(right, ast.Tuple) else [right]
                yield from self._formatted(_PERCENT, text, given, items, depth)
            case ast.Name() | ast.Attribute():
                yield from self._of_name(node, items, depth)
            case ast.Call():
                yield from self._of_call(node, items, depth)
            case _:
                yield _UNKNOWN

    def _of_name(
        self, node: ast.Name | ast.Attribute, items: _Expressions, depth: int
    ) -> Iterator[NamePart]:
        name = dotted(node)
        parameter = self._parameter(node)
        if name in items:
            yield from self._parts(items[name], {}, depth + 1)
        elif parameter:
            yield self._of_parameter("parameter", parameter)
        elif name in self._known.values:
            yield from self._parts(self._known.values[name], items, depth + 1)
        elif loop := self._loop(name, node):
            yield self._make_part(loop.items)
        else:
            yield _UNKNOWN

    def _make_part(self, node: ast.expr) -> NamePart:
        """Return the part that an item of a list is: of a parameter, or not known."""
        for _ in range(_MAX_DEPTH):
            parameter = self._parameter(node)
            if parameter:
                return self._of_parameter("item", parameter)
            if dotted(node) not in self._known.values:
                break
            node = self._known.values[dotted(node)]
        return _UNKNOWN

    def _of_parameter(self, kind: str, name: ast.expr) -> NamePart:
        value = self._evaluate(name)
        if not isinstance(value, str):
            return _UNKNOWN
        return NamePart("item" if kind == "item" else "parameter", value)

    def _of_call(self, node: ast.Call, items: _Expressions, depth: int) -> Iterator[NamePart]:
        match node:
            case ast.Call(func=ast.Name(id="str"), args=[inner], keywords=[]):
                yield from self._parts(inner, items, depth + 1)
            case ast.Call(
                func=ast.Attribute(value=ast.Constant(value=str(text)), attr="format"),
                args=given,
                keywords=[],
            ):
                yield from self._formatted(_FIELD, text, given, items, depth)
            case ast.Call(func=ast.Attribute(value=owner, attr=method), args=[]) if (
                method in _OF_NODE and self._is_node(owner)
            ):
                yield _OF_NODE[method]
            case _:
                yield _UNKNOWN

    def _is_node(self, node: ast.expr) -> bool:
        """Return whether an expression is the node: self, or what rclpy.create_node() makes."""
        value = self._evaluate(node) if dotted(node) else None
        is_made = isinstance(value, Call) and value.name.startswith("rclpy.")
        return dotted(node) == "self" or is_made

    def _formatted(
        self,
        pattern: re.Pattern[str],
        text: str,
        given: list[ast.expr],
        items: _Expressions,
        depth: int,
    ) -> Iterator[NamePart]:
        """Yield the parts of a text with places for what is given."""
        start = number = 0
        for place in pattern.finditer(text):
            yield NamePart("text", text[start : place.start()])
            start = place.end()
            if place[0] in ("{{", "}}", "%%"):
                yield NamePart("text", place[0][0])
                continue
            at = int(place[1]) if (place[1] or "").isdigit() else number
            number += 1
            if place[1] is not None and at < len(given):
                yield from self._parts(given[at], items, depth + 1)
            else:
                yield _UNKNOWN
        yield NamePart("text", text[start:])

    def _parameter(self, node: ast.expr) -> ast.expr | None:
        """Return the name of the parameter whose value an expression is.

        The result is None if it is no parameter's.
        """
        match node:
            case ast.Attribute(value=ast.Call(func=made, args=[name, *_]), attr="value"):
                method = made
            case ast.Attribute(
                value=ast.Call(
                    func=ast.Attribute(
                        value=ast.Call(func=made, args=[name, *_]), attr="get_parameter_value"
                    )
                ),
                attr=attribute,
            ) if attribute in _VALUES:
                method = made
            case _:
                return None
        is_method = isinstance(method, ast.Attribute) and method.attr in _METHODS
        if isinstance(method, ast.Attribute) and is_method and self._is_node(method.value):
            return name
        return None
