"""The state of a static evaluation: steps, errors, recorded calls, whether the current statement is certainly reached.

What depends on something known only at run time becomes Unknown, with the reason; nothing is guessed. Steps, sizes and
depth are bounded, so that the evaluation of any file ends.
"""

import ast
import builtins
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import NamedTuple

from grader.static_python.imports import USUAL_NAMES
from grader.static_python.parse import Position, position_of
from grader.static_python.values import MAX_ITEMS, UNKNOWN_KEYS, Call, Function, QualifiedName, Scope, Unknown, Value


class PythonError(NamedTuple):
    """An error that certainly stops Python at this position: an undefined name, an import that fails."""

    message: str
    at: Position


class ReturnFlow(Exception):
    """A return statement, with its value."""

    def __init__(self, value: Value) -> None:
        self.value = value


class LoopFlow(Exception):
    """A break or continue statement."""

    def __init__(self, *, is_break: bool) -> None:
        self.is_break = is_break


class RaisedFlow(Exception):
    """An error for which a handler is searched; `kind` decides which handler catches it."""

    def __init__(self, error: PythonError, kind: type[Exception]) -> None:
        self.error = error
        self.kind = kind


class ExitFlow(Exception):
    """The end of the program, by sys.exit or by an error that nothing catches."""


class EvaluationStopped(Exception):
    """The evaluation ends here: it takes too many steps, or nothing that follows can be determined."""


# The functions that are evaluated, by their full names: each takes its call, with the arguments, and returns its value.
FunctionTable = Mapping[str, Callable[["Evaluation", Call], Value]]

_EXITS = ("sys.exit", "os._exit", "builtins.exit", "builtins.quit")
_MAX_STEPS = 100_000
_MAX_DEPTH = 30
_MAX_ERRORS = 200


class Evaluation:
    """The state of one evaluation; what it evaluates is added by ExpressionEvaluator and Interpreter."""

    def __init__(self, functions: FunctionTable, names: Mapping[str, Value]) -> None:
        """`functions` has every function that is evaluated; `names` are bound from the beginning, such as __file__."""
        self.functions = functions
        self.module = Scope(dict(names))
        self.errors: list[PythonError] = []
        self.calls: list[Call] = []  # every call that is not evaluated, in order
        self.uncertainty: Unknown | None = None  # set while it is unknown whether a statement is reached
        self.handlers = 0  # how many blocks around this place catch errors
        self.may_have_failed = False  # whether an error may have been raised in the innermost of them
        self._steps = 0
        self._depth = 0

    def step(self, count: int = 1) -> None:
        """Count steps; raises EvaluationStopped."""
        self._steps += count
        if self._steps > _MAX_STEPS:
            raise EvaluationStopped("the evaluation takes too many steps")

    def error(self, message: str, at: Position, kind: type[Exception] = TypeError) -> None:
        """Record once an error that stops Python at a place certainly reached; `kind` decides what catches it."""
        if self.uncertainty is not None:
            return
        if self.handlers:
            raise RaisedFlow(PythonError(message, at), kind)
        if len(self.errors) < _MAX_ERRORS and all(message != error.message for error in self.errors):
            self.errors.append(PythonError(message, at))

    def record(self, call: Call) -> Call:
        """Record a call that is not evaluated, and return it as its result. Raises ExitFlow if it certainly exits."""
        if call.name in _EXITS and self.uncertainty is None and not self.handlers:
            if call.args and call.args[0] not in (0, None):
                self.error("the file exits here with an error", call.at)
            raise ExitFlow
        if not call.name.startswith("builtins.open"):
            self.may_have_failed = True
        call.uncertainty = self.uncertainty
        if len(self.calls) < MAX_ITEMS:
            self.calls.append(call)
        return call

    def find(self, node: ast.Name, scope: Scope) -> Value:
        """Return the value of a name. An undefined name is an error; its value is the most likely intended one."""
        try:
            return scope.find(node.id)
        except KeyError:
            pass
        if hasattr(builtins, node.id):
            return QualifiedName(f"builtins.{node.id}")
        if "*" in self.module.names or node.id.startswith("__"):
            return Unknown(f"the definition of {node.id!r} is known only at run time", position_of(node))
        self.error(f"the name {node.id!r} is not defined or imported", position_of(node), NameError)
        return QualifiedName(USUAL_NAMES.get(node.id, f"?.{node.id}"))

    def call_function(self, function: Function, call: Call) -> Value:
        """Return the value of a call of a function of the file."""
        if self._depth == _MAX_DEPTH:
            return Unknown("functions call each other too deeply", call.at)
        self._depth += 1
        try:
            return function.body(Scope(self._bound_parameters(function, call), function.scope), call.at)
        finally:
            self._depth -= 1

    def apply(self, function: Value, item: Value, at: Position) -> Value:
        """Return the value of a function for one item, as map and sorted call it."""
        self.step()
        call = Call(getattr(function, "name", ""), [item], {}, at)
        if isinstance(function, Function):
            return self.call_function(function, call)
        evaluate = self.functions.get(call.name)
        return evaluate(self, call) if evaluate is not None else Unknown("this function is not supported", at)

    @contextmanager
    def uncertain(self, reason: str, at: Position) -> Iterator[None]:
        """Evaluate what may not be reached: whatever it binds is unknown then."""
        before = self.uncertainty
        self.uncertainty = before or Unknown(reason, at)
        try:
            yield
        except LoopFlow:  # the rest of the loop may not be reached: it stays uncertain
            return
        self.uncertainty = before

    def _bound_parameters(self, function: Function, call: Call) -> dict[str, Value]:
        """Return the values of a function's parameters by their names."""
        parameters = function.parameters
        positional = [parameter.arg for parameter in (*parameters.posonlyargs, *parameters.args)]
        names = {*positional, *(parameter.arg for parameter in parameters.kwonlyargs)}
        unpacked = call.kwargs.get(UNKNOWN_KEYS)  # represents any argument
        given = dict(zip(positional, call.args, strict=False))
        given |= {name: value for name, value in call.kwargs.items() if name in names}
        missing = sorted(names - given.keys() - function.defaults.keys())
        excess = len(call.args) > len(positional) and not parameters.vararg
        if unpacked is None and (missing or excess or (call.kwargs.keys() - names and not parameters.kwarg)):
            what = f"the argument {missing[0]!r} is missing" if missing else "there is one argument too many"
            self.error(f"{what} in this call", call.at)
        defaults = {**dict.fromkeys(missing, Unknown("an argument is missing", call.at)), **function.defaults}
        bound: dict[str, Value] = {**(dict.fromkeys(names, unpacked) if unpacked is not None else defaults), **given}
        if parameters.vararg:
            bound[parameters.vararg.arg] = tuple(call.args[len(positional) :])
        if parameters.kwarg:
            bound[parameters.kwarg.arg] = {name: value for name, value in call.kwargs.items() if name not in names}
        return bound
