"""Evaluate expressions of any kind, also given as text, and the statements that have no blocks: imports, assignments, deletions, raise and assert."""

import ast
import builtins
from collections.abc import Callable, Iterator

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

    def evaluate_kind(self, node: ast.expr, scope: Scope) -> Value:
        """Return the value of an expression."""
        at = position_of(node)
        match node:
            case ast.ListComp(elt=element) | ast.GeneratorExp(elt=element) | ast.SetComp(elt=element):
                values = self._comprehension(node.generators, None, element, scope, at)
                return (
                    self.make_set(values, at) if isinstance(node, ast.SetComp) and isinstance(values, list) else values
                )
            case ast.DictComp(key=key, value=element):
                values = self._comprehension(node.generators, key, element, scope, at)
                return dict(values) if isinstance(values, list) else values
            case ast.NamedExpr(target=target, value=expression):
                result = self.evaluate(expression, scope)
                while scope.is_loop and scope.outer is not None:
                    scope = scope.outer
                self.assign(target, result, scope)
                return result
            case ast.Lambda(args=parameters, body=body):
                return self.function(parameters, scope, at, lambda inner, _: self.evaluate(body, inner))
            case _:
                return super().evaluate_kind(node, scope)

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
        """Evaluate a statement."""
        match node:
            case ast.Import() | ast.ImportFrom():
                self._import(node, scope)
            case ast.Assign(targets=targets, value=expression):
                value = self.evaluate(expression, scope)
                for target in targets:
                    self.assign(target, value, scope)
            case ast.AnnAssign(target=target, value=ast.expr() as expression):
                self.assign(target, self.evaluate(expression, scope), scope)
            case ast.AugAssign(target=target, op=op, value=expression):
                before, value = self.evaluate(target, scope), self.evaluate(expression, scope)
                if isinstance(op, ast.Add) and isinstance(before, list):
                    extend(self, before, value, position_of(node))
                else:
                    self.assign(target, operate(self, op, before, value, position_of(node)), scope)
            case ast.Expr(value=expression):
                self.evaluate(expression, scope)
            case ast.ClassDef(name=name):
                scope.bind(name, Unknown("a class is not supported", position_of(node)))
            case ast.Return(value=expression):
                raise ReturnFlow(self.evaluate(expression, scope) if expression is not None else None)
            case ast.Break() | ast.Continue():
                raise LoopFlow(is_break=isinstance(node, ast.Break))
            case ast.Delete(targets=targets):
                for target in targets:
                    self._delete(target, scope)
            case ast.Global(names=names):
                scope.declared |= dict.fromkeys(names, self.module)
            case ast.Nonlocal(names=names):
                scope.declared |= {name: scope.holder(name) for name in names}
            case ast.Raise():
                self._raise(node, scope)
            case ast.Assert(test=test):
                if truth(self.evaluate(test, scope)) is False:
                    self.error("this assertion fails", position_of(node), AssertionError)

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

    def _delete(self, target: ast.expr, scope: Scope) -> None:
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
