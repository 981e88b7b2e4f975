"""The value of a Python expression, as far as it can be told without running anything."""

import ast
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any

from grader.submission.python import methods
from grader.submission.python.names import attribute_fault
from grader.submission.python.values import (
    Bound,
    Choice,
    Function,
    Made,
    Named,
    Scope,
    Spot,
    Steering,
    TooHard,
    Unknown,
    Value,
    at,
    size,
    unknown_in,
)

if TYPE_CHECKING:
    from grader.submission.python.machine import Machine

_KINDS = {
    str: "a text",
    list: "a list",
    tuple: "a tuple",
    dict: "a dict",
    type(None): "None",
    PurePosixPath: "a path",
}
_LEAVES = ("sys.exit", "os._exit", "builtins.exit", "builtins.quit")
_NAMING = ("builtins.exec", "builtins.globals", "builtins.locals", "builtins.vars")
MOST_ITEMS = 20_000
MOST_TEXT = 100_000


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
            return _attribute(machine, evaluate(machine, owner, scope), name, at(node))
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
            return _compare(machine, node, scope)
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


def operate(machine: "Machine", op: ast.operator, left: Value, right: Value, spot: Spot) -> Value:
    """The value of a sum, of a path with / or of a text with %; a list keeps what is known of it."""
    machine.step(sum(len(value) for value in (left, right) if isinstance(value, str)) // 32)
    match op, left, right:
        case ast.Add(), str(), str():
            return left + right if len(left) + len(right) <= MOST_TEXT else Unknown("it grows too long", spot)
        case ast.Add(), int() | float(), int() | float():
            try:
                return left + right
            except OverflowError:
                return Unknown("the number is too large", spot)
        case ast.Add(), tuple(), tuple():
            return (*left, *right) if len(left) + len(right) <= MOST_ITEMS else Unknown("it grows too long", spot)
        case ast.Add(), list(), list() | Unknown() | Made():
            joined = list(left)
            extend(machine, joined, right, spot)
            return joined
        case ast.Add(), _, list() if isinstance(left, Unknown | Made):
            return [left if isinstance(left, Unknown) else Unknown("what is added here is not followed", spot), *right]
        case (
            ast.Add(),
            str() | list() | tuple() | dict() | None | PurePosixPath(),
            str() | list() | tuple() | dict() | None | PurePosixPath(),
        ):
            machine.fault(f"Python cannot add {_KINDS[type(right)]} to {_KINDS[type(left)]}", spot)
        case ast.Div(), (str() | PurePosixPath()), (str() | PurePosixPath()) if not (
            isinstance(left, str) and isinstance(right, str)
        ):
            return methods.path_of([left, right], spot)
        case ast.Div(), Made(), _:
            return Made("truediv", [left, right], {}, spot)
        case ast.Mod(), str(), _ if not isinstance(right, Unknown):
            return methods.percent(left, right, spot)
        case ast.BitOr(), dict(), dict():
            return left | right
    for value in (left, right):
        if isinstance(value, Unknown):
            return value
    return Unknown("an operation of this kind is not followed", spot)


def extend(machine: "Machine", target: list[Value], value: Value, spot: Spot) -> None:
    """Add what a list is extended by; an unknown part of it stays in its place."""
    items = items_of(value)
    machine.step(len(items or ()) // 64)
    if items is None:
        target.append(value if isinstance(value, Unknown) else Unknown("what is added here is not followed", spot))
    elif machine.unsure is not None:
        target += [machine.unsure] * bool(items)
    elif isinstance(target, Steering):
        lose(target, Unknown("it is steered", spot))
    elif len(target) + len(items) > MOST_ITEMS:
        target.append(Unknown("it grows too long", spot))
    else:
        target += items


def items_of(value: Value) -> list[Value] | None:
    """What a loop over a value goes through; None where that cannot be told."""
    if isinstance(value, list | tuple | dict):
        return list(value)
    if isinstance(value, str):
        return list(value) if len(value) < MOST_ITEMS else None
    return None


def truth(value: Value) -> bool | None:
    """Whether a condition holds; None where only a run would tell."""
    if value is None or isinstance(value, str | int | float | list | tuple | dict):
        if isinstance(value, list | tuple) and value and all(isinstance(each, Unknown) for each in value):
            return None
        if isinstance(value, dict) and "**" in value:
            return None
        return bool(value)
    return True if isinstance(value, PurePosixPath | Function) else None


def is_known(machine: "Machine", items: "list[Value] | tuple[Value, ...]") -> bool:
    """Whether it can be told at which place of a list its items stand."""
    machine.step(len(items) // 64)
    return not any(isinstance(each, Unknown) for each in items)


def store(machine: "Machine", container: Value, key: Value, value: Value, spot: Spot) -> None:
    """Put a value into a dict or list; where it cannot be told which place is meant, nothing of it is known any more."""
    if isinstance(container, dict) and isinstance(key, str | int) and len(container) < MOST_ITEMS:
        container[key] = value
    elif isinstance(container, list) and isinstance(key, int) and is_known(machine, container):
        if -len(container) <= key < len(container):
            container[key] = value
    else:
        lose(container, Unknown("what is put here is not followed", spot))


def remove(machine: "Machine", container: Value, key: Value, unknown: Unknown) -> None:
    """Take something out of a dict or list; `unknown` says why, where it cannot be told what."""
    is_place = isinstance(container, list) and isinstance(key, int) and -len(container) <= key < len(container)
    is_key = isinstance(container, dict) and isinstance(key, str | int) and key in container and "**" not in container
    if (
        machine.unsure is None
        and not isinstance(container, Steering)
        and (is_key or (is_place and is_known(machine, container)))
    ):
        del container[key]
    else:
        lose(container, unknown)


def lose(container: Value, unknown: Unknown) -> None:
    """Forget what is in a list or dict, which is changed in a way that is not followed."""
    if isinstance(container, Steering):
        raise TooHard("a walk through folders that is steered on its way is not followed")
    if isinstance(container, list):
        container[:] = [unknown]
    elif isinstance(container, dict):
        for key in container:
            container[key] = unknown
        container["**"] = unknown


def distinct(values: list[Value]) -> list[Value]:
    """The values of a set: each once."""
    plain = all(isinstance(each, str | int | float | PurePosixPath | None) for each in values)
    return list(dict.fromkeys(values)) if plain else values


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


def _compare(machine: "Machine", node: ast.Compare, scope: Scope) -> Value:
    left = evaluate(machine, node.left, scope)
    rights = [evaluate(machine, each, scope) for each in node.comparators]
    unknown = Unknown("it is told only by a run", at(node))
    cost = size([left, *rights])
    machine.step(cost // 64)
    if len(rights) != 1 or cost >= MOST_ITEMS or not _is_plain(left) or not _is_plain(rights[0]):
        return unknown
    right = rights[0]
    if isinstance(right, dict) and not isinstance(left, str | int | float | PurePosixPath | None):
        return unknown
    match node.ops[0]:
        case ast.Eq():
            return left == right
        case ast.NotEq():
            return left != right
        case ast.Is():
            return left is right if right is None or left is None else unknown
        case ast.IsNot():
            return left is not right if right is None or left is None else unknown
        case ast.In() if isinstance(right, list | tuple | dict) or (isinstance(left, str) and isinstance(right, str)):
            return left in right
        case ast.NotIn() if isinstance(right, list | tuple | dict) or (
            isinstance(left, str) and isinstance(right, str)
        ):
            return left not in right
        case ast.Lt() | ast.LtE() | ast.Gt() | ast.GtE() if isinstance(left, int) and isinstance(right, int):
            less, equal = left < right, left == right
            match node.ops[0]:
                case ast.Lt():
                    return less
                case ast.LtE():
                    return less or equal
                case ast.Gt():
                    return not less and not equal
                case _:
                    return not less
        case _:
            return unknown


def _is_plain(value: Value) -> bool:
    if isinstance(value, list | tuple | dict):
        return all(map(_is_plain, value.values() if isinstance(value, dict) else value))
    if isinstance(value, str | PurePosixPath) and methods.names_the_folder(str(value)):
        return False
    return value is None or isinstance(value, str | int | float | PurePosixPath)


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


def _attribute(machine: "Machine", owner: Value, name: str, spot: Spot) -> Value:
    match owner:
        case Unknown():
            return owner
        case Named(name="?glob"):
            return Named(f"glob.{name}")
        case Named(name="glob.glob") if name in ("glob", "iglob"):
            machine.fault(
                f"glob is a function here, so glob.{name} is not defined: write glob(...)", spot, AttributeError
            )
            return Named("glob.glob")
        case Named(name=full):
            known = machine.library.get(f"{full}.{name}")
            fault = attribute_fault(full, name) if known is None else None
            if fault is not None:
                machine.fault(fault, spot, AttributeError)
            constant = _CONSTANTS.get(f"{full}.{name}")
            return constant if known is None and constant is not None else Named(f"{full}.{name}")
        case PurePosixPath():
            return methods.path_attribute(owner, name)
        case _:
            return Bound(owner, name)


_CONSTANTS = {
    "os.sep": "/",
    "os.path.sep": "/",
    "os.linesep": "\n",
    "os.curdir": ".",
    "os.pardir": "..",
    "os.name": "posix",
}


def _call(machine: "Machine", node: ast.Call, scope: Scope) -> Value:
    function = evaluate(machine, node.func, scope)
    args = _parts(machine, node.args, scope)
    given = _keywords(machine, node, scope)
    kwargs, spot = dict(given.known), at(node)
    if not given.complete:
        kwargs["**"] = Unknown("arguments are unpacked that are not followed", spot)
    machine.step(size([args, list(kwargs.values())]) // 32)
    match function:
        case Unknown():
            machine.may_fail()
            return function
        case Function() if any(isinstance(each, ast.Starred) for each in node.args) and unknown_in(args) is not None:
            return Unknown("arguments are unpacked that are not followed", spot)
        case str() | int() | float() | list() | tuple() | dict() | None | PurePosixPath():
            machine.fault(
                f"{_KINDS.get(type(function), 'a number')} cannot be called: is there a comma missing before it?", spot
            )
            return Unknown("what is called here is not followed", spot)
        case Function():
            return machine.call_function(function, args, kwargs, spot)
        case Named(name="glob" | "?glob" as name):
            if name == "glob":
                machine.fault("glob is a module here, which cannot be called: write glob.glob(...)", spot)
            return _named(machine, "glob.glob", args, kwargs, spot)
        case Named(name=name):
            return _named(machine, name, args, kwargs, spot)
        case Bound(owner=Made() as owner, name=name) if f"{owner.name}.{name}" in machine.library:
            return machine.library[f"{owner.name}.{name}"](machine, args, kwargs, spot)
        case Bound(owner=Made() as owner, name=name):
            made = Made(f"{owner.name}.{name}", args, kwargs, spot, owner)
            owner.calls.append(made)
            return _make(machine, made)
        case Bound(owner=owner, name=name):
            return methods.call(machine, owner, name, args, kwargs, spot)
        case _:
            return Unknown("what is called here is not followed", spot)


def _named(machine: "Machine", name: str, args: list[Value], kwargs: dict[str, Value], spot: Spot) -> Value:
    known = machine.library.get(name)
    return known(machine, args, kwargs, spot) if known is not None else _make(machine, Made(name, args, kwargs, spot))


def _make(machine: "Machine", made: Made) -> Value:
    if made.name in _LEAVES:
        machine.leave(made)
    if made.name in _NAMING:
        machine.module.names["*"] = Unknown("names may be set here", made.at)
    if not made.name.startswith("builtins.open"):
        machine.may_fail()
    if len(machine.made) < MOST_ITEMS:
        machine.made.append(made)
    if machine.unsure is not None:
        made.kwargs.setdefault("?", machine.unsure)
    return made


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
