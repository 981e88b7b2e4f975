"""The difference between two files of XML, YAML or Python: elements, settings and calls, as edits of the text."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from typing import NamedTuple

from grader.difference import Node, Step, steps
from grader.edits import Proposal, element_text, with_attribute, with_child
from grader.markup import attributes, head_end
from grader.package.edits.task import Verb, change
from grader.package.edits.wording import slip
from grader.package.yaml_nodes import YamlFault, YamlNode, read_yaml
from grader.source import Edit, Source
from grader.xml.parsing import Element, XmlFault, XmlFile

_VERBS: Mapping[str, Verb] = {"set": "set", "add": "add", "move": "add"}  # others: rename

Span = tuple[int, int]
_SCALAR = re.compile(
    r"""
      "[^"\n]*" | '[^'\n]*'
    | [^\s#][^\n\r]*?(?=\s*(?:\r?\n|$|\s\#))    # base_link, of "Fixed Frame: base_link  # of the robot"
    """,
    re.VERBOSE,
)
_MAX_DEPTH, _MAX_CHILDREN = 8, 200
_IDENTIFYING = ("exec", "name", "pkg", "file")  # attributes of an element


class TreePlace(NamedTuple):
    """Where a node is in its text, and the edits that add a value or a node to it; `code` is how to write it elsewhere.

    `codes` and `spans` are those of its values, and `names` the offsets of their names.
    """

    label: str
    code: str
    codes: Mapping[str, str]
    spans: Mapping[str, Span]
    names: Mapping[str, Span]
    with_value: Callable[[str, str], Edit | None]
    with_child: Callable[[str], Edit | None]
    with_tag: Callable[[str], Edit] | None = None


def tree_proposals(
    source: Source,
    trees: tuple[Node | None, Node | None],
    what: str,
    needs: Callable[[str], Iterable[Edit]] = lambda _: (),
) -> Iterator[Proposal]:
    """Yield the edits that undo one difference each to another tree.

    The `of` of each node returns its place, and `needs` the edits that a text needs in the file.
    """
    own, like = trees
    found = steps(own, like) if own is not None and like is not None else []
    found += [*_others(own, found)] if own is not None else []

    alike: dict[tuple[object, ...], list[Proposal]] = {}  # missing in one place; a mistake that is made everywhere
    for step in found:
        code, edit = _edit(source, step)
        if edit is not None:
            made = change([*needs(code), edit], _VERBS.get(step.verb, "rename"), _words(step), what)
            is_new = not edit.old
            yield made._replace(rank=int(_is_whole(step)))
            key = (step.own.of,) if is_new else (edit.old.rpartition("/")[0], edit.new.rpartition("/")[0])
            alike.setdefault(key, []).append(made)
    for (old, *_), several in alike.items():
        if old and len(several) > 1:
            yield several[0]._replace(edits=tuple(dict.fromkeys(edit for it in several for edit in it.edits)))


def _others(root: Node, found: Iterable[Step]) -> Iterator[Step]:
    """Yield steps that add what other steps make of a node: it may be missing beside it."""
    for step in found:
        new = step.like.values[step.name] if step.verb == "set" and step.like is not None else ""
        if step.like and new and new in step.like.keys and not slip(step.own.values.get(step.name, ""), [new]):
            above = (it for it in root.walk() if it.of and any(child is step.own for child in it.children))
            yield from (Step("add", it, step.like) for it in above)


def _is_whole(step: Step) -> bool:
    """Return whether a value is replaced that is a node in both trees: its own differences come first."""
    nodes = [node for node in (step.own, step.like) if node is not None]
    return all(step.name in [child.tag for child in node.children] for node in nodes)


def _words(step: Step) -> str:
    label = step.own.of().label
    label = label if not step.name or step.name.isdigit() else f"`{step.name}` of {label}"
    return f"the value of {label}" if step.verb == "set" else label


def _edit(source: Source, step: Step) -> tuple[str, Edit | None]:
    """Return the text that a step writes, and its edit; None where it has none."""
    own, like, name = step.own, step.like, step.name
    mine: TreePlace = (step.parent or own).of()
    if like is None:
        return "", None
    its: TreePlace = like.of()
    if step.verb in ("add", "move"):
        return its.code, mine.with_child(its.code)
    if step.verb == "retag":
        return "", mine.with_tag(like.tag) if mine.with_tag else None
    if step.verb == "set":
        code = its.codes[name]
        return code, source.edit(*mine.spans[name], code) if name in mine.spans else mine.with_value(name, code)
    others = (it for it, value in like.values.items() if it not in own.values and value == own.values[name])
    new = step.other or next(others, "")  # the same value may have another name
    return "", source.edit(*mine.names[name], new) if new and name in mine.names else None


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
        whole, at = element_text(source, start), source.text.find(text, end)
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

    def add(code: str) -> Edit:
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
        return TreePlace(kind, code, codes, spans, {}, lambda name, code: add(f"{name}: {code}"), add)

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
