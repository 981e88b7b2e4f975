"""The state of the evaluation of a file, and the calls in it.

These are calls of its own functions, of the table's, and of methods.
"""

import ast
from collections.abc import Callable, Collection, Mapping
from functools import partial
from pathlib import PurePosixPath
from typing import ClassVar

from grader.base.names import closest
from grader.base.records import Named
from grader.ros.known.python_names import python_names
from grader.ros.known.releases import Releases
from grader.ros.python.budget import Budget
from grader.ros.python.builtins import BUILTINS, call, truth
from grader.ros.python.expressions import Expressions
from grader.ros.python.library import USUAL_NAMES, is_inert, usual_meaning
from grader.ros.python.operators import method, operate
from grader.ros.python.parse import START, Position, make_position
from grader.ros.python.values import (
    PLAIN,
    BoundMethod,
    Call,
    EvaluationFails,
    Function,
    FunctionTable,
    InertValue,
    Items,
    Lacking,
    PlainFunction,
    QualifiedName,
    Scope,
    Undetermined,
    Unknown,
    UnknownAttribute,
    Value,
    call_plain,
    explain_unknown,
    is_object,
    known,
    one_of,
    unknown_after_error,
)
from grader.ros.python.walking import walk


class PythonError(Named):
    """An error that certainly stops Python at this position.

    Examples are an undefined name, an import that fails.
    """

    message: str
    at: Position
    name: str = ""  # that is undefined
    argument: str = ""  # that a function does not have
    lacks: Lacking = ""  # what another launch file, or the user, may give


NOT_EVALUATED = "is not evaluated"
MISSING_COMMA = "a {} cannot be called: is there a comma missing before it?"
# All parts of such an expression are evaluated before the expression itself; such a part may change
# something.
_WHOLE = (
    ast.Name,
    ast.Call,
    ast.BinOp,
    ast.UnaryOp,
    ast.Attribute,
    ast.Subscript,
    ast.JoinedStr,
    ast.FormattedValue,
)
_CHANGING = (ast.Call, ast.NamedExpr, ast.Await, ast.Yield, ast.YieldFrom)
# After them, nothing of the file is known.
_CHANGING_ANYTHING = frozenset(
    {
        *(f"builtins.{name}" for name in ("exec", "eval", "globals", "locals", "setattr", "vars")),
        *("os.chdir", "os.abort", "os._exit", "os.kill", "os.putenv", "os.environ.update"),
        *("os.environ.pop", "os.environ.clear", "os.execv", "os.execvp", "sys.path.append"),
        *("sys.path.insert", "importlib.import_module", "builtins.__import__"),
    }
)
_MAX_ERRORS = 200
_MAX_CALLS = 20_000
_MAX_DEPTH = 30  # of calls
_CHANGING_METHODS = {
    list: ("append", "extend", "insert", "sort", "reverse", "pop", "clear", "remove"),
    dict: ("update", "pop", "setdefault", "clear"),
}


class Evaluation(Expressions):
    """The state of the evaluation of a file.

    A part of an expression that is not known is Unknown: names, lists and arguments keep it, an
    operation with it is unknown as well. Only what the table of functions lists is called. Whatever
    else a file calls may do anything, so the evaluation stops there.
    """

    def __init__(
        self, functions: FunctionTable, names: Mapping[str, Value], budget: Budget
    ) -> None:
        """`functions` has every function that is evaluated.

        `names` are bound from the beginning, such as __file__.
        """
        super().__init__(self._builtin, budget)
        self.functions = functions
        self.exports: Mapping[str, Collection[str]] = {}
        self.local_modules: Collection[str] = ()
        self.releases: Releases = ()  # whose Python runs the file; none: that of Jazzy
        self.module = Scope({"__name__": "__main__", **names})
        self.errors: list[PythonError] = []
        self.calls: list[Call] = []  # what is recorded, in order
        # the first that may have failed, or stopped the evaluation
        self.doubt: Unknown | None = None
        self.at = START  # the statement that is evaluated
        self.attempts = 0  # how many try statements are around the statement
        # whether what follows a statement that is not evaluated is evaluated
        self.goes_on = False
        self.possible = 0  # how many branches around the statement may not run
        self.guarded = 0  # how many conditions are around it that ask for the environment
        self._depth = 0  # of calls of the file's functions

    def doubted(self, unknown: Unknown) -> Unknown:
        """Keep that an error may have been raised here, and return the unknown value."""
        self.doubt = self.doubt or unknown
        return unknown

    def error(
        self,
        message: str,
        at: Position,
        kind: type[BaseException] | None = None,
        *,
        name: str = "",
        argument: str = "",
        lacks: Lacking = "",
    ) -> None:
        """Record once an error that certainly stops Python, such as an undefined name.

        Raises it where a try may catch it. Where the statement may not run, it is a doubt.
        """
        if self.attempts:
            raise EvaluationFails(message, at, kind)
        if self.possible:
            self.doubted(Unknown(message, at))
            return
        if len(self.errors) < _MAX_ERRORS and all(
            message != error.message for error in self.errors
        ):
            self.errors.append(PythonError(message, at, name, argument, lacks))

    def evaluate(self, node: ast.expr, scope: Scope) -> Value:
        """Return the value of an expression.

        Returns Unknown, with the reason, where it cannot be determined.

        The evaluation stops if a part of the expression may have changed something and is not
        evaluated.
        """
        try:
            return self.value(node, scope)
        except Undetermined as error:
            unknown = error.as_unknown(make_position(node))
            if error.follows_error:
                return unknown
            may_change = not isinstance(node, _WHOLE) and any(
                isinstance(part, _CHANGING) for part in walk(node)
            )
            if error.is_final or may_change:
                raise Undetermined(unknown.reason, unknown.at, is_final=True) from None
            return unknown if _cannot_fail(node) else self.doubted(unknown)
        except EvaluationFails as error:
            at = error.at or make_position(node)
            self.error(str(error), at, error.kind, argument=error.argument, lacks=error.lacks)
            return unknown_after_error(make_position(node))

    def _name(self, node: ast.Name, scope: Scope) -> Value:
        """Return the value of a name.

        An undefined name is an error; its value is the most likely intended one.
        """
        try:
            return scope.find(node.id)
        except KeyError:
            pass
        if node.id in python_names("builtins", self.releases):
            return self._builtin(node.id)
        if node.id.startswith("__"):
            raise Undetermined(f"the name {node.id!r} {NOT_EVALUATED}")
        message = f"the name {node.id!r} is not defined or imported"
        self.error(message, make_position(node), NameError, name=node.id)
        texts = (name for name, value in self.module.names.items() if isinstance(value, str))
        meant = closest(node.id, texts) if node.id not in USUAL_NAMES else None
        if meant is not None:
            return self.module.names[meant]
        return usual_meaning(node.id)

    def _builtin(self, name: str) -> Value:
        full = f"builtins.{name}"
        if name in BUILTINS and full not in self.functions:
            return BUILTINS[name]
        return QualifiedName(full)

    def test(self, value: Value, branches: Collection[ast.expr]) -> bool:
        """Return whether a condition holds.

        Stops if that is unknown and a branch may change something.
        """
        if isinstance(value, Unknown | Call | QualifiedName | BoundMethod) and not is_object(value):
            nodes = (node for branch in branches for node in walk(branch))
            if any(isinstance(node, _CHANGING) for node in nodes):
                reason = f"a condition {NOT_EVALUATED}: {explain_unknown(value)}"
                raise Undetermined(reason, getattr(value, "at", self.at), is_final=True)
        return truth(value)

    def function(
        self,
        parameters: ast.arguments,
        scope: Scope,
        at: Position,
        body: Callable[[Scope], Value],
        local: frozenset[str] = frozenset(),
    ) -> Function:
        """Return a function as it is defined: its defaults are evaluated now."""
        positional = reversed(parameters.posonlyargs + parameters.args)
        pairs = list(zip(positional, reversed(parameters.defaults), strict=False))[::-1]
        named = zip(parameters.kwonlyargs, parameters.kw_defaults, strict=True)
        pairs += [(parameter, default) for parameter, default in named if default]
        defaults = {parameter.arg: self.evaluate(default, scope) for parameter, default in pairs}
        return Function(parameters, scope, defaults, body, at, local)

    def unpack(self, kwargs: dict[str, Value], value: Value, node: ast.expr) -> None:
        """Add the arguments that ** unpacks."""
        if not isinstance(value, dict):
            reason = explain_unknown(value) or f"this use of ** {NOT_EVALUATED}"
            raise Undetermined(reason, make_position(node), is_final=True)
        for key, item in value.items():
            if not isinstance(key, str) or key in kwargs:
                raise EvaluationFails(
                    f"TypeError: ** unpacks the key {key!r}, which is no text or given twice"
                )
            kwargs[key] = item

    def called(
        self, function: Value, args: list[Value], kwargs: dict[str, Value], node: ast.expr
    ) -> Value:
        """Return the value of a call of any value."""
        made = Call("", args, kwargs, make_position(node))
        for keyword in node.keywords if isinstance(node, ast.Call) else ():
            made.places[keyword.arg or ""] = make_position(keyword.value)
        return self.call_value(function, made)

    def call_value(self, function: Value, made: Call) -> Value:
        """Return the value of a call; the call gets its name here."""
        self.budget.charge(1 + len(made.args) + len(made.kwargs))
        result = None
        match function:
            case Function():
                result = self.call_function(function, made)
            case QualifiedName(is_defined=False):
                result = unknown_after_error(made.at)
            case QualifiedName(name=name):
                if name == "glob":
                    self.error(
                        "glob is a module here and cannot be called: write glob.glob(...)", made.at
                    )
                made.name = "glob.glob" if name in ("glob", "?glob") else name
                result = self._by_name(made)
            case BoundMethod(owner=Call() as owner, name=name):
                made.name = f"{owner.name}.{name}"
                made.owner = owner
                result = self._by_name(made)
            case BoundMethod() | UnknownAttribute():
                result = self._method(function.owner, function.name, made)
            case PlainFunction():
                result = self._plain(function, made)
            case Unknown(follows_error=True):
                result = function
            case _:
                result = self._call_other(function, made)
        return result

    def _call_other(self, function: Value, made: Call) -> Value:
        """Return the value of a call of what is neither a function of the file nor of the table."""
        match function:
            case Call(name="functools.partial", args=[inner, *first], kwargs=named):
                made.args = first + made.args
                made.kwargs = {**named, **made.kwargs}
                return self.call_value(inner, made)
            case _ if isinstance(function, PLAIN):
                kind = type(function).__name__
                raise EvaluationFails(MISSING_COMMA.format(kind))
        reason = f"this call {NOT_EVALUATED}: {explain_unknown(function)}".rstrip(": ")
        return self._call_outside(reason, made)

    def _call_outside(self, reason: str, made: Call) -> Value:
        """Return the value of a call of what is not evaluated: not known, as what it may change."""
        given = [*made.args, *made.kwargs.values()]
        callbacks = Function | BoundMethod | Items
        if not self.goes_on or any(isinstance(value, callbacks) for value in given):
            raise Undetermined(reason, made.at, is_final=True)
        unknown = self.doubted(Unknown(reason, made.at))
        for value in given:
            self.make_open(value, unknown)
        return unknown

    def make_open(self, value: Value, unknown: Unknown) -> None:
        """Keep that a list may have changed; raise Undetermined for a dict, whose keys may have."""
        if isinstance(value, list) and unknown not in value[-1:]:
            value.append(unknown)
        elif isinstance(value, dict) and value:
            raise Undetermined(unknown.reason, unknown.at, is_final=True)

    def _plain(self, function: PlainFunction, made: Call) -> Value:
        """Return the value of Python's own function.

        Stops where it would call others, or use up an iterator.
        """
        try:
            return call(
                function, made.args, made.kwargs, self.budget, partial(self._apply, made.at)
            )
        except Undetermined as error:
            given = (*made.args, *made.kwargs.values())
            if any(
                isinstance(value, Function | BoundMethod | QualifiedName | Items) for value in given
            ):
                raise Undetermined(str(error), error.at or made.at, is_final=True) from None
            raise

    def _apply(self, at: Position, function: Value, args: list[Value]) -> Value:
        return self.call_value(function, Call("", args, {}, at))

    def _by_name(self, made: Call) -> Value:
        """Return the value of a call of something outside of the file, by the table."""
        function = self.functions.get(made.name)
        if function is None:
            reason = f"{made.name.removeprefix('builtins.')} {NOT_EVALUATED}"
            if is_inert(made.name):
                return InertValue(reason, made.at)
            if made.name in _CHANGING_ANYTHING:
                raise Undetermined(reason, made.at, is_final=True)
            return self._call_outside(reason, made)
        if isinstance(function, PlainFunction):
            return self.call_value(function, made)
        return function(self, made)

    def _method(self, owner: Value, name: str, made: Call) -> Value:
        """Return the value of a method.

        Of what is not known, only a method of texts is known to change nothing.
        """
        if isinstance(owner, PurePosixPath) and f"pathlib.Path.{name}" in self.functions:
            made.name = f"pathlib.Path.{name}"
            made.args = [owner, *made.args]
            return self._by_name(made)
        if any(
            isinstance(owner, kind) and name in names for kind, names in _CHANGING_METHODS.items()
        ):
            return self._change(owner, name, made)
        bound_method = method(owner, name, self.budget)
        if bound_method:
            return self.call_value(bound_method, made)
        if isinstance(owner, Unknown) and owner.is_text and name in ("replace", "strip"):
            return owner  # still a text that is not known, or that of a file
        if isinstance(owner, Unknown) and (
            owner.follows_error or name in python_names("class str", self.releases)
        ):
            raise owner.as_signal(owner.at)
        reason = f"the method {name} of this value {NOT_EVALUATED}"
        if isinstance(owner, InertValue):
            return InertValue(owner.reason, made.at)
        if not isinstance(owner, Unknown):
            raise Undetermined(reason, made.at, is_final=True)
        return self._call_outside(reason, made)

    def _change(self, owner: Value, name: str, made: Call) -> Value:
        """Run a method that changes a list or dict: Python's own."""
        try:
            self.budget.measure([made.args, list(made.kwargs.values())], "holds")
            self.budget.charge(len(owner) // 16 if name != "append" else 0)
            args = made.args
            kwargs = made.kwargs
            if name == "sort":
                arguments = [owner, *args]
                owner[:] = call(
                    BUILTINS["sorted"],
                    arguments,
                    kwargs,
                    self.budget,
                    partial(self._apply, made.at),
                )
                return None
            if name in ("extend", "update"):
                args = [
                    value if isinstance(value, dict) else list(self.budget.items(value))
                    for value in args
                ]
            elif name == "remove":
                known([owner, args])
            elif name != "append":
                known(args if name not in ("insert", "setdefault") else args[:1])
            if self.possible:
                args = self._as_possible(name, args)
            return self.budget.checked(call_plain(getattr(owner, name), *args, **kwargs))
        except Undetermined as error:
            if error.is_final:
                raise
            reason = f"the method {name} {NOT_EVALUATED} here: {error}"
            raise Undetermined(reason, made.at, is_final=True) from None

    def _as_possible(self, name: str, args: list[Value]) -> list[Value]:
        """Return what a method that may not run adds. Raises Undetermined for other changes."""
        match name, args:
            case "append", [item]:
                return [self.perhaps(item)]
            case "extend", [[*items]]:
                return [list(map(self.perhaps, items))]
            case "insert" | "setdefault", [place, item]:
                return [place, self.perhaps(item)]
            case "update", [{**pairs}]:
                return [{key: self.perhaps(item) for key, item in pairs.items()}]
        raise Undetermined("whether it runs is not known")

    def perhaps(self, value: Value) -> Value:
        """Return a value that may not be there where it is not known whether the statement runs."""
        if not self.possible:
            return value
        return one_of([value], f"whether this branch runs {NOT_EVALUATED}", self.at)

    def call_function(self, function: Function, made: Call) -> Value:
        """Return the value of a call of a function of the file."""
        if self._depth == _MAX_DEPTH:
            raise Undetermined(
                f"a function that calls others so deeply {NOT_EVALUATED}", made.at, is_final=True
            )
        scope = Scope(self._bound_parameters(function, made), function.scope, function.local)
        self._depth += 1
        try:
            return function.body(scope)
        finally:
            self._depth -= 1

    def _bound_parameters(self, function: Function, made: Call) -> dict[str, Value]:
        """Return the values of a function's parameters by their names."""
        parameters = function.parameters
        positional = [parameter.arg for parameter in parameters.posonlyargs + parameters.args]
        names = {*positional, *(parameter.arg for parameter in parameters.kwonlyargs)}
        given = dict(zip(positional, made.args, strict=False))
        named = {name: value for name, value in made.kwargs.items() if name in names}
        others = dict(made.kwargs)
        for name in named.keys() - given.keys():
            del others[name]
        missing = sorted(names - given.keys() - named.keys() - function.defaults.keys())
        if missing:
            self.error(f"the argument {missing[0]!r} is missing in this call", made.at)
        elif _are_too_many(made, parameters, others):
            self.error("there is one argument too many in this call", made.at)
        absent = dict.fromkeys(names, Unknown("an argument is missing", made.at))
        bound = {**absent, **function.defaults, **given, **named}
        if parameters.vararg:
            bound[parameters.vararg.arg] = tuple(made.args[len(positional) :])
        if parameters.kwarg:
            bound[parameters.kwarg.arg] = others
        return bound

    def _binary(self, node: ast.BinOp, scope: Scope) -> Value:
        """Return the value of a binary operator.

        For an object in the table it is its method for division.
        """
        left = self.evaluate(node.left, scope)
        right = self.evaluate(node.right, scope)
        if (
            isinstance(node.op, ast.Div)
            and isinstance(left, Call)
            and f"{left.name}.__truediv__" in self.functions
        ):
            made = Call("", [right], {}, make_position(node))
            return self.call_value(BoundMethod(left, "__truediv__"), made)
        added = self._add_open(left, right) if isinstance(node.op, ast.Add) else None
        return operate(node.op, left, right, self.budget) if added is None else added

    def _add_open(self, left: Value, right: Value) -> Value:
        """Return the sum of two lists or texts of which one is not known; None for other values."""
        match left, right:
            case (list(), Unknown()) | (Unknown(), list()) if self.goes_on:
                return spread(left) + spread(right)
            case (Unknown(is_text=True) as text, str() | Unknown(is_text=True)) | (
                str(),
                Unknown(is_text=True) as text,
            ):
                return text  # a longer one, which is not known either
        return None

    def _ifexp(self, node: ast.IfExp, scope: Scope) -> Value:
        """Return the value of a conditional expression: one of both where the condition is open."""
        value = self.evaluate(node.test, scope)
        branches = [node.body, node.orelse]
        if not (self.goes_on and isinstance(value, Unknown)) or value.follows_error:
            return self.evaluate(branches[not self.test(value, branches)], scope)
        self.possible += 1
        try:
            values = [self.evaluate(branch, scope) for branch in branches]
        finally:
            self.possible -= 1
        return one_of(values, value.reason, value.at)

    KINDS: ClassVar = {
        **Expressions.KINDS,
        ast.Name: _name,
        ast.BinOp: _binary,
        ast.IfExp: _ifexp,
    }


def spread(value: Value) -> list[Value]:
    """Return the items of a list; of one that is not known, those that may be there."""
    if not isinstance(value, Unknown):
        return list(value)
    items = []
    for candidate in value.candidates:
        if isinstance(candidate, list | tuple):
            items += [one_of([item], value.reason, value.at) for item in candidate]
    return items if value.candidates else [value]


def _cannot_fail(node: ast.expr) -> bool:
    """Return whether an operator raises no error, whatever the values are."""
    match node:
        case ast.UnaryOp(op=ast.Not()) | ast.BoolOp() | ast.IfExp():
            return True
        case ast.Compare(ops=ops):
            return all(isinstance(op, ast.Eq | ast.NotEq | ast.Is | ast.IsNot) for op in ops)
    return False


def record(evaluation: Evaluation, made: Call) -> Call:
    """Record a call that is not evaluated further, and return it as its result.

    The result is a function for the table.
    """
    if len(evaluation.calls) < _MAX_CALLS:
        evaluation.calls.append(made)
        if made.owner:
            made.owner.method_calls.append(made)
    return made


def _are_too_many(made: Call, parameters: ast.arguments, others: Mapping[str, Value]) -> bool:
    """Return whether a call gives arguments that no parameter takes; `others` have a name."""
    positional = parameters.posonlyargs + parameters.args
    if len(made.args) > len(positional) and not parameters.vararg:
        return True
    return bool(others) and not parameters.kwarg
