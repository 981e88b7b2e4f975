"""Launch files in XML and YAML, read as entities.

The entities become the actions that a Python launch file would create.

Their values are texts with substitutions, by launch's grammar, and texts that are numbers.
"""

import re
import shlex
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any, Literal, NamedTuple, NoReturn

from grader.base.grouping import Strings, are_texts
from grader.base.names import closest, did_you_mean
from grader.base.patterns import on_use
from grader.base.source import Location, Source
from grader.ros.config.yaml_nodes import (
    YamlFault,
    YamlNode,
    check_one_document,
    read_yaml,
    yaml_value,
)
from grader.ros.known.package_rows import added_launch_actions
from grader.ros.launch.call_arguments import TYPED, check
from grader.ros.launch.launch_classes import (
    COMPONENT,
    LIFECYCLE_COMPONENT,
    class_named,
    first_release,
    front_end,
)
from grader.ros.launch.launch_model import Findings, LaunchFault
from grader.ros.launch.substitutions import boolean, located
from grader.ros.python.parse import START, Position
from grader.ros.python.values import (
    Call,
    EvaluationFails,
    EvaluationSignal,
    Undetermined,
    Unknown,
    Value,
)
from grader.ros.xml.parsing import Element, XmlFault, XmlFile

_NAME = on_use(r"[A-Za-z][A-Za-z0-9_-]*")
_SUBSTITUTION = on_use(r"\$\(([A-Za-z][A-Za-z0-9_-]*)")
_BEFORE_NEXT = {
    "": " '\"()",
    "'": " '()",
    '"': ' "()',
}  # what ends a value, in no quotes and in each kind of quotes
_Values = list[Value]


class _SubstitutionFormat(NamedTuple):
    """The names of the arguments of a substitution, in their order."""

    required: Strings = ()
    optional: Strings = ()
    rest: str = ""  # of which there is at least one


_TWO_VALUES = _SubstitutionFormat(("left", "right"))
# The substitutions that are evaluated.
_SUBSTITUTIONS: Mapping[str, _SubstitutionFormat] = {
    "var": _SubstitutionFormat(("variable_name",), ("default",)),
    "env": _SubstitutionFormat(("name",), ("default_value",)),
    "command": _SubstitutionFormat(("command",), ("on_stderr",)),
    "find-pkg-share": _SubstitutionFormat(("package",)),
    "find-exec": _SubstitutionFormat(("name",)),
    "eval": _SubstitutionFormat(("expression",), ("python_modules",)),
    "dirname": _SubstitutionFormat(),
    "filename": _SubstitutionFormat(),
    "file-content": _SubstitutionFormat(("path",)),
    "exec-in-pkg": _SubstitutionFormat(("executable", "package")),
    "if": _SubstitutionFormat(("condition", "if_value"), ("else_value",)),
    "not": _SubstitutionFormat(("value",)),
    "and": _TWO_VALUES,
    "or": _TWO_VALUES,
    "equals": _TWO_VALUES,
    "not-equals": _TWO_VALUES,
    "path-join": _SubstitutionFormat(rest="substitutions"),
    "string-join": _SubstitutionFormat(("delimiter",), rest="substitutions"),
}
_ON_STDERR = (["fail"], ["ignore"], ["warn"], ["capture"])
_MERGE_KEY = "<<"  # of YAML
_LOG = "launch.actions.log.Log"
_MAX_DEPTH = 40
_MAX_ENTITIES = 5_000
_MAX_PLACES = 40  # attributes of an element in XML that are looked for


class _Part(NamedTuple):
    """What an element may have: an attribute, elements of one name, or actions."""

    value: type | None = str  # the type of an attribute; None for any scalar
    is_required: bool = False
    is_evaluated: bool = True  # not where launch accepts it, and it changes what is started
    holds: Literal["value", "elements", "actions"] = "value"


_Parts = Mapping[str, _Part]
_TEXT = _Part()
_REQUIRED = _Part(is_required=True)
_NOT_EVALUATED = _Part(is_evaluated=False)
_BOOL = _Part(bool)
_ANY = _Part(None)
_ELEMENTS = _Part(holds="elements")
_CHILDREN = _Part(holds="actions")
_CONDITION_PARTS: _Parts = {"if": _TEXT, "unless": _TEXT}
_PROCESS: _Parts = {
    "cwd": _TEXT,
    "name": _TEXT,
    "on_exit": _TEXT,
    "launch-prefix": _TEXT,
    "output": _TEXT,
    "respawn": _TEXT,
    "shell": _BOOL,
    "emulate_tty": _BOOL,
    "respawn_max_retries": _NOT_EVALUATED,
    "respawn_delay": _NOT_EVALUATED,
    "sigkill_timeout": _NOT_EVALUATED,
    "sigterm_timeout": _NOT_EVALUATED,
    "env": _ELEMENTS,
}
_NODE: _Parts = {
    "exec": _REQUIRED,
    "pkg": _TEXT,
    "args": _TEXT,
    "ros_args": _TEXT,
    "exec_name": _NOT_EVALUATED,
    "namespace": _TEXT,
    "remap": _ELEMENTS,
    "param": _ELEMENTS,
    **_PROCESS,
}
# `node-name` is none of them: launch_ros reads it up to 0.26.11, and its class Node has no argument
# for it; since then the reader refuses it (https://github.com/ros2/launch_ros/pull/538).
_MESSAGE: _Parts = {"message": _REQUIRED}
_PUSH_NAMESPACE: _Parts = {"namespace": _REQUIRED}
_COMPONENTS: _Parts = dict.fromkeys(
    ("composable_node", "composable_lifecycle_node"), _Part(holds="elements")
)
# The actions that are evaluated.
_ACTIONS: Mapping[str, _Parts] = {
    "arg": {"name": _REQUIRED, "default": _TEXT, "description": _TEXT, "choice": _ELEMENTS},
    "bool_arg": {"name": _REQUIRED, "default": _TEXT, "description": _TEXT},
    "executable": {"cmd": _REQUIRED, **_PROCESS},
    "group": {
        "scoped": _BOOL,
        "forwarding": _BOOL,
        "keep": _NOT_EVALUATED,
        "children": _CHILDREN,
    },
    "include": {"file": _REQUIRED, "arg": _ELEMENTS, "let": _ELEMENTS},
    "log": {"message": _REQUIRED, "level": _TEXT},
    **dict.fromkeys(("log_info", "log_debug", "log_warning", "log_error"), _MESSAGE),
    "set_env": {"name": _REQUIRED, "value": _REQUIRED},
    "let": {"name": _REQUIRED, "value": _REQUIRED},
    "timer": {
        "period": _Part(float, is_required=True),
        "cancel_on_shutdown": _NOT_EVALUATED,
        "children": _CHILDREN,
    },
    "node": _NODE,
    "lifecycle_node": {**_NODE, "autostart": _BOOL},
    "node_container": {**_NODE, **_COMPONENTS},
    "load_composable_node": {"target": _REQUIRED, **_COMPONENTS},
    "push_ros_namespace": _PUSH_NAMESPACE,
    "push-ros-namespace": _PUSH_NAMESPACE,
    "set_parameter": {"name": _REQUIRED, "value": _REQUIRED},
    "set_remap": {"from": _REQUIRED, "to": _REQUIRED},
    "set_parameters_from_file": {"filename": _REQUIRED},
}
_COMPOSABLE_NODE: _Parts = {
    "pkg": _REQUIRED,
    "plugin": _REQUIRED,
    "name": _REQUIRED,
    "namespace": _TEXT,
    "param": _ELEMENTS,
    "remap": _ELEMENTS,
    "extra_arg": _ELEMENTS,
    **_CONDITION_PARTS,
}
_NESTED: Mapping[str, _Parts] = {
    "arg": {"name": _REQUIRED, "value": _REQUIRED},
    "let": {"name": _REQUIRED, "value": _REQUIRED},
    "choice": {"value": _REQUIRED},
    "env": {"name": _REQUIRED, "value": _REQUIRED},
    "composable_node": _COMPOSABLE_NODE,
    "composable_lifecycle_node": {**_COMPOSABLE_NODE, "autostart": _BOOL},
    "remap": {"from": _REQUIRED, "to": _REQUIRED},
    "param": {
        "name": _TEXT,
        "from": _TEXT,
        "value": _ANY,
        "value-sep": _TEXT,
        "type": _ANY,
        "allow_substs": _NOT_EVALUATED,
        "param": _ELEMENTS,
    },
}


def elements_in(tag: str) -> list[str]:
    """Return the elements that an element of a launch file in XML may have."""
    if tag in ("launch", "group", "timer"):
        return list(_ACTIONS)
    parts = {**_ACTIONS, **_NESTED}.get(tag, {})
    return [name for name, part in parts.items() if part.holds == "elements"]


def attributes_of_element(tag: str) -> Iterator[tuple[str, bool]]:
    """Yield the attributes of an element of a launch file in XML, and whether it needs each."""
    for name, part in {**_NESTED.get(tag, {}), **_ACTIONS.get(tag, {})}.items():
        if part.holds == "value":
            yield name, part.is_required


_SCALARS: Mapping[str, type] = {"bool": bool, "float": float, "int": int}
_VALUE_TYPES = (
    "str",
    "bool",
    "float",
    "int",
    "list_of_str",
    "list_of_bool",
    "list_of_float",
    "list_of_int",
    "yaml",
)
# The argument of the constructor, where it has another name than the attribute.
_ARGUMENTS = {
    "pkg": "package",
    "exec": "executable",
    "default": "default_value",
    "message": "msg",
    "launch-prefix": "prefix",
    "file": "launch_description_source",
    "args": "arguments",
    "from": "src",
    "to": "dst",
    "ros_args": "ros_arguments",
    "target": "target_container",
}
_ROS1 = (
    "this is a launch file of ROS 1; in ROS 2 write exec= for type=, $(find-pkg-share ...) "
    "for $(find ...),"
    " $(var ...) for $(arg ...), and <param> inside of <node>"
)
_SUBSTITUTIONS_OF_ROS1 = {"arg": "var", "find": "find-pkg-share", "optenv": "env"}
_RENAMED = {"node-name": ": write name"}
_RAW = ("shell", "emulate_tty", "scoped", "forwarding", "autostart")
_NAMED = ("name", "namespace")  # attributes that the class LifecycleNode needs


@dataclass(slots=True)
class _Entity:
    """One element of a launch file: <node pkg="..."/>, or `- node: {pkg: ...}`.

    `attributes` are texts in XML, values in YAML. `nested` has the elements in it by their names,
    `actions` those that are actions of a group.
    """

    kind: str
    at: Position
    attributes: dict[str, Any] = field(default_factory=dict)
    nested: "dict[str, list[_Entity]]" = field(default_factory=dict)
    actions: "list[_Entity]" = field(default_factory=list)
    is_yaml: bool = False
    has_actions: bool = True  # in YAML: whether it is a list, or has the key children
    error: str = ""  # what is wrong with its form
    places: dict[str, Position] = field(default_factory=dict)  # of its attributes

    def place(self, name: str) -> Position:
        """Return where an attribute is."""
        return self.places.get(name, self.at)


def read_frontend(data: bytes, source: Source, *, is_yaml: bool) -> _Entity | LaunchFault:
    """Return the root entity of a launch file in XML or YAML, or why it cannot be read.

    It never raises.
    """
    try:
        data.decode()  # as open does, whatever the file itself says of its encoding
        if is_yaml:
            root = _YamlReader().root(data, source.path)
        else:
            root = _xml_root(XmlFile(data, source))
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        return LaunchFault(
            "the file is not UTF-8 text: save it as UTF-8", Location(source.path, line, 1)
        )
    except (YamlFault, XmlFault) as fault:
        return LaunchFault(
            f"not readable as {'YAML' if is_yaml else 'XML'}: {fault}", fault.location
        )
    except EvaluationFails as error:
        line, column = error.at or START
        return LaunchFault(str(error), Location(source.path, line, column))
    if root and root.kind == "launch":
        if not is_yaml and _is_of_ros1(root):
            root.error = _ROS1
        return root
    if is_yaml:
        what = "the file is not a list of actions below launch:"
    else:
        what = "the root of the file is not <launch>"
    return LaunchFault(f"{what}; ros2 launch starts nothing", Location(source.path, 1, 1))


def _is_of_ros1(root: _Entity) -> bool:
    """Return whether a launch file is one of ROS 1: its nodes have a type."""
    pending = [root]
    while pending:
        entity = pending.pop()
        pending += entity.actions
        if (
            entity.kind == "node"
            and "type" in entity.attributes
            and "exec" not in entity.attributes
        ):
            return True
    return False


def _xml_root(file: XmlFile) -> _Entity:
    def entity(element: Element, depth: int) -> _Entity:
        location = file.location(element)
        attributes = {str(name): str(value) for name, value in element.attrib.items()}
        parsed = _Entity(str(element.tag), Position(location.line, location.column), attributes)
        placed = list(attributes)[:_MAX_PLACES]
        parsed.places = {name: _position_at(file.location(element, name)) for name in placed}
        parsed.actions = [
            entity(child, depth + 1) for child in element.iterchildren("*") if depth < _MAX_DEPTH
        ]
        for inner in parsed.actions:
            parsed.nested.setdefault(inner.kind, []).append(inner)
        return parsed

    return entity(file.root, 0)


@dataclass(slots=True)
class _YamlReader:
    """A reader of entities from YAML's lists and mappings.

    Aliases can multiply them, so they are counted.
    """

    count: int = 0

    def root(self, data: bytes, path: str) -> _Entity | None:
        """Return the entity of the whole file; None where its only key is not launch."""
        check_one_document(data.decode(), path)
        root = read_yaml(data, path)
        node = root.get("launch")
        if not node or not isinstance(root.value, dict) or len(root.value) > 1:
            return None
        return self.entity("launch", node, 0)

    def entries(self, listed: YamlNode, depth: int) -> list[_Entity]:
        """Return the actions of a list, each below its own key. Raises EvaluationFails."""
        entities = []
        for item in listed.items:
            table = item.value if isinstance(item.value, dict) else {}
            if len(table) != 1:
                names = ", ".join(list(table)[:4]) or "nothing"
                message = (
                    f"expected one action below one key, found {names}. Is it indented far enough?"
                )
                raise EvaluationFails(message, _locate_node(item))
            entities += [self.entity(kind, value, depth + 1) for kind, value in table.items()]
        return entities

    def entity(self, kind: str, node: YamlNode, depth: int) -> _Entity:
        """Return one action or element."""
        entity = _Entity(kind, _locate_node(node), is_yaml=True)
        self.count += 1
        if depth > _MAX_DEPTH or self.count > _MAX_ENTITIES:
            raise EvaluationFails("the launch file has too many elements", _locate_node(node))
        if isinstance(node.value, list):
            entity.actions = self.entries(node, depth)
        elif not isinstance(node.value, dict):
            entity.error = f"{kind} has no attributes: write them below it"
        else:
            entity.has_actions = "children" in node.value
            for key, value in node.value.items():
                if key == "children":
                    entity.actions = self.entries(value, depth)
                elif value.items and isinstance(value.items[0].value, dict):
                    entity.nested[key] = [self.entity(key, item, depth + 1) for item in value.items]
                else:
                    entity.attributes[key] = _plain_value(value)
                    entity.places[key] = _position_at(node.key_location(key))
        return entity


def _plain_value(node: YamlNode) -> Any:
    """Return the value of a scalar, or of a list of scalars; None of anything else."""
    if isinstance(node.value, list):
        return [_plain_value(item) for item in node.items]
    text = node.text
    if text is None or node.is_string:
        return text
    try:
        loaded = yaml_value(text) if len(text) < 50 else text  # longer ones are no numbers
    except ValueError:
        return text
    if isinstance(loaded, dict | list) or (isinstance(loaded, str) and loaded != text):
        return text
    return loaded


def _locate_node(node: YamlNode) -> Position:
    return _position_at(node.location)


def _position_at(location: Location) -> Position:
    return Position(location.line, location.column)


def read_actions(parent: _Entity, findings: Findings) -> _Values:
    """Return the actions in an entity; errors, which stop the launch, are added to the findings."""
    values: _Values = []
    for entity in parent.actions:
        try:
            values.append(_read_action(entity, findings))
        except EvaluationFails as error:
            findings.add_fault(str(error), error.at or entity.at)
        except EvaluationSignal as signal:
            values.append(signal.as_unknown(entity.at))
    return values


def _read_action(entity: _Entity, findings: Findings) -> Call:
    kind = entity.kind
    if kind not in _ACTIONS:
        if kind in front_end("action") or kind in added_launch_actions():
            raise Undetermined(f"the action {kind} is not evaluated", entity.at)
        raise EvaluationFails(
            f"there is no action {kind!r}{did_you_mean(kind, _ACTIONS)}", entity.at
        )
    given = _read_attributes(entity, {**_CONDITION_PARTS, **_ACTIONS[kind]})
    condition = _take_condition(given, entity)
    if kind == "lifecycle_node" and not given.keys() >= {*_NAMED}:
        raise Undetermined("a <lifecycle_node> without name and namespace is not evaluated")
    kwargs = {
        _ARGUMENTS.get(name, name): _read_argument(entity, name, value)
        for name, value in given.items()
    }
    if condition:
        kwargs["condition"] = condition
    _add_elements(entity, kwargs)
    if "children" in _ACTIONS[kind]:
        kwargs["actions"] = read_actions(entity, findings)
    name = front_end("action")[kind]
    if "level" in given:
        name = _LOG
    return _checked_call(Call(name, [], kwargs, entity.at))


def _read_attributes(entity: _Entity, parts: _Parts) -> dict[str, Any]:
    """Return the attributes of an entity, of their types. Raises EvaluationSignal."""
    if entity.error:
        raise EvaluationFails(entity.error, entity.at)
    takes_actions = "children" in parts
    if entity.is_yaml and entity.has_actions != takes_actions:
        what = "needs the key children" if takes_actions else "has no list of actions"
        raise EvaluationFails(f"{entity.kind} {what}", entity.at)
    parts = {**parts, _MERGE_KEY: _NOT_EVALUATED}
    _check_names(entity, parts)
    for name, part in parts.items():
        if part.is_required and name not in entity.attributes and name not in entity.nested:
            raise EvaluationFails(f"<{entity.kind}> needs the attribute {name!r}", entity.at)
    return {
        name: _typed_attribute(entity, name, value, parts[name].value)
        for name, value in entity.attributes.items()
    }


def _check_names(entity: _Entity, parts: _Parts) -> None:
    """Compare the names in an entity with those that it may have. Raises EvaluationSignal."""
    inner = [*entity.nested, *(action.kind for action in entity.actions)]
    for name in [*inner, *entity.attributes]:
        if not _is_evaluated(name, entity, parts):
            raise Undetermined(f"{name} of <{entity.kind}> is not evaluated", entity.at)
    if "children" not in parts:
        elements = {name for name, part in parts.items() if part.holds == "elements"}
        for name in inner:
            if name not in elements:
                hint = did_you_mean(name, elements)
                raise EvaluationFails(f"<{entity.kind}> contains no <{name}>{hint}", entity.at)
    _check_attributes(entity, parts)


def _is_evaluated(name: str, entity: _Entity, parts: _Parts) -> bool:
    """Return whether an attribute or element of this name is evaluated in an entity."""
    # value-sep makes a list of the attribute value in XML; YAML has lists itself.
    is_separator = name.endswith("-sep") and name.removesuffix("-sep") in parts
    if is_separator and (name not in parts or entity.is_yaml):
        return False
    return name not in parts or parts[name].is_evaluated


def _check_attributes(entity: _Entity, parts: _Parts) -> None:
    """Raise EvaluationFails for an attribute that an entity may not have."""
    for name in entity.attributes:
        if name not in parts or parts[name].holds != "value":
            hint = _RENAMED.get(name) or did_you_mean(name, parts)
            message = f"<{entity.kind}> has no attribute {name!r}{hint}"
            raise EvaluationFails(message, entity.place(name))


def _typed_attribute(entity: _Entity, name: str, value: Any, wanted: type | None) -> Any:
    """Return an attribute as a value of a type; None: any scalar. Raises EvaluationSignal."""
    if not entity.is_yaml:
        if wanted is str:
            return value
        return _typed_text(value, wanted, entity.place(name))
    if not _is_typed(value, wanted):
        what = f"{name} of {entity.kind} is {value!r}, which YAML reads as {type(value).__name__}"
        if wanted is str:
            hint = "put quotes around it"
        else:
            hint = f"write a {wanted.__name__ if wanted is not None else 'any'}"
        raise EvaluationFails(f"{what}: {hint}", entity.place(name))
    return value


def _checked_call(call: Call) -> Call:
    """Return a call whose arguments its constructor accepts. Raises EvaluationSignal."""
    cls = class_named(call.name)
    doubt = check(cls, call) if cls else None
    if doubt:
        raise doubt.as_signal(doubt.at)
    return call


def _take_condition(given: dict[str, Any], entity: _Entity) -> Call | None:
    """Take the condition out of the attributes."""
    conditions = {name: given.pop(name) for name in ("if", "unless") if name in given}
    if len(conditions) > 1:
        raise EvaluationFails("if and unless cannot be used together", entity.at)
    for name, text in conditions.items():
        kind = "if_condition.IfCondition" if name == "if" else "unless_condition.UnlessCondition"
        kwargs = {"predicate_expression": _parse_value(text, entity.place(name))}
        return Call(f"launch.conditions.{kind}", [], kwargs, entity.at)
    return None


def _read_argument(entity: _Entity, name: str, value: Any) -> Value:
    at = entity.place(name)
    if entity.kind == "arg" and name in ("name", "description"):
        return value  # without substitutions
    if name in ("cmd", "args", "ros_args"):
        return _command_line(value, at)
    if name == "on_exit":
        if value != "shutdown":
            raise EvaluationFails(f"on_exit is 'shutdown', not {value!r}", at)
        return [Call(front_end("action")["shutdown"], [], {}, at)]
    if name == "respawn" or entity.kind == "set_parameter":
        text = "launch.substitutions.text_substitution.TextSubstitution"
        parts = _parse_value(value, at)
        return [
            Call(text, [], {"text": part}, at) if isinstance(part, str) else part for part in parts
        ]
    if name == "period":
        return _parse_if_text(value, at)
    return _parse_value(value, at) if isinstance(value, str) and name not in _RAW else value


def _add_elements(entity: _Entity, kwargs: dict[str, Value]) -> None:
    """Add the arguments that the elements in an entity stand for."""
    if "children" in _ACTIONS[entity.kind]:
        return
    for name, inner in entity.nested.items():
        match name:
            case "param":
                kwargs["parameters"] = [_read_parameter(child) for child in inner]
            case "remap":
                kwargs["remappings"] = _read_pairs(inner, "from", "to")
            case "env":
                pairs = _read_pairs(inner, "name", "value")
                kwargs["additional_env"] = {tuple(given): value for given, value in pairs}
            case "arg" | "let":
                arguments = _read_pairs(inner, "name", "value")
                kwargs["launch_arguments"] = [*kwargs.get("launch_arguments", ()), *arguments]
            case "composable_node" | "composable_lifecycle_node":
                components = map(_read_component, inner)
                before = kwargs.get("composable_node_descriptions", ())
                kwargs["composable_node_descriptions"] = [*before, *components]
            case "choice":
                kwargs["choices"] = [
                    _read_attributes(child, _NESTED[name])["value"] for child in inner
                ]


def _read_component(entity: _Entity) -> Call:
    """Return a component. Raises EvaluationSignal."""
    given = _read_attributes(entity, _NESTED[entity.kind])
    condition = _take_condition(given, entity)
    kwargs = {}
    for name, value in given.items():
        kwargs[_ARGUMENTS.get(name, name)] = _read_argument(entity, name, value)
    if condition:
        kwargs["condition"] = condition
    cls = COMPONENT if entity.kind == "composable_node" else LIFECYCLE_COMPONENT
    component = _checked_call(Call(cls, [], kwargs, entity.place("plugin")))
    if "param" in entity.nested:
        unknown = Unknown("parameters of components are not evaluated", entity.at)
        component.kwargs["parameters"] = unknown  # the check would leave out the whole component
        with suppress(EvaluationSignal):
            component.kwargs["parameters"] = list(map(_read_parameter, entity.nested["param"]))
    if "remap" in entity.nested:
        component.kwargs["remappings"] = Unknown("a remapping is not evaluated", entity.at)
        with suppress(EvaluationSignal):
            component.kwargs["remappings"] = _read_pairs(entity.nested["remap"], "from", "to")
    return component


def _read_pairs(elements: list[_Entity], *names: str) -> list[tuple[_Values, ...]]:
    """Return the values of two attributes of each element. Raises EvaluationSignal."""
    given = [_read_attributes(element, _NESTED[element.kind]) for element in elements]
    pairs = []
    for element, attributes in zip(elements, given, strict=True):
        values = [_parse_value(attributes[name], element.place(name)) for name in names]
        pairs.append(tuple(values))
    return pairs


def _read_parameter(entity: _Entity) -> Value:
    """Return an item of the parameters of a node. Raises EvaluationSignal."""
    given = _read_attributes(entity, _NESTED["param"])
    if ("from" in given) == ("name" in given):
        raise EvaluationFails("a <param> has either name or from", entity.at)
    if "from" in given:
        return _parse_value(str(given["from"]), entity.place("from"))
    parts = _parse_value(given["name"], entity.place("name"))
    name: Value = tuple(parts)
    if len(parts) == 1 and isinstance(parts[0], str):
        name = parts[0]
    inner = entity.nested.get("param")
    if not inner:
        return {name: _read_parameter_value(entity, given)}
    if "value" in given or "type" in given:
        raise EvaluationFails("a <param> has either a value or other <param> in it", entity.at)
    table: dict[Any, Value] = {}
    for element in inner:
        values = _read_parameter(element)
        if isinstance(values, dict):
            table |= values
    return {name: table}


def _read_parameter_value(entity: _Entity, given: Mapping[str, Any]) -> Value:
    """Return the value of a <param> as the ParameterValue that it is in Python.

    Raises EvaluationSignal.
    """
    if "value" not in given:
        raise EvaluationFails("a <param> needs a value", entity.at)
    kind = given.get("type")
    if kind is not None and kind not in _VALUE_TYPES:
        raise EvaluationFails(
            f"a <param> has the type {kind!r}, which is none of {', '.join(_VALUE_TYPES)}",
            entity.at,
        )
    has_separator = "value-sep" in given
    scalar = _SCALARS.get(kind or "")
    if scalar is not None and not entity.is_yaml and not has_separator:
        kwargs = _converted(str(entity.attributes["value"]), scalar, entity)
    elif kind not in (None, "str", "yaml"):
        raise Undetermined(f"a <param> of the type {kind} is not evaluated", entity.at)
    elif has_separator:
        kwargs = {"value": _separated_values(entity, kind)}
    else:
        value = given["value"]
        if kind == "str" and not entity.is_yaml:
            value = entity.attributes["value"]  # as it is written, where the other is a number
        kwargs = {"value": _parse_if_text(value, entity.place("value"))}
        if kind == "str":
            kwargs["value_type"] = Call("builtins.str", [], {}, entity.at)
    return _checked_call(Call(TYPED[0], [], kwargs, entity.at))


def _converted(text: str, kind: type, entity: _Entity) -> dict[str, Value]:
    """Return the arguments of ParameterValue for a value in XML with a type.

    They are converted as by launch's type_utils.py. Raises EvaluationFails.
    """
    if "$(" in text:
        of_kind = Call(f"builtins.{kind.__name__}", [], {}, entity.at)
        return {"value": _parse_if_text(text, entity.place("value")), "value_type": of_kind}
    try:
        with located(entity.at):
            return {"value": boolean(text) if kind is bool else kind(text)}
    except ValueError:
        message = f"the value {text[:40]!r} of a <param> is not {kind.__name__}"
        raise EvaluationFails(message, entity.place("value")) from None


def _separated_values(entity: _Entity, kind: str | None) -> _Values:
    """Return the list that a value in XML is with the attribute value-sep.

    It is split as by launch_xml's entity.py.
    """
    text = str(entity.attributes["value"])
    separator = str(entity.attributes["value-sep"])
    if not separator:
        raise EvaluationFails("value-sep is empty", entity.at)
    items = [_typed_text(part, None, entity.at) for part in text.split(separator)]
    if kind is not None or "$(" in text or len({type(item) for item in items}) > 1:
        raise Undetermined("this list in a <param> is not evaluated", entity.at)
    return [_parse_value(item, entity.at)[0] if isinstance(item, str) else item for item in items]


def _parse_value(text: str, at: Position) -> _Values:
    """Return a value as a list of strings and substitutions. Raises EvaluationFails."""
    parser = _ValueParser(text, at)
    parts = parser.template("", 0)
    return parts or [""]


def _parse_if_text(value: Any, at: Position) -> Any:
    """Return a value; a text is parsed, as each in a list is. Raises EvaluationSignal."""
    if isinstance(value, list):
        if "$(" in str(value):
            raise Undetermined("a list with substitutions is not evaluated", at)
        return [_parse_if_text(item, at) for item in value]
    parts = _parse_value(value, at) if isinstance(value, str) else [value]
    if len(parts) == 1 and not isinstance(parts[0], Call):
        return parts[0]
    return parts


def _command_line(text: str, at: Position) -> list[_Values]:
    """Return the words of a line as launch splits it.

    Strings are split, the values of substitutions are not.
    """
    words: list[_Values] = [[]]
    for piece in _parse_value(text, at):
        if not isinstance(piece, str):
            words[-1].append(piece)
            continue
        try:
            pieces = shlex.split(piece)
        except ValueError:
            raise EvaluationFails(
                "quotes cannot enclose a substitution in a line of arguments: remove them", at
            ) from None
        if piece[:1].isspace() or not pieces:
            words.append([])
        words[-1] += pieces[:1]
        words += [[word] for word in pieces[1:]]
        if piece[-1:].isspace():
            words.append([])
    return [word for word in words if word]


def _typed_text(text: str, kind: type | None, at: Position) -> Any:
    """Return the value of a text in XML as a type, by default any scalar.

    A text that is none of it stays a text.
    """
    if kind is float:
        try:
            return float(text)
        except ValueError:
            return text
    text = {"1": "true", "0": "false"}.get(text, text) if kind is bool else text
    try:
        typed = yaml_value(text) if text else text
    except ValueError:
        return text
    if not _is_typed(typed, kind):
        raise EvaluationFails(
            f"{text[:40]!r} is of no type that is accepted here: put quotes in it", at
        )
    return typed


def _is_typed(value: Any, kind: type | None) -> bool:
    """Return whether a value is a text or of a type; with None, a scalar or a list of them.

    The scalars of a list are texts, and of one type besides: is_instance_of_valid_type() of launch.
    """
    if isinstance(value, list) and kind is None:
        types = {type(item) for item in value} - {str}
        return len(types) < 2 and types <= {bool, int, float}
    return isinstance(value, str | (kind or float) | (kind or int))


@dataclass(slots=True)
class _ValueParser:
    """Parses a value from its beginning to its end."""

    text: str
    at: Position
    position: int = 0

    @property
    def next(self) -> str:
        return self.text[self.position : self.position + 1]

    def template(self, quote: str, depth: int) -> _Values:
        """Return strings and substitutions, up to the closing quote or the end."""
        parts = []
        while self.position < len(self.text) and (not quote or self.next != quote):
            parts.append(self.part(quote, quote, depth))
        if quote and self.position >= len(self.text):
            raise EvaluationFails(f"a quote is not closed in {self.text[:60]!r}", self.at)
        self.position += len(quote)
        return parts

    def part(self, ends: str, quote: str, depth: int) -> Value:
        """Return a substitution, or a string up to the next one or an end."""
        if self.text.startswith("$(", self.position):
            self.position += 2
            return self.substitution(quote, depth + 1)
        start = self.position
        while (
            self.position < len(self.text)
            and not self.text.startswith("$(", self.position)
            and self.next not in ends
        ):
            is_escape = self.next == "\\" and self.text[
                self.position + 1 : self.position + 2
            ] not in ("", " ", "\n")
            self.position += 2 if is_escape else 1
        return re.sub(r"\\(.)", r"\1", self.text[start : self.position])

    def substitution(self, quote: str, depth: int) -> Call:
        """Return the substitution in brackets: a name, and values separated by one space each."""
        name = _NAME.match(self.text, self.position)
        if not name or depth > _MAX_DEPTH:
            raise EvaluationFails(
                f"there is no name of a substitution after $( in {self.text[:60]!r}", self.at
            )
        self.position = name.end()
        values = []
        while self.next == " ":
            self.position += 1
            values.append(self.value(quote, depth))
        if self.next != ")":
            if not self.next:
                what = "is not closed"
            else:
                what = f"has {self.next!r} in an argument without quotes"
            raise EvaluationFails(f"the bracket of $({name[0][:40]} {what}", self.at)
        self.position += 1
        return self.call(name[0], values)

    def value(self, quote: str, depth: int) -> _Values:
        if not quote and self.next in ("'", '"'):
            start = self.next
            self.position += 1
            return self.template(start, depth)
        parts = []
        while self.next and self.next not in _BEFORE_NEXT[quote]:
            parts.append(self.part(_BEFORE_NEXT[quote], quote, depth))
        if not parts:
            raise EvaluationFails(
                f"an argument is missing in {self.text[:60]!r}: write one space between arguments",
                self.at,
            )
        return parts

    def call(self, name: str, values: list[_Values]) -> Call:
        """Return a substitution as the call that it is in Python. Raises EvaluationFails."""
        if name == "command" and len(values) > 1 and values[1] not in _ON_STDERR:
            raise EvaluationFails(
                "$(command ...) needs quotes around its command: $(command 'xacro ...')", self.at
            )
        if name not in _SUBSTITUTIONS:
            self.fail_unknown(name)
        required, optional, rest = _SUBSTITUTIONS[name]
        if rest:
            return self.call_with_rest(name, values)
        names = required + optional
        if not len(required) <= len(values) <= len(names):
            count = "1 argument" if len(names) == 1 else f"{len(names) or 'no'} arguments"
            raise EvaluationFails(f"$({name} ...) takes {count}", self.at)
        kwargs = {}
        for argument, value in zip(names, values, strict=False):
            is_text = are_texts(value)
            kwargs[argument] = "".join(map(str, value)) if is_text else value
        return Call(front_end("substitution")[name], [], kwargs, self.at)

    def fail_unknown(self, name: str) -> NoReturn:
        """Raise for a substitution that is not evaluated, or that does not exist."""
        if name in front_end("substitution"):
            raise Undetermined(f"the substitution $({name} ...) is not evaluated", self.at)
        similar = _SUBSTITUTIONS_OF_ROS1.get(name) or closest(name, _SUBSTITUTIONS)
        hint = f"; did you mean $({similar} ...)?" if similar else ""
        raise EvaluationFails(f"there is no substitution $({name} ...){hint}", self.at)

    def call_with_rest(self, name: str, values: list[_Values]) -> Call:
        """Return a substitution that takes any number of values. Raises EvaluationFails."""
        required, _, rest = _SUBSTITUTIONS[name]
        if len(values) <= len(required):
            count = "2 arguments" if required else "1 argument"
            raise EvaluationFails(f"$({name} ...) takes at least {count}", self.at)
        kwargs = dict(zip(required, values, strict=False))
        kwargs[rest] = values[len(required) :]
        return Call(front_end("substitution")[name], [], kwargs, self.at)


def find_later_words(root: _Entity, findings: Findings) -> None:
    """Add the words of a launch file that not every release has."""
    pending = [root]
    while pending:
        entity = pending.pop()
        pending += entity.actions
        if entity.is_yaml:  # in XML, these are among the actions
            for inner in entity.nested.values():
                pending += inner
        words = [("action", entity.kind, entity.at), ("element", entity.kind, entity.at)]
        for name, value in entity.attributes.items():
            at = entity.place(name)
            words.append(("attribute", f"{entity.kind} {name}", at))
            for substitution in _SUBSTITUTION.findall(str(value)):
                words.append(("substitution", substitution, at))
        for kind, name, at in words:
            since = first_release(kind, name)
            if since:
                findings.add_later(f"there is no {_describe_word(kind, name)}", since, at)


def _describe_word(kind: str, name: str) -> str:
    """Return a word of XML and YAML with what it is."""
    if kind == "substitution":
        return f"substitution $({name} ...)"
    if kind == "attribute":
        element, _, attribute = name.partition(" ")
        return f"attribute {attribute!r} of <{element}>"
    return f"{kind} {name!r}"
