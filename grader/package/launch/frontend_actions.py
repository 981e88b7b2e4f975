"""The entities of a launch file in XML or YAML as the actions that a Python launch file would create."""

from collections.abc import Mapping
from typing import Any

from grader.names import did_you_mean
from grader.package.launch.api import class_named, front_end
from grader.package.launch.arguments import check
from grader.package.launch.frontend import Entity
from grader.package.launch.frontend_values import command_line, is_typed, parse_if_text, parse_value, typed_text
from grader.package.launch.model import Findings
from grader.package.launch.value_types import TYPED
from grader.python.values import Call, EvaluationFails, EvaluationSignal, Undetermined, Unknown, Value

_PROCESS = (
    "cwd name on_exit launch-prefix output respawn shell:bool emulate_tty:bool"
    " -respawn_max_retries -respawn_delay -sigkill_timeout -sigterm_timeout -env"
)
# The attributes of each element that is evaluated: ! is required, : precedes a type that is not text, [] are elements
# in it; what launch accepts, but is not evaluated, begins with -.
_ACTIONS: Mapping[str, str] = {
    "arg": "name! default description choice[]", "executable": f"cmd! {_PROCESS}",
    "group": "scoped:bool -forwarding -keep children", "include": "file! arg[]", "log": "message!",
    "set_env": "name! value!", "let": "name! value!", "timer": "period!:float -cancel_on_shutdown children",
    "node": f"exec! pkg args -ros_args -node-name -exec_name namespace remap[] param[] {_PROCESS}",
    **dict.fromkeys(("push_ros_namespace", "push-ros-namespace"), "namespace!"), "set_parameter": "name! value!",
}  # fmt: skip
_NESTED: Mapping[str, str] = {
    "arg": "name! value!", "choice": "value!", "remap": "from! to!",
    "param": "name from value:any type:any -allow_substs param[]",
}  # fmt: skip
_TYPES: Mapping[str, type | None] = {"float": float, "bool": bool, "any": None}
_VALUE_TYPES = ("str", "bool", "float", "int", "list_of_str", "list_of_bool", "list_of_float", "list_of_int", "yaml")
# The argument of the constructor, where it has another name than the attribute.
_ARGUMENTS = {
    "pkg": "package", "exec": "executable", "default": "default_value", "message": "msg", "launch-prefix": "prefix",
    "file": "launch_description_source", "args": "arguments",
}  # fmt: skip
_RAW = ("shell", "emulate_tty", "scoped")


def actions_of(parent: Entity, findings: Findings) -> list[Value]:
    """Return the actions in an entity; errors, which stop the launch, are added to the findings."""
    found: list[Value] = []
    for entity in parent.actions:
        try:
            found.append(_action(entity, findings))
        except EvaluationFails as error:
            findings.add_fault(str(error), error.at or entity.at)
        except EvaluationSignal as signal:
            found.append(Unknown(str(signal), signal.at or entity.at))
    return found


def _action(entity: Entity, findings: Findings) -> Call:
    kind = entity.kind
    if kind not in _ACTIONS:
        if kind in front_end("action"):
            raise Undetermined(f"the action {kind} is not evaluated", entity.at)
        raise EvaluationFails(f"there is no action {kind!r}{did_you_mean(kind, _ACTIONS)}", entity.at)
    given = _attributes(entity, f"if unless {_ACTIONS[kind]}")
    condition = _condition(given, entity)
    kwargs = {_ARGUMENTS.get(name, name): _value(entity, name, value) for name, value in given.items()}
    if condition is not None:
        kwargs["condition"] = condition
    _add_elements(entity, kwargs)
    if "children" in _ACTIONS[kind]:
        kwargs["actions"] = actions_of(entity, findings)
    return _checked(Call(front_end("action")[kind], [], kwargs, entity.at))


def _attributes(entity: Entity, known: str) -> dict[str, Any]:
    """Return the attributes of an entity, of their types. Raises EvaluationSignal."""
    if entity.error:
        raise EvaluationFails(entity.error, entity.at)
    if entity.is_yaml and entity.has_actions != ("children" in known):
        what = "needs the key children" if "children" in known else "has no list of actions"
        raise EvaluationFails(f"{entity.kind} {what}", entity.at)
    names = {word.partition(":")[0].strip("-![]"): word for word in f"{known} -<<".split()}
    lists = {name for name, word in names.items() if word.endswith("[]")}
    inner = [*entity.nested, *(it.kind for it in entity.actions)]
    for name in [*inner, *entity.attributes]:
        if (
            name == "<<"
            or names.get(name, "").startswith("-")
            or (name.removesuffix("-sep") in names and name not in names)
        ):
            raise Undetermined(f"{name} of <{entity.kind}> is not evaluated", entity.at)
    for name in inner if "children" not in names else ():
        if name not in lists:
            raise EvaluationFails(f"<{entity.kind}> contains no <{name}>{did_you_mean(name, lists)}", entity.at)
    for name in entity.attributes:
        if name not in names or name in lists or name == "children":
            raise EvaluationFails(f"<{entity.kind}> has no attribute {name!r}{did_you_mean(name, names)}", entity.at)
    missing = [name for name, word in names.items() if "!" in word and name not in {*entity.attributes, *entity.nested}]
    if missing:
        raise EvaluationFails(f"<{entity.kind}> needs the attribute {missing[0]!r}", entity.at)
    return {
        name: _typed(entity, name, value, names[name].partition(":")[2]) for name, value in entity.attributes.items()
    }


def _typed(entity: Entity, name: str, value: Any, kind: str) -> Any:
    wanted = _TYPES[kind] if kind else str
    if not entity.is_yaml:
        return value if wanted is str else typed_text(value, wanted, entity.at)
    if not is_typed(value, wanted, entity.at):
        what = f"{name} of {entity.kind} is {value!r}, which YAML reads as {type(value).__name__}"
        raise EvaluationFails(f"{what}: {'put quotes around it' if wanted is str else f'write a {kind}'}", entity.at)
    return value


def _checked(call: Call) -> Call:
    """Return a call whose arguments its constructor accepts. Raises EvaluationSignal."""
    cls = class_named(call.name)
    doubt = check(cls, call) if cls is not None else None
    if doubt is not None:
        raise Undetermined(doubt.reason, doubt.at)
    return call


def _condition(given: dict[str, Any], entity: Entity) -> Call | None:
    """Take the condition out of the attributes."""
    own = {name: given.pop(name) for name in ("if", "unless") if name in given}
    if len(own) > 1:
        raise EvaluationFails("if and unless cannot be used together", entity.at)
    for name, text in own.items():
        kind = "if_condition.IfCondition" if name == "if" else "unless_condition.UnlessCondition"
        kwargs = {"predicate_expression": parse_value(text, entity.at)}
        return Call(f"launch.conditions.{kind}", [], kwargs, entity.at)
    return None


def _value(entity: Entity, name: str, value: Any) -> Value:
    if entity.kind == "arg" and name in ("name", "description"):
        return value  # without substitutions
    if name in ("cmd", "args"):
        return command_line(value, entity.at)
    if name == "on_exit":
        if value != "shutdown":
            raise EvaluationFails(f"on_exit is 'shutdown', not {value!r}", entity.at)
        return [Call(front_end("action")["shutdown"], [], {}, entity.at)]
    if name == "respawn" or entity.kind == "set_parameter":
        text = "launch.substitutions.text_substitution.TextSubstitution"
        parts = parse_value(value, entity.at)
        return [Call(text, [], {"text": it}, entity.at) if isinstance(it, str) else it for it in parts]
    if name == "period":
        return parse_if_text(value, entity.at)
    return parse_value(value, entity.at) if isinstance(value, str) and name not in _RAW else value


def _add_elements(entity: Entity, kwargs: dict[str, Value]) -> None:
    """Add the arguments that the elements in an entity stand for."""
    for name, inner in entity.nested.items() if "children" not in _ACTIONS[entity.kind] else ():
        match name:
            case "param":
                kwargs["parameters"] = [_parameter(it) for it in inner]
            case "remap" | "arg":
                pair = ("from", "to") if name == "remap" else ("name", "value")
                given = [(it, _attributes(it, _NESTED[name])) for it in inner]
                found = [tuple(parse_value(values[key], it.at) for key in pair) for it, values in given]
                kwargs["remappings" if name == "remap" else "launch_arguments"] = found
            case "choice":
                kwargs["choices"] = [_attributes(it, _NESTED[name])["value"] for it in inner]


def _parameter(entity: Entity) -> Value:
    """Return an item of the parameters of a node. Raises EvaluationSignal."""
    given = _attributes(entity, _NESTED["param"])
    if ("from" in given) == ("name" in given):
        raise EvaluationFails("a <param> has either name or from", entity.at)
    if "from" in given:
        return parse_value(str(given["from"]), entity.at)
    parts, inner, kind = parse_value(given["name"], entity.at), entity.nested.get("param"), given.get("type")
    name: Value = parts[0] if len(parts) == 1 and isinstance(parts[0], str) else tuple(parts)
    if inner:
        if "value" in given or "type" in given:
            raise EvaluationFails("a <param> has either a value or other <param> in it", entity.at)
        tables = (_parameter(it) for it in inner)
        return {name: {key: value for table in tables if isinstance(table, dict) for key, value in table.items()}}
    if "value" not in given:
        raise EvaluationFails("a <param> needs a value", entity.at)
    if kind is not None and kind not in _VALUE_TYPES:
        raise EvaluationFails(f"a <param> has the type {kind!r}, which is none of {', '.join(_VALUE_TYPES)}", entity.at)
    if kind not in (None, "str", "yaml"):
        raise Undetermined(f"a <param> of the type {kind} is not evaluated", entity.at)
    value = entity.attributes["value"] if not entity.is_yaml and kind == "str" else given["value"]
    kwargs: dict[str, Value] = {"value": parse_if_text(value, entity.at)}
    if kind == "str":
        kwargs["value_type"] = Call("builtins.str", [], {}, entity.at)
    return {name: _checked(Call(TYPED[0], [], kwargs, entity.at))}
