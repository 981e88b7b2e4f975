"""The source of an expanded xacro file: where each element comes from, and the edits of what it comes from."""

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING

from grader.source import Edit, Edits, Location, Source
from grader.xacro.expander import Expander
from grader.xacro.nodes import XacroNode
from grader.xacro.scopes import XacroScope

if TYPE_CHECKING:
    from grader.edits import Proposal
    from grader.xacro.edits import Rewriter

_READING_OF_SHORT = 1_500  # parts


class ExpandedSource(Source):
    """The text of a xacro file; its start tags are the expanded elements. Methods that make edits import them late."""

    is_expanded = True

    def __init__(self, source: Source, nodes: list[XacroNode], expander: Expander, work: int) -> None:
        super().__init__(source.path, source.text)
        self._nodes, self._expander, self._work = nodes, expander, work

    def tag(self, index: int, attribute: str | None = None) -> Location:
        """Return the location in the source of an expanded element, or of an attribute if it has it."""
        return self._nodes[index].place.at(attribute)

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
        place = self._nodes[tag].place
        return place.source.element(place.tag)

    def rewrites(self, attribute: str, wanted: Mapping[int, tuple[str, str]]) -> list[Edits]:
        """Return the ways to give an attribute (or, without a name, the text) of elements of one place other values."""
        from grader.xacro.written import Use

        place = self._nodes[next(iter(wanted))].place
        scope = place.scope or XacroScope()
        uses = []
        for tag in self.siblings(next(iter(wanted))):
            node = self._nodes[tag]
            text = node.attributes.get(attribute, "") if attribute else "".join(map(str, node.children)).strip()
            call = node.place.calls[-1][1] if node.place.calls else None
            uses.append(Use(node.place.scope or scope, *wanted.get(tag, (text, text)), call))
        return self._rewriter.ways(place, attribute, uses)

    def numbers(self, tag: int, attribute: str) -> list[tuple[str, Callable[[str], Edits]]]:
        """Return the numbers from which an attribute is computed, each with what makes the edit of its definition."""
        from grader.xacro.written import TextChange, Written, edits_of

        def changing(written: Written) -> Callable[[str], Edits]:
            return lambda new: edits_of([TextChange(written, new)]) or ()

        place = self._nodes[tag].place
        found = self._rewriter.numbers(place, attribute, place.scope or XacroScope())
        return [(it.text.strip(), changing(it)) for it in found]

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

    def corrections(self, names: Sequence[str]) -> "list[Proposal]":
        """Return edits that may correct undeclared and undefined names, calls of macros, and conditions.

        `names` are those that the reference and the format have.
        """
        from grader.edits import Proposal
        from grader.names import near
        from grader.xacro.corrections import corrections
        from grader.xacro.edits import conditions

        found = [*corrections(Source(self.path, self.text), self.documents, self._expander.refused)]
        words = {word for name in names for word in name.split("_")}
        given = sorted(words)
        for document in self.documents.values():
            edited = conditions(document.place.source, given, near)
            found += [Proposal(edits, "a text in a condition") for edits in edited]
        return list({correction.edits: correction for correction in reversed(found)}.values())[::-1]

    def calls(self, edit: Edit) -> dict[str, list[Location]]:
        """Return the calls of the macros that an edit is in, by their names."""
        found: dict[str, dict[Location, None]] = {}
        for node in self._nodes if edit.old else ():
            place = node.place.at(next((it for it in node.attributes if it and edit.old.startswith(f"{it}=")), None))
            if node.place.calls and place[:3] == edit[:3]:
                name, call = node.place.calls[-1]
                found.setdefault(name, {})[call.at()] = None
        return {name: [*calls] for name, calls in found.items()}

    @cached_property
    def _rewriter(self) -> "Rewriter":
        from grader.xacro.edits import Rewriter

        return Rewriter(self._expander.texts)
