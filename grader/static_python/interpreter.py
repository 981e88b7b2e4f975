"""Evaluate a whole Python file without running it: its blocks, functions, branches, loops and error handlers."""

import ast
import builtins
from collections.abc import Mapping, Sequence
from functools import partial

from grader.static_python.evaluation import EvaluationStopped, ExitFlow, FunctionTable, LoopFlow, RaisedFlow, ReturnFlow
from grader.static_python.parse import Code, Position, position_of
from grader.static_python.statements import StatementEvaluator
from grader.static_python.values import UNKNOWN_KEYS, Call, Function, Scope, Unknown, Value, items_of, truth

_CONDITION = "a condition is known only at run time"


class Interpreter(StatementEvaluator):
    """Adds the statements that have blocks."""

    def __init__(self, functions: FunctionTable, names: Mapping[str, Value]) -> None:
        """`names` are those that Python itself binds, such as __file__."""
        super().__init__(functions, {"__name__": "__main__", **names})
        self.stop_reason = ""  # why the file is not evaluated to its end
        self._has_generators = True
        self._generators: dict[ast.AST, bool] = {}

    def run(self, code: Code) -> Scope:
        """Evaluate a whole file and return the scope of its names. Never raises."""
        self._has_generators = "yield" in code.source.text
        try:
            self._block(code.tree.body, self.module)
        except (EvaluationStopped, RecursionError) as error:
            self._stop(error)
        except (ReturnFlow, LoopFlow, ExitFlow):  # also a break outside of a loop, which ast accepts
            pass
        return self.module

    def call_from_outside(self, function: Function, at: Position, args: Sequence[Value] | None = ()) -> Value:
        """Return the value of a call of one of the file's functions. Never raises.

        With `args` None, the arguments are unknown, and no error in the call counts: it may never happen.
        """
        unknown = {UNKNOWN_KEYS: Unknown("an event is known only at run time", at)} if args is None else {}
        recorded = list(self.errors)
        try:
            return self.call_function(function, Call("", list(args or ()), unknown, at))
        except (EvaluationStopped, RecursionError) as error:
            return Unknown(self._stop(error), at)
        except (ExitFlow, LoopFlow):
            return Unknown("the file exits here", at)
        finally:
            if args is None:
                self.errors = recorded

    def _functiondef(self, node: ast.FunctionDef | ast.AsyncFunctionDef, scope: Scope) -> None:
        function = self.function(node.args, scope, position_of(node), partial(self._function_body, node))
        for parameter in getattr(node, "type_params", ()):  # Python 3.12
            scope.bind(parameter.name, Unknown("a type is not supported", position_of(node)))
        decorated = Unknown("a decorator is not supported", position_of(node))
        scope.bind(node.name, decorated if node.decorator_list else function)

    def _if(self, node: ast.If, scope: Scope) -> None:
        condition = truth(self.evaluate(node.test, scope))
        if condition is None:
            self._branches([node.body, node.orelse], scope, position_of(node))
        else:
            self._block(node.body if condition else node.orelse, scope)

    def _while(self, node: ast.While, scope: Scope) -> None:
        before = self.uncertainty
        if truth(self.evaluate(node.test, scope)) is False:
            self._block(node.orelse, scope)
        else:  # the body twice: its first round may change what the second one does
            self._branches([node.body, node.body, node.orelse], scope, position_of(node))
        self.uncertainty = before

    def _match(self, node: ast.Match, scope: Scope) -> None:
        self.evaluate(node.subject, scope)
        for pattern in ast.walk(node):
            if isinstance(pattern, ast.MatchAs | ast.MatchStar) and pattern.name is not None:
                scope.bind(pattern.name, Unknown("a pattern is not supported", position_of(node)))
        self._branches([case.body for case in node.cases], scope, position_of(node))

    def _with(self, node: ast.With | ast.AsyncWith, scope: Scope) -> None:
        for item in node.items:
            value = self.evaluate(item.context_expr, scope)
            if item.optional_vars is not None:
                self.assign(item.optional_vars, value, scope)
        self._block(node.body, scope)

    _asyncfunctiondef, _asyncwith = _functiondef, _with

    def _stop(self, error: Exception) -> str:
        is_deep = isinstance(error, RecursionError)
        self.stop_reason = "the file is too deeply nested to evaluate" if is_deep else str(error)
        return self.stop_reason

    def _block(self, body: list[ast.stmt], scope: Scope) -> None:
        for statement in body:
            self.step()
            if self.may_have_failed and self.handlers and self.uncertainty is None:
                self.uncertainty = Unknown("an earlier error may have been caught", position_of(statement))
            self.statement(statement, scope)

    def _branches(self, bodies: list[list[ast.stmt]], scope: Scope, at: Position, reason: str = _CONDITION) -> None:
        """Evaluate blocks of which only a run decides which are executed."""
        for body in bodies:
            with self.uncertain(reason, at):
                self._block(body, scope)

    def _function_body(self, node: ast.FunctionDef | ast.AsyncFunctionDef, scope: Scope, at: Position) -> Value:
        if self._has_generators and node not in self._generators:
            self._generators[node] = any(isinstance(inner, ast.Yield | ast.YieldFrom) for inner in ast.walk(node))
        if self._generators.get(node):
            return Unknown("a generator function is not supported", at)
        before = self.uncertainty
        try:
            self._block(node.body, scope)
        except ReturnFlow as flow:
            return flow.value if self.uncertainty is before or self.uncertainty is None else self.uncertainty
        finally:
            self.uncertainty = before
        return None

    def _for(self, node: ast.For | ast.AsyncFor, scope: Scope) -> None:
        items = items_of(self.evaluate(node.iter, scope))
        before = self.uncertainty
        if items is None:
            for body in (node.body, node.body, node.orelse):  # the body twice, as that of a while loop
                with self.uncertain("the items of a loop are known only at run time", position_of(node)):
                    self.assign(node.target, None, scope)
                    self._block(body, scope)
        for item in items or ():
            self.step()
            self.assign(node.target, item, scope)
            try:
                self._block(node.body, scope)
            except LoopFlow as flow:
                if flow.is_break:
                    break
        else:
            self._block(node.orelse if items is not None else [], scope)
        self.uncertainty = before

    def _try(self, node: ast.Try | ast.TryStar, scope: Scope) -> None:
        if not node.handlers:
            self._block(node.body, scope)
        else:
            raised, may_have_failed = self._guard(node.body, scope)
            if raised is not None:
                self._handle(node, raised, scope)
            elif may_have_failed:
                bodies = [node.orelse, *(handler.body for handler in node.handlers)]
                self._branches(bodies, scope, position_of(node), "whether an error is raised is known only at run time")
            else:
                self._block(node.orelse, scope)
        self._block(node.finalbody, scope)

    _asyncfor, _trystar = _for, _try

    def _guard(self, body: list[ast.stmt], scope: Scope) -> tuple[RaisedFlow | None, bool]:
        """Evaluate a block whose errors are caught; return the certainly raised error, and whether another may be."""
        before, failed_before, self.may_have_failed = self.uncertainty, self.may_have_failed, False
        self.handlers += 1
        raised: RaisedFlow | None = None
        try:
            self._block(body, scope)
        except RaisedFlow as error:
            raised = error
        finally:
            self.handlers -= 1
            failed, self.may_have_failed = self.may_have_failed, self.may_have_failed or failed_before
        self.uncertainty = before
        return raised, failed

    def _handle(self, node: ast.Try | ast.TryStar, raised: RaisedFlow, scope: Scope) -> None:
        """Evaluate the first handler that catches an error; raise it again where none does."""
        for handler in node.handlers:
            catches = _catches(handler.type, raised.kind)
            if catches is False:
                continue
            if handler.name is not None:
                scope.bind(handler.name, Unknown("the error is known only at run time", position_of(handler)))
            if catches:
                self._block(handler.body, scope)
                return
            reason = "which error is raised is known only at run time"
            self._branches([handler.body], scope, position_of(handler), reason)
        self.error(raised.error.message, raised.error.at, raised.kind)


def _catches(kinds: ast.expr | None, raised: type[Exception]) -> bool | None:
    """Return whether `except kinds:` catches an error; None where this is unknown."""
    if kinds is None:
        return True
    parts = kinds.elts if isinstance(kinds, ast.Tuple) else [kinds]
    types = [getattr(builtins, part.id, None) if isinstance(part, ast.Name) else None for part in parts]
    if any(isinstance(kind, type) and issubclass(raised, kind) for kind in types):
        return True
    return None if None in types else False
