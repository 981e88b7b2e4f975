"""The value of a Python expression, as far as it can be told without running anything."""

import ast
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any

from grader.static_python import methods
from grader.static_python.calls import attribute, call
from grader.static_python.containers import MOST_ITEMS, MOST_TEXT, distinct, extend, is_known, items_of, truth
from grader.static_python.operators import compare, operate
from grader.static_python.values import Choice, Made, Named, Scope, Spot, Unknown, Value, at, size

if TYPE_CHECKING:
    from grader.static_python.machine import Machine


def evaluate(machine: "Machine", node: ast.expr, scope: Scope) -> Value:
    """The value of an expression; Unknown, with the reason, where it cannot be told."""
    machine.step()
    value = _evaluate(machine, node, scope)
    if isinstance(value, str | list | tuple | dict) and not isinstance(node, ast.Name | ast.Subscript | ast.Constant):
        machine.step(len(value) // 64)  # a large value takes its time to make
    return value


def _evaluate(machine: "Machine", node: ast.expr, scope: Scope) -> Value:
    match node:
        case ast.Constant(value=value):
            return value
        case ast.Name():
            return machine.find(node, scope)
        case ast.Attribute(value=owner, attr=name):
            return attribute(machine, evaluate(machine, owner, scope), name, at(node))
        case ast.Call():
            return _call(machine, node, scope)
        case ast.List(elts=parts):
            return _parts(machine, parts, scope)
        case ast.Tuple(elts=parts):
            return tuple(_parts(machine, parts, scope))
        case ast.Set(elts=parts):
            return distinct(_parts(machine, parts, scope))
        case ast.Dict():
            return _dict(machine, node, scope)
        case ast.JoinedStr(values=pieces):
            return _joined(machine, pieces, scope, at(node))
        case ast.BinOp(left=left, op=op, right=right):
            return operate(machine, op, evaluate(machine, left, scope), evaluate(machine, right, scope), at(node))
        case ast.BoolOp():
            return _bool(machine, node, scope)
        case ast.UnaryOp(op=ast.Not(), operand=operand):
            known = truth(evaluate(machine, operand, scope))
            return Unknown("it is told only by a run", at(node)) if known is None else not known
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            number = evaluate(machine, operand, scope)
            return -number if isinstance(number, int | float) else Unknown("this is no number", at(node))
        case ast.Compare():
            values = [evaluate(machine, each, scope) for each in (node.left, *node.comparators)]
            if len(values) != 2:
                return Unknown("it is told only by a run", at(node))
            return compare(machine, node.ops[0], values[0], values[1], at(node))
        case ast.IfExp(test=test, body=body, orelse=other):
            known = truth(evaluate(machine, test, scope))
            if known is None:
                return Unknown("it depends on something that only a run would tell", at(node))
            return evaluate(machine, body if known else other, scope)
        case ast.Subscript(value=owner, slice=key):
            return _item(machine, evaluate(machine, owner, scope), key, scope, at(node))
        case ast.ListComp() | ast.GeneratorExp() | ast.SetComp() | ast.DictComp():
            return _comprehension(machine, node, scope)
        case ast.NamedExpr(target=target, value=value):
            result = evaluate(machine, value, scope)
            while scope.is_loop and scope.outer is not None:
                scope = scope.outer
            machine.assign(target, result, scope)
            return result
        case ast.Lambda():
            return machine.function(node, scope)
        case ast.Starred(value=value) | ast.Await(value=value):
            return evaluate(machine, value, scope)
        case _:
            return Unknown("an expression of this kind is not followed", at(node))


def _parts(machine: "Machine", parts: list[ast.expr], scope: Scope) -> list[Value]:
    values: list[Value] = []
    for part in parts:
        value = evaluate(machine, part, scope)
        if isinstance(part, ast.Starred):
            extend(machine, values, value, at(part))
        else:
            values.append(value)
    return values


def _dict(machine: "Machine", node: ast.Dict, scope: Scope) -> Value:
    made: dict[Any, Value] = {}
    for key_node, value_node in zip(node.keys, node.values, strict=True):
        value = evaluate(machine, value_node, scope)
        if key_node is None:
            if not isinstance(value, dict):
                return Unknown("a dict is made from something that is not followed", at(value_node))
            made |= value
            continue
        key = evaluate(machine, key_node, scope)
        if isinstance(key, str | int | float | PurePosixPath | None) and key != "**":
            made[key] = value
        else:
            return key if isinstance(key, Unknown) else Unknown("a key of a dict is not followed", at(key_node))
    return made


def _joined(machine: "Machine", pieces: list[ast.expr], scope: Scope, spot: Spot) -> Value:
    text = ""
    for piece in pieces:
        if isinstance(piece, ast.Constant):
            text += str(piece.value)
            continue
        if not isinstance(piece, ast.FormattedValue):
            return Unknown("an expression of this kind is not followed", spot)
        value = evaluate(machine, piece.value, scope)
        if isinstance(value, Unknown):
            return value
        plain = methods.as_text(value)
        if plain is None or piece.format_spec is not None or piece.conversion not in (-1, ord("s")):
            return Unknown("a formatted text of this kind is not followed", spot)
        text += plain
        if len(text) > MOST_TEXT:
            return Unknown("it grows too long", spot)
    return text


def _bool(machine: "Machine", node: ast.BoolOp, scope: Scope) -> Value:
    value: Value = None
    for part in node.values:
        value = evaluate(machine, part, scope)
        known = truth(value)
        if known is None:
            return Unknown("it is told only by a run", at(node))
        if known != isinstance(node.op, ast.And):
            return value
    return value


def _item(machine: "Machine", owner: Value, key: ast.expr, scope: Scope, spot: Spot) -> Value:
    if isinstance(owner, Unknown):
        return owner
    if isinstance(key, ast.Slice):
        bounds = [evaluate(machine, each, scope) if each else None for each in (key.lower, key.upper, key.step)]
        whole = isinstance(owner, str) or (isinstance(owner, list | tuple) and is_known(machine, owner))
        if whole and all(each is None or type(each) is int for each in bounds):
            machine.step(len(owner) // 32)
            return owner[slice(*bounds)] if bounds[2] != 0 else Unknown("a slice with step 0", spot)
        return Unknown("a slice of this is not followed", spot)
    index = evaluate(machine, key, scope)
    machine.may_fail()
    if isinstance(owner, Named):
        return Made(f"{owner.name}[]", [index], {}, spot)
    if isinstance(owner, list | tuple) and not is_known(machine, owner):
        return Unknown("what stands at this place is told only by a run", spot)
    try:
        if isinstance(owner, str | list | tuple | dict) and isinstance(index, str | int):
            return owner[index]  # type: ignore[index]
    except (LookupError, TypeError):
        pass
    return Unknown("what stands at this place is told only by a run", spot)


def _comprehension(
    machine: "Machine", node: "ast.ListComp | ast.GeneratorExp | ast.SetComp | ast.DictComp", scope: Scope
) -> Value:
    inner = Scope({}, scope, is_loop=True)
    values: list[Value] = []
    table: dict[Any, Value] = {}

    def go(index: int) -> bool:
        """Follow the loops from this one inward; False where it cannot be told what they go through."""
        if index == len(node.generators):
            if isinstance(node, ast.DictComp):
                key = evaluate(machine, node.key, inner)
                value = evaluate(machine, node.value, inner)
                if not isinstance(key, str | int):
                    return False
                table[key] = value
            else:
                values.append(evaluate(machine, node.elt, inner))
            return len(values) <= MOST_ITEMS
        generator = node.generators[index]
        items = items_of(evaluate(machine, generator.iter, inner))
        if items is None:
            return False
        for item in items:
            if isinstance(item, Unknown):
                if isinstance(node, ast.DictComp):
                    return False
                values.append(item)
                continue
            machine.assign(generator.target, item, inner)
            checks = [truth(evaluate(machine, each, inner)) for each in generator.ifs]
            if None in checks:
                return False
            if all(checks) and not go(index + 1):
                return False
        return True

    if not go(0):
        return Unknown("a comprehension over something that only a run would tell", at(node))
    if isinstance(node, ast.SetComp):
        return distinct(values)
    return table if isinstance(node, ast.DictComp) else values


def _call(machine: "Machine", node: ast.Call, scope: Scope) -> Value:
    function = evaluate(machine, node.func, scope)
    args = _parts(machine, node.args, scope)
    given = _keywords(machine, node, scope)
    kwargs, spot = dict(given.known), at(node)
    if not given.complete:
        kwargs["**"] = Unknown("arguments are unpacked that are not followed", spot)
    machine.step(size([args, list(kwargs.values())]) // 32)
    is_unpacked = any(isinstance(each, ast.Starred) for each in node.args)
    return call(machine, function, args, kwargs, spot, is_unpacked=is_unpacked)


def _keywords(machine: "Machine", node: ast.Call, scope: Scope) -> Choice:
    known: dict[str, Value] = {}
    complete = True
    for keyword in node.keywords:
        value = evaluate(machine, keyword.value, scope)
        if keyword.arg is not None:
            known[keyword.arg] = value
        elif isinstance(value, dict):
            known |= {key: each for key, each in value.items() if isinstance(key, str)}
        else:
            complete = False
    return Choice(known, complete)
