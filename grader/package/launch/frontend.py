"""Launch files in XML and YAML: both have the same elements, which are read as entities."""

from dataclasses import dataclass, field

import yaml

from grader.package.launch.model import Findings, LaunchFault
from grader.package.yaml_nodes import YamlFault, YamlNode, read_yaml
from grader.source import Location, Source
from grader.static_python.parse import START, Position
from grader.xml.parsing import Element, XmlFault, XmlFile

_MAX_DEPTH = 40
_MAX_ENTITIES = 5_000
_YAML = yaml.SafeLoader("")  # decides which plain scalars are numbers, booleans or null
# The attributes that have to be strings.
_STRINGS = {
    "arg": ("name", "default", "value"),
    "let": ("name", "value"),
    "node": ("pkg", "exec", "name", "namespace", "args", "if", "unless"),
    "include": ("file", "if", "unless"),
    "group": ("if", "unless"),
    "executable": ("cmd", "if", "unless"),
}


@dataclass(slots=True)
class Entity:
    """One element of a launch file: <node pkg="..."/>, or `- node: {pkg: ...}`."""

    kind: str
    at: Position
    attributes: dict[str, str] = field(default_factory=dict)
    children: "list[Entity]" = field(default_factory=list)


def read_frontend(data: bytes, source: Source, findings: Findings, *, is_yaml: bool) -> Entity | LaunchFault:
    """Return the root entity of a launch file in XML or YAML, or why it cannot be read. Never raises."""
    try:
        root = _YamlReader(findings).root(data, source.path) if is_yaml else _xml_root(XmlFile(data, source))
    except (YamlFault, XmlFault) as fault:
        return LaunchFault(f"not readable as {'YAML' if is_yaml else 'XML'}: {fault}", fault.location)
    if root is not None and root.kind == "launch":
        return root
    what = "the file is not a list of actions below launch:" if is_yaml else "the root of the file is not <launch>"
    return LaunchFault(f"{what}; ros2 launch starts nothing", Location(source.path, 1, 1))


def _xml_root(file: XmlFile) -> Entity:
    def entity(element: Element, depth: int) -> Entity:
        location = file.location(element)
        attributes = {str(name): str(value) for name, value in element.attrib.items()}
        children = element.iterchildren("*") if depth < _MAX_DEPTH else ()
        at = Position(location.line, location.column)
        return Entity(str(element.tag), at, attributes, [entity(child, depth + 1) for child in children])

    return entity(file.root, 0)


@dataclass(slots=True)
class _YamlReader:
    """A reader of entities from YAML's lists and mappings; aliases can multiply them, so they are counted."""

    findings: Findings
    count: int = 0

    def root(self, data: bytes, path: str) -> Entity | None:
        """Return the entity of the whole file; None where its only key is not launch."""
        root = read_yaml(data, path)
        node = root.get("launch")
        if node is None or not isinstance(root.value, dict) or len(root.value) > 1:
            return None
        listed = node if node.items else node.get("children") or node
        return Entity("launch", _position(node), {}, self.entries(listed, 0))

    def entries(self, listed: YamlNode, depth: int) -> list[Entity]:
        """Return the actions of a list, each below its own key."""
        found: list[Entity] = []
        for item in listed.items:
            table = item.value if isinstance(item.value, dict) else {}
            if len(table) != 1:
                names = ", ".join(list(table)[:4]) or "nothing"
                message = f"expected one action below one key, found {names}. Is it indented far enough?"
                self.findings.add_fault(message, _position(item))
            found += [self.entity(kind, value, depth + 1) for kind, value in list(table.items())[:1]]
        return found

    def entity(self, kind: str, node: YamlNode, depth: int) -> Entity:
        """Return one action or element."""
        entity = Entity(kind, _position(node))
        self.count += 1
        if depth > _MAX_DEPTH or self.count > _MAX_ENTITIES:
            self.findings.add_unknown("the launch file has too many elements", START)
            return entity
        if not isinstance(node.value, dict):
            entity.children += self.entries(node, depth)
            return entity
        for key, value in merge_keys(node).items():
            if value.text is not None:
                entity.attributes[key] = value.text
                self.check_string(kind, key, value)
            elif key == "children":
                entity.children += self.entries(value, depth)
            else:
                entity.children += [self.entity(key, item, depth + 1) for item in value.items or [value]]
        return entity

    def check_string(self, kind: str, key: str, value: YamlNode) -> None:
        """Add an error for a number, boolean or null where launch takes strings only."""
        if value.quoted or key not in _STRINGS.get(kind, ()):
            return
        tag: str = _YAML.resolve(yaml.ScalarNode, value.text, (True, False))  # type: ignore[no-untyped-call]
        if tag.rpartition(":")[2] in ("bool", "int", "float", "null"):
            message = (
                f"{key} of {kind} must be a string, but YAML reads {value.text} as another type: put quotes around it"
            )
            self.findings.add_fault(message, _position(value))


def merge_keys(node: YamlNode) -> dict[str, YamlNode]:
    """Return a mapping with what `<<` merges into it."""
    table = node.value if isinstance(node.value, dict) else {}
    given = table.get("<<")
    if given is None:
        return table
    found: dict[str, YamlNode] = {}
    for other in reversed(given.items or [given]):
        found |= other.value if isinstance(other.value, dict) else {}
    return {key: value for key, value in {**found, **table}.items() if key != "<<"}


def _position(node: YamlNode) -> Position:
    return Position(node.location.line, node.location.column)
