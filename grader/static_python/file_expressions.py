"""Expressions in a file: its names, functions and imports; and the state of the evaluation of a file.

A part of an expression that is not known is Unknown: names, lists and arguments keep it, an operation with it is unknown
as well. Only what the table of functions lists is called. Whatever else a file calls may do anything, so the
evaluation stops there.
"""

import ast
import builtins
from collections.abc import Callable, Collection, Mapping
from functools import partial
from pathlib import PurePosixPath
from typing import Any, NamedTuple

from grader.static_python.budget import Budget
from grader.static_python.builtins import BUILTINS, call, truth
from grader.static_python.expressions import Expressions, kinds_of
from grader.static_python.imports import CONSTANTS, PYTHON_3_12, USUAL_NAMES, attribute_error
from grader.static_python.operators import has_attribute, method
from grader.static_python.parse import Position, position_of
from grader.static_python.values import (
    PLAIN,
    UNKNOWN_KEYS,
    BoundMethod,
    Call,
    EvaluationSignal,
    ExpressionFails,
    Function,
    Items,
    PlainFunction,
    QualifiedName,
    Scope,
    Undetermined,
    Unknown,
    Value,
    call_plain,
    iterate,
    known,
    reason_of,
    str_of,
)


class PythonError(NamedTuple):
    """An error that certainly stops Python at this position: an undefined name, an import that fails."""

    message: str
    at: Position


class RaisedFlow(EvaluationSignal):
    """An error for which a handler is searched; `kind` decides which handler catches it."""

    def __init__(self, error: PythonError, kind: type[BaseException]) -> None:
        super().__init__(error.message)
        self.error, self.kind = error, kind


class ExitFlow(EvaluationSignal):
    """The end of the program, by sys.exit or by an error that nothing catches."""


class EvaluationStopped(EvaluationSignal):
    """The evaluation ends here: nothing that follows can be determined."""

    def __init__(self, reason: str, at: Position) -> None:
        super().__init__(reason)
        self.at = at


# The functions that are evaluated, by their full names; each of the second kind takes its call.
FunctionTable = Mapping[str, "PlainFunction | Callable[[FileExpressions, Call], Value]"]

_MAX_DEPTH = 30
_MAX_ERRORS = 200
_MAX_CALLS = 20_000
_NOT_EVALUATED = "is not evaluated"
FAILED = "Python raises an error before"  # the reason of a value that would follow
# What is unknown without an error where its operands are unknown.
_SAFE = (ast.BoolOp, ast.JoinedStr, ast.FormattedValue, ast.IfExp)
_CHANGING: Mapping[type, tuple[str, ...]] = {
    list: ("append", "extend", "insert", "sort", "reverse", "clear", "remove", "pop", "index", "count"),
    dict: ("update", "setdefault", "pop", "clear"),
    set: ("add", "discard"),
}
_PARTS = ("name", "stem", "suffix", "parent", "parents", "parts")  # of a path
_TEXT_METHODS = frozenset(name for name in dir(str) if not name.startswith("_"))


def record(evaluation: "FileExpressions", made: Call) -> Call:
    """Record a call that is not evaluated further, and return it as its result."""
    if len(evaluation.calls) < _MAX_CALLS:
        evaluation.calls.append(made)
        if made.owner is not None:
            made.owner.method_calls.append(made)
    return made


class FileExpressions(Expressions):
    """The state of the evaluation of a file, and its expressions."""

    def __init__(self, functions: FunctionTable, names: Mapping[str, Value], budget: Budget) -> None:
        """`functions` has every function that is evaluated; `names` are bound from the beginning, such as __file__."""
        super().__init__(self._undefined, budget)
        self.functions = functions
        self.module = Scope({"__name__": "__main__", **names})
        self.errors: list[PythonError] = []
        self.calls: list[Call] = []  # what is recorded, in order
        self.doubt: Unknown | None = None  # the first that may have failed, or stopped the evaluation
        self.handlers = 0  # how many blocks around this place catch errors
        self.has_lazy_annotations = False  # whether annotations are not evaluated
        self.has_star = False  # whether names are bound that are not known
        self.exports: Mapping[str, Collection[str]] = {}
        self.local_modules: Collection[str] = ()
        self._depth = 0

    def doubted(self, unknown: Unknown) -> Unknown:
        """Keep that an error may have been raised here, and return the unknown value."""
        if self.handlers:
            raise EvaluationStopped(f"an error may be caught: {unknown.reason}", unknown.at)
        self.doubt = self.doubt or unknown
        return unknown

    def error(self, message: str, at: Position, kind: type[BaseException] = TypeError) -> None:
        """Record once an error that certainly stops Python; `kind` decides what catches it."""
        if self.handlers:
            raise RaisedFlow(PythonError(message, at), kind)
        if len(self.errors) < _MAX_ERRORS and all(message != error.message for error in self.errors):
            self.errors.append(PythonError(message, at))

    def evaluate(self, node: ast.expr, scope: Scope) -> Value:
        """Return the value of an expression; Unknown, with the reason, where it cannot be determined."""
        try:
            return self.value(node, scope)
        except Undetermined as error:
            unknown = Unknown(str(error), error.at or position_of(node))
            is_safe = isinstance(node, _SAFE) or (isinstance(node, ast.Compare) and _is_equality(node))
            return unknown if is_safe and error.at else self.doubted(unknown)
        except ExpressionFails as error:
            self.error(str(error), position_of(node), error.kind)
            return Unknown(FAILED, position_of(node))

    def of_name(self, node: ast.Name, scope: Scope) -> Value:
        """Return the value of a name. An undefined name is an error; its value is the most likely intended one."""
        try:
            return scope.find(node.id)
        except KeyError:
            pass
        if node.id in BUILTINS and f"builtins.{node.id}" not in self.functions:
            return BUILTINS[node.id]
        if hasattr(builtins, node.id) and node.id not in PYTHON_3_12:
            return QualifiedName(f"builtins.{node.id}")
        if self.has_star or node.id.startswith("__"):
            raise Undetermined(f"the name {node.id!r} {_NOT_EVALUATED}")
        self.error(f"the name {node.id!r} is not defined or imported", position_of(node), NameError)
        return QualifiedName(USUAL_NAMES.get(node.id, f"?.{node.id}"))

    def _undefined(self, name: str) -> Value:
        raise Undetermined(f"the name {name!r} {_NOT_EVALUATED}")

    def of_attribute(self, node: ast.Attribute, scope: Scope) -> Value:
        """Return the value of an attribute; a method is returned as it is bound."""
        owner, name, at = self.evaluate(node.value, scope), node.attr, position_of(node)
        match owner:
            case QualifiedName(name="?glob"):  # used without an import: an attribute shows that the module is meant
                return QualifiedName(f"glob.{name}")
            case QualifiedName(name="glob.glob") if name in ("glob", "iglob"):
                message = f"glob is a function here, so glob.{name} is not defined: write glob(...)"
                self.error(message, at, AttributeError)
                return owner
            case QualifiedName(name=module):
                full = f"{module}.{name}"
                error = attribute_error(module, name) if full not in self.functions else None
                if error is not None:
                    raise ExpressionFails(error, AttributeError)
                return CONSTANTS.get(full, QualifiedName(full))
        if isinstance(owner, PurePosixPath) and name in _PARTS:
            value = getattr(owner, name)
            return self.budget.checked(list(value) if name == "parents" else value, "path")
        if isinstance(owner, PLAIN) and not has_attribute(owner, name):
            raise ExpressionFails(f"{type(owner).__name__!r} has no attribute {name!r}", AttributeError)
        return BoundMethod(owner, name)

    def of_subscript(self, node: ast.Subscript, scope: Scope) -> Value:
        """Return the value of an item; of something outside of the file, by the table."""
        if not isinstance(node.value, ast.Name | ast.Attribute | ast.Call):
            return super().of_subscript(node, scope)
        owner = self.evaluate(node.value, scope)
        if isinstance(owner, QualifiedName | Call):
            made = Call(f"{owner.name}.__getitem__", [self.key(node.slice, scope)], {}, position_of(node))
            function = self.functions.get(made.name)
            if function is None or isinstance(function, PlainFunction):
                raise Undetermined(f"{owner.name}[...] {_NOT_EVALUATED}")
            return function(self, made)
        return super().of_subscript(ast.copy_location(ast.Subscript(_Held(owner), node.slice, node.ctx), node), scope)

    def of__held(self, node: "_Held", scope: Scope) -> Value:
        """Return a value that is evaluated already."""
        del scope
        return node.held

    def of_ifexp(self, node: ast.IfExp, scope: Scope) -> Value:
        """Return the value of a conditional expression."""
        test = self.evaluate(node.test, scope)
        self._condition(test, [node.body, node.orelse])
        return self.evaluate(node.body if truth(test) else node.orelse, scope)

    def of_boolop(self, node: ast.BoolOp, scope: Scope) -> Value:
        """Return the value of `and` and `or`."""
        value: Value = None
        for index, operand in enumerate(node.values):
            value = self.evaluate(operand, scope)
            if operand is not node.values[-1]:
                self._condition(value, node.values[index + 1 :])
                if truth(value) != isinstance(node.op, ast.And):
                    break
        return value

    def _condition(self, test: Value, branches: list[ast.expr]) -> None:
        """Stop where it is not known whether an expression is evaluated that may change something."""
        if not isinstance(test, Unknown | Call | QualifiedName | BoundMethod):
            return
        nodes = (node for branch in branches for node in ast.walk(branch))
        if any(isinstance(node, ast.Call | ast.NamedExpr | ast.Await) for node in nodes):
            raise EvaluationStopped(reason_of(test), getattr(test, "at", position_of(branches[0])))

    def elements(self, nodes: list[ast.expr], scope: Scope) -> list[Value]:
        """Return the values of the elements of a list, or of the arguments of a call."""
        values: list[Value] = []
        for node in nodes:
            if isinstance(node, ast.Starred):
                values += iterate(self.evaluate(node.value, scope))
            else:
                values.append(self.evaluate(node, scope))
        return values

    def of_set(self, node: ast.Set, scope: Scope) -> Value:
        """Return a set."""
        return self._by_name(Call("builtins.set", [self.elements(node.elts, scope)], {}, position_of(node)))

    def of_dict(self, node: ast.Dict, scope: Scope) -> Value:
        """Return a dict."""
        table: dict[Any, Value] = {}
        for key, value in zip(node.keys, node.values, strict=True):
            found = self.evaluate(value, scope)
            if key is not None:
                call_plain(table.__setitem__, known(self.evaluate(key, scope)), found)
            elif isinstance(found, dict):
                table |= found
            else:
                raise Undetermined(reason_of(found) or "this dict is not supported", getattr(found, "at", None))
        return table

    def of_joinedstr(self, node: ast.JoinedStr, scope: Scope) -> Value:
        """Return the text of an f-string."""
        pieces = [self.evaluate(piece, scope) for piece in node.values]
        self.budget.measure(pieces, "path")
        return self.budget.checked("".join(pieces), "path")

    def of_formattedvalue(self, node: ast.FormattedValue, scope: Scope) -> Value:
        """Return the text of a replacement field."""
        value = self.evaluate(node.value, scope)
        self.budget.measure(value, "path")
        if node.format_spec is not None or node.conversion not in (-1, ord("s")):
            raise Undetermined("a format of this kind is not supported")
        return str_of(value)

    def inner(self, scope: Scope) -> Scope:
        """Return the scope of a comprehension."""
        inner = Scope({}, scope)
        inner.is_loop = True
        return inner

    def of_generatorexp(self, node: ast.GeneratorExp, scope: Scope) -> Value:
        """Return a generator; its first loop's items are evaluated now, the rest when it is iterated."""
        first, *others = node.generators
        items = iterate(self.evaluate(first.iter, scope))
        held = ast.comprehension(first.target, _Held(Items(items)), first.ifs, first.is_async)
        inner = self.inner(scope)
        return Items(self.evaluate(node.elt, round_) for round_ in self.rounds([held, *others], inner))

    def of_setcomp(self, node: ast.SetComp, scope: Scope) -> Value:
        """Return the set of a comprehension."""
        values = [self.evaluate(node.elt, inner) for inner in self.rounds(node.generators, self.inner(scope))]
        return self._by_name(Call("builtins.set", [values], {}, position_of(node)))

    def of_dictcomp(self, node: ast.DictComp, scope: Scope) -> Value:
        """Return the dict of a comprehension."""
        return {
            known(self.evaluate(node.key, inner)): self.evaluate(node.value, inner)
            for inner in self.rounds(node.generators, self.inner(scope))
        }

    def of_namedexpr(self, node: ast.NamedExpr, scope: Scope) -> Value:
        """Bind a name in the function or module around, and return its value."""
        found = self.evaluate(node.value, scope)
        while scope.is_loop and scope.outer is not None:
            scope = scope.outer
        self.bind(node.target, found, scope)
        return found

    def of_lambda(self, node: ast.Lambda, scope: Scope) -> Value:
        """Return a lambda."""
        return self.function(node.args, scope, position_of(node), lambda inner: self.evaluate(node.body, inner))

    def function(
        self,
        parameters: ast.arguments,
        scope: Scope,
        at: Position,
        body: Callable[[Scope], Value],
        local: frozenset[str] = frozenset(),
    ) -> Function:
        """Return a function as it is defined: its defaults are evaluated now."""
        positional = reversed([*parameters.posonlyargs, *parameters.args])
        pairs = list(zip(positional, reversed(parameters.defaults), strict=False))[::-1]
        named = zip(parameters.kwonlyargs, parameters.kw_defaults, strict=True)
        pairs += [(parameter, default) for parameter, default in named if default is not None]
        defaults = {parameter.arg: self.evaluate(default, scope) for parameter, default in pairs}
        return Function(parameters, scope, defaults, body, at, local)

    def unpack(self, kwargs: dict[str, Value], value: Value, node: ast.expr) -> None:
        """Add the arguments that ** unpacks; of an unknown dict, that any argument may be given."""
        if not isinstance(value, dict):
            kwargs[UNKNOWN_KEYS] = Unknown(reason_of(value) or f"this use of ** {_NOT_EVALUATED}", position_of(node))
            return
        for key, item in value.items():
            if not isinstance(key, str) or key in kwargs:
                raise ExpressionFails(f"TypeError: ** unpacks the key {key!r}, which is no text or given twice")
            kwargs[key] = item

    def called(self, function: Value, args: list[Value], kwargs: dict[str, Value], node: ast.expr) -> Value:
        """Return the value of a call of any value."""
        return self.call_value(function, Call("", args, kwargs, position_of(node)))

    def call_value(self, function: Value, made: Call) -> Value:
        """Return the value of a call; the call gets its name here."""
        self.budget.charge(1 + len(made.args) + len(made.kwargs))
        apply = partial(self._apply, made.at)
        match function:
            case Function():
                return self.call_function(function, made)
            case QualifiedName(name="glob"):
                self.error("glob is a module here and cannot be called: write glob.glob(...)", made.at)
                made.name = "glob.glob"
                return self._by_name(made)
            case QualifiedName(name=name):
                made.name = "glob.glob" if name == "?glob" else name
                return self._by_name(made)
            case BoundMethod(owner=Call() as owner, name=name):
                made.name, made.owner = f"{owner.name}.{name}", owner
                return self._by_name(made)
            case BoundMethod(owner=owner, name=name):
                return self._method(owner, name, made)
            case PlainFunction():
                if UNKNOWN_KEYS in made.kwargs:
                    raise Undetermined("the unpacked arguments are known only at run time", made.at)
                return call(function, made.args, made.kwargs, self.budget, apply)
        if isinstance(function, Unknown) and function.reason == FAILED:
            return function
        if isinstance(function, PLAIN):
            kind = type(function).__name__
            raise ExpressionFails(f"a {kind} cannot be called: is there a comma missing before it?")
        raise EvaluationStopped(f"this call {_NOT_EVALUATED}: {reason_of(function)}".rstrip(": "), made.at)

    def _apply(self, at: Position, function: Value, args: list[Value]) -> Value:
        return self.call_value(function, Call("", args, {}, at))

    def _by_name(self, made: Call) -> Value:
        """Return the value of a call of something outside of the file, by the table."""
        function = self.functions.get(made.name)
        if function is None:
            if made.name.startswith("?."):  # an undefined name, which is an error already
                return Unknown(FAILED, made.at)
            raise EvaluationStopped(f"{made.name.removeprefix('builtins.')} {_NOT_EVALUATED}", made.at)
        if isinstance(function, PlainFunction):
            return self.call_value(function, made)
        return function(self, made)

    def _method(self, owner: Value, name: str, made: Call) -> Value:
        """Return the value of a method. Of what is not known, only a method of texts is known to change nothing."""
        kind = _kind(owner)
        if kind and f"{kind}.{name}" in self.functions:
            made.name, made.args = f"{kind}.{name}", [owner, *made.args]
            return self._by_name(made)
        changing = next((names for kind, names in _CHANGING.items() if isinstance(owner, kind)), ())
        if name in changing:
            return self._change(owner, name, made)
        found = method(owner, name, self.budget)
        if found is not None:
            return self.call_value(found, made)
        if isinstance(owner, Unknown) and (name in _TEXT_METHODS or owner.reason == FAILED):
            raise Undetermined(owner.reason, owner.at)
        raise EvaluationStopped(f"the method {name} of this value {_NOT_EVALUATED}", made.at)

    def _change(self, owner: Value, name: str, made: Call) -> Value:
        """Run a method that changes a list, dict or set: Python's own."""
        try:
            self.budget.measure([made.args, [*made.kwargs.values()]], "holds")
            args, kwargs = made.args, dict(made.kwargs)
            if name == "sort":
                arguments = [owner, *args]
                owner[:] = call(BUILTINS["sorted"], arguments, kwargs, self.budget, partial(self._apply, made.at))
                return None
            if name in ("extend", "update"):
                args = [value if isinstance(value, dict) else list(iterate(value)) for value in args]
            elif name not in ("append", "insert", "setdefault"):
                known(args)
            if name in ("remove", "index", "count"):
                known(owner)
            if name in ("insert", "setdefault"):
                known(args[:1])
            return self.budget.checked(call_plain(getattr(owner, name), *args, **kwargs))
        except Undetermined as error:
            raise EvaluationStopped(f"the method {name} {_NOT_EVALUATED} here: {error}", made.at) from None

    def call_function(self, function: Function, made: Call) -> Value:
        """Return the value of a call of a function of the file."""
        if self._depth == _MAX_DEPTH:
            raise EvaluationStopped("functions call each other too deeply", made.at)
        scope = Scope(self._bound_parameters(function, made), function.scope, function.locals)
        self._depth += 1
        try:
            return function.body(scope)
        finally:
            self._depth -= 1

    def _bound_parameters(self, function: Function, made: Call) -> dict[str, Value]:
        """Return the values of a function's parameters by their names."""
        parameters = function.parameters
        positional = [parameter.arg for parameter in (*parameters.posonlyargs, *parameters.args)]
        names = {*positional, *(parameter.arg for parameter in parameters.kwonlyargs)}
        unpacked = made.kwargs.get(UNKNOWN_KEYS)  # represents any argument
        given = dict(zip(positional, made.args, strict=False))
        by_name = {name: value for name, value in made.kwargs.items() if name in names}
        missing = sorted(names - given.keys() - by_name.keys() - function.defaults.keys())
        excess = len(made.args) > len(positional) and not parameters.vararg
        twice = sorted(given.keys() & by_name.keys())
        if unpacked is None and (missing or excess or twice or (made.kwargs.keys() - names and not parameters.kwarg)):
            what = f"the argument {missing[0]!r} is missing" if missing else "there is one argument too many"
            self.error(f"{what} in this call", made.at)
        elif unpacked is not None:
            self.doubted(unpacked)
        default = unpacked or Unknown("an argument is missing", made.at)
        bound = {**dict.fromkeys(names, default), **(function.defaults if unpacked is None else {}), **given, **by_name}
        if parameters.vararg:
            bound[parameters.vararg.arg] = tuple(made.args[len(positional) :])
        if parameters.kwarg:
            bound[parameters.kwarg.arg] = {name: value for name, value in made.kwargs.items() if name not in names}
        return bound


class _Held(ast.expr):
    """An expression that is evaluated already."""

    def __init__(self, held: Value) -> None:
        super().__init__()
        self.held = held


def _kind(owner: Value) -> str:
    """Return the name by which the table has the methods of a value: only those of paths are there."""
    return "pathlib.Path" if isinstance(owner, PurePosixPath) else ""


def _is_equality(node: ast.Compare) -> bool:
    return all(isinstance(op, ast.Eq | ast.NotEq | ast.Is | ast.IsNot) for op in node.ops)


FileExpressions.KINDS = {**kinds_of(FileExpressions), _Held: FileExpressions.of__held}
__all__ = ["EvaluationStopped", "ExitFlow", "FileExpressions", "FunctionTable", "PythonError", "RaisedFlow", "record"]
