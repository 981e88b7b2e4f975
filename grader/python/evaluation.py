"""The state of the evaluation of a file: its errors, what is recorded, and the first thing that is not evaluated."""

import ast
import builtins
from collections.abc import Collection, Mapping
from typing import NamedTuple

from grader.python import values as py
from grader.python.budget import Budget
from grader.python.builtins import BUILTINS, truth
from grader.python.expressions import Expressions
from grader.python.knowledge import reason_of
from grader.python.library import PYTHON_3_12, USUAL_NAMES
from grader.python.parse import START, Position, position_of


class PythonError(NamedTuple):
    """An error that certainly stops Python at this position: an undefined name, an import that fails."""

    message: str
    at: Position


NOT_EVALUATED = "is not evaluated"
FAILED = "Python raises an error before"  # the reason of a value that would follow
# All parts of such an expression are evaluated before the expression itself; such a part may change something.
_WHOLE = (ast.Name, ast.Call, ast.BinOp, ast.UnaryOp, ast.Attribute, ast.Subscript, ast.JoinedStr, ast.FormattedValue)
_CHANGING = (ast.Call, ast.NamedExpr, ast.Await, ast.Yield, ast.YieldFrom)
_MAX_ERRORS = 200
_MAX_CALLS = 20_000


class Evaluation(Expressions):
    """The state of the evaluation of a file.

    A part of an expression that is not known is Unknown: names, lists and arguments keep it, an operation with it is
    unknown as well. Only what the table of functions lists is called. Whatever else a file calls may do anything, so
    the evaluation stops there.
    """

    def __init__(self, functions: py.FunctionTable, names: Mapping[str, py.Value], budget: Budget) -> None:
        """`functions` has every function that is evaluated; `names` are bound from the beginning, such as __file__."""
        super().__init__(self._builtin, budget)
        self.functions = functions
        self.exports: Mapping[str, Collection[str]] = {}
        self.local_modules: Collection[str] = ()
        self.module = py.Scope({"__name__": "__main__", **names})
        self.errors: list[PythonError] = []
        self.calls: list[py.Call] = []  # what is recorded, in order
        self.doubt: py.Unknown | None = None  # the first that may have failed, or stopped the evaluation
        self.at = START  # the statement that is evaluated

    def doubted(self, unknown: py.Unknown) -> py.Unknown:
        """Keep that an error may have been raised here, and return the unknown value."""
        self.doubt = self.doubt or unknown
        return unknown

    def error(self, message: str, at: Position) -> None:
        """Record once an error that certainly stops Python."""
        if len(self.errors) < _MAX_ERRORS and all(message != error.message for error in self.errors):
            self.errors.append(PythonError(message, at))

    def evaluate(self, node: ast.expr, scope: py.Scope) -> py.Value:
        """Return the value of an expression; Unknown, with the reason, where it cannot be determined.

        The evaluation stops if a part of the expression may have changed something and is not evaluated.
        """
        try:
            return self.value(node, scope)
        except py.Undetermined as error:
            unknown = py.Unknown(str(error), error.at or position_of(node))
            may_change = not isinstance(node, _WHOLE) and any(isinstance(part, _CHANGING) for part in ast.walk(node))
            if error.is_final or may_change:
                raise py.Undetermined(unknown.reason, unknown.at, is_final=True) from None
            return self.doubted(unknown)
        except py.EvaluationFails as error:
            self.error(str(error), position_of(node))
            return py.Unknown(FAILED, position_of(node))

    def _of_name(self, node: ast.Name, scope: py.Scope) -> py.Value:
        """Return the value of a name. An undefined name is an error; its value is the most likely intended one."""
        try:
            return scope.find(node.id)
        except KeyError:
            pass
        if hasattr(builtins, node.id) and node.id not in PYTHON_3_12:
            return self._builtin(node.id)
        if node.id.startswith("__"):
            raise py.Undetermined(f"the name {node.id!r} {NOT_EVALUATED}")
        self.error(f"the name {node.id!r} is not defined or imported", position_of(node))
        return py.QualifiedName(USUAL_NAMES.get(node.id, f"?.{node.id}"))

    def _builtin(self, name: str) -> py.Value:
        full = f"builtins.{name}"
        return BUILTINS[name] if name in BUILTINS and full not in self.functions else py.QualifiedName(full)

    def test(self, value: py.Value, branches: Collection[ast.expr]) -> bool:
        """Return whether a condition holds; stop if that is unknown and a branch may change something."""
        if isinstance(value, py.Unknown | py.Call | py.QualifiedName | py.BoundMethod):
            nodes = (node for branch in branches for node in ast.walk(branch))
            if any(isinstance(node, _CHANGING) for node in nodes):
                reason = f"a condition {NOT_EVALUATED}: {reason_of(value)}"
                raise py.Undetermined(reason, getattr(value, "at", self.at), is_final=True)
        return truth(value)


def record(evaluation: Evaluation, made: py.Call) -> py.Call:
    """Record a call that is not evaluated further, and return it as its result: a function for the table."""
    if len(evaluation.calls) < _MAX_CALLS:
        evaluation.calls.append(made)
        if made.owner is not None:
            made.owner.method_calls.append(made)
    return made
