"""Evaluate a whole Python file without running it.

This covers its functions, branches, loops, assignments and imports.

A statement of any other kind, such as `try` or `while`, ends the evaluation: what follows is not
known.
"""

import ast
import builtins
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
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
from grader.ros.python import values as py
from grader.ros.python.budget import Budget
from grader.ros.python.builtins import truth
from grader.ros.python.evaluation import MISSING_COMMA, NOT_EVALUATED, Evaluation
from grader.ros.python.library import (
    CONSTANTS,
    Uncertain,
    attribute_error,
    import_error,
    imported_names,
    usual_meaning,
)
from grader.ros.python.operators import has_attribute, operate
from grader.ros.python.parse import Code, Position, bound_in, make_position, own_nodes
from grader.ros.python.values import call_plain, charge_str, known, refuse
from grader.ros.python.walking import walk

_PARTS = ("name", "stem", "suffix", "parent", "parents", "parts")  # of a path
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


class _ReturnFlow(py.EvaluationSignal):
    """A return statement, with its value."""

    def __init__(self, value: py.Value) -> None:
        super().__init__()
        self.value = value


_ENVIRONMENTS = ("os.environ", "environ")
# By which packages, programs and files are found.
SEARCHED_VARIABLES = ("AMENT_PREFIX_PATH", "PATH", "PYTHONPATH", "LD_LIBRARY_PATH", "HOME")
_WITHOUT_EFFECT = frozenset(
    {
        *("os.path.join", "os.pathsep.join", "os.getenv", "str"),
        *(f"{name}.get" for name in _ENVIRONMENTS),
    }
)


class _ClassScope(py.Scope):
    """The names in the body of a class."""


def _stop_at(node: ast.FunctionDef) -> Iterator[py.Value]:
    """Raise Undetermined where the first item of a generator function is needed."""
    yield from ()
    raise py.Undetermined(
        "a generator function is not evaluated", make_position(node), is_final=True
    )


def _catches(kind: ast.expr | None, raised: py.EvaluationFails, at: Position) -> bool:
    """Return whether `except KIND` catches an error. Raises Undetermined."""
    name = kind.id if isinstance(kind, ast.Name) else ""
    if kind is None or name == "BaseException" or (raised.kind is None and name == "Exception"):
        return True
    caught = _BUILT_IN.get(name)
    if raised.kind is None or not isinstance(caught, type):
        message = "which error is raised in this try is not evaluated"
        raise py.Undetermined(message, at, is_final=True)
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


def _names_bound(body: Sequence[ast.stmt]) -> set[str] | None:
    """Return the names that branches bind; None if they do more than set the environment, too."""
    names = set[str]()
    for statement in body:
        match statement:
            case (
                ast.Assign(targets=[target], value=value)
                | ast.AugAssign(target=target, value=value)
            ):
                pass
            case ast.Pass():
                continue
            case _:
                return None
        calls = [_full_name(each.func) for each in walk(value) if isinstance(each, ast.Call)]
        if not _WITHOUT_EFFECT.issuperset(calls):
            return None
        match target:
            case ast.Name(id=name):
                names.add(name)
            case ast.Subscript(value=owner, slice=ast.Constant(value=key)):
                if _full_name(owner) not in _ENVIRONMENTS or key in SEARCHED_VARIABLES:
                    return None
            case _:
                return None
    return names


class Interpreter(Evaluation):
    """Adds the statements of a file to its expressions."""

    def __init__(
        self,
        functions: py.FunctionTable,
        names: Mapping[str, py.Value],
        *,
        stand_ins: Collection[str] = (),
        budget: Budget | None = None,
        exports: Mapping[str, Collection[str]] | None = None,
        local_modules: Collection[str] = (),
    ) -> None:
        """`functions` may be called, by full name.

        `names` are bound from the beginning, such as __file__.

        `stand_ins` are texts that stand for folders that are not known; `exports` has the names of
        modules, besides those of Python itself; `local_modules` are beside the file, and imported
        before any other.
        """
        super().__init__(functions, names, budget or Budget(MAX_FILE_STEPS))
        self.budget.stand_ins = stand_ins
        self.exports = exports or {}
        self.local_modules = local_modules

    def run(self, code: Code) -> py.Scope:
        """Evaluate a whole file and return the scope of its names. Never raises."""
        self.releases = code.releases
        try:
            self._block(code.tree.body, self.module)
        except (py.EvaluationSignal, RecursionError) as error:
            self._stop(error)
        return self.module

    def call_from_outside(
        self, function: py.Function, at: Position, args: Sequence[py.Value] | None = ()
    ) -> py.Value:
        """Return the value of a call of one of the file's functions. Never raises.

        With `args` None, the arguments are unknown, and no error or doubt in the call counts: it
        may never happen.
        """
        given = function.parameters
        count = len([*given.posonlyargs, *given.args]) - len(given.defaults)
        event: list[py.Value] = [py.Unknown("an event is known only at run time", at)] * count
        recorded, doubt = list(self.errors), self.doubt
        try:
            return self.call_function(
                function, py.Call("", event if args is None else list(args), {}, at)
            )
        except (py.EvaluationSignal, RecursionError) as error:
            return self._stop(error, at)
        finally:
            if args is None:
                self.errors, self.doubt = recorded, doubt

    def _stop(
        self, error: py.EvaluationSignal | RecursionError, at: Position | None = None
    ) -> py.Unknown:
        if isinstance(error, RecursionError):
            error = py.Undetermined("the file is too deeply nested, which is not evaluated")
        return self.doubted(error.as_unknown(at or self.at))

    def _block(self, body: list[ast.stmt], scope: py.Scope) -> None:
        for node in body:
            self.budget.charge(1)
            self.at = make_position(node)
            kind = self._STATEMENTS.get(type(node))
            if kind is None:
                raise py.Undetermined(
                    f"a statement of the kind {type(node).__name__} is not evaluated",
                    self.at,
                    is_final=True,
                )
            try:
                kind(self, node, scope)
            except py.EvaluationFails as error:  # of the statement itself, such as an assignment
                at = error.at or make_position(node)
                self.error(str(error), at, error.kind, argument=error.argument, lacks=error.lacks)
            except py.Undetermined as error:
                if error.is_final:
                    raise
                reason = f"this statement is not evaluated: {error}"
                raise py.Undetermined(
                    reason, error.at or make_position(node), is_final=True
                ) from None

    def _functiondef(self, node: ast.FunctionDef, scope: py.Scope) -> None:
        at = make_position(node)
        if getattr(node, "type_params", []):
            raise py.Undetermined(
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
        function: py.Value = self.function(
            parameters, scope, at, partial(self._function_body, node), bound_in(node)
        )
        for annotation in (
            *(parameter.annotation for parameter in every if parameter),
            node.returns,
        ):
            self._annotation(annotation, scope)
        for decorator in reversed(decorators):
            function = self.call_value(decorator, py.Call("", [function], {}, at))
        scope.names[node.name] = function

    def _classdef(self, node: ast.ClassDef, scope: py.Scope) -> None:
        """Evaluate the body of a class, which is not evaluated itself."""
        bases = [self.evaluate(base, scope) for base in node.bases]
        is_plain = not node.keywords and not node.decorator_list
        if not is_plain or not all(isinstance(base, py.QualifiedName) for base in bases):
            raise py.Undetermined("a class of this kind is not evaluated", self.at, is_final=True)
        at, inside = self.at, _ClassScope({}, scope)
        self._block(node.body, inside)
        scope.names[node.name] = py.ClassBody(inside.names, at)

    def _delete(self, node: ast.Delete, scope: py.Scope) -> None:
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
                    raise py.Undetermined("this use of del is not supported")

    def _function_body(self, node: ast.FunctionDef, scope: py.Scope) -> py.Value:
        if any(isinstance(inner, ast.Yield | ast.YieldFrom) for inner in own_nodes(node)):
            return py.Items(_stop_at(node))
        try:
            self._block(node.body, scope)
        except _ReturnFlow as flow:
            return flow.value
        return None

    def _return(self, node: ast.Return, scope: py.Scope) -> None:
        raise _ReturnFlow(self.evaluate(node.value, scope) if node.value is not None else None)

    def _annotation(self, node: ast.expr | None, scope: py.Scope) -> None:
        """Find the names of an annotation, and stop where it calls something."""
        if node is None:
            return
        for part in walk(node):
            if isinstance(part, ast.Name):
                self._name(part, scope)
            elif not isinstance(part, _IN_ANNOTATIONS):
                raise py.Undetermined("this annotation is not evaluated", self.at, is_final=True)

    def _if(self, node: ast.If, scope: py.Scope) -> None:
        branches = [*node.body, *node.orelse]
        if not (_reads_environment(node.test) and self._skip_branches(branches, scope)):
            self._block(node.body if truth(self.evaluate(node.test, scope)) else node.orelse, scope)

    def _skip_branches(self, branches: Sequence[ast.stmt], scope: py.Scope) -> bool:
        """Make unknown what branches bind of which one runs; return False if they do more.

        Also if they read a name that is not bound: one of them may fail.
        """
        names = _names_bound(branches)
        if names is None or not self._has_names(branches, scope):
            return False
        for name in names:
            reason = f"which branch binds {name} {NOT_EVALUATED}"
            scope.names[name] = py.Unknown(reason, self.at)
        return True

    def _has_names(self, statements: Sequence[ast.stmt], scope: py.Scope) -> bool:
        """Return whether each name that statements read is bound before."""
        bound = set[str]()
        for statement in statements:
            names = [part for part in walk(statement) if isinstance(part, ast.Name)]
            try:
                for name in names:
                    if isinstance(name.ctx, ast.Load) and name.id not in bound:
                        self._name(name, scope)
            except py.EvaluationFails:
                return False
            bound.update(name.id for name in names if isinstance(name.ctx, ast.Store))
        return True

    def _for(self, node: ast.For, scope: py.Scope) -> None:
        items = self.evaluate(node.iter, scope)
        # How often it runs once the error is fixed is not known.
        if isinstance(items, py.Unknown) and items.follows_error:
            self.doubted(items)
            items = []
        for item in self.budget.items(items):
            self.bind(node.target, item, scope)
            self._block(node.body, scope)
        self._block(node.orelse, scope)

    def _with(self, node: ast.With, scope: py.Scope) -> None:
        value, target = (
            self.evaluate(node.items[0].context_expr, scope),
            node.items[0].optional_vars,
        )
        # Such as open() of a file that does not exist.
        has_failed = isinstance(value, py.Unknown) and value.follows_error
        if isinstance(value, py.Call):
            self.call_value(py.BoundMethod(value, "__enter__"), py.Call("", [], {}, self.at))
        if len(node.items) > 1 or not (isinstance(value, py.Call | StringIO) or has_failed):
            raise py.Undetermined("this use of with is not evaluated", self.at, is_final=True)
        if target is not None:
            self.bind(target, value, scope)
        try:
            self._block(node.body, scope)
        finally:
            if isinstance(value, StringIO):
                value.close()
            elif isinstance(value, py.Call):
                value.method_calls.append(py.Call(f"{value.name}.__exit__", [], {}, self.at, value))

    def _annassign(self, node: ast.AnnAssign, scope: py.Scope) -> None:
        if node.value is not None:
            self.bind(node.target, self.evaluate(node.value, scope), scope)
        if scope is self.module or isinstance(scope, _ClassScope):
            self._annotation(node.annotation, scope)

    def _expr(self, node: ast.Expr, scope: py.Scope) -> None:
        self.evaluate(node.value, scope)

    def _pass(self, node: ast.Pass, scope: py.Scope) -> None:
        pass

    def _import(self, node: ast.Import | ast.ImportFrom, scope: py.Scope) -> None:
        module = ""
        if isinstance(node, ast.ImportFrom):
            module = "." * node.level + (node.module or "")
        for alias in node.names:
            if (module or alias.name).split(".")[0] in self.local_modules:
                raise py.Undetermined(
                    f"the file's own module {module or alias.name} is not evaluated",
                    self.at,
                    is_final=True,
                )
            error = import_error(module, alias.name, self.exports, self.releases)
            bound = imported_names(module, alias, self.exports)
            if isinstance(error, Uncertain):
                reason = (
                    f"whether {module or alias.name} is installed is not known; it is not evaluated"
                )
                self.doubted(py.Unknown(reason, self.at))
            elif error is not None:
                self.error(error, self.at, ModuleNotFoundError)
                bound = dict.fromkeys(bound, usual_meaning(alias.name))
            if bound.pop("*", None) is not None:
                raise py.Undetermined(
                    f"the names of {module} are not evaluated", self.at, is_final=True
                )
            scope.names.update(bound)

    def _try(self, node: ast.Try, scope: py.Scope) -> None:
        """Run a body, and the handler of what it certainly raises; stop where it may raise more."""
        if node.finalbody:
            raise py.Undetermined("a try with finally is not evaluated", self.at, is_final=True)
        branches = [*node.body, *node.orelse]
        for handler in node.handlers:
            branches += handler.body
        if any(map(_reads_environment, node.body)) and self._skip_branches(branches, scope):
            return
        doubt, self.doubt, raised = self.doubt, None, None
        self.attempts += 1
        try:
            self._block(node.body, scope)
        except py.EvaluationFails as error:
            raised = error
        finally:
            self.attempts -= 1
        if self.doubt is not None:
            raise py.Undetermined(self.doubt.reason, self.doubt.at, is_final=True)
        self.doubt = doubt
        if raised is None:
            self._block(node.orelse, scope)
        else:
            self._handle(raised, node.handlers, scope)

    def _handle(
        self, raised: py.EvaluationFails, handlers: Sequence[ast.ExceptHandler], scope: py.Scope
    ) -> None:
        """Run the handler of an error; raise it again where none catches it."""
        for handler in handlers:
            kinds = handler.type.elts if isinstance(handler.type, ast.Tuple) else [handler.type]
            if any(_catches(kind, raised, self.at) for kind in kinds):
                if handler.name:
                    scope.names[handler.name] = py.Unknown(
                        "an error is not evaluated", make_position(handler)
                    )
                self._block(handler.body, scope)
                return
        raise raised

    def _assert(self, node: ast.Assert, scope: py.Scope) -> None:
        if not truth(self.evaluate(node.test, scope)):
            self.error("this assertion fails", self.at, AssertionError)

    def _raise(self, node: ast.Raise, _: py.Scope) -> None:
        raised = node.exc.func if isinstance(node.exc, ast.Call) else node.exc
        kind = _BUILT_IN.get(raised.id) if isinstance(raised, ast.Name) else None
        if isinstance(kind, type) and issubclass(kind, Exception):
            self.error(f"the file raises {kind.__name__} here", self.at, kind)
        raise py.Undetermined("which error is raised here is not evaluated", self.at, is_final=True)

    def _attribute(self, node: ast.Attribute, scope: py.Scope) -> py.Value:
        owner, name = self.evaluate(node.value, scope), node.attr
        if isinstance(owner, py.QualifiedName):
            return self._attribute_of_module(owner, node)
        match owner:
            case PurePosixPath() if name in _PARTS:
                return self._part_of_path(owner, name)
            case py.Namespace():
                return owner.find(name)
            case py.Unknown(is_text=False):
                return owner.attribute(name, make_position(node))
        if isinstance(owner, py.PLAIN) and not has_attribute(owner, name, self.releases):
            raise py.EvaluationFails(f"{type(owner).__name__!r} has no attribute {name!r}")
        return py.BoundMethod(owner, name, node)

    def _part_of_path(self, path: PurePosixPath, name: str) -> py.Value:
        """Return an attribute of a path; those above a folder that is not known are not known."""
        value = self.budget.checked(getattr(path, name) if name != "parents" else None, "path")
        above: list[py.Value] = [*path.parents] if name == "parents" else [value]
        is_folder = name in ("parent", "parents")
        unknown = py.Unknown("the folder that a build installs to is not known", self.at)
        known = [
            part if not is_folder or self.budget.is_below(path, part) else unknown for part in above
        ]
        return known if name == "parents" else known[0]

    def _attribute_of_module(self, owner: py.QualifiedName, node: ast.Attribute) -> py.Value:
        """Return what a name in a module stands for; a misspelt one is an error."""
        if (
            owner.name == "?glob"
        ):  # used without an import: the attribute shows that it is the module
            return py.QualifiedName(f"glob.{node.attr}")
        if owner.name == "glob.glob" and node.attr in ("glob", "iglob"):
            message = (
                f"glob is a function here, so glob.{node.attr} is not defined: write glob(...)"
            )
            self.error(message, make_position(node))
            return owner
        module, full = owner.name, f"{owner.name}.{node.attr}"
        is_evaluated = full in self.functions
        error = None if is_evaluated else attribute_error(module, node.attr, self.releases)
        if error is not None:
            known = [
                function for function in self.functions if function.rpartition(".")[0] == module
            ]
            meant = closest(full, known)
            if meant is None:
                raise py.EvaluationFails(error)
            self.error(error, make_position(node))
            full = meant
        return CONSTANTS.get(full, py.QualifiedName(full, is_defined=owner.is_defined))

    def item(self, owner: py.Value, key: py.Value, node: ast.expr) -> py.Value:
        """Return the value of owner[key]; of something outside of the file, by the table."""
        if not isinstance(owner, py.QualifiedName | py.Call):
            return super().item(owner, key, node)
        made = py.Call(f"{owner.name}.__getitem__", [key], {}, make_position(node))
        function = self.functions.get(made.name)
        if (
            function is None
            and isinstance(owner, py.QualifiedName)
            and owner.name in self.functions
        ):
            self.error(
                f"{owner.name} is a function: write ( ) around its arguments, not [ ]",
                make_position(node),
            )
            return self.call_value(owner, py.Call("", [key], {}, make_position(node)))
        if function is None or isinstance(function, py.PlainFunction):
            raise py.Undetermined(f"{owner.name}[...] {NOT_EVALUATED}")
        return function(self, made)

    def elements(self, nodes: Sequence[ast.expr], scope: py.Scope) -> list[py.Value]:
        """Return the values of the elements of a list, or of the arguments of a call."""
        values: list[py.Value] = []
        for node in chain.from_iterable(map(self._separated, nodes)):
            if not isinstance(node, ast.Starred):
                values.append(self.evaluate(node, scope))
                continue
            try:
                values += self.budget.items(self.evaluate(node.value, scope))
            except py.Undetermined as error:
                raise py.Undetermined(
                    str(error), error.at or make_position(node), is_final=True
                ) from None
        return values

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

    def _set(self, node: ast.Set, scope: py.Scope) -> py.Value:
        return call_plain(set, self.elements(node.elts, scope))

    def _dict(self, node: ast.Dict, scope: py.Scope) -> py.Value:
        table: dict[Any, py.Value] = {}
        for key, value in zip(node.keys, node.values, strict=True):
            evaluated = self.evaluate(value, scope)
            if key is not None:
                call_plain(table.__setitem__, known(self.evaluate(key, scope)), evaluated)
            elif isinstance(evaluated, dict):
                table |= evaluated
            else:
                refuse(evaluated, "this dict is not supported")
        return table

    def _joinedstr(self, node: ast.JoinedStr, scope: py.Scope) -> py.Value:
        pieces = [self.evaluate(piece, scope) for piece in node.values]
        if len(pieces) == 1 and isinstance(pieces[0], py.Unknown):
            return pieces[0]
        self.budget.measure(pieces, "text")
        return self.budget.checked("".join(pieces), "text")

    def _formattedvalue(self, node: ast.FormattedValue, scope: py.Scope) -> py.Value:
        value = self.evaluate(node.value, scope)
        is_text = isinstance(value, py.Unknown) and value.is_text
        if not is_text:
            self.budget.measure(value, "text")
        if node.format_spec is not None or node.conversion not in (-1, ord("s")):
            raise py.Undetermined("a format of this kind is not supported")
        return value if is_text else charge_str(value)

    def _dictcomp(self, node: ast.DictComp, scope: py.Scope) -> py.Value:
        return {
            known(self.evaluate(node.key, inner)): self.evaluate(node.value, inner)
            for inner in self.rounds(node.generators, py.Scope({}, scope))
        }

    def _lambda(self, node: ast.Lambda, scope: py.Scope) -> py.Value:
        return self.function(
            node.args, scope, make_position(node), lambda inner: self.evaluate(node.body, inner)
        )

    def bind(self, target: ast.expr, value: py.Value, scope: py.Scope) -> None:
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
                if isinstance(changed, py.PLAIN):
                    raise py.EvaluationFails(
                        f"{type(changed).__name__!r} has no attribute {name!r}"
                    )
                reason = f"a change of the attribute {name} is not evaluated"
                raise py.Undetermined(reason, make_position(target), is_final=True)
            case _:
                super().bind(target, value, scope)

    def _store(self, owner: py.Value, key: py.Value, value: py.Value, at: Position) -> None:
        """Set an item of a list or dict."""
        if isinstance(owner, py.QualifiedName | py.Call):
            made = py.Call(f"{owner.name}.__setitem__", [key, value], {}, at)
            is_defined = isinstance(owner, py.Call) or owner.is_defined
            self.call_value(py.QualifiedName(made.name, is_defined=is_defined), made)
            return
        if not isinstance(owner, py.PLAIN) or isinstance(key, slice):
            refuse(owner, "this assignment to an item is not supported")
        call_plain(setitem, owner, key, value)
        self.budget.charge(len(owner))

    def _assign(self, node: ast.Assign, scope: py.Scope) -> None:
        value = self.evaluate(node.value, scope)
        for target in node.targets:
            self.bind(target, value, scope)

    def _augassign(self, node: ast.AugAssign, scope: py.Scope) -> None:
        target = node.target
        if any(isinstance(part, ast.Call | ast.NamedExpr) for part in walk(target)):
            raise py.Undetermined("this target is not supported")
        load = copy(target)
        load.ctx = ast.Load()
        before, value = self.evaluate(load, scope), self.evaluate(node.value, scope)
        if isinstance(before, py.Unknown) and before.is_text:
            self.bind(target, before, scope)  # still a text that is not known
            return
        if not isinstance(before, py.PLAIN):
            refuse(before, "this value is not supported")
        if isinstance(before, list) and isinstance(node.op, ast.Add):
            before.extend(list(self.budget.items(value)))
            self.budget.measure(before, "holds")
        elif isinstance(before, list | dict):
            raise py.Undetermined("this operator is not supported")
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
    }

    # The statements that are evaluated.
    _STATEMENTS: ClassVar[Mapping[type[ast.stmt], Callable[[Any, Any, py.Scope], None]]] = {
        ast.FunctionDef: _functiondef,
        ast.ClassDef: _classdef,
        ast.Delete: _delete,
        ast.Return: _return,
        ast.If: _if,
        ast.For: _for,
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
