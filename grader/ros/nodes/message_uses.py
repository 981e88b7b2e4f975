"""The types of messages, services and actions that Python code imports, and used fields.

The fields are those of values whose type is certain.

A value is certain where its name is bound once: what a typed callback is given, T(), and a field of
these. What is under a condition on its type, or caught, does not count.
"""

import ast
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from functools import partial

from grader.base.grouping import Strings
from grader.base.records import Named
from grader.base.source import Location, Source
from grader.base.text import last_part
from grader.ros.known.package_tables import python_table
from grader.ros.nodes.node_facts import FieldUse, RclpyObject, TypeImport
from grader.ros.python.bindings import names_bound
from grader.ros.python.constants import (
    count_bound,
    count_stored,
    dotted,
    last_name,
    make_order,
)
from grader.ros.python.parse import (
    AnyFunction,
    Code,
    Position,
    caught_by,
    end_position,
    location_in,
    make_position,
    name_position,
    own_parameters,
)
from grader.ros.python.values import SCALARS, QualifiedName, Scope, Value
from grader.ros.python.walking import children, walk

_ValueOf = Callable[[ast.expr, Scope], Value]

_SCOPES = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
_KINDS = ("msg", "srv", "action")
_CAUGHT = frozenset(
    {"AttributeError", "ImportError", "ModuleNotFoundError", "TypeError", "Exception", ""}
)
# Functions that ask what a value is, or has.
_ASKING = frozenset({"isinstance", "hasattr", "getattr", "setattr", "type"})
_MAX_PATH = 12
_MAX_ITEMS = 100  # of a list that a field is set to
ITEM = "[]"  # in a path: an item of a list
# What methods of a node return, and now() of its clock; and what gives the value of a message.
_GET = "self.get_parameter"
_RETURNED = {
    _GET: "rclpy.parameter.Parameter",
    "self.declare_parameter": "rclpy.parameter.Parameter",
    "self.get_clock": "rclpy.clock.Clock",
    "self.get_logger": "rclpy.impl.rcutils_logger.RcutilsLogger",
}
_TIME = "rclpy.time.Time"
_NOW = {"rclpy.clock.Clock": _TIME}
# Objects whose attributes are known.
_WITH_MEMBERS = frozenset({_TIME, *_RETURNED.values()}) - {*_NOW}
_ORDERS = (ast.Lt, ast.LtE, ast.Gt, ast.GtE)  # == and != take any objects
_OF_NUMBERS = ("abs", "round", "int", "float", "range", "self.create_timer")
_LACKS = {"rclpy.parameter.Parameter": ".value", _TIME: ".to_msg()"}


class _Typed(Named):
    """A value: a field of what has a type, or this itself.

    The type has the name of its section: chat_msgs.srv.Ask.Request.
    """

    type: str
    path: Strings = ()


class CodePart(Named):
    """A function or method, or the module without these.

    It has its calls, its scope and the place of its class.
    """

    name: str
    node: AnyFunction | ast.Module
    calls: Sequence[ast.Call]
    scope: Scope
    of: Location | None = None


Evaluate = Callable[[ast.expr], Value]
ClassesByLocation = Mapping[Location, ast.ClassDef]
FunctionKey = tuple[Location | None, str]  # the class and the name of a function


def _interface_name(value: Value) -> str | None:
    """Return the full name of a type of a message, service or action, or of a section of one.

    The result is None for what is none.
    """
    if not isinstance(value, QualifiedName):
        return None
    parts = value.name.split(".")
    is_type = len(parts) in (3, 4) and parts[1] in _KINDS and parts[2][:1].isupper()
    is_type = is_type and parts[0] != "rclpy"  # whose module action has other classes
    return value.name if is_type else None


def type_imports(tree: ast.Module, source: Source) -> Iterator[TypeImport]:
    """Yield the types that a file certainly imports: not in a try, nor under a condition."""
    pending = list(tree.body)
    while pending:
        statement = pending.pop()
        match statement:
            case ast.ImportFrom(module=str(module), names=names, level=0):
                _, _, kind = module.partition(".")
                for alias in names if kind in _KINDS and module != "rclpy.action" else ():
                    if alias.name != "*":
                        at = location_in(source, make_position(alias))
                        yield TypeImport(f"{module}.{alias.name}", at)
            case ast.FunctionDef(body=body) | ast.AsyncFunctionDef(body=body):
                pending += body
            case ast.ClassDef(body=body) | ast.With(body=body) | ast.For(body=body):
                pending += body


class _Callback(Named):
    """Which arguments of a function are the type and the callback, and what that is given.

    The callback is given sections of the type.
    """

    type_at: int
    type_name: str
    callback_at: int
    callback_name: str
    sections: Strings


_CALLBACKS = {
    "create_subscription": _Callback(0, "msg_type", 2, "callback", ("",)),
    "create_service": _Callback(0, "srv_type", 2, "callback", (".Request", ".Response")),
    "ActionServer": _Callback(1, "action_type", 3, "execute_callback", (".GoalHandle",)),
}


def field_uses(
    code: Code,
    parts: Sequence[CodePart],
    value_of: _ValueOf,
    node_classes: Collection[Location],
) -> Iterator[FieldUse]:
    """Yield the fields that the functions of a module use.

    `node_classes` are where its classes are that have the methods of rclpy's nodes.
    """
    nodes = code.nodes
    stored = _count_bindings(nodes)
    given = _types_given(parts, nodes, value_of)
    functions = []
    own_names = {*stored}.union(part.name for part in parts)
    has_others = any(name.removeprefix("self.") in own_names for name in _RETURNED)
    for part in parts:
        evaluate = partial(_value_in, part.scope, value_of)
        key = f"self.{part.name}" if part.of else part.name
        is_node = part.of in node_classes and not has_others
        types = given.get((part.of, key), ())
        functions.append((part, _FunctionUses(part.node, evaluate, types, is_node=is_node)))
    shared: dict[Location | None, dict[str, _Typed]] = {None: {}}
    for part, function in functions:
        for name, typed in function.kept(is_module=isinstance(part.node, ast.Module)):
            if stored[name.removeprefix("self.")] == 1:
                of = part.of if name.startswith("self.") else None
                shared.setdefault(of, {})[name] = typed
    for part, function in functions:
        function.know({**shared[None], **shared.get(part.of, {})})
        for use in function.uses():
            yield use.placed(code.source)


def _count_bindings(nodes: Sequence[ast.AST]) -> Counter[str]:
    """Return how often names, parameters and attributes are bound, wherever it is."""
    return count_bound(nodes) + Counter(node.arg for node in nodes if isinstance(node, ast.arg))


def _value_in(scope: Scope, value_of: _ValueOf, node: ast.expr) -> Value:
    return value_of(node, scope)


def _types_given(
    parts: Sequence[CodePart],
    nodes: Sequence[ast.AST],
    value_of: _ValueOf,
) -> dict[FunctionKey, Strings]:
    """Return what functions are called with that are named only where they become callbacks.

    The keys are the places of their classes and their names.
    """
    named = _count_uses(nodes)
    types_by_name: dict[FunctionKey, list[Strings]] = {}
    for part in parts:
        bound = _names_inside(part)
        for call in part.calls:
            callback = _typed_callback(call, part.scope, value_of)
            if callback is not None and callback[0] not in bound:
                name, types = callback
                of = part.of if name.startswith("self.") else None
                types_by_name.setdefault((of, name), []).append(types)
    return {
        key: types_of_each[0]
        for key, types_of_each in types_by_name.items()
        if {*types_of_each} == {types_of_each[0]} and named[key[1]] == len(types_of_each)
    }


def _names_inside(part: CodePart) -> set[str]:
    """Return the names that a function, or one in it, binds; none of a module."""
    return names_bound(walk(part.node)) - {part.name} if part.name else set()


def _count_uses(nodes: Iterable[ast.AST]) -> Counter[str]:
    """Return how often names and attributes are read."""
    return Counter(
        dotted(node)
        for node in nodes
        if isinstance(node, ast.Name | ast.Attribute) and isinstance(node.ctx, ast.Load)
    )


def _typed_callback(call: ast.Call, scope: Scope, value_of: _ValueOf) -> tuple[str, Strings] | None:
    """Return the name of the callback that a call registers, and the types that it is given.

    There are no types where the type of the call is not known.
    """
    row = _CALLBACKS.get(last_name(call.func))
    if not row:
        return None
    callback = given_argument(call, row.callback_at, row.callback_name)
    made = given_argument(call, row.type_at, row.type_name)
    if callback is None or made is None:
        return None
    kind = _interface_name(value_of(made, scope))
    types = tuple(f"{kind}{section}" for section in row.sections) if kind else ()
    return dotted(callback), types


def given_argument(call: ast.Call, position: int, name: str) -> ast.expr | None:
    """Return the expression of an argument; None where it is missing, or may be unpacked."""
    for keyword in call.keywords:
        if keyword.arg == name:
            return keyword.value
    if position < len(call.args) and not any(
        isinstance(argument, ast.Starred) for argument in call.args
    ):
        return call.args[position]
    return None


class _PlacedUse(Named):
    """The use of a field, at the name of the field in a file that is given later."""

    type: str
    path: Strings
    at: Position
    literal: tuple[Value, ...] = ()
    rclpy: tuple[str, Position] | None = None  # the type of an object of rclpy, and its end

    def placed(self, source: Source) -> FieldUse:
        instead = None
        if self.rclpy is not None:
            full, end = self.rclpy
            name = last_part(full)
            is_whole = not self.type.startswith("rclpy.") or self.path == ("value",)
            lacks = _LACKS.get(full, "") if is_whole else ""
            instead = RclpyObject(name, lacks, location_in(source, end))
        at = location_in(source, self.at)
        return FieldUse(self.type, self.path, at, self.literal, instead)


class _FunctionUses:
    """The fields that one function uses of values whose type is certain."""

    def __init__(
        self,
        function: AnyFunction | ast.Module,
        evaluate: Evaluate,
        given: Sequence[str],
        *,
        is_node: bool,
    ) -> None:
        """`given` are the types of the arguments after self; `is_node`: self is a node of rclpy."""
        self._evaluate = evaluate
        self._is_node = is_node
        self._nodes = sorted(certain_nodes(function), key=make_order)
        self._counts = count_stored(walk(function))
        for node in walk(function):
            match node:
                case ast.ExceptHandler(name=str(name)) | ast.MatchAs(name=str(name)):
                    self._counts[name] += 1
                case ast.Global(names=names) | ast.Nonlocal(names=names):
                    self._counts.update(names + names)
        self._types: dict[str, _Typed] = {}
        self._asked = {*_asked(self._nodes)}
        self._bind_arguments(function, given)
        self._bind_assigned()

    def _bind_arguments(self, function: ast.AST, given: Sequence[str]) -> None:
        if isinstance(function, AnyFunction):
            for name, kind in zip(own_parameters(function), given, strict=False):
                if kind and self._counts[name] == 1 and name not in self._asked:
                    self._types[name] = _Typed(kind)

    def _bind_assigned(self) -> None:
        """Bind the names that are assigned once, in the order of the lines."""
        for node in self._nodes:
            match node:
                case (
                    ast.Assign(targets=[target], value=value)
                    | ast.AnnAssign(target=target, value=ast.expr() as value)
                ):
                    typed = self._find_type(value)
                case ast.For(target=target, iter=items):
                    listed = self._find_type(items)
                    typed = listed and listed._replace(path=(*listed.path, ITEM))
                case _:
                    continue
            name = dotted(target)
            is_bound = name.count(".") < 2 and self._counts[name] == 1
            if typed and name and is_bound and name not in self._asked:
                self._types[name] = typed

    def kept(self, *, is_module: bool) -> Iterator[tuple[str, _Typed]]:
        """Yield what other functions can use: attributes of self, and the names of a module."""
        for name, typed in self._types.items():
            if name.startswith("self.") or is_module:
                yield name, typed

    def know(self, shared: Mapping[str, _Typed]) -> None:
        """Add names that other functions bind."""
        for name, typed in shared.items():
            if self._counts[name] == 0 and name not in self._asked:
                self._types[name] = typed

    def _find_type(self, node: ast.expr) -> _Typed | None:
        """Return what an expression is; None where this is not certain."""
        path: list[str] = []
        name = dotted(node)
        while len(path) < _MAX_PATH:
            if name in self._types:
                typed = self._types[name]
                return typed._replace(path=(*typed.path, *reversed(path)))
            match node:
                case ast.Attribute(value=inner, attr=attribute):
                    path.append(attribute)
                    node = inner
                    name = name.rpartition(".")[0]
                case ast.Subscript(value=inner, slice=index) if not isinstance(index, ast.Slice):
                    path.append(ITEM)
                    node = inner
                    name = dotted(inner)
                case ast.Call(func=made):
                    kind = self._type_returned(made)
                    return _Typed(kind, tuple(reversed(path))) if kind is not None else None
                case _:
                    return None
        return None

    def _type_returned(self, function: ast.expr) -> str | None:
        """Return the type of what a function returns that is called; None if it is not known."""
        name = dotted(function)
        if self._is_node and name in _RETURNED:
            return _RETURNED[name]
        if isinstance(function, ast.Attribute) and function.attr == "now":
            owner = self._find_type(function.value)
            return _NOW.get(owner.type) if owner and not owner.path else None
        return _interface_name(self._evaluate(function)) if name else None

    def uses(self) -> Iterator[_PlacedUse]:
        """Yield the fields that are used, each with the value that it is set to."""
        values = {}
        for node in self._nodes:
            match node:
                case ast.Assign(targets=[ast.Attribute() as target], value=value):
                    values[target] = value
                case ast.Attribute():
                    yield from self._uses_of_attribute(node, values.get(node))
                case ast.Call():
                    yield from self._uses_in_call(node)
            operands = _operands(node)
            for operand in operands:
                yield from self._uses_as_number(operand)
            if len(operands) > 1:
                yield from self._uses_with_time(operands)

    def _uses_with_time(self, operands: Sequence[ast.expr]) -> Iterator[_PlacedUse]:
        """Yield a field of a message or a number that is computed with a Time of rclpy."""
        types = [self._find_type(operand) for operand in operands]
        if _Typed(_TIME) not in types:
            return
        for operand, typed in zip(operands, types, strict=True):
            is_field = typed is not None and bool(typed.path) and typed.type not in _LACKS
            if is_field or type(getattr(operand, "value", None)) in (int, float):
                at = make_position(operand)
                yield _PlacedUse(_TIME, ("from_msg",), at, rclpy=(_TIME, at))

    def _uses_as_number(self, operand: ast.expr) -> Iterator[_PlacedUse]:
        """Yield the use of a parameter in place of its value, as the path of this."""
        typed = self._find_type(operand)
        if typed and typed.type == _RETURNED[_GET] and not typed.path:
            yield self._with_value(
                _PlacedUse(typed.type, ("value",), make_position(operand)), operand
            )

    def _uses_of_attribute(
        self, node: ast.Attribute, value: ast.expr | None
    ) -> Iterator[_PlacedUse]:
        """Yield the use of a field, or of a constant, that an attribute is."""
        typed = self._find_type(node.value)
        if typed and typed.type in _WITH_MEMBERS and not typed.path:
            yield from self._unknown_member(node, typed.type)
        if not typed and node.attr.isupper() and dotted(node.value):
            kind = _interface_name(self._evaluate(node.value))  # a constant of a type
            typed = _Typed(kind) if kind is not None else None
        if typed and not typed.type.startswith("rclpy."):
            path = (*typed.path, node.attr)
            yield self._with_value(_PlacedUse(typed.type, path, name_position(node)), value)

    def _unknown_member(self, node: ast.Attribute, kind: str) -> Iterator[_PlacedUse]:
        """Yield the use of an attribute that an object of rclpy does not have."""
        known = python_table().members[last_part(kind)]
        if isinstance(node.ctx, ast.Load) and node.attr not in known:
            rclpy = (kind, end_position(node))
            yield _PlacedUse(kind, (node.attr,), name_position(node), rclpy=rclpy)

    def _uses_in_call(self, call: ast.Call) -> Iterator[_PlacedUse]:
        """Yield the fields that the keywords of a constructor set."""
        if not call.keywords or not dotted(call.func):
            return
        kind = _interface_name(self._evaluate(call.func))
        if kind is None:
            return
        for keyword in call.keywords:
            if keyword.arg not in (None, "check_fields"):
                use = _PlacedUse(kind, (keyword.arg or "",), make_position(keyword))
                yield self._with_value(use, keyword.value)

    def _with_value(self, use: _PlacedUse, node: ast.expr | None) -> _PlacedUse:
        """Return the use of a field with the value that it is set to, as far as it is known."""
        typed = self._find_type(node) if node else None
        if not node or (typed and typed.type not in _LACKS):
            return use
        if not typed:
            return use._replace(literal=self._literal(node))
        return use if typed.path else use._replace(rclpy=(typed.type, end_position(node)))

    def _literal(self, node: ast.expr) -> tuple[Value, ...]:
        value = self._evaluate(node)
        if value is None or isinstance(value, SCALARS):
            return (value,)
        if isinstance(value, list | tuple) and len(value) <= _MAX_ITEMS:
            return (list(value),)
        return ()


def _operands(node: ast.AST) -> Sequence[ast.expr]:
    """Return what has to be a number for Python to compute a node; a text with % takes any."""
    match node:
        case ast.BinOp(left=left, op=operator, right=right) if not isinstance(operator, ast.Mod):
            return (left, right)
        case ast.Compare(left=left, ops=operators, comparators=others):
            return (left, *others) if all(isinstance(each, _ORDERS) for each in operators) else ()
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return (operand,)
        case ast.Call(func=function, args=[operand, *_]) if dotted(function) in _OF_NUMBERS:
            return (operand,)
    return ()


def _asked(nodes: Sequence[ast.AST]) -> Iterator[str]:
    """Yield the names of values whose type or attributes a function asks for."""
    for node in nodes:
        match node:
            case ast.Call(func=ast.Name(id=name), args=[first, *_]) if name in _ASKING:
                yield dotted(first)
            case ast.Match(subject=subject):
                yield dotted(subject)


def certain_nodes(function: ast.AST) -> Iterator[ast.AST]:
    """Yield the nodes of a function, or of a module without its functions and classes.

    Nodes of which errors are caught are not among them.
    """
    pending = [function]
    while pending:
        node = pending.pop()
        yield node
        match node:
            case ast.Try(handlers=handlers, orelse=orelse, finalbody=final) if _catches(handlers):
                pending += [*handlers, *orelse, *final]
            case ast.Module(body=body):
                pending += [statement for statement in body if not isinstance(statement, _SCOPES)]
            case ast.With(items=items) | ast.AsyncWith(items=items) if suppresses(items):
                continue
            case _:
                pending += children(node)


def suppresses(items: Sequence[ast.withitem]) -> bool:
    """Return whether a with statement may keep errors in it from stopping the program."""
    calls = [getattr(item.context_expr, "func", item.context_expr) for item in items]
    return any("suppress" in dotted(call) or "raises" in dotted(call) for call in calls)


def _catches(handlers: Sequence[ast.ExceptHandler]) -> bool:
    """Return whether a handler may catch that a field or type does not exist."""
    for handler in handlers:
        if any(not kind or last_part(dotted(kind)) in _CAUGHT for kind in caught_by(handler)):
            return True
    return False
