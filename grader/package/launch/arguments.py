"""The constructors of launch's classes, and what they require of their arguments, as they check it themselves."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from grader.names import did_you_mean
from grader.package.launch.api import PROCESS, SOURCE, LaunchClass, class_named, exports, is_a
from grader.package.launch.model import not_evaluated
from grader.package.launch.substitutions import PERFORMS
from grader.package.launch.value_types import CHECKS, is_entity, is_text, items_in, kind_of, wrong_text, wrong_typed
from grader.python.evaluation import Evaluation, record
from grader.python.values import Call, EvaluationFails, Function, Items, Undetermined, Unknown, Value, iterate, known

_ACTIONS = (
    "Node", "ExecuteProcess", "LogInfo", "LaunchDescription", "DeclareLaunchArgument", "SetLaunchConfiguration",
    "GroupAction", "SetEnvironmentVariable", "AppendEnvironmentVariable", "IncludeLaunchDescription", "OpaqueFunction",
    "TimerAction", "RegisterEventHandler", "OnProcessExit", "OnProcessStart", "Shutdown", "EmitEvent",
    "PushROSNamespace", "SetParameter",
)  # fmt: skip
_OF_ONE_LIST = ("LaunchDescription", "PathJoinSubstitution", "GroupAction")


def _bind(cls: LaunchClass, call: Call) -> None:
    """Give the arguments of a constructor their names. Raises EvaluationFails as Python does."""
    positional = [name for name, it in cls.parameters.items() if it.is_positional]
    if len(call.args) > len(positional):
        names = ", ".join(f"{name}=..." for name in cls.parameters if name not in positional)
        hint = "put [ ] around them" if cls.short in _OF_ONE_LIST else f"write {names[:100]}"
        raise EvaluationFails(f"{cls.short} takes {len(positional)} argument without a name: {hint}", call.at)
    given = dict(zip(positional, call.args, strict=False))
    if twice := given.keys() & call.kwargs.keys():
        raise EvaluationFails(f"{cls.short} is given {min(twice)!r} twice", call.at)
    for name in (name for name in call.kwargs if name not in cls.parameters):
        message = f"{cls.short} has no argument {name!r}{did_you_mean(name, cls.parameters)}"
        raise EvaluationFails(message, call.at)
    kwargs = {**given, **call.kwargs}.items()
    call.args = []
    call.kwargs = {name: list(iterate(value)) if isinstance(value, Items) else value for name, value in kwargs}
    missing = [name for name, it in cls.parameters.items() if it.is_required and name not in call.kwargs]
    if missing:
        raise EvaluationFails(f"{cls.short} needs the argument {missing[0]}=...", call.at)


def check(cls: LaunchClass, call: Call) -> Unknown | None:
    """Name and check the arguments of a constructor; return what is not evaluated. Raises EvaluationFails."""
    if cls.short not in _EVALUATED and not is_a(cls.name, SOURCE):
        return Unknown(f"{cls.short} is not evaluated", call.at)
    _bind(cls, call)
    doubt: Unknown | None = None
    for name, value in [*call.kwargs.items(), ("", None)]:
        try:
            if message := _wrong(cls, call, name, value):
                raise EvaluationFails(message, call.at)
        except Undetermined as error:
            doubt = doubt or Unknown(str(error), call.at)
    return doubt


def _wrong(cls: LaunchClass, call: Call, name: str, value: Value) -> str:
    """Return what is wrong with an argument, or, without a name, with all together. Raises Undetermined."""
    if not name:
        message = _SPECIAL[cls.short](call) if cls.short in _SPECIAL else ""
        return f"{cls.short}: {message}" if message else ""
    test = cls.parameters[name].check
    own = CHECKS.get(test.removesuffix("?"))
    wanted = own(value) if own is not None and not (value is None and test.endswith("?")) else ""
    tail = "" if wanted.startswith("has a value") else f", not {kind_of(value)}"
    return f"{name} of {cls.short} {wanted}{tail}" if wanted else ""


def _declaration(call: Call) -> str:
    choices, default = call.kwargs.get("choices"), call.kwargs.get("default_value")
    if choices is not None and not items_in(choices):
        return "choices is empty, or no list"
    if isinstance(default, str) and choices is not None and default not in known(choices):
        return f"the default {default!r} of {call.kwargs['name']!r} is not one of its choices"
    return ""


def _include(call: Call) -> str:
    source, given = call.kwargs["launch_description_source"], call.kwargs.get("launch_arguments")
    if not (isinstance(source, Call) and is_a(source.name, SOURCE)) and (wrong := wrong_text(source)):
        return f"the first argument {wrong}, not {kind_of(source)}"
    if isinstance(given, dict):
        return "launch_arguments is given a dict: add .items() to it"
    return "launch_arguments takes pairs" if given is not None and items_in(given) is None else ""


def _opaque(call: Call) -> str:
    if not isinstance(call.kwargs["function"], Function) or not isinstance(
        call.kwargs.get("args"), list | tuple | None
    ):
        raise Undetermined("this OpaqueFunction")
    return ""


def _event_handler(call: Call) -> str:
    value, target = call.kwargs.get("on_exit", call.kwargs.get("on_start")), call.kwargs.get("target_action")
    items = value if isinstance(value, list) else [value]
    if not isinstance(value, Function) and not all(isinstance(it, Call) and is_entity(it) for it in items):
        raise Undetermined("what this event handler executes")
    if not isinstance(target, Call | None) or (target is not None and not is_a(target.name, PROCESS)):
        raise Undetermined("the target of this event handler")
    return ""


def _description(call: Call) -> str:
    actions = call.kwargs.get("initial_entities")
    return "put [ ] around the actions" if actions is not None and items_in(actions) is None else ""


def _text_substitution(call: Call) -> str:
    text = call.kwargs["text"]
    return "" if isinstance(text, str) or (is_text(text) and not isinstance(text, Call)) else f"text is {kind_of(text)}"


def _timer(call: Call) -> str:
    if not isinstance(call.kwargs["period"], float):
        raise Undetermined("a timer whose period is no decimal number")
    return ""


def _group(call: Call) -> str:
    if call.kwargs.keys() - {"actions", "scoped", "condition"} or not isinstance(call.kwargs.get("scoped", True), bool):
        raise Undetermined("what this group keeps")
    return ""


# The classes that are evaluated, besides the sources of included files; what is wrong with their arguments.
_EVALUATED = frozenset({*_ACTIONS, *PERFORMS, "IfCondition", "UnlessCondition", "ParameterValue", "LaunchContext"})
_SPECIAL: Mapping[str, Callable[[Call], str]] = {
    "DeclareLaunchArgument": _declaration, "OpaqueFunction": _opaque, "IncludeLaunchDescription": _include,
    "LaunchDescription": _description, "TextSubstitution": _text_substitution, "ParameterValue": wrong_typed,
    "GroupAction": _group, "TimerAction": _timer, **dict.fromkeys(("OnProcessExit", "OnProcessStart"), _event_handler),
}  # fmt: skip


class LaunchFunctions(dict[str, Any]):
    """The functions by full name, with every class of launch and its methods."""

    def get(self, name: str, default: Any = None) -> Any:
        """Return a function; None for one that is not evaluated."""
        found = super().get(name)
        return found if found is not None else _function_of(name) or default

    def __contains__(self, name: object) -> bool:
        return self.get(str(name)) is not None


def _function_of(name: str) -> "Callable[[Evaluation, Call], Value] | None":
    """Return the constructor of a class of launch, or one that fails: of a name that is not there."""
    owner, _, own = name.rpartition(".")
    names, cls = exports().get(owner), class_named(owner)
    if names is not None and own in names:
        made = class_named(names[own])
        return partial(_construct, made) if made is not None else None
    if names is not None or (cls is not None and own not in cls.methods and not own.startswith("_")):
        return partial(_fail, f"{cls.short if cls is not None else owner} has no {own!r}")
    return None


def _construct(cls: LaunchClass, evaluation: Evaluation, call: Call) -> Value:
    call.name = cls.name
    doubt = check(cls, call)
    if doubt is not None:
        evaluation.doubted(Unknown(not_evaluated(doubt.reason), doubt.at))
    return record(evaluation, call)


def _fail(message: str, *_: object) -> Value:
    raise EvaluationFails(message)
