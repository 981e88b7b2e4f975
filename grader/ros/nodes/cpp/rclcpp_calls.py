"""What calls of rclcpp declare and open: one recorded call to the facts of a node."""

from collections.abc import Collection, Iterator, Mapping, Sequence

from grader.base.grouping import as_list, as_text, only_one
from grader.base.patterns import on_use
from grader.base.source import Location
from grader.ros.cpp.cpp_values import (
    INTEGERS,
    CppCall,
    CppName,
    CppSum,
    CppValue,
    as_scalar,
    not_known,
)
from grader.ros.cpp.declarations import plain, short_name
from grader.ros.cpp.literals import SECONDS
from grader.ros.cpp.syntax import CppNode
from grader.ros.cpp.unit import CppUnit
from grader.ros.known.package_tables import cpp_table
from grader.ros.nodes.node_facts import (
    Endpoint,
    EndpointKind,
    NameOrParts,
    NamePart,
    NodeParameter,
    Qos,
    Timer,
)
from grader.ros.python.values import SCALARS, Value

_MESSAGE = on_use(r"(\w+)::(msg|srv|action)::(\w+)")
_ENDPOINTS: Mapping[str, EndpointKind] = {
    "create_publisher": "publisher",
    "create_subscription": "subscription",
    "create_service": "service",
    "create_client": "client",
}
ACTIONS: Mapping[str, EndpointKind] = {
    "rclcpp_action::create_server": "action server",
    "rclcpp_action::create_client": "action client",
}
INTERFACES_OF_ACTION = 4  # which functions of actions take in place of a node
DECLARES = ("declare_parameter", "declare_parameters")
_READS_IF_DECLARED = ("get_parameter_or", "has_parameter")
_READS = ("get_parameter", *_READS_IF_DECLARED)
_TIMERS = ("create_wall_timer", "create_timer")
METHODS = frozenset({*_ENDPOINTS, *DECLARES, *_READS, *_TIMERS})
_DURATIONS = {
    **{f"std::chrono::{ending}": seconds for ending, seconds in SECONDS.items()},
    "nanoseconds": 1e-9,
    "microseconds": 1e-6,
    "milliseconds": 1e-3,
    "seconds": 1.0,
    "minutes": 60.0,
    "hours": 3600.0,
    "duration": 1.0,
    "from_seconds": 1.0,
    "Duration": 1e-9,
}
# Methods of rclcpp::QoS that set a policy, and what they set.
_POLICIES = {
    "reliable": ("reliability", "reliable"),
    "best_effort": ("reliability", "best_effort"),
    "reliability_best_available": ("reliability", None),
    "transient_local": ("durability", "transient_local"),
    "durability_volatile": ("durability", "volatile"),
    "durability_best_available": ("durability", None),
}
# The enumerators of rclcpp and rmw, without their beginnings.
_VALUES = {
    "reliable": "reliable",
    "besteffort": "best_effort",
    "transientlocal": "transient_local",
    "volatile": "volatile",
}
_WITHOUT_EFFECT = (
    *("avoid_ros_namespace_conventions", "deadline", "lifespan", "liveliness"),
    "get_rmw_qos_profile",
)
_BRANCHES = ("if_statement", "switch_statement", "conditional_expression", "catch_clause")
_CATCHING = ("try_statement",)
_EMPTY = {"string": "", "string_view": "", "double": 0.0, "float": 0.0}
_VALUE_METHODS = frozenset(
    {
        *("as_string", "as_double", "as_int", "as_bool", "as_string_array", "get_value", "get"),
        *("get_parameter_value", "as_double_array", "as_integer_array", "as_bool_array"),
    }
)


def read_endpoint(
    kind: EndpointKind, call: CppCall, unit: CppUnit, scopes: Sequence[str], position: int = 0
) -> Endpoint:
    """Return what a call opens; `position` is that of the name among its arguments."""
    name, parts = read_name(call.argument(position), call.owner)
    qos = Qos()
    if kind in ("publisher", "subscription"):
        qos = _qos(call.argument(1))
    kind_of_message = message_type(call.types[0], unit, scopes) if call.types else None
    return Endpoint(
        kind,
        kind_of_message,
        name,
        call.node.location,
        qos,
        parts,
        is_conditional=_is_inside(_BRANCHES, call.node),
        is_caught=_is_inside(_CATCHING, call.node),
    )


def _is_inside(kinds: Collection[str], node: CppNode) -> bool:
    """Return whether a statement of some kinds has a node in it, in the function of that."""
    for around in node.ancestors():
        if around.kind in kinds:
            return True
        if around.kind == "function_definition":
            return False
    return False


def filter_subscription(
    type_name: str | None, given: Sequence[CppValue], at: Location
) -> Endpoint | None:
    """Return the subscription of a filter that is given a node, a topic and perhaps a QoS.

    The result is None where it is given something else.
    """
    if len(given) not in (2, 3, 4):
        return None
    name, parts = read_name(given[1])
    qos = _qos(given[2]) if len(given) > 2 else _preset("rmw_qos_profile_default")
    return Endpoint("subscription", type_name, name, at, qos, parts)


def message_type(written: str, unit: CppUnit, scopes: Sequence[str]) -> str | None:
    """Return the full name of a message, service or action; None for one that is not known."""
    types = set()
    for meaning in unit.meanings(plain(written), scopes):
        match = _MESSAGE.fullmatch(meaning)
        if match:
            types.add(".".join(match.groups()))
    return only_one(types)


def read_name(value: CppValue, node: CppValue = None) -> NameOrParts:
    """Return a name that is plain text, or the parts of one that is not.

    `node` is what has the node, if that is not the object itself.
    """
    if isinstance(value, str):
        return value, ()
    if isinstance(value, CppSum):
        return None, tuple(_part(part, node) for part in value.parts)
    if isinstance(value, CppCall):
        return None, (_part(value, node),)
    return None, ()


def _part(value: CppValue, node: CppValue) -> NamePart:
    if isinstance(value, str):
        return NamePart("text", value)
    parameter = _parameter_read(value)
    if parameter is not None:
        return NamePart("parameter", parameter)
    is_call = isinstance(value, CppCall) and not value.args
    is_own = is_call and (_is_node(value.owner) or _is_same(value.owner, node))
    if is_own and value.name == "get_name":
        return NamePart("node name")
    if is_own and value.name == "get_namespace":
        return NamePart("namespace")
    return NamePart("unknown")


def _is_this(value: CppValue) -> bool:
    return isinstance(value, CppName) and value.name == "this"


def _is_node(value: CppValue) -> bool:
    """Return whether a value is the object itself, or the node of a controller."""
    if value is None or _is_this(value):
        return True
    return isinstance(value, CppCall) and value.name == "get_node" and not value.args


def _is_same(one: CppValue, other: CppValue) -> bool:
    """Return whether two values are one variable."""
    if not isinstance(one, CppName) or not isinstance(other, CppName):
        return False
    return one.name.removeprefix("this->") == other.name.removeprefix("this->")


def _parameter_read(value: CppValue) -> str | None:
    """Return the name of the parameter whose value this is; None for another value."""
    while isinstance(value, CppCall) and value.name in _VALUE_METHODS and not value.args:
        value = value.owner
    if not isinstance(value, CppCall) or value.name not in ("declare_parameter", "get_parameter"):
        return None
    is_own = value.owner is None or _is_this(value.owner)
    name = value.argument(0)
    return name if is_own and isinstance(name, str) else None


def facts_of_method(
    call: CppCall, unit: CppUnit, scopes: Sequence[str]
) -> Iterator[Endpoint | NodeParameter | Timer]:
    """Yield what a method of a node declares, opens or reads."""
    name = call.short
    at = call.node.location
    if name in _ENDPOINTS:
        yield read_endpoint(_ENDPOINTS[name], call, unit, scopes)
    elif name in _TIMERS:
        yield Timer(_duration(call.argument(0)), at)
    elif name == "declare_parameters":
        yield from _declared(call, at)
    elif name == "declare_parameter":
        default = _converted(call.argument(1), call.types[0] if call.types else "")
        is_plain = len(call.args) < 3
        is_alone = len(call.args) == 1
        declared = NodeParameter(as_text(call.argument(0)), default, at, is_plain=is_plain)
        has_type = bool(call.types)
        yield declared._replace(
            is_unset=is_alone and has_type, is_untyped=is_alone and not has_type
        )
    else:
        # With a second argument, it returns false for what is not declared.
        is_needed = name == "get_parameter" and len(call.args) == 1
        read = NodeParameter(as_text(call.argument(0)), None, at, is_declared=False)
        # The method that converts it right there, as as_int.
        method = call.node.parent.child("field").text
        conversion = method if method.startswith("as_") else ""
        yield read._replace(
            is_needed=is_needed, is_guard=name == "has_parameter", read_as=conversion
        )


def _duration(value: CppValue) -> float | None:
    """Return a duration in seconds; None for one that is computed."""
    if not isinstance(value, CppCall) or not isinstance(value.argument(0), int | float):
        return None
    unit = _DURATIONS.get(value.name) or _DURATIONS.get(value.short)
    return float(value.argument(0)) * unit if unit is not None else None


def _declared(call: CppCall, at: Location) -> Iterator[NodeParameter]:
    """Yield the parameters of declare_parameters: pairs of a name and a default."""
    namespace = call.argument(0)
    given = call.argument(1)
    before = f"{namespace}." if namespace else ""
    if isinstance(given, CppCall):
        given = list(given.args)
    if not isinstance(given, list) or not isinstance(namespace, str):
        yield NodeParameter(None, not_known("it is computed"), at)
        return
    written = call.types[0] if call.types else ""
    for pair in given:
        match pair:
            case [str() as name, value]:
                is_plain = not isinstance(value, list | CppCall)
                default = _converted(value, written)
                yield NodeParameter(f"{before}{name}", default, at, is_plain=is_plain)
            case _:
                yield NodeParameter(None, not_known("it is computed"), at)


def _converted(value: CppValue, written: str) -> Value:
    """Return the default of a parameter, as the type of its template argument has it.

    The result is None where there is none, or a type in its place.
    """
    if isinstance(value, CppCall) and value.short == "ParameterValue" and len(value.args) == 1:
        value = value.args[0]
    if isinstance(value, CppName) and "PARAMETER_" in value.name:
        return None
    converted = _of_type(value, written)
    items = as_list(converted)
    if all(isinstance(item, SCALARS) or item is None for item in items):
        return converted
    return not_known("the default is computed")


def _of_type(value: CppValue, written: str) -> Value:
    """Return a value, or the items of a list, as the type of a template argument has it."""
    if isinstance(value, CppCall) and value.short == "vector":
        return _items_of_vector(value)
    if isinstance(value, list):
        return _in_braces(value, written)
    return as_scalar(value, short_name(plain(written)))


def _in_braces(items: Sequence[CppValue], written: str) -> Value:
    """Return what is made of values in braces: one value of a plain type, or the items of a list.

    Only the template argument says which: {"a"} may be a text or a list of texts.
    """
    kind = short_name(plain(written))
    if (kind in _EMPTY or kind == "bool" or kind.startswith(INTEGERS)) and len(items) <= 1:
        return as_scalar(items[0] if items else _EMPTY.get(kind, 0), kind)
    inner = written.partition("<")[2].rpartition(">")[0]
    if not inner:
        return not_known("its type is not written")
    return [as_scalar(item, plain(inner)) for item in items]


def _items_of_vector(vector: CppCall) -> list[Value]:
    """Return the items that a vector is made of, of the type of its template argument."""
    items = list(vector.args)
    if len(items) == 1 and isinstance(items[0], list):
        items = items[0]
    kind = plain(vector.types[0]) if vector.types else ""
    return [as_scalar(item, kind) for item in items]


# --- Quality of service
# ----------------------------------------------------------------------


def _qos(value: CppValue) -> Qos:
    """Return a quality of service: a depth, an object of rclcpp::QoS, or one of the presets."""
    match value:
        case bool():
            return Qos()
        case int():
            return Qos(value, "reliable", "volatile")
        case CppName():
            return _preset(value.name)
        case CppCall() if value.owner is not None:
            return _with_policy(_qos(value.owner), value)
        case CppCall():
            return _constructed_qos(value)
    return Qos()


def _constructed_qos(call: CppCall) -> Qos:
    if call.short == "QoS":
        first = call.argument(0)
        second = call.argument(1)
        if second is not None:
            return _preset(second.name) if isinstance(second, CppName) else Qos()
        if isinstance(first, CppCall) and first.short == "KeepLast":
            first = first.argument(0)
        if isinstance(first, int) and not isinstance(first, bool):
            return Qos(first, "reliable", "volatile")
        if isinstance(first, CppCall) and first.short == "KeepAll":
            return Qos(None, "reliable", "volatile")
        is_depth = _parameter_read(first) is not None
        return Qos(None, "reliable", "volatile") if is_depth else Qos()
    return _preset(call.name)


def _preset(name: str) -> Qos:
    words = cpp_table().profiles.get(short_name(name), "").split()
    if not words:
        return Qos()
    depth = int(words[0]) if words[0].isdigit() else None
    return Qos(depth, words[1], words[2])


def _with_policy(qos: Qos, call: CppCall) -> Qos:
    """Return a quality of service after a method that sets one of its policies."""
    if call.name in _POLICIES:
        policy, value = _POLICIES[call.name]
        is_reliability = policy == "reliability"
        return qos._replace(reliability=value) if is_reliability else qos._replace(durability=value)
    if call.name in ("reliability", "durability"):
        argument = call.argument(0)
        value = _policy(argument.name) if isinstance(argument, CppName) else None
        is_reliability = call.name == "reliability"
        return qos._replace(reliability=value) if is_reliability else qos._replace(durability=value)
    if call.name in ("keep_last", "history", "keep_all"):
        depth = call.argument(0)
        return qos._replace(depth=depth if isinstance(depth, int) else None)
    return qos if call.name in _WITHOUT_EFFECT else Qos()


def _policy(name: str) -> str | None:
    last = short_name(name)
    for start in ("RMW_QOS_POLICY_RELIABILITY_", "RMW_QOS_POLICY_DURABILITY_"):
        last = last.removeprefix(start)
    return _VALUES.get(last.lower().replace("_", ""))
