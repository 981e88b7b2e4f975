"""A xacro file, expanded statically, as the document that ROS 2 reads; every element keeps its place in the source.

xacro (ros/xacro 2.1) stops at the first thing that it refuses. Here it becomes a problem, and the rest is expanded all
the same, so that one defect does not hide another.
"""

from collections.abc import Mapping
from contextlib import suppress
from itertools import groupby
from typing import NamedTuple

from grader.problems import Problem
from grader.source import Source
from grader.static_python.closed_values import Budget, ExpressionFails, OutOfBudget, Undetermined
from grader.xacro import catalogue
from grader.xacro.expanded_source import ExpandedSource
from grader.xacro.expander import STOPS, Expander, Open
from grader.xacro.files import Files, Workspace
from grader.xacro.nodes import XacroNode, read_nodes, recovered_nodes
from grader.xacro.tags import CALL, HANDLERS
from grader.xml.parsing import Element, Unresolved, XmlDocument, XMLSyntaxError, error_location, make_element

__all__ = ("Expansion", "Open", "Workspace", "expand")


class Expansion(NamedTuple):
    """An expanded file.

    If it cannot be expanded at all, `root` is None, and `recovered` is what can be read despite broken tags.
    """

    root: Element | None
    source: Source
    problems: tuple[Problem, ...]  # what xacro refuses
    undetermined: tuple[Open, ...]  # what cannot be determined statically
    unresolved: Mapping[Element, Unresolved]  # the elements that are not known completely
    recovered: Element | None = None

    @property
    def document(self) -> XmlDocument:
        """The expanded file as the reader of robots takes it; what cannot be determined is a problem in it."""
        undetermined = [
            Problem(catalogue.XACRO_UNDETERMINED, found.reason, found.location) for found in self.undetermined
        ]
        problems = [*self.problems, *undetermined]
        return XmlDocument(
            self.root, self.source, problems, 0, self.unresolved, is_expanded=True, recovered=self.recovered
        )


def expand(data: bytes, path: str, workspace: Workspace, arguments: Mapping[str, str | None]) -> Expansion:
    """Return a xacro file as xacro expands it with these arguments; never raises. `path` is that in the submission."""
    plain, budget = Source(path, data.decode("utf-8", "surrogateescape")), workspace.budget
    before = budget.used
    try:
        source, refused, is_recovered = _read(data, plain, budget)
    except ExpressionFails as error:
        problem = Problem(catalogue.XACRO_NOT_XML, f"{error}; {STOPS}", plain.at(0))
        return Expansion(None, plain, (problem,), (), {})
    except (Undetermined, OutOfBudget) as error:
        return Expansion(None, plain, (), (Open(str(error), plain.at(0)),), {})
    if source is None:
        return Expansion(None, plain, refused, (), {})
    files = Files(workspace, path)
    files.documents[path] = source
    expander = Expander(files, arguments, budget, HANDLERS, CALL)
    root = expander.root(source)
    nodes: list[XacroNode] = []
    unresolved: dict[Element, Unresolved] = {}
    element = _element(root, nodes, unresolved)
    return Expansion(
        None if is_recovered else element,
        ExpandedSource(plain, nodes, expander, budget.used - before),
        (*refused, *expander.problems),
        tuple(expander.undetermined),
        unresolved,
        element if is_recovered else None,
    )


def _read(data: bytes, text: Source, budget: Budget) -> tuple[XacroNode | None, tuple[Problem, ...], bool]:
    """Return the elements of a file, what xacro refuses in it, and whether they are only what broken tags leave."""
    path = text.path
    try:
        return read_nodes(data, path, budget), (), False
    except XMLSyntaxError as error:
        message = f"xacro needs well-formed XML: {error.msg}; {STOPS}"
        refused = (Problem(catalogue.XACRO_NOT_XML, message, error_location(error, text)),)
    with suppress(XMLSyntaxError):
        return read_nodes(data, path, budget, is_repaired=True), refused, False
    recovered, assumed = recovered_nodes(data, path, budget)
    return recovered, (*refused, *assumed) if recovered is not None else refused, True


def _element(root: XacroNode, nodes: list[XacroNode], unresolved: dict[Element, Unresolved]) -> Element:
    """Return the elements of lxml for expanded ones; `nodes` becomes the latter in document order."""
    made = make_element(_name(root.tag), _attributes(root.attributes))
    pending: list[tuple[XacroNode, Element]] = [(root, made)]
    while pending:
        node, element = pending.pop()
        nodes.append(node)
        if node.unresolved or node.open is not None:
            unresolved[element] = Unresolved(node.unresolved, node.open)
        children: list[tuple[XacroNode, Element]] = []
        for kind, found in groupby(node.children, type):
            if kind is XacroNode:
                inside = [child for child in found if isinstance(child, XacroNode)]
                children += [(it, make_element(_name(it.tag), _attributes(it.attributes), element)) for it in inside]
            elif children:
                children[-1][1].tail = "".join(map(str, found))
            else:
                element.text = "".join(map(str, found))
        pending += reversed(children)
    return made


def _name(tag: str) -> str:
    """Return a name for lxml: a prefix stands for its namespace, because no element with one belongs to a URDF."""
    if ":" not in tag:
        return tag
    prefix, _, local = tag.partition(":")
    return f"{{{prefix}}}{local}"


def _attributes(attributes: dict[str, str]) -> dict[str, str]:
    return attributes if ":" not in "".join(attributes) else {_name(name): it for name, it in attributes.items()}
