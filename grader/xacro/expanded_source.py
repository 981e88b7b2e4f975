"""The source of an expanded xacro file: where each element comes from."""

from collections.abc import Mapping, Sequence

from grader.source import Location, Source
from grader.xacro.expander import Expander, Refusal
from grader.xacro.nodes import XacroNode
from grader.xacro.texts import Texts

_READING_OF_SHORT = 1_500  # parts


class ExpandedSource(Source):
    """The text of a xacro file; its start tags are the expanded elements."""

    is_expanded = True

    def __init__(self, source: Source, nodes: list[XacroNode], expander: Expander, work: int) -> None:
        super().__init__(source.path, source.text)
        self.nodes: Sequence[XacroNode] = nodes
        self._expander, self._work = expander, work

    def tag(self, index: int, attribute: str | None = None) -> Location:
        """Return the location in the source of an expanded element, or of an attribute if it has it."""
        return self.nodes[index].place.at(attribute)

    def next_tag(self, index: int, name: str) -> int:
        """Return the index of the first expanded element of this name after another one; that one if there is none."""
        others = range(index + 1, len(self.nodes))
        return next((other for other in others if self.nodes[other].tag == name), index)

    @property
    def documents(self) -> Mapping[str, XacroNode]:
        """The files that it was expanded from, as they are written, by their paths: this one first."""
        return self._expander.files.documents

    @property
    def includes(self) -> Mapping[tuple[str, int], list[str]]:
        """The files that were included, by the path of the file and the index of the tag that include them."""
        return self._expander.files.followed

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
        return next((found.reason for found in self._expander.undetermined), "")

    @property
    def cost(self) -> int:
        """How much longer this takes to expand and to read than a short file."""
        return super().cost + self._work // _READING_OF_SHORT

    def element(self, tag: int) -> tuple[Source, int]:
        """Return the text, perhaps of an included file, with an expanded element, and the offset of its start tag."""
        place = self.nodes[tag].place
        return place.source.element(place.tag)
