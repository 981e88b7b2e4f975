"""Follows a Python file statement by statement, as far as that can be done without running it.

What depends on something that only a run would tell becomes Unknown, with the reason; nothing is ever guessed. Steps, sizes and
depth are bounded, so that it ends for any file.
"""

import ast
import builtins
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from grader.submission.python import expressions
from grader.submission.python.names import MODULES, import_fault, is_at_hand, public_names
from grader.submission.python.parse import Code
from grader.submission.python.values import (
    Bound,
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


class _Return(Exception):
    """A function's value on its way out."""

    def __init__(self, value: Value) -> None:
        self.value = value


class _Leave(Exception):
    """A break or continue on its way to its loop."""

    def __init__(self, *, for_good: bool) -> None:
        self.for_good = for_good


class _Raised(Exception):
    """An error on its way to a handler that may catch it."""

    def __init__(self, fault: Fault, kind: type[Exception]) -> None:
        self.fault = fault
        self.kind = kind


class Left(Exception):
    """The file ends Python, or an error does that nothing catches."""


class Exhausted(TooHard):
    """The file does more than is followed."""


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
        except (_Return, _Leave, Left):
            pass
        return self.module

    def follow(self, function: Function, spot: Spot, args: tuple[Value, ...] = ()) -> Value:
        """What a function of the file returns when it is called from outside; Unknown where it cannot be followed."""
        try:
            return self.call_function(function, list(args), {}, spot)
        except (TooHard, RecursionError) as error:
            self.stopped = str(error) if isinstance(error, TooHard) else "it is too deeply nested to follow"
            return Unknown(self.stopped, spot)
        except Left:
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
            except _Return as done:
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
            self._statement(statement, scope)

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
            raise _Raised(Fault(message, spot), kind)
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

    def _statement(self, node: ast.stmt, scope: Scope) -> None:
        match node:
            case ast.Import() | ast.ImportFrom():
                self._import(node, scope)
            case ast.Assign(targets=targets, value=value):
                result = expressions.evaluate(self, value, scope)
                for target in targets:
                    self.assign(target, result, scope)
            case ast.AnnAssign(target=target, value=expression) if expression is not None:
                self.assign(target, expressions.evaluate(self, expression, scope), scope)
            case ast.AugAssign():
                self._augment(node, scope)
            case ast.Expr(value=value):
                expressions.evaluate(self, value, scope)
            case ast.FunctionDef() | ast.AsyncFunctionDef():
                function = self.function(node, scope)
                decorated = Unknown("a function with a decorator is not followed", at(node))
                scope.bind(node.name, decorated if node.decorator_list else function)
            case ast.ClassDef():
                scope.bind(node.name, Unknown("a class is not followed", at(node)))
            case ast.Return(value=value):
                raise _Return(expressions.evaluate(self, value, scope) if value is not None else None)
            case ast.If():
                self._if(node, scope)
            case ast.For() | ast.AsyncFor():
                self._for(node, scope)
            case ast.While():
                self._while(node, scope)
            case ast.Match():
                self._match(node, scope)
            case ast.With() | ast.AsyncWith():
                for item in node.items:
                    value = expressions.evaluate(self, item.context_expr, scope)
                    if item.optional_vars is not None:
                        self.assign(item.optional_vars, value, scope)
                self.block(node.body, scope)
            case ast.Try() | ast.TryStar():
                self._try(node, scope)
            case ast.Break() | ast.Continue():
                raise _Leave(for_good=isinstance(node, ast.Break))
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
                if expressions.truth(expressions.evaluate(self, test, scope)) is False:
                    self.fault("this assertion does not hold", at(node), AssertionError)

    def _delete(self, target: ast.expr, scope: Scope) -> None:
        if isinstance(target, ast.Subscript):
            container = expressions.evaluate(self, target.value, scope)
            index = expressions.evaluate(self, target.slice, scope)
            expressions.remove(
                self, container, index, self.unsure or Unknown("what is deleted here is not followed", at(target))
            )
        elif isinstance(target, ast.Name) and self.unsure is None:
            scope.declared.get(target.id, scope).names.pop(target.id, None)
        elif isinstance(target, ast.Name):
            scope.bind(target.id, self.unsure)

    def _raise(self, node: ast.Raise, scope: Scope) -> None:
        raised = node.exc.func if isinstance(node.exc, ast.Call) else node.exc
        name = raised.id if isinstance(raised, ast.Name) else "an error"
        if node.exc is not None:
            expressions.evaluate(self, node.exc, scope)
        self.may_fail()
        kind = getattr(builtins, name, Exception)
        if self.unsure is None:
            self.fault(f"the file raises {name} here", at(node), kind if isinstance(kind, type) else Exception)
            raise Left

    def assign(self, target: ast.expr, value: Value, scope: Scope) -> None:
        """Give a name, or the names in a pattern, a value; what cannot be followed makes the name unknown."""
        if self.unsure is not None:
            value = _doubtful(value, self.unsure)
        match target:
            case ast.Name(id=name):
                scope.bind(name, value)
            case ast.Tuple(elts=parts) | ast.List(elts=parts):
                values = list(value[: len(parts) + 1]) if isinstance(value, list | tuple) else []
                if len(values) != len(parts) or any(isinstance(each, ast.Starred) for each in parts):
                    values = [Unknown("it is unpacked in a way that is not followed", at(target))] * len(parts)
                for part, each in zip(parts, values, strict=True):
                    self.assign(part.value if isinstance(part, ast.Starred) else part, each, scope)
            case ast.Subscript(value=owner, slice=key):
                container = expressions.evaluate(self, owner, scope)
                index = expressions.evaluate(self, key, scope)
                expressions.store(self, container, index, value, at(target))
            case ast.Attribute(value=owner):
                expressions.evaluate(self, owner, scope)

    @contextmanager
    def doubt(self, reason: str, spot: Spot) -> Iterator[None]:
        """Follow what may not be reached: whatever it sets is then unknown."""
        before = self.unsure
        self.unsure = before or Unknown(reason, spot)
        try:
            yield
        except _Leave:  # what follows in the loop may not be reached
            return
        self.unsure = before

    def _import(self, node: ast.Import | ast.ImportFrom, scope: Scope) -> None:
        module = "" if isinstance(node, ast.Import) else "." * node.level + (node.module or "")
        for alias in node.names:
            if not is_at_hand(module or alias.name):
                self.may_fail()
            fault = import_fault(module, alias.name)
            if fault:
                self.fault(fault, at(node), ImportError)
            full = f"{module}.{alias.name}" if module else alias.name
            if alias.name == "*" and public_names(module) is not None:
                for name in public_names(module) or ():
                    scope.bind(name, Named(f"{module}.{name}"))
            elif alias.asname:
                scope.bind(alias.asname, Named(full))
            elif module:
                scope.bind(alias.name, Named(full))
            else:
                scope.bind(alias.name.split(".")[0], Named(alias.name.split(".")[0]))

    def _augment(self, node: ast.AugAssign, scope: Scope) -> None:
        load = ast.copy_location(_as_load(node.target), node)
        before = expressions.evaluate(self, load, scope)
        value = expressions.evaluate(self, node.value, scope)
        if isinstance(node.op, ast.Add) and isinstance(before, list):
            expressions.extend(self, before, value, at(node))
            return
        self.assign(node.target, expressions.operate(self, node.op, before, value, at(node)), scope)

    def _if(self, node: ast.If, scope: Scope) -> None:
        condition = expressions.truth(expressions.evaluate(self, node.test, scope))
        if condition is None:
            self._maybe([node.body, node.orelse], scope, at(node))
        else:
            self.block(node.body if condition else node.orelse, scope)

    def _for(self, node: ast.For | ast.AsyncFor, scope: Scope) -> None:
        items = expressions.items_of(expressions.evaluate(self, node.iter, scope))
        if items is None:
            before = self.unsure
            for body in (node.body, node.body, node.orelse):  # twice: the first round may change what the second does
                with self.doubt("it happens in a loop over something that only a run would tell", at(node)):
                    self.assign(node.target, None, scope)
                    self.block(body, scope)
            self.unsure = before
            return
        before = self.unsure
        for item in items:
            self.step()
            self.assign(node.target, item, scope)
            try:
                self.block(node.body, scope)
            except _Leave as leave:
                if leave.for_good:
                    break
        else:
            self.block(node.orelse, scope)
        self.unsure = before

    def _while(self, node: ast.While, scope: Scope) -> None:
        before = self.unsure
        if expressions.truth(expressions.evaluate(self, node.test, scope)) is False:
            self.block(node.orelse, scope)
            return
        # Twice: the first round may change what the second does.
        self._maybe([node.body, node.body, node.orelse], scope, at(node))
        self.unsure = before

    def _match(self, node: ast.Match, scope: Scope) -> None:
        expressions.evaluate(self, node.subject, scope)
        for each in ast.walk(node):
            name = each.name if isinstance(each, ast.MatchAs | ast.MatchStar) else None
            if name is not None:
                scope.bind(name, Unknown("a pattern is not followed", at(node)))
        self._maybe([case.body for case in node.cases], scope, at(node))

    def _maybe(self, bodies: list[list[ast.stmt]], scope: Scope, spot: Spot) -> None:
        """Follow every branch of what only a run would decide."""
        for body in bodies:
            with self.doubt("it depends on something that only a run would tell", spot):
                self.block(body, scope)

    def _try(self, node: "ast.Try | ast.TryStar", scope: Scope) -> None:
        if not node.handlers:
            for body in (node.body, node.finalbody):
                self.block(body, scope)
            return
        before, failed_before = self.unsure, self._may_have_failed
        raised = None
        self._handlers += 1
        self._may_have_failed = False
        try:
            self.block(node.body, scope)
        except _Raised as error:
            raised = error
        finally:
            self._handlers -= 1
            may_have_failed = self._may_have_failed
            self._may_have_failed |= failed_before
        self.unsure = before
        if raised is not None:
            self._handle(node, raised, scope)
        elif may_have_failed:
            for body in (node.orelse, *(handler.body for handler in node.handlers)):
                with self.doubt("it depends on whether there was an error", at(node)):
                    self.block(body, scope)
        else:
            self.block(node.orelse, scope)
        self.block(node.finalbody, scope)

    def _handle(self, node: "ast.Try | ast.TryStar", raised: _Raised, scope: Scope) -> None:
        """Follow the first handler that catches an error; raise it further where none does."""
        for handler in node.handlers:
            catches = _catches(handler.type, raised.kind)
            if catches is False:
                continue
            if handler.name is not None:
                scope.bind(handler.name, Unknown("the error is told only by a run", at(handler)))
            if catches:
                self.block(handler.body, scope)
                return
            with self.doubt("it depends on which error there was", at(handler)):
                self.block(handler.body, scope)
        self.fault(raised.fault.message, raised.fault.at, raised.kind)


def _catches(kinds: ast.expr | None, raised: type[Exception]) -> bool | None:
    """Whether `except kinds:` catches an error; None where that cannot be told."""
    if kinds is None:
        return True
    parts = kinds.elts if isinstance(kinds, ast.Tuple) else [kinds]
    types = [getattr(builtins, part.id, None) if isinstance(part, ast.Name) else None for part in parts]
    if any(isinstance(each, type) and issubclass(raised, each) for each in types):
        return True
    return None if None in types else False


def _doubtful(value: Value, doubt: Unknown) -> Value:
    """A value that is set where it is unknown whether that is reached; functions and modules stay what they are."""
    return value if isinstance(value, Named | Function | Bound) else doubt


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


def _as_load(target: ast.expr) -> ast.expr:
    match target:
        case ast.Name(id=name):
            return ast.Name(name, ast.Load())
        case ast.Attribute(value=value, attr=attribute):
            return ast.Attribute(value, attribute, ast.Load())
        case ast.Subscript(value=value, slice=key):
            return ast.Subscript(value, key, ast.Load())
        case _:
            return target
