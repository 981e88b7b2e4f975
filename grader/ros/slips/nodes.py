"""The elements of a text as they are written, whether xacro or ROS 2 reads them."""

from grader.base.source import Source
from grader.ros.python.budget import Budget, OutOfBudget
from grader.ros.python.values import EvaluationFails, Undetermined
from grader.ros.xacro.xacro_nodes import XacroNode, read_nodes, recovered_nodes
from grader.ros.xml.parsing import XMLSyntaxError


def read_elements(source: Source) -> XacroNode | None:
    """Return the root element of a text, also after the edits that repair it; None without one."""
    data, budget = source.text.encode("utf-8", "surrogateescape"), Budget()
    try:
        return _read(data, source.path, budget)
    except (EvaluationFails, Undetermined, OutOfBudget):
        return None


def _read(data: bytes, path: str, budget: Budget) -> XacroNode | None:
    try:
        return read_nodes(data, path, budget)
    except XMLSyntaxError:
        return recovered_nodes(data, path, budget)[0]


def find_place(node: XacroNode) -> tuple[Source, int]:
    """Return the text that an element is written in, and the offset of its start tag."""
    return node.place.source.element(node.place.tag)
