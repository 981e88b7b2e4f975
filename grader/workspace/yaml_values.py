"""The values in YAML parameter files, each with the keys above it."""

from collections.abc import Iterator
from typing import NamedTuple

from grader.names import near
from grader.package.yaml_nodes import YamlNode

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


def sections_in(node: YamlNode, keys: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], YamlNode]]:
    """Yield the parameters of each node in a parameter file: the keys of the node, and the mapping below."""
    if not isinstance(node.value, dict) or len(keys) > _MAX_DEPTH:
        return
    for key, inner in node.value.items():
        if key == PARAMETERS:
            yield keys, inner
        else:
            yield from sections_in(inner, (*keys, key))


def is_misspelt_key(key: str, node: YamlNode) -> bool:
    """Return whether a key with a mapping surely stands for ros__parameters."""
    return isinstance(node.value, dict) and near(key, [PARAMETERS]) is not None


def is_parameters(node: YamlNode) -> bool:
    """Return whether a file has parameters of nodes."""
    return next(sections_in(node), None) is not None
