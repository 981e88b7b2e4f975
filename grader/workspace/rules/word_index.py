"""Where the words of a text are: it is searched once for all names that are looked up in it."""

from functools import cache, cached_property

from grader.base.patterns import on_use
from grader.base.source import Source

_WORD = on_use(r"[\w-]+")
_IS_INSIDE = on_use(r"[\w-]|\.\w")  # behind a name that goes on
Span = tuple[int, int]  # the offsets of the first character and after the last one


class WordIndex:
    """The words of a text by what they are. `NameFixes` makes one of each file with a finding."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.find = cache(self._find)

    @cached_property
    def _starts(self) -> dict[str, list[int]]:
        """The offsets at which each word begins."""
        starts: dict[str, list[int]] = {}
        for match in _WORD.finditer(self.source.text):
            starts.setdefault(match[0], []).append(match.start())
        return starts

    def _find(self, name: str) -> list[Span]:
        """Return where a name is written as a whole, in order; empty for a name without words.

        The places of the rarest of its words are looked at.
        """
        places = []
        for match in _WORD.finditer(name):
            places.append((match.start(), self._starts.get(match[0], [])))
        if not places:
            return []
        offset, starts = min(places, key=lambda place: len(place[1]))
        text = self.source.text
        spans = []
        for start in starts:
            begin = start - offset
            end = begin + len(name)
            is_begun = begin > 0 and _WORD.match(text, begin - 1) is not None
            is_written = begin >= 0 and text.startswith(name, begin)
            if is_written and not is_begun and not _IS_INSIDE.match(text, end):
                spans.append((begin, end))
        return spans
