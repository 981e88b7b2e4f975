"""Evaluate a whole Python file without running it: its functions, branches, loops, assignments and imports.

A statement of any other kind, such as `try` or `while`, ends the evaluation: what follows is not known.
"""

import ast
import builtins
from collections.abc import Collection, Mapping, Sequence
from functools import partial
from io import StringIO

from grader.python import values as py
from grader.python.budget import Budget
from grader.python.builtins import truth
from grader.python.file_expressions import FileExpressions
from grader.python.knowledge import iterate
from grader.python.library import UNCERTAIN, USUAL_NAMES, import_error, imported_names
from grader.python.parse import Code, Position, bound_in, own_nodes, position_of

_STEPS = 100_000  # what the evaluation of one file may use
_IN_ANNOTATIONS = (
    ast.Attribute, ast.Subscript, ast.Constant, ast.BinOp, ast.BitOr, ast.Tuple, ast.List, ast.expr_context, ast.Index,
)  # fmt: skip


class _ReturnFlow(py.EvaluationSignal):
    """A return statement, with its value."""

    def __init__(self, value: py.Value) -> None:
        super().__init__()
        self.value = value


class Interpreter(FileExpressions):
    """Adds the statements of a file to its expressions."""

    def __init__(
        self,
        functions: py.FunctionTable,
        names: Mapping[str, py.Value],
        *,
        stand_ins: Collection[str] = (),
        budget: Budget | None = None,
        exports: Mapping[str, Collection[str]] | None = None,
        local_modules: Collection[str] = (),
    ) -> None:
        """`functions` may be called, by full name; `names` are bound from the beginning, such as __file__.

        `stand_ins` are texts that stand for folders that are not known; `exports` has the names of modules, besides
        those of Python itself; `local_modules` are beside the file, and imported before any other.
        """
        super().__init__(functions, names, budget or Budget(_STEPS))
        self.budget.stand_ins = stand_ins
        self.exports = exports or {}
        self.local_modules = local_modules

    def run(self, code: Code) -> py.Scope:
        """Evaluate a whole file and return the scope of its names. Never raises."""
        try:
            self._block(code.tree.body, self.module)
        except (py.EvaluationSignal, RecursionError) as error:
            self._stop(error)
        return self.module

    def call_from_outside(self, function: py.Function, at: Position, args: Sequence[py.Value] | None = ()) -> py.Value:
        """Return the value of a call of one of the file's functions. Never raises.

        With `args` None, the arguments are unknown, and no error or doubt in the call counts: it may never happen.
        """
        given = function.parameters
        count = len([*given.posonlyargs, *given.args]) - len(given.defaults)
        event: list[py.Value] = [py.Unknown("an event is known only at run time", at)] * count
        recorded, doubt = list(self.errors), self.doubt
        try:
            return self.call_function(function, py.Call("", event if args is None else list(args), {}, at))
        except (py.EvaluationSignal, RecursionError) as error:
            return self._stop(error, at)
        finally:
            if args is None:
                self.errors, self.doubt = recorded, doubt

    def _stop(self, error: py.EvaluationSignal | RecursionError, at: Position | None = None) -> py.Unknown:
        if isinstance(error, RecursionError):
            error = py.Undetermined("the file is too deeply nested, which is not evaluated")
        return self.doubted(py.Unknown(str(error), error.at or at or self.at))

    def _block(self, body: list[ast.stmt], scope: py.Scope) -> None:
        for node in body:
            self.budget.charge(1)
            self.at = position_of(node)
            kind = getattr(self, f"_on_{type(node).__name__.lower()}", None)
            if kind is None:
                raise py.Undetermined(
                    f"a statement of the kind {type(node).__name__} is not evaluated", self.at, is_final=True
                )
            try:
                kind(node, scope)
            except py.EvaluationFails as error:  # of the statement itself, such as an assignment
                self.error(str(error), position_of(node))
            except py.Undetermined as error:
                if error.is_final:
                    raise
                reason = f"this statement is not evaluated: {error}"
                raise py.Undetermined(reason, error.at or position_of(node), is_final=True) from None

    def _on_functiondef(self, node: ast.FunctionDef, scope: py.Scope) -> None:
        at = position_of(node)
        if node.decorator_list or getattr(node, "type_params", []):
            raise py.Undetermined("a function with a decorator or type parameters is not evaluated", at, is_final=True)
        parameters = node.args
        every = (*parameters.posonlyargs, *parameters.args, *parameters.kwonlyargs, parameters.vararg, parameters.kwarg)
        function: py.Value = self.function(parameters, scope, at, partial(self._function_body, node), bound_in(node))
        for annotation in (*(parameter.annotation for parameter in every if parameter), node.returns):
            self._annotation(annotation, scope)
        scope.names[node.name] = function

    def _function_body(self, node: ast.FunctionDef, scope: py.Scope) -> py.Value:
        if any(isinstance(inner, ast.Yield | ast.YieldFrom) for inner in own_nodes(node)):
            raise py.Undetermined("a generator function is not evaluated", position_of(node), is_final=True)
        try:
            self._block(node.body, scope)
        except _ReturnFlow as flow:
            return flow.value
        return None

    def _on_return(self, node: ast.Return, scope: py.Scope) -> None:
        raise _ReturnFlow(self.evaluate(node.value, scope) if node.value is not None else None)

    def _annotation(self, node: ast.expr | None, scope: py.Scope) -> None:
        """Find the names of an annotation, and stop where it calls something."""
        for part in ast.walk(node) if node is not None else ():
            if isinstance(part, ast.Name):
                self._of_name(part, scope)
            elif not isinstance(part, _IN_ANNOTATIONS):
                raise py.Undetermined("this annotation is not evaluated", self.at, is_final=True)

    def _on_if(self, node: ast.If, scope: py.Scope) -> None:
        self._block(node.body if truth(self.evaluate(node.test, scope)) else node.orelse, scope)

    def _on_for(self, node: ast.For, scope: py.Scope) -> None:
        for item in iterate(self.evaluate(node.iter, scope)):
            self.bind(node.target, item, scope)
            self._block(node.body, scope)
        self._block(node.orelse, scope)

    def _on_with(self, node: ast.With, scope: py.Scope) -> None:
        value, target = self.evaluate(node.items[0].context_expr, scope), node.items[0].optional_vars
        if isinstance(value, py.Call):
            self.call_value(py.BoundMethod(value, "__enter__"), py.Call("", [], {}, self.at))
        if len(node.items) > 1 or not isinstance(value, py.Call | StringIO):
            raise py.Undetermined("this use of with is not evaluated", self.at, is_final=True)
        if target is not None:
            self.bind(target, value, scope)
        try:
            self._block(node.body, scope)
        finally:
            if isinstance(value, StringIO):
                value.close()
            else:
                value.method_calls.append(py.Call(f"{value.name}.__exit__", [], {}, self.at, value))

    def _on_annassign(self, node: ast.AnnAssign, scope: py.Scope) -> None:
        if node.value is not None:
            self.bind(node.target, self.evaluate(node.value, scope), scope)
        if scope is self.module:
            self._annotation(node.annotation, scope)

    def _on_expr(self, node: ast.Expr, scope: py.Scope) -> None:
        self.evaluate(node.value, scope)

    def _on_pass(self, node: ast.Pass, scope: py.Scope) -> None:
        pass

    def _on_import(self, node: ast.Import | ast.ImportFrom, scope: py.Scope) -> None:
        module = "" if isinstance(node, ast.Import) else "." * node.level + (node.module or "")
        for alias in node.names:
            if (module or alias.name).split(".")[0] in self.local_modules:
                raise py.Undetermined(
                    f"the file's own module {module or alias.name} is not evaluated", self.at, is_final=True
                )
            error = import_error(module, alias.name, self.exports)
            bound = imported_names(module, alias, self.exports)
            if error == UNCERTAIN:
                reason = f"whether {module or alias.name} is installed is not known; it is not evaluated"
                self.doubted(py.Unknown(reason, self.at))
            elif error is not None:
                self.error(error, self.at)
                bound = dict.fromkeys(bound, py.QualifiedName(USUAL_NAMES.get(alias.name, f"?.{alias.name}")))
            if bound.pop("*", None) is not None:
                raise py.Undetermined(f"the names of {module} are not evaluated", self.at, is_final=True)
            scope.names.update(bound)

    _on_importfrom = _on_import

    def _on_assert(self, node: ast.Assert, scope: py.Scope) -> None:
        if not truth(self.evaluate(node.test, scope)):
            self.error("this assertion fails", self.at)

    def _on_raise(self, node: ast.Raise, _: py.Scope) -> None:
        raised = node.exc.func if isinstance(node.exc, ast.Call) else node.exc
        kind = getattr(builtins, raised.id, None) if isinstance(raised, ast.Name) else None
        if isinstance(kind, type) and issubclass(kind, Exception):
            self.error(f"the file raises {kind.__name__} here", self.at)
        raise py.Undetermined("which error is raised here is not evaluated", self.at, is_final=True)
