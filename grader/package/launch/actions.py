"""What the actions of a launch description do as launch executes them: nodes, includes, arguments, timers, events."""

from collections.abc import Callable, Mapping
from dataclasses import replace

from grader.package.launch.api import SOURCE, is_a
from grader.package.launch.known_files import start_known_file
from grader.package.launch.model import ANY, Context, Resolved
from grader.package.launch.nodes import check_namespace, evaluate_node, evaluate_process, start_node, start_process
from grader.package.launch.parameters import evaluate_dict
from grader.package.launch.substitutions import known_text, resolve
from grader.package.launch.value_types import items_in, kind_of
from grader.package.launch.visitor import PROCESSES, ActionVisitor
from grader.python.parse import Position
from grader.python.values import (
    Call,
    EvaluationFails,
    EvaluationSignal,
    Function,
    QualifiedName,
    Undetermined,
    Unknown,
    Value,
)

CIRCULAR_INCLUDE = "it includes itself"
# By which packages, programs and files are found.
_SEARCHED = ("AMENT_PREFIX_PATH", "PATH", "PYTHONPATH", "LD_LIBRARY_PATH", "HOME")


def _description(visitor: ActionVisitor, call: Call, context: Context, when: bool | None) -> None:
    visitor.visit_all(call.kwargs.get("initial_entities") or [], call, context, when)
    for method in call.method_calls:
        if method.name.endswith((".add_action", ".add_entity")):
            visitor.visit_all([*method.args, *method.kwargs.values()], method, context, when)


def _declare(visitor: ActionVisitor, call: Call, context: Context, when: bool | None) -> None:
    del visitor
    name, choices, default = (call.kwargs.get(it) for it in ("name", "choices", "default_value"))
    if not isinstance(name, str):
        raise Undetermined("the name of this launch argument is not evaluated", call.at)
    if when is False:
        return
    is_given = name in context.given or (name in context.arguments and call.kwargs.get("condition") is not None)
    if default is None and not is_given:
        raise EvaluationFails(f"the launch argument {name!r} has no default, and no value is given", call.at)
    if name not in context.arguments:
        _set(name, default, call, context, when)
    value = context.arguments[name]
    if choices is not None and when:
        if not isinstance(value, str) or not isinstance(choices, list | tuple):
            raise Undetermined(f"whether {name!r} is one of its choices is not evaluated", call.at)
        if value not in choices:
            raise EvaluationFails(f"the value {value!r} of {name!r} is not one of its choices", call.at)


def _assign(visitor: ActionVisitor, call: Call, context: Context, when: bool | None) -> None:
    del visitor
    if when is not False:
        _set(known_text(call.kwargs["name"], context, call.at), call.kwargs["value"], call, context, when)


def _set(name: str, value: Value, call: Call, context: Context, when: bool | None) -> None:
    uncertain = Unknown(f"the launch argument {name!r} is set under a condition", call.at)
    try:
        context.arguments[name] = resolve(value, context, call.at) if when else uncertain
    except EvaluationSignal as signal:
        context.arguments[name] = Unknown(str(signal), signal.at or call.at)
        raise


def _environment(visitor: ActionVisitor, call: Call, context: Context, when: bool | None) -> None:
    del visitor
    variable = known_text(call.kwargs["name"], context, call.at) if when is not False else "X"
    if not variable or "=" in variable:
        raise EvaluationFails(f"an environment variable cannot be called {variable!r}", call.at)
    if variable in _SEARCHED:
        raise Undetermined(f"what is found with another {variable} is not evaluated", call.at)


def _namespace(visitor: ActionVisitor, call: Call, context: Context, when: bool | None) -> None:
    del visitor
    if when is not False:
        check_namespace(call.kwargs["namespace"], context, call.at)
        context.arguments["ros_namespace"] = Unknown("the namespace is not evaluated", call.at)


def _set_parameter(visitor: ActionVisitor, call: Call, context: Context, when: bool | None) -> None:
    visitor.findings.sets_parameters = True
    if when is not False:
        evaluate_dict({"": call.kwargs["value"]}, context, call.at)


def _nothing(visitor: ActionVisitor, call: Call, context: Context, when: bool | None) -> None:
    """Do nothing: its arguments are evaluated."""


def _shutdown(visitor: ActionVisitor, call: Call, context: Context, when: bool | None) -> None:
    del context
    if when is not False and not visitor.findings.is_silent:
        raise Undetermined("what a shutdown stops is not evaluated", call.at)


def _group(visitor: ActionVisitor, call: Call, context: Context, when: bool | None) -> None:
    """Visit a group: what it sets ends with it, unless scoped is False."""
    inner = context.copy() if call.kwargs.get("scoped", True) else context
    visitor.visit_all(call.kwargs["actions"], call, inner, when)


def _timer(visitor: ActionVisitor, call: Call, context: Context, when: bool | None) -> None:
    if when:
        visitor.later.append((call.kwargs["actions"], call, context, when))
    else:
        visitor.perhaps(call.kwargs["actions"], call, context, when)


def _register(visitor: ActionVisitor, call: Call, context: Context, when: bool | None) -> None:
    handler = call.kwargs["event_handler"]
    kind = handler.name.rpartition(".")[2] if isinstance(handler, Call) else ""
    if kind not in ("OnProcessExit", "OnProcessStart"):
        visitor.add_form(Undetermined("this event handler is not evaluated"), call.at, when)
        return
    value = handler.kwargs.get("on_exit", handler.kwargs.get("on_start"))
    actions = visitor.call_function(value, handler.at, None, context) if isinstance(value, Function) else value
    if kind == "OnProcessStart" and value is actions and when is not False:
        visitor.later.append((actions if isinstance(actions, list | tuple) else [actions], handler, context, None))
    elif not isinstance(actions, QualifiedName | None):
        visitor.perhaps(actions, handler, context, when)


def _opaque_function(visitor: ActionVisitor, call: Call, context: Context, when: bool | None) -> None:
    function, args = call.kwargs["function"], call.kwargs.get("args") or []
    if not isinstance(function, Function) or not isinstance(args, list | tuple) or call.kwargs.get("kwargs"):
        raise Undetermined("the result of this OpaqueFunction is not evaluated", call.at)
    if when is False:
        return
    arguments = (Call("launch.launch_context.LaunchContext", [], {}, call.at), *args)
    found = visitor.call_function(function, call.at, arguments if when else None, context)
    if isinstance(found, Unknown):
        visitor.findings.add(Undetermined(found.reason), found.at, when)
    elif found is not None:
        visitor.visit_all(found, call, context, when)


def _include(visitor: ActionVisitor, call: Call, context: Context, when: bool | None) -> None:
    if when is False:
        return
    source = call.kwargs["launch_description_source"]
    if isinstance(source, Call) and is_a(source.name, SOURCE):
        source = source.kwargs.get("launch_file_path", Unknown("this launch description is not evaluated", call.at))
    given = _launch_arguments(call.kwargs.get("launch_arguments"), context, call.at)
    path = known_text(source, context, call.at)
    arguments = {**context.arguments, **given}
    inner = replace(context, path=path, arguments=arguments, when=when, reads=[], given=frozenset(given))
    reason = visitor.include(path, inner)
    if reason and not start_known_file(visitor.findings, path, call, inner):
        visitor.findings.refer("include", path, call)
        if reason == CIRCULAR_INCLUDE:
            raise EvaluationFails(reason, call.at)
        visitor.findings.add_unknown(reason, call.at)
    elif not reason:
        visitor.findings.refer("include", path, call)
    context.arguments.update(inner.arguments)  # an included file shares its arguments with the actions that follow
    if reason:
        context.arguments[ANY] = Unknown(reason, call.at)


def _launch_arguments(given: Value, context: Context, at: Position) -> dict[str, Resolved]:
    """Return the launch arguments that an include passes on. Raises EvaluationSignal."""
    pairs = items_in(given) if given is not None else []
    found: dict[str, Resolved] = {}
    for pair in pairs or ():
        if not isinstance(pair, list | tuple) or len(pair) != 2:
            raise Undetermined("launch_arguments that are no pairs are not evaluated", at)
        for part in pair:
            if not isinstance(part, str | Call | Unknown | list | tuple):
                raise EvaluationFails(f"the value of a launch argument is {kind_of(part)}, not a string", at)
        found[known_text(pair[0], context, at)] = resolve(pair[1], context, at)
    return found


def _process(visitor: ActionVisitor, call: Call, context: Context, when: bool | None) -> None:
    """Start a process, which an action can do once only."""
    before, visitor.executed[id(call)] = visitor.executed.get(id(call), False), when
    start, evaluate = (start_node, evaluate_node) if "executable" in call.kwargs else (start_process, evaluate_process)
    start(visitor.findings, call, context, when)
    if when is not False and before is not False:
        message = f"the same {call.name.rpartition('.')[2]} is executed twice: make two of them"
        raise EvaluationFails(message, call.at) if before and when else Undetermined(message, call.at)
    if when is not False:
        evaluate(call, context)
    on_exit = call.kwargs.get("on_exit")
    if isinstance(on_exit, list):
        visitor.perhaps(on_exit, call, context, when)
    elif not isinstance(on_exit, Function | Call | Unknown | QualifiedName | None):
        raise Undetermined("this value of on_exit is not evaluated", call.at)


# What each kind of action does, besides the evaluation of its arguments.
KINDS: Mapping[str, Callable[[ActionVisitor, Call, Context, bool | None], None]] = {
    **dict.fromkeys(PROCESSES, _process), "LogInfo": _nothing, "LaunchDescription": _description,
    "DeclareLaunchArgument": _declare, "SetLaunchConfiguration": _assign, "GroupAction": _group,
    **dict.fromkeys(("SetEnvironmentVariable", "AppendEnvironmentVariable"), _environment),
    "IncludeLaunchDescription": _include, "OpaqueFunction": _opaque_function, "TimerAction": _timer,
    "RegisterEventHandler": _register, **dict.fromkeys(("Shutdown", "EmitEvent"), _shutdown),
    "PushROSNamespace": _namespace, "SetParameter": _set_parameter,
}  # fmt: skip
