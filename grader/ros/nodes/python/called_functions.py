"""Which functions of rclpy and tf2_ros a module calls, and what is wrong with their arguments."""

import ast
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence

from grader.base.grouping import StringsByName, group_values
from grader.base.text import first_part, last_part
from grader.ros.known.releases import Release
from grader.ros.nodes.python.code_edits import CodeEdits
from grader.ros.nodes.python.python_calls import ArgumentKind, Written, WrongCall, wrong_call
from grader.ros.python.bindings import names_bound
from grader.ros.python.constants import count_bound, dotted, last_name
from grader.ros.python.parse import AnyFunction, Code
from grader.ros.python.walking import walk

_PLAIN_NODES = ("rclpy.Node", "rclpy.node.Node")
# The classes of what calls make, of which the table of calls has methods.
_MAKING = {
    "create_publisher": "Publisher",
    "create_client": "Client",
    "create_timer": "Timer",
    **{
        name: name
        for name in ("ActionClient", "Buffer", "TransformBroadcaster", "StaticTransformBroadcaster")
    },
}
_SECTIONS = ("Request", "Response", "Goal", "Result", "Feedback")


class CalledFunctions:
    """The functions that a module calls, by the keys of the table of calls."""

    def __init__(
        self,
        code: Code,
        nodes: Sequence[ast.AST],
        node_classes: Collection[ast.ClassDef],
        releases: Sequence[Release],
    ) -> None:
        """Search in all nodes of the code; the classes have no bases but those of rclpy."""
        self._nodes = node_classes
        self._code = code
        self._releases = releases
        self._stored = count_bound(nodes)
        self._rebound = {*self._stored}
        self._defined = set[str]()
        self._bound_in: dict[ast.ClassDef, set[str]] = {}  # the names that bodies of classes bind
        self._named: dict[str, list[ast.ClassDef]] = {}  # the classes of each name
        self._owners: dict[ast.AST, list[ast.ClassDef]] = {}  # the classes that calls are in
        for node in nodes:
            self._add(node)
        imports = dict[str, str]()
        self._lost = self._rebound | self._defined
        for node in nodes:
            for name, full in imported_names([node]).items():
                if imports.setdefault(name, full) != full:
                    self._lost.add(name)
        # The names that the module certainly imports, and does not bind to anything else.
        self._imports = {name: full for name, full in imports.items() if name not in self._lost}
        self._made = group_values(bound_calls(nodes))

    def _add(self, node: ast.AST) -> None:
        """Keep the names that a node binds, and its calls if it is a class."""
        if isinstance(node, ast.arg):
            self._rebound.add(node.arg)
        elif isinstance(node, AnyFunction | ast.ClassDef):
            self._defined.add(node.name)
        if isinstance(node, ast.ClassDef):
            self._add_class(node)

    def _add_class(self, owner: ast.ClassDef) -> None:
        self._bound_in[owner] = names_in_class(owner)
        self._named.setdefault(owner.name, []).append(owner)
        for node in walk(owner):
            if isinstance(node, ast.Call):
                self._owners.setdefault(node, []).append(owner)

    def wrong_call(
        self,
        call: ast.Call,
        owner: ast.ClassDef | None,
        filled: StringsByName,
        known_kind: Callable[[ast.expr], ArgumentKind | None],
    ) -> WrongCall | None:
        """Return what is wrong with the arguments of a call in a method of a node's class.

        `filled` is what is given to parameters where it is missing, `known_kind` says what an
        expression is that the class does not tell.
        """
        called = self._called_function(call, owner)
        if called is None:
            return None

        def find_kind(argument: ast.expr) -> ArgumentKind | None:
            return known_kind(argument) or self._find_kind(owner, argument)

        source = self._code.source
        written = Written(call, source, CodeEdits(source).span, find_kind, filled)
        return wrong_call(written, called, self._releases)

    def _called_function(self, call: ast.Call, owner: ast.ClassDef | None) -> str | None:
        """Return the key of the table of calls for what is surely called."""
        name = dotted(call.func)
        receiver, _, method = name.rpartition(".")
        if owner and receiver == "self":
            return f"Node.{method}" if not self._is_replaced(method, owner) else None
        match call.func:
            case ast.Attribute(attr="__init__", value=ast.Call(func=ast.Name(id="super"), args=[])):
                is_plain = owner is not None and self._full_name(owner.bases[0]) in _PLAIN_NODES
                return "Node.__init__" if is_plain else None
        full = self._full_name(call.func)
        if full in _PLAIN_NODES or full.startswith(("rclpy.action.", "tf2_ros.")):
            return f"{last_part(full)}.__init__"
        if full.startswith("rclpy."):
            return full
        kind = self._kind_of_object(receiver)
        return f"{kind}.{method}" if kind is not None else None

    def _full_name(self, node: ast.expr) -> str:
        """Return the full name of what is imported; empty for what may be something else."""
        first, dot, rest = dotted(node).partition(".")
        if first in self._lost:
            return ""
        return f"{self._imports.get(first, first)}{dot}{rest}"

    def _kind_of_object(self, name: str) -> str | None:
        """Return what a variable or attribute holds that the file binds once, if rclpy makes it."""
        calls = self._made.get(name, ())
        if len(calls) != 1 or self._stored[last_part(name)] != 1:
            return None
        made = calls[0].func
        maker = last_name(made)
        if self._full_name(made).startswith(("rclpy.action.", "tf2_ros.")):
            return _MAKING.get(maker)
        if not isinstance(made, ast.Attribute):
            return None
        return _MAKING.get(maker) if self._is_node(made.value, calls[0]) else None

    def _is_node(self, node: ast.expr, call: ast.Call) -> bool:
        """Return whether the object whose method is called surely is a node of rclpy."""
        name = dotted(node)
        method = last_name(call.func)
        if name == "self":
            owners = self._owners.get(call, ())
            return len(owners) == 1 and self._is_node_class(owners[0], method)
        made = self._made.get(name, ())
        if len(made) != 1 or self._stored[last_part(name)] != 1:
            return False
        full = self._full_name(made[0].func)
        owners = self._named.get(dotted(made[0].func), ())
        is_own = len(owners) == 1 and self._is_node_class(owners[0], method)
        return is_own or full in _PLAIN_NODES or full == "rclpy.create_node"

    def _is_node_class(self, owner: ast.ClassDef, method: str) -> bool:
        """Return whether a class has no bases but those of rclpy, and does not replace a method."""
        is_plain = owner in self._nodes and not owner.keywords and not owner.decorator_list
        return is_plain and not self._is_replaced(method, owner)

    def _is_replaced(self, method: str, owner: ast.ClassDef) -> bool:
        """Return whether the module may replace a method of a class of nodes."""
        if method in self._defined or method in self._stored:
            return True
        return method in self._bound_in.get(owner, ())

    def _find_kind(self, owner: ast.ClassDef | None, argument: ast.expr) -> ArgumentKind | None:
        """Return what an argument surely is."""
        if isinstance(argument, ast.BinOp):
            kinds = {self._find_kind(owner, side) for side in (argument.left, argument.right)}
            return "number" if kinds == {"number"} else None
        if isinstance(argument, ast.Constant | ast.JoinedStr | ast.Lambda):
            return _kind_of_value(argument)
        name = dotted(argument)
        methods = list_methods(owner) if owner else {}
        method = methods.get(name.removeprefix("self.")) if name.startswith("self.") else None
        if method and not method.decorator_list and method.name not in self._stored:
            return "function"
        return "type" if self._is_interface(argument) else None

    def _is_interface(self, argument: ast.expr) -> bool:
        """Return whether an expression is a type of messages, or a section of another type."""
        first, _, section = dotted(argument).partition(".")
        parts = self._full_name(argument).split(".")
        if first not in self._imports or first in self._rebound or parts[0] in ("rclpy", ""):
            return False
        if parts[-1] in _SECTIONS and parts[-1] in section:
            parts.pop()
        return len(parts) > 2 and parts[-2] in ("msg", "srv", "action") and parts[-1][0].isupper()


def made_in(nodes: Iterable[ast.AST]) -> Iterator[tuple[str, str]]:
    """Yield the variables and attributes that nodes bind, with what their calls make."""
    for target, call in bound_calls(nodes):
        yield target, dotted(call.func)


def bound_calls(nodes: Iterable[ast.AST]) -> Iterator[tuple[str, ast.Call]]:
    """Yield the calls whose results are bound, with the variable or attribute."""
    for node in nodes:
        match node:
            case ast.Assign(targets=[ast.Name() | ast.Attribute() as to], value=ast.Call() as call):
                yield dotted(to), call


def names_in_class(owner: ast.ClassDef) -> set[str]:
    """Return the names that the body of a class binds."""
    names = set()
    for node in owner.body:
        if isinstance(node, AnyFunction | ast.ClassDef):
            names.add(node.name)
        else:
            names.update(names_bound(walk(node)))
    return names


def list_methods(owner: ast.ClassDef) -> dict[str, ast.FunctionDef]:
    """Return the methods of a class by their names."""
    return {node.name: node for node in owner.body if isinstance(node, ast.FunctionDef)}


def imported_names(nodes: Iterable[ast.AST]) -> dict[str, str]:
    """Return the full names of what imports bind, by the names in the module."""
    imports = {}
    for node in nodes:
        match node:
            case ast.Import(names=names):
                for alias in names:
                    top = first_part(alias.name)
                    imports[alias.asname or top] = alias.name if alias.asname else top
            case ast.ImportFrom(module=module, names=names, level=level):
                for alias in names:  # of the package itself, if dots come first
                    full = f"{'.' * level}{module or ''}.{alias.name}"
                    imports[alias.asname or alias.name] = full
    return imports


def name_fully(node: ast.expr, imports: StringsByName) -> str:
    """Return the full name of what an expression names, by the names that are imported."""
    first, dot, rest = dotted(node).partition(".")
    return f"{imports.get(first, first)}{dot}{rest}"


def _kind_of_value(value: ast.Constant | ast.JoinedStr | ast.Lambda) -> ArgumentKind | None:
    if isinstance(value, ast.Lambda):
        return "function"
    if isinstance(value, ast.JoinedStr) or isinstance(value.value, str):
        return "text"
    return "number" if type(value.value) in (int, float) else None
