"""The constants of a Python module, which is not run.

These are the values of names that a scope binds once.
"""

import ast
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import ClassVar

from grader.ros.known.python_names import MODULES, python_names
from grader.ros.known.releases import RELEASES
from grader.ros.python.bindings import bound_names
from grader.ros.python.budget import Budget, OutOfBudget
from grader.ros.python.interpreter import Interpreter
from grader.ros.python.library import imported_names
from grader.ros.python.parse import START, make_position
from grader.ros.python.values import (
    EvaluationFails,
    FunctionTable,
    QualifiedName,
    Scope,
    Undetermined,
    Unknown,
    Value,
)

_MAX_STEPS = 500_000  # of the evaluation of one module
# What binds names of a module, or finds its submodules, in ways that are not seen.
_BINDS_UNSEEN = frozenset(
    {
        "exec",
        "eval",
        "globals",
        "locals",
        "vars",
        "setattr",
        "modules",
        "__dict__",
        "__path__",
        "__getattr__",
    }
)


def binds_unseen(nodes: Sequence[ast.AST]) -> bool:
    """Return whether a module with these nodes may bind names in ways that are not seen."""
    names = (
        getattr(node, "id", None) or getattr(node, "attr", None) or getattr(node, "name", None)
        for node in nodes
    )
    return any(name in _BINDS_UNSEEN for name in names)


class Constants(Interpreter):
    """Evaluates expressions of a module whose names are constants.

    What it cannot evaluate is Unknown.
    """

    def __init__(
        self,
        nodes: Sequence[ast.AST],
        name: str,
        functions: FunctionTable,
        work: Budget,
        *,
        is_package: bool,
    ) -> None:
        """`nodes` are those of the module; of calls, those of the functions are evaluated.

        `work` is the budget of all files of the workspace.
        """
        super().__init__(functions, {}, budget=Budget(_MAX_STEPS, whole=work))
        self._full_name, self._is_package, self._is_open = name, is_package, binds_unseen(nodes)
        self.imported: set[str] = set()  # the full names of what the scopes so far import
        self._shared: set[str] = set()  # names that functions of the module may bind
        for node in nodes:
            if isinstance(node, ast.Global | ast.Nonlocal):
                self._shared.update(node.names)

    def evaluate_node(self, node: ast.expr | None, scope: Scope) -> Value:
        """Return the value of an expression; None for none."""
        if node is None:
            return None
        try:
            return self.evaluate(node, scope)
        except (OutOfBudget, RecursionError) as error:
            return Unknown(str(error), START)

    def evaluate(self, node: ast.expr, scope: Scope) -> Value:
        """Return the value of an expression.

        Returns Unknown where it cannot be determined: nothing else depends on it.
        """
        try:
            return self.value(node, scope)
        except (Undetermined, EvaluationFails) as error:
            return Unknown(str(error), make_position(node))

    def bound(self, nodes: Sequence[ast.AST], scope: Scope) -> Scope:
        """Return a scope with the names that statements bind: constants, and what is not known."""
        nodes = sorted(nodes, key=make_order)
        counts, values = _bindings(nodes)
        unknown = Unknown("it is not bound once", START)
        names = [name for name in counts if name.partition(".")[0] not in self._shared]
        scope.names |= dict.fromkeys(names, unknown)
        last_star = self._bind_imports(nodes, counts, scope)
        if self._is_open:
            return scope
        for name, expression in values.items():
            if name in names and counts[name] == 1 and expression.lineno > last_star:
                value = self.evaluate_node(expression, scope)
                # A list or a dictionary may be changed.
                scope.names[name] = unknown if isinstance(value, list | dict) else value
        return scope

    def _bind_imports(
        self, nodes: Sequence[ast.AST], counts: Mapping[str, int], scope: Scope
    ) -> int:
        """Bind the names that are imported once; return the line of the last star import, or 0.

        A star import may bind what is assigned above it.
        """
        last_star = 0
        for node in nodes:
            if isinstance(node, ast.ImportFrom) and _replaces_names(node):
                last_star = max(last_star, node.lineno)
            if isinstance(node, ast.Import | ast.ImportFrom):
                imported = self._imported_names(node)
                self.imported.update(value.name for value in imported.values())
                for name, value in imported.items():
                    if counts[name] == 1:
                        scope.names[name] = value
        return last_star

    def _imported_names(self, node: ast.Import | ast.ImportFrom) -> dict[str, QualifiedName]:
        """Return what an import binds."""
        module = ""
        if isinstance(node, ast.ImportFrom):
            module = node.module or ""
            if node.level:
                # Of a package, one level is the package itself.
                above = self._full_name.split(".")
                count = node.level - self._is_package
                if count:
                    above = above[:-count]
                module = ".".join(filter(None, (*above, module)))
        names: dict[str, QualifiedName] = {}
        for alias in node.names:
            names |= imported_names(module, alias, {})
        return names

    def _constant_name(self, node: ast.Name, scope: Scope) -> Value:
        value: Value = Unknown("it is not a constant", make_position(node))
        if node.id in python_names("builtins"):
            value = self._builtin(node.id)
        return constant_in(scope, node.id, value)

    def _constant_attribute(self, node: ast.Attribute, scope: Scope) -> Value:
        constant = constant_in(scope, dotted(node), self)
        if constant is not self:
            return constant
        return Interpreter.KINDS[ast.Attribute](self, node, scope)

    KINDS: ClassVar = {
        **Interpreter.KINDS,
        ast.Name: _constant_name,
        ast.Attribute: _constant_attribute,
    }


def constant_in(scope: Scope, name: str, default: Value = None) -> Value:
    """Return the value of a name with dots in a scope."""
    try:
        return scope.find(name)
    except KeyError:
        return default


def dotted(node: ast.AST) -> str:
    """Return the text of a name with dots; empty for any other expression."""
    names: list[str] = []
    while isinstance(node, ast.Attribute):
        names.append(node.attr)
        node = node.value
    if isinstance(node, ast.Name):
        return ".".join([node.id, *reversed(names)])
    return ""


def last_name(node: ast.AST) -> str:
    """Return a name, or what is behind the last dot of an attribute.

    It is empty for any other expression.
    """
    match node:
        case ast.Attribute(attr=name) | ast.Name(id=name):
            return name
    return ""


def make_order(node: ast.AST) -> tuple[int, int]:
    """Return line and column of a node, by which nodes are in the order of the file."""
    return getattr(node, "lineno", 0), getattr(node, "col_offset", 0)


def _replaces_names(node: ast.ImportFrom) -> bool:
    """Return whether a star import may bind names of constants.

    Those of messages and of Python itself do not.
    """
    *_, last = (node.module or "").split(".")
    is_known = last in ("msg", "srv", "action") or last in python_names(MODULES, RELEASES)
    return node.names[0].name == "*" and not is_known


def _bindings(nodes: Sequence[ast.AST]) -> tuple[Counter[str], dict[str, ast.expr]]:
    """Return how often statements bind or change each name with dots.

    Also returns the expressions that are assigned.
    """
    counts, values = Counter[str](), dict[str, ast.expr]()
    for part in nodes:
        match part:
            case ast.Assign(targets=[target], value=value):
                values[dotted(target)] = value
            case ast.AnnAssign(target=target, value=ast.expr() as value):
                values[dotted(target)] = value
            case _:
                counts.update(_bound_by(part))
    return counts, values


def _bound_by(part: ast.AST) -> Sequence[str]:
    """Return the names with dots that one node binds or changes."""
    match part:
        case ast.Attribute(ctx=ast.Store() | ast.Del()):
            return [dotted(part), dotted(part.value)]
        case ast.Subscript(ctx=ast.Store() | ast.Del()):
            return [dotted(part.value)]
        case _:
            return bound_names(part)
