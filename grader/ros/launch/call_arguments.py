"""The constructors of launch's classes, and what they require of their arguments.

They check it themselves.

An argument is a text (a string or substitutions), a list of them, a parameter of a node, and so on:
`_CHECKS` has a check of each kind, which returns what is wrong.
"""

from ast import expr, unparse
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import PurePosixPath
from typing import Any

from grader.base.grouping import as_list
from grader.base.names import did_you_mean
from grader.base.records import Named
from grader.ros.launch.launch_classes import (
    ENTITY,
    JOINED_PATH,
    PROCESS,
    SOURCE,
    SUBSTITUTION,
    LaunchClass,
    class_named,
    exports,
    is_a,
)
from grader.ros.launch.launch_model import UnknownText, not_evaluated
from grader.ros.launch.substitutions import CONDITIONS, PERFORMS, listed
from grader.ros.python.evaluation import Evaluation, record
from grader.ros.python.parse import make_position
from grader.ros.python.values import (
    VIEWS,
    BoundMethod,
    Call,
    EvaluationFails,
    Function,
    Items,
    QualifiedName,
    Undetermined,
    Unknown,
    UnknownArgument,
    Value,
    iterate,
    known,
)

SCALARS = (bool, int, float, str)
TYPED = (
    "launch_ros.parameter_descriptions.ParameterValue",
    "launch_ros.parameter_descriptions.Parameter",
)
FILE = "launch_ros.parameter_descriptions.ParameterFile"
# What is no text yet: the calls that give it, and what is missing.
OPENED = {
    "builtins.open": "an open file: add .read()",
    "xacro.process_file": "a document, not its text: add .toxml()",
    "xacro.parse": "a document, not its text: add .toxml()",
}
_COLLECTIONS = (list, tuple, dict, set, frozenset, *VIEWS)
_NAMES = {
    type(None): "None",
    bool: "a boolean",
    int: "a number",
    float: "a number",
    dict: "a dict",
    Function: "a function",
    BoundMethod: "a method that is not called",
    UnknownText: "a text",
    Items: "an iterator",
}
_WANTED = {
    bool: "True, False",
    float: "a decimal number such as 2.0",
    int: "an integer",
    str: "a string",
}
_ACTIONS = (
    "Node",
    "ExecuteProcess",
    *("LogInfo", "Log", "LogDebug", "LogWarning", "LogError"),
    "LaunchDescription",
    "DeclareLaunchArgument",
    "DeclareBooleanLaunchArgument",
    "SetLaunchConfiguration",
    "GroupAction",
    "SetEnvironmentVariable",
    "AppendEnvironmentVariable",
    "IncludeLaunchDescription",
    "OpaqueFunction",
    "TimerAction",
    "RegisterEventHandler",
    "OnProcessExit",
    "OnProcessStart",
    "OnStateTransition",
    "Shutdown",
    "ChangeState",
    "EmitEvent",
    "LifecycleNode",
    "PushROSNamespace",
    "SetParameter",
    "SetParametersFromFile",
    "SetRemap",
    "SetUseSimTime",
    "ComposableNodeContainer",
    "LoadComposableNodes",
    "ComposableNode",
    "ComposableLifecycleNode",
)
_BOOLEAN_CHOICES = ("true", "false", "True", "False", "TRUE", "FALSE")
_TEXTUAL = ("text", "texts", "path", "mapping")  # the checks of what may be a substitution
_MAX_DEPTH = 20  # of lists in others
_TAKES_A_LIST = ("LaunchDescription", "PathJoinSubstitution", "GroupAction")
# The classes that are evaluated, besides the sources of included files; what is wrong with their
# arguments.
_EVALUATED = frozenset(
    {*_ACTIONS, *PERFORMS, *CONDITIONS, "ParameterValue", "ParameterFile", "LaunchContext"}
)
# The arguments that are kept as they are: of all others launch makes a copy when the object is
# made.
_KEPT_AS_IT_IS = {"GroupAction": "actions", "TimerAction": "actions", "OpaqueFunction": "args"}


PARTIAL = "functools.partial"


class LaunchFunctions(dict[str, Any]):
    """The functions by full name, with every class of launch and its methods."""

    def get(self, name: str, default: Any = None) -> Any:
        """Return a function; None for one that is not evaluated."""
        function = super().get(name)
        if function is not None:
            return function
        return _find_function(name) or default

    def __contains__(self, name: object) -> bool:
        return self.get(str(name)) is not None


def _find_function(name: str) -> "Callable[[Evaluation, Call], Value] | None":
    """Return the constructor of a class of launch, or one that fails.

    It fails for a name that is not there.
    """
    owner, _, member = name.rpartition(".")
    names = exports().get(owner)
    cls = class_named(owner)
    if names is not None and member in names:
        made = class_named(names[member])
        return partial(_record_constructor, made) if made else None
    if names is not None or (cls and member not in cls.methods and not member.startswith("_")):
        return partial(_fail_missing, f"{cls.short if cls else owner} has no {member!r}")
    return None


def _record_constructor(cls: LaunchClass, evaluation: Evaluation, call: Call) -> Value:
    call.name = cls.name
    doubt = check(cls, call)
    call.is_object = True
    for name in [name for name in call.kwargs if name != _KEPT_AS_IT_IS.get(cls.short)]:
        call.kwargs[name] = _copied(call.kwargs[name], evaluation)
    if doubt:
        reason = not_evaluated(doubt.reason)
        evaluation.doubted(Unknown(reason, doubt.at, follows_error=doubt.follows_error))
    return record(evaluation, call)


def join_path(evaluation: Evaluation, call: Call) -> Value:
    """Return the PathJoinSubstitution that `path / more` makes of a substitution for a path."""
    owner = call.owner
    cls = class_named(JOINED_PATH)
    assert owner
    assert cls
    before = listed(owner.kwargs["substitutions"]) if owner.name == JOINED_PATH else [owner]
    parts = [*before, *call.args]
    return _record_constructor(cls, evaluation, Call("", [parts], {}, call.at))


def texts_from_paths(cls: LaunchClass, call: Call) -> list[str]:
    """Return the arguments of a constructor that have to be texts, and are or have a path."""
    names = [name for name, row in cls.parameters.items() if row.check in _TEXTUAL]
    return [name for name in names if _has_path(call.kwargs.get(name))]


def _has_path(value: Value) -> bool:
    if isinstance(value, dict):
        value = list(value.values())
    return isinstance(value, PurePosixPath) or (
        isinstance(value, list | tuple) and any(map(_has_path, value))
    )


def _copied(value: Value, evaluation: Evaluation, depth: int = 0) -> Value:
    """Return a copy of the lists and dicts in a value."""
    if not isinstance(value, _COLLECTIONS) or depth > _MAX_DEPTH:
        return value
    evaluation.budget.charge(len(value))
    if isinstance(value, dict):
        return {key: _copied(item, evaluation, depth + 1) for key, item in value.items()}
    copies = [_copied(item, evaluation, depth + 1) for item in value]
    if isinstance(value, (list, *VIEWS)):
        return copies
    return type(value)(copies)


def _fail_missing(message: str, *_: object) -> Value:
    raise EvaluationFails(message)


def check(cls: LaunchClass, call: Call) -> Unknown | None:
    """Name and check the arguments of a constructor; return what is not evaluated.

    Raises EvaluationFails.
    """
    if cls.short not in _EVALUATED and not is_a(cls.name, SOURCE):
        return Unknown(f"{cls.short} is not evaluated", call.at)
    _name_arguments(cls, call)
    doubt = None
    for name, value in [*call.kwargs.items(), ("", None)]:
        try:
            if message := _wrong_argument(cls, call, name, value):
                raise EvaluationFails(message, call.at)
        except Undetermined as error:
            doubt = doubt or error.as_unknown(call.at)
    return doubt


def _name_arguments(cls: LaunchClass, call: Call) -> None:
    """Give the arguments of a constructor their names. Raises EvaluationFails as Python does."""
    given = _given_by_place(cls, call)
    twice = given.keys() & call.kwargs.keys()
    if twice:
        raise EvaluationFails(f"{cls.short} is given {min(twice)!r} twice", call.at)
    for name in call.kwargs:
        if name not in cls.parameters:
            message = f"{cls.short} has no argument {name!r}{did_you_mean(name, cls.parameters)}"
            raise UnknownArgument(message, call.at, name)
    given |= call.kwargs
    for name, value in given.items():
        if isinstance(value, Items):
            given[name] = list(iterate(value))
    call.args = []
    call.kwargs = given
    for name, row in cls.parameters.items():
        if row.is_required and name not in given:
            raise EvaluationFails(f"{cls.short} needs the argument {name}=...", call.at)


def _given_by_place(cls: LaunchClass, call: Call) -> dict[str, Value]:
    """Return the arguments of a call without a name, by their names. Raises EvaluationFails."""
    positional = [name for name, row in cls.parameters.items() if row.is_positional]
    if len(call.args) > len(positional):
        if cls.short in _TAKES_A_LIST:
            hint = "put [ ] around them"
        else:
            names = ", ".join(f"{name}=..." for name in cls.parameters if name not in positional)
            hint = f"write {names[:100]}"
        raise EvaluationFails(
            f"{cls.short} takes {len(positional)} argument without a name: {hint}", call.at
        )
    return dict(zip(positional, call.args, strict=False))


class _Fault(Named):
    """What is wrong with an argument, after its name."""

    message: str
    is_of_part: bool = False  # whether it says what is wrong inside the argument, and what that is


_Wrong = _Fault | None
_NO_LIST = _Fault("has to be a list: put [ ] around it")


def _wrong_argument(cls: LaunchClass, call: Call, name: str, value: Value) -> str:
    """Return what is wrong with an argument, or, without a name, with all together.

    Raises Undetermined.
    """
    if bound := _find_bound(value):
        text = unparse(bound)[:60]
        raise EvaluationFails(f"{text} without (): write {text}()", make_position(bound))
    if not name:
        message = _SPECIAL[cls.short](call) if cls.short in _SPECIAL else ""
        return f"{cls.short}: {message}" if message else ""
    parameter = cls.parameters[name]
    find_error = _CHECKS.get(parameter.check)
    if find_error is None or (value is None and parameter.can_be_none):
        return ""
    fault = find_error(value)
    if fault is None:
        return ""
    if fault.is_of_part:
        return f"{name} of {cls.short} {fault.message}"
    return f"{name} of {cls.short} {fault.message}, not {describe_kind(value)}"


def _find_bound(value: Value) -> expr | None:
    """Return the expression of a method in a value that is not called.

    Raises Undetermined for what may be a property of an object of launch.
    """
    if isinstance(value, list | tuple | dict):
        items = value.values() if isinstance(value, dict) else value
        return next(filter(None, map(_find_bound, items)), None)
    match value:
        case BoundMethod(owner=Call(name=name)) if class_named(name):
            raise Undetermined(f"the value of {value.name}")
        case BoundMethod():
            return value.node
    return None


def _is_text(value: Value) -> bool:
    """Return whether a value is a string or a substitution. Raises Undetermined."""
    match value:
        case UnknownText():
            return True
        case Unknown():
            raise value.as_signal()
        case QualifiedName():
            raise Undetermined(f"the value of {value.name}")
        case PurePosixPath():  # since launch 3.4.10
            return True
        case Call() if class_named(value.name):
            return is_a(value.name, SUBSTITUTION)
        case Call() if value.name not in OPENED:
            raise Undetermined(f"the result of {value.name}")
    return isinstance(value, str)


def _is_entity(call: Call) -> bool:
    """Return whether a call makes an action, or a description of some. Raises Undetermined."""
    if not class_named(call.name):
        raise Undetermined(f"the result of {call.name}")
    return is_a(call.name, ENTITY)


def items_in(value: Value) -> list[Value] | None:
    """Return what iterating over a value gives; None where Python cannot. Raises Undetermined."""
    if isinstance(value, Unknown):
        raise value.as_signal()
    if isinstance(value, Call) and not class_named(value.name):
        raise Undetermined(f"the result of {value.name}")
    if isinstance(value, Items):
        return list(iterate(value))
    kinds = (*_COLLECTIONS, str, range)
    return list(value) if isinstance(value, kinds) else None


def _wrong_text(value: Value) -> _Wrong:
    """Return what is wrong with a value that has to be a text. Raises Undetermined."""
    if isinstance(value, _COLLECTIONS):
        for item in value:
            if not _is_text(item):
                return _wrong_in(item)
        return None
    if _is_text(value):
        return None
    return _Fault("takes a string or a substitution")


def _wrong_in(item: Value) -> _Fault:
    """Return what is wrong with a list that has an item which is no text."""
    hint = f": write '{item}'" if type(item) in (int, float) else ""
    return _Fault(f"has an item that is {describe_kind(item)}{hint}", is_of_part=True)


def _first_fault(faults: Iterable[_Wrong]) -> _Wrong:
    return next((fault for fault in faults if fault), None)


def describe_kind(value: Value) -> str:
    """Return what a value is, in words."""
    if isinstance(value, Call):
        return OPENED.get(value.name, f"{value.short}(...)")
    if isinstance(value, PurePosixPath):
        return "a path: write str(...) around it"
    return _NAMES.get(type(value), f"a {type(value).__name__}")


def _check_of_type(kind: type) -> Callable[[Value], _Wrong]:
    """Return the check of a value of a type, or of a substitution whose text is read as one."""
    fault = _Fault(f"takes {_WANTED[kind]} or a substitution")

    def checked(value: Value) -> _Wrong:
        if isinstance(value, str | int | float):
            return None if isinstance(value, kind) else fault
        if isinstance(value, list | tuple) and any(
            isinstance(item, Call | Unknown) for item in value
        ):
            return _wrong_text(value)
        if not isinstance(value, _COLLECTIONS) and _is_text(value):
            return None
        return fault

    return checked


def _wrong_parameters(value: Value) -> _Wrong:
    """Return what is wrong with the parameters of a node. Raises Undetermined."""
    if isinstance(value, Unknown):
        raise value.as_signal()
    if not isinstance(value, list):
        return _NO_LIST
    return _first_fault(map(_wrong_item, value))


def _wrong_item(item: Value) -> _Wrong:
    if isinstance(item, PurePosixPath) or (isinstance(item, Call) and item.name in (*TYPED, FILE)):
        return None
    if isinstance(item, dict):
        return _wrong_dict(item)
    return _wrong_text(item)


def _wrong_dict(table: dict[Any, Value]) -> _Wrong:
    for key, value in table.items():
        fault = _wrong_text(key) or _wrong_parameter(value)
        if fault:
            return fault
    return None


def _wrong_parameter(value: Value) -> _Wrong:
    """Return what is wrong with the value of a parameter. Raises Undetermined."""
    match value:
        case dict():
            return _wrong_dict(value)
        case list() | tuple() | range():
            items = [item for item in value if not isinstance(item, SCALARS)]
            # launch_ros reads these, which takes no paths
            wrong = [_wrong_in(item) for item in items if isinstance(item, PurePosixPath)]
            return _first_fault([*wrong, *map(_wrong_text, items)])
    is_right = isinstance(value, str | int | float | bytes)
    is_right = is_right or (isinstance(value, Call) and value.name in TYPED)
    if is_right or (not isinstance(value, PurePosixPath) and _is_text(value)):
        return None
    return _Fault(f"has a value that is {describe_kind(value)}", is_of_part=True)


def _wrong_typed(call: Call) -> str:
    """Return what is wrong with the value of ParameterValue, or nothing. Raises Undetermined."""
    value = call.kwargs["value"]
    kind = read_type(call)
    if isinstance(value, UnknownText):
        return "" if kind in (None, str) else "the value is a text"
    if isinstance(value, SCALARS):
        if kind is None or isinstance(value, kind):
            return ""
        return f"the value is {describe_kind(value)}, not {kind.__name__}"
    if isinstance(value, list | tuple) and not any(
        isinstance(element, Call | Unknown) for element in value
    ):
        is_wrong = kind is not None or not all(isinstance(element, SCALARS) for element in value)
        return f"the value is {describe_kind(value)}" if is_wrong else ""
    fault = _wrong_text(value)
    return fault.message if fault else ""


def read_type(call: Call) -> "type | None":
    """Return the type that ParameterValue is given; None for none.

    Raises Undetermined for the type of a list.
    """
    given = call.kwargs.get("value_type")
    if given is None:
        return None
    name = getattr(given, "name", "").removeprefix("builtins.")
    scalar = {kind.__name__: kind for kind in SCALARS}.get(name)
    if scalar is None:
        raise Undetermined(f"the type {name}")
    return scalar


def _wrong_texts(value: Value) -> _Wrong:
    items = items_in(value)
    if items is None:
        return _NO_LIST
    for item in items:
        if not isinstance(item, _COLLECTIONS) and not _is_text(item):
            return _wrong_in(item)
    return _first_fault(map(_wrong_text, items))


def _wrong_path(value: Value) -> _Wrong:
    """Return what is wrong with the parts of a path: each is a text, or a list of its parts."""
    if not isinstance(value, list | tuple):
        return _wrong_text(value)
    for part in value:
        if not isinstance(part, list | tuple) and not _is_text(part):
            return _wrong_in(part)
    return _first_fault(map(_wrong_text, value))


def _wrong_boolean_text(value: Value) -> _Wrong:
    return None if isinstance(value, bool) else _wrong_text(value)


def _wrong_mapping(value: Value) -> _Wrong:
    if isinstance(value, dict):
        return _first_fault(_wrong_text(item) for pair in value.items() for item in pair)
    items_in(value)  # raises Undetermined for what may be a dict
    return _Fault("has to be a dict")


def _wrong_period(value: Value) -> _Wrong:
    if isinstance(value, str):  # is read as a number
        return None
    return _check_of_type(float)(value)


def _wrong_actions(value: Value) -> _Wrong:
    if items_in(value) is None:
        return _Fault("takes a list of actions: put [ ] around them")
    return None


def _wrong_remappings(value: Value) -> _Wrong:
    rules = items_in(value)
    if rules is None:
        return _NO_LIST
    for rule in rules:
        if isinstance(rule, Unknown):
            raise rule.as_signal()
        if not isinstance(rule, tuple) or len(rule) != 2:
            return _Fault("takes pairs: ('from', 'to')")
        fault = _wrong_text(rule[0]) or _wrong_text(rule[1])
        if fault:
            return fault
    return None


_CHECKS = {
    "text": _wrong_text,
    "texts": _wrong_texts,
    "path": _wrong_path,
    "mapping": _wrong_mapping,
    "bool": _check_of_type(bool),
    "boolean text": _wrong_boolean_text,
    "float": _wrong_period,
    "remappings": _wrong_remappings,
    "actions": _wrong_actions,
    "parameters": _wrong_parameters,
    "parameter": _wrong_parameter,
}


def _wrong_declaration(call: Call) -> str:
    choices = call.kwargs.get("choices")
    default = call.kwargs.get("default_value")
    if choices is not None and not items_in(choices):
        return "choices is empty, or no list"
    if isinstance(default, str) and choices is not None and default not in known(choices):
        return f"the default {default!r} of {call.kwargs['name']!r} is not one of its choices"
    return ""


def _wrong_include(call: Call) -> str:
    source = call.kwargs["launch_description_source"]
    given = call.kwargs.get("launch_arguments")
    if not (isinstance(source, Call) and is_a(source.name, SOURCE)):
        fault = _wrong_text(source)
        if fault:
            return f"the first argument {fault.message}, not {describe_kind(source)}"
    if isinstance(given, dict) and not all(isinstance(key, str) and len(key) == 2 for key in given):
        # Python takes a key of two letters for a pair
        return "launch_arguments is given a dict: add .items() to it"
    if given is not None and items_in(given) is None:
        return "launch_arguments takes pairs"
    return ""


def _wrong_opaque_function(call: Call) -> str:
    function = call.kwargs["function"]
    args = call.kwargs.get("args")
    is_partial = isinstance(function, Call) and function.name == PARTIAL
    if not (isinstance(function, Function) or is_partial) or not isinstance(
        args, list | tuple | None
    ):
        raise Undetermined("this OpaqueFunction")
    return ""


def _wrong_event_handler(call: Call) -> str:
    value = call.kwargs.get("on_exit", call.kwargs.get("on_start"))
    target = call.kwargs.get("target_action")
    items = as_list(value)
    if not isinstance(value, Function) and not all(
        isinstance(handler, Call) and _is_entity(handler) for handler in items
    ):
        raise Undetermined("what this event handler executes")
    if isinstance(target, str | list | dict | int | float):
        return f"target_action is {describe_kind(target)}, not an action such as Node(...)"
    if not isinstance(target, Call | None) or (target and not is_a(target.name, PROCESS)):
        raise Undetermined("the target of this event handler")
    return ""


def _wrong_description(call: Call) -> str:
    actions = call.kwargs.get("initial_entities")
    if actions is not None and items_in(actions) is None:
        return "put [ ] around the actions"
    return ""


def _wrong_text_substitution(call: Call) -> str:
    text = call.kwargs["text"]
    if isinstance(text, str) or (_is_text(text) and not isinstance(text, Call)):
        return ""
    return f"text is {describe_kind(text)}"


def _wrong_timer(call: Call) -> str:
    """Return what is wrong with the period: a string is read as a number when the timer is made."""
    if isinstance(call.kwargs["period"], str):
        try:
            call.kwargs["period"] = float(call.kwargs["period"])
        except ValueError:
            return f"the period {call.kwargs['period'][:40]!r} is no number"
    return ""


def _wrong_group(call: Call) -> str:
    given = call.kwargs
    others = given.keys() - {
        "actions",
        "scoped",
        "forwarding",
        "launch_configurations",
        "condition",
    }
    flags = [given.get(name, True) for name in ("scoped", "forwarding")]
    if others or not all(isinstance(flag, bool) for flag in flags):
        raise Undetermined("what this group keeps")
    return ""


def _wrong_boolean(call: Call) -> str:
    """Return nothing: the class itself makes a text of the default, and gives the choices."""
    default = call.kwargs.get("default_value")
    if isinstance(default, bool):
        call.kwargs["default_value"] = str(default)
    call.kwargs["choices"] = list(_BOOLEAN_CHOICES)
    return _wrong_declaration(call)


_SPECIAL = {
    "DeclareLaunchArgument": _wrong_declaration,
    "DeclareBooleanLaunchArgument": _wrong_boolean,
    "OpaqueFunction": _wrong_opaque_function,
    "IncludeLaunchDescription": _wrong_include,
    "LaunchDescription": _wrong_description,
    "TextSubstitution": _wrong_text_substitution,
    "ParameterValue": _wrong_typed,
    "GroupAction": _wrong_group,
    "TimerAction": _wrong_timer,
    "OnProcessExit": _wrong_event_handler,
    "OnProcessStart": _wrong_event_handler,
}
