"""The constants of a Python module, which is not run.

These are the values of names that a scope binds once.
"""

import ast
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import ClassVar

from grader.base.text import first_part
from grader.ros.known.python_names import MODULES, python_names
from grader.ros.known.releases import RELEASES
from grader.ros.python.bindings import bound_names
from grader.ros.python.budget import Budget, OutOfBudget
from grader.ros.python.interpreter import Interpreter
from grader.ros.python.library import imported_names
from grader.ros.python.parse import START, make_position
from grader.ros.python.values import (
    Call,
    EvaluationFails,
    FunctionTable,
    QualifiedName,
    Scope,
    Undetermined,
    Unknown,
    Value,
)

_QUALITY = "rclpy.qos.QoSProfile"  # an object whose attributes may be set
_MAX_STEPS = 500_000  # of the evaluation of one module
_MAX_NAMES = 40  # of a name with dots
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
        self._full_name = name
        self._is_package = is_package
        self._is_open = binds_unseen(nodes)
        self.imported: set[str] = set()  # the full names of what the scopes so far import
        self._shared = set()  # names that functions of the module may bind
        for node in nodes:
            if isinstance(node, ast.Global | ast.Nonlocal):
                self._shared.update(node.names)

    def evaluate_node(self, node: ast.expr | None, scope: Scope) -> Value:
        """Return the value of an expression; None for none."""
        if not node:
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
        names = [name for name in counts if first_part(name) not in self._shared]
        scope.names |= dict.fromkeys(names, unknown)
        last_star = self._bind_imports(nodes, counts, scope)
        if self._is_open:
            return scope
        for name, expression in values.items():
            if name in names and counts[name] == 1 and expression.lineno > last_star:
                value = self.evaluate_node(expression, scope)
                # A list or a dictionary may be changed.
                is_open = isinstance(value, list | dict)
                if isinstance(value, Call) and value.name == _QUALITY:
                    is_open = _is_given_away(name, nodes)
                scope.names[name] = unknown if is_open else value
        return scope

    def _bind_imports(
        self, nodes: Sequence[ast.AST], counts: Mapping[str, int], scope: Scope
    ) -> int:
        """Bind the names that imports bind to one value; return the line of the last star import.

        A star import may bind what is assigned above it. Without one, the line is 0.
        """
        last_star = 0
        imports = defaultdict[str, list[Value]](list)  # by names: rclpy has two with rclpy.qos
        for node in nodes:
            if isinstance(node, ast.ImportFrom) and _replaces_names(node):
                last_star = max(last_star, node.lineno)
            if isinstance(node, ast.Import | ast.ImportFrom):
                for name, value in self._imported_names(node):
                    imports[name].append(value)
                    if isinstance(value, QualifiedName):
                        self.imported.add(value.name)
        for name, values in imports.items():
            full_names = [getattr(value, "name", value) for value in values]
            if full_names.count(full_names[0]) == counts[name]:
                scope.names[name] = values[0]
        return last_star

    def _imported_names(self, node: ast.Import | ast.ImportFrom) -> Iterator[tuple[str, Value]]:
        """Yield the names that an import binds, each with its value."""
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
        for alias in node.names:
            yield from imported_names(module, alias, {}).items()

    def _constant_name(self, node: ast.Name, scope: Scope) -> Value:
        value = Unknown("it is not a constant", make_position(node))
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


def dotted(node: ast.AST | None) -> str:
    """Return the text of a name with dots; empty for any other expression, and of very many."""
    names: list[str] = []
    while isinstance(node, ast.Attribute) and len(names) < _MAX_NAMES:
        names.append(node.attr)
        node = node.value
    if isinstance(node, ast.Name):
        return ".".join([node.id, *reversed(names)])
    return ""


def count_stored(nodes: Iterable[ast.AST]) -> Counter[str]:
    """Return how often nodes bind each variable, parameter or attribute, with its dots."""
    counts = Counter[str]()
    for node in nodes:
        match node:
            case ast.arg(arg=name):
                counts[name] += 1
            case ast.Name(ctx=ast.Store() | ast.Del()) | ast.Attribute(ctx=ast.Store() | ast.Del()):
                counts[dotted(node)] += 1
    return counts


def count_bound(nodes: Iterable[ast.AST]) -> Counter[str]:
    """Return how often a variable is bound, or an attribute of any object."""
    bound = Counter[str]()
    for node in nodes:
        if isinstance(getattr(node, "ctx", None), ast.Store | ast.Del):
            bound[getattr(node, "id", getattr(node, "attr", ""))] += 1
    return bound


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


def _is_given_away(name: str, nodes: Sequence[ast.AST]) -> bool:
    """Return whether an object has another name, or is given to a function, which may change it."""
    for node in nodes:
        match node:
            case ast.Assign(value=ast.Name(id=given)) if given == name:
                return True
            case ast.Expr(value=ast.Call(func=ast.Name(), args=args)) if name in map(dotted, args):
                return True
    return False


def _bindings(nodes: Sequence[ast.AST]) -> tuple[Counter[str], dict[str, ast.expr]]:
    """Return how often statements bind or change each name with dots.

    Also return the expressions that are assigned.
    """
    counts = Counter[str]()
    values = {}
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
