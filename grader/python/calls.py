"""Calls in a file: of its own functions, of the functions in the table, and of methods."""

import ast
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import PurePosixPath

from grader.python import values as py
from grader.python.builtins import BUILTINS, call
from grader.python.evaluation import FAILED, NOT_EVALUATED, Evaluation
from grader.python.knowledge import call_plain, iterate, known, reason_of
from grader.python.operators import method
from grader.python.parse import Position, position_of

_MAX_DEPTH = 30
_CHANGING: Mapping[type, tuple[str, ...]] = {
    list: ("append", "extend", "insert", "sort", "reverse", "pop"),
    dict: ("update", "pop"),
}
_TEXT_METHODS = frozenset(name for name in dir(str) if not name.startswith("_"))


class Calls(Evaluation):
    """Adds the calls of what a file names."""

    _depth = 0

    def function(
        self,
        parameters: ast.arguments,
        scope: py.Scope,
        at: Position,
        body: Callable[[py.Scope], py.Value],
        local: frozenset[str] = frozenset(),
    ) -> py.Function:
        """Return a function as it is defined: its defaults are evaluated now."""
        positional = reversed([*parameters.posonlyargs, *parameters.args])
        pairs = list(zip(positional, reversed(parameters.defaults), strict=False))[::-1]
        named = zip(parameters.kwonlyargs, parameters.kw_defaults, strict=True)
        pairs += [(parameter, default) for parameter, default in named if default is not None]
        defaults = {parameter.arg: self.evaluate(default, scope) for parameter, default in pairs}
        return py.Function(parameters, scope, defaults, body, at, local)

    def unpack(self, kwargs: dict[str, py.Value], value: py.Value, node: ast.expr) -> None:
        """Add the arguments that ** unpacks."""
        if not isinstance(value, dict):
            reason = reason_of(value) or f"this use of ** {NOT_EVALUATED}"
            raise py.Undetermined(reason, position_of(node), is_final=True)
        for key, item in value.items():
            if not isinstance(key, str) or key in kwargs:
                raise py.EvaluationFails(f"TypeError: ** unpacks the key {key!r}, which is no text or given twice")
            kwargs[key] = item

    def called(self, function: py.Value, args: list[py.Value], kwargs: dict[str, py.Value], node: ast.expr) -> py.Value:
        """Return the value of a call of any value."""
        return self.call_value(function, py.Call("", args, kwargs, position_of(node)))

    def call_value(self, function: py.Value, made: py.Call) -> py.Value:
        """Return the value of a call; the call gets its name here."""
        self.budget.charge(1 + len(made.args) + len(made.kwargs))
        found: py.Value = None
        match function:
            case py.Function():
                found = self.call_function(function, made)
            case py.QualifiedName(name=name):
                if name == "glob":
                    self.error("glob is a module here and cannot be called: write glob.glob(...)", made.at)
                made.name = "glob.glob" if name in ("glob", "?glob") else name
                found = self._by_name(made)
            case py.BoundMethod(owner=py.Call() as owner, name=name):
                made.name, made.owner = f"{owner.name}.{name}", owner
                found = self._by_name(made)
            case py.BoundMethod(owner=owner, name=name):
                found = self._method(owner, name, made)
            case py.PlainFunction():
                found = self._plain(function, made)
            case py.Unknown(reason=reason) if reason == FAILED:
                found = function
            case _ if isinstance(function, py.PLAIN):
                kind = type(function).__name__
                raise py.EvaluationFails(f"a {kind} cannot be called: is there a comma missing before it?")
            case _:
                reason = f"this call {NOT_EVALUATED}: {reason_of(function)}".rstrip(": ")
                raise py.Undetermined(reason, made.at, is_final=True)
        return found

    def _plain(self, function: py.PlainFunction, made: py.Call) -> py.Value:
        """Return the value of Python's own function; stop where it would call others, or use up an iterator."""
        try:
            return call(function, made.args, made.kwargs, self.budget, partial(self._apply, made.at))
        except py.Undetermined as error:
            given = (*made.args, *made.kwargs.values())
            if any(isinstance(value, py.Function | py.BoundMethod | py.QualifiedName | py.Items) for value in given):
                raise py.Undetermined(str(error), error.at or made.at, is_final=True) from None
            raise

    def _apply(self, at: Position, function: py.Value, args: list[py.Value]) -> py.Value:
        return self.call_value(function, py.Call("", args, {}, at))

    def _by_name(self, made: py.Call) -> py.Value:
        """Return the value of a call of something outside of the file, by the table."""
        function = self.functions.get(made.name)
        if function is None and made.name.startswith("?."):  # an undefined name, which is an error already
            return py.Unknown(FAILED, made.at)
        if function is None:
            reason = f"{made.name.removeprefix('builtins.')} {NOT_EVALUATED}"
            raise py.Undetermined(reason, made.at, is_final=True)
        return self.call_value(function, made) if isinstance(function, py.PlainFunction) else function(self, made)

    def _method(self, owner: py.Value, name: str, made: py.Call) -> py.Value:
        """Return the value of a method. Of what is not known, only a method of texts is known to change nothing."""
        if isinstance(owner, PurePosixPath) and f"pathlib.Path.{name}" in self.functions:
            made.name, made.args = f"pathlib.Path.{name}", [owner, *made.args]
            return self._by_name(made)
        if any(isinstance(owner, kind) and name in names for kind, names in _CHANGING.items()):
            return self._change(owner, name, made)
        found = method(owner, name, self.budget)
        if found is not None:
            return self.call_value(found, made)
        if isinstance(owner, py.Unknown) and (name in _TEXT_METHODS or owner.reason == FAILED):
            raise py.Undetermined(owner.reason, owner.at)
        raise py.Undetermined(f"the method {name} of this value {NOT_EVALUATED}", made.at, is_final=True)

    def _change(self, owner: py.Value, name: str, made: py.Call) -> py.Value:
        """Run a method that changes a list or dict: Python's own."""
        try:
            self.budget.measure([made.args, [*made.kwargs.values()]], "holds")
            self.budget.charge(len(owner) // 16 if name != "append" else 0)
            args, kwargs = made.args, made.kwargs
            if name == "sort":
                arguments = [owner, *args]
                owner[:] = call(BUILTINS["sorted"], arguments, kwargs, self.budget, partial(self._apply, made.at))
                return None
            if name in ("extend", "update"):
                args = [value if isinstance(value, dict) else list(iterate(value)) for value in args]
            elif name != "append":
                known(args if name != "insert" else args[:1])
            return self.budget.checked(call_plain(getattr(owner, name), *args, **kwargs))
        except py.Undetermined as error:
            if error.is_final:
                raise
            reason = f"the method {name} {NOT_EVALUATED} here: {error}"
            raise py.Undetermined(reason, made.at, is_final=True) from None

    def call_function(self, function: py.Function, made: py.Call) -> py.Value:
        """Return the value of a call of a function of the file."""
        if self._depth == _MAX_DEPTH:
            raise py.Undetermined(f"a function that calls others so deeply {NOT_EVALUATED}", made.at, is_final=True)
        scope = py.Scope(self._bound_parameters(function, made), function.scope, function.local)
        self._depth += 1
        try:
            return function.body(scope)
        finally:
            self._depth -= 1

    def _bound_parameters(self, function: py.Function, made: py.Call) -> dict[str, py.Value]:
        """Return the values of a function's parameters by their names."""
        parameters = function.parameters
        positional = [parameter.arg for parameter in (*parameters.posonlyargs, *parameters.args)]
        names = {*positional, *(parameter.arg for parameter in parameters.kwonlyargs)}
        given = dict(zip(positional, made.args, strict=False))
        others = {name: value for name, value in made.kwargs.items() if name not in names or name in given}
        missing = sorted(names - given.keys() - made.kwargs.keys() - function.defaults.keys())
        if missing or (len(made.args) > len(positional) and not parameters.vararg) or (others and not parameters.kwarg):
            what = f"the argument {missing[0]!r} is missing" if missing else "there is one argument too many"
            self.error(f"{what} in this call", made.at)
        bound = {**dict.fromkeys(names, py.Unknown("an argument is missing", made.at)), **function.defaults, **given}
        bound |= {name: value for name, value in made.kwargs.items() if name in names}
        if parameters.vararg:
            bound[parameters.vararg.arg] = tuple(made.args[len(positional) :])
        if parameters.kwarg:
            bound[parameters.kwarg.arg] = others
        return bound
