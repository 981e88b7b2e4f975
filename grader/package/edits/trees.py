"""The difference between two files of XML or YAML: their elements and settings, as edits of the text."""

import re
from collections.abc import Iterator

from grader.difference import Node, Step, steps
from grader.edits import Proposal, text_of, with_attribute, with_child
from grader.markup import attribute, head_end
from grader.package.edits.task import Verb, change
from grader.package.xml_file import XmlFault, XmlFile
from grader.package.yaml_nodes import Node as YamlNode
from grader.package.yaml_nodes import YamlFault, read_yaml
from grader.source import Edit, Location, Source
from grader.xml.parsing import Element

_SCALAR = re.compile(r""""[^"\n]*"|'[^'\n]*'|[^\s#][^\n\r]*?(?=\s*(?:\r?\n|$|\s#))""")
_MAX_DEPTH, _MAX_CHILDREN = 8, 200
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


_VERBS: dict[str, Verb] = {"add": "add", "unset": "remove"}


def _place(step: Step) -> str:
    node = step.like or step.own
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
        return Node(str(element.tag), (key,), values, children, source.offset(place.line, place.column))

    return node(file.root, _MAX_DEPTH)


def _xml_edit(source: Source, like: Source, step: Step) -> Edit | None:
    start = step.own.of
    found = attribute(source.text, start, step.name) if step.name else None
    match step:
        case Step(verb="set", name="", like=Node(values=values)):
            end, is_empty = head_end(source.text, start)
            text = source.text[end : source.text.find("<", end)]
            first = end + len(text) - len(text.lstrip())
            return None if is_empty else source.edit(first, first + len(text.strip()), values[""])
        case Step(verb="set", like=Node(values=values)):
            return with_attribute(source, start, step.name, values[step.name])
        case Step(verb="unset") if found is not None:
            return source.edit(found.start - 1, found.end, "")
        case Step(verb="add", like=Node(of=place)):
            return with_child(source, start, text_of(like, place))
    return None


def _yaml_tree(source: Source) -> Node | None:
    try:
        root = read_yaml(source.text.encode("utf-8", "surrogateescape"), source.path)
    except YamlFault:
        return None
    manager = root.get("Visualization Manager")
    return _yaml_node("Visualization Manager", manager) if manager is not None else None


def _yaml_node(tag: str, node: YamlNode, depth: int = _MAX_DEPTH) -> Node:
    items = node.value.items() if isinstance(node.value, dict) else [("-", item) for item in node.items]
    values = {name: item.text for name, item in items if item.text is not None}
    kind = values.get("Class", "").rpartition("/")[2]
    children = [_yaml_node(name, item, depth - 1) for name, item in items if item.text is None and depth][
        :_MAX_CHILDREN
    ]
    return Node(kind or tag, (tag, values.get("Name", "")), values, children, node)


def _yaml_edit(source: Source, like: Source, step: Step) -> Edit | None:
    mine, its = step.own.of, step.like.of if step.like is not None else None
    match step:
        case Step(verb="set") if its is not None and step.name in its.value:
            new = _scalar(like, its.value[step.name].location)
            old = mine.get(step.name)
            if old is not None:
                start = source.offset(old.location.line, old.location.column)
                text = _scalar(source, old.location)
                gap = " " if not text and source.text[start - 1 : start].strip() else ""
                return source.edit(start, start + len(text), gap + new)
            return _inserted(source, mine, f"{step.name}: {new}")
        case Step(verb="add", like=Node(tag=tag)) if its is not None:
            text = _block(like, its)
            return _inserted(source, mine, f"- {text}" if isinstance(mine.value, list) else f"{tag}:\n  {text}")
    return None


def _scalar(source: Source, at: Location) -> str:
    """Return the text of a value at a place, with its quotes."""
    found = _SCALAR.match(source.text, source.offset(at.line, at.column))
    return found[0] if found is not None else ""


def _inserted(source: Source, into: YamlNode, text: str) -> Edit | None:
    """Return the edit that adds lines at the start of a mapping or list."""
    at = into.location
    start, indent = source.offset(at.line, at.column), " " * (at.column - 1)
    if not into.value:
        text = f"\n{' ' * (len(source.line(at.line)) - len(source.line(at.line).lstrip()) + 2)}{text}"
        return source.edit(start, start + 2, text) if source.text[start : start + 2] in ("[]", "{}") else None
    newline = "\r\n" if "\r\n" in source.text else "\n"
    return source.edit(start, start, f"{text}\n".replace("\n", newline + indent))


def _block(source: Source, node: YamlNode) -> str:
    """Return the lines of a mapping, the first one without its indentation, the others two deeper than it."""
    first, depth = node.location.line, node.location.column - 1
    lines = source.text.split("\n")[first - 1 :]
    ends = (number for number, line in enumerate(lines[1:], 1) if line.strip() and not line.startswith(" " * depth))
    return "\n  ".join(line[depth:].rstrip() for line in lines[: next(ends, len(lines))]).rstrip()
