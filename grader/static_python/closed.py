"""The exact value of an expression all of whose names have known values, as in xacro: Python's own, from an allow-list.

Where `expressions` returns what can be told of a Python file in part, this either returns Python's value, or says that Python
certainly raises an error, or that the value cannot be determined statically. Nothing outside the allow-list is reached.
"""

import ast
import warnings
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache

from grader.static_python.closed_functions import call, make_dict
from grader.static_python.closed_methods import attribute, format_value
from grader.static_python.closed_operators import compare, operate, subscript
from grader.static_python.closed_values import (
    ExpressionFails,
    Function,
    Undetermined,
    Value,
    check_size,
    items_of,
    run,
)

_MAX_LENGTH = 4_000  # characters of an expression
_MAX_KEPT = 1_000  # parsed expressions


class OutOfSteps(Undetermined):
    """No steps are left: nothing more of the document can be evaluated."""


class Budget:
    """The steps that are left for all expressions of a document."""

    def __init__(self, steps: int) -> None:
        self.left = steps

    def spend(self, count: int = 1) -> None:
        """Count steps; raise OutOfSteps if none are left."""
        self.left -= count
        if self.left < 0:
            raise OutOfSteps("evaluating this takes too many steps")


def evaluate(text: str, find: Callable[[str], Value], budget: Budget) -> Value:
    """Return the value of an expression. `find` returns the value of a name, and raises as this function does.

    Raises ExpressionFails where Python raises an error, Undetermined where the value cannot be determined.
    """
    if len(text) > _MAX_LENGTH:
        raise Undetermined("the expression is too long")
    node = _parsed(text.strip())
    if isinstance(node, str):
        raise ExpressionFails(node)
    try:
        return _Evaluator(find, budget).value(node, {})
    except (RecursionError, MemoryError):
        raise Undetermined("the expression is nested too deeply") from None


@lru_cache(_MAX_KEPT)
def _parsed(text: str) -> ast.expr | str:
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


class _Evaluator:
    def __init__(self, find: Callable[[str], Value], budget: Budget) -> None:
        self._find = find
        self._budget = budget

    def value(self, node: ast.expr, local: Mapping[str, Value]) -> Value:
        """Return the value of an expression; `local` has the names that comprehensions and lambdas bind."""
        self._budget.spend()
        match node:
            case ast.Constant(value=value):
                return value
            case ast.Name(id=name):
                if name.startswith("__"):
                    raise ExpressionFails(f"names that begin with two underscores are not allowed: {name}")
                return local[name] if name in local else self._find(name)
            case ast.BinOp(left=left, op=op, right=right):
                return self._sized(operate(op, self.value(left, local), self.value(right, local)))
            case ast.Compare(left=left, ops=ops, comparators=comparators):
                return self._compare(self.value(left, local), ops, comparators, local)
            case ast.BoolOp(op=op, values=operands):
                return self._bool_op(op, operands, local)
            case ast.IfExp(test=test, body=body, orelse=other):
                return self.value(body if run(bool, self.value(test, local)) else other, local)
            case ast.Attribute(value=owner, attr=name):
                return attribute(self.value(owner, local), name)
            case ast.Subscript(value=owner, slice=key):
                return self._sized(subscript(self.value(owner, local), self.value(key, local)))
            case ast.Call():
                return self._call(node, local)
            case _:
                return self._rare(node, local)

    def _rare(self, node: ast.expr, local: Mapping[str, Value]) -> Value:
        match node:
            case ast.UnaryOp(op=op, operand=operand):
                return run(_UNARY[type(op)], self.value(operand, local))
            case ast.List(elts=elements):
                return self._sized(self._elements(elements, local))
            case ast.Tuple(elts=elements):
                return self._sized(tuple(self._elements(elements, local)))
            case ast.Set(elts=elements):
                return self._sized(run(set, self._elements(elements, local)))
            case ast.Dict(keys=keys, values=values):
                return self._sized(self._dict(keys, values, local))
            case ast.Slice(lower=lower, upper=upper, step=step):
                return slice(*(None if bound is None else self.value(bound, local) for bound in (lower, upper, step)))
            case ast.ListComp(elt=element, generators=loops):
                return self._sized([self.value(element, inner) for inner in self._rounds(loops, local)])
            case ast.SetComp(elt=element, generators=loops):
                return self._sized(run(set, [self.value(element, inner) for inner in self._rounds(loops, local)]))
            case ast.GeneratorExp(elt=element, generators=loops):
                return iter(self._sized([self.value(element, inner) for inner in self._rounds(loops, local)]))
            case ast.DictComp(key=key, value=element, generators=loops):
                pairs = [(self.value(key, inner), self.value(element, inner)) for inner in self._rounds(loops, local)]
                return self._sized(run(dict, pairs))
            case ast.JoinedStr(values=pieces):
                return self._sized("".join(self._piece(piece, local) for piece in pieces))
            case ast.Lambda(args=parameters, body=body):
                return self._function(parameters, body, local)
            case ast.Await() | ast.Yield() | ast.YieldFrom():
                raise ExpressionFails("SyntaxError: await and yield belong into functions")
            case _:
                raise Undetermined("an expression of this kind is not supported")

    def _sized(self, value: Value) -> Value:
        if type(value) is not float:
            self._budget.spend(check_size(value) // 16)
        return value

    def _compare(
        self, left: Value, ops: list[ast.cmpop], comparators: list[ast.expr], local: Mapping[str, Value]
    ) -> Value:
        for op, comparator in zip(ops, comparators, strict=True):
            right = self.value(comparator, local)
            if not compare(op, left, right):
                return False
            left = right
        return True

    def _bool_op(self, op: ast.boolop, operands: list[ast.expr], local: Mapping[str, Value]) -> Value:
        value: Value = None
        for operand in operands:
            value = self.value(operand, local)
            if bool(value) != isinstance(op, ast.And):
                break
        return value

    def _call(self, node: ast.Call, local: Mapping[str, Value]) -> Value:
        function = self.value(node.func, local)
        args = self._elements(node.args, local)
        kwargs: dict[str, Value] = {}
        for keyword in node.keywords:
            value = self.value(keyword.value, local)
            more = {keyword.arg: value} if keyword.arg is not None else run(make_dict, value)
            if repeated := kwargs.keys() & more.keys():
                raise ExpressionFails(f"SyntaxError: keyword argument repeated: {min(repeated)}")
            kwargs |= more
        self._budget.spend(check_size([args, list(kwargs.values())]) // 16)
        return self._sized(call(function, args, kwargs))

    def _elements(self, nodes: list[ast.expr], local: Mapping[str, Value]) -> list[Value]:
        values: list[Value] = []
        for node in nodes:
            if isinstance(node, ast.Starred):
                values += items_of(self.value(node.value, local))
            else:
                values.append(self.value(node, local))
        return values

    def _dict(
        self, keys: list[ast.expr | None], values: list[ast.expr], local: Mapping[str, Value]
    ) -> dict[Value, Value]:
        table: dict[Value, Value] = {}
        for key, node in zip(keys, values, strict=True):
            if key is None:
                table |= run(make_dict, self.value(node, local))
            else:
                run(table.__setitem__, self.value(key, local), self.value(node, local))
        return table

    def _piece(self, piece: ast.expr, local: Mapping[str, Value]) -> str:
        """Return the text of one piece of an f-string."""
        if isinstance(piece, ast.FormattedValue):
            spec = self.value(piece.format_spec, local) if piece.format_spec is not None else ""
            conversion = chr(piece.conversion) if piece.conversion >= 0 else None
            return format_value(self.value(piece.value, local), spec, conversion)
        return str(self.value(piece, local))

    def _function(self, parameters: ast.arguments, body: ast.expr, local: Mapping[str, Value]) -> Function:
        names = [parameter.arg for parameter in (*parameters.posonlyargs, *parameters.args)]
        if parameters.vararg or parameters.kwarg or parameters.kwonlyargs or parameters.defaults:
            raise Undetermined("a lambda of this kind is not supported")

        def called(*args: Value) -> Value:
            if len(args) != len(names):
                raise ExpressionFails(f"this lambda takes {len(names)} arguments, not {len(args)}")
            return self.value(body, {**local, **dict(zip(names, args, strict=True))})

        return Function("lambda", called)

    def _rounds(self, loops: list[ast.comprehension], local: Mapping[str, Value]) -> Iterator[Mapping[str, Value]]:
        """Yield the names that are bound in each round of nested loops."""
        if not loops:
            yield local
            return
        loop, *nested = loops
        for item in items_of(self.value(loop.iter, local)):
            self._budget.spend()
            inner = {**local, **_bound(loop.target, item)}
            if all(self.value(condition, inner) for condition in loop.ifs):
                yield from self._rounds(nested, inner)


def _bound(target: ast.expr, value: Value) -> dict[str, Value]:
    """Return the names of a loop's target with their values."""
    match target:
        case ast.Name(id=name):
            return {name: value}
        case ast.Tuple(elts=targets) | ast.List(elts=targets):
            values = list(items_of(value))
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
    ast.Invert: lambda value: ~value,
}
