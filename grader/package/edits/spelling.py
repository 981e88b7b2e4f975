"""Misspelt words: a word of a file that is close to one that the reference's file, the file itself or Python has."""

import keyword
import re
from collections.abc import Iterable, Iterator

from grader.edits import Proposal
from grader.names import closest
from grader.package.edits.task import proposal
from grader.source import Edit, Source
from grader.static_python.imports import USUAL_NAMES

_WORD = re.compile(r"[^\W\d]\w*")
_MIN_LENGTH = 2
_MAX_WORDS = 8
_PYTHON = {*keyword.kwlist, *USUAL_NAMES, "launch", "launch_ros", "path", "join", "package_name", "open", "read"} - {
    "?"
}


def respelt(source: Source, known: Iterable[str], lines: Iterable[int], what: str) -> Iterator[Proposal]:
    """Yield edits that replace a misspelt word everywhere; words on these lines come first, then rare ones.

    `known` are texts with words that are spelt as they should be; the file's other words may be the right ones, too.
    """
    places: dict[str, list[re.Match[str]]] = {}
    for match in _WORD.finditer(source.text):
        places.setdefault(match[0], []).append(match)
    right = {word for text in known for word in _WORD.findall(text)}
    right |= _PYTHON if source.path.endswith(".py") else set()
    suspects = [word for word in places if word not in right and len(word) >= _MIN_LENGTH]
    near = set(lines)

    def order(word: str) -> tuple[bool, int, int]:
        first = places[word][0].start()
        return source.at(first).line not in near, len(places[word]), first

    found = 0
    for word in sorted(suspects, key=order):
        guess = closest(word, right) or closest(word, [other for other in places if len(places[other]) > 1])
        if guess is not None:
            yield proposal(
                _replaced(source, places[word], guess), f"a misspelt name in {what}", f"correct the spelling in {what}"
            )
            found += 1
        if found == _MAX_WORDS:
            return


def _replaced(source: Source, places: Iterable[re.Match[str]], new: str) -> list[Edit]:
    return [source.edit(place.start(), place.end(), new) for place in places]
