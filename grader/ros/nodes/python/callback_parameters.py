"""Callbacks of rclpy that cannot take what they are called with.

Python raises a TypeError when such a callback is called, which stops the node. A callback counts if
it is surely the one that the code names: a lambda, a function or a method that nothing decorates,
defines again or replaces.
"""

import ast
from collections.abc import Callable, Collection, Mapping, Sequence
from functools import cached_property

from grader.base.grouping import group_values
from grader.base.records import Named
from grader.base.text import counted
from grader.ros.nodes.message_uses import ClassesByLocation, CodePart, certain_nodes, given_argument
from grader.ros.nodes.node_facts import (
    CodeFault,
    CodeFaults,
)
from grader.ros.python.bindings import bound_names
from grader.ros.python.constants import dotted, last_name
from grader.ros.python.parse import AnyFunction, Code, own_nodes
from grader.ros.python.walking import walk

_Function = AnyFunction | ast.Lambda


class _CallbackRow(Named):
    """A parameter that is given a callback, and what that is called with.

    `most` is greater than `given` where rclpy gives another argument to who takes it.
    """

    position: int | None  # None where it is given by its name only
    name: str
    given: int
    what: str  # in words; empty for nothing
    most: int = 0


# rclpy/{node,subscription,executors,service,client}.py, rclpy/action/{server,client}.py and
# rclpy/task.py of ros2/rclpy, from Humble to Rolling.
_CALLBACKS: Mapping[str, Sequence[_CallbackRow]] = {
    "create_timer": [_CallbackRow(1, "callback", 0, "")],
    "create_subscription": [_CallbackRow(2, "callback", 1, "the message", 2)],
    "create_service": [_CallbackRow(2, "callback", 2, "the request and the response")],
    "ActionServer": [
        _CallbackRow(3, "execute_callback", 1, "the handle of the goal"),
        _CallbackRow(None, "goal_callback", 1, "the goal"),
        _CallbackRow(None, "cancel_callback", 1, "the handle of the goal"),
        _CallbackRow(None, "handle_accepted_callback", 1, "the handle of the goal"),
    ],
    "send_goal_async": [_CallbackRow(1, "feedback_callback", 1, "the feedback")],
    "add_done_callback": [_CallbackRow(0, "callback", 1, "the future")],
    "add_on_set_parameters_callback": [_CallbackRow(0, "callback", 1, "the list of parameters")],
    "add_pre_set_parameters_callback": [_CallbackRow(0, "callback", 1, "the list of parameters")],
    "add_post_set_parameters_callback": [_CallbackRow(0, "callback", 1, "the list of parameters")],
}
_TIMER_INFO = "TimerInfo"  # which rclpy gives by name to the parameter that has it as annotation


class _Scope(Named):
    """A module, class or function: what binds each name in it, and its nodes.

    The nodes of functions and classes in it are not among its nodes.
    """

    bound: Mapping[str, list[ast.AST]]
    nodes: Collection[ast.AST]


class CallbackFunctions:
    """The functions that a module gives as callbacks. What binds a name is searched once a scope.

    `classes` are those of the module by their places, `replaced` the attributes and methods that
    the code of the package may replace.
    """

    def __init__(self, code: Code, classes: ClassesByLocation, replaced: Collection[str]) -> None:
        self._code = code
        self._classes = classes
        self._replaced = replaced
        self._scopes: dict[ast.AST, _Scope] = {}

    def find(self, part: CodePart, given: ast.expr) -> _Function | None:
        """Return the function that an expression in a part surely is; None if not known."""
        if isinstance(given, ast.Lambda):
            return given
        name = dotted(given)
        if name.startswith("self."):
            owner = self._classes.get(part.of) if part.of else None
            return self._method(owner, name[5:]) if owner else None
        if not name or "." in name:
            return None
        inside = self._scope(part.node) if part.name else None
        if inside and _binders(inside, name):
            return _only_function(inside, name)
        return _only_function(self._module, name)

    def _method(self, owner: ast.ClassDef, name: str) -> _Function | None:
        """Return the method that an attribute of self surely is."""
        if owner.decorator_list or owner.keywords or name in self._replaced:
            return None
        return _only_function(self._scope(owner), name)

    def _scope(self, node: ast.AST) -> _Scope:
        """Return what binds names in a function, also inside of others in it, or in a class."""
        if node not in self._scopes:
            nodes = own_nodes(node)
            inside = nodes if isinstance(node, ast.ClassDef) else walk(node)
            self._scopes[node] = _Scope(_bound_names(inside), frozenset(nodes))
        return self._scopes[node]

    @cached_property
    def _module(self) -> _Scope:
        """What binds names in the module; a function that binds one of it does so, too."""
        nodes = own_nodes(self._code.tree)
        bound = _bound_names(nodes)
        for node in walk(self._code.tree):
            for name in node.names if isinstance(node, ast.Global) else ():
                bound.setdefault(name, []).append(node)
        return _Scope(bound, frozenset(nodes))


def wrong_callbacks(
    code: Code,
    parts: Sequence[CodePart],
    functions: CallbackFunctions,
    is_of_rclpy: Callable[[ast.Call, CodePart], bool],
) -> CodeFaults:
    """Yield the callbacks that cannot be called with what rclpy gives them.

    `is_of_rclpy` says whether a call surely is one of rclpy's.
    """
    if "rclpy" not in code.text:
        return
    for part in parts:
        faults = []
        for call in part.calls:
            if last_name(call.func) in _CALLBACKS and is_of_rclpy(call, part):
                faults += [(call, fault) for fault in _find_faults(code, part, call, functions)]
        certain = set(certain_nodes(part.node)) if faults else set[ast.AST]()
        yield from (fault for call, fault in faults if call in certain)


def _find_faults(
    code: Code, part: CodePart, call: ast.Call, functions: CallbackFunctions
) -> CodeFaults:
    """Yield the callbacks that a call is given and that cannot be called."""
    called = last_name(call.func)
    for callback in _CALLBACKS[called]:
        position = len(call.args) if callback.position is None else callback.position
        given = given_argument(call, position, callback.name)
        if not given:
            continue
        function = functions.find(part, given)
        if not function or _is_given_time(called, function, code):
            continue
        is_method = dotted(given).startswith("self.")
        least, most = count_parameters(function, is_method=is_method)
        if _may_be_called(callback, least, most):
            continue
        name = "the function" if isinstance(function, ast.Lambda) else f"{function.name}()"
        taken = _say_parameters(least, most, is_method=is_method)
        gets = f"{callback.given}: {callback.what}" if callback.what else "none"
        message = f"{name} takes {taken}, but a callback of {called}() is called with {gets}"
        at = code.at(function)
        yield CodeFault("callback-parameters", message, at, code.at(call))


def _may_be_called(callback: _CallbackRow, least: float, most: float) -> bool:
    counts = range(callback.given, max(callback.given, callback.most) + 1)
    return any(least <= count <= most for count in counts)


def _say_parameters(least: float, most: float, *, is_method: bool) -> str:
    """Return how many arguments a function takes, in words."""
    if most < 0:
        return "no argument, not even self"
    if least == float("inf"):
        return "an argument that has to be given by its name"
    besides = " besides self" if is_method else ""
    if least == most:
        return f"{counted(int(least), 'argument') if least else 'no argument'}{besides}"
    if most == float("inf"):
        return f"at least {counted(int(least), 'argument')}{besides}"
    return f"{int(least)} to {int(most)} arguments{besides}"


def count_parameters(function: _Function, *, is_method: bool) -> tuple[float, float]:
    """Return how many arguments without names a function takes at least and at most.

    Nothing is enough for one with a parameter that must be given by its name.
    """
    parameters = function.args
    most: float = len(parameters.posonlyargs) + len(parameters.args) - is_method
    least: float = max(most - len(parameters.defaults), 0)
    if parameters.vararg:
        most = float("inf")
        least = max(least, 0)
    if any(not default for default in parameters.kw_defaults):
        least = float("inf")
    return least, most


def _is_given_time(called: str, function: _Function, code: Code) -> bool:
    """Return whether the callback of a timer may be given when it is called.

    It is by name, in the parameter whose annotation says so, from Jazzy on.
    """
    if called != "create_timer" or _TIMER_INFO not in code.text:
        return False
    parameters = [*function.args.posonlyargs, *function.args.args, *function.args.kwonlyargs]
    return any(parameter.annotation is not None for parameter in parameters)


def _bound_names(nodes: Sequence[ast.AST]) -> dict[str, list[ast.AST]]:
    """Return what binds each name: functions, and anything else that does; `*` for all names."""
    return group_values((name, node) for node in nodes for name in bound_names(node))


def _binders(scope: _Scope, name: str) -> list[ast.AST]:
    """Return what binds a name in a scope."""
    return [*scope.bound.get(name, ()), *scope.bound.get("*", ())]


def _only_function(scope: _Scope, name: str) -> _Function | None:
    """Return what binds a name if it is one function of the scope without decorators."""
    binders = _binders(scope, name)
    if len(binders) != 1 or binders[0] not in scope.nodes:
        return None
    [function] = binders
    if not isinstance(function, AnyFunction) or function.decorator_list:
        return None
    return function
