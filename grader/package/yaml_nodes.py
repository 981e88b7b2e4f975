"""YAML with the place of every value: read event by event, so that neither depth nor aliases can blow it up."""

from collections.abc import Iterator
from dataclasses import dataclass, field

import yaml

from grader.source import Location

_MOST_EVENTS = 100_000
_MOST_ALIASES = 1000
_MOST_DEPTH = 200  # the parser takes its time over each bracket that is open


class YamlFault(Exception):
    """A text that is not YAML: what is wrong, and where."""

    def __init__(self, message: str, location: Location) -> None:
        super().__init__(message)
        self.location = location


@dataclass(eq=False, slots=True)
class Node:
    """A value and its place: a text as it is written, a list, or a mapping; an alias is the very node that it names.

    `quoted` tells a text in quotes from a plain one such as true or 1.
    """

    location: Location
    value: "str | list[Node] | dict[str, Node]"
    quoted: bool = False
    _key: "str | None" = field(default=None, repr=False)

    def get(self, *keys: str) -> "Node | None":
        """What is found below a mapping by these keys, one inside the other."""
        node: Node | None = self
        for key in keys:
            node = node.value.get(key) if node is not None and isinstance(node.value, dict) else None
        return node

    @property
    def text(self) -> str | None:
        """A single value's text; None of lists and mappings."""
        return self.value if isinstance(self.value, str) else None

    @property
    def items(self) -> "list[Node]":
        """The entries of a list; none of other values."""
        return self.value if isinstance(self.value, list) else []


def read_yaml(data: bytes, path: str) -> Node:
    """The first document of a YAML text; raises YamlFault. An empty text is an empty mapping."""
    is_wide = data.startswith((b"\xff\xfe", b"\xfe\xff"))
    text = data.decode("utf-16" if is_wide else "utf-8", "replace")
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    try:
        return _compose(yaml.parse(text, Loader=loader), path)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        last = text.count("\n") + 1  # at the end of a text without a line end, the parser is one line further
        place = Location(path, min(mark.line + 1, last), mark.column + 1) if mark else Location(path, 1, 1)
        words = " ".join(each for each in (error.context, error.problem) if each)
        raise YamlFault(words or "it is no YAML", place) from None
    except yaml.YAMLError as error:  # such as characters that YAML forbids
        raise YamlFault(" ".join(str(error).split())[:200], Location(path, 1, 1)) from None
    except RecursionError:
        raise YamlFault("it is too deeply nested", Location(path, 1, 1)) from None


def _compose(events: Iterator[yaml.Event], path: str) -> Node:
    root = Node(Location(path, 1, 1), {})
    open_nodes: list[Node] = []
    anchors: dict[str, Node] = {}
    aliases = 0
    first = True
    for count, event in enumerate(events):
        if count > _MOST_EVENTS:
            raise YamlFault("it holds far more than any such file", root.location)
        if isinstance(event, yaml.CollectionEndEvent):
            open_nodes.pop()
        elif isinstance(event, yaml.DocumentEndEvent):
            break
        if not isinstance(event, yaml.NodeEvent):
            continue
        if isinstance(event, yaml.AliasEvent):
            aliases += 1
            found = anchors.get(event.anchor or "")
            if found is None or aliases > _MOST_ALIASES:
                reason = "more aliases than any such file has" if found else f"an alias of nothing: {event.anchor}"
                raise YamlFault(reason, _location(event, path))
            node = found
        else:
            node = _node(event, path)
            if event.anchor:
                anchors[event.anchor] = node
        if open_nodes:
            _attach(open_nodes[-1], node)
        elif first:
            root, first = node, False
        if isinstance(event, yaml.CollectionStartEvent):
            open_nodes.append(node)
            if len(open_nodes) > _MOST_DEPTH:
                raise YamlFault("it is too deeply nested", node.location)
    return root


def _node(event: yaml.NodeEvent, path: str) -> Node:
    place = _location(event, path)
    if isinstance(event, yaml.ScalarEvent):
        return Node(place, event.value, quoted=event.style in ("'", '"'))
    return Node(place, {} if isinstance(event, yaml.MappingStartEvent) else [])


def _attach(parent: Node, node: Node) -> None:
    if isinstance(parent.value, list):
        parent.value.append(node)
    elif isinstance(parent.value, dict) and parent._key is None:  # noqa: SLF001  a node is built here
        parent._key = node.text if node.text is not None else f"\0{len(parent.value)}"  # noqa: SLF001
    elif isinstance(parent.value, dict):
        parent.value[parent._key or ""] = node  # noqa: SLF001  the last one counts, for PyYAML as for RViz
        parent._key = None  # noqa: SLF001


def _location(event: yaml.Event, path: str) -> Location:
    mark = event.start_mark
    return Location(path, mark.line + 1, mark.column + 1) if mark is not None else Location(path, 1, 1)
