"""What actions of a launch description change: launch configurations, the environment, parameters of all nodes."""

from collections.abc import Callable, Mapping

from grader.package.launch.model import Context, Findings, LaunchFails, LaunchSignal, NotEvaluated, Resolved
from grader.package.launch.nodes import absolute_namespace
from grader.package.launch.parameters import evaluate_dict
from grader.package.launch.substitutions import known_text, resolve
from grader.package.launch.value_types import kind_of
from grader.static_python.values import Call, Unknown, Value

_SEARCHED = ("AMENT_PREFIX_PATH", "PATH", "PYTHONPATH", "LD_LIBRARY_PATH")  # by which packages and programs are found


def _declare(findings: Findings, call: Call, context: Context, when: bool | None) -> None:
    del findings
    name, choices = call.kwargs["name"], call.kwargs.get("choices")
    if not isinstance(name, str):
        raise NotEvaluated("the name of this launch argument is not evaluated", call.at)
    if when is False:
        return
    default = call.kwargs.get("default_value")
    is_given = name in context.given or (name in context.arguments and call.kwargs.get("condition") is not None)
    if default is None and not is_given:
        raise LaunchFails(f"the launch argument {name!r} has no default, and no value is given", call.at)
    if name not in context.arguments:
        _set(name, default, call, context, when)
    value = context.arguments[name]
    if choices is not None and when:
        if not isinstance(value, str) or not isinstance(choices, list | tuple):
            raise NotEvaluated(f"whether {name!r} is one of its choices is not evaluated", call.at)
        if value not in choices:
            raise LaunchFails(f"the value {value!r} of {name!r} is not one of its choices", call.at)


def _assign(findings: Findings, call: Call, context: Context, when: bool | None) -> None:
    del findings
    if when is not False:
        _set(known_text(call.kwargs["name"], context, call.at), call.kwargs["value"], call, context, when)


def _set(name: str, value: Value, call: Call, context: Context, when: bool | None) -> None:
    uncertain = Unknown(f"the launch argument {name!r} is set under a condition", call.at)
    try:
        context.arguments[name] = resolve(value, context, call.at) if when else uncertain
    except LaunchSignal as signal:
        context.arguments[name] = Unknown(str(signal), signal.at)
        raise


def _unset(findings: Findings, call: Call, context: Context, when: bool | None) -> None:
    del findings
    if when:
        context.arguments.pop(known_text(call.kwargs["name"], context, call.at), None)
    elif when is None:
        raise NotEvaluated("a launch argument that is unset under a condition is not evaluated", call.at)


def _environment(findings: Findings, call: Call, context: Context, when: bool | None) -> None:
    del findings
    if when is False:
        return
    name, value = (call.kwargs.get(it) for it in ("name", "value"))
    variable = known_text(name, context, call.at)
    if (not variable or "=" in variable) and not call.name.endswith("UnsetEnvironmentVariable"):
        raise LaunchFails(f"an environment variable cannot be called {variable!r}", call.at)
    is_set = call.name.endswith("SetEnvironmentVariable") and when
    found: Resolved | None = resolve(value, context, call.at) if is_set else None
    if not is_set and not (call.name.endswith("UnsetEnvironmentVariable") and when):
        found = Unknown("the environment is not evaluated", call.at)
    context.environment[variable] = found
    if variable in _SEARCHED and not call.name.endswith("AppendEnvironmentVariable"):
        raise NotEvaluated(f"what is found with another {variable} is not evaluated", call.at)


def _push(findings: Findings, call: Call, context: Context, when: bool | None) -> None:
    del findings
    if when is None:
        raise NotEvaluated("what is pushed under a condition is not evaluated", call.at)
    if when:
        context.around.pushed.append(context.copy())


def _pop(findings: Findings, call: Call, context: Context, when: bool | None) -> None:
    del findings
    if when is None:
        raise NotEvaluated("what is popped under a condition is not evaluated", call.at)
    if when and not context.around.pushed:
        raise LaunchFails("nothing has been pushed before", call.at)
    if when:
        kept = context.around.pushed.pop()
        context.arguments, context.environment = kept.arguments, kept.environment


def _reset(findings: Findings, call: Call, context: Context, when: bool | None) -> None:
    del findings
    given = call.kwargs.get("launch_configurations")
    own = {} if given is None else given
    if when is None:
        raise NotEvaluated("what is reset under a condition is not evaluated", call.at)
    if not isinstance(own, dict):
        raise LaunchFails(f"launch_configurations is {kind_of(own)}, not a dict", call.at)
    kept = {known_text(name, context, call.at): resolve(value, context, call.at) for name, value in own.items()}
    if when:
        context.arguments.clear()
        context.arguments.update(kept)


def _namespace(findings: Findings, call: Call, context: Context, when: bool | None) -> None:
    del findings
    if when is not False:
        pushed = known_text(call.kwargs["namespace"], context, call.at)
        full = absolute_namespace(context.arguments.get("ros_namespace", ""), pushed, call.at)
        context.arguments["ros_namespace"] = full if when else Unknown("the namespace is not evaluated", call.at)


def _set_parameter(findings: Findings, call: Call, context: Context, when: bool | None) -> None:
    findings.sets_parameters = True
    if when is not False and "value" in call.kwargs:
        evaluate_dict({"": call.kwargs["value"]}, context, call.at)
    elif when:
        found = resolve(call.kwargs["filename"], context, call.at)
        raise NotEvaluated(f"whether {found if isinstance(found, str) else 'a file'} exists is not evaluated", call.at)


def _sim_time(findings: Findings, call: Call, context: Context, when: bool | None) -> None:
    del findings, context
    value = call.kwargs["value"]
    if when is not False and not isinstance(value, bool):
        unknown = isinstance(value, Unknown)
        raise (NotEvaluated if unknown else LaunchFails)("SetUseSimTime takes True or False, in Python only", call.at)


def _shutdown(findings: Findings, call: Call, context: Context, when: bool | None) -> None:
    del findings, context
    event = call.kwargs.get("event")
    if when is not False and not (isinstance(event, Call) and not event.name.endswith("Shutdown")):
        raise NotEvaluated("what a shutdown stops is not evaluated", call.at)


# What each kind of action changes.
EFFECTS: Mapping[str, Callable[[Findings, Call, Context, bool | None], None]] = {
    "DeclareLaunchArgument": _declare, "SetLaunchConfiguration": _assign, "UnsetLaunchConfiguration": _unset,
    **dict.fromkeys(("SetEnvironmentVariable", "AppendEnvironmentVariable", "UnsetEnvironmentVariable"), _environment),
    **dict.fromkeys(("PushLaunchConfigurations", "PushEnvironment"), _push), "ResetLaunchConfigurations": _reset,
    **dict.fromkeys(("PopLaunchConfigurations", "PopEnvironment"), _pop), "PushROSNamespace": _namespace,
    **dict.fromkeys(("SetParameter", "SetParametersFromFile"), _set_parameter), "SetUseSimTime": _sim_time,
    **dict.fromkeys(("Shutdown", "EmitEvent"), _shutdown),
}  # fmt: skip
