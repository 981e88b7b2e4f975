"""A xacro file, expanded statically, as the document that ROS 2 reads.

Every element keeps its place in the source.

xacro (ros/xacro 2.1) stops at the first thing that it refuses. Here it becomes a problem, and the
rest is expanded all the same, so that one defect does not hide another.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from itertools import groupby
from typing import TYPE_CHECKING

from grader.base.errors import NotDecided
from grader.base.merge_conflicts import describe_conflicts, find_conflicts
from grader.base.patterns import on_use
from grader.base.problems import Problem
from grader.base.records import Named
from grader.base.source import Location, Source
from grader.ros.python.budget import Budget, OutOfBudget
from grader.ros.python.values import EvaluationFails, Undetermined
from grader.ros.xacro import xacro_problems
from grader.ros.xacro.corrections import Refusal
from grader.ros.xacro.expander import STOPS, Expander, UndeterminedUse
from grader.ros.xacro.tags import CALL, HANDLERS
from grader.ros.xacro.texts import OtherArguments, Texts
from grader.ros.xacro.xacro_files import Files, SurroundingFiles
from grader.ros.xacro.xacro_nodes import XacroNode, read_nodes, recovered_nodes, walk
from grader.ros.xml.parsing import (
    Element,
    Unresolved,
    XmlDocument,
    XMLSyntaxError,
    error_location,
    make_element,
)
from grader.ros.xml.xml_problems import MISPLACED_DECLARATION

if TYPE_CHECKING:
    from grader.ros.xacro.inventory import Inventory

_READING_OF_SHORT = 1_500  # parts


class _XacroArgument(Named):
    """An argument that a xacro file declares."""

    name: str
    default: str  # as it is written
    value: str | None  # that it has; None if it is known only at run time, or not reached


class ExpandedSource(Source):
    """The text of a xacro file; its start tags are the expanded elements."""

    is_expanded = True

    def __init__(
        self,
        source: Source,
        nodes: list[XacroNode],
        expander: Expander,
        work: int,
    ) -> None:
        super().__init__(source.path, source.text)
        self.nodes = nodes
        self._expander = expander
        self._work = work

    def tag(self, index: int, attribute: str | None = None) -> Location:
        """Return the location in the source of an expanded element.

        With an attribute that the element has, it is the location of the attribute.
        """
        return self.nodes[index].place.at(attribute)

    def next_tag(self, index: int, name: str) -> int:
        """Return the index of the first expanded element of this name after another one.

        Returns the index of the other one if there is none.
        """
        others = range(index + 1, len(self.nodes))
        return next((other for other in others if self.nodes[other].tag == name), index)

    @property
    def documents(self) -> Mapping[str, XacroNode]:
        """The files that it was expanded from, as they are written, by their paths.

        This file is the first one.
        """
        return self._expander.files.documents

    @property
    def texts_of_files(self) -> list[Source]:
        """The texts of the files that it includes, also of those that are no XML."""
        read = [document.place.source for document in self.documents.values()]
        return [*read, *self._expander.files.broken.values()]

    @property
    def includes(self) -> Mapping[tuple[str, int], list[str]]:
        """The files that were included, by the path and the tag that include them.

        The key is the path of the file and the index of the tag in it.
        """
        return self._expander.files.followed

    @property
    def declared_arguments(self) -> list[_XacroArgument]:
        """The arguments that its files declare, in their order, each once."""
        defaults: dict[str, str] = {}
        for document in self.documents.values():
            for node in walk(document):
                if node.tag == "xacro:arg" and "name" in node.attributes:
                    default = node.attributes.get("default", "")
                    defaults.setdefault(node.attributes["name"], default)
        values = self.texts.arguments
        return [_XacroArgument(name, text, values.get(name)) for name, text in defaults.items()]

    @property
    def texts(self) -> Texts:
        """What the names in its texts stand for."""
        return self._expander.texts

    @property
    def refused(self) -> Sequence[Refusal]:
        """What xacro refuses, without which it was expanded, and where."""
        return self._expander.refused

    @property
    def is_refused(self) -> bool:
        """Whether xacro refuses something, without which it was expanded."""
        return bool(self._expander.problems)

    @property
    def open_reason(self) -> str:
        """Why something could not be expanded; empty if everything was."""
        return next((part.reason for part in self._expander.undetermined), "")

    def inventory(self, budget: Budget) -> "Inventory":
        """Return what its files define and use. Raises NotDecided where that takes too much."""
        from grader.ros.xacro.inventory import take_inventory  # late: few rubrics need it

        try:
            return take_inventory(self.documents.values(), budget)
        except OutOfBudget as error:
            raise NotDecided(str(error)) from None

    def check_known(self, read_inventory: "Inventory") -> None:
        """Raise NotDecided if what seems to be missing may be in a part that is not known."""
        is_open = any(
            (place.source.path, place.tag) not in self.includes for place in read_inventory.includes
        )
        if self.open_reason and is_open:
            raise NotDecided(self.open_reason)
        if read_inventory.dynamic:
            place = read_inventory.dynamic[0].at()
            reason = "xacro evaluates the name of a property or macro"
            raise NotDecided(f"{reason} ({place.path}, line {place.line})", reason)

    @property
    def cost(self) -> int:
        """How much longer this takes to expand and to read than a short file."""
        return super().cost + self._work // _READING_OF_SHORT

    def element(self, tag: int) -> tuple[Source, int]:
        """Return the text with an expanded element, and the offset of its start tag.

        The text may be that of an included file.
        """
        place = self.nodes[tag].place
        return place.source.element(place.tag)


_INSTRUCTION = on_use(
    r"<!--.*?(?:-->|\Z)|<!\[CDATA\[.*?(?:\]\]>|\Z)|<\?(?!xml\s)(?P<target>[\w:.-]+)", re.DOTALL
)
# What libxml2 says of <xacro:macro> and </macro>: it leaves the prefixes out.
_OTHER_PREFIX = on_use(
    r"Opening and ending tag mismatch: (?P<name>\S+) line (?P<line>\d+) and (?P=name)(?![\w.-])"
)


class _Expansion(Named):
    """An expanded file.

    If it cannot be expanded at all, `root` is None, and `recovered` is what can be read despite
    broken tags. `is_meant` says whether xacro refuses nothing else.
    """

    root: Element | None
    source: Source
    problems: tuple[Problem, ...]  # what xacro refuses
    undetermined: tuple[UndeterminedUse, ...]  # what cannot be determined statically
    unresolved: Mapping[Element, Unresolved]  # the elements that are not known completely
    recovered: Element | None = None
    is_meant: bool = False
    warnings: tuple[Problem, ...] = ()  # what xacro writes to stderr, and notes

    @property
    def document(self) -> XmlDocument:
        """The expanded file as the reader of robots takes it.

        What cannot be determined is a problem in it.
        """
        undetermined = [
            Problem(xacro_problems.XACRO_UNDETERMINED, part.reason, part.location)
            for part in self.undetermined
        ]
        problems = [*self.problems, *undetermined, *self.warnings]
        expanded = XmlDocument(
            self.root, self.source, problems, 0, self.unresolved, is_expanded=True
        )
        return expanded._replace(recovered=self.recovered, is_meant=self.is_meant)


def expand(
    data: bytes,
    path: str,
    workspace: SurroundingFiles,
    arguments: Mapping[str, str | None],
    others: OtherArguments = "default",
) -> _Expansion:
    """Return a xacro file as xacro expands it with these arguments; never raises.

    `path` is that in the workspace. `others` says what is known of other arguments.
    """
    plain = Source(path, data.decode("utf-8", "surrogateescape"))
    budget = workspace.budget
    before = budget.used
    try:
        source, refused, is_recovered = _read(data, plain, budget)
    except EvaluationFails as error:
        problem = Problem(xacro_problems.XACRO_NOT_XML, f"{error}; {STOPS}", plain.at(0))
        return _Expansion(None, plain, (problem,), (), {})
    except (Undetermined, OutOfBudget) as error:
        return _Expansion(None, plain, (), (UndeterminedUse(str(error), plain.at(0)),), {})
    if not source:
        return _Expansion(None, plain, refused, (), {})
    files = Files(workspace, path)
    files.documents[path] = source
    refused = (*refused, *_instructions(plain))
    expander = Expander(files, arguments, budget, HANDLERS, CALL)
    expander.texts.other_arguments = others
    root = expander.root(source)
    nodes: list[XacroNode] = []
    unresolved: dict[Element, Unresolved] = {}
    element = _element(root, nodes, unresolved)
    return _Expansion(
        None if is_recovered else element,
        ExpandedSource(plain, nodes, expander, budget.used - before),
        (*refused, *expander.problems),
        tuple(expander.undetermined),
        unresolved,
        element if is_recovered else None,
        is_meant=not expander.problems,
        warnings=tuple(expander.warnings),
    )


def _read(
    data: bytes, text: Source, budget: Budget
) -> tuple[XacroNode | None, tuple[Problem, ...], bool]:
    """Return the elements of a file, and what xacro refuses in it.

    Also return whether they are only what broken tags leave.
    """
    path = text.path
    try:
        return read_nodes(data, path, budget), (), False
    except XMLSyntaxError as error:
        what = f"xacro needs well-formed XML: {error.msg}"
        location = error_location(error, text)
        prefixes = _OTHER_PREFIX.match(error.msg or "")
        if prefixes:
            what = (
                f"the end tag in line {location.line} has not the prefix of the start tag "
                f"<{prefixes['name']}> in line {prefixes['line']}"
            )
    conflicts = find_conflicts(text.text)
    if conflicts:
        what = describe_conflicts(text.text, conflicts)
        location = text.at(conflicts[0].start)
    refused = (Problem(xacro_problems.XACRO_NOT_XML, f"{what}; {STOPS}", location),)
    with suppress(XMLSyntaxError):
        return read_nodes(data, path, budget, is_repaired=True), refused, False
    recovered, assumed = recovered_nodes(data, path, budget)
    return recovered, (*refused, *assumed) if recovered else refused, True


def _instructions(text: Source) -> Iterator[Problem]:
    """Yield the first processing instruction.

    It stands after xacro's own comment, where TinyXML2 refuses it.
    """
    instruction = next(
        (match for match in _INSTRUCTION.finditer(text.text) if match["target"]), None
    )
    if instruction:
        what = f"<?{instruction['target'][:40]}?>"
        message = f"{what} comes after the comment that xacro adds, which ROS 2 rejects: remove it"
        yield Problem(MISPLACED_DECLARATION, message, text.at(instruction.start()))


def _element(
    root: XacroNode, nodes: list[XacroNode], unresolved: dict[Element, Unresolved]
) -> Element:
    """Return the elements of lxml for expanded ones.

    `nodes` becomes the latter in document order.
    """
    made = make_element(_name(root.tag), _attributes(root.attributes))
    pending = [(root, made)]
    while pending:
        node, element = pending.pop()
        nodes.append(node)
        if node.unresolved or node.open is not None:
            unresolved[element] = Unresolved(node.unresolved, node.open)
        children = []
        for kind, group in groupby(node.children, type):
            if kind is XacroNode:
                inside = [child for child in group if isinstance(child, XacroNode)]
                children += [
                    (child, make_element(_name(child.tag), _attributes(child.attributes), element))
                    for child in inside
                ]
            elif children:
                children[-1][1].tail = "".join(map(str, group))
            else:
                element.text = "".join(map(str, group))
        pending += reversed(children)
    return made


def _name(tag: str) -> str:
    """Return a name for lxml.

    A prefix stands for its namespace, because no element with one belongs to a URDF.
    """
    if ":" not in tag:
        return tag
    prefix, _, local = tag.partition(":")
    return f"{{{prefix}}}{local}"


def _attributes(attributes: dict[str, str]) -> dict[str, str]:
    if ":" not in "".join(attributes):
        return attributes
    return {_name(name): text for name, text in attributes.items()}
