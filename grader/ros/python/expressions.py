"""The value of an expression: Python's own, from an allow-list.

It either is Python's value, or Python certainly raises an error, or it cannot be determined
statically. Nothing outside of the allow-list is reached. `files` adds what an expression in a file
can do besides.
"""

import ast
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import lru_cache
from typing import Any, ClassVar

from grader.ros.python.budget import Budget
from grader.ros.python.builtins import call, truth
from grader.ros.python.operators import attribute, compare, operate, subscript
from grader.ros.python.parse import SyntaxFault, parse_expression
from grader.ros.python.values import (
    EvaluationFails,
    InnerScope,
    Items,
    Scope,
    Undetermined,
    Value,
    call_plain,
)

_MAX_LENGTH = 4_000  # characters of an expression
_MAX_KEPT = 200  # characters of an expression that is kept once it is parsed
_OF_NODE = 2  # what evaluating a part of an expression is charged


def evaluate(text: str, find: Callable[[str], Value], budget: Budget) -> Value:
    """Return the value of an expression.

    `find` returns the value of a name, and raises as this function does.

    Raises EvaluationFails where Python raises an error, Undetermined where the value cannot be
    determined, OutOfBudget.
    """
    text = text.strip()
    if len(text) > _MAX_LENGTH:
        raise Undetermined("the expression is too long")
    budget.charge(len(text))
    node = parse_expression(text) if len(text) > _MAX_KEPT else _kept(text)
    if isinstance(node, SyntaxFault):
        raise EvaluationFails(node.message) if node.is_certain else Undetermined(node.message)
    try:
        return Expressions(find, budget).value(node, Scope({}))
    except (RecursionError, MemoryError):
        raise Undetermined("the expression is nested too deeply") from None


_kept = lru_cache(1_000)(parse_expression)
# What makes a value that no function has measured yet.
_MAKES_VALUES = frozenset(
    {ast.Constant, ast.UnaryOp, ast.List, ast.Tuple, ast.ListComp, ast.Set, ast.Dict}
)


class Expressions:
    """An evaluator of expressions.

    `find` returns the value of a name that no comprehension binds.
    """

    def __init__(self, find: Callable[[str], Value], budget: Budget) -> None:
        self._find = find
        self.budget = budget

    def value(self, node: ast.expr, scope: Scope) -> Value:
        """Return the value of an expression; `scope` has the names that comprehensions bind."""
        self.budget.charge(_OF_NODE)
        kind = self.KINDS.get(type(node))
        if kind is None:
            raise Undetermined("an expression of this kind is not supported")
        value = kind(self, node, scope)
        if type(node) in _MAKES_VALUES:
            return self.budget.checked(value)
        return value

    evaluate = value  # of a part of an expression: in a file, it may be Unknown

    def _constant(self, node: ast.Constant, scope: Scope) -> Value:
        del scope
        return node.value

    def _name(self, node: ast.Name, scope: Scope) -> Value:
        if node.id.startswith("__"):
            raise EvaluationFails(
                f"names that begin with two underscores are not allowed: {node.id}"
            )
        try:
            return scope.find(node.id)
        except KeyError:
            return self._find(node.id)

    def _binop(self, node: ast.BinOp, scope: Scope) -> Value:
        left = self.evaluate(node.left, scope)
        right = self.evaluate(node.right, scope)
        return operate(node.op, left, right, self.budget)

    def _ifexp(self, node: ast.IfExp, scope: Scope) -> Value:
        holds = self.test(self.evaluate(node.test, scope), [node.body, node.orelse])
        return self.evaluate(node.body if holds else node.orelse, scope)

    def _attribute(self, node: ast.Attribute, scope: Scope) -> Value:
        return attribute(self.evaluate(node.value, scope), node.attr, self.budget)

    def _subscript(self, node: ast.Subscript, scope: Scope) -> Value:
        return self.item(self.evaluate(node.value, scope), self.key(node.slice, scope), node)

    def item(self, owner: Value, key: Value, node: ast.expr) -> Value:
        """Return the value of owner[key]."""
        del node
        return subscript(owner, key, self.budget)

    def _unaryop(self, node: ast.UnaryOp, scope: Scope) -> Value:
        if type(node.op) not in _UNARY:
            raise Undetermined("an expression of this kind is not supported")
        operand = self.evaluate(node.operand, scope)
        if not isinstance(node.op, ast.Not):
            self.budget.measure(operand)
        return call_plain(_UNARY[type(node.op)], operand)

    def elements(
        self, nodes: list[ast.expr], scope: Scope, *, is_call: bool = False
    ) -> list[Value]:
        """Return the values of the elements of a list, or of the arguments of a call."""
        del is_call
        return [self.evaluate(element, scope) for element in nodes]

    def _list(self, node: ast.List, scope: Scope) -> Value:
        return self.elements(node.elts, scope)

    def _tuple(self, node: ast.Tuple, scope: Scope) -> Value:
        return tuple(self.elements(node.elts, scope))

    def _listcomp(self, node: ast.ListComp, scope: Scope) -> Value:
        return [
            self.evaluate(node.elt, inner)
            for inner in self.rounds(node.generators, InnerScope({}, scope))
        ]

    def _generatorexp(self, node: ast.GeneratorExp, scope: Scope) -> Value:
        """Return a generator.

        The items of its first loop are evaluated now, the rest when it is iterated.
        """
        first = self.budget.items(self.evaluate(node.generators[0].iter, scope))
        rounds = self.rounds(node.generators, InnerScope({}, scope), first)
        return Items(self.evaluate(node.elt, inner) for inner in rounds)

    def _compare(self, node: ast.Compare, scope: Scope) -> Value:
        left = self.evaluate(node.left, scope)
        for op, comparator in zip(node.ops, node.comparators, strict=True):
            right = self.evaluate(comparator, scope)
            if not compare(op, left, right, self.budget):
                return False
            left = right
        return True

    def _boolop(self, node: ast.BoolOp, scope: Scope) -> Value:
        value = None
        for index, operand in enumerate(node.values, 1):
            value = self.evaluate(operand, scope)
            others = node.values[index:]
            if not others or self.test(value, others) != isinstance(node.op, ast.And):
                break
        return value

    def test(self, value: Value, branches: Sequence[ast.expr]) -> bool:
        """Return whether a condition holds, which decides which of the branches are evaluated."""
        del branches
        return truth(value)

    def key(self, key: ast.expr, scope: Scope) -> Value:
        """Return the value of a subscript's key, which may be a slice."""
        if not isinstance(key, ast.Slice):
            return self.evaluate(key, scope)
        bounds = [
            None if not bound else self.evaluate(bound, scope)
            for bound in (key.lower, key.upper, key.step)
        ]
        self.budget.measure(bounds)
        return slice(*bounds)

    def _call(self, node: ast.Call, scope: Scope) -> Value:
        function = self.evaluate(node.func, scope)
        args = self.elements(node.args, scope, is_call=True)
        kwargs: dict[str, Value] = {}
        for keyword in node.keywords:
            if keyword.arg is None:
                self.unpack(kwargs, self.evaluate(keyword.value, scope), keyword.value)
                continue
            if keyword.arg in kwargs:
                raise EvaluationFails(f"SyntaxError: keyword argument repeated: {keyword.arg}")
            kwargs[keyword.arg] = self.evaluate(keyword.value, scope)
        return self.called(function, args, kwargs, node)

    def unpack(self, _: dict[str, Value], __: Value, ___: ast.expr) -> None:
        """Add the arguments that ** unpacks."""
        raise Undetermined("arguments with ** are not supported")

    def called(
        self, function: Value, args: list[Value], kwargs: dict[str, Value], node: ast.expr
    ) -> Value:
        """Return the value of a call of a value."""
        return call(
            function,
            args,
            kwargs,
            self.budget,
            lambda inner, items: self.called(inner, items, {}, node),
        )

    def rounds(
        self,
        loops: Sequence[ast.comprehension],
        scope: Scope,
        first: Iterator[Value] | None = None,
        depth: int = 0,
    ) -> Iterator[Scope]:
        """Yield the scope once for each round of nested loops, charged by depth.

        Each loop around passes them on.

        `first` are the items of the first loop, if they are evaluated already.
        """
        if not loops:
            yield scope
            return
        loop, *nested = loops
        if first is None:
            outer = scope if depth else scope.outer or scope
            first = self.budget.items(self.budget.checked(self.evaluate(loop.iter, outer)))
        for item in first:
            self.budget.charge(_OF_NODE + len(scope.names) + depth)
            self.bind(loop.target, item, scope)
            if all(self.test(self.evaluate(condition, scope), loop.ifs) for condition in loop.ifs):
                yield from self.rounds(nested, scope, None, depth + 1)

    def bind(self, target: ast.expr, value: Value, scope: Scope) -> None:
        """Bind the names of a target to a value."""
        match target:
            case ast.Name(id=name):
                scope.names[name] = value
            case ast.Tuple(elts=targets) | ast.List(elts=targets):
                self.unpack_items(targets, value, scope)
            case _:
                raise Undetermined("this loop is not supported")

    def unpack_items(self, targets: Sequence[ast.expr], value: Value, scope: Scope) -> None:
        """Bind several targets to the items of a value."""
        if any(isinstance(target, ast.Starred) for target in targets):
            raise Undetermined("a target with a star is not supported")
        values = list(self.budget.items(value))
        if len(values) != len(targets):
            message = f"ValueError: cannot unpack {len(values)} values into {len(targets)} names"
            raise EvaluationFails(message)
        for inner, item in zip(targets, values, strict=True):
            self.bind(inner, item, scope)

    # The expressions that are evaluated.
    KINDS: ClassVar[Mapping[type[ast.expr], Callable[[Any, Any, Scope], Value]]] = {
        ast.Constant: _constant,
        ast.Name: _name,
        ast.BinOp: _binop,
        ast.IfExp: _ifexp,
        ast.Attribute: _attribute,
        ast.Subscript: _subscript,
        ast.UnaryOp: _unaryop,
        ast.List: _list,
        ast.Tuple: _tuple,
        ast.ListComp: _listcomp,
        ast.GeneratorExp: _generatorexp,
        ast.Compare: _compare,
        ast.BoolOp: _boolop,
        ast.Call: _call,
    }


_UNARY = {
    ast.Not: lambda value: not truth(value),
    ast.USub: lambda value: -value,
    ast.UAdd: lambda value: +value,
}
