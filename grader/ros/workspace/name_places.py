"""The names of a workspace as its files write them: what an editor shows and changes."""

import re
from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from typing import NamedTuple

from grader.base.extents import ended
from grader.base.source import Location, Source
from grader.ros.workspace.names import Definition, Mismatch, Use
from grader.ros.workspace.offered_names import OFFERED, offered_names
from grader.ros.workspace.opened import OpenedWorkspace
from grader.ros.workspace.reading import names_in, read_agreement

_NAME = r"(?<![\w.-]){}(?![\w-]|\.\w)"
_Fact = Definition | Use


class NamePlace(NamedTuple):
    """A place at which a file writes a name."""

    kind: str
    name: str
    is_definition: bool
    whole: Location  # of the value, attribute or tag around it
    written: Location | None  # of the name in it; None where it is made of parts

    @property
    def at(self) -> Location:
        """Where it is, with its end: the name, or else what makes it."""
        return self.written or self.whole

    @property
    def why_made(self) -> str:
        """That it is made of parts."""
        return f"{self.whole.file_and_line} makes the name {self.name!r} of parts: change it there"


class NamePlaces:
    """The names that the files of a workspace define and use."""

    def __init__(self, opened: OpenedWorkspace) -> None:
        self._opened = opened

    @cached_property
    def _facts(self) -> Mapping[str, list[_Fact]]:
        """What files define and use, by their paths."""
        by_path: dict[str, list[_Fact]] = {}
        for fact in names_in(self._opened.workspace):
            by_path.setdefault(fact.location.path, []).append(fact)
        return by_path

    @cached_property
    def mismatches(self) -> Mapping[tuple[str, str, int], Mismatch]:
        """What does not agree, by its message, file and line."""
        found = {}
        for mismatch in read_agreement(self._opened.workspace).mismatches:
            at = mismatch.location
            found[mismatch.message, at.path, at.line] = mismatch
        return found

    def at(self, path: str, line: int, column: int) -> NamePlace | None:
        """Return the name at a place of a file, the shortest of several; None where there is none.

        Line and column count from 1, columns in characters.
        """
        found = [it for it in self._places(self._facts.get(path, ())) if _holds(it, line, column)]
        return min(found, key=_length, default=None)

    def same(self, name: NamePlace) -> list[NamePlace]:
        """Return each place of the name that is written at a place, the definitions first."""
        return self.named(self.owners(name), name.kind, name.name)

    def named(self, owners: frozenset[str], kind: str, name: str) -> list[NamePlace]:
        """Return each place of a name of some owners, the definitions first."""
        found = []
        for facts in self._facts.values():
            for fact in facts:
                is_own = not owners or not fact.owner or fact.owner in owners
                if is_own and (_kind(fact), fact.name) == (kind, name):
                    found.append(fact)
        return sorted(self._places(found), key=lambda it: not it.is_definition)

    def owners(self, name: NamePlace) -> frozenset[str]:
        """Return the owners of the names at the place of a name; none where they are anyone's."""
        owners = set()
        for fact in self._facts[name.whole.path]:
            is_there = fact.location[:3] == name.whole[:3]
            if is_there and (_kind(fact), fact.name) == (name.kind, name.name):
                owners.add(fact.owner)
        return frozenset(owners - {""}) if "" not in owners else frozenset()

    def defined_in(self, path: str) -> list[NamePlace]:
        """Return the names that a file defines."""
        facts = [it for it in self._facts.get(path, ()) if isinstance(it, Definition)]
        return [*self._places(facts)]

    def holding(self, text: str, most: int) -> list[NamePlace]:
        """Return the first definitions whose names hold a text, in whatever case."""
        found = []
        for facts in self._facts.values():
            for fact in facts:
                if isinstance(fact, Definition) and text.lower() in fact.name.lower():
                    found.append(fact)
        return [*self._places(found[:most])]

    def offered(self, kind: str, owner: str) -> list[str]:
        """Return the names of a kind that may be written, as `offered_names` does."""
        assert kind in OFFERED
        return offered_names(self._opened.workspace, kind, owner)

    def _places(self, facts: Iterable[_Fact]) -> Iterator[NamePlace]:
        """Yield where files write names, each place once."""
        seen: set[tuple[object, ...]] = set()
        for fact in facts:
            whole = ended(fact.location, self._opened.source)
            source = self._opened.source(whole.path)
            if source is None:
                continue
            written = _written(source, whole, fact.name)
            is_definition = isinstance(fact, Definition)
            place = NamePlace(_kind(fact), fact.name, is_definition, whole, written)
            key = (place.kind, place.name, is_definition, place.at[:3])
            if key not in seen:
                seen.add(key)
                yield place


def _kind(fact: _Fact) -> str:
    """Return the kind of a name; links are frames."""
    return "frame" if fact.kind == "link" else fact.kind


def _written(source: Source, whole: Location, name: str) -> Location | None:
    """Return where the text at a place writes a name; None where it is made of parts."""
    start = source.offset(whole.line, whole.column)
    end = source.offset(whole.end_line, whole.end_column)
    pattern = re.compile(_NAME.format(re.escape(name)))
    found = [*pattern.finditer(source.text, start, end)]
    if not found:
        return None
    at, after = source.at(found[-1].start()), source.at(found[-1].end())
    return at._replace(end_line=after.line, end_column=after.column)


def _holds(place: NamePlace, line: int, column: int) -> bool:
    at = place.at
    return (at.line, at.column) <= (line, column) <= (at.end_line, at.end_column)


def _length(place: NamePlace) -> tuple[int, int]:
    return place.at.end_line - place.at.line, place.at.end_column - place.at.column
