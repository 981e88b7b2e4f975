"""The entities of a launch file in XML or YAML as the actions that a Python launch file would create."""

import re
from dataclasses import dataclass

from grader.names import closest
from grader.package.launch.frontend import Entity
from grader.package.launch.model import Findings
from grader.package.launch.substitutions import COMMAND_LINE
from grader.static_python.parse import Position
from grader.static_python.values import Call, Unknown, Value

_MAX_DEPTH = 40
# The Python name of each substitution of the XML and YAML frontends.
_SUBSTITUTIONS = {
    "find-pkg-share": "launch_ros.substitutions.FindPackageShare",
    "find-pkg-prefix": "launch_ros.substitutions.FindPackagePrefix",
    "var": "launch.substitutions.LaunchConfiguration",
    "command": "launch.substitutions.Command",
    "find-exec": "launch.substitutions.FindExecutable",
    "dirname": "launch.substitutions.ThisLaunchFileDir",
    "env": "launch.substitutions.EnvironmentVariable",
    "eval": "launch.substitutions.PythonExpression",
    "file-content": "launch.substitutions.FileContent",
    "equals": "launch.substitutions.EqualsSubstitution",
    "not-equals": "launch.substitutions.NotEqualsSubstitution",
    "not": "launch.substitutions.NotSubstitution",
    "and": "launch.substitutions.AndSubstitution",
    "or": "launch.substitutions.OrSubstitution",
    "all": "launch.substitutions.AllSubstitution",
    "any": "launch.substitutions.AnySubstitution",
    "if": "launch.substitutions.IfElseSubstitution",
}
# The substitutions of ROS 1 and their names in ROS 2.
_ROS1 = {"find": "find-pkg-share", "arg": "var", "optenv": "env"}
_ON_STDERR = ("fail", "ignore", "warn", "capture")
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


def parse_value(text: str, at: Position, findings: Findings) -> list[Value]:
    """Return a value as a list of strings and calls of substitutions; mistakes in it are added to the findings."""
    return _ValueParser(text, at, findings).pieces("", 0)


@dataclass(slots=True)
class _ValueParser:
    """Parses a value from its beginning to its end."""

    text: str
    at: Position
    findings: Findings
    position: int = 0

    def pieces(self, ends: str, depth: int) -> list[Value]:
        """Return strings and substitutions, up to one of the characters that end them."""
        found: list[Value] = []
        plain: list[str] = []
        while self.position < len(self.text) and self.text[self.position] not in ends:
            if self.text.startswith("$(", self.position) and depth < _MAX_DEPTH:
                found += ["".join(plain)] if plain else []
                plain.clear()
                self.position += 2
                found.append(self.substitution(depth + 1))
                continue
            if self.text[self.position] == "\\" and self.position + 1 < len(self.text):
                self.position += 1
            plain.append(self.text[self.position])
            self.position += 1
        return [*found, "".join(plain)] if plain or not found else found

    def substitution(self, depth: int) -> Call:
        """Return the substitution in brackets: a name, and values separated by spaces, with or without quotes."""
        start = self.position
        while self.position < len(self.text) and self.text[self.position] not in " \t\n)":
            self.position += 1
        name = self.text[start : self.position]
        values: list[Value] = []
        while self.position < len(self.text) and self.text[self.position] != ")":
            first = self.text[self.position]
            if first in " \t\n":
                self.position += 1
            elif first in "'\"":
                self.position += 1
                values.append(self.pieces(first, depth))
                self.position += 1
            else:
                values.append(self.pieces(" \t\n)", depth))
        if self.position >= len(self.text):
            self.findings.add_fault(f"the bracket of $({name[:40]} is not closed", self.at)
        self.position += 1
        return self.call(name, values)

    def call(self, name: str, values: list[Value]) -> Call:
        """Return a substitution as the call that it is in Python."""
        if name in _ROS1:
            message = f"$({name} ...) is a substitution of ROS 1; in ROS 2 write $({_ROS1[name]} ...)"
            self.findings.add_fault(message, self.at)
            name = _ROS1[name]
        if name == "command" and len(values) > 1 and values[1] not in [[mode] for mode in _ON_STDERR]:
            message = "$(command ...) needs quotes around its command: $(command 'xacro ...')"
            self.findings.add_fault(message, self.at)
            values = [[part for value in values for part in (*value, " ")]]
        similar = closest(name, _SUBSTITUTIONS) if name not in _SUBSTITUTIONS else None
        if similar:
            self.findings.add_fault(f"there is no substitution $({name} ...); did you mean $({similar} ...)?", self.at)
        return Call(_SUBSTITUTIONS.get(name, f"launch.substitutions.{name}"), values, {}, self.at)


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
