"""Evaluate a whole Python file without running it: its blocks, functions, branches, loops and error handlers."""

import ast
import builtins
from collections.abc import Collection, Mapping, Sequence
from functools import partial
from io import StringIO

from grader.static_python import values as py
from grader.static_python.budget import Budget, OutOfBudget
from grader.static_python.builtins import truth
from grader.static_python.evaluation import EvaluationStopped, ExitFlow, FunctionTable, RaisedFlow
from grader.static_python.knowledge import iterate
from grader.static_python.parse import Code, Position, bound_in, own_nodes, position_of
from grader.static_python.statements import LoopFlow, ReturnFlow, Statements

_STEPS = 100_000  # what the evaluation of one file may use


class Interpreter(Statements):
    """Adds the statements that have blocks."""

    def __init__(
        self,
        functions: FunctionTable,
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
        except (EvaluationStopped, OutOfBudget, RecursionError) as error:
            self._stop(error)
        except (ReturnFlow, LoopFlow, ExitFlow):  # also a break outside of a loop, which ast accepts
            pass
        except RaisedFlow as error:
            self.errors.append(error.error)
        return self.module

    def call_from_outside(self, function: py.Function, at: Position, args: Sequence[py.Value] | None = ()) -> py.Value:
        """Return the value of a call of one of the file's functions. Never raises.

        With `args` None, the arguments are unknown, and no error or doubt in the call counts: it may never happen.
        """
        unknown = {py.UNKNOWN_KEYS: py.Unknown("an event is known only at run time", at)} if args is None else {}
        recorded, doubt = list(self.errors), self.doubt
        try:
            return self.call_function(function, py.Call("", list(args or ()), unknown, at))
        except (EvaluationStopped, OutOfBudget, RecursionError) as error:
            return self._stop(error, at)
        except (ExitFlow, LoopFlow, py.ExpressionFails, py.Undetermined, RaisedFlow):
            return self.doubted(py.Unknown("the file exits here", at))
        finally:
            if args is None:
                self.errors, self.doubt = recorded, doubt

    def _stop(self, error: Exception, at: Position | None = None) -> py.Unknown:
        self.handlers = 0
        is_deep = isinstance(error, RecursionError)
        reason = "the file is too deeply nested, which is not evaluated" if is_deep else str(error)
        return self.doubted(py.Unknown(reason, getattr(error, "at", None) or at or self.at))

    def _block(self, body: list[ast.stmt], scope: py.Scope) -> None:
        for statement in body:
            self.budget.charge(1)
            self.at = position_of(statement)
            self.statement(statement, scope)

    def _on_functiondef(self, node: ast.FunctionDef, scope: py.Scope) -> None:
        at = position_of(node)
        if node.decorator_list or getattr(node, "type_params", []):
            raise EvaluationStopped("a function with a decorator or type parameters is not evaluated", at)
        parameters = node.args
        every = (*parameters.posonlyargs, *parameters.args, *parameters.kwonlyargs, parameters.vararg, parameters.kwarg)
        function: py.Value = self.function(parameters, scope, at, partial(self._function_body, node), bound_in(node))
        for annotation in (*(parameter.annotation for parameter in every if parameter), node.returns):
            self.annotation(annotation, scope)
        scope.names[node.name] = function

    def _function_body(self, node: ast.FunctionDef, scope: py.Scope) -> py.Value:
        if any(isinstance(inner, ast.Yield | ast.YieldFrom) for inner in own_nodes(node)):
            raise EvaluationStopped("a generator function is not evaluated", position_of(node))
        try:
            self._block(node.body, scope)
        except ReturnFlow as flow:
            return flow.value
        return None

    def _on_if(self, node: ast.If, scope: py.Scope) -> None:
        self._block(node.body if truth(self.evaluate(node.test, scope)) else node.orelse, scope)

    def _on_while(self, node: ast.While, scope: py.Scope) -> None:
        while truth(self.evaluate(node.test, scope)):
            if not self._round(node.body, scope):
                return
        self._block(node.orelse, scope)

    def _on_for(self, node: ast.For, scope: py.Scope) -> None:
        items = iterate(self.evaluate(node.iter, scope))
        for item in items:
            self.bind(node.target, item, scope)
            if not self._round(node.body, scope):
                return
        self._block(node.orelse, scope)

    def _round(self, body: list[ast.stmt], scope: py.Scope) -> bool:
        """Evaluate one round of a loop; return whether the loop goes on."""
        try:
            self._block(body, scope)
        except LoopFlow as flow:
            return not flow.is_break
        return True

    def _on_with(self, node: ast.With, scope: py.Scope) -> None:
        entered: list[py.Value] = []
        for item in node.items:
            value = self.evaluate(item.context_expr, scope)
            at = position_of(item.context_expr)
            if isinstance(value, py.Call):
                self.call_value(py.BoundMethod(value, "__enter__"), py.Call("", [], {}, at))
            elif not isinstance(value, StringIO):
                raise EvaluationStopped("this use of with is not evaluated", at)
            entered.append(value)
            if item.optional_vars is not None:
                self.bind(item.optional_vars, value, scope)
        try:
            self._block(node.body, scope)
        finally:
            for value in entered:
                if isinstance(value, StringIO):
                    value.close()

    def _on_try(self, node: ast.Try, scope: py.Scope) -> None:
        """Evaluate a block; an error in it is certain, because the evaluation stops where one is only possible."""
        leaving = (part for it in node.finalbody for part in ast.walk(it))
        if any(isinstance(part, ast.Return | ast.Break | ast.Continue) for part in leaving):
            raise EvaluationStopped("leaving a finally block is not evaluated", position_of(node))
        try:
            self._guarded(node, scope)
        except (RaisedFlow, ReturnFlow, LoopFlow, ExitFlow):
            self._block(node.finalbody, scope)
            raise
        self._block(node.finalbody, scope)

    def _guarded(self, node: ast.Try, scope: py.Scope) -> None:
        before = self.handlers
        self.handlers += bool(node.handlers)
        try:
            self._block(node.body, scope)
        except RaisedFlow as raised:
            self.handlers = before
            self._handle(node, raised, scope)
            return
        finally:
            self.handlers = before
        self._block(node.orelse, scope)

    def _handle(self, node: ast.Try, raised: RaisedFlow, scope: py.Scope) -> None:
        """Evaluate the first handler that catches an error; raise it again where none does."""
        for handler in node.handlers:
            catches = _catches(handler.type, raised.kind)
            if catches is None:
                raise EvaluationStopped("whether an error is caught here is not evaluated", position_of(handler))
            if catches:
                if handler.name is not None:
                    scope.names[handler.name] = py.Unknown("the error is not evaluated", position_of(handler))
                self._block(handler.body, scope)
                if handler.name is not None:
                    scope.names.pop(handler.name, None)
                return
        self.error(raised.error.message, raised.error.at, raised.kind)


def _catches(kinds: ast.expr | None, raised: type[BaseException]) -> bool | None:
    """Return whether `except kinds:` catches an error; None where this is unknown."""
    if kinds is None:
        return True
    parts = kinds.elts if isinstance(kinds, ast.Tuple) else [kinds]
    types = [getattr(builtins, part.id, None) if isinstance(part, ast.Name) else None for part in parts]
    if any(isinstance(kind, type) and issubclass(raised, kind) for kind in types):
        return True
    return None if None in types else False
