"""Launch files in XML and YAML: both have the same elements, which are read as entities."""

from dataclasses import dataclass, field
from typing import Any

import yaml

from grader.package.launch.model import LaunchFault
from grader.package.yaml_nodes import YamlFault, YamlNode, read_yaml
from grader.python.parse import START, Position
from grader.python.values import EvaluationFails
from grader.source import Location, Source
from grader.xml.parsing import Element, XmlFault, XmlFile

_MAX_DEPTH = 40
_MAX_ENTITIES = 5_000


@dataclass(slots=True)
class Entity:
    """One element of a launch file: <node pkg="..."/>, or `- node: {pkg: ...}`.

    `attributes` are texts in XML, values in YAML. `nested` has the elements in it by their names, `actions` those that
    are actions of a group.
    """

    kind: str
    at: Position
    attributes: dict[str, Any] = field(default_factory=dict)
    nested: "dict[str, list[Entity]]" = field(default_factory=dict)
    actions: "list[Entity]" = field(default_factory=list)
    is_yaml: bool = False
    has_actions: bool = True  # in YAML: whether it is a list, or has the key children
    error: str = ""  # what is wrong with its form


def read_frontend(data: bytes, source: Source, *, is_yaml: bool) -> Entity | LaunchFault:
    """Return the root entity of a launch file in XML or YAML, or why it cannot be read. Never raises."""
    try:
        root = _YamlReader().root(data, source.path) if is_yaml else _xml_root(XmlFile(data, source))
    except (YamlFault, XmlFault) as fault:
        return LaunchFault(f"not readable as {'YAML' if is_yaml else 'XML'}: {fault}", fault.location)
    except EvaluationFails as error:
        line, column = error.at or START
        return LaunchFault(str(error), Location(source.path, line, column))
    if root is not None and root.kind == "launch":
        return root
    what = "the file is not a list of actions below launch:" if is_yaml else "the root of the file is not <launch>"
    return LaunchFault(f"{what}; ros2 launch starts nothing", Location(source.path, 1, 1))


def _xml_root(file: XmlFile) -> Entity:
    def entity(element: Element, depth: int) -> Entity:
        location = file.location(element)
        attributes = {str(name): str(value) for name, value in element.attrib.items()}
        found = Entity(str(element.tag), Position(location.line, location.column), attributes)
        found.actions = [entity(it, depth + 1) for it in element.iterchildren("*") if depth < _MAX_DEPTH]
        for inner in found.actions:
            found.nested.setdefault(inner.kind, []).append(inner)
        return found

    return entity(file.root, 0)


@dataclass(slots=True)
class _YamlReader:
    """A reader of entities from YAML's lists and mappings; aliases can multiply them, so they are counted."""

    count: int = 0

    def root(self, data: bytes, path: str) -> Entity | None:
        """Return the entity of the whole file; None where its only key is not launch."""
        root = read_yaml(data, path)
        node = root.get("launch")
        if node is None or not isinstance(root.value, dict) or len(root.value) > 1:
            return None
        return self.entity("launch", node, 0)

    def entries(self, listed: YamlNode, depth: int) -> list[Entity]:
        """Return the actions of a list, each below its own key. Raises EvaluationFails."""
        found: list[Entity] = []
        for item in listed.items:
            table = item.value if isinstance(item.value, dict) else {}
            if len(table) != 1:
                names = ", ".join(list(table)[:4]) or "nothing"
                message = f"expected one action below one key, found {names}. Is it indented far enough?"
                raise EvaluationFails(message, _position(item))
            found += [self.entity(kind, value, depth + 1) for kind, value in table.items()]
        return found

    def entity(self, kind: str, node: YamlNode, depth: int) -> Entity:
        """Return one action or element."""
        entity = Entity(kind, _position(node), is_yaml=True)
        self.count += 1
        if depth > _MAX_DEPTH or self.count > _MAX_ENTITIES:
            raise EvaluationFails("the launch file has too many elements", _position(node))
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
                    entity.attributes[key] = _plain(value)
        return entity


def _plain(node: YamlNode) -> Any:
    """Return the value of a scalar, or of a list of scalars; None of anything else."""
    if isinstance(node.value, list):
        return [_plain(item) for item in node.items]
    text = node.text
    if text is None or node.quoted:
        return text
    try:
        found = yaml.safe_load(text) if len(text) < 50 else text  # longer ones are no numbers
    except (yaml.YAMLError, ValueError):
        return text
    return text if isinstance(found, dict | list) or (isinstance(found, str) and found != text) else found


def _position(node: YamlNode) -> Position:
    return Position(node.location.line, node.location.column)
