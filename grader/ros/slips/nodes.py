"""The elements of a text as they are written, whether xacro or ROS 2 reads them."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from grader.base import markup
from grader.base.element_edits import with_attribute
from grader.base.source import Edit, Source
from grader.ros.python.budget import Budget, OutOfBudget
from grader.ros.python.values import EvaluationFails, Undetermined
from grader.ros.xacro.xacro_nodes import XacroNode, read_nodes, recovered_nodes
from grader.ros.xml.parsing import XMLSyntaxError

_MAX_LENGTH = 500  # characters of a value


def read_elements(source: Source) -> XacroNode | None:
    """Return the root element of a text, also after the edits that repair it; None without one."""
    data = source.text.encode("utf-8", "surrogateescape")
    budget = Budget()
    try:
        return _read(data, source.path, budget)
    except (EvaluationFails, Undetermined, OutOfBudget):
        return None


def _read(data: bytes, path: str, budget: Budget) -> XacroNode | None:
    try:
        return read_nodes(data, path, budget)
    except XMLSyntaxError:
        return recovered_nodes(data, path, budget)[0]


class WrittenValue(NamedTuple):
    """The value of an attribute as it is written."""

    source: Source
    start: int  # the offset of the tag
    attribute: markup.Attribute
    text: str

    def edit(self, new: str) -> Edit:
        """Return the edit that writes another value."""
        return with_attribute(self.source, self.start, self.attribute.name, new)


def list_values(source: Source, start: int) -> Iterator[WrittenValue]:
    """Yield the values in the start tag at an offset, but not very long ones."""
    for attribute in markup.attributes(source.text, start):
        text = source.text[slice(*attribute.value)]
        if len(text) <= _MAX_LENGTH:
            yield WrittenValue(source, start, attribute, text)


def list_all_values(nodes: Iterable[XacroNode]) -> Iterator[WrittenValue]:
    """Yield the values in the start tags of elements."""
    for node in nodes:
        yield from list_values(*find_place(node))


def find_place(node: XacroNode) -> tuple[Source, int]:
    """Return the text that an element is written in, and the offset of its start tag."""
    return node.place.source.element(node.place.tag)
