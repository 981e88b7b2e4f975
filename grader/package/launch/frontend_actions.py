"""The entities of a launch file in XML or YAML as the actions that a Python launch file would create."""

from collections.abc import Mapping
from typing import Any

from grader.names import did_you_mean
from grader.package.launch.api import class_named, front_end
from grader.package.launch.arguments import bind, check
from grader.package.launch.frontend import Entity
from grader.package.launch.frontend_attributes import TYPES, attributes_of
from grader.package.launch.frontend_values import command_line, parse_if_text, parse_value, typed_text
from grader.package.launch.model import Findings, LaunchFails
from grader.package.launch.value_types import FILE, TYPED
from grader.static_python.values import Call, ExpressionFails, Value

_PROCESS = (
    "cwd name on_exit launch-prefix output respawn respawn_max_retries:int respawn_delay:float sigkill_timeout:float"
    " sigterm_timeout:float shell:bool emulate_tty:bool env[]"
)
_NODE = f"exec! pkg args ros_args node-name exec_name namespace remap[] param[] {_PROCESS}"
# The attributes of each element: ! is required, : precedes a type that is not text, [] are elements in it.
_ACTIONS: Mapping[str, str] = {
    "append_env": "name! value! prepend:bool separator", "arg": "name! default description choice[]",
    "executable": f"cmd! {_PROCESS}", "group": "scoped:bool forwarding:bool keep[] children", "include": "file! arg[]",
    "log": "message!", "reset_env": "", "reset": "keep[]", "set_env": "name! value!", "let": "name! value!",
    "shutdown": "reason", "timer": "period!:float cancel_on_shutdown:bool children", "unset_env": "name!",
    "ros_timer": "period!:float children", "node": _NODE, "node_container": f"{_NODE} composable_node[]",
    "load_composable_node": "target! composable_node![]", "push_ros_namespace": "namespace!",
    "push-ros-namespace": "namespace!", "set_parameter": "name! value!", "set_parameters_from_file": "filename!",
    "set_remap": "from! to!", "set_ros_log_dir": "new_log_dir!", "set_use_sim_time": "value!",
}  # fmt: skip
_NESTED: Mapping[str, str] = {
    **dict.fromkeys(("env", "keep", "arg", "extra_arg"), "name! value!"), "choice": "value!", "remap": "from! to!",
    "param": "name from value:any type:any allow_substs:bool param[]",
    "composable_node": "pkg! plugin! name! if unless namespace param[] remap[] extra_arg[]",
}  # fmt: skip
_VALUE_TYPES = ("str", "bool", "float", "int", "list_of_str", "list_of_bool", "list_of_float", "list_of_int", "yaml")
# The argument of the constructor, where it has another name than the attribute.
_ARGUMENTS = {
    "pkg": "package", "exec": "executable", "default": "default_value", "message": "msg", "launch-prefix": "prefix",
    "file": "launch_description_source", "args": "arguments", "ros_args": "ros_arguments", "target": "target_container",
    "node-name": "node_name",
}  # fmt: skip
_AS_TEXT = {("arg", "name"), ("arg", "description")}  # without substitutions
_RAW = ("shell", "emulate_tty", "scoped", "forwarding", "respawn_max_retries")
# Elements and attributes that only ROS 1 has, and what replaces them.
_ROS1_TAGS = {
    "param": "a <param> belongs in its <node>", "rosparam": "write <param from=.../> in the <node>",
    "remap": "a <remap> belongs in its <node>", "machine": "", "test": "", "env": "write <set_env>",
}  # fmt: skip


def actions_of(parent: Entity, findings: Findings) -> list[Value]:
    """Return the actions in an entity; errors, which stop the launch, are added to the findings."""
    found: list[Value] = []
    for entity in parent.actions:
        try:
            if entity.kind != "keep" or parent.kind != "group":
                found.append(_action(entity, findings))
        except LaunchFails as error:
            findings.add_fault(str(error), error.at)
    return found


def _action(entity: Entity, findings: Findings) -> Call:
    kind = entity.kind
    if kind not in _ACTIONS:
        if kind in _ROS1_TAGS:
            hint = f": {_ROS1_TAGS[kind]}".removesuffix(": ")
            raise LaunchFails(f"<{kind}> in this place is from ROS 1 and not accepted by ROS 2{hint}", entity.at)
        raise LaunchFails(f"there is no action {kind!r}{did_you_mean(kind, _ACTIONS)}", entity.at)
    given = attributes_of(entity, f"if unless {_ACTIONS[kind]}")
    condition = _condition(given, entity)
    if kind == "set_remap":
        given = {"src": given["from"], "dst": given["to"]}
    kwargs = {_ARGUMENTS.get(name, name): _value(entity, name, value) for name, value in given.items()}
    if condition is not None:
        kwargs["condition"] = condition
    _add_elements(entity, kwargs, findings)
    return _checked(Call(front_end("action")[kind], [], kwargs, entity.at))


def _checked(call: Call) -> Call:
    """Return a call whose arguments its constructor accepts. Raises LaunchFails."""
    cls = class_named(call.name)
    try:
        if cls is not None:
            bind(cls, call)
            check(cls, call)
    except ExpressionFails as error:
        raise LaunchFails(str(error), call.at) from None
    return call


def _condition(given: dict[str, Any], entity: Entity) -> Call | None:
    """Take the condition out of the attributes."""
    own = {name: given.pop(name) for name in ("if", "unless") if name in given}
    if len(own) > 1:
        raise LaunchFails("if and unless cannot be used together", entity.at)
    for name, text in own.items():
        kind = "if_condition.IfCondition" if name == "if" else "unless_condition.UnlessCondition"
        kwargs = {"predicate_expression": parse_value(text, entity.at)}
        return Call(f"launch.conditions.{kind}", [], kwargs, entity.at)
    return None


def _value(entity: Entity, name: str, value: Any) -> Value:
    if (entity.kind, name) in _AS_TEXT:
        return value
    if name in ("cmd", "args", "ros_args"):
        return command_line(value, entity.at)
    if name == "on_exit" and value != "shutdown":
        raise LaunchFails(f"on_exit is 'shutdown', not {value!r}", entity.at)
    if name in ("respawn_delay", "sigkill_timeout", "sigterm_timeout"):
        if not isinstance(value, int | float) or value < 0:
            raise LaunchFails(f"{name} is {value!r}, not a number of seconds", entity.at)
        return str(value) if name != "respawn_delay" else value
    return (
        [Call(front_end("action")["shutdown"], [], {}, entity.at)]
        if name == "on_exit"
        else _parsed(entity, name, value)
    )


def _parsed(entity: Entity, name: str, value: Any) -> Value:
    if name == "respawn" or entity.kind == "set_parameter":
        parts = parse_value(value, entity.at)
        text = "launch.substitutions.text_substitution.TextSubstitution"
        return [Call(text, [], {"text": it}, entity.at) if isinstance(it, str) else it for it in parts]
    if name in ("period", "prepend", "cancel_on_shutdown"):
        return parse_if_text(value, entity.at)
    return parse_value(value, entity.at) if isinstance(value, str) and name not in _RAW else value


def _add_elements(entity: Entity, kwargs: dict[str, Value], findings: Findings) -> None:
    """Add the arguments that the elements in an entity stand for."""
    nested = {
        name: inner
        for name, inner in entity.nested.items()
        if f"{name}[]" in _ACTIONS[entity.kind].replace("!", "").split()
    }
    for name, inner in nested.items():
        match name:
            case "param":
                kwargs["parameters"] = [_parameter(it) for it in inner]
            case "remap" | "arg":
                pair = ("from", "to") if name == "remap" else ("name", "value")
                found = [tuple(_pairs(it)[key] for key in pair) for it in inner]
                kwargs["remappings" if name == "remap" else "launch_arguments"] = found
            case "env" | "keep":
                table = {tuple(pair["name"]): pair["value"] for pair in map(_pairs, inner)}
                kwargs["additional_env" if name == "env" else "launch_configurations"] = table
            case "choice":
                kwargs["choices"] = [_choice(it) for it in inner]
            case "composable_node":
                kwargs["composable_node_descriptions"] = [_composable(it) for it in inner]
    if "children" in _ACTIONS[entity.kind]:
        kwargs["actions"] = actions_of(entity, findings)
    if entity.kind == "load_composable_node":
        kwargs.setdefault("composable_node_descriptions", [])


def _choice(entity: Entity) -> str:
    if not isinstance(entity.attributes.get("value"), str):
        raise LaunchFails("<choice> needs the attribute 'value'", entity.at)
    return str(entity.attributes["value"])


def _pairs(entity: Entity) -> dict[str, list[Value]]:
    given = attributes_of(entity, _NESTED[entity.kind])
    return {name: parse_value(value, entity.at) for name, value in given.items()}


def _composable(entity: Entity) -> Call:
    given = attributes_of(entity, _NESTED[entity.kind])
    condition = _condition(given, entity)
    kwargs: dict[str, Value] = {
        _ARGUMENTS.get(name, name): parse_value(value, entity.at) for name, value in given.items()
    }
    if condition is not None:
        kwargs["condition"] = condition
    kwargs["parameters"] = [_parameter(it) for it in entity.nested.get("param", [])]
    return _checked(Call("launch_ros.descriptions.composable_node.ComposableNode", [], kwargs, entity.at))


def _parameter(entity: Entity) -> Value:
    """Return an item of the parameters of a node. Raises LaunchFails."""
    given = attributes_of(entity, _NESTED["param"])
    if "from" in given and "name" in given:
        raise LaunchFails("a <param> has either name or from", entity.at)
    if "from" in given:
        allow = given.get("allow_substs", False)
        path = parse_value(str(given["from"]), entity.at)
        return _checked(Call(FILE, [], {"param_file": path, "allow_substs": allow}, entity.at))
    if "name" not in given or "allow_substs" in given:
        raise LaunchFails("a <param> needs name, or from, which may have allow_substs", entity.at)
    parts, inner = parse_value(given["name"], entity.at), entity.nested.get("param")
    name: Value = parts[0] if len(parts) == 1 and isinstance(parts[0], str) else tuple(parts)
    if inner:
        if "value" in given or "type" in given:
            raise LaunchFails("a <param> has either a value or other <param> in it", entity.at)
        tables = (_parameter(it) for it in inner)
        return {name: {key: value for table in tables if isinstance(table, dict) for key, value in table.items()}}
    if "value" not in given:
        raise LaunchFails("a <param> needs a value", entity.at)
    kind = given.get("type")
    if kind is not None and kind not in _VALUE_TYPES:
        raise LaunchFails(f"a <param> has the type {kind!r}, which is none of {', '.join(_VALUE_TYPES)}", entity.at)
    value = entity.attributes["value"] if not entity.is_yaml and kind == "str" else given["value"]
    kwargs: dict[str, Value] = {"value": parse_if_text(value, entity.at)}
    if kind is not None and kind != "yaml":
        kwargs["value_type"] = Call(f"builtins.{kind}", [], {}, entity.at)
        if kind in ("int", "float", "bool") and not entity.is_yaml:
            kwargs["value"] = parse_if_text(typed_text(entity.attributes["value"], TYPES[kind], entity.at), entity.at)
    return {name: _checked(Call(TYPED[0], [], kwargs, entity.at))}
