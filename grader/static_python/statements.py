"""Evaluate the statements that have no blocks: imports, assignments, deletions, raise and assert."""

import ast
import builtins

from grader.static_python.evaluation import ExitFlow, LoopFlow, ReturnFlow
from grader.static_python.expressions import ExpressionEvaluator
from grader.static_python.imports import import_error, imported_names, is_always_installed
from grader.static_python.inspection import truth
from grader.static_python.operators import extend, operate, remove
from grader.static_python.parse import position_of
from grader.static_python.values import Scope, Unknown


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
