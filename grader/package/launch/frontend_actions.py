"""The entities of a launch file in XML or YAML as the actions that a Python launch file would create."""

import re

from grader.package.launch.frontend import Entity
from grader.package.launch.model import Findings
from grader.package.launch.substitution_grammar import parse_value
from grader.package.launch.substitutions import COMMAND_LINE
from grader.static_python.values import Call, Unknown, Value

# Elements and attributes that only ROS 1 has, and what replaces them.
_ROS1_TAGS = {
    "param": "a <param> belongs in its <node>", "rosparam": "write <param from=.../> in the <node>",
    "remap": "a <remap> belongs in its <node>", "machine": "", "test": "", "env": "write <set_env>",
}  # fmt: skip
_ROS1_ATTRIBUTES: dict[str, dict[str, str | None]] = {
    "node": {"type": "exec", "package": "pkg", "executable": "exec", "ns": "namespace", "required": None},
    "arg": {"value": "default", "default_value": "default", "doc": "description"},
    "param": {"command": "value", "textfile": "value"},
    "group": {"ns": None},
    "include": {"ns": None, "pass_all_args": None},
}
_NODES = {"node": "Node", "lifecycle_node": "LifecycleNode"}
_IDLE = re.compile(r"(?:log|set|append|prepend|reset|push|pop|unset|rep|shutdown)(?:[_-]\w*)?")


def actions_of(parent: Entity, findings: Findings) -> list[Value]:
    """Return the actions in an entity; errors are added to the findings."""
    return [action for child in parent.children if (action := _action(child, findings)) is not None]


def _action(entity: Entity, findings: Findings) -> Call | None:
    _add_ros1_errors(entity, findings)
    name = entity.attributes.get("name")
    given = {key: parse_value(value, entity.at, findings) for key, value in entity.attributes.items()}
    kwargs: dict[str, Value] = {}
    own: dict[str, Value]
    for key, condition in (("unless", "UnlessCondition"), ("if", "IfCondition")):
        if key in given:
            kwargs["condition"] = Call(f"launch.conditions.{condition}", [given[key]], {}, entity.at)
    match entity.kind:
        case "node" | "lifecycle_node":
            return _node(entity, given, kwargs, findings)
        case "arg":
            default = given.get("default", given.get("value", given.get("default_value")))
            action, own = "DeclareLaunchArgument", {"name": name, "default_value": default}
        case "let":
            action, own = "SetLaunchConfiguration", {"name": name, "value": given.get("value")}
        case "include":
            inner = [child for child in entity.children if child.kind in ("arg", "let")]
            values = [parse_value(child.attributes.get("value", ""), child.at, findings) for child in inner]
            passed = [(child.attributes.get("name", ""), value) for child, value in zip(inner, values, strict=True)]
            own = {"launch_description_source": given.get("file"), "launch_arguments": passed}
            action = "IncludeLaunchDescription"
        case "executable":
            action, own = "ExecuteProcess", {"cmd": [Call(COMMAND_LINE, given.get("cmd", []), {}, entity.at)]}
        case "group" | "timer":
            scoped = entity.kind == "group" and entity.attributes.get("scoped", "true").lower() in ("true", "1")
            action, own = "GroupAction", {"actions": actions_of(entity, findings), "scoped": scoped}
        case kind:
            if kind not in _ROS1_TAGS and not _IDLE.fullmatch(kind):
                findings.add_unknown(f"what <{kind[:40]}> starts is known only at run time", entity.at)
            return None
    return Call(f"launch.actions.{action}", [], kwargs | own, entity.at)


def _add_ros1_errors(entity: Entity, findings: Findings) -> None:
    """Add an error for what ROS 1 accepts and ROS 2 does not."""
    if entity.kind in _ROS1_TAGS:
        hint = f": {_ROS1_TAGS[entity.kind]}".removesuffix(": ")
        findings.add_fault(f"<{entity.kind}> in this place is from ROS 1 and not accepted by ROS 2{hint}", entity.at)
    for element in (entity, *(child for child in entity.children if child.kind == "param")):
        for wrong, right in _ROS1_ATTRIBUTES.get(element.kind, {}).items():
            if wrong in element.attributes:
                hint = f"; write {right!r}" if right else ""
                findings.add_fault(f"<{element.kind}> has no attribute {wrong!r} in ROS 2{hint}", element.at)


def _node(entity: Entity, given: dict[str, Value], kwargs: dict[str, Value], findings: Findings) -> Call:
    for wrong, right in _ROS1_ATTRIBUTES["node"].items():
        if wrong in given and right is not None and right not in given:
            given[right] = given[wrong]
    table: dict[str, Value] = {}
    parameters: list[Value] = [table]
    for child in entity.children:
        name = child.attributes.get("name")
        if child.kind == "param" and name is not None:
            value = next((child.attributes[key] for key in ("value", "command") if key in child.attributes), None)
            missing = Unknown("this parameter has no value", child.at)
            table[name] = parse_value(value, child.at, findings) if value is not None else missing
        elif child.kind == "param":
            parameters.append(parse_value(child.attributes.get("from", ""), child.at, findings))
    named = {"package": given.get("pkg"), "executable": given.get("exec")}
    kwargs |= {"parameters": parameters, **{key: value for key, value in named.items() if value is not None}}
    kwargs["arguments"] = [Call(COMMAND_LINE, given["args"], {}, entity.at)] if "args" in given else []
    return Call(f"launch_ros.actions.{_NODES[entity.kind]}", [], kwargs, entity.at)
