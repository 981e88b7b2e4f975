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
        case BoundMethod(owner=Call() as owner, name=name):
            call.name, call.owner = f"{owner.name}.{name}", owner
            if call.name not in evaluation.functions:
                owner.method_calls.append(call)
        case BoundMethod(owner=owner, name=name):
            return call_method(evaluation, owner, name, call)
        case _:
            if kind := type_name(function):
                evaluation.error(f"{kind} cannot be called: is there a comma missing before it?", call.at)
            return Unknown("this call is not supported", call.at)
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
        if isinstance(value, str | list | tuple | dict) and not isinstance(node, ast.Subscript):
            self.step(len(value) // 64)  # a large value takes time to make
        return value

    def evaluate_kind(self, node: ast.expr, scope: Scope) -> Value:
        """Return the value of an expression, without the checks of `evaluate`."""
        at = position_of(node)
        match node:
            case ast.Attribute(value=owner, attr=name):
                return attribute(self, self.evaluate(owner, scope), name, at)
            case ast.Call():
                return self._call(node, scope)
            case ast.List(elts=elements):
                return self._elements(elements, scope)
            case ast.Tuple(elts=elements):
                return tuple(self._elements(elements, scope))
            case ast.Set(elts=elements):
                return self.make_set(self._elements(elements, scope), at)
            case ast.Dict():
                return self._dict(node, scope)
            case ast.JoinedStr(values=pieces):
                return self._f_string(pieces, scope, at)
            case ast.BinOp(left=left, op=op, right=right):
                return operate(self, op, self.evaluate(left, scope), self.evaluate(right, scope), at)
            case ast.BoolOp(op=op, values=operands):
                return self._bool_op(op, operands, scope, at)
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                condition = truth(self.evaluate(operand, scope))
                return Unknown(_RUN_TIME, at) if condition is None else not condition
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                number = self.evaluate(operand, scope)
                return -number if isinstance(number, int | float) else Unknown("this is not a number", at)
            case ast.Compare(left=left, ops=ops, comparators=comparators):
                first, *others = [self.evaluate(operand, scope) for operand in (left, *comparators)]
                return compare(self, ops[0], first, others[0], at) if len(others) == 1 else Unknown(_RUN_TIME, at)
            case ast.IfExp(test=test, body=body, orelse=other):
                condition = truth(self.evaluate(test, scope))
                if condition is None:
                    return Unknown("it depends on a condition that is known only at run time", at)
                return self.evaluate(body if condition else other, scope)
            case ast.Subscript(value=owner, slice=key):
                value = self.evaluate(owner, scope)
                return subscript(self, value, self.key(key, scope), at) if not isinstance(value, Unknown) else value
            case ast.Starred(value=expression) | ast.Await(value=expression):
                return self.evaluate(expression, scope)
            case _:
                return Unknown("an expression of this kind is not supported", at)

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

    def _f_string(self, pieces: list[ast.expr], scope: Scope, at: Position) -> Value:
        text = ""
        for piece in pieces:
            if isinstance(piece, ast.Constant):
                text += str(piece.value)
                continue
            if not isinstance(piece, ast.FormattedValue):
                return Unknown("an expression of this kind is not supported", at)
            value = self.evaluate(piece.value, scope)
            if isinstance(value, Unknown):
                return value
            plain = as_text(value)
            if plain is None or piece.format_spec is not None or piece.conversion not in (-1, ord("s")):
                return Unknown("a format of this kind is not supported", at)
            text += plain
            if len(text) > MAX_TEXT:
                return Unknown("a value grows too long", at)
        return text

    def _bool_op(self, op: ast.boolop, operands: list[ast.expr], scope: Scope, at: Position) -> Value:
        value: Value = None
        for operand in operands:
            value = self.evaluate(operand, scope)
            condition = truth(value)
            if condition is None:
                return Unknown(_RUN_TIME, at)
            if condition != isinstance(op, ast.And):
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
        is_unpacked = any(isinstance(argument, ast.Starred) for argument in node.args)
        if is_unpacked and isinstance(function, Function) and unknown_in(call.args) is not None:
            return Unknown("the unpacked arguments are known only at run time", call.at)
        return call_value(self, function, call)
