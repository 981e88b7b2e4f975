"""Edits that make a broken XML text readable: a search over few operations near the place where the parser stops."""

from collections.abc import Callable, Iterator
from heapq import nsmallest
from itertools import islice
from typing import NamedTuple

from grader.edits import Proposal, composed
from grader.source import Edits, Source
from grader.xml.operations import WAYS, Change, Operation, Operations
from grader.xml.pieces import ParserMark, PieceScan, Rules, scan

_MAX_ERRORS = 40  # of one text
_MAX_TRIES = 600  # at one error, of each kind
_MAX_WAYS = 4  # at one error that grading decides among
_MAX_FOUND = 8
_MAX_READ = 3_000_000  # characters
_WINDOW = 400  # characters after an error that must be read


class Way(NamedTuple):
    """What is wrong, the changes of a text that correct it, each from offset to offset, and the text after them."""

    name: str
    changes: list[Change]
    after: str


def syntax_proposals(
    source: Source, *, is_urdf: bool, is_strict: bool, charge: Callable[[int], object] = lambda _: None
) -> Iterator[Proposal]:
    """Yield edits that make a text readable, the most plausible first; none where none brings the parser further.

    `charge` gets the number of characters that each step of the search has read.
    """
    search = _SyntaxSearch(Rules(is_strict, is_urdf), charge)
    first = list(search.steps(source.text))
    if first:
        yield _join(source, [ways[0] for ways in first])
    others = ((index, way) for index in reversed(range(len(first))) for way in first[index][1:])
    for number, (index, way) in enumerate(islice(others, _MAX_FOUND), start=1):
        rest = [ways[0] for ways in search.steps(way.after)]
        yield _join(source, [*(ways[0] for ways in first[:index]), way, *rest])._replace(way=number)


def _join(source: Source, ways: list[Way]) -> Proposal:
    edits: Edits = ()
    text = source.text
    for way in ways:
        own = Source(source.path, text)
        edits = composed(source.text, source.path, edits, [own.edit(*change) for change in way.changes])
        text = way.after
    causes, actions = zip(*dict.fromkeys(WAYS[way.name] for way in ways), strict=True)
    return Proposal(edits, " and ".join(causes), " and ".join(dict.fromkeys(actions)))


class _SyntaxSearch:
    """A search, whose work is bounded."""

    def __init__(self, rules: Rules, charge: Callable[[int], object]) -> None:
        self.rules, self.left, self._charge = rules, _MAX_READ, charge

    def steps(self, text: str) -> Iterator[list[Way]]:
        """Yield the ways to bring the parser further, the best first, until the text can be read."""
        for _ in range(_MAX_ERRORS):
            before = self.left
            ways = self._ways(text)
            self._charge(before - self.left)
            if not ways:
                return
            yield ways
            text = ways[0].after

    def _ways(self, text: str) -> list[Way]:
        self.left -= len(text)
        stop = scan(text, self.rules)
        found: list[tuple[tuple[int, int], Way]] = []
        operations = Operations(text, stop, stop.wrong, self.rules.is_urdf) if stop.wrong else None
        for stage in (operations.likely(), operations.characters()) if operations else ():
            found = nsmallest(4 * _MAX_WAYS, [*found, *self._rank(text, stop, stage)], key=lambda pair: pair[0])
            if found and not found[0][0][1]:
                break
        return list({way.after: way for _, way in reversed(found)}.values())[::-1][:_MAX_WAYS]

    def _rank(
        self, text: str, stop: PieceScan, operations: Iterator[Operation]
    ) -> Iterator[tuple[tuple[int, int], Way]]:
        """Yield the ways that bring the parser further, with their distance to the end and the faults for urdfdom."""
        for name, *changes in islice(operations, _MAX_TRIES):
            after = text
            for start, end, new in reversed(changes):
                after = after[:start] + new + after[end:]
            mark = next(
                (mark for mark in reversed(stop.marks) if changes and mark.position <= changes[0][0]), ParserMark()
            )
            limit = min(stop.at + _WINDOW + max(len(after) - len(text), 0), len(after) + 1)
            self.left -= limit - mark.position
            if self.left < 0:
                return
            then = scan(after, self.rules, mark, limit)
            if after != text and len(after) - then.at < len(text) - stop.at:
                yield (len(after) - then.at if then.at < limit else -1, then.faults), Way(name, changes, after)
