"""Follows a Python file statement by statement, as far as that can be done without running it.

What depends on something that only a run would tell becomes Unknown, with the reason; nothing is ever guessed. Steps, sizes and
depth are bounded, so that it ends for any file.
"""

import ast
import builtins
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from grader.static_python import expressions, statements
from grader.static_python.leaving import Exhausted, Leave, Left, Raised, Return
from grader.static_python.names import MODULES
from grader.static_python.parse import Code
from grader.static_python.values import (
    Fault,
    Function,
    Made,
    Named,
    Scope,
    Spot,
    TooHard,
    Unknown,
    Value,
    at,
)

Library = Mapping[str, Callable[["Machine", list[Value], dict[str, Value], Spot], Value]]

_MOST_STEPS = 100_000
_MOST_DEPTH = 30
_MOST_FAULTS = 200


class Machine:
    """The state of one file that is followed. `library` gives the functions that can be followed, by full name."""

    def __init__(self, code: Code, library: Library, *, special: Mapping[str, Value]) -> None:
        """`special` holds the names that Python itself sets, such as __file__."""
        self.code = code
        self.library = library
        self.module = Scope({"__name__": "__main__", **special})
        self.faults: list[Fault] = []
        self.notes: list[Any] = []  # what functions of the library have to say
        self.made: list[Made] = []  # every call of something outside, in order
        self.unsure: Unknown | None = None  # set while it is unknown whether a statement is reached
        self.stopped = ""  # why the file is not followed to its end
        self._handlers = 0  # how many blocks around this place catch errors
        self._may_have_failed = False  # whether an error may have come up in the innermost of them
        self._generators: dict[ast.AST, bool] = {}
        self._messages: set[str] = set()
        self._steps = 0
        self._depth = 0

    def run(self) -> Scope:
        """Follow the whole file; its names afterwards. Never raises."""
        try:
            self.block(self.code.tree.body, self.module)
        except (TooHard, RecursionError) as error:
            self.stopped = str(error) if isinstance(error, TooHard) else "it is too deeply nested to follow"
        except (Return, Leave, Left):
            pass
        return self.module

    def follow(self, function: Function, spot: Spot, args: tuple[Value, ...] = ()) -> Value:
        """What a function of the file returns when it is called from outside; Unknown where it cannot be followed."""
        try:
            return self.call_function(function, list(args), {}, spot)
        except (TooHard, RecursionError) as error:
            self.stopped = str(error) if isinstance(error, TooHard) else "it is too deeply nested to follow"
            return Unknown(self.stopped, spot)
        except (Left, Leave):  # or a break outside of a loop, which ast lets pass
            return Unknown("the file ends Python here", spot)

    def step(self, count: int = 1) -> None:
        """Count steps; raises Exhausted."""
        self._steps += count
        if self._steps > _MOST_STEPS:
            raise Exhausted("it takes too many steps to follow")

    def call_function(self, function: Function, args: list[Value], kwargs: dict[str, Value], spot: Spot) -> Value:
        """The value that a function of the file returns."""
        self._depth += 1
        if self._depth > _MOST_DEPTH:
            self._depth -= 1
            return Unknown("functions call each other too deeply to follow", spot)
        try:
            scope = Scope(_parameters(self, function, args, kwargs, spot), function.scope)
            if isinstance(function.node, ast.Lambda):
                return expressions.evaluate(self, function.node.body, scope)
            if self._is_generator(function.node):
                return Unknown("a generator function is not followed", spot)
            before = self.unsure
            try:
                self.block(function.node.body, scope)
            except Return as done:
                if self.unsure is not before and self.unsure is not None:
                    return Unknown(self.unsure.reason, self.unsure.at)
                return done.value
            finally:
                self.unsure = before
            return None
        finally:
            self._depth -= 1

    def block(self, body: list[ast.stmt], scope: Scope) -> None:
        """Follow statements in order."""
        for statement in body:
            self.step()
            if self._may_have_failed and self._handlers and self.unsure is None:
                self.unsure = Unknown("an error before it may have been caught", at(statement))
            statements.follow_statement(self, statement, scope)

    def guarded(self, body: list[ast.stmt], scope: Scope) -> tuple[Raised | None, bool]:
        """Follow statements whose errors are caught: the error that certainly comes up, and whether another one may."""
        failed_before, self._may_have_failed = self._may_have_failed, False
        self._handlers += 1
        try:
            self.block(body, scope)
        except Raised as error:
            return error, True
        finally:
            self._handlers -= 1
            failed, self._may_have_failed = self._may_have_failed, self._may_have_failed or failed_before
        return None, failed

    def assign(self, target: ast.expr, value: Value, scope: Scope) -> None:
        """Give a name, or the names in a pattern, a value."""
        statements.assign(self, target, value, scope)

    def find(self, node: ast.Name, scope: Scope) -> Value:
        """The value of a name; of one that is not defined, what was most likely meant, and a fault."""
        try:
            return scope.find(node.id)
        except KeyError:
            pass
        if hasattr(builtins, node.id):
            return Named(f"builtins.{node.id}")
        if "*" in self.module.names or node.id.startswith("__"):
            return Unknown(f"where the name {node.id!r} comes from is told only by a run", at(node))
        self.fault(f"the name {node.id!r} is used, but not defined or imported", at(node), NameError)
        return Named(MODULES.get(node.id, f"?.{node.id}"))

    def fault(self, message: str, spot: Spot, kind: type[Exception] = TypeError) -> None:
        """Note, once, what stops Python here, if it is certain that it comes here; `kind` tells which handlers catch it."""
        if self.unsure is not None:
            return
        if self._handlers:
            raise Raised(Fault(message, spot), kind)
        if message not in self._messages and len(self.faults) < _MOST_FAULTS:
            self._messages.add(message)
            self.faults.append(Fault(message, spot))

    def may_fail(self) -> None:
        """Note that what happens here may raise an error."""
        self._may_have_failed = True

    def leave(self, made: Made) -> None:
        """End the file here, as sys.exit does; raises Left where it is certain that it comes here."""
        if self.unsure is None and not self._handlers:
            if made.args and made.args[0] not in (0, None):
                self.fault("the file ends here, with an error", made.at)
            raise Left
        self.may_fail()

    def function(self, node: "ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda", scope: Scope) -> Function:
        """A function as it is defined: its defaults have their values from then on."""
        wanted = node.args
        with_default = [*wanted.posonlyargs, *wanted.args][::-1]
        defaults = list(zip(with_default, wanted.defaults[::-1], strict=False))
        defaults += [
            (each, it) for each, it in zip(wanted.kwonlyargs, wanted.kw_defaults, strict=True) if it is not None
        ]
        return Function(node, scope, {each.arg: expressions.evaluate(self, it, scope) for each, it in defaults})

    def _is_generator(self, node: "ast.FunctionDef | ast.AsyncFunctionDef") -> bool:
        if node not in self._generators:
            self._generators[node] = any(isinstance(each, ast.Yield | ast.YieldFrom) for each in ast.walk(node))
        return self._generators[node]

    @contextmanager
    def doubt(self, reason: str, spot: Spot) -> Iterator[None]:
        """Follow what may not be reached: whatever it sets is then unknown."""
        before = self.unsure
        self.unsure = before or Unknown(reason, spot)
        try:
            yield
        except Leave:  # what follows in the loop may not be reached
            return
        self.unsure = before


def _parameters(
    machine: Machine, function: Function, args: list[Value], kwargs: dict[str, Value], spot: Spot
) -> dict[str, Value]:
    """The names that a function's parameters get."""
    wanted = function.node.args
    positional = [*wanted.posonlyargs, *wanted.args]
    known = {each.arg for each in [*positional, *wanted.kwonlyargs]}
    unpacked = kwargs.get("**")  # arguments that are not known, any of them
    given = {parameter.arg: value for parameter, value in zip(positional, args, strict=False)}
    given |= {name: value for name, value in kwargs.items() if name in known}
    missing = sorted(known - given.keys() - function.defaults.keys())
    too_many = len(args) > len(positional) and not wanted.vararg
    if unpacked is None and (missing or too_many or (kwargs.keys() - known and not wanted.kwarg)):
        what = f"the argument {missing[0]!r} is not given" if missing else "there is an argument too many"
        machine.fault(f"{what} in the call of this function", spot)
    not_given = dict.fromkeys(missing, Unknown("an argument is not given", spot))
    defaults = dict.fromkeys(known, unpacked) if unpacked is not None else {**not_given, **function.defaults}
    names: dict[str, Value] = {**defaults, **given}
    if wanted.vararg:
        names[wanted.vararg.arg] = tuple(args[len(positional) :])
    if wanted.kwarg:
        names[wanted.kwarg.arg] = {name: value for name, value in kwargs.items() if name not in known}
    return names
