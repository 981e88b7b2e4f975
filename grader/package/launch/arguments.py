"""What the constructors of launch's classes require of their arguments, as they check it themselves."""

from collections.abc import Callable, Mapping
from pathlib import PurePosixPath

from grader.names import did_you_mean
from grader.package.launch.api import ACTION, PROCESS, SOURCE, LaunchClass, is_a
from grader.package.launch.value_types import (
    CHECKS,
    gives_text,
    is_entity,
    is_text,
    items_in,
    kind_of,
    wrong_text,
    wrong_typed,
)
from grader.static_python.knowledge import iterate
from grader.static_python.values import (
    UNKNOWN_KEYS,
    Call,
    ExpressionFails,
    Function,
    Items,
    QualifiedName,
    Undetermined,
    Unknown,
)

_OF_ONE_LIST = ("LaunchDescription", "PathJoinSubstitution", "GroupAction")


def bind(cls: LaunchClass, call: Call) -> None:
    """Give the arguments of a constructor their names. Raises ExpressionFails as Python does, and Undetermined."""
    positional = [name for name, it in cls.parameters.items() if it.is_positional]
    if UNKNOWN_KEYS in call.kwargs:
        raise Undetermined(f"the arguments of {cls.short}, which ** unpacks,")
    if len(call.args) > len(positional) and not cls.rest:
        names = ", ".join(f"{name}=..." for name in cls.parameters if name not in positional)
        hint = "put [ ] around them" if cls.short in _OF_ONE_LIST else f"write {names[:100]}"
        raise ExpressionFails(f"{cls.short} takes {len(positional)} argument without a name: {hint}")
    given = dict(zip(positional, call.args, strict=False))
    if twice := given.keys() & call.kwargs.keys():
        raise ExpressionFails(f"{cls.short} is given {min(twice)!r} twice")
    for name in (name for name in call.kwargs if name not in cls.parameters):
        message = f"{cls.short} has no argument {name!r}{did_you_mean(name, cls.parameters)}"
        raise ExpressionFails(message)
    kwargs = {**given, **call.kwargs}.items()
    call.args = call.args[len(positional) :]
    call.kwargs = {name: list(iterate(value)) if isinstance(value, Items) else value for name, value in kwargs}
    missing = [name for name, it in cls.parameters.items() if it.is_required and name not in call.kwargs]
    if missing:
        raise ExpressionFails(f"{cls.short} needs the argument {missing[0]}=...")


def check(cls: LaunchClass, call: Call) -> Unknown | None:
    """Check the arguments of a constructor; return the first that is not known. Raises ExpressionFails."""
    doubt: Unknown | None = None
    is_late = cls.short == "ResetLaunchConfigurations"  # which takes anything until it is executed
    pairs = [(name, cls.parameters[name].check, value) for name, value in call.kwargs.items() if not is_late]
    for name, test, value in [*pairs, *((cls.rest, "text", value) for value in call.args)]:
        optional, own = test.endswith("?"), CHECKS.get(test.removesuffix("?"))
        try:
            if own is not None and not (value is None and optional) and (wanted := own(value)):
                tail = "" if wanted.startswith("has a value") else f", not {kind_of(value)}"
                raise ExpressionFails(f"{name} of {cls.short} {wanted}{tail}")
        except Undetermined as error:
            doubt = doubt or Unknown(str(error), call.at)
    special = _SPECIAL.get(cls.short)
    try:
        if special is not None and (message := special(call)):
            raise ExpressionFails(f"{cls.short}: {message}")
    except Undetermined as error:
        doubt = doubt or Unknown(str(error), call.at)
    return doubt


def _declaration(call: Call) -> str:
    choices, default = call.kwargs.get("choices"), call.kwargs.get("default_value")
    if choices is not None and not isinstance(choices, Unknown) and not items_in(choices):
        return "choices is empty, or no list"
    known = (
        choices if isinstance(choices, list | tuple) and not any(isinstance(it, Unknown) for it in choices) else None
    )
    if known is not None and isinstance(default, str) and default not in known:
        return f"the default {default!r} of {call.kwargs['name']!r} is not one of its choices"
    return ""


def _timer(call: Call) -> str:
    period = call.kwargs["period"]
    if isinstance(period, str):
        try:
            float(period)
        except ValueError:
            return f"period is {period!r}, not a number"
    return ""


def _include(call: Call) -> str:
    source, given = call.kwargs["launch_description_source"], call.kwargs.get("launch_arguments")
    if not (isinstance(source, Call) and is_a(source.name, SOURCE)) and (wrong := wrong_text(source)):
        return f"the first argument {wrong}, not {kind_of(source)}"
    if isinstance(given, dict):
        return "launch_arguments is given a dict: add .items() to it"
    return "launch_arguments takes pairs" if given is not None and items_in(given) is None else ""


def _opaque(call: Call) -> str:
    function, args = call.kwargs["function"], call.kwargs.get("args")
    if isinstance(function, Unknown):
        raise Undetermined(function.reason)
    if not isinstance(function, Function | QualifiedName) and not callable(function):
        return f"function is {kind_of(function)}, not a function"
    if not isinstance(call.kwargs.get("kwargs"), dict | Unknown | None):
        return "kwargs has to be a dict"
    return "args has to be a list" if args is not None and items_in(args) is None else ""


def _event_handler(call: Call) -> str:
    for name, value in call.kwargs.items():
        if name in ("on_exit", "on_start", "on_completion") and not isinstance(value, Function | QualifiedName | None):
            items = [value] if isinstance(value, Call) else items_in(value) or [value]
            wrong = [it for it in items if not isinstance(it, Unknown) and not (isinstance(it, Call) and is_entity(it))]
            if wrong:
                return f"expected an action, found {kind_of(wrong[0])} in {name}"
    target = call.kwargs.get("target_action")
    if isinstance(target, Unknown):
        raise Undetermined(target.reason)
    if isinstance(target, Function | QualifiedName):
        raise Undetermined("the events that a function chooses")
    kind = ACTION if call.name.endswith("OnExecutionComplete") else PROCESS
    is_other = isinstance(target, Call) and not is_a(target.name, kind)
    if is_other or not isinstance(target, Call | Function | QualifiedName | None):
        return f"target_action is {kind_of(target)}, not {'an action' if kind == ACTION else 'a node or process'}"
    return ""


def _description(call: Call) -> str:
    actions = call.kwargs.get("initial_entities")
    return "put [ ] around the actions" if actions is not None and items_in(actions) is None else ""


def _load(call: Call) -> str:
    target = call.kwargs["target_container"]
    is_action = isinstance(target, Call) and is_a(target.name, PROCESS)
    wrong = "" if is_action else wrong_text(target)
    return wrong and f"target_container {wrong}"


def _shutdown_handler(call: Call) -> str:
    value = call.kwargs["on_shutdown"]
    if not isinstance(value, Function) and not all(
        isinstance(it, Call) and is_entity(it) for it in items_in(value) or [value]
    ):
        raise Undetermined(f"what {kind_of(value)} does at the end")
    return ""


def _text_substitution(call: Call) -> str:
    text = call.kwargs["text"]
    return (
        ""
        if isinstance(text, str) or (is_text(text) and gives_text(text.name))
        else f"text is {kind_of(text)}, not a string"
    )


def _parameter_file(call: Call) -> str:
    file, allow = call.kwargs["param_file"], call.kwargs.get("allow_substs", False)
    wrong = "" if isinstance(file, PurePosixPath) else wrong_text(file)
    return wrong or ("" if isinstance(allow, bool | Unknown) else "allow_substs takes True or False")


def _if_else(call: Call) -> str:
    values = [call.kwargs.get(name, "") for name in ("if_value", "else_value")]
    return "one of if_value and else_value is needed" if values == ["", ""] else ""


_SPECIAL: Mapping[str, Callable[[Call], str]] = {
    "DeclareLaunchArgument": _declaration, "TimerAction": _timer, "ROSTimer": _timer, "OpaqueFunction": _opaque,
    "IncludeLaunchDescription": _include, "LaunchDescription": _description, "TextSubstitution": _text_substitution,
    "ParameterFile": _parameter_file, "IfElseSubstitution": _if_else,
    "ParameterValue": wrong_typed, "LoadComposableNodes": _load, "OnShutdown": _shutdown_handler,
    **dict.fromkeys(("OnProcessExit", "OnProcessStart", "OnProcessIO", "OnExecutionComplete"), _event_handler),
}  # fmt: skip
