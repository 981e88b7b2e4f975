"""Names that xacro refuses and that surely stand for others, and how a file is expanded with those."""

from collections.abc import Iterable
from typing import NamedTuple

from grader.source import Location
from grader.text import quoted
from grader.xacro.nodes import XacroNode
from grader.xacro.scopes import ScopePlace, UnknownName


class Misspelt(NamedTuple):
    """A name that xacro refuses and that surely stands for another one, and where it is."""

    unknown: UnknownName
    place: ScopePlace
    location: Location

    @property
    def sentence(self) -> str:
        """What it is read as."""
        return f"the {self.unknown.kind} {quoted(self.unknown.name)} is read as {quoted(self.unknown.meant or '')}"


class Respelling:
    """Names that are read as others: in expressions, and those of elements, by the file and the index of the tag."""

    def __init__(self, misspelt: Iterable[Misspelt] = ()) -> None:
        self.names: dict[str, str] = {}
        self._elements: dict[tuple[str, int], dict[str, str]] = {}
        for (name, _, kind, meant), place, _ in misspelt:
            own = self._elements.setdefault((place.source.path, place.tag), {})
            (self.names if kind == "property" else own)[name] = meant or name

    def element(self, node: XacroNode) -> XacroNode:
        """Return an element with the names that it is read with: of a macro, of attributes, of the block it inserts."""
        names = self._elements.get((node.place.source.path, node.place.tag))
        if not names:
            return node
        name = node.tag.removeprefix("xacro:")
        has_block = name == "insert_block"
        other = XacroNode(f"xacro:{names.get(name, name)}", node.place)
        other.attributes = {
            names.get(key, key): names.get(text, text) if has_block else text for key, text in node.attributes.items()
        }
        other.children, other.unresolved = node.children, node.unresolved
        return other
