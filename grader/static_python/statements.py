"""Evaluate expressions of any kind, also given as text, and the statements that have no blocks, such as imports."""

import ast
import builtins
from collections.abc import Callable, Iterator
from typing import Any

from grader.static_python.evaluation import ExitFlow, LoopFlow, ReturnFlow
from grader.static_python.imports import import_error, imported_names, is_always_installed
from grader.static_python.operators import extend, operate, remove, store
from grader.static_python.parse import Position, position_of
from grader.static_python.simple_expressions import SimpleEvaluator
from grader.static_python.values import (
    MAX_ITEMS,
    BoundMethod,
    Function,
    QualifiedName,
    Scope,
    Unknown,
    Value,
    items_of,
    truth,
)

_MAX_LENGTH = 1_000  # of a text


class ExpressionEvaluator(SimpleEvaluator):
    """Adds the expressions that bind names: comprehensions, lambdas and assignment expressions."""

    def _listcomp(self, node: ast.ListComp | ast.GeneratorExp | ast.SetComp, scope: Scope) -> list[Value] | Unknown:
        return self._comprehension(node.generators, None, node.elt, scope, position_of(node))

    _generatorexp = _listcomp

    def _setcomp(self, node: ast.SetComp, scope: Scope) -> Value:
        values = self._listcomp(node, scope)
        return self.make_set(values, position_of(node)) if isinstance(values, list) else values

    def _dictcomp(self, node: ast.DictComp, scope: Scope) -> Value:
        values = self._comprehension(node.generators, node.key, node.value, scope, position_of(node))
        return dict(values) if isinstance(values, list) else values

    def _namedexpr(self, node: ast.NamedExpr, scope: Scope) -> Value:
        result = self.evaluate(node.value, scope)
        while scope.is_loop and scope.outer is not None:
            scope = scope.outer
        self.assign(node.target, result, scope)
        return result

    def _lambda(self, node: ast.Lambda, scope: Scope) -> Value:
        return self.function(node.args, scope, position_of(node), lambda inner, _: self.evaluate(node.body, inner))

    def assign(self, target: ast.expr, value: Value, scope: Scope) -> None:
        """Bind the names of a target to a value; a target that is not supported is bound to Unknown."""
        if self.uncertainty is not None and not isinstance(value, QualifiedName | Function | BoundMethod):
            value = self.uncertainty
        match target:
            case ast.Name(id=name):
                scope.bind(name, value)
            case ast.Tuple(elts=targets) | ast.List(elts=targets):
                values = list(value[: len(targets) + 1]) if isinstance(value, list | tuple) else []
                if len(values) != len(targets) or any(isinstance(inner, ast.Starred) for inner in targets):
                    values = [Unknown("unpacking of this kind is not supported", position_of(target))] * len(targets)
                for inner, item in zip(targets, values, strict=True):
                    self.assign(inner.value if isinstance(inner, ast.Starred) else inner, item, scope)
            case ast.Subscript(value=owner, slice=key):
                container = self.evaluate(owner, scope)
                store(self, container, self.key(key, scope), value, position_of(target))
            case ast.Attribute(value=owner):
                self.evaluate(owner, scope)

    def function(
        self, parameters: ast.arguments, scope: Scope, at: Position, body: Callable[[Scope, Position], Value]
    ) -> Function:
        """Return a function as it is defined: its defaults are evaluated now."""
        positional = reversed([*parameters.posonlyargs, *parameters.args])
        pairs = list(zip(positional, reversed(parameters.defaults), strict=False))
        named = zip(parameters.kwonlyargs, parameters.kw_defaults, strict=True)
        pairs += [(parameter, default) for parameter, default in named if default is not None]
        defaults = {parameter.arg: self.evaluate(default, scope) for parameter, default in pairs}
        return Function(parameters, scope, defaults, body, at)

    def _comprehension(
        self, loops: list[ast.comprehension], key: ast.expr | None, element: ast.expr, scope: Scope, at: Position
    ) -> list[Value] | Unknown:
        """Return the values of the rounds; with a key, as in a dict, pairs."""
        inner = Scope({}, scope, is_loop=True)
        values: list[Value] = []
        for is_known in self._rounds(loops, inner, values if key is None else None):
            name = self.evaluate(key, inner) if key is not None and is_known else ""
            if not is_known or not isinstance(name, str | int) or len(values) > MAX_ITEMS:
                return Unknown("a comprehension over items that are known only at run time", at)
            value = self.evaluate(element, inner)
            values.append(value if key is None else (name, value))
        return values

    def _rounds(self, loops: list[ast.comprehension], scope: Scope, unknown: list[Value] | None) -> Iterator[bool]:
        """Bind the targets of nested loops, round by round; False where their items or conditions are not known.

        An unknown item joins the list `unknown` as the result of its rounds; without the list it is not supported.
        """
        if not loops:
            yield True
            return
        loop, *nested = loops
        items = items_of(self.evaluate(loop.iter, scope))
        for item in [None] if items is None else items:
            if items is None or (isinstance(item, Unknown) and unknown is None):
                yield False
            elif isinstance(item, Unknown) and unknown is not None:
                unknown.append(item)
            else:
                self.assign(loop.target, item, scope)
                conditions = [truth(self.evaluate(condition, scope)) for condition in loop.ifs]
                if None in conditions:
                    yield False
                elif all(conditions):
                    yield from self._rounds(nested, scope, unknown)


class StatementEvaluator(ExpressionEvaluator):
    """Adds the statements without blocks to the expressions."""

    def statement(self, node: ast.stmt, scope: Scope) -> None:
        """Evaluate a statement, if its kind is supported."""
        kind = getattr(self, f"_{type(node).__name__.lower()}", None)
        if kind is not None:
            kind(node, scope)

    def _assign(self, node: ast.Assign, scope: Scope) -> None:
        value = self.evaluate(node.value, scope)
        for target in node.targets:
            self.assign(target, value, scope)

    def _annassign(self, node: ast.AnnAssign, scope: Scope) -> None:
        if node.value is not None:
            self.assign(node.target, self.evaluate(node.value, scope), scope)

    def _augassign(self, node: ast.AugAssign, scope: Scope) -> None:
        before, value = self.evaluate(node.target, scope), self.evaluate(node.value, scope)
        if isinstance(node.op, ast.Add) and isinstance(before, list):
            extend(self, before, value, position_of(node))
        else:
            self.assign(node.target, operate(self, node.op, before, value, position_of(node)), scope)

    def _expr(self, node: ast.Expr, scope: Scope) -> None:
        self.evaluate(node.value, scope)

    def _classdef(self, node: Any, scope: Scope) -> None:
        scope.bind(getattr(node.name, "id", node.name), Unknown("a class is not supported", position_of(node)))

    _typealias = _classdef  # type X = ..., in Python 3.12

    def _return(self, node: ast.Return, scope: Scope) -> None:
        raise ReturnFlow(self.evaluate(node.value, scope) if node.value is not None else None)

    def _break(self, node: ast.Break | ast.Continue, scope: Scope) -> None:
        del scope
        raise LoopFlow(is_break=isinstance(node, ast.Break))

    _continue = _break

    def _global(self, node: ast.Global, scope: Scope) -> None:
        scope.declared |= dict.fromkeys(node.names, self.module)

    def _nonlocal(self, node: ast.Nonlocal, scope: Scope) -> None:
        scope.declared |= {name: scope.holder(name) for name in node.names}

    def _assert(self, node: ast.Assert, scope: Scope) -> None:
        if truth(self.evaluate(node.test, scope)) is False:
            self.error("this assertion fails", position_of(node), AssertionError)

    def _delete(self, node: ast.Delete, scope: Scope) -> None:
        for target in node.targets:
            self._delete_target(target, scope)

    def _import(self, node: ast.Import | ast.ImportFrom, scope: Scope) -> None:
        module = "" if isinstance(node, ast.Import) else "." * node.level + (node.module or "")
        for alias in node.names:
            if not is_always_installed(module or alias.name):
                self.may_have_failed = True
            error = import_error(module, alias.name)
            if error is not None:
                self.error(error, position_of(node), ImportError)
            for name, value in imported_names(module, alias).items():
                scope.bind(name, value)

    _importfrom = _import

    def _delete_target(self, target: ast.expr, scope: Scope) -> None:
        match target:
            case ast.Subscript(value=owner, slice=key):
                container = self.evaluate(owner, scope)
                reason = Unknown("this deletion is not supported", position_of(target))
                remove(self, container, self.key(key, scope), self.uncertainty or reason)
            case ast.Name(id=name) if self.uncertainty is None:
                scope.declared.get(name, scope).names.pop(name, None)
            case ast.Name(id=name):
                scope.bind(name, self.uncertainty)

    def _raise(self, node: ast.Raise, scope: Scope) -> None:
        raised = node.exc.func if isinstance(node.exc, ast.Call) else node.exc
        name = raised.id if isinstance(raised, ast.Name) else "an error"
        if node.exc is not None:
            self.evaluate(node.exc, scope)
        self.may_have_failed = True
        kind = getattr(builtins, name, Exception)
        if self.uncertainty is None:
            self.error(f"the file raises {name} here", position_of(node), kind if isinstance(kind, type) else Exception)
            raise ExitFlow
