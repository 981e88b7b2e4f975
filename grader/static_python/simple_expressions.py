"""The values of expressions that bind no names: operators, attributes, calls, literals."""

import ast
from pathlib import PurePosixPath
from typing import Any

from grader.static_python.evaluation import Evaluation
from grader.static_python.methods import attribute, call_method
from grader.static_python.operators import compare, extend, operate, subscript, type_name
from grader.static_python.parse import Position, position_of
from grader.static_python.values import (
    MAX_TEXT,
    UNKNOWN_KEYS,
    BoundMethod,
    Call,
    Function,
    QualifiedName,
    Scope,
    Unknown,
    Value,
    as_text,
    size,
    truth,
    unknown_in,
)

_BINDS_NAMES = ("builtins.exec", "builtins.globals", "builtins.locals", "builtins.vars")
_RUN_TIME = "its value is known only at run time"
_SIZED = (str, list, tuple, dict)


def call_value(evaluation: Evaluation, function: Value, call: Call) -> Value:
    """Return the value of a call of any value. The call gets its name here; one that is not evaluated is recorded."""
    match function:
        case Unknown():
            evaluation.may_have_failed = True
            return function
        case Function():
            return evaluation.call_function(function, call)
        case QualifiedName(name=name):
            if name == "glob":
                evaluation.error("glob is a module here and cannot be called: write glob.glob(...)", call.at)
            call.name = "glob.glob" if name in ("glob", "?glob") else name
            return _call_by_name(evaluation, call)
        case BoundMethod(owner=Call() as owner, name=name):
            call.name, call.owner = f"{owner.name}.{name}", owner
            if call.name not in evaluation.functions:
                owner.method_calls.append(call)
            return _call_by_name(evaluation, call)
        case BoundMethod(owner=owner, name=name):
            return call_method(evaluation, owner, name, call)
    if kind := type_name(function):
        evaluation.error(f"{kind} cannot be called: is there a comma missing before it?", call.at)
    return Unknown("this call is not supported", call.at)


def _call_by_name(evaluation: Evaluation, call: Call) -> Value:
    evaluate = evaluation.functions.get(call.name)
    if evaluate is not None:
        return evaluate(evaluation, call)
    if call.name in _BINDS_NAMES:
        evaluation.module.names["*"] = Unknown("names may be bound here", call.at)
    return evaluation.record(call)


class SimpleEvaluator(Evaluation):
    """An evaluator of expressions, with a table of functions."""

    def evaluate(self, node: ast.expr, scope: Scope) -> Value:
        """Return the value of an expression; Unknown, with the reason, where it cannot be determined."""
        self.step()
        if isinstance(node, ast.Constant):
            return node.value
        if isinstance(node, ast.Name):
            return self.find(node, scope)
        value = self.evaluate_kind(node, scope)
        if isinstance(value, _SIZED) and not isinstance(node, ast.Subscript):
            self.step(len(value) // 64)  # a large value takes time to make
        return value

    def evaluate_kind(self, node: ast.expr, scope: Scope) -> Value:
        """Return the value of an expression, without the checks of `evaluate`."""
        kind = getattr(self, f"_{type(node).__name__.lower()}", None)
        return kind(node, scope) if kind else Unknown("an expression of this kind is not supported", position_of(node))

    def _attribute(self, node: ast.Attribute, scope: Scope) -> Value:
        return attribute(self, self.evaluate(node.value, scope), node.attr, position_of(node))

    def _list(self, node: ast.List, scope: Scope) -> Value:
        return self._elements(node.elts, scope)

    def _tuple(self, node: ast.Tuple, scope: Scope) -> Value:
        return tuple(self._elements(node.elts, scope))

    def _set(self, node: ast.Set, scope: Scope) -> Value:
        return self.make_set(self._elements(node.elts, scope), position_of(node))

    def _binop(self, node: ast.BinOp, scope: Scope) -> Value:
        left, right = self.evaluate(node.left, scope), self.evaluate(node.right, scope)
        return operate(self, node.op, left, right, position_of(node))

    def _unaryop(self, node: ast.UnaryOp, scope: Scope) -> Value:
        at, value = position_of(node), self.evaluate(node.operand, scope)
        match node.op:
            case ast.Not():
                condition = truth(value)
                return Unknown(_RUN_TIME, at) if condition is None else not condition
            case ast.USub():
                return -value if isinstance(value, int | float) else Unknown("this is not a number", at)
        return Unknown("an expression of this kind is not supported", at)

    def _compare(self, node: ast.Compare, scope: Scope) -> Value:
        at = position_of(node)
        first, *others = [self.evaluate(operand, scope) for operand in (node.left, *node.comparators)]
        return compare(self, node.ops[0], first, others[0], at) if len(others) == 1 else Unknown(_RUN_TIME, at)

    def _ifexp(self, node: ast.IfExp, scope: Scope) -> Value:
        condition = truth(self.evaluate(node.test, scope))
        if condition is None:
            return Unknown("it depends on a condition that is known only at run time", position_of(node))
        return self.evaluate(node.body if condition else node.orelse, scope)

    def _subscript(self, node: ast.Subscript, scope: Scope) -> Value:
        owner = self.evaluate(node.value, scope)
        if isinstance(owner, Unknown):
            return owner
        return subscript(self, owner, self.key(node.slice, scope), position_of(node))

    def _starred(self, node: ast.Starred | ast.Await, scope: Scope) -> Value:
        return self.evaluate(node.value, scope)

    _await = _starred

    def key(self, key: ast.expr, scope: Scope) -> Value:
        """Return the value of a subscript's key, which may be a slice."""
        if not isinstance(key, ast.Slice):
            return self.evaluate(key, scope)
        return slice(*(self.evaluate(bound, scope) if bound else None for bound in (key.lower, key.upper, key.step)))

    def make_set(self, values: list[Value], at: Position) -> Value:
        """Return the value of a set with these values."""
        return call_value(self, QualifiedName("builtins.set"), Call("", [values], {}, at))

    def _elements(self, nodes: list[ast.expr], scope: Scope) -> list[Value]:
        values: list[Value] = []
        for node in nodes:
            value = self.evaluate(node, scope)
            if isinstance(node, ast.Starred):
                extend(self, values, value, position_of(node))
            else:
                values.append(value)
        return values

    def _dict(self, node: ast.Dict, scope: Scope) -> Value:
        table: dict[Any, Value] = {}
        for key_node, value_node in zip(node.keys, node.values, strict=True):
            value = self.evaluate(value_node, scope)
            if key_node is None:
                if not isinstance(value, dict):
                    return Unknown("the unpacked dict is known only at run time", position_of(value_node))
                table |= value
                continue
            key = self.evaluate(key_node, scope)
            if isinstance(key, Unknown):
                return key
            if not isinstance(key, str | int | float | PurePosixPath | None) or key == UNKNOWN_KEYS:
                return Unknown("a key of this kind is not supported", position_of(key_node))
            table[key] = value
        return table

    def _joinedstr(self, node: ast.JoinedStr, scope: Scope) -> Value:
        text = ""
        for piece in node.values:
            value = self.evaluate(piece, scope)
            if isinstance(value, Unknown):
                return value
            text += str(value)
            if len(text) > MAX_TEXT:
                return Unknown("a value grows too long", position_of(node))
        return text

    def _formattedvalue(self, node: ast.FormattedValue, scope: Scope) -> Value:
        value = self.evaluate(node.value, scope)
        plain = as_text(value)
        if isinstance(value, Unknown):
            return value
        if plain is None or node.format_spec is not None or node.conversion not in (-1, ord("s")):
            return Unknown("a format of this kind is not supported", position_of(node))
        return plain

    def _boolop(self, node: ast.BoolOp, scope: Scope) -> Value:
        value: Value = None
        for operand in node.values:
            value = self.evaluate(operand, scope)
            condition = truth(value)
            if condition is None:
                return Unknown(_RUN_TIME, position_of(node))
            if condition != isinstance(node.op, ast.And):
                break
        return value

    def _call(self, node: ast.Call, scope: Scope) -> Value:
        function = self.evaluate(node.func, scope)
        call = Call("", self._elements(node.args, scope), {}, position_of(node))
        for keyword in node.keywords:
            value = self.evaluate(keyword.value, scope)
            if keyword.arg is not None:
                call.kwargs[keyword.arg] = value
            elif isinstance(value, dict):
                call.kwargs |= {key: item for key, item in value.items() if isinstance(key, str)}
            else:
                call.kwargs[UNKNOWN_KEYS] = Unknown("the unpacked arguments are known only at run time", call.at)
        self.step(size([call.args, list(call.kwargs.values())]) // 32)
        is_vague = isinstance(function, Function) and unknown_in(call.args) is not None
        if is_vague and any(isinstance(argument, ast.Starred) for argument in node.args):
            return Unknown("the unpacked arguments are known only at run time", call.at)
        return call_value(self, function, call)
