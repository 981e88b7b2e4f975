"""Visit the actions of a launch description: the nodes, includes and arguments that they add."""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import ClassVar

from grader.package.launch.conditions import holds
from grader.package.launch.known_files import start_known_file
from grader.package.launch.model import Context, Findings
from grader.package.launch.nodes import start_node, start_process
from grader.package.launch.substitutions import resolve
from grader.static_python.parse import START, Position
from grader.static_python.values import UNKNOWN_KEYS, Call, Function, QualifiedName, Unknown, Value

_MAX_ACTIONS = 5_000
_MAX_DEPTH = 40
CIRCULAR_INCLUDE = "it includes itself"
# Actions that start nothing.
_IDLE = re.compile(r"(?:Set|Unset|Push|Pop|Log|Append|Prepend|Reset|Replace|Clear|Emit|Shutdown|Unregister)\w*")
_CONTAINERS = ("ComposableNodeContainer", "LoadComposableNodes", "ComposableNode", "ComposableLifecycleNode")

# Takes the path of a launch file below the prefix and the arguments for it; returns why it is not read, or nothing.
Include = Callable[[str, Context], str]


@dataclass(slots=True)
class ActionVisitor:
    """A visitor of actions that adds its findings. `when` is whether an action is executed, None if this is unknown."""

    findings: Findings
    include: Include
    call_function: Callable[[Function, Position, Sequence[Value] | None], Value]
    visited: set[int] = field(default_factory=set)  # the ids of the calls that are part of the description
    steps: int = 0
    depth: int = 0

    def visit(self, value: Value, context: Context, when: bool | None) -> None:
        """Visit an action, or all actions of a list."""
        self.steps += 1
        if self.depth > _MAX_DEPTH or self.steps > _MAX_ACTIONS:
            self.findings.add_unknown("the launch file has too many actions", START)
            return
        self.depth += 1
        match value:
            case list() | tuple() | dict():
                for action in value.values() if isinstance(value, dict) else value:
                    if self.steps <= _MAX_ACTIONS:
                        self.visit(action, context, when)
            case Unknown():
                self.findings.add_unknown(value.reason, value.at)
            case QualifiedName():
                self.findings.add_unknown(f"the value of {value.name} is known only at run time", START)
            case Call():
                start = len(context.errors)
                is_certain = UNKNOWN_KEYS not in value.kwargs
                executed = _both(when if is_certain else when and None, holds(value.kwargs.get("condition"), context))
                self.findings.add_errors(context, start, is_certain=when is True)  # launch evaluates the condition
                self.visited.add(id(value))
                self._action(value, context, executed)
                self.findings.add_errors(context, start, is_certain=executed is True)
        self.depth -= 1

    def _action(self, call: Call, context: Context, when: bool | None) -> None:
        kind = call.name.rpartition(".")[2]
        visit = self._VISITS.get(kind)
        if visit is not None:
            visit(self, call, context, when)
        elif kind.startswith("On") and kind[2:3].isupper():
            self._event_handler(call, context, when if kind == "OnProcessStart" else when and None)
        elif kind in _CONTAINERS:
            self.findings.add_unknown("the nodes of a container are not supported", call.at)
        elif _IDLE.fullmatch(kind) and call.name.startswith(("launch.", "launch_ros.")):
            self.findings.sets_parameters |= kind in ("SetParameter", "SetParametersFromFile")
        elif not call.name.startswith("?."):
            self.findings.add_unknown(f"what {kind} starts is known only at run time", call.at)

    def _node(self, call: Call, context: Context, when: bool | None) -> None:
        start_node(self.findings, call, context, when)

    def _process(self, call: Call, context: Context, when: bool | None) -> None:
        start_process(self.findings, call, context, when)

    def _timer(self, call: Call, context: Context, when: bool | None) -> None:
        self._inner(call, call.argument(1, "actions"), context, when)

    def _register(self, call: Call, context: Context, when: bool | None) -> None:
        self.visit(call.argument(0, "event_handler"), context, when)

    def _argument(self, call: Call, context: Context, when: bool | None) -> None:
        _set_argument(call, context, when, declares="Declare" in call.name)

    def _description(self, call: Call, context: Context, when: bool | None) -> None:
        actions, *others = [call.argument(0, "initial_entities"), *call.args[1:]]
        if isinstance(actions, Call) or others:
            context.add_error("LaunchDescription takes one list: put [ ] around the actions", call.at)
        self._visit_list(others, call, context, when)
        self._visit_list(actions, call, context, when)
        for method in call.method_calls:
            if method.name.endswith((".add_action", ".add_entity")):
                self._visit_list(method.args, method, context, when)

    def _visit_list(self, actions: Value, call: Call, context: Context, when: bool | None) -> None:
        """Visit the actions of a description, which may not contain lists."""
        if isinstance(actions, list | tuple) and any(isinstance(action, list | tuple) for action in actions):
            context.add_error("expected an action, found a list of actions: write * before it", call.at)
        self.visit(actions, context, when)

    def _inner(self, call: Call, actions: Value, context: Context, when: bool | None) -> None:
        """Visit the actions in another action, which have to be a list."""
        if isinstance(actions, Call):
            kind = call.name.rpartition(".")[2]
            context.add_error(f"{kind} takes a list of actions: put [ ] around them", call.at)
        self.visit(actions, context, when)

    def _group(self, call: Call, context: Context, when: bool | None) -> None:
        """Visit a group: the launch arguments that it sets end with it, unless scoped is False."""
        before = dict(context.arguments)
        own = call.kwargs.get("launch_configurations")
        for name, value in own.items() if isinstance(own, dict) else ():
            context.arguments[str(name)] = resolve(value, context)
        self._inner(call, call.argument(0, "actions"), context, when)
        if call.kwargs.get("scoped", True) is not False:
            context.arguments.clear()
            context.arguments.update(before)

    def _event_handler(self, call: Call, context: Context, when: bool | None) -> None:
        """Visit the actions for an event. Only the start of another process certainly happens."""
        for value in (value for name, value in call.kwargs.items() if name.startswith("on_") or name == "entities"):
            actions = self.call_function(value, call.at, None) if isinstance(value, Function) else value
            self.visit(actions, context, when)

    def _opaque_function(self, call: Call, context: Context, when: bool | None) -> None:
        function, args = call.argument(0, "function"), call.kwargs.get("args") or []
        if not isinstance(function, Function) or not isinstance(args, list | tuple) or call.kwargs.get("kwargs"):
            self.findings.add_unknown("the result of an OpaqueFunction is known only at run time", call.at)
            return
        arguments = (Call("launch.LaunchContext", [], {}, call.at), *args)
        self.visit(self.call_function(function, call.at, arguments), context, when)

    def _include(self, call: Call, context: Context, when: bool | None) -> None:
        if when is False:
            return
        path = resolve(call.argument(0, "launch_description_source"), context)
        given = _launch_arguments(call.argument(1, "launch_arguments"), context, call.at)
        if not isinstance(path, str) or given is None:
            reason = path.reason if isinstance(path, Unknown) else "the included file is known only at run time"
            self.findings.add_unknown(reason, call.at)
            return
        folder, arguments = path.rpartition("/")[0], {**context.arguments, **given}
        inner = Context(folder, arguments, when=when, steps_left=context.steps_left)
        reason = self.include(path, inner)
        if not reason or not start_known_file(self.findings, path, call, inner):
            self.findings.refer("include", path, call)
            if reason == CIRCULAR_INCLUDE and when:
                self.findings.add_fault(reason, call.at)
            elif reason:
                self.findings.add_unknown(reason, call.at)
        context.arguments.update(inner.arguments)  # an included file shares its arguments with the actions that follow
        if reason:
            context.arguments[UNKNOWN_KEYS] = Unknown(reason, call.at)

    # The methods that visit each kind of action.
    _VISITS: ClassVar[Mapping[str, Callable[..., None]]] = {
        "DeclareLaunchArgument": _argument,
        "DeclareBooleanLaunchArgument": _argument,
        "SetLaunchConfiguration": _argument,
        "Node": _node,
        "LifecycleNode": _node,
        "ExecuteProcess": _process,
        "ExecuteLocal": _process,
        "IncludeLaunchDescription": _include,
        "LaunchDescription": _description,
        "GroupAction": _group,
        "TimerAction": _timer,
        "RosTimer": _timer,
        "RegisterEventHandler": _register,
        "OpaqueFunction": _opaque_function,
    }


def _both(one: bool | None, other: bool | None) -> bool | None:
    """Return whether two conditions hold, each of which may be unknown."""
    return min(one, other, key=(False, None, True).index)


def _set_argument(call: Call, context: Context, when: bool | None, *, declares: bool) -> None:
    """Give a launch argument that is declared or set its value."""
    name = resolve(call.argument(0, "name"), context)
    if when is False or not isinstance(name, str) or (declares and name in context.arguments):
        return  # DeclareLaunchArgument.execute keeps a value that is already set
    value = call.argument(1, "default_value", "value")
    choices = call.kwargs.get("choices")
    if declares and len(call.args) > 1:
        context.add_error("DeclareLaunchArgument takes its default as a keyword argument: default_value=...", call.at)
    is_limited = declares and isinstance(choices, list | tuple) and all(isinstance(choice, str) for choice in choices)
    if is_limited and choices and isinstance(value, str) and value not in choices:
        context.add_error(f"the default {value!r} of {name!r} is not one of its choices", call.at)
    if isinstance(value, int | float):
        text = str(value).lower() if isinstance(value, bool) else str(value)
        context.add_error(f"the value of a launch argument is a string: write {text!r}", call.at)
    if when is None:
        context.arguments[name] = Unknown(f"the launch argument {name!r} is set under a condition", call.at)
    elif value is None:
        context.arguments[name] = Unknown(f"the launch argument {name!r} has no default", call.at)
    else:
        context.arguments[name] = resolve(value, context)


def _launch_arguments(given: Value, context: Context, at: Position) -> dict[str, Value] | None:
    """Return the launch arguments that an include passes on, resolved; None where they are unknown."""
    if given is None:
        return {}
    if isinstance(given, dict):
        context.add_error("launch_arguments is given a dict: add .items() to it", at)
        given = list(given.items())
    pairs: list[Value] = list(given) if isinstance(given, list | tuple) else [None]
    if not all(isinstance(pair, list | tuple) and len(pair) == 2 for pair in pairs):
        return None
    resolved = [(resolve(name, context), resolve(value, context)) for name, value in pairs]
    return {name: value for name, value in resolved if isinstance(name, str)}
