"""Files of XML and YAML as trees."""

import re
from functools import partial

from grader.difference import Node
from grader.edits import text_of, with_attribute, with_child
from grader.markup import attributes, head_end
from grader.package.edits.trees import TreePlace
from grader.package.xml_file import XmlFault, XmlFile
from grader.package.yaml_nodes import YamlFault, YamlNode, read_yaml
from grader.source import Edit, Source
from grader.xml.parsing import Element

_SCALAR = re.compile(
    r"""
      "[^"\n]*" | '[^'\n]*'
    | [^\s#][^\n\r]*?(?=\s*(?:\r?\n|$|\s\#))    # base_link, of "Fixed Frame: base_link  # of the robot"
    """,
    re.VERBOSE,
)
_MAX_DEPTH, _MAX_CHILDREN = 8, 200
_IDENTIFYING = ("exec", "name", "pkg", "file")  # attributes of an element


def markup_tree(source: Source) -> Node | None:
    """Return a file of XML or YAML as a tree; None of one that cannot be read."""
    data = source.text.encode("utf-8", "surrogateescape")
    try:
        if source.path.endswith(".xml"):
            file = XmlFile(data, source)
            return _element(source, file, file.root, _MAX_DEPTH)
        return _yaml(source, "the file", read_yaml(data, source.path), [], _MAX_DEPTH)
    except (XmlFault, YamlFault):
        return None


def _element(source: Source, file: XmlFile, element: Element, depth: int) -> Node:
    """Return an element: its attributes are values, and its text is one without a name."""
    text, tag, place = (element.text or "").strip(), str(element.tag), file.location(element)
    values = {**{str(name): str(value) for name, value in element.attrib.items()}, **({"": text} if text else {})}
    key = next((values[name] for name in (*_IDENTIFYING, "") if name in values), "")
    children = [_element(source, file, child, depth - 1) for child in element.iterchildren("*") if depth]
    start = source.offset(place.line, place.column)

    def of() -> TreePlace:
        end, _ = head_end(source.text, start)
        whole, at = text_of(source, start), source.text.find(text, end)
        names = {it.name: (it.start, it.start + len(it.name)) for it in attributes(source.text, start)}

        def with_tag(new: str) -> Edit:
            renamed = new.join(whole.rsplit(tag, 1)).replace(tag, new, 1)
            return source.edit(start, start + len(whole), renamed)

        adding = partial(with_attribute, source, start), partial(with_child, source, start)
        return TreePlace(
            f"<{tag}>", whole, values, {"": (at, at + len(text))} if text else {}, names, *adding, with_tag
        )

    return Node(tag, (key, values.get("pkg", "")), values, children[:_MAX_CHILDREN], of)


def _yaml(source: Source, tag: str, node: YamlNode, seen: list[YamlNode], depth: int) -> Node:
    """Return a mapping or a list: its texts are values, and the others nodes."""
    items = node.value.items() if isinstance(node.value, dict) else [("-", item) for item in node.items]
    texts = {name: item for name, item in items if item.text is not None}
    values = {name: item.text or "" for name, item in texts.items()}
    kind = values.get("Class", "").rpartition("/")[2] or tag
    inner = [(name, it) for name, it in items if it.text is None and depth and it not in seen][:_MAX_CHILDREN]
    seen += [item for _, item in inner]

    def added(code: str) -> Edit:
        """Return the edit that adds lines at the start."""
        at, dash = node.location, "- " * isinstance(node.value, list)
        start, indent = source.offset(at.line, at.column), " " * (at.column - 1)
        newline = "\r\n" if "\r\n" in source.text else "\n"
        return source.edit(start, start, f"{dash}{code}\n".replace("\n", newline + indent))

    def of() -> TreePlace:
        spans = {name: scalar_span(source, item) for name, item in texts.items()}
        codes = {name: source.text[slice(*span)] for name, span in spans.items()}
        lines = source.text[slice(*line_span(source, node))].split("\n")  # the first one without its indentation
        block = "\n  ".join(line[node.location.column - 1 :].rstrip() for line in lines).rstrip()
        code = f"{tag}:\n  {block}".removeprefix("-:\n  ")
        return TreePlace(kind, code, codes, spans, {}, lambda name, code: added(f"{name}: {code}"), added)

    children = [_yaml(source, name, item, seen, depth - 1) for name, item in inner]
    return Node(kind, (tag, values.get("Name", "")), values, children, of)


def scalar_span(source: Source, node: YamlNode) -> tuple[int, int]:
    """Return the offsets of the text of a value, with its quotes."""
    start = source.offset(node.location.line, node.location.column)
    found = _SCALAR.match(source.text, start)
    return start, found.end() if found is not None else start


def line_span(source: Source, node: YamlNode) -> tuple[int, int]:
    """Return the offsets of the lines of a mapping: up to the next line that is not as deep as its keys."""
    number, last = node.location.line + 1, source.text.count("\n") + 1
    indent = " " * (node.location.column - 1)
    while number <= last and (not source.line(number).strip() or source.line(number).startswith(indent)):
        number += 1
    return source.offset(node.location.line, 1), source.offset(number, 1) if number <= last else len(source.text)
