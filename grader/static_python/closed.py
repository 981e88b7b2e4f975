"""The exact value of an expression all of whose names have known values, as in xacro: Python's own, from an allow-list.

Where `expressions` returns what can be told of a Python file in part, this either returns Python's value, or says that
Python certainly raises an error, or that the value cannot be determined statically. Nothing outside the allow-list is
reached. The evaluator of files (`interpreter`) knows values in part, which could not be exact: so there are two.
"""

import ast
import warnings
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from typing import Any

from grader.static_python.closed_functions import call
from grader.static_python.closed_operators import attribute, compare, operate, subscript
from grader.static_python.closed_values import Budget, ExpressionFails, Undetermined, Value, call_plain, items_of

_MAX_LENGTH = 4_000  # characters of an expression
_MAX_KEPT = 200  # characters of an expression that is kept once it is parsed
_OF_NODE = 2  # what evaluating a part of an expression is charged


def evaluate(text: str, find: Callable[[str], Value], budget: Budget) -> Value:
    """Return the value of an expression. `find` returns the value of a name, and raises as this function does.

    Raises ExpressionFails where Python raises an error, Undetermined where the value cannot be determined, OutOfBudget.
    """
    text = text.strip()
    if len(text) > _MAX_LENGTH:
        raise Undetermined("the expression is too long")
    budget.charge(len(text))
    node = _parse(text) if len(text) > _MAX_KEPT else _kept(text)
    if isinstance(node, str):
        raise ExpressionFails(node)
    try:
        return _Evaluator(find, budget).value(node, {})
    except (RecursionError, MemoryError):
        raise Undetermined("the expression is nested too deeply") from None


def _parse(text: str) -> ast.expr | str:
    """Return an expression, or Python's message on why it is none. Raises Undetermined if it is nested too deeply."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return ast.parse(text, mode="eval").body
    except SyntaxError as error:
        return f"SyntaxError: {error.msg}"
    except (RecursionError, MemoryError, SystemError):  # how deep differs between versions; CPython 3.11 may miscount
        raise Undetermined("the expression is nested too deeply") from None
    except (ValueError, OverflowError) as error:
        return f"{type(error).__name__}: {error}"


_kept = lru_cache(1_000)(_parse)


# What makes a value that no function has measured yet.
_MAKES_VALUES = frozenset({ast.Constant, ast.UnaryOp, ast.List, ast.Tuple, ast.ListComp})


class _Evaluator:
    def __init__(self, find: Callable[[str], Value], budget: Budget) -> None:
        self._find = find
        self._budget = budget

    def value(self, node: ast.expr, local: Mapping[str, Value]) -> Value:
        """Return the value of an expression; `local` has the names that comprehensions bind."""
        self._budget.charge(_OF_NODE)
        kind = _KINDS.get(type(node))
        if kind is None:
            raise Undetermined("an expression of this kind is not supported")
        value: Value = kind(self, node, local)
        return self._budget.checked(value) if type(node) in _MAKES_VALUES else value

    def _constant(self, node: ast.Constant, local: Mapping[str, Value]) -> Value:
        del local
        return node.value

    def _name(self, node: ast.Name, local: Mapping[str, Value]) -> Value:
        if node.id.startswith("__"):
            raise ExpressionFails(f"names that begin with two underscores are not allowed: {node.id}")
        return local[node.id] if node.id in local else self._find(node.id)

    def _binop(self, node: ast.BinOp, local: Mapping[str, Value]) -> Value:
        return operate(node.op, self.value(node.left, local), self.value(node.right, local), self._budget)

    def _ifexp(self, node: ast.IfExp, local: Mapping[str, Value]) -> Value:
        return self.value(node.body if call_plain(bool, self.value(node.test, local)) else node.orelse, local)

    def _attribute(self, node: ast.Attribute, local: Mapping[str, Value]) -> Value:
        return attribute(self.value(node.value, local), node.attr, self._budget)

    def _subscript(self, node: ast.Subscript, local: Mapping[str, Value]) -> Value:
        return subscript(self.value(node.value, local), self._key(node.slice, local), self._budget)

    def _unaryop(self, node: ast.UnaryOp, local: Mapping[str, Value]) -> Value:
        if type(node.op) not in _UNARY:
            raise Undetermined("an expression of this kind is not supported")
        return call_plain(_UNARY[type(node.op)], self.value(node.operand, local))

    def _list(self, node: ast.List | ast.Tuple, local: Mapping[str, Value]) -> list[Value]:
        return [self.value(element, local) for element in node.elts]

    def _tuple(self, node: ast.Tuple, local: Mapping[str, Value]) -> Value:
        return tuple(self._list(node, local))

    def _listcomp(self, node: ast.ListComp, local: Mapping[str, Value]) -> Value:
        return [self.value(node.elt, inner) for inner in self._rounds(node.generators, local)]

    def _await(self, node: ast.Await | ast.Yield | ast.YieldFrom, local: Mapping[str, Value]) -> Value:
        del node, local
        raise ExpressionFails("SyntaxError: await and yield belong into functions")

    _yield = _yieldfrom = _await

    def _compare(self, node: ast.Compare, local: Mapping[str, Value]) -> Value:
        left = self.value(node.left, local)
        for op, comparator in zip(node.ops, node.comparators, strict=True):
            right = self.value(comparator, local)
            if not compare(op, left, right, self._budget):
                return False
            left = right
        return True

    def _boolop(self, node: ast.BoolOp, local: Mapping[str, Value]) -> Value:
        value: Value = None
        for operand in node.values:
            value = self.value(operand, local)
            if bool(value) != isinstance(node.op, ast.And):
                break
        return value

    def _key(self, key: ast.expr, local: Mapping[str, Value]) -> Value:
        if not isinstance(key, ast.Slice):
            return self.value(key, local)
        return slice(
            *(None if bound is None else self.value(bound, local) for bound in (key.lower, key.upper, key.step))
        )

    def _call(self, node: ast.Call, local: Mapping[str, Value]) -> Value:
        function = self.value(node.func, local)
        args = [self.value(argument, local) for argument in node.args]
        kwargs: dict[str, Value] = {}
        for keyword in node.keywords:
            if keyword.arg is None:
                raise Undetermined("arguments with ** are not supported")
            if keyword.arg in kwargs:
                raise ExpressionFails(f"SyntaxError: keyword argument repeated: {keyword.arg}")
            kwargs[keyword.arg] = self.value(keyword.value, local)
        return call(function, args, kwargs, self._budget)

    def _rounds(
        self, loops: list[ast.comprehension], local: Mapping[str, Value], depth: int = 0
    ) -> Iterator[Mapping[str, Value]]:
        """Yield the names bound in each round of nested loops, charged by depth: each loop around passes them on."""
        if not loops:
            yield local
            return
        loop, *nested = loops
        for item in items_of(self._budget.checked(self.value(loop.iter, local))):
            self._budget.charge(_OF_NODE + len(local) + depth)
            inner = {**local, **_bound(loop.target, item)}
            if all(self.value(condition, inner) for condition in loop.ifs):
                yield from self._rounds(nested, inner, depth + 1)


_KINDS: Mapping[type, Callable[[_Evaluator, Any, Mapping[str, Value]], Value]] = {
    kind: vars(_Evaluator)[name]
    for kind in vars(ast).values()
    if isinstance(kind, type) and (name := f"_{kind.__name__.lower()}") in vars(_Evaluator)
}


def _bound(target: ast.expr, value: Value) -> dict[str, Value]:
    """Return the names of a loop's target with their values."""
    match target:
        case ast.Name(id=name):
            return {name: value}
        case ast.Tuple(elts=targets) | ast.List(elts=targets):
            values = items_of(value)
            if len(values) != len(targets):
                raise ExpressionFails(f"ValueError: cannot unpack {len(values)} values into {len(targets)} names")
            pairs = zip(targets, values, strict=True)
            return {name: part for inner, item in pairs for name, part in _bound(inner, item).items()}
        case _:
            raise Undetermined("this loop is not supported")


_UNARY: Mapping[type[ast.unaryop], Callable[[Value], Value]] = {
    ast.Not: lambda value: not value,
    ast.USub: lambda value: -value,
    ast.UAdd: lambda value: +value,
}
