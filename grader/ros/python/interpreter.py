"""Evaluate a whole Python file without running it.

This covers its functions, branches, loops, assignments and imports.

A statement of any other kind, such as `try` or `while`, ends the evaluation: what follows is not
known.
"""

import ast
import builtins
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from copy import copy
from functools import partial
from io import StringIO
from itertools import chain
from operator import delitem, setitem
from pathlib import PurePosixPath
from typing import Any, ClassVar

from grader.base.names import closest
from grader.ros.known.python_names import python_names
from grader.ros.known.releases import RELEASES
from grader.ros.python.bindings import names_bound
from grader.ros.python.budget import Budget
from grader.ros.python.builtins import truth
from grader.ros.python.evaluation import MISSING_COMMA, NOT_EVALUATED, Evaluation, spread
from grader.ros.python.library import (
    CONSTANTS,
    Uncertain,
    attribute_error,
    import_error,
    imported_names,
    usual_meaning,
)
from grader.ros.python.operators import has_attribute, operate
from grader.ros.python.parse import Code, Position, bound_in, caught_by, make_position, own_nodes
from grader.ros.python.values import (
    PLAIN,
    BoundMethod,
    Call,
    ClassBody,
    EvaluationFails,
    EvaluationSignal,
    Function,
    FunctionTable,
    InnerScope,
    Items,
    Namespace,
    PlainFunction,
    QualifiedName,
    Scope,
    Undetermined,
    Unknown,
    Value,
    call_plain,
    charge_str,
    known,
    one_of,
    refuse,
)
from grader.ros.python.walking import walk

_PARTS = ("name", "stem", "suffix", "parent", "parents", "parts")  # of a path
_NO_NAMES: Mapping[str, Value] = {}
MAX_FILE_STEPS = 100_000  # what the evaluation of one file may use
_IN_ANNOTATIONS = (
    ast.Attribute,
    ast.Subscript,
    ast.Constant,
    ast.BinOp,
    ast.BitOr,
    ast.Tuple,
    ast.List,
    ast.expr_context,
    ast.Index,
)
# What builtins has in every version of Python: classes of errors, and others.
_BUILT_IN = {name: getattr(builtins, name) for name in python_names("builtins", RELEASES[:1])}


class _ReturnFlow(EvaluationSignal):
    """A return statement, with its value."""

    def __init__(self, value: Value) -> None:
        super().__init__()
        self.value = value


class _RaiseFlow(EvaluationSignal):
    """A raise statement that may not run."""


# What a statement may leave that is not evaluated, so that what follows is not known.
_LEAVING = (ast.Return, ast.Global, ast.Nonlocal, ast.Yield, ast.YieldFrom, ast.Await)
_LEAVING_LOOPS = (ast.Break, ast.Continue)
_COPIED = 8  # names of a scope, which are looked at or copied for one part of the budget
_OF_BRANCHES = "which of these branches runs is not evaluated"


_ENVIRONMENTS = ("os.environ", "environ")
# By which packages, programs and files are found.
SEARCHED_VARIABLES = ("AMENT_PREFIX_PATH", "PATH", "PYTHONPATH", "LD_LIBRARY_PATH", "HOME")


class _ClassScope(Scope):
    """The names in the body of a class."""


def _stop_at(node: ast.FunctionDef) -> Iterator[Value]:
    """Raise Undetermined where the first item of a generator function is needed."""
    yield from ()
    raise Undetermined("a generator function is not evaluated", make_position(node), is_final=True)


def _catches(kind: ast.expr | None, raised: EvaluationFails, at: Position) -> bool:
    """Return whether `except KIND` catches an error. Raises Undetermined."""
    name = kind.id if isinstance(kind, ast.Name) else ""
    if not kind or name == "BaseException" or (raised.kind is None and name == "Exception"):
        return True
    caught = _BUILT_IN.get(name)
    if raised.kind is None or not isinstance(caught, type):
        message = "which error is raised in this try is not evaluated"
        raise Undetermined(message, at, is_final=True)
    return issubclass(raised.kind, caught)


def _full_name(node: ast.expr) -> str:
    """Return the name that an expression is: os.environ; empty for others."""
    match node:
        case ast.Name(id=name):
            return name
        case ast.Attribute(value=owner, attr=name):
            return f"{_full_name(owner)}.{name}"
    return ""


def _reads_environment(node: ast.AST) -> bool:
    nodes = [each for each in walk(node) if isinstance(each, ast.Name | ast.Attribute)]
    return any(_full_name(each) in _ENVIRONMENTS for each in nodes)


def _fits(subject: Value, pattern: ast.pattern) -> bool | None:
    """Return whether a pattern is certainly that of a value, or certainly not."""
    match pattern:
        case ast.MatchAs(pattern=None):
            return True
        case ast.MatchOr(patterns=patterns):
            fits = [_fits(subject, each) for each in patterns]
            return True in fits or (None if None in fits else False)
        case ast.MatchValue(value=ast.Constant(value=value)) if isinstance(subject, str | int):
            return bool(subject == value)
    return None


def _join_ends(ends: Sequence[dict[str, Value]], at: Position) -> dict[str, Value]:
    """Return the names after branches: each has the value of all, or is one of several."""
    joined = {}
    for name in dict.fromkeys(chain.from_iterable(ends)):
        values = [end[name] for end in ends if name in end]
        is_same = len(values) == len(ends) and all(
            value is values[0] or (isinstance(value, str) and value == values[0])
            for value in values
        )
        reason = f"which branch binds {name} {NOT_EVALUATED}"
        joined[name] = values[0] if is_same else one_of(values, reason, at)
    return joined


class Interpreter(Evaluation):
    """Adds the statements of a file to its expressions."""

    def __init__(
        self,
        functions: FunctionTable,
        names: Mapping[str, Value],
        *,
        stand_ins: Collection[str] = (),
        budget: Budget | None = None,
        exports: Mapping[str, Collection[str]] | None = None,
        local_modules: Collection[str] = (),
        goes_on: bool = False,
    ) -> None:
        """`functions` may be called, by full name.

        `names` are bound from the beginning, such as __file__.

        `stand_ins` are texts that stand for folders that are not known; `exports` has the names of
        modules, besides those of Python itself; `local_modules` are beside the file, and imported
        before any other. With `goes_on`, what follows a statement that is not evaluated is
        evaluated, with what that may change as open values.
        """
        super().__init__(functions, names, budget or Budget(MAX_FILE_STEPS))
        self.budget.stand_ins = stand_ins
        self.exports = exports or {}
        self.local_modules = local_modules
        self.goes_on = goes_on
        self.unread: list[Unknown] = []  # the statements that are not evaluated
        self.chosen = 0  # how many conditions are around the statement, which hold

    def run(self, code: Code) -> Scope:
        """Evaluate a whole file and return the scope of its names. It never raises."""
        self.releases = code.releases
        try:
            self._block(code.tree.body, self.module)
        except (EvaluationSignal, RecursionError) as error:
            self._stop(error)
        return self.module

    def call_from_outside(
        self,
        function: Function | Call,
        at: Position,
        args: Sequence[Value] | None = (),
        named: Mapping[str, Value] = _NO_NAMES,
    ) -> Value:
        """Return the value of a call of a function of the file, or of partial() of one.

        It never raises.

        With `args` None, the arguments are unknown, and no error or doubt in the call counts: it
        may never happen.
        """
        count = 1
        if isinstance(function, Function):
            given = function.parameters
            count = len(given.posonlyargs + given.args) - len(given.defaults)
        event = [Unknown("an event is known only at run time", at)] * count
        recorded = list(self.errors)
        doubt = self.doubt
        unread = list(self.unread)
        try:
            made = Call("", event if args is None else list(args), dict(named), at)
            return self.call_value(function, made)
        except (EvaluationSignal, RecursionError) as error:
            return self._stop(error, at)
        finally:
            if args is None:
                self.errors = recorded
                self.doubt = doubt
                self.unread = unread

    def _stop(
        self, error: EvaluationSignal | RecursionError, at: Position | None = None
    ) -> Unknown:
        if isinstance(error, RecursionError):
            error = Undetermined("the file is too deeply nested, which is not evaluated")
        return self.doubted(error.as_unknown(at or self.at))

    def _block(self, body: list[ast.stmt], scope: Scope) -> None:
        for node in body:
            self.budget.charge(1)
            self.at = make_position(node)
            kind = self._STATEMENTS.get(type(node), Interpreter._unsupported)
            try:
                kind(self, node, scope)
            except EvaluationFails as error:  # of the statement itself, such as an assignment
                at = error.at or make_position(node)
                self.error(str(error), at, error.kind, argument=error.argument, lacks=error.lacks)
            except Undetermined as error:
                what = "" if error.is_final else f"this statement {NOT_EVALUATED}: "
                unknown = Unknown(f"{what}{error}", error.at or make_position(node))
                self._skip(node, unknown, scope)

    def _unsupported(self, node: ast.stmt, _: Scope) -> None:
        reason = f"a statement of the kind {type(node).__name__} {NOT_EVALUATED}"
        raise Undetermined(reason, is_final=True)

    def _skip(self, node: ast.stmt, unknown: Unknown, scope: Scope) -> None:
        """Go on after a statement that is not evaluated: what it may change is open then.

        Raises Undetermined where it may change more, or where what follows may not run.
        """
        parts = own_nodes(node) if not isinstance(node, ast.FunctionDef | ast.ClassDef) else [node]
        is_loop = isinstance(node, ast.For | ast.While)
        leaving = _LEAVING if is_loop else (_LEAVING + _LEAVING_LOOPS)
        names = names_bound(parts)
        if not self.goes_on or "*" in names or any(isinstance(part, leaving) for part in parts):
            raise Undetermined(unknown.reason, unknown.at, is_final=True)
        for name in sorted({part.id for part in parts if isinstance(part, ast.Name)} - names):
            self._make_reached_open(name, scope, unknown)
        self.unread.append(self.doubted(unknown))
        scope.names.update(dict.fromkeys(names, unknown))

    def _make_reached_open(self, name: str, scope: Scope, unknown: Unknown) -> None:
        """Keep that a name's value may have changed, and of a function what its scope has."""
        with suppress(KeyError, EvaluationFails):
            value = scope.find(name)
            self.make_open(value, unknown)
            if isinstance(value, Function):
                self.budget.charge(len(value.scope.names) // _COPIED)
                for shared in list(value.scope.names.values()):
                    if isinstance(shared, list):
                        self.make_open(shared, unknown)

    def _perhaps(
        self, branches: Sequence[Callable[[], None]], reason: Undetermined, scope: Scope
    ) -> None:
        """Run branches of which one runs, and keep as open what they do not agree on.

        Raises _ReturnFlow where all return, and Undetermined where branches are not evaluated.
        """
        at = reason.at or self.at
        if not self.goes_on or reason.is_final:
            raise Undetermined(str(reason), at, is_final=True)
        self.budget.charge(len(branches) * len(scope.names) // _COPIED)
        before = dict(scope.names)
        ends = []
        returned = []
        self.possible += 1
        try:
            for branch in branches:
                scope.names.clear()
                scope.names.update(before)
                try:
                    branch()
                    ends.append(dict(scope.names))
                except _ReturnFlow as flow:
                    returned.append(flow.value)
                except _RaiseFlow:
                    continue
        finally:
            self.possible -= 1
        if not ends:
            if not returned:
                raise _RaiseFlow
            raise _ReturnFlow(one_of(returned, _OF_BRANCHES, at))
        scope.names.clear()
        scope.names.update(_join_ends(ends, at))
        if returned:
            scope.returned += returned
            self.possible += 1  # until the function ends

    def _functiondef(self, node: ast.FunctionDef, scope: Scope) -> None:
        at = make_position(node)
        if getattr(node, "type_params", []):
            raise Undetermined(
                "a function with type parameters is not evaluated", at, is_final=True
            )
        decorators = [self.evaluate(decorator, scope) for decorator in node.decorator_list]
        parameters = node.args
        every = (
            *parameters.posonlyargs,
            *parameters.args,
            *parameters.kwonlyargs,
            parameters.vararg,
            parameters.kwarg,
        )
        function = self.function(
            parameters, scope, at, partial(self._function_body, node), bound_in(node)
        )
        for annotation in (
            *(parameter.annotation for parameter in every if parameter),
            node.returns,
        ):
            self._annotation(annotation, scope)
        for decorator in reversed(decorators):
            function = self.call_value(decorator, Call("", [function], {}, at))
        scope.names[node.name] = function

    def _classdef(self, node: ast.ClassDef, scope: Scope) -> None:
        """Evaluate the body of a class, which is not evaluated itself."""
        bases = [self.evaluate(base, scope) for base in node.bases]
        is_plain = not node.keywords and not node.decorator_list
        if not is_plain or not all(isinstance(base, QualifiedName) for base in bases):
            raise Undetermined("a class of this kind is not evaluated", is_final=True)
        at = self.at
        inside = _ClassScope({}, scope)
        self._block(node.body, inside)
        scope.names[node.name] = ClassBody(inside.names, at)

    def _delete(self, node: ast.Delete, scope: Scope) -> None:
        for target in node.targets:
            match target:
                case ast.Name(id=name) if name in scope.names:
                    del scope.names[name]
                case ast.Subscript(value=owner, slice=key):
                    changed = self.evaluate(owner, scope)
                    if not isinstance(changed, list | dict):
                        refuse(changed, "this use of del is not supported")
                    call_plain(delitem, changed, known(self.key(key, scope)))
                case _:
                    raise Undetermined("this use of del is not supported")

    def _function_body(self, node: ast.FunctionDef, scope: Scope) -> Value:
        if any(isinstance(inner, ast.Yield | ast.YieldFrom) for inner in own_nodes(node)):
            return Items(_stop_at(node))
        possible = self.possible
        value = None
        try:
            self._block(node.body, scope)
        except _ReturnFlow as flow:
            value = flow.value
        except _RaiseFlow:
            if not scope.returned:
                raise
            return one_of(scope.returned, _OF_BRANCHES, self.at)
        finally:
            self.possible = possible
        if scope.returned:
            return one_of([*scope.returned, value], _OF_BRANCHES, self.at)
        return value

    def _return(self, node: ast.Return, scope: Scope) -> None:
        raise _ReturnFlow(self.evaluate(node.value, scope) if node.value else None)

    def _annotation(self, node: ast.expr | None, scope: Scope) -> None:
        """Find the names of an annotation, and stop where it calls something."""
        if not node:
            return
        for part in walk(node):
            if isinstance(part, ast.Name):
                self._name(part, scope)
            elif not isinstance(part, _IN_ANNOTATIONS):
                raise Undetermined("this annotation is not evaluated", is_final=True)

    def _if(self, node: ast.If, scope: Scope) -> None:
        doubt = self.doubt
        is_guard = _reads_environment(node.test)
        value = self.evaluate(node.test, scope)
        if is_guard:
            self.doubt = doubt  # whether a variable is set raises nothing
        try:
            holds = truth(value)
        except Undetermined as error:
            if error.follows_error:
                raise
            bodies = (node.body, node.orelse)
            self.guarded += is_guard
            try:
                self._perhaps([partial(self._block, body, scope) for body in bodies], error, scope)
            finally:
                self.guarded -= is_guard
        else:
            self.chosen += 1
            try:
                self._block(node.body if holds else node.orelse, scope)
            finally:
                self.chosen -= 1

    def _for(self, node: ast.For, scope: Scope) -> None:
        items = self.evaluate(node.iter, scope)
        # How often it runs once the error is fixed is not known.
        if isinstance(items, Unknown) and items.follows_error:
            self.doubted(items)
            items = []
        for item in self.budget.items(items):
            if not (isinstance(item, Unknown) and item.candidates):
                self._round(node, item, scope)
                continue
            rounds = [partial(self._round, node, each, scope) for each in item.candidates]
            self._perhaps([*rounds, lambda: None], item.as_signal(item.at), scope)
        self._block(node.orelse, scope)

    def _round(self, node: ast.For, item: Value, scope: Scope) -> None:
        self.bind(node.target, item, scope)
        self._block(node.body, scope)

    def _while(self, node: ast.While, scope: Scope) -> None:
        """Run the body once, as what may run or not, with what it binds as open values."""
        reason = Undetermined(f"how often this loop runs {NOT_EVALUATED}", self.at)
        unknown = self.doubted(reason.as_unknown(self.at))
        self.unread.append(unknown)
        scope.names.update(dict.fromkeys(names_bound(own_nodes(node)), unknown))
        self._perhaps([partial(self._block, node.body, scope), lambda: None], reason, scope)
        self._block(node.orelse, scope)

    def _match(self, node: ast.Match, scope: Scope) -> None:
        """Run the case of a known value, or each of those that may be meant."""
        subject = self.evaluate(node.subject, scope)
        cases = []
        for case in node.cases:
            scope.names.update(
                dict.fromkeys(names_bound(walk(case.pattern)), Unknown(_OF_BRANCHES, self.at))
            )
            fits = None if case.guard else _fits(subject, case.pattern)
            if fits is not False:
                cases.append(case)
            if fits:
                break
        if len(cases) == 1 and fits:
            self._block(cases[0].body, scope)
        elif cases:
            bodies = [partial(self._block, case.body, scope) for case in cases]
            reason = Undetermined(_OF_BRANCHES, self.at)
            self._perhaps(bodies if fits else [*bodies, lambda: None], reason, scope)

    def _with(self, node: ast.With, scope: Scope) -> None:
        first, *others = node.items
        body = node.body
        if others:  # are as a statement in the statement
            body = [ast.copy_location(ast.With(items=others, body=node.body), node)]
        value = self.evaluate(first.context_expr, scope)
        target = first.optional_vars
        if isinstance(value, Call):
            self.call_value(BoundMethod(value, "__enter__"), Call("", [], {}, self.at))
        # open() of a file that does not exist has failed.
        is_open = isinstance(value, Unknown) and (value.follows_error or self.goes_on)
        if not (isinstance(value, Call | StringIO) or is_open):
            raise Undetermined("this use of with is not evaluated", is_final=True)
        if target:
            self.bind(target, value, scope)
        try:
            self._block(body, scope)
        finally:
            if isinstance(value, StringIO):
                value.close()
            elif isinstance(value, Call):
                value.method_calls.append(Call(f"{value.name}.__exit__", [], {}, self.at, value))

    def _annassign(self, node: ast.AnnAssign, scope: Scope) -> None:
        if node.value:
            self.bind(node.target, self.evaluate(node.value, scope), scope)
        if scope is self.module or isinstance(scope, _ClassScope):
            self._annotation(node.annotation, scope)

    def _expr(self, node: ast.Expr, scope: Scope) -> None:
        self.evaluate(node.value, scope)

    def _pass(self, node: ast.Pass, scope: Scope) -> None:
        pass

    def _import(self, node: ast.Import | ast.ImportFrom, scope: Scope) -> None:
        module = ""
        if isinstance(node, ast.ImportFrom):
            module = "." * node.level + (node.module or "")
        for alias in node.names:
            if (module or alias.name).split(".")[0] in self.local_modules:
                raise Undetermined(
                    f"the file's own module {module or alias.name} is not evaluated",
                    is_final=True,
                )
            error = import_error(module, alias.name, self.exports, self.releases)
            bound = imported_names(module, alias, self.exports)
            if isinstance(error, Uncertain):
                reason = (
                    f"whether {module or alias.name} is installed is not known; it is not evaluated"
                )
                self.doubted(Unknown(reason, self.at))
            elif error is not None:
                self.error(error, self.at, ModuleNotFoundError)
                bound = dict.fromkeys(bound, usual_meaning(alias.name))
            if bound.pop("*", None) is not None:
                raise Undetermined(f"the names of {module} are not evaluated", is_final=True)
            scope.names.update(bound)

    def _try(self, node: ast.Try, scope: Scope) -> None:
        """Run a body, and the handler of what it certainly raises; stop where it may raise more."""
        if node.finalbody:
            rest = copy(node)
            rest.finalbody = []
            try:
                self._try(rest, scope)
            finally:
                self._block(node.finalbody, scope)
            return
        doubt = self.doubt
        self.doubt = None
        raised = None
        self.attempts += 1
        try:
            self._block(node.body, scope)
        except EvaluationFails as error:
            raised = error
        finally:
            self.attempts -= 1
        reason = self.doubt
        self.doubt = doubt
        if reason is not None:
            bodies = [node.orelse, *(handler.body for handler in node.handlers)]
            for handler in node.handlers:
                self._bind_error(handler, scope)
            self._perhaps(
                [partial(self._block, body, scope) for body in bodies],
                reason.as_signal(reason.at),
                scope,
            )
        elif not raised:
            self._block(node.orelse, scope)
        else:
            self._handle(raised, node.handlers, scope)

    def _handle(
        self, raised: EvaluationFails, handlers: Sequence[ast.ExceptHandler], scope: Scope
    ) -> None:
        """Run the handler of an error; raise it again where none catches it."""
        for handler in handlers:
            if any(_catches(kind, raised, self.at) for kind in caught_by(handler)):
                self._bind_error(handler, scope)
                self._block(handler.body, scope)
                return
        raise raised

    def _bind_error(self, handler: ast.ExceptHandler, scope: Scope) -> None:
        if handler.name:
            at = make_position(handler)
            scope.names[handler.name] = Unknown("an error is not evaluated", at)

    def _assert(self, node: ast.Assert, scope: Scope) -> None:
        if not truth(self.evaluate(node.test, scope)):
            self.error("this assertion fails", self.at, AssertionError)

    def _raise(self, node: ast.Raise, _: Scope) -> None:
        raised = node.exc.func if isinstance(node.exc, ast.Call) else node.exc
        kind = _BUILT_IN.get(raised.id) if isinstance(raised, ast.Name) else None
        is_ended = self.goes_on and not self.attempts
        if is_ended and (self.possible or self.chosen):
            # What a launch file refuses on purpose is no mistake in it.
            reason = f"whether the file raises an error here {NOT_EVALUATED}"
            self.doubted(Unknown(reason, self.at))
            raise _RaiseFlow(reason, self.at)
        if isinstance(kind, type) and issubclass(kind, Exception):
            self.error(f"the file raises {kind.__name__} here", self.at, kind)
        reason = f"which error is raised here {NOT_EVALUATED}"
        if is_ended:
            raise _RaiseFlow(reason, self.at)
        raise Undetermined(reason, is_final=True)

    def _attribute(self, node: ast.Attribute, scope: Scope) -> Value:
        owner = self.evaluate(node.value, scope)
        name = node.attr
        if isinstance(owner, QualifiedName):
            return self._attribute_of_module(owner, node)
        match owner:
            case PurePosixPath() if name in _PARTS:
                return self._part_of_path(owner, name)
            case Namespace():
                return owner.find(name)
            case Unknown(is_text=False):
                return owner.attribute(name, make_position(node))
        if isinstance(owner, PLAIN) and not has_attribute(owner, name, self.releases):
            raise EvaluationFails(f"{type(owner).__name__!r} has no attribute {name!r}")
        return BoundMethod(owner, name, node)

    def _part_of_path(self, path: PurePosixPath, name: str) -> Value:
        """Return an attribute of a path; those above a folder that is not known are not known."""
        value = self.budget.checked(getattr(path, name) if name != "parents" else None, "path")
        above = list(path.parents) if name == "parents" else [value]
        is_folder = name in ("parent", "parents")
        unknown = Unknown("the folder that a build installs to is not known", self.at)
        known = [
            part if not is_folder or self.budget.is_below(path, part) else unknown for part in above
        ]
        return known if name == "parents" else known[0]

    def _attribute_of_module(self, owner: QualifiedName, node: ast.Attribute) -> Value:
        """Return what a name in a module stands for; a misspelt one is an error."""
        if (
            owner.name == "?glob"
        ):  # used without an import: the attribute shows that it is the module
            return QualifiedName(f"glob.{node.attr}")
        if owner.name == "glob.glob" and node.attr in ("glob", "iglob"):
            message = (
                f"glob is a function here, so glob.{node.attr} is not defined: write glob(...)"
            )
            self.error(message, make_position(node))
            return owner
        module = owner.name
        full = f"{owner.name}.{node.attr}"
        is_evaluated = full in self.functions
        error = None if is_evaluated else attribute_error(module, node.attr, self.releases)
        if error is not None:
            known = [
                function for function in self.functions if function.rpartition(".")[0] == module
            ]
            meant = closest(full, known)
            if meant is None:
                raise EvaluationFails(error)
            self.error(error, make_position(node))
            full = meant
        return CONSTANTS.get(full, QualifiedName(full, is_defined=owner.is_defined))

    def item(self, owner: Value, key: Value, node: ast.expr) -> Value:
        """Return the value of owner[key]; of something outside of the file, by the table."""
        if not isinstance(owner, QualifiedName | Call):
            return super().item(owner, key, node)
        made = Call(f"{owner.name}.__getitem__", [key], {}, make_position(node))
        function = self.functions.get(made.name)
        if function is None and isinstance(owner, QualifiedName) and owner.name in self.functions:
            self.error(
                f"{owner.name} is a function: write ( ) around its arguments, not [ ]",
                make_position(node),
            )
            return self.call_value(owner, Call("", [key], {}, make_position(node)))
        if function is None or isinstance(function, PlainFunction):
            raise Undetermined(f"{owner.name}[...] {NOT_EVALUATED}")
        return function(self, made)

    def elements(
        self, nodes: Sequence[ast.expr], scope: Scope, *, is_call: bool = False
    ) -> list[Value]:
        """Return the values of the elements of a list, or of the arguments of a call."""
        values = []
        for node in chain.from_iterable(map(self._separated, nodes)):
            if not isinstance(node, ast.Starred):
                values.append(self.evaluate(node, scope))
                continue
            value = self.evaluate(node.value, scope)
            try:
                values += self.budget.items(value) if is_call else self._list_items(value)
            except Undetermined as error:
                raise Undetermined(
                    str(error), error.at or make_position(node), is_final=True
                ) from None
        return values

    def _list_items(self, value: Value) -> list[Value]:
        """Return the items of a value; of one that is not known, those that may be there."""
        if self.goes_on and isinstance(value, Unknown):
            return spread(value)
        return list(self.budget.items(value))

    def _separated(self, node: ast.expr) -> list[ast.expr]:
        """Return an element, or the two elements that are meant where a comma is missing.

        They are written as a call of a tuple or list.
        """
        match node:
            case ast.Call(
                func=ast.Tuple() | ast.List() | ast.Call() as first,
                args=[start, *_] as args,
                keywords=[],
            ):
                before = self._separated(first)
                if isinstance(before[-1], ast.Tuple | ast.List):
                    kind = type(before[-1]).__name__.lower()
                    self.error(MISSING_COMMA.format(kind), make_position(node))
                    return [*before, ast.copy_location(ast.Tuple(elts=args, ctx=ast.Load()), start)]
        return [node]

    def _set(self, node: ast.Set, scope: Scope) -> Value:
        return call_plain(set, self.elements(node.elts, scope))

    def _dict(self, node: ast.Dict, scope: Scope) -> Value:
        table: dict[Any, Value] = {}
        for key, value in zip(node.keys, node.values, strict=True):
            evaluated = self.evaluate(value, scope)
            if key:
                call_plain(table.__setitem__, known(self.evaluate(key, scope)), evaluated)
            elif isinstance(evaluated, dict):
                table |= evaluated
            else:
                refuse(evaluated, "this dict is not supported")
        return table

    def _joinedstr(self, node: ast.JoinedStr, scope: Scope) -> Value:
        pieces = [self.evaluate(piece, scope) for piece in node.values]
        if len(pieces) == 1 and isinstance(pieces[0], Unknown):
            return pieces[0]
        self.budget.measure(pieces, "text")
        return self.budget.checked("".join(pieces), "text")

    def _formattedvalue(self, node: ast.FormattedValue, scope: Scope) -> Value:
        value = self.evaluate(node.value, scope)
        is_text = isinstance(value, Unknown) and value.is_text
        if not is_text:
            self.budget.measure(value, "text")
        if node.format_spec or node.conversion not in (-1, ord("s")):
            raise Undetermined("a format of this kind is not supported")
        return value if is_text else charge_str(value)

    def _dictcomp(self, node: ast.DictComp, scope: Scope) -> Value:
        return {
            known(self.evaluate(node.key, inner)): self.evaluate(node.value, inner)
            for inner in self.rounds(node.generators, InnerScope({}, scope))
        }

    def _namedexpr(self, node: ast.NamedExpr, scope: Scope) -> Value:
        value = self.evaluate(node.value, scope)
        while isinstance(scope, InnerScope) and scope.outer:
            scope = scope.outer
        self.bind(node.target, value, scope)
        return value

    def _lambda(self, node: ast.Lambda, scope: Scope) -> Value:
        return self.function(
            node.args, scope, make_position(node), lambda inner: self.evaluate(node.body, inner)
        )

    def bind(self, target: ast.expr, value: Value, scope: Scope) -> None:
        """Bind the names of a target to a value, or change an item."""
        match target:
            case ast.Subscript(value=owner, slice=key):
                self._store(
                    self.evaluate(owner, scope),
                    known(self.key(key, scope)),
                    value,
                    make_position(target),
                )
            case ast.Attribute(value=owner, attr=name):
                changed = self.evaluate(owner, scope)
                if isinstance(changed, PLAIN):
                    raise EvaluationFails(f"{type(changed).__name__!r} has no attribute {name!r}")
                reason = f"a change of the attribute {name} is not evaluated"
                raise Undetermined(reason, make_position(target), is_final=True)
            case _:
                super().bind(target, value, scope)

    def _store(self, owner: Value, key: Value, value: Value, at: Position) -> None:
        """Set an item of a list or dict."""
        if isinstance(owner, QualifiedName | Call):
            made = Call(f"{owner.name}.__setitem__", [key, value], {}, at)
            is_defined = isinstance(owner, Call) or owner.is_defined
            self.call_value(QualifiedName(made.name, is_defined=is_defined), made)
            return
        if not isinstance(owner, PLAIN) or isinstance(key, slice):
            refuse(owner, "this assignment to an item is not supported")
        call_plain(setitem, owner, key, self.perhaps(value))
        self.budget.charge(len(owner))

    def _assign(self, node: ast.Assign, scope: Scope) -> None:
        value = self.evaluate(node.value, scope)
        for target in node.targets:
            self.bind(target, value, scope)

    def _augassign(self, node: ast.AugAssign, scope: Scope) -> None:
        target = node.target
        if any(isinstance(part, ast.Call | ast.NamedExpr) for part in walk(target)):
            raise Undetermined("this target is not supported")
        load = copy(target)
        load.ctx = ast.Load()
        before = self.evaluate(load, scope)
        value = self.evaluate(node.value, scope)
        if isinstance(before, Unknown) and before.is_text:
            self.bind(target, before, scope)  # still a text that is not known
            return
        if not isinstance(before, PLAIN):
            refuse(before, "this value is not supported")
        if isinstance(before, list) and isinstance(node.op, ast.Add):
            before.extend(map(self.perhaps, self._list_items(value)))
            self.budget.measure(before, "holds")
        elif isinstance(before, list | dict):
            raise Undetermined("this operator is not supported")
        else:
            self.bind(target, operate(node.op, before, value, self.budget), scope)

    KINDS: ClassVar = {
        **Evaluation.KINDS,
        ast.Attribute: _attribute,
        ast.Dict: _dict,
        ast.Set: _set,
        ast.JoinedStr: _joinedstr,
        ast.FormattedValue: _formattedvalue,
        ast.DictComp: _dictcomp,
        ast.Lambda: _lambda,
        ast.NamedExpr: _namedexpr,
    }

    # The statements that are evaluated.
    _STATEMENTS: ClassVar[Mapping[type[ast.stmt], Callable[[Any, Any, Scope], None]]] = {
        ast.FunctionDef: _functiondef,
        ast.ClassDef: _classdef,
        ast.Delete: _delete,
        ast.Return: _return,
        ast.If: _if,
        ast.For: _for,
        ast.While: _while,
        ast.Match: _match,
        ast.With: _with,
        ast.Assign: _assign,
        ast.AugAssign: _augassign,
        ast.AnnAssign: _annassign,
        ast.Expr: _expr,
        ast.Pass: _pass,
        ast.Import: _import,
        ast.ImportFrom: _import,
        ast.Try: _try,
        ast.Assert: _assert,
        ast.Raise: _raise,
    }
