"""What a program in Python certainly runs, and the faults in that code which a grade assumes fixed.

A program certainly runs the body of its file, the function that starts it, the constructors of its
nodes and their callbacks, without what is under a condition or caught, or behind what spins a node.
"""

import ast
from collections.abc import Iterable, Iterator, Sequence

from grader.base.grouping import distinct
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.slips import Slip, Slips
from grader.base.source import Edit, Location
from grader.ros.nodes.message_uses import given_argument, suppresses
from grader.ros.nodes.node_facts import CodeFault
from grader.ros.nodes.python.branches import may_catch_error, program_name
from grader.ros.nodes.python.called_functions import list_methods
from grader.ros.nodes.python.code_faults import ModuleText
from grader.ros.nodes.python.rclpy_names import CALLBACKS
from grader.ros.python.constants import binds_unseen, dotted
from grader.ros.python.parse import Position, location_in, make_position, name_position
from grader.ros.python.walking import children, walk

_NEW_LINE = on_use(r"\n[ \t]*")


def assumed_fixes(module: ModuleText, function: str, faults: Iterable[CodeFault]) -> Slips:
    """Yield the fixes of faults in the module of a program that a grade assumes, by their lines.

    They are those of what is certainly wrong in what the program certainly runs. `function` is the
    one that it calls; it is empty for a script, which runs its body as __main__.
    """
    code = module.code
    if binds_unseen(code.nodes):
        return
    places = _RunningCode(module, function).read()
    certain = [fault for fault in faults if fault.is_certain and fault.location in places]
    slips: dict[tuple[str, Location | None], Slip] = {}
    for fault in sorted(certain, key=lambda fault: (fault.location.line, fault.location.column)):
        # A name that is written more than once is one mistake.
        key = (fault.message, None if fault.rule == "name-binding" else fault.location)
        for fix in list(fault.fixes)[:1]:
            first = slips.get(key)
            edits = (*(first.edits if first else ()), *map(_in_one_line, fix.edits))
            at = first.location if first else fault.location
            edits = distinct(edits)
            slips[key] = Slip(edits, fault.message, fix.assumption, at, is_refused=True)
    yield from slips.values()


def _in_one_line(edit: Edit) -> Edit:
    """Return an edit that moves no line, so that other findings stay in theirs."""
    is_statement = not edit.old and edit.new.count("\n") == 1
    return edit._replace(new=_NEW_LINE.sub("; ", edit.new)) if is_statement else edit


class _Function(Named):
    """A function that certainly runs, with the node's class that it is a method of."""

    node: ast.FunctionDef
    owner: ast.ClassDef | None = None


class _RunningCode:
    """The search for the code that a program certainly runs."""

    def __init__(self, module: ModuleText, function: str) -> None:
        self._code = module.code
        self._function = function
        body = module.code.tree.body
        self._functions = {node.name: node for node in body if isinstance(node, ast.FunctionDef)}
        self._classes = {node.name: node for node in module.nodes.values() if len(node.bases) == 1}
        self._places = set[Location]()
        self._pending: list[_Function] = []

    def read(self) -> set[Location]:
        """Return where names, attributes, calls and functions are that certainly run."""
        body = self._code.tree.body
        self._run(body, None)
        for node in body:
            for base in node.bases if isinstance(node, ast.ClassDef) else ():
                self._evaluate(base, None)
        if self._function in self._functions:
            self._pending.append(_Function(self._functions[self._function]))
        if "main" in self._functions:
            self._keep(make_position(self._functions["main"]))
        seen = set()
        while self._pending:
            function = self._pending.pop(0)
            if function.node not in seen:
                seen.add(function.node)
                self._keep(make_position(function.node))
                self._run(function.node.body, function.owner)
        return self._places

    def _keep(self, position: Position) -> None:
        self._places.add(location_in(self._code.source, position))

    def _run(self, statements: Sequence[ast.stmt], owner: ast.ClassDef | None) -> None:
        """Keep what is certainly evaluated of statements, up to the one that spins the node.

        The others run when the program is stopped.
        """
        for statement in self._running(statements):
            called = self._evaluate(statement, owner)
            if any(name.endswith("spin") for name in called):
                return

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
                is_run = not self._function and program_name(test) == "__main__"
                return [body] if is_run else []
            case ast.Try(body=body, handlers=handlers, finalbody=final):
                return [final] if any(map(may_catch_error, handlers)) else [body, final]
            case ast.With(items=items, body=body):
                return [] if suppresses(items) else [body]
            case ast.While(test=test, body=body):
                return [body] if _runs_on(test) else []
        return [] if hasattr(statement, "body") or isinstance(statement, ast.Match) else None

    def _evaluate(self, statement: ast.AST, owner: ast.ClassDef | None) -> list[str]:
        """Keep the parts of a statement that are certainly evaluated; return what they call."""
        called = []
        pending = [statement]
        while pending:
            part = pending.pop()
            match part:
                case ast.IfExp() | ast.BoolOp() | ast.Lambda() | ast.comprehension():
                    continue
                case ast.AnnAssign(target=target, value=value):
                    pending += [target, *([value] if value else [])]
                    continue
                case ast.Name() | ast.Import() | ast.ImportFrom():
                    self._keep(make_position(part))
                case ast.Attribute():
                    self._keep(name_position(part))
                case ast.Call():
                    self._keep(make_position(part))
                    called.append(dotted(part.func))
                    self._pending += self._functions_run_by(part, owner)
            pending += children(part)
        return called

    def _functions_run_by(self, call: ast.Call, owner: ast.ClassDef | None) -> Iterator[_Function]:
        """Yield the functions of the module that a call runs, or lets rclpy call."""
        name = dotted(call.func)
        if name in self._functions:
            yield _Function(self._functions[name])
        node_class = self._classes.get(name)
        if node_class and "__init__" in list_methods(node_class):
            yield _Function(list_methods(node_class)["__init__"], node_class)
        methods = list_methods(owner) if owner else {}
        argument = CALLBACKS.get(name.removeprefix("self."))
        given = given_argument(call, *argument) if argument is not None else None
        for named in (name, dotted(given) if given else ""):
            if named.startswith("self.") and named[5:] in methods:
                yield _Function(methods[named[5:]], owner)


def _runs_on(test: ast.expr) -> bool:
    """Return whether the condition of a loop holds at first."""
    if isinstance(test, ast.Constant):
        return bool(test.value)
    return isinstance(test, ast.Call) and dotted(test.func) == "rclpy.ok"
