"""The edits of the texts that the elements of an expanded xacro file come from."""

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property

from grader.hints.edits import Proposal
from grader.hints.xacro.corrections import corrections
from grader.hints.xacro.rewriter import Rewriter, conditions
from grader.hints.xacro.written import TextChange, Use, Written, edits_of
from grader.names import near
from grader.source import Edit, Edits, Location, Source
from grader.xacro.expanded_source import ExpandedSource
from grader.xacro.scopes import XacroScope


class ExpandedEdits:
    """Makes the edits of an expanded xacro file; elements are named by their indices in the expanded document."""

    def __init__(self, source: ExpandedSource) -> None:
        self._source = source

    def rewrites(self, attribute: str, wanted: Mapping[int, tuple[str, str]]) -> list[Edits]:
        """Return the ways to give an attribute (or, without a name, the text) of elements of one place other values."""
        place = self._source.nodes[next(iter(wanted))].place
        scope = place.scope or XacroScope()
        uses = []
        for tag in self.siblings(next(iter(wanted))):
            node = self._source.nodes[tag]
            text = node.attributes.get(attribute, "") if attribute else "".join(map(str, node.children)).strip()
            call = node.place.calls[-1][1] if node.place.calls else None
            uses.append(Use(node.place.scope or scope, *wanted.get(tag, (text, text)), call))
        return self._rewriter.ways(place, attribute, uses)

    def numbers(self, tag: int, attribute: str) -> list[tuple[str, Callable[[str], Edits]]]:
        """Return the numbers from which an attribute is computed, each with what makes the edit of its definition."""

        def changing(written: Written) -> Callable[[str], Edits]:
            return lambda new: edits_of([TextChange(written, new)]) or ()

        place = self._source.nodes[tag].place
        found = self._rewriter.numbers(place, attribute, place.scope or XacroScope())
        return [(it.text.strip(), changing(it)) for it in found]

    def siblings(self, tag: int) -> list[int]:
        """Return the indices of the expanded elements that come from the same place of the source."""
        place = self._source.nodes[tag].place
        return self._by_place[place.source.path, place.tag]

    @cached_property
    def _by_place(self) -> dict[tuple[str, int], list[int]]:
        found: dict[tuple[str, int], list[int]] = {}
        for index, node in enumerate(self._source.nodes):
            found.setdefault((node.place.source.path, node.place.tag), []).append(index)
        return found

    def corrections(self, names: Sequence[str]) -> list[Proposal]:
        """Return edits that may correct undeclared and undefined names, calls of macros, and conditions.

        `names` are those that the reference and the format have.
        """
        found = [
            *corrections(Source(self._source.path, self._source.text), self._source.documents, self._source.refused)
        ]
        words = {word for name in names for word in name.split("_")}
        given = sorted(words)
        for document in self._source.documents.values():
            edited = conditions(document.place.source, given, near)
            found += [Proposal(edits, "a text in a condition") for edits in edited]
        return list({correction.edits: correction for correction in reversed(found)}.values())[::-1]

    def calls(self, edit: Edit) -> dict[str, list[Location]]:
        """Return the calls of the macros that an edit is in, by their names."""
        found: dict[str, dict[Location, None]] = {}
        for node in self._source.nodes if edit.old else ():
            place = node.place.at(next((it for it in node.attributes if it and edit.old.startswith(f"{it}=")), None))
            if node.place.calls and place[:3] == edit[:3]:
                name, call = node.place.calls[-1]
                found.setdefault(name, {})[call.at()] = None
        return {name: [*calls] for name, calls in found.items()}

    @cached_property
    def _rewriter(self) -> Rewriter:
        return Rewriter(self._source.texts)
