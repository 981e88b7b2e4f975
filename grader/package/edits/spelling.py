"""Misspelt words: a word of a file that is close to one that the reference's file, the file itself or Python has."""

import keyword
import re
from collections.abc import Iterable, Iterator
from difflib import SequenceMatcher
from itertools import islice

from grader.edits import Proposal
from grader.package.edits.task import proposal
from grader.source import Source
from grader.static_python.imports import USUAL_NAMES

_WORD = re.compile(r"[^\W\d]\w*")
_MIN_LENGTH = 2
_MAX_WORDS = 8
_MAX_SUSPECTS = 60
_MAX_MORE = 2  # letters that one word has more than the other
_LONG = 8
_LIKENESS, _LIKENESS_OF_LONG = 0.75, 0.88
_ROS = {"rviz2", "xacro", "robot_state_publisher", "joint_state_publisher", "joint_state_publisher_gui"}
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
    right |= {word for word in places if len(places[word]) > 1} | _ROS
    right |= _PYTHON if source.path.endswith(".py") else set()
    suspects = [word for word in places if word not in right and len(word) >= _MIN_LENGTH]
    near = set(lines)

    def order(word: str) -> tuple[bool, int, int]:
        first = places[word][0].start()
        return source.at(first).line not in near, len(places[word]), first

    guesses = ((word, _nearest(word, right)) for word in sorted(suspects, key=order)[:_MAX_SUSPECTS])
    for word, guess in islice(((word, guess) for word, guess in guesses if guess), _MAX_WORDS):
        edits = [source.edit(*place.span(), guess) for place in places[word]]
        yield proposal(edits, f"a misspelt name in {what}", f"correct the spelling in {what}")


def _nearest(word: str, known: Iterable[str]) -> str | None:
    """Return the known word that a slip of the hand makes this one: a letter more, less or other, two that are swapped."""
    lower, best = word.lower(), (_LIKENESS if len(word) < _LONG else _LIKENESS_OF_LONG, "")
    matcher = SequenceMatcher(None, "", lower, autojunk=False)
    for other in sorted(known):
        same_end = other[:1].lower() == lower[:1] or other[-2:].lower() == lower[-2:]
        if not same_end or abs(len(other) - len(word)) > _MAX_MORE:
            continue
        matcher.set_seq1(other.lower())
        if matcher.quick_ratio() >= best[0]:
            swapped = sorted(other.lower()) == sorted(lower)
            best = max(best, (matcher.ratio() + 0.1 * swapped + 0.01 * (other[:1] == word[:1]), other))
    return best[1] or None
