"""What the actions of a launch description do as launch executes them: nodes, includes, groups, timers, events."""

from collections.abc import Callable, Mapping
from dataclasses import replace

from grader.package.launch.api import ENTITY, SOURCE, is_a
from grader.package.launch.conditions import both, holds
from grader.package.launch.fields import launch_arguments
from grader.package.launch.known_files import start_known_file
from grader.package.launch.model import Context, LaunchFails, NotEvaluated
from grader.package.launch.nodes import evaluate_node, evaluate_process, start_node, start_process
from grader.package.launch.substitutions import known_text, resolve
from grader.package.launch.value_types import items_in, kind_of
from grader.package.launch.visitor import PROCESSES, ActionVisitor
from grader.static_python.values import UNKNOWN_KEYS, Call, Function, QualifiedName, Unknown

CIRCULAR_INCLUDE = "it includes itself"
_HANDLER = "launch.event_handler.BaseEventHandler"


def _description(visitor: ActionVisitor, call: Call, context: Context, when: bool | None) -> None:
    visitor.visit_all(call.kwargs.get("initial_entities") or [], call, context, when)
    for method in call.method_calls:
        if method.name.endswith((".add_action", ".add_entity")):
            visitor.visit_all([*method.args, *method.kwargs.values()], method, context, when)


def _group(visitor: ActionVisitor, call: Call, context: Context, when: bool | None) -> None:
    """Visit a group: what it sets ends with it, unless scoped is False."""
    own = call.kwargs.get("launch_configurations") or {}
    is_scoped, inner = bool(call.kwargs.get("scoped", True)), context
    if is_scoped:
        inner = context.copy()
        if not call.kwargs.get("forwarding", True):
            inner.arguments, inner.environment = {}, {}
    for name, value in own.items() if when is not False else ():
        inner.arguments[known_text(name, context, call.at)] = resolve(value, context, call.at)
    visitor.visit_all(call.kwargs["actions"], call, inner, when)


def _timer(visitor: ActionVisitor, call: Call, context: Context, when: bool | None) -> None:
    period = call.kwargs["period"]
    if not isinstance(period, str | float):
        try:
            float(known_text(period, context, call.at))
        except ValueError:
            raise NotEvaluated("a timer whose period is no number is not evaluated", call.at) from None
    visitor.defer(call.kwargs["actions"], call, context, when, None)


def _register(visitor: ActionVisitor, call: Call, context: Context, when: bool | None) -> None:
    handler = call.kwargs["event_handler"]
    if isinstance(handler, Unknown):
        raise NotEvaluated(handler.reason, handler.at)
    if not isinstance(handler, Call) or not is_a(handler.name, _HANDLER):
        error = LaunchFails(f"expected an event handler, found {kind_of(handler)}", call.at)
        visitor.add_of_form(error, context, when)
        return
    target = handler.kwargs.get("target_action")
    for name, value in handler.kwargs.items():
        if (name.startswith("on_") or name == "entities") and not isinstance(value, QualifiedName | None):
            actions = visitor.call_function(value, handler.at, None, context) if isinstance(value, Function) else value
            is_certain = handler.name.endswith("OnProcessStart") and isinstance(target, Call) and value is actions
            listed = actions if isinstance(actions, list | tuple) else [actions]
            if is_certain:
                visitor.defer(listed, handler, context, when, target)
            elif actions is not None and not handler.name.endswith("OnProcessIO"):
                loaded, visitor.is_loaded = (
                    visitor.is_loaded,
                    visitor.is_loaded and value is actions and not handler.name.endswith("OnShutdown"),
                )
                visitor.perhaps(listed, handler, context, when and None)
                visitor.is_loaded = loaded


def _opaque_function(visitor: ActionVisitor, call: Call, context: Context, when: bool | None) -> None:
    function, args = call.kwargs["function"], call.kwargs.get("args") or []
    if not isinstance(function, Function) or not isinstance(args, list | tuple) or call.kwargs.get("kwargs"):
        raise NotEvaluated("the result of this OpaqueFunction is not evaluated", call.at)
    if when is False:
        return
    arguments = (Call("launch.launch_context.LaunchContext", [], {}, call.at), *args)
    found = visitor.call_function(function, call.at, arguments if when else None, context)
    loaded, visitor.is_loaded = visitor.is_loaded, False
    if isinstance(found, Unknown):
        visitor.findings.add(NotEvaluated(found.reason, found.at), when)
    elif found is not None:
        visitor.visit_all(found, call, context, when)
    visitor.is_loaded = loaded


def _include(visitor: ActionVisitor, call: Call, context: Context, when: bool | None) -> None:
    if when is False:
        return
    source = call.kwargs["launch_description_source"]
    if isinstance(source, Call) and is_a(source.name, SOURCE):
        source = source.kwargs.get("launch_file_path", Unknown("this launch description is not evaluated", call.at))
    given = launch_arguments(call.kwargs.get("launch_arguments"), context, call.at)
    path = known_text(source, context, call.at)
    arguments = {**context.arguments, **given}
    inner = replace(context, path=path, arguments=arguments, when=when, reads=[], given=frozenset(given))
    reason = visitor.include(path, inner)
    if reason and not start_known_file(visitor.findings, path, call, inner):
        visitor.findings.refer("include", path, call)
        if reason == CIRCULAR_INCLUDE:
            raise LaunchFails(reason, call.at)
        visitor.findings.add_unknown(reason, call.at)
    elif not reason:
        visitor.findings.refer("include", path, call)
    context.arguments.update(inner.arguments)  # an included file shares its arguments with the actions that follow
    if reason:
        context.arguments[UNKNOWN_KEYS] = Unknown(reason, call.at)


def _process(visitor: ActionVisitor, call: Call, context: Context, when: bool | None) -> None:
    """Start a process, which an action can do once only."""
    before, visitor.executed[id(call)] = visitor.executed.get(id(call), False), when
    start = start_node if "executable" in call.kwargs else start_process
    start(visitor.findings, call, context, when)
    if when is not False and before is not False:
        message = f"the same {call.name.rpartition('.')[2]} is executed twice: make two of them"
        raise LaunchFails(message, call.at) if before and when else NotEvaluated(message, call.at)
    if when is not False:
        (evaluate_node if "executable" in call.kwargs else evaluate_process)(call, context)
    on_exit = call.kwargs.get("on_exit")
    if isinstance(on_exit, list):
        visitor.perhaps(on_exit, call, context, when and None)
    elif not isinstance(on_exit, Function | Call | Unknown | QualifiedName | None):
        raise NotEvaluated("this value of on_exit is not evaluated", call.at)
    if composed := call.kwargs.get("composable_node_descriptions"):
        _load(
            visitor,
            Call(call.name, [], {"target_container": "", "composable_node_descriptions": composed}, call.at),
            context,
            when,
        )


def _load(visitor: ActionVisitor, call: Call, context: Context, when: bool | None) -> None:
    """Evaluate the nodes that a container loads."""
    visitor.findings.add_unknown("the nodes of a container are not supported", call.at)
    target = call.kwargs["target_container"]
    if when is not False and not (isinstance(target, Call) and is_a(target.name, ENTITY)):
        resolve(target, context, call.at)
    nodes = items_in(call.kwargs["composable_node_descriptions"])
    if nodes is None:
        raise LaunchFails("composable_node_descriptions has to be a list: put [ ] around it", call.at)
    for node in nodes:
        if not isinstance(node, Call) or not node.name.endswith("ComposableNode"):
            raise NotEvaluated("this composable node is not evaluated", call.at)
        visitor.evaluate_fields(node, context, both(when, holds(node, context)))


# What each kind of action does, besides the evaluation of its arguments and what EFFECTS lists.
KINDS: Mapping[str, Callable[[ActionVisitor, Call, Context, bool | None], None]] = {
    **dict.fromkeys(PROCESSES, _process), **dict.fromkeys(("TimerAction", "ROSTimer"), _timer),
    "IncludeLaunchDescription": _include, "LaunchDescription": _description, "GroupAction": _group,
    "RegisterEventHandler": _register, "OpaqueFunction": _opaque_function, "LoadComposableNodes": _load,
}  # fmt: skip
