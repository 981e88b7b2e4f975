"""A xacro file, expanded statically, as the document that ROS 2 reads; every element keeps its place in the source.

xacro (ros/xacro 2.1) stops at the first thing that it refuses. Here it becomes a problem, and the rest is expanded all
the same, so that one defect does not hide another.
"""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from functools import cached_property
from itertools import groupby
from typing import TYPE_CHECKING, NamedTuple

from grader.markup import element_end
from grader.problems import Problem
from grader.source import Correction, Edit, Edits, Location, Source
from grader.static_python.closed_values import Budget, ExpressionFails, OutOfBudget, Undetermined
from grader.xacro import catalogue
from grader.xacro.expander import STOPS, Expander, Open
from grader.xacro.files import Files, Workspace
from grader.xacro.nodes import XacroNode, read_nodes, recovered_nodes
from grader.xacro.tags import CALL, HANDLERS
from grader.xml.parsing import Element, Unresolved, XmlDocument, XMLSyntaxError, make_element

if TYPE_CHECKING:
    from grader.xacro.edits import Rewriter

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


_READING_OF_SHORT = 1_500  # parts


class ExpandedSource(Source):
    """The text of a xacro file; its start tags are the expanded elements. Edits are imported late: not for grading."""

    def __init__(self, source: Source, nodes: list[XacroNode], expander: Expander, work: int) -> None:
        super().__init__(source.path, source.text)
        self._nodes, self._expander, self._work = nodes, expander, work

    def tag(self, index: int, attribute: str | None = None) -> Location:
        """Return the location in the source of an expanded element, or of an attribute if it has it."""
        node = self._nodes[index]
        moved = node.moved.get(attribute) if attribute is not None else None
        return node.place.at(attribute) if moved is None else moved.at("value")

    def next_tag(self, index: int, name: str) -> int:
        """Return the index of the first expanded element of this name after another one; that one if there is none."""
        others = range(index + 1, len(self._nodes))
        return next((other for other in others if self._nodes[other].tag == name), index)

    @property
    def documents(self) -> Mapping[str, XacroNode]:
        """The files that it was expanded from, as they are written, by their paths: this one first."""
        return self._expander.files.documents

    @property
    def includes(self) -> Mapping[tuple[str, int], list[str]]:
        """The files that were included, by the path of the file and the index of the tag that include them."""
        return self._expander.files.followed

    @property
    def open_reason(self) -> str:
        """Why something could not be expanded; empty if everything was."""
        return next((found.reason for found in self._expander.undetermined), "")

    @property
    def cost(self) -> int:
        """How much longer this takes to expand and to read than a short file."""
        return super().cost + self._work // _READING_OF_SHORT

    def element(self, tag: int) -> tuple[Source, int]:
        """Return the text, perhaps of an included file, with an expanded element, and the offset of its start tag."""
        place = self._nodes[tag].place
        return place.source.element(place.tag)

    def rewrites(self, attribute: str, wanted: Mapping[int, tuple[str, str]]) -> list[Edits]:
        """Return the ways to give an attribute (or, without a name, the text) of elements of one place other values."""
        first = self._nodes[next(iter(wanted))]
        moved = first.moved.get(attribute)
        from grader.xacro.edits import Use
        from grader.xacro.scopes import XacroScope

        if moved is not None:
            old, new = next(iter(wanted.values()))
            return self._rewriter.ways(moved, "value", [Use(moved.scope or XacroScope(), old, new)])
        uses = []
        for tag in self.siblings(next(iter(wanted))):
            node = self._nodes[tag]
            text = node.attributes.get(attribute, "") if attribute else "".join(map(str, node.children)).strip()
            old, new = wanted.get(tag, (text, text))
            uses.append(Use(node.place.scope or XacroScope(), old, new, node.place.calls or ()))
        return self._rewriter.ways(first.place, attribute, uses)

    def siblings(self, tag: int) -> list[int]:
        """Return the indices of the expanded elements that come from the same place of the source."""
        place = self._nodes[tag].place
        return self._by_place[place.source.path, place.tag]

    @cached_property
    def _by_place(self) -> dict[tuple[str, int], list[int]]:
        found: dict[tuple[str, int], list[int]] = {}
        for index, node in enumerate(self._nodes):
            found.setdefault((node.place.source.path, node.place.tag), []).append(index)
        return found

    def corrections(self, names: Sequence[str] = (), numbers: Sequence[str] = ()) -> list[Correction]:
        """Return edits that may correct XML that is not well-formed, undefined names, and calls of macros."""
        from grader.xacro.corrections import Corrector, Refusal, well_formed

        refusals = [Refusal(*refused) for refused in self._expander.refused]
        corrector = Corrector(self.documents, self._expander.uses, self._expander.files.others)
        found = (*well_formed(Source(self.path, self.text)), *corrector.corrections(refusals, names, numbers))
        return list({correction.edits: correction for correction in reversed(found)}.values())[::-1]

    def calls(self, edit: Edit) -> tuple[tuple[str, Location], ...]:
        """Return the calls of the macro that an edit is in, each with the macro's name; nothing outside of macros."""
        found: tuple[int, tuple[tuple[str, Location], ...]] = (-1, ())
        for name, body, calls in self._expander.uses.values():
            source, start = body.source.element(body.tag)
            if source.path == edit.path and start <= source.offset(edit.line, edit.column) < element_end(
                source.text, start
            ):
                found = max(found, (start, tuple((name, call.at()) for call in calls.values())), key=lambda it: it[0])
        return found[1]

    def adapted(self, tag: int, xml: str) -> str:
        """Return the text of an element inserted in the one with this index: in a macro, with parameters in names."""
        from grader.xacro.written import with_parameters

        scope = self._nodes[tag].place.scope
        return with_parameters(xml, scope) if scope is not None else xml

    @cached_property
    def _rewriter(self) -> "Rewriter":
        from grader.xacro.edits import Rewriter

        return Rewriter(self._expander.texts)


def expand(data: bytes, path: str, workspace: Workspace, arguments: Mapping[str, str | None]) -> Expansion:
    """Return a xacro file as xacro expands it with these arguments; never raises. `path` is that in the submission."""
    plain, budget = Source(path, data.decode("utf-8", "surrogateescape")), workspace.budget
    before = budget.used
    try:
        source, refused, is_recovered = _read(data, path, budget)
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


def _read(data: bytes, path: str, budget: Budget) -> tuple[XacroNode | None, tuple[Problem, ...], bool]:
    """Return the elements of a file, what xacro refuses in it, and whether they are only what broken tags leave."""
    try:
        return read_nodes(data, path, budget), (), False
    except XMLSyntaxError as error:
        refused = (_not_xml(error, path),)
    with suppress(XMLSyntaxError):
        return read_nodes(data, path, budget, is_repaired=True), refused, False
    recovered, assumed = recovered_nodes(data, path, budget)
    return recovered, (*refused, *assumed) if recovered is not None else refused, True


def _not_xml(error: XMLSyntaxError, path: str) -> Problem:
    line, column = error.position
    location = Location(path, max(line or 1, 1), max(column or 1, 1))
    return Problem(catalogue.XACRO_NOT_XML, f"xacro needs well-formed XML: {error.msg}; {STOPS}", location)


def _element(root: XacroNode, nodes: list[XacroNode], unresolved: dict[Element, Unresolved]) -> Element:
    """Return the elements of lxml for expanded ones; `nodes` becomes the latter in document order."""
    made = make_element(_name(root.tag), _named(root.attributes))
    pending: list[tuple[XacroNode, Element]] = [(root, made)]
    while pending:
        node, element = pending.pop()
        nodes.append(node)
        if node.unresolved or node.open is not None:
            unresolved[element] = Unresolved(node.unresolved, node.open)
        children: list[tuple[XacroNode, Element]] = []
        for is_text, found in groupby(node.children, key=lambda child: isinstance(child, str)):
            if not is_text:
                inside = (child for child in found if isinstance(child, XacroNode))
                children += [(it, make_element(_name(it.tag), _named(it.attributes), element)) for it in inside]
            elif children:
                children[-1][1].tail = "".join(map(str, found))
            else:
                element.text = "".join(map(str, found))
        pending += reversed(children)
    return made


def _name(tag: str) -> str:
    """Return a name for lxml: a prefix stands for its namespace, because no element with one belongs to a URDF."""
    prefix, colon, local = tag.partition(":")
    return f"{{{prefix}}}{local}" if colon else tag


def _named(attributes: dict[str, str]) -> dict[str, str]:
    is_plain = all(":" not in name for name in attributes)
    return attributes if is_plain else {_name(name): value for name, value in attributes.items()}
