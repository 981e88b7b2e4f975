"""The slips in a node written in Python for which it certainly stops, or does nothing.

Only what the program certainly runs counts: the body of its file, the function that starts it, the
constructors of its nodes and their callbacks, without what is under a condition or caught. A slip
is assumed for the grade; `code_faults` lists what is wrong in any code of a module.
"""

import ast
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Sequence
from typing import NamedTuple

from grader.base.names import near
from grader.base.slips import Slip
from grader.base.source import Edit
from grader.ros.known.package_tables import python_table
from grader.ros.known.python_names import python_names
from grader.ros.known.releases import RELEASES, Release
from grader.ros.nodes.message_uses import given_argument
from grader.ros.nodes.python.branches import INTERRUPTS, calls_in_branches
from grader.ros.nodes.python.called_functions import (
    CalledFunctions,
    imported_names,
    made_in,
    methods_of,
)
from grader.ros.nodes.python.rclpy_names import CALLBACKS, NODE_CLASSES, is_passive
from grader.ros.python.constants import binds_unseen, dotted, last_name
from grader.ros.python.parse import Code, Position, location_in, position_of
from grader.ros.python.walking import children, walk

_MAX_NAMES = 20  # that are not defined
# Modules that students forget to import, and names in modules.
_MODULES = ("rclpy", "math", "time", "os", "sys", "random")
_IMPORTED = {"Node": "rclpy.node"}
_WAITING = frozenset({"threading", "asyncio", "time", "signal", "multiprocessing"})


class Program(NamedTuple):
    """A program of a module: its name, and the function that it calls.

    A script calls none, and runs its body as __main__.
    """

    name: str
    function: str


class _Function(NamedTuple):
    """A function that certainly runs, with the node's class that it is a method of."""

    node: ast.FunctionDef
    owner: ast.ClassDef | None = None
    message: str = ""  # the full name of the message that it is called with


def node_slips(code: Code, program: Program, releases: Sequence[Release] = ()) -> list[Slip]:
    """Return the slips of a program in its file, in the order of the lines.

    Calls are those of the given releases, or of any that are known.
    """
    nodes = walk(code.tree)
    if binds_unseen(nodes):
        return []
    slips = [*_NodeSlips(code, nodes, program, releases or RELEASES).found()]
    return sorted(slips, key=lambda slip: (slip.location.line, slip.location.column))


class _NodeSlips:
    """The search for the slips of one program."""

    def __init__(
        self,
        code: Code,
        nodes: Sequence[ast.AST],
        program: Program,
        releases: Sequence[Release],
    ) -> None:
        self._code, self._nodes, self._program = code, nodes, program
        self._imports = imported_names(nodes)
        self._has_star = False
        self._names_left = _MAX_NAMES
        self._bound: set[str] = set()
        for node in nodes:
            self._bind(node)
        self._known = {*self._bound, *self._imports}
        self._global = {"__file__", *python_names("builtins", tuple(releases))}
        self._functions = {
            node.name: node for node in code.tree.body if isinstance(node, ast.FunctionDef)
        }
        self._classes: dict[str, ast.ClassDef] = {}  # of nodes
        for node in code.tree.body:
            if not isinstance(node, ast.ClassDef) or len(node.bases) != 1:
                continue
            if self._full_name(node.bases[0]) in NODE_CLASSES:
                self._classes[node.name] = node
        self._calls = CalledFunctions(code, nodes, self._imports, releases)

    def _bind(self, node: ast.AST) -> None:
        match node:
            case ast.Name(id=name, ctx=ast.Store() | ast.Del()) | ast.arg(arg=name):
                self._bound.add(name)
            case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
                self._bound.add(name)
            case ast.ExceptHandler(name=str(name)) | ast.MatchAs(name=str(name)):
                self._bound.add(name)
            case ast.ImportFrom(names=names):
                self._has_star |= names[0].name == "*"

    def _full_name(self, node: ast.expr) -> str:
        first, dot, rest = dotted(node).partition(".")
        return f"{self._imports.get(first, first)}{dot}{rest}"

    def found(self) -> Iterator[Slip]:
        """Yield the slips."""
        body = [*_until_spin(self._running(self._code.tree.body))]
        calls = [call for statement in body for call in _calls(statement)]
        is_script = not self._program.function
        if is_script and not calls and "main" in self._functions:
            yield from self._of_main_that_is_not_called()
            return
        pending = [_Function(self._functions[name]) for name in self._called(calls)]
        if self._program.function in self._functions:
            pending.append(_Function(self._functions[self._program.function]))
        yield from self._undefined(body)
        for node in self._code.tree.body:
            if isinstance(node, ast.ClassDef):
                yield from self._undefined(node.bases)
        yield from self._of_functions(pending)

    def _of_functions(self, pending: list[_Function]) -> Iterator[Slip]:
        """Yield the slips of functions, and of those that they run."""
        seen: set[ast.FunctionDef] = set()
        made: list[tuple[_Function, ast.stmt, str]] = []
        while pending:
            function = pending.pop(0)
            if function.node in seen:
                continue
            seen.add(function.node)
            statements = [*_until_spin(self._running(function.node.body))]
            yield from self._undefined(statements)
            yield from self._wrong_fields(function, statements)
            yield from self._wrong_calls(function, statements)
            pending += self._constructors(statements)
            if function.owner is not None:
                if function.node.name == "__init__":
                    yield from self._without_init_of_node(function.owner)
                yield from self._undefined_attributes(function.owner, statements)
                yield from self._called_callbacks(function.owner, statements)
                pending += self._methods(function.owner, statements)
            for statement in statements:
                calls = [*_calls(statement)]
                pending += [_Function(self._functions[name]) for name in self._called(calls)]
                for name in {dotted(call.func) for call in calls} & self._classes.keys():
                    made.append((function, statement, name))
        yield from self._without_rclpy(made)

    def _called(self, calls: Iterable[ast.Call]) -> Iterator[str]:
        """Yield the functions of the module that are called."""
        for call in calls:
            if isinstance(call.func, ast.Name) and call.func.id in self._functions:
                yield call.func.id

    def _running(self, statements: Sequence[ast.stmt]) -> Iterator[ast.stmt]:
        """Yield the statements that certainly run, up to the first that may end the function."""
        for statement in statements:
            blocks = self._running_blocks(statement)
            if blocks is None:
                yield statement
            for block in blocks or ():
                yield from self._running(block)
            if isinstance(statement, ast.Return | ast.Raise | ast.If) and any(
                isinstance(part, ast.Return | ast.Raise) for part in walk(statement)
            ):
                return

    def _running_blocks(self, statement: ast.stmt) -> list[list[ast.stmt]] | None:
        """Return the blocks of a statement that certainly run; None if it has no blocks."""
        match statement:
            case ast.If(test=test, body=body):
                is_run = not self._program.function and _name(test) == "__main__"
                return [body] if is_run else []
            case ast.Try(body=body, handlers=handlers, finalbody=final):
                names = {dotted(kind).rpartition(".")[2] for kind in _types(handlers)}
                return [body, final] if names <= INTERRUPTS else [final]
            case ast.With(items=items, body=body):
                is_caught = any("suppress" in dotted(_function_of(context)) for context in items)
                return [] if is_caught else [body]
            case ast.While(test=test, body=body):
                return [body] if _runs_on(test) else []
        return [] if hasattr(statement, "body") or isinstance(statement, ast.Match) else None

    def _constructors(self, statements: Sequence[ast.stmt]) -> Iterator[_Function]:
        """Yield the constructors of the nodes that statements make."""
        for statement in statements:
            for call in _calls(statement):
                owner = self._classes.get(dotted(call.func))
                for method in owner.body if owner is not None else ():
                    if isinstance(method, ast.FunctionDef) and method.name == "__init__":
                        yield _Function(method, owner)

    def _methods(self, owner: ast.ClassDef, statements: Sequence[ast.stmt]) -> Iterator[_Function]:
        """Yield the methods that statements of a method call, or let be called."""
        methods = methods_of(owner)
        for statement in statements:
            for call in _calls(statement):
                name = dotted(call.func)
                if name.startswith("self.") and name[5:] in methods:
                    yield _Function(methods[name[5:]], owner)
                callback = _callback(call)
                if callback is not None and dotted(callback)[5:] in methods:
                    message = ""
                    if name.endswith("create_subscription") and call.args:
                        message = self._full_name(call.args[0])
                    yield _Function(methods[dotted(callback)[5:]], owner, message)

    def _undefined(self, statements: Sequence[ast.AST]) -> Iterator[Slip]:
        """Yield the names that are not defined, where it is sure what is meant."""
        if self._has_star:
            return
        for statement in statements:
            for node in _certain_parts(statement):
                if not isinstance(node, ast.Name) or not isinstance(node.ctx, ast.Load):
                    continue
                if node.id in self._known or node.id in self._global or self._names_left == 0:
                    continue
                self._known.add(node.id)
                self._names_left -= 1
                yield from self._undefined_name(node)

    def _undefined_name(self, node: ast.Name) -> Iterator[Slip]:
        """Yield that a name is not defined, if it is sure what is meant."""
        name = node.id
        reaction = f"the name {name} is not defined"
        module = _IMPORTED.get(name) or _package_of_message(name)
        meant = near(name, self._bound | self._imports.keys())
        if name in _MODULES:
            yield from self._with_import(node, f"import {name}", reaction)
        elif module is not None:
            yield from self._with_import(node, f"from {module} import {name}", reaction)
        elif meant is not None:
            yield self._replaced(node, name, meant, reaction)

    def _with_import(self, node: ast.Name, code: str, reaction: str) -> Iterator[Slip]:
        for first in self._code.tree.body:
            is_import = isinstance(first, ast.Import | ast.ImportFrom)
            if is_import and getattr(first, "module", "") != "__future__":
                assumption = f"`{code}` is added"
                yield self._inserted(first, f"{code}; ", node, reaction, assumption)
                return

    def _wrong_fields(self, function: _Function, statements: Sequence[ast.stmt]) -> Iterator[Slip]:
        """Yield the fields that a message does not have."""
        types = self._types_bound_once(function, statements)
        for statement in statements:
            for node in _certain_parts(statement):
                if not isinstance(node, ast.Attribute) or not isinstance(node.value, ast.Name):
                    continue
                name = node.value.id
                if name in types:
                    yield from self._wrong_field(node, types[name])

    def _types_bound_once(
        self, function: _Function, statements: Sequence[ast.stmt]
    ) -> dict[str, str]:
        """Return the types of the messages in variables that a function binds once."""
        types: dict[str, str] = {}
        parameters = [node.arg for node in walk(function.node) if isinstance(node, ast.arg)]
        if function.message and len(parameters) == 2:
            types[parameters[1]] = function.message
        for statement in statements:
            match statement:
                case ast.Assign(targets=[ast.Name(id=name)], value=ast.Call(func=made, args=[])):
                    types[name] = self._full_name(made)
        counts = Counter(parameters) + _count_stored(function.node)
        return {name: full for name, full in types.items() if counts[name] == 1}

    def _wrong_field(self, node: ast.Attribute, kind: str) -> Iterator[Slip]:
        messages = python_table().messages
        fields = messages.get(kind)
        if fields is None or node.attr in fields or node.attr.startswith(("_", "get_", "SLOT")):
            return
        inside = [name for name, of in fields.items() if node.attr in messages.get(of, {})]
        meant = near(node.attr, fields)
        if len(inside) == 1:
            meant = f"{inside[0]}.{node.attr}"
        if meant is not None:
            name = kind.replace(".", "/")
            yield self._replaced(node, node.attr, meant, f"{name} has no field {node.attr}")

    def _undefined_attributes(
        self, owner: ast.ClassDef, statements: Sequence[ast.stmt]
    ) -> Iterator[Slip]:
        """Yield the attributes of self that are like one that the class has, and not defined."""
        if owner.decorator_list:
            return
        own_names = self._attributes_of(owner)
        seen = {*own_names}
        for statement in statements:
            for node in _certain_parts(statement):
                if not isinstance(node, ast.Attribute) or not isinstance(node.ctx, ast.Load):
                    continue
                if len(seen) > len(own_names) + _MAX_NAMES:
                    return
                name = node.attr
                if dotted(node) != f"self.{name}" or name in seen or name.startswith("_"):
                    continue
                seen.add(name)
                meant = _meant_attribute(name, own_names)
                if meant is not None:
                    reaction = f"{owner.name} has no attribute {name}"
                    yield self._replaced(node, name, meant, reaction)

    def _attributes_of(self, owner: ast.ClassDef) -> set[str]:
        """Return the attributes that a class of a node may have, as far as names say."""
        names = {*methods_of(owner)}
        for node in self._nodes:
            match node:
                case ast.Attribute(attr=name, ctx=ast.Store()) | ast.Name(id=name, ctx=ast.Store()):
                    names.add(name)
        return names | python_table().node_attributes

    def _called_callbacks(
        self, owner: ast.ClassDef, statements: Sequence[ast.stmt]
    ) -> Iterator[Slip]:
        """Yield callbacks that are called where they should be given."""
        methods = methods_of(owner)
        for statement in statements:
            for call in _calls(statement):
                given = _callback(call)
                if not isinstance(given, ast.Call) or given.args or given.keywords:
                    continue
                name = dotted(given.func)
                method = methods.get(name.removeprefix("self."))
                if method is None or method.decorator_list or _gives_value(method):
                    continue
                what = dotted(call.func).rpartition(".")[2]
                reaction = f"{what}() is given what {name}() returns, not the function"
                start = self._offset(position_of(given))
                end = self._end(given)
                edit = self._code.source.edit(start, end, name)
                yield self._slip(given, edit, reaction, f"{name}() is read as {name}")

    def _wrong_calls(self, function: _Function, statements: Sequence[ast.stmt]) -> Iterator[Slip]:
        """Yield the calls of rclpy and tf2_ros with arguments that stop the program."""
        filled = {"node_name": f'"{self._program.name.removesuffix(".py")}"'}
        nodes = [name for name, made in made_in(statements) if made in self._classes]
        if function.owner is not None:
            filled["node"] = "self"
        elif len(nodes) == 1:
            filled["node"] = nodes[0]
        for statement in statements:
            for call in _calls(statement):
                wrong = self._calls.wrong_call(call, function.owner, filled)
                if wrong is not None and wrong.edits:
                    at = location_in(self._code.source, position_of(call))
                    yield Slip(wrong.edits, wrong.reaction, wrong.assumption, at, is_refused=True)

    def _without_init_of_node(self, owner: ast.ClassDef) -> Iterator[Slip]:
        """Yield that the constructor of a node does not call that of its base."""
        for method in owner.body:
            if not isinstance(method, ast.FunctionDef) or method.name != "__init__":
                continue
            names = {getattr(inner, "attr", getattr(inner, "id", "")) for inner in walk(method)}
            if names.isdisjoint(("__init__", "super")):
                code = f'super().__init__("{self._program.name.removesuffix(".py")}")'
                reaction = f"super().__init__() is missing in the class {owner.name}"
                yield from self._before(method.body, f"{code}; ", owner, reaction, code)

    def _without_rclpy(self, made: Sequence[tuple[_Function, ast.stmt, str]]) -> Iterator[Slip]:
        """Yield that rclpy is not initialised, or that nothing spins the only node."""
        text = self._code.source.text
        if len(made) != 1 or self._imports.get("rclpy") != "rclpy" or not self._is_closed():
            return
        [(function, statement, name)] = made
        if function.owner is not None:
            return
        names = {getattr(node, "attr", getattr(node, "id", "")) for node in self._nodes}
        if "init" not in names and "context" not in text.lower():
            reaction = "rclpy.init() is missing, so that rclpy makes no node"
            code = "rclpy.init()"
            yield from self._before(function.node.body, f"{code}; ", statement, reaction, code)
        if not self._may_run_on(self._classes[name]):
            yield from self._without_spin(statement, name)

    def _may_run_on(self, node_class: ast.ClassDef) -> bool:
        """Return whether a program may spin or wait, or its node has no callbacks."""
        waits = any(isinstance(node, ast.While | ast.For | ast.AsyncFor) for node in self._nodes)
        modules = {full.partition(".")[0] for full in self._imports.values()}
        if "spin" in self._code.source.text or waits or modules & _WAITING:
            return True
        calls = [node for node in walk(node_class) if isinstance(node, ast.Call)]
        conditional = calls_in_branches(self._code.tree)
        called = {last_name(call.func) for call in calls if call not in conditional}
        return called.isdisjoint(CALLBACKS)

    def _without_spin(self, statement: ast.stmt, name: str) -> Iterator[Slip]:
        """Yield that the statement that makes a node of a class does not spin it."""
        reaction = "rclpy.spin() is missing, so that the program ends at once"
        match statement:
            case ast.Expr(value=ast.Call() as call) if dotted(call.func) == name:
                source = self._code.source
                start, end = self._offset(position_of(call)), self._end(call)
                code = f"rclpy.spin({source.text[start:end]})"
                yield self._slip(
                    call, source.edit(start, end, code), reaction, f"`{code}` is assumed"
                )
            case ast.Assign(targets=[ast.Name(id=variable)]):
                end, code = self._end(statement), f"rclpy.spin({variable})"
                edit = self._code.source.edit(end, end, f"; {code}")
                yield self._slip(statement, edit, reaction, f"`{code}` is added")

    def _is_closed(self) -> bool:
        """Return whether all that the file imports is known to do nothing for rclpy."""
        return not self._has_star and all(map(is_passive, self._imports.values()))

    def _of_main_that_is_not_called(self) -> Iterator[Slip]:
        for node in self._code.tree.body:
            is_plain = isinstance(
                node, ast.Import | ast.ImportFrom | ast.FunctionDef | ast.ClassDef | ast.Assign
            )
            is_text = isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
            if not is_plain and not is_text and not (isinstance(node, ast.If) and _name(node.test)):
                return
        source = self._code.source
        end = len(source.text)
        edit = source.edit(end, end, "\nmain()\n")
        reaction = "main() is never called, so that the program does nothing"
        yield self._slip(self._functions["main"], edit, reaction, "main() is called")

    # --- Edits

    def _before(
        self,
        body: Sequence[ast.stmt],
        code: str,
        node: ast.stmt,
        reaction: str,
        added: str,
    ) -> Iterator[Slip]:
        """Yield the slip of a call that is missing before the statements of a function."""
        is_text = isinstance(body[0], ast.Expr) and isinstance(body[0].value, ast.Constant)
        first = body[1] if is_text and len(body) > 1 else body[0]
        if isinstance(first, ast.Expr | ast.Assign | ast.AnnAssign | ast.Pass):
            yield self._inserted(first, code, node, reaction, f"`{added}` is added")

    def _inserted(
        self,
        before: ast.stmt,
        code: str,
        node: ast.expr | ast.stmt,
        reaction: str,
        assumption: str,
    ) -> Slip:
        start = self._offset(position_of(before))
        edit = self._code.source.edit(start, start, code)
        return self._slip(node, edit, reaction, assumption)

    def _replaced(
        self, node: ast.Name | ast.Attribute, written: str, meant: str, reaction: str
    ) -> Slip:
        end = self._end(node)
        edit = self._code.source.edit(end - len(written), end, meant)
        return self._slip(node, edit, reaction, f"{written} is read as {meant}")

    def _slip(self, node: ast.expr | ast.stmt, edit: Edit, reaction: str, assumption: str) -> Slip:
        at = location_in(self._code.source, position_of(node))
        return Slip((edit,), reaction, assumption, at, is_refused=True)

    def _offset(self, position: Position) -> int:
        location = location_in(self._code.source, position)
        return self._code.source.offset(location.line, location.column)

    def _end(self, node: ast.expr | ast.stmt | ast.keyword) -> int:
        return self._offset(Position(node.end_lineno or 1, (node.end_col_offset or 0) + 1))


def _until_spin(statements: Iterable[ast.stmt]) -> Iterator[ast.stmt]:
    """Yield statements up to the one that spins the node: the others run when it is stopped."""
    for statement in statements:
        yield statement
        if any(dotted(call.func).endswith("spin") for call in _calls(statement)):
            return


def _types(handlers: Iterable[ast.ExceptHandler]) -> Iterator[ast.expr]:
    for handler in handlers:
        if isinstance(handler.type, ast.Tuple):
            yield from handler.type.elts
        else:
            yield handler.type or ast.Name("BaseException")


def _name(test: ast.expr) -> str:
    """Return the text that a condition compares __name__ with; empty for another condition."""
    match test:
        case ast.Compare(
            left=ast.Name(id="__name__"),
            ops=[ast.Eq()],
            comparators=[ast.Constant(value=str(name))],
        ):
            return name
    return ""


def _function_of(item: ast.withitem) -> ast.expr:
    return getattr(item.context_expr, "func", item.context_expr)


def _runs_on(test: ast.expr) -> bool:
    """Return whether the condition of a loop holds at first."""
    if isinstance(test, ast.Constant):
        return bool(test.value)
    return isinstance(test, ast.Call) and dotted(test.func) == "rclpy.ok"


def _gives_value(method: ast.FunctionDef) -> bool:
    for node in walk(method):
        if isinstance(node, ast.Yield | ast.YieldFrom) or (
            isinstance(node, ast.Return) and node.value is not None
        ):
            return True
    return False


def _certain_parts(statement: ast.AST) -> Iterator[ast.AST]:
    """Yield the parts of a statement that are certainly evaluated."""
    pending = [statement]
    while pending:
        part = pending.pop()
        yield part
        if isinstance(part, ast.AnnAssign):
            pending += [part.target, *([part.value] if part.value is not None else [])]
        elif not isinstance(part, ast.IfExp | ast.BoolOp | ast.Lambda | ast.comprehension):
            pending += children(part)


def _calls(statement: ast.stmt) -> Iterator[ast.Call]:
    for part in _certain_parts(statement):
        if isinstance(part, ast.Call):
            yield part


def _callback(call: ast.Call) -> ast.expr | None:
    """Return what a method of a node, or the server of an action, is given to call later."""
    argument = CALLBACKS.get(dotted(call.func).removeprefix("self."))
    if argument is not None:
        return given_argument(call, *argument)
    return None


def _package_of_message(name: str) -> str | None:
    """Return the module of the only well-known message of a name."""
    matches = [full for full in python_table().messages if full.rpartition(".")[2] == name]
    if len(matches) == 1:
        return matches[0].rpartition(".")[0]
    return None


def _meant_attribute(name: str, own_names: Collection[str]) -> str | None:
    """Return the attribute that a name surely means: but for underscores, else a similar one."""
    alike = [other for other in own_names if other.strip("_") == name.strip("_")]
    return alike[0] if len(alike) == 1 else near(name, own_names)


def _count_stored(function: ast.AST) -> Counter[str]:
    """Return how often a function sets or deletes each variable."""
    return Counter(
        node.id
        for node in walk(function)
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store | ast.Del)
    )
