"""The values in YAML parameter files, each with the keys above it."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any, NamedTuple

from grader.base.names import near
from grader.ros.config.yaml_nodes import YamlNode

PARAMETERS = "ros__parameters"
_MAX_DEPTH = 30


class YamlValue(NamedTuple):
    """A text, or a list of texts, with its keys; `node` has its place."""

    keys: tuple[str, ...]
    node: YamlNode

    @property
    def said(self) -> str:
        """What the file calls it: its last two keys."""
        return ".".join([key for key in self.keys if key != PARAMETERS][-2:])

    def texts(self) -> Iterator[tuple[str, YamlNode]]:
        """Yield its text, or those in its list, each with its node."""
        for node in [self.node, *self.node.items]:
            if node.text is not None:
                yield node.text, node


def values_in(node: YamlNode, keys: tuple[str, ...] = ()) -> Iterator[YamlValue]:
    """Yield the values of a tree of mappings, also of those in lists."""
    if len(keys) > _MAX_DEPTH:
        return
    if isinstance(node.value, dict):
        for key, inner in node.value.items():
            yield from values_in(inner, (*keys, key))
    else:
        yield YamlValue(keys, node)
        for number, item in enumerate(node.items):
            if isinstance(item.value, dict):
                yield from values_in(item, (*keys, str(number)))


def sections_in(
    node: YamlNode, keys: tuple[str, ...] = ()
) -> Iterator[tuple[tuple[str, ...], YamlNode]]:
    """Yield the parameters of each node in a parameter file: the keys of the node, and the mapping
    below.
    """
    for key, inner in node.pairs if len(keys) <= _MAX_DEPTH else ():
        if key == PARAMETERS:
            yield keys, _nested(inner)
        else:
            yield from sections_in(inner, (*keys, key))


def _nested(node: YamlNode) -> YamlNode:
    """Return parameters with tables in place of keys with dots, as rcl reads them."""
    if not isinstance(node.value, dict) or not any("." in key for key in node.value):
        return node
    tables, places = dict[str, YamlNode](), dict[str, Any]()
    for key, inner in node.value.items():
        outer, _, last = key.partition(".")
        if last:
            table = replace(inner, value={last: inner}, key_marks={last: node.key_marks[key]})
        else:
            table = inner
        before = tables.get(outer)
        if before is not None and isinstance(before.value, dict) and isinstance(table.value, dict):
            marks = before.key_marks | table.key_marks
            table = replace(before, value=before.value | table.value, key_marks=marks)
        tables[outer] = table
        places.setdefault(outer, node.key_marks[key])
    return replace(node, value={key: _nested(it) for key, it in tables.items()}, key_marks=places)


def is_misspelt_key(key: str, node: YamlNode) -> bool:
    """Return whether a key with a mapping surely stands for ros__parameters."""
    return isinstance(node.value, dict) and near(key, [PARAMETERS]) is not None


def is_parameters(node: YamlNode) -> bool:
    """Return whether a file has parameters of nodes."""
    return next(sections_in(node), None) is not None
