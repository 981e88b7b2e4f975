"""Launch files in XML and YAML: both say the same in two spellings, and come to what a Python launch file would make."""

from collections.abc import Iterator
from dataclasses import dataclass, field

from grader.robot.source import Location, Source
from grader.robot.xml import Element, XMLSyntaxError, parse_xml
from grader.submission.launch.model import Fault
from grader.submission.python.values import Made, Spot, Value
from grader.submission.yaml_nodes import Node, YamlFault, read_yaml

_MOST_DEPTH = 60
# What a frontend's substitution is called in Python.
_SUBSTITUTIONS = {
    "find-pkg-share": "launch_ros.substitutions.FindPackageShare",
    "find-pkg-prefix": "launch_ros.substitutions.FindPackagePrefix",
    "var": "launch.substitutions.LaunchConfiguration",
    "command": "launch.substitutions.Command",
    "find-exec": "launch.substitutions.FindExecutable",
    "dirname": "launch.substitutions.ThisLaunchFileDir",
    "env": "launch.substitutions.EnvironmentVariable",
}
_ROS1 = {"find": "find-pkg-share", "arg": "var", "optenv": "env"}
_OTHER = (
    "eval",
    "exec-in-pkg",
    "anon",
    "not",
    "and",
    "or",
    "equals",
    "if",
    "filename",
    "anonymous",
    "file-content",
    "contents",
)
_ROS1_ATTRIBUTES = {"type": "exec", "package": "pkg", "executable": "exec"}


@dataclass(slots=True)
class Entity:
    """One element of a launch file: <node pkg="..."/>, or `- node: {pkg: ...}`."""

    kind: str
    at: Spot
    attributes: dict[str, str] = field(default_factory=dict)
    children: "list[Entity]" = field(default_factory=list)


@dataclass(slots=True)
class Frontend:
    """A file in XML or YAML as the description that it makes, with what is wrong in it; or the reason why it is unreadable."""

    source: Source
    description: Made | None = None
    syntax: Fault | None = None
    faults: list[tuple[str, Spot]] = field(default_factory=list)


def read_frontend(data: bytes, path: str, *, is_yaml: bool) -> Frontend:
    """Read a launch file in XML or YAML; never raises."""
    source = Source(path, data.decode("utf-8", "replace"))
    frontend = Frontend(source)
    try:
        root = _yaml_root(data, path) if is_yaml else _xml_root(data, source)
    except YamlFault as fault:
        frontend.syntax = Fault(f"not readable as YAML: {fault}", fault.location)
        return frontend
    except (XMLSyntaxError, ValueError) as error:
        line, column = getattr(error, "position", (1, 1))
        words = str(getattr(error, "msg", error)).split(", line ")[0]
        frontend.syntax = Fault(f"not readable as XML: {words}", Location(path, max(line, 1), max(column, 1)))
        return frontend
    if root is None or root.kind != "launch":
        what = "the root of the file is not <launch>" if not is_yaml else "the file does not begin with launch:"
        frontend.syntax = Fault(f"{what}; ros2 launch reads nothing of it", Location(path, 1, 1))
        return frontend
    frontend.description = Made("launch.LaunchDescription", [_actions(root, frontend)], {}, root.at)
    return frontend


def _xml_root(data: bytes, source: Source) -> Entity:
    root = parse_xml(data)
    places = {element: index for index, element in enumerate(root.iter())}

    def entity(element: Element, depth: int) -> Entity:
        where = source.tag(places[element])
        made = Entity(str(element.tag), Spot(where.line, where.column), dict(element.attrib.items()))  # type: ignore[arg-type]
        if depth < _MOST_DEPTH:
            made.children = [entity(child, depth + 1) for child in element]
        return made

    return entity(root, 0)


def _yaml_root(data: bytes, path: str) -> Entity | None:
    node = read_yaml(data, path).get("launch")
    return _yaml_entity("launch", node, 0) if node is not None else None


def _yaml_entity(kind: str, node: Node, depth: int) -> Entity:
    made = Entity(kind, Spot(node.location.line, node.location.column))
    if depth > _MOST_DEPTH:
        return made
    if isinstance(node.value, dict):
        for key, value in node.value.items():
            if value.text is not None:
                made.attributes[key] = value.text
            else:
                made.children += _yaml_children(key, value, depth)
    elif isinstance(node.value, list):
        made.children += _yaml_children("", node, depth)
    return made


def _yaml_children(key: str, node: Node, depth: int) -> Iterator[Entity]:
    """A list below a key: of actions, each with its own key, or of elements of the key's kind, such as param."""
    for item in node.items or [node]:
        table = item.value if isinstance(item.value, dict) else {}
        inner = list(table.items())
        if key in ("", "children", "launch") or (len(inner) == 1 and not isinstance(inner[0][1].value, str)):
            for kind, value in inner:
                yield _yaml_entity(kind, value, depth + 1)
        else:
            yield _yaml_entity(key, item, depth + 1)


def _actions(parent: Entity, frontend: Frontend) -> list[Value]:
    return [made for child in parent.children if (made := _action(child, frontend)) is not None]


def _action(entity: Entity, frontend: Frontend) -> Made | None:
    given = {key: _text(value, entity.at, frontend) for key, value in entity.attributes.items()}
    kwargs: dict[str, Value] = {}
    if "if" in given:
        kwargs["condition"] = Made("launch.conditions.IfCondition", [given["if"]], {}, entity.at)
    elif "unless" in given:
        kwargs["condition"] = Made("launch.conditions.UnlessCondition", [given["unless"]], {}, entity.at)
    match entity.kind:
        case "node":
            return _node(entity, given, kwargs, frontend)
        case "arg":
            arguments = {
                "name": entity.attributes.get("name"),
                "default_value": given.get("default", given.get("value")),
            }
            return Made("launch.actions.DeclareLaunchArgument", [], arguments, entity.at)
        case "let":
            arguments = {"name": entity.attributes.get("name"), "value": given.get("value")}
            return Made("launch.actions.SetLaunchConfiguration", [], arguments, entity.at)
        case "include":
            inner = [each for each in entity.children if each.kind in ("arg", "let")]
            passed = [
                (each.attributes.get("name", ""), _text(each.attributes.get("value", ""), each.at, frontend))
                for each in inner
            ]
            kwargs |= {"launch_description_source": given.get("file"), "launch_arguments": passed}
            return Made("launch.actions.IncludeLaunchDescription", [], kwargs, entity.at)
        case "executable":
            kwargs["cmd"] = [given.get("cmd")]
            return Made("launch.actions.ExecuteProcess", [], kwargs, entity.at)
        case "group" | "timer":
            kwargs["actions"] = _actions(entity, frontend)
            return Made("launch.actions.GroupAction", [], kwargs, entity.at)
        case _:
            return None


def _node(entity: Entity, given: dict[str, Value], kwargs: dict[str, Value], frontend: Frontend) -> Made:
    for wrong, right in _ROS1_ATTRIBUTES.items():
        if wrong in given and right not in given:
            message = f"a node has no {wrong!r} in ROS 2's launch files; the attribute is called {right!r}"
            frontend.faults.append((message, entity.at))
            given[right] = given[wrong]
    table: dict[str, Value] = {}
    parameters: list[Value] = [table]
    for child in entity.children:
        name = child.attributes.get("name")
        if child.kind == "param" and name is not None:
            table[name] = _text(child.attributes.get("value", ""), child.at, frontend)
        elif child.kind == "param":
            parameters.append(_text(child.attributes.get("from", ""), child.at, frontend))
    kwargs |= {"package": given.get("pkg"), "executable": given.get("exec"), "parameters": parameters}
    kwargs["arguments"] = [given["args"]] if "args" in given else []
    return Made("launch_ros.actions.Node", [], kwargs, entity.at)


def _text(text: str, at: Spot, frontend: Frontend) -> list[Value]:
    """A value with its substitutions, as a list of texts and what Python would call them."""
    pieces, _ = _pieces(text, 0, at, frontend, 0)
    return pieces


def _pieces(text: str, start: int, at: Spot, frontend: Frontend, depth: int) -> tuple[list[Value], int]:
    """Texts and substitutions from a place on, up to the bracket that closes the substitution around it."""
    pieces: list[Value] = []
    plain = ""
    position = start
    while position < len(text):
        if text.startswith("$(", position) and depth < _MOST_DEPTH:
            if plain:
                pieces.append(plain)
                plain = ""
            substitution, position = _substitution(text, position + 2, at, frontend, depth + 1)
            pieces.append(substitution)
        elif text[position] == ")" and depth:
            break
        elif depth and text[position] in "'\"":
            position += 1
        else:
            plain += text[position]
            position += 1
    if plain or not pieces:
        pieces.append(plain)
    return pieces, position + 1


def _substitution(text: str, start: int, at: Spot, frontend: Frontend, depth: int) -> tuple[Made, int]:
    end = start
    while end < len(text) and text[end] not in " \t\n)":
        end += 1
    name = text[start:end]
    while end < len(text) and text[end] in " \t\n":
        end += 1
    inner, position = _pieces(text, end, at, frontend, depth)
    if name in _ROS1:
        frontend.faults.append((f"$({name} ...) is of ROS 1; in ROS 2 it is $({_ROS1[name]} ...)", at))
        name = _ROS1[name]
    elif name not in _SUBSTITUTIONS and name not in _OTHER:
        frontend.faults.append((f"there is no substitution $({name[:40]} ...)", at))
    full = _SUBSTITUTIONS.get(name, f"launch.substitutions.{name}")
    if name == "var" and len(inner) == 1 and isinstance(inner[0], str):
        variable, _, default = inner[0].strip().partition(" ")
        return Made(full, [variable] + ([default.strip()] if default else []), {}, at), position
    return Made(full, [inner], {}, at), position
