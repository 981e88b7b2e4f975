"""YAML with the location of each value.

It is read by event: neither depth nor aliases use unlimited time or memory.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import yaml

from grader.base.grouping import Span, Strings
from grader.base.patterns import on_use
from grader.base.source import Location, Source

_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_MAX_EVENTS = 25_000
_LIKE_AN_ALIAS = on_use(r"(?<![\w/*])\*\w")  # not the key /**
_MAX_ALIASES = 1000
_MAX_AGAIN = 2_000  # values that a walk looks at again, for which aliases stand
_MAX_DEPTH = 200  # the parser gets slower with each open bracket
_TAGS = frozenset(
    f"tag:yaml.org,2002:{name}"
    for name in (
        "null",
        "bool",
        "int",
        "float",
        "str",
        "seq",
        "map",
        "binary",
        "timestamp",
        "omap",
        "pairs",
        "set",
    )
)
_TEXT = "tag:yaml.org,2002:str"
_DEEP = "the file is too deeply nested"
# of newer versions of libyaml, which look ahead of the events
_TOO_DEEP = "exceeded maximum nesting depth"


class YamlFault(Exception):
    """A text that is not YAML, with the location of the error."""

    def __init__(self, message: str, location: Location) -> None:
        super().__init__(message)
        self.location = location


@dataclass(frozen=True, eq=False, slots=True)
class YamlNode:
    """A value with its location: a text, a list or a mapping.

    An alias is the same object as its anchor.
    """

    source: Source
    mark: Any  # PyYAML's; a Location is made only on demand
    value: "str | list[YamlNode] | dict[str, YamlNode]"
    quoted: bool = False  # a text in quotes, which is a string even if it is true or 1
    end_mark: Any = None  # of a text
    tag: str = ""  # of a text
    key_marks: dict[str, Any] = field(default_factory=dict)  # of a mapping
    replaced: list[tuple[str, "YamlNode"]] = field(
        default_factory=list
    )  # values of keys that are written again

    @property
    def location(self) -> Location:
        """Where it begins."""
        return _locate_mark(self.source, self.mark)

    @property
    def span(self) -> Span:
        """The offsets of the start and the end of a text, with its quotes."""
        shift = int(self.source.text.startswith("\ufeff"))
        return self.mark.index + shift, self.end_mark.index + shift

    @property
    def is_string(self) -> bool:
        """Whether it is a string even if it is true or 1: by its quotes or its tag."""
        return self.quoted or self.tag == _TEXT

    @property
    def has_type(self) -> bool:
        """Whether a tag says which type it has, and not that it is a string."""
        return self.tag in _TAGS - {_TEXT}

    def get(self, *keys: str) -> "YamlNode | None":
        """Return the node at a path of keys, None where there is none."""
        node: YamlNode | None = self
        for key in keys:
            node = node.value.get(key) if node and isinstance(node.value, dict) else None
        return node

    def key_location(self, *keys: str) -> Location:
        """Return where the last of some keys, which are there, begins."""
        mapping = self.find_mapping(keys)
        assert mapping
        return _locate_mark(mapping.source, mapping.key_marks[keys[-1]])

    def find_mapping(self, keys: "Strings") -> "YamlNode | None":
        """Return the mapping that has the last of some keys."""
        reached = {self: None}
        for above in keys[:-1]:
            inside: dict[YamlNode, None] = {}
            for mapping in reached:
                inside |= dict.fromkeys(inner for key, inner in mapping.pairs if key == above)
            reached = inside
        return next((mapping for mapping in reached if keys[-1] in mapping.key_marks), None)

    @property
    def text(self) -> str | None:
        """The text of a scalar; None for lists and mappings."""
        if isinstance(self.value, str):
            return self.value
        return None

    @property
    def table(self) -> "dict[str, YamlNode]":
        """The keys of a mapping with their values; nothing for other values."""
        return self.value if isinstance(self.value, dict) else {}

    @property
    def pairs(self) -> "list[tuple[str, YamlNode]]":
        """The keys of a mapping with their values, as rcl reads them.

        Keys that are written again are among them.
        """
        if isinstance(self.value, dict):
            return [*self.replaced, *self.value.items()]
        return []

    @property
    def items(self) -> "list[YamlNode]":
        """The entries of a list; no entries for other values."""
        if isinstance(self.value, list):
            return self.value
        return []


class Visits:
    """The lists and mappings that a walk through a file has entered.

    An alias is the same object as its anchor: a file of 2 KB has millions of paths. A walk enters
    each object once, and again only while what it looks at again is little.
    """

    def __init__(self) -> None:
        self._entered: set[YamlNode] = set()
        self._again = _MAX_AGAIN
        self.is_complete = True  # whether the walk may enter all of the file

    def enters(self, node: YamlNode) -> bool:
        """Return whether the walk may look into a list or mapping; a text has nothing in it."""
        if isinstance(node.value, str):
            return True
        if node in self._entered:
            self._again -= 1 + len(node.value) + len(node.replaced)
            self.is_complete = self.is_complete and self._again >= 0
            return self._again >= 0
        self._entered.add(node)
        return True


def yaml_value(text: str) -> Any:
    """Return the value of a short YAML text: a number, a text, a list.

    Raises ValueError if it has none.
    """
    try:
        loaded = yaml.load(text, Loader=_LOADER)  # noqa: S506  a safe loader
        # libyaml takes tabs that yaml.safe_load refuses.
        return yaml.safe_load(text) if "\t" in text else loaded
    except (yaml.YAMLError, RecursionError) as error:
        raise ValueError(str(error)) from None


def check_one_document(text: str, path: str) -> None:
    """Raise YamlFault for what yaml.safe_load refuses besides.

    This is a second document, and a tag that it does not know.
    """
    source = Source(path, text)
    documents = 0
    depth = 0
    try:
        for count, event in enumerate(yaml.parse(text, Loader=_LOADER)):
            documents += isinstance(event, yaml.DocumentStartEvent)
            depth += isinstance(event, yaml.CollectionStartEvent) - isinstance(
                event, yaml.CollectionEndEvent
            )
            tag = getattr(event, "tag", None)
            if count > _MAX_EVENTS or depth > _MAX_DEPTH:
                return
            if documents > 1:
                raise YamlFault("a second document begins", _locate_mark(source, event.start_mark))
            if tag not in (None, "!") and tag not in _TAGS:
                raise YamlFault(
                    f"the tag {tag[:40]} is not known", _locate_mark(source, event.start_mark)
                )
    except yaml.YAMLError:
        return  # which is reported where the nodes are read


def yaml_root(source: Source) -> YamlNode | None:
    """Return the root of a text; None where it is no YAML."""
    try:
        return read_yaml(source.text.encode("utf-8", "surrogateescape"), source.path)
    except YamlFault:
        return None


def read_yaml(data: bytes, path: str) -> YamlNode:
    """Return the first document of a YAML text; an empty text is an empty mapping.

    Raises YamlFault.
    """
    is_wide = data.startswith((b"\xff\xfe", b"\xfe\xff"))
    text = data.decode("utf-16" if is_wide else "utf-8", "replace")
    source = Source(path, text)
    try:
        return _compose_nodes(yaml.parse(text.removeprefix("\ufeff"), Loader=_LOADER), source)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        location = _locate_mark(source, mark) if mark else Location(path, 1, 1)
        if error.problem == _TOO_DEEP:
            raise YamlFault(_DEEP, Location(path, 1, 1)) from None
        message = f"{error.context or ''} {error.problem or ''}".strip()
        raise YamlFault(message or "this is not YAML", location) from None
    except yaml.YAMLError as error:  # such as characters that YAML forbids
        raise YamlFault(" ".join(str(error).split())[:200], Location(path, 1, 1)) from None
    except RecursionError:
        raise YamlFault(_DEEP, Location(path, 1, 1)) from None


def first_alias(source: Source) -> tuple[str, Location] | None:
    """Return the name and the place of the first alias in a text that is YAML; None without one."""
    may_have_one = _LIKE_AN_ALIAS.search(source.text) is not None
    for event in (
        yaml.parse(source.text.removeprefix("\ufeff"), Loader=_LOADER) if may_have_one else ()
    ):
        if isinstance(event, yaml.AliasEvent):
            return event.anchor or "", _locate_mark(source, event.start_mark)
    return None


def _locate_mark(source: Source, mark: Any) -> Location:
    """Return the location of a mark by its offset.

    The lines of YAML also end at separators of Unicode.
    """
    return source.at(min(mark.index + source.text.startswith("\ufeff"), len(source.text)))


def _compose_nodes(events: Iterator[yaml.Event], source: Source) -> YamlNode:
    root = YamlNode(source, next(events).start_mark, {})
    open_nodes: list[
        tuple[YamlNode, list[YamlNode]]
    ] = []  # each with the key in it whose value follows
    anchors = _Anchors(source)
    first = True
    for count, event in enumerate(events, 1):
        if count > _MAX_EVENTS:
            raise YamlFault(f"the file has more than {_MAX_EVENTS} values", root.location)
        if not isinstance(event, yaml.NodeEvent):
            if isinstance(event, yaml.CollectionEndEvent):
                open_nodes.pop()
            elif isinstance(event, yaml.DocumentEndEvent):
                break
            continue
        node = anchors.node(event)
        if open_nodes:
            _attach_node(*open_nodes[-1], node)
        elif first:
            root = node
            first = False
        if isinstance(event, yaml.CollectionStartEvent):
            open_nodes.append((node, []))
            if len(open_nodes) > _MAX_DEPTH:
                raise YamlFault(_DEEP, Location(source.path, 1, 1))
    return root


class _Anchors:
    """The nodes that aliases stand for, by the names of their anchors."""

    def __init__(self, source: Source) -> None:
        self._source = source
        self._nodes = dict[str, YamlNode]()
        self._aliases = 0

    def node(self, event: yaml.NodeEvent) -> YamlNode:
        """Return the node of an event.

        Raises YamlFault for an alias without an anchor, and for too many.
        """
        if isinstance(event, yaml.AliasEvent):
            return self._resolve_alias(
                event.anchor or "", _locate_mark(self._source, event.start_mark)
            )
        if isinstance(event, yaml.ScalarEvent):
            node = YamlNode(
                self._source,
                event.start_mark,
                event.value,
                event.style in ("'", '"'),
                event.end_mark,
                event.tag or "",
            )
        else:
            node = YamlNode(
                self._source,
                event.start_mark,
                [] if isinstance(event, yaml.SequenceStartEvent) else {},
            )
        if event.anchor:
            self._nodes[event.anchor] = node
        return node

    def _resolve_alias(self, anchor: str, location: Location) -> YamlNode:
        self._aliases += 1
        anchored = self._nodes.get(anchor)
        if not anchored:
            raise YamlFault(f"there is no anchor for the alias {anchor}", location)
        if self._aliases > _MAX_ALIASES:
            raise YamlFault(f"the file has more than {_MAX_ALIASES} aliases", location)
        return anchored


def _attach_node(parent: YamlNode, key: list[YamlNode], node: YamlNode) -> None:
    if isinstance(parent.value, list):
        parent.value.append(node)
    elif not key:
        key.append(node)
    elif isinstance(parent.value, dict):
        named = key.pop()
        name = named.text if named.text is not None else f"\0{len(parent.value)}"
        if name in parent.value:
            parent.replaced.append((name, parent.value[name]))
        parent.value[name] = node  # the last key counts, in PyYAML as in RViz
        parent.key_marks[name] = named.mark
