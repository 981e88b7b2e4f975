"""Statements of a followed file: what they set, which branches are taken, which errors are caught."""

import ast
import builtins
from typing import TYPE_CHECKING

from grader.static_python.containers import extend, items_of, remove, store, truth
from grader.static_python.expressions import evaluate
from grader.static_python.leaving import Leave, Left, Raised, Return
from grader.static_python.names import import_fault, is_at_hand, public_names, some_names
from grader.static_python.operators import operate
from grader.static_python.values import Bound, Function, Named, Scope, Spot, Unknown, Value, at

if TYPE_CHECKING:
    from grader.static_python.machine import Machine


def follow_statement(machine: "Machine", node: ast.stmt, scope: Scope) -> None:
    """Follow one statement."""
    match node:
        case ast.Import() | ast.ImportFrom():
            _import(machine, node, scope)
        case ast.Assign(targets=targets, value=value):
            result = evaluate(machine, value, scope)
            for target in targets:
                assign(machine, target, result, scope)
        case ast.AnnAssign(target=target, value=expression) if expression is not None:
            assign(machine, target, evaluate(machine, expression, scope), scope)
        case ast.AugAssign():
            _augment(machine, node, scope)
        case ast.Expr(value=value):
            evaluate(machine, value, scope)
        case ast.FunctionDef() | ast.AsyncFunctionDef():
            function = machine.function(node, scope)
            decorated = Unknown("a function with a decorator is not followed", at(node))
            scope.bind(node.name, decorated if node.decorator_list else function)
        case ast.ClassDef():
            scope.bind(node.name, Unknown("a class is not followed", at(node)))
        case ast.Return(value=value):
            raise Return(evaluate(machine, value, scope) if value is not None else None)
        case ast.If():
            _if(machine, node, scope)
        case ast.For() | ast.AsyncFor():
            _for(machine, node, scope)
        case ast.While():
            _while(machine, node, scope)
        case ast.Match():
            _match(machine, node, scope)
        case ast.With() | ast.AsyncWith():
            for item in node.items:
                value = evaluate(machine, item.context_expr, scope)
                if item.optional_vars is not None:
                    assign(machine, item.optional_vars, value, scope)
            machine.block(node.body, scope)
        case ast.Try() | ast.TryStar():
            _try(machine, node, scope)
        case ast.Break() | ast.Continue():
            raise Leave(for_good=isinstance(node, ast.Break))
        case ast.Delete(targets=targets):
            for target in targets:
                _delete(machine, target, scope)
        case ast.Global(names=names):
            scope.declared |= dict.fromkeys(names, machine.module)
        case ast.Nonlocal(names=names):
            scope.declared |= {name: scope.holder(name) for name in names}
        case ast.Raise():
            _raise(machine, node, scope)
        case ast.Assert(test=test):
            if truth(evaluate(machine, test, scope)) is False:
                machine.fault("this assertion does not hold", at(node), AssertionError)


def _delete(machine: "Machine", target: ast.expr, scope: Scope) -> None:
    if isinstance(target, ast.Subscript):
        container = evaluate(machine, target.value, scope)
        index = evaluate(machine, target.slice, scope)
        remove(machine, container, index, machine.unsure or Unknown("what is deleted here is not followed", at(target)))
    elif isinstance(target, ast.Name) and machine.unsure is None:
        scope.declared.get(target.id, scope).names.pop(target.id, None)
    elif isinstance(target, ast.Name):
        scope.bind(target.id, machine.unsure)


def _raise(machine: "Machine", node: ast.Raise, scope: Scope) -> None:
    raised = node.exc.func if isinstance(node.exc, ast.Call) else node.exc
    name = raised.id if isinstance(raised, ast.Name) else "an error"
    if node.exc is not None:
        evaluate(machine, node.exc, scope)
    machine.may_fail()
    kind = getattr(builtins, name, Exception)
    if machine.unsure is None:
        machine.fault(f"the file raises {name} here", at(node), kind if isinstance(kind, type) else Exception)
        raise Left


def assign(machine: "Machine", target: ast.expr, value: Value, scope: Scope) -> None:
    """Give a name, or the names in a pattern, a value; what cannot be followed makes the name unknown."""
    if machine.unsure is not None:
        value = _doubtful(value, machine.unsure)
    match target:
        case ast.Name(id=name):
            scope.bind(name, value)
        case ast.Tuple(elts=parts) | ast.List(elts=parts):
            values = list(value[: len(parts) + 1]) if isinstance(value, list | tuple) else []
            if len(values) != len(parts) or any(isinstance(each, ast.Starred) for each in parts):
                values = [Unknown("it is unpacked in a way that is not followed", at(target))] * len(parts)
            for part, each in zip(parts, values, strict=True):
                assign(machine, part.value if isinstance(part, ast.Starred) else part, each, scope)
        case ast.Subscript(value=owner, slice=key):
            container = evaluate(machine, owner, scope)
            index = evaluate(machine, key, scope)
            store(machine, container, index, value, at(target))
        case ast.Attribute(value=owner):
            evaluate(machine, owner, scope)


def _import(machine: "Machine", node: ast.Import | ast.ImportFrom, scope: Scope) -> None:
    module = "" if isinstance(node, ast.Import) else "." * node.level + (node.module or "")
    for alias in node.names:
        if not is_at_hand(module or alias.name):
            machine.may_fail()
        fault = import_fault(module, alias.name)
        if fault:
            machine.fault(fault, at(node), ImportError)
        full = f"{module}.{alias.name}" if module else alias.name
        if alias.name == "*" and public_names(module) is not None:
            for name in public_names(module) or ():
                scope.bind(name, Named(f"{module}.{name}"))
        elif alias.name == "*":
            scope.bind("*", Named(full))
            for name in some_names(module):
                scope.bind(name, Named(f"{module}.{name}"))
        elif alias.asname:
            scope.bind(alias.asname, Named(full))
        elif module:
            scope.bind(alias.name, Named(full))
        else:
            scope.bind(alias.name.split(".")[0], Named(alias.name.split(".")[0]))


def _augment(machine: "Machine", node: ast.AugAssign, scope: Scope) -> None:
    load = ast.copy_location(_as_load(node.target), node)
    before = evaluate(machine, load, scope)
    value = evaluate(machine, node.value, scope)
    if isinstance(node.op, ast.Add) and isinstance(before, list):
        extend(machine, before, value, at(node))
        return
    assign(machine, node.target, operate(machine, node.op, before, value, at(node)), scope)


def _if(machine: "Machine", node: ast.If, scope: Scope) -> None:
    condition = truth(evaluate(machine, node.test, scope))
    if condition is None:
        _maybe(machine, [node.body, node.orelse], scope, at(node))
    else:
        machine.block(node.body if condition else node.orelse, scope)


def _for(machine: "Machine", node: ast.For | ast.AsyncFor, scope: Scope) -> None:
    items = items_of(evaluate(machine, node.iter, scope))
    if items is None:
        before = machine.unsure
        for body in (node.body, node.body, node.orelse):  # twice: the first round may change what the second does
            with machine.doubt("it happens in a loop over something that only a run would tell", at(node)):
                assign(machine, node.target, None, scope)
                machine.block(body, scope)
        machine.unsure = before
        return
    before = machine.unsure
    for item in items:
        machine.step()
        assign(machine, node.target, item, scope)
        try:
            machine.block(node.body, scope)
        except Leave as leave:
            if leave.for_good:
                break
    else:
        machine.block(node.orelse, scope)
    machine.unsure = before


def _while(machine: "Machine", node: ast.While, scope: Scope) -> None:
    before = machine.unsure
    if truth(evaluate(machine, node.test, scope)) is False:
        machine.block(node.orelse, scope)
        return
    # Twice: the first round may change what the second does.
    _maybe(machine, [node.body, node.body, node.orelse], scope, at(node))
    machine.unsure = before


def _match(machine: "Machine", node: ast.Match, scope: Scope) -> None:
    evaluate(machine, node.subject, scope)
    for each in ast.walk(node):
        name = each.name if isinstance(each, ast.MatchAs | ast.MatchStar) else None
        if name is not None:
            scope.bind(name, Unknown("a pattern is not followed", at(node)))
    _maybe(machine, [case.body for case in node.cases], scope, at(node))


def _maybe(machine: "Machine", bodies: list[list[ast.stmt]], scope: Scope, spot: Spot) -> None:
    """Follow every branch of what only a run would decide."""
    for body in bodies:
        with machine.doubt("it depends on something that only a run would tell", spot):
            machine.block(body, scope)


def _try(machine: "Machine", node: "ast.Try | ast.TryStar", scope: Scope) -> None:
    if not node.handlers:
        for body in (node.body, node.finalbody):
            machine.block(body, scope)
        return
    before = machine.unsure
    raised, may_have_failed = machine.guarded(node.body, scope)
    machine.unsure = before
    if raised is not None:
        _handle(machine, node, raised, scope)
    elif may_have_failed:
        for body in (node.orelse, *(handler.body for handler in node.handlers)):
            with machine.doubt("it depends on whether there was an error", at(node)):
                machine.block(body, scope)
    else:
        machine.block(node.orelse, scope)
    machine.block(node.finalbody, scope)


def _handle(machine: "Machine", node: "ast.Try | ast.TryStar", raised: Raised, scope: Scope) -> None:
    """Follow the first handler that catches an error; raise it further where none does."""
    for handler in node.handlers:
        catches = _catches(handler.type, raised.kind)
        if catches is False:
            continue
        if handler.name is not None:
            scope.bind(handler.name, Unknown("the error is told only by a run", at(handler)))
        if catches:
            machine.block(handler.body, scope)
            return
        with machine.doubt("it depends on which error there was", at(handler)):
            machine.block(handler.body, scope)
    machine.fault(raised.fault.message, raised.fault.at, raised.kind)


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
