"""The values in YAML parameter files, each with the keys above it."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from grader.base.grouping import Strings
from grader.base.names import near
from grader.base.records import Named
from grader.ros.config.yaml_nodes import Visits, YamlNode

PARAMETERS = "ros__parameters"
_MAX_DEPTH = 30


class YamlValue(Named):
    """A text, or a list of texts, with its keys; `node` has its place."""

    keys: Strings
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


def values_in(node: YamlNode) -> Iterator[YamlValue]:
    """Yield the values of a tree of mappings, also of those in lists."""
    yield from _values_below(node, (), Visits())


def _values_below(node: YamlNode, keys: Strings, visits: Visits) -> Iterator[YamlValue]:
    if len(keys) > _MAX_DEPTH or not visits.enters(node):
        return
    if isinstance(node.value, dict):
        for key, inner in node.value.items():
            yield from _values_below(inner, (*keys, key), visits)
    else:
        yield YamlValue(keys, node)
        for number, item in enumerate(node.items):
            if isinstance(item.value, dict):
                yield from _values_below(item, (*keys, str(number)), visits)


_Section = tuple[Strings, YamlNode]


def tables_in(node: YamlNode) -> Iterator[YamlNode]:
    """Yield a table and all tables in it."""
    pending = [node]
    visits = Visits()
    while pending:
        table = pending.pop()
        if isinstance(table.value, dict) and visits.enters(table):
            yield table
            pending += table.value.values()


def sections_in(node: YamlNode, keys: Strings = ()) -> Iterator[_Section]:
    """Yield the parameters of each node in a parameter file.

    These are the keys of the node, and the mapping below.
    """
    yield from _sections_below(node, keys, Visits(), {})


def keys_of_sections(node: YamlNode) -> dict[str, Strings]:
    """Return the keys of the sections of a parameter file by the full names of their nodes.

    A full name is such as /ns/node.
    """
    return {f"/{'/'.join(keys).strip('/')}": keys for keys, _ in sections_in(node) if keys}


def _sections_below(
    node: YamlNode, keys: Strings, visits: Visits, nested: dict[YamlNode, YamlNode]
) -> Iterator[_Section]:
    if len(keys) > _MAX_DEPTH or not isinstance(node.value, dict) or not visits.enters(node):
        return
    for key, inner in node.pairs:
        if key == PARAMETERS:
            yield keys, _nested(inner, nested)
        else:
            yield from _sections_below(inner, (*keys, key), visits, nested)


def _nested(node: YamlNode, made: dict[YamlNode, YamlNode]) -> YamlNode:
    """Return parameters with tables in place of keys with dots, as rcl reads them.

    `made` has those that were made before: an alias is the same object as its anchor.
    """
    if not isinstance(node.value, dict) or not any("." in key for key in node.value):
        return node
    if node in made:
        return made[node]
    tables = dict[str, list[YamlNode]]()
    places = dict[str, Any]()
    for key, inner in node.value.items():
        outer, _, last = key.partition(".")
        if last:
            table = replace(inner, value={last: inner}, key_marks={last: node.key_marks[key]})
        else:
            table = inner
        tables.setdefault(outer, []).append(table)
        places.setdefault(outer, node.key_marks[key])
    value = {key: _nested(_joined(entries), made) for key, entries in tables.items()}
    made[node] = replace(node, value=value, key_marks=places)
    return made[node]


def _joined(tables: list[YamlNode]) -> YamlNode:
    """Return the tables of one key as one; a value that is no table replaces those before it."""
    first = tables[0]
    value = dict[str, YamlNode]()
    marks = dict[str, Any]()
    for table in tables:
        if not isinstance(table.value, dict) or not isinstance(first.value, dict):
            first = table
            value = {}
            marks = {}
        if isinstance(table.value, dict):
            value |= table.value
            marks |= table.key_marks
    if isinstance(first.value, dict) and len(tables) > 1:
        return replace(first, value=value, key_marks=marks)
    return first


def is_misspelt_key(key: str, node: YamlNode) -> bool:
    """Return whether a key with a mapping surely stands for ros__parameters."""
    return isinstance(node.value, dict) and near(key, [PARAMETERS]) is not None


def is_parameters(node: YamlNode) -> bool:
    """Return whether a file has parameters of nodes."""
    return next(sections_in(node), None) is not None
