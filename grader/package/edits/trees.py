"""The difference between two files of XML or YAML: their elements and settings, as edits of the text."""

import re
from collections.abc import Iterator, Mapping

from grader.difference import Node, Step, steps
from grader.edits import Proposal, text_of, with_attribute, with_child
from grader.markup import attribute, head_end
from grader.package.edits.task import Verb, change
from grader.package.xml_file import XmlFault, XmlFile
from grader.package.yaml_nodes import Node as YamlNode
from grader.package.yaml_nodes import YamlFault, read_yaml
from grader.source import Edit, Source
from grader.xml.parsing import Element

_SCALAR = re.compile(r""""[^"\n]*"|'[^'\n]*'|[^\s#][^\n\r]*?(?=\s*(?:\r?\n|$|\s#))""")
_MAX_DEPTH, _MAX_CHILDREN = 8, 200
_VERBS: Mapping[str, Verb] = {"add": "add", "retag": "rename", "unset": "rename"}
_IDENTIFYING = ("exec", "name", "pkg", "file")  # attributes of an element


def tree_proposals(own: Source, like: Source, given: frozenset[str], what: str) -> Iterator[Proposal]:
    """Yield the edits that undo one difference each between two files, first those to a value that a check is given."""
    read, write = (_yaml_tree, _yaml_edit) if own.path.endswith((".rviz", ".yaml", ".yml")) else (_xml_tree, _xml_edit)
    mine, its = read(own), read(like)
    found = steps(mine, its) if mine is not None and its is not None else []

    def order(step: Step) -> bool:
        return not any(given.intersection(node.values.values()) for node in (step.like.walk() if step.like else ()))

    same: dict[tuple[str, str], list[Edit]] = {}
    for step in sorted(found, key=order):
        edit = write(own, like, step)
        if edit is not None:
            yield change([edit], _VERBS.get(step.verb, "set"), _place(step), what)
            same.setdefault((edit.old.rpartition("/")[0], edit.new.rpartition("/")[0]), []).append(edit)
    for (old, _), edits in same.items():  # one mistake that is made everywhere, such as classes of ROS 1
        if old and len(edits) > 1:
            yield change(edits, "set", "the same value in several places", what)


def _place(step: Step) -> str:
    node = step.own if step.verb in ("retag", "unset") else step.like or step.own
    tag = f"<{node.tag}>" if node.of.__class__ is int else node.tag
    name = f"`{step.name}` of {tag}" if step.name else tag
    return f"the value of {name}" if step.verb == "set" else name


def _xml_tree(source: Source) -> Node | None:
    try:
        file = XmlFile(source.text.encode("utf-8", "surrogateescape"), source)
    except XmlFault:
        return None

    def node(element: Element, depth: int) -> Node:
        text = (element.text or "").strip()
        values = {**{str(name): str(value) for name, value in element.attrib.items()}, **({"": text} if text else {})}
        key = next((values[name] for name in (*_IDENTIFYING, "") if name in values), "")
        place = file.location(element)
        children = [node(child, depth - 1) for child in element.iterchildren("*") if depth][:_MAX_CHILDREN]
        return Node(
            str(element.tag), (key, values.get("pkg", "")), values, children, source.offset(place.line, place.column)
        )

    return node(file.root, _MAX_DEPTH)


def _xml_edit(source: Source, like: Source, step: Step) -> Edit | None:
    start = step.own.of
    match step:
        case Step(verb="set", name="", like=Node(values=values)):
            end, is_empty = head_end(source.text, start)
            text = source.text[end : source.text.find("<", end)]
            first = end + len(text) - len(text.lstrip())
            return None if is_empty else source.edit(first, first + len(text.strip()), values[""])
        case Step(verb="set", like=Node(values=values)):
            return with_attribute(source, start, step.name, values[step.name])
        case Step(verb="unset", name=name, own=own, like=Node(values=values)):  # the same value, by another name
            found = attribute(source.text, start, name)
            new = next((it for it, value in values.items() if it not in own.values and value == own.values[name]), None)
            return source.edit(found.start, found.start + len(name), new) if found and new else None
        case Step(verb="retag", own=own, like=Node(tag=tag)):
            text = text_of(source, start)
            return source.edit(start, start + len(text), tag.join(text.rsplit(own.tag, 1)).replace(own.tag, tag, 1))
        case Step(verb="add", like=Node(of=place)):
            return with_child(source, start, text_of(like, place))
    return None


def _yaml_tree(source: Source) -> Node | None:
    try:
        root = read_yaml(source.text.encode("utf-8", "surrogateescape"), source.path)
    except YamlFault:
        return None
    manager = root.get("Visualization Manager")
    return _yaml_node("Visualization Manager", manager, []) if manager is not None else None


def _yaml_node(tag: str, node: YamlNode, seen: list[YamlNode], depth: int = _MAX_DEPTH) -> Node:
    items = node.value.items() if isinstance(node.value, dict) else [("-", item) for item in node.items]
    values = {name: item.text for name, item in items if item.text is not None}
    kind = values.get("Class", "").rpartition("/")[2]
    inner = [(name, item) for name, item in items if item.text is None and depth and item not in seen][:_MAX_CHILDREN]
    seen += [item for _, item in inner]
    children = [_yaml_node(name, item, seen, depth - 1) for name, item in inner]
    return Node(kind or tag, (tag, values.get("Name", "")), values, children, node)


def _yaml_edit(source: Source, like: Source, step: Step) -> Edit | None:
    mine, its = step.own.of, step.like.of if step.like is not None else None
    match step:
        case Step(verb="set") if its is not None and step.name in its.value:
            start, end = scalar_span(like, its.value[step.name])
            new, old = like.text[start:end], mine.get(step.name)
            if old is not None:
                start, end = scalar_span(source, old)
                gap = " " if start == end and source.text[start - 1 : start].strip() else ""
                return source.edit(start, end, gap + new)
            return _inserted(source, mine, f"{step.name}: {new}")
        case Step(verb="add", like=Node(tag=tag)) if its is not None:
            text = _block(like, its)
            return _inserted(source, mine, f"- {text}" if isinstance(mine.value, list) else f"{tag}:\n  {text}")
    return None


def scalar_span(source: Source, node: YamlNode) -> tuple[int, int]:
    """Return the offsets of the text of a value, with its quotes."""
    start = source.offset(node.location.line, node.location.column)
    found = _SCALAR.match(source.text, start)
    return start, found.end() if found is not None else start


def _inserted(source: Source, into: YamlNode, text: str) -> Edit:
    """Return the edit that adds lines at the start of a mapping or list."""
    at = into.location
    start, indent = source.offset(at.line, at.column), " " * (at.column - 1)
    newline = "\r\n" if "\r\n" in source.text else "\n"
    return source.edit(start, start, f"{text}\n".replace("\n", newline + indent))


def line_span(source: Source, node: YamlNode) -> tuple[int, int]:
    """Return the offsets of the lines of a mapping: up to the next line that is not as deep as its keys."""
    number, last = node.location.line + 1, source.text.count("\n") + 1
    indent = " " * (node.location.column - 1)
    while number <= last and (not source.line(number).strip() or source.line(number).startswith(indent)):
        number += 1
    return source.offset(node.location.line, 1), source.offset(number, 1) if number <= last else len(source.text)


def _block(source: Source, node: YamlNode) -> str:
    """Return the lines of a mapping, the first one without its indentation, the others two deeper than it."""
    start, end = line_span(source, node)
    lines = source.text[start:end].split("\n")
    return "\n  ".join(line[node.location.column - 1 :].rstrip() for line in lines).rstrip()
