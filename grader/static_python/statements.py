"""The statements of a file without blocks: assignments, imports, deletions and raised errors."""

import ast
import builtins
import operator
from copy import copy

from grader.static_python import values as py
from grader.static_python.builtins import truth
from grader.static_python.evaluation import EvaluationStopped, ExitFlow
from grader.static_python.file_expressions import FileExpressions
from grader.static_python.imports import UNCERTAIN, USUAL_NAMES, import_error, imported_names
from grader.static_python.knowledge import call_plain, iterate, known, reason_of, refuse
from grader.static_python.operators import operate
from grader.static_python.parse import Position, position_of


class ReturnFlow(py.EvaluationSignal):
    """A return statement, with its value."""

    def __init__(self, value: py.Value) -> None:
        super().__init__()
        self.value = value


class LoopFlow(py.EvaluationSignal):
    """A break or continue statement."""

    def __init__(self, *, is_break: bool) -> None:
        super().__init__()
        self.is_break = is_break


class Statements(FileExpressions):
    """Adds the statements without blocks to the expressions."""

    def statement(self, node: ast.stmt, scope: py.Scope) -> None:
        """Evaluate a statement; stop at one of a kind that is not supported."""
        kind = getattr(self, f"_on_{type(node).__name__.lower()}", None)
        if kind is None:
            raise EvaluationStopped(
                f"a statement of the kind {type(node).__name__} is not evaluated", position_of(node)
            )
        try:
            kind(node, scope)
        except py.ExpressionFails as error:  # of the statement itself, such as an assignment
            self.error(str(error), position_of(node), error.kind)
        except py.Undetermined as error:
            raise EvaluationStopped(
                f"this statement is not evaluated: {error}", error.at or position_of(node)
            ) from None

    def bind(self, target: ast.expr, value: py.Value, scope: py.Scope) -> None:
        """Bind the names of a target to a value, or change an item."""
        match target:
            case ast.Subscript(value=owner, slice=key):
                self._store(self.evaluate(owner, scope), self.key(key, scope), value, position_of(target))
            case ast.Attribute(value=owner, attr=name):
                changed = self.evaluate(owner, scope)
                if isinstance(changed, py.PLAIN):
                    raise py.ExpressionFails(f"{type(changed).__name__!r} has no attribute {name!r}", AttributeError)
                raise EvaluationStopped(f"a change of the attribute {name} is not evaluated", position_of(target))
            case _:
                super().bind(target, value, scope)

    def _store(self, owner: py.Value, key: py.Value, value: py.Value, at: Position) -> None:
        """Set an item of a list or dict."""
        if isinstance(owner, py.QualifiedName | py.Call):
            made = py.Call(f"{owner.name}.__setitem__", [key, value], {}, at)
            self.call_value(py.QualifiedName(made.name), made)
            return
        if not isinstance(owner, py.PLAIN):
            refuse(owner, "this assignment to an item is not supported")
        if isinstance(key, slice):
            value = list(iterate(value))
        call_plain(operator.setitem, owner, known(key) if not isinstance(key, slice) else key, value)
        self.budget.charge(len(owner))

    def _on_assign(self, node: ast.Assign, scope: py.Scope) -> None:
        value = self.evaluate(node.value, scope)
        for target in node.targets:
            self.bind(target, value, scope)

    def _on_annassign(self, node: ast.AnnAssign, scope: py.Scope) -> None:
        if node.value is not None:
            self.bind(node.target, self.evaluate(node.value, scope), scope)
        if scope is self.module:
            self.annotation(node.annotation, scope)

    def annotation(self, node: ast.expr | None, scope: py.Scope) -> None:
        """Find the names of an annotation, and stop where it calls something."""
        if node is None or self.has_lazy_annotations:
            return
        for part in ast.walk(node):
            if isinstance(part, ast.Name):
                self._of_name(part, scope)
            elif not isinstance(part, _IN_ANNOTATIONS):
                raise EvaluationStopped("this annotation is not evaluated", position_of(node))

    def _on_augassign(self, node: ast.AugAssign, scope: py.Scope) -> None:
        target = node.target
        if any(isinstance(part, ast.Call | ast.NamedExpr) for part in ast.walk(target)):
            raise py.Undetermined("this target is not supported")
        load = copy(target)
        load.ctx = ast.Load()
        before, value = self.evaluate(load, scope), self.evaluate(node.value, scope)
        if not isinstance(before, py.PLAIN):
            refuse(before, "this value is not supported")
        if isinstance(before, list) and isinstance(node.op, ast.Add):
            before.extend(list(iterate(value)))
            self.budget.measure(before, "holds")
        elif isinstance(before, list | dict):
            raise py.Undetermined("this operator is not supported")
        else:
            self.bind(target, operate(node.op, before, value, self.budget), scope)

    def _on_expr(self, node: ast.Expr, scope: py.Scope) -> None:
        self.evaluate(node.value, scope)

    def _on_pass(self, node: ast.Pass, scope: py.Scope) -> None:
        pass

    def _on_return(self, node: ast.Return, scope: py.Scope) -> None:
        raise ReturnFlow(self.evaluate(node.value, scope) if node.value is not None else None)

    def _on_break(self, node: ast.Break | ast.Continue, scope: py.Scope) -> None:
        del scope
        raise LoopFlow(is_break=isinstance(node, ast.Break))

    _on_continue = _on_break

    def _on_assert(self, node: ast.Assert, scope: py.Scope) -> None:
        if not truth(self.evaluate(node.test, scope)):
            self.error("this assertion fails", position_of(node), AssertionError)

    def _on_delete(self, node: ast.Delete, scope: py.Scope) -> None:
        for target in node.targets:
            match target:
                case ast.Subscript(value=owner, slice=key):
                    container, item = self.evaluate(owner, scope), self.key(key, scope)
                    if not isinstance(container, py.PLAIN):
                        raise py.Undetermined(reason_of(container) or "this deletion is not supported")
                    call_plain(operator.delitem, container, item if isinstance(item, slice) else known(item))
                case ast.Name(id=name):
                    self._of_name(ast.copy_location(ast.Name(name, ast.Load()), target), scope)
                    scope.names.pop(name, None)
                case _:
                    raise py.Undetermined("this deletion is not supported")

    def _on_import(self, node: ast.Import | ast.ImportFrom, scope: py.Scope) -> None:
        module = "" if isinstance(node, ast.Import) else "." * node.level + (node.module or "")
        at = position_of(node)
        for alias in node.names:
            if (module or alias.name).split(".")[0] in self.local_modules:
                raise EvaluationStopped(f"the file's own module {module or alias.name} is not evaluated", at)
            error = import_error(module, alias.name, self.exports)
            if error == UNCERTAIN:
                self.doubted(
                    py.Unknown(f"whether {module or alias.name} is installed is not known; it is not evaluated", at)
                )
            elif error is not None:
                self.error(error, at, ImportError)
            bound = imported_names(module, alias, self.exports)
            if error not in (None, UNCERTAIN):
                bound = dict.fromkeys(bound, py.QualifiedName(USUAL_NAMES.get(alias.name, f"?.{alias.name}")))
            if bound.pop("*", None) is not None:
                raise EvaluationStopped(f"the names of {module} are not evaluated", at)
            self.has_lazy_annotations |= (module, alias.name) == ("__future__", "annotations")
            for name, value in bound.items():
                scope.names[name] = value

    _on_importfrom = _on_import

    def _on_raise(self, node: ast.Raise, _: py.Scope) -> None:
        """Raise one of Python's own errors, which ends the file if nothing can catch it."""
        raised = node.exc.func if isinstance(node.exc, ast.Call) else node.exc
        kind = getattr(builtins, raised.id, None) if isinstance(raised, ast.Name) else None
        if self.handlers or not isinstance(kind, type) or not issubclass(kind, Exception):
            raise EvaluationStopped("which error is raised here is not evaluated", position_of(node))
        self.error(f"the file raises {kind.__name__} here", position_of(node), kind)
        raise ExitFlow


_IN_ANNOTATIONS = (
    ast.Attribute, ast.Subscript, ast.Constant, ast.BinOp, ast.BitOr, ast.Tuple, ast.List, ast.expr_context, ast.Index,
)  # fmt: skip
