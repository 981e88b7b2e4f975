"""Launch files in XML and YAML: both say the same in two spellings, and come to what a Python launch file would make."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

import yaml

from grader.package.launch.line import Faults, read_line
from grader.package.launch.model import Fault
from grader.package.launch.substitutions import CMDLINE
from grader.package.yaml_nodes import Node, YamlFault, read_yaml
from grader.source import Location, Source
from grader.static_python.values import Made, Spot, Unknown, Value
from grader.xml.parsing import Element, XMLSyntaxError, parse_xml

_MOST_DEPTH = 40
_MOST_ENTITIES = 5_000
# Elements and attributes that only ROS 1 has, and what stands for them.
_ROS1_TAGS = {"param": "a <param> stands inside its <node>", "rosparam": "write <param from=.../> inside the <node>",
              "remap": "a <remap> stands inside its <node>", "machine": "", "test": "", "env": "write <set_env>"}  # fmt: skip
_ROS1_ATTRIBUTES: dict[str, dict[str, str | None]] = {
    "node": {"type": "exec", "package": "pkg", "executable": "exec", "ns": "namespace", "required": None},
    "arg": {"value": "default", "default_value": "default", "doc": "description"},
    "param": {"command": "value", "textfile": "value"},
    "group": {"ns": None},
    "include": {"ns": None, "pass_all_args": None},
}
_NODES = {"node": "Node", "lifecycle_node": "LifecycleNode"}
_IDLE = re.compile(r"(?:log|set|append|prepend|reset|push|pop|unset|rep|shutdown)(?:[_-]\w*)?")
_TAGGED = yaml.SafeLoader("")  # tells which plain texts YAML takes for a number or for true and false


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
    faults: Faults = field(default_factory=list)
    unknown: Faults = field(default_factory=list)


def read_frontend(data: bytes, path: str, *, is_yaml: bool) -> Frontend:
    """Read a launch file in XML or YAML; never raises."""
    source = Source(path, data.decode("utf-8", "replace"))
    frontend = Frontend(source)
    try:
        root = _YamlReader(frontend).root(data, path) if is_yaml else _xml_root(data, source)
    except YamlFault as fault:
        frontend.syntax = Fault(f"not readable as YAML: {fault}", fault.location)
        return frontend
    except (XMLSyntaxError, ValueError) as error:
        line, column = getattr(error, "position", (1, 1))
        words = " ".join(str(getattr(error, "msg", error)).split(", line ")[0].split())
        frontend.syntax = Fault(f"not readable as XML: {words}", Location(path, max(line, 1), max(column, 1)))
        return frontend
    if root is None or root.kind != "launch":
        what = "the root of the file is not <launch>" if not is_yaml else "the file is not one list under launch:"
        frontend.syntax = Fault(f"{what}; ros2 launch reads nothing of it", Location(path, 1, 1))
        return frontend
    frontend.description = Made("launch.LaunchDescription", [_actions(root, frontend)], {}, root.at)
    return frontend


def _xml_root(data: bytes, source: Source) -> Entity:
    root = parse_xml(data)
    places = {element: index for index, element in enumerate(root.iter("*"))}

    def entity(element: Element, depth: int) -> Entity:
        try:
            where = source.tag(places[element])
        except IndexError:  # the text is in some encoding in which its tags are not seen
            where = Location(source.path, 1, 1)
        made = Entity(str(element.tag), Spot(where.line, where.column), dict(element.attrib.items()))  # type: ignore[arg-type]
        if depth < _MOST_DEPTH:
            made.children = [entity(child, depth + 1) for child in element.iterchildren("*")]
        return made

    return entity(root, 0)


class _YamlReader:
    """Makes entities of YAML's lists and mappings; aliases may make them many, so they are counted."""

    def __init__(self, frontend: Frontend) -> None:
        self.frontend = frontend
        self.count = 0

    def root(self, data: bytes, path: str) -> Entity | None:
        """The entity that the whole file is; None where its only key is not launch."""
        root = read_yaml(data, path)
        node = root.get("launch")
        if node is None or not isinstance(root.value, dict) or len(root.value) > 1:
            return None
        made = Entity("launch", _spot(node))
        made.children += self.entries(node if node.items else (node.get("children") or node), 0)
        return made

    def entries(self, listed: Node, depth: int) -> Iterator[Entity]:
        """The actions of a list, each under a key of its own."""
        for item in listed.items:
            table = item.value if isinstance(item.value, dict) else {}
            if len(table) != 1:
                names = ", ".join(list(table)[:4]) or "nothing"
                message = f"one action is expected here, under one key; there is {names}. Is it indented far enough?"
                self.frontend.faults.append((message, _spot(item)))
            for kind, value in list(table.items())[:1]:
                yield self.entity(kind, value, depth + 1)

    def entity(self, kind: str, node: Node, depth: int) -> Entity:
        """One action or element."""
        made = Entity(kind, _spot(node))
        self.count += 1
        if depth > _MOST_DEPTH or self.count > _MOST_ENTITIES:
            self.frontend.unknown[:] = [("it holds more than is followed", Spot(1, 1))]
            return made
        if not isinstance(node.value, dict):
            made.children += self.entries(node, depth)
            return made
        for key, value in merged(node).items():
            if value.text is not None:
                made.attributes[key] = value.text
                self.check(kind, key, value)
            elif key == "children":
                made.children += self.entries(value, depth)
            else:
                made.children += [self.entity(key, item, depth + 1) for item in value.items or [value]]
        return made

    def check(self, kind: str, key: str, value: Node) -> None:
        """Note a number, or true or false, where launch takes a text only."""
        if value.quoted or (kind, key) not in _TEXTS:
            return
        tag: str = _TAGGED.resolve(yaml.ScalarNode, value.text, (True, False))  # type: ignore[no-untyped-call]
        if tag.rpartition(":")[2] in ("bool", "int", "float", "null"):
            message = (
                f"{key} of {kind} has to be a text; YAML takes {value.text!r} for something else without its quotes"
            )
            self.frontend.faults.append((message, _spot(value)))


_TEXTS = frozenset(
    (kind, key)
    for kind, keys in {
        "arg": ("name", "default", "value"),
        "let": ("name", "value"),
        "node": ("pkg", "exec", "name", "namespace", "args", "if", "unless"),
        "include": ("file", "if", "unless"),
        "group": ("if", "unless"),
        "executable": ("cmd", "if", "unless"),
    }.items()
    for key in keys
)


def merged(node: Node) -> dict[str, Node]:
    """A mapping with what `<<` merges into it."""
    table = node.value if isinstance(node.value, dict) else {}
    given = table.get("<<")
    if given is None:
        return table
    found: dict[str, Node] = {}
    for each in reversed(given.items or [given]):
        found |= each.value if isinstance(each.value, dict) else {}
    found |= table
    del found["<<"]
    return found


def _spot(node: Node) -> Spot:
    return Spot(node.location.line, node.location.column)


def _actions(parent: Entity, frontend: Frontend) -> list[Value]:
    return [made for child in parent.children if (made := _action(child, frontend)) is not None]


def _action(entity: Entity, frontend: Frontend) -> Made | None:
    _note_ros1(entity, frontend)
    given = {key: read_line(value, entity.at, frontend.faults) for key, value in entity.attributes.items()}
    kwargs: dict[str, Value] = {}
    if "if" in given:
        kwargs["condition"] = Made("launch.conditions.IfCondition", [given["if"]], {}, entity.at)
    elif "unless" in given:
        kwargs["condition"] = Made("launch.conditions.UnlessCondition", [given["unless"]], {}, entity.at)
    match entity.kind:
        case _ if entity.kind in _NODES:
            return _node(entity, given, kwargs, frontend)
        case "arg":
            default = given.get("default", given.get("value", given.get("default_value")))
            kwargs |= {"name": entity.attributes.get("name"), "default_value": default}
            return Made("launch.actions.DeclareLaunchArgument", [], kwargs, entity.at)
        case "let":
            kwargs |= {"name": entity.attributes.get("name"), "value": given.get("value")}
            return Made("launch.actions.SetLaunchConfiguration", [], kwargs, entity.at)
        case "include":
            passed = [
                (each.attributes.get("name", ""), read_line(each.attributes.get("value", ""), each.at, frontend.faults))
                for each in entity.children
                if each.kind in ("arg", "let")
            ]
            kwargs |= {"launch_description_source": given.get("file"), "launch_arguments": passed}
            return Made("launch.actions.IncludeLaunchDescription", [], kwargs, entity.at)
        case "executable":
            kwargs["cmd"] = [Made(CMDLINE, given.get("cmd", []), {}, entity.at)]
            return Made("launch.actions.ExecuteProcess", [], kwargs, entity.at)
        case "group" | "timer":
            kwargs["actions"] = _actions(entity, frontend)
            kwargs["scoped"] = entity.kind == "group" and entity.attributes.get("scoped", "true").lower() in (
                "true",
                "1",
            )
            return Made("launch.actions.GroupAction", [], kwargs, entity.at)
        case _:
            if entity.kind not in _ROS1_TAGS and not _IDLE.fullmatch(entity.kind):
                frontend.unknown.append((f"what <{entity.kind[:40]}> starts is told only by a run", entity.at))
            return None


def _note_ros1(entity: Entity, frontend: Frontend) -> None:
    """Note what ROS 2's launch does not know, for all that ROS 1's did."""
    if entity.kind in _ROS1_TAGS:
        more = _ROS1_TAGS[entity.kind]
        message = f"<{entity.kind}> at this place is of ROS 1, and unknown to ROS 2" + (f": {more}" if more else "")
        frontend.faults.append((message, entity.at))
    for element in (entity, *(each for each in entity.children if each.kind == "param")):
        for wrong, right in _ROS1_ATTRIBUTES.get(element.kind, {}).items():
            if wrong in element.attributes:
                more = f"; the attribute is called {right!r}" if right else ""
                message = f"<{element.kind}> has no {wrong!r} in ROS 2's launch files{more}"
                frontend.faults.append((message, element.at))


def _node(entity: Entity, given: dict[str, Value], kwargs: dict[str, Value], frontend: Frontend) -> Made:
    for wrong, right in _ROS1_ATTRIBUTES["node"].items():
        if wrong in given and right is not None and right not in given:
            given[right] = given[wrong]
    table: dict[str, Value] = {}
    parameters: list[Value] = [table]
    for child in entity.children:
        name = child.attributes.get("name")
        if child.kind == "param" and name is not None:
            value = next((child.attributes[key] for key in ("value", "command") if key in child.attributes), None)
            table[name] = (
                read_line(value, child.at, frontend.faults)
                if value is not None
                else Unknown("this parameter has no value", child.at)
            )
        elif child.kind == "param":
            parameters.append(read_line(child.attributes.get("from", ""), child.at, frontend.faults))
    named = {"package": given.get("pkg"), "executable": given.get("exec")}
    kwargs |= {"parameters": parameters, **{key: value for key, value in named.items() if value is not None}}
    kwargs["arguments"] = [Made(CMDLINE, given["args"], {}, entity.at)] if "args" in given else []
    return Made(f"launch_ros.actions.{_NODES[entity.kind]}", [], kwargs, entity.at)
