"""What Python code names and does not call, calls twice, or asks of modules that lack it."""

import ast
from collections.abc import Collection, Iterator, Sequence

from grader.base.grouping import StringsByName
from grader.base.names import near
from grader.base.problems import NO_FIXES
from grader.base.text import first_part
from grader.ros.known.package_tables import python_table
from grader.ros.known.python_names import python_names
from grader.ros.known.releases import RELEASES
from grader.ros.nodes.message_uses import ClassesByLocation, CodePart, certain_nodes, given_argument
from grader.ros.nodes.node_facts import CodeFault, CodeFaults
from grader.ros.nodes.python.called_functions import list_methods, name_fully
from grader.ros.nodes.python.code_edits import CodeEdits
from grader.ros.python.constants import count_bound, dotted
from grader.ros.python.parse import Code, make_position
from grader.ros.python.walking import walk

_OLDEST = "humble"  # what it lacks is said where no release is stated
# Functions without which a program does not run, or does not end.
_CALLED = frozenset({"rclpy.init", "rclpy.spin", "rclpy.spin_once", "rclpy.shutdown"})
_DECLARES = "self.declare_parameter"
_UNDECLARING = ("has_parameter", "undeclare_parameter", "ParameterAlreadyDeclared")
_MAKING = frozenset({"self.create_timer", "self.create_subscription"})


def missing_members(code: Code, parts: Sequence[CodePart], imports: StringsByName) -> CodeFaults:
    """Yield what the modules that a file imports certainly lack in the stated releases.

    Of Python's own modules this is what is a misspelling of a name that they have. `imports` has
    the full names of what is imported.
    """
    bound = count_bound(code.nodes)
    modules = {name: full for name, full in imports.items() if not bound[name]}
    for part in parts:
        read = [node for node in certain_nodes(part.node) if isinstance(node, ast.Attribute)]
        for node in sorted(read, key=make_position):
            is_of_module = first_part(dotted(node)) in modules
            if is_of_module and isinstance(node.ctx, ast.Load):
                yield from _find_missing(code, node, name_fully(node, modules))


def _find_missing(code: Code, node: ast.Attribute, full: str) -> CodeFaults:
    """Yield that a module has no attribute, which is the last of a full name."""
    module, _, name = full.rpartition(".")
    edits = CodeEdits(code.source)
    end = edits.span(node)[1]
    at = code.source.at(end - len(name))
    fixes = NO_FIXES
    since = python_table().gone.get(full)
    names = python_names(module, code.releases) if module else frozenset[str]()
    sure = near(name, names) if names and name not in names else None
    if since is not None:
        releases = code.releases or (_OLDEST,)
        if not {*releases}.isdisjoint(RELEASES[: RELEASES.index(since)]):
            return
        message = f"{module} has no {name} since {since.capitalize()}"
    elif sure is not None:
        message = f"{module} has no {name}; did you mean {sure}?"
        fixes = edits.rewrite(end - len(name), end, sure)
    else:
        return
    yield CodeFault("name-binding", message, at, fixes=fixes)


def uncalled_functions(
    code: Code,
    parts: Sequence[CodePart],
    classes: ClassesByLocation,
    imports: StringsByName,
) -> CodeFaults:
    """Yield the functions of rclpy and own methods that are a statement without being called."""
    edits = CodeEdits(code.source)
    for part in parts:
        owner = classes.get(part.of) if part.of else None
        methods = list_methods(owner) if owner else {}
        plain = {f"self.{name}" for name, node in methods.items() if not node.decorator_list}
        for node in certain_nodes(part.node):
            written = dotted(node.value) if isinstance(node, ast.Expr) else ""
            full = name_fully(node.value, imports) if isinstance(node, ast.Expr) else ""
            if isinstance(node, ast.Expr) and (full in _CALLED or written in plain):
                message = f"{written} is not called: write {written}()"
                end = edits.span(node)[1]
                is_sure = full == "rclpy.init"
                fixes = edits.insert(end, "()", "it is called") if is_sure else NO_FIXES
                yield CodeFault("function-call", message, code.at(node), fixes=fixes)


def repeated_calls(code: Code, classes: Collection[ast.ClassDef]) -> CodeFaults:
    """Yield what constructors of nodes declare twice, or make twice in the same words.

    Only statements of which each runs after the other are compared.
    """
    may_undeclare = any(word in code.text for word in _UNDECLARING)
    for owner in classes:
        first: dict[str, ast.Call] = {}
        for call in _list_called(list_methods(owner).get("__init__")):
            name = _find_declared(call)
            key = f"declares {name}" if name else ast.dump(call)
            if dotted(call.func) not in _MAKING and (not name or may_undeclare):
                continue
            other = first.setdefault(key, call)
            if other is call:
                continue
            if name:
                message = f"the parameter {name!r} is declared twice: rclpy raises an exception"
                yield CodeFault("declared-once", message, code.at(call), code.at(other))
            else:
                made = dotted(call.func).removeprefix("self.create_")
                message = f"the same {made} is created twice, so its callback runs twice"
                yield CodeFault("declared-once", message, code.at(call), code.at(other), False)


def _list_called(constructor: ast.FunctionDef | None) -> Iterator[ast.Call]:
    """Yield the calls of methods of self that the statements of a constructor are made of."""
    for statement in constructor.body if constructor else ():
        if isinstance(statement, ast.Assign | ast.AnnAssign | ast.Expr):
            for node in walk(statement):
                if isinstance(node, ast.Call) and dotted(node.func).startswith("self."):
                    yield node


def _find_declared(call: ast.Call) -> str:
    """Return the parameter that a call declares, if its name is written there."""
    named = given_argument(call, 0, "name")
    if dotted(call.func) != _DECLARES or not isinstance(named, ast.Constant):
        return ""
    return named.value if isinstance(named.value, str) else ""
