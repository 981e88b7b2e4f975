"""The known name that is closest to a mistyped one: to suggest it, or to read it in its place."""

from collections.abc import Iterable, Sequence
from functools import lru_cache
from itertools import islice, product

from grader.base.grouping import Strings, StringsByName
from grader.base.patterns import on_use
from grader.base.text import quoted

_Words = Strings

_MAX_CANDIDATES = 300
_MAX_KNOWN = 1000
_MAX_CACHED = 4096  # names whose words are kept
_LIKENESS, _MARGIN = 0.7, 0.1  # of difflib's ratios
MAX_LENGTH = 60  # characters of names that are compared
MAX_GUESSES = 50  # names of one file that are compared, because that takes long
_CAMEL = on_use(r"(?<=[^\W\d_A-Z])(?=[A-Z])")
_WORD = on_use(r"\d+|[^\W\d_]+")
_LETTER_BORDER = on_use(r"(?<!\d) (?!\d)")
_AXES_AND_SIDES = frozenset("xyzlrfb")
# Words of side, place, axis and measure: none is a misspelling of another one.
_DISTINCT = frozenset(
    {
        "left",
        "right",
        "front",
        "rear",
        "back",
        "fore",
        "top",
        "bottom",
        "upper",
        "lower",
        "inner",
        "outer",
        "middle",
        "side",
        "first",
        "second",
        "third",
        "last",
        "start",
        "end",
        "forward",
        "backward",
        "minimum",
        "maximum",
        "min",
        "max",
        "roll",
        "pitch",
        "yaw",
        "width",
        "length",
        "height",
        "depth",
        "thickness",
        "radius",
        "diameter",
        "size",
        "mass",
        "weight",
    }
)


def closest(
    name: str, known: Iterable[str], *, likeness: float = _LIKENESS, is_clear: bool = False
) -> str | None:
    """Return the known name that is most like this one, or None if none is close.

    The first step that finds a name decides: the same words in another order; the most similar text
    by difflib; the same letters in another order. The name of a sibling is never returned: one with
    another number, or another word of side, place or measure.

    Args:
        name: The name that is not known.
        known: The known names; of more than 300 those that begin or end alike are compared.
        likeness: The smallest ratio of difflib.
        is_clear: Whether no other known name may be nearly as similar.
    """
    from difflib import get_close_matches  # late: few files have a misspelt name

    if len(name) > MAX_LENGTH:
        return None
    lower = name.lower()
    candidates = _candidates(name, known)
    reordered = _with_same_words(name, candidates)
    if reordered is not None:
        return reordered
    matches = get_close_matches(lower, candidates, n=2, cutoff=likeness)
    if is_clear and _are_equally_similar(lower, matches):
        return None
    if not matches:  # difflib rates swapped letters in short names too low, such as xzy for xyz
        letters = sorted(lower)
        matches = [candidate for candidate in candidates if sorted(candidate) == letters]
    return candidates[matches[0]] if matches else None


def _with_same_words(name: str, candidates: StringsByName) -> str | None:
    """Return the known name that has the several words of another one in another order."""
    words = sorted(_words(name))
    if len(words) > 1:
        for candidate, other in candidates.items():
            if sorted(_words(candidate)) == words:
                return other
    return None


def _are_equally_similar(name: str, matches: Sequence[str]) -> bool:
    """Return whether two names are nearly as similar to another one."""
    from difflib import SequenceMatcher  # late: as above

    if len(matches) < 2:
        return False
    first, second = (SequenceMatcher(None, name, match).ratio() for match in matches)
    return first - second <= _MARGIN


def _candidates(name: str, known: Iterable[str]) -> dict[str, str]:
    """Return the names that a name may stand for, by their lower case; no sibling of it."""
    lower = name.lower()
    sides = _sides(name)
    candidates = {}
    for other in sorted(known, reverse=True):
        if other != name and len(other) <= MAX_LENGTH:
            candidates[other.lower()] = other
    if len(candidates) > _MAX_CANDIDATES:  # comparing is slow
        ends = (lower[:3], lower[-3:])
        alike = (key for key in candidates if key[:3] == ends[0] or key[-3:] == ends[1])
        candidates = {key: candidates[key] for key in islice(alike, _MAX_CANDIDATES)}
    return {
        key: other for key, other in candidates.items() if not _are_siblings(sides, _sides(other))
    }


def _sides(name: str) -> _Words:
    """Return the numbers and the words of side, place and measure in a name."""
    return _sides_in(_words(name))


@lru_cache(maxsize=_MAX_CACHED)
def _sides_in(words: _Words) -> _Words:
    return tuple(sorted(word for word in words if word.isdigit() or word in _DISTINCT))


def _are_siblings(sides: _Words, others: _Words) -> bool:
    """Return whether two names differ in the numbers or sides that both of them have.

    Numbers of another length may be mistyped.
    """
    if len(sides) != len(others):
        return False
    for side, other in zip(sides, others, strict=True):
        if side != other and side.isdigit() == other.isdigit():
            return not side.isdigit() or len(side) == len(other)
    return False


def is_misspelling(name: str, known: str) -> bool:
    """Return whether a name is similar to another, and so is each of its words.

    The names robot_arm and robot_base are not similar in this sense.
    """
    if closest(name, [known]) is None:
        return False
    words = name.split("_")
    others = known.split("_")
    if len(words) != len(others):
        return True
    for word, other in zip(words, others, strict=True):
        differing = abs(len(word) - len(other))
        differing += sum(one != two for one, two in zip(word, other, strict=False))
        if differing > 1 and closest(word, [other]) is None:
            return False
    return True


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Return the end of a message: `; did you mean 'x'?`.

    Returns nothing if no known name is close.
    """
    match = closest(name, known)
    return f"; did you mean {quoted(match)}?" if match else ""


def similar_there(name: str, known: Iterable[str]) -> str:
    """Return the end of a message that asks for a name: `; there is 'x'`.

    Returns nothing if no known name is close: the one that is asked for is the right one.
    """
    match = closest(name, known)
    return f"; there is {quoted(match)}" if match else ""


def first_part(path: str) -> str:
    """Return what a path or a name has before its first slash."""
    return path.partition("/")[0]


def last_part(path: str) -> str:
    """Return what a path or a name has behind its last slash."""
    return path.rpartition("/")[2]


def folded(name: str) -> str:
    """Return the letters and digits of a name in lower case.

    The names my_robot, My-Robot and MYROBOT become one name.
    """
    return "".join(filter(str.isalnum, name.casefold()))


def near(name: str, known: Iterable[str], suffix: str = "") -> str | None:
    """Return the known name that another one surely stands for.

    Returns None if none is near, or several are equally near.

    Words are compared one by one, whatever their case: one letter, or one exchanged pair, may
    differ in a known word of four letters or more, two in seven or more. `suffix`, the kind of
    thing that is named, may be missing at the end.
    """
    words = _words(name)
    others = set(islice(known, _MAX_KNOWN + 1)) - {name}
    if len(others) > _MAX_KNOWN:
        return None
    distances = {}
    for other in others:
        distance = _distance(words, _words(other), suffix)
        if distance is not None:
            distances[other] = distance
    nearest = min(distances.values(), default=None)
    nearest_names = [other for other, distance in distances.items() if distance == nearest]
    if len(nearest_names) == 1:
        return nearest_names[0]
    return None


def are_of_one_side(name: str, other: str) -> bool:
    """Return whether two names have the same numbers and words of side, place and measure.

    The order of these does not matter.
    """
    words = _words(name), _words(other)
    pairs: Iterable[tuple[str, str]] = ()
    if len(words[0]) == len(words[1]) and sorted(words[0]) != sorted(words[1]):
        pairs = zip(*words, strict=True)
    is_other = any(one != known and _are_distinct(one, known) for one, known in pairs)
    return _sides(name) == _sides(other) and not is_other


def _words(name: str) -> _Words:
    return _cached_words(name[: MAX_LENGTH + 1])


@lru_cache(maxsize=_MAX_CACHED)
def _cached_words(name: str) -> _Words:
    return tuple(_WORD.findall(_CAMEL.sub(" ", name).casefold()))


@lru_cache(maxsize=_MAX_CACHED)
def _letters(words: _Words) -> str:
    return _LETTER_BORDER.sub("", " ".join(words))


def _distance(name: _Words, known: _Words, suffix: str) -> tuple[int, bool] | None:
    """Return how many letters differ, and whether the suffix is missing.

    Returns None for names that are not near.
    """
    texts = [_letters(name), _letters(known)]
    if not all(texts) or max(map(len, texts)) > MAX_LENGTH:
        return None
    if texts[0] == texts[1]:
        return 0, False
    shorter, longer = sorted((name, known), key=len)
    is_cut = len(longer) == len(shorter) + 1 and longer[-1] == suffix
    if not is_cut and len(name) != len(known):
        return None
    differing = 0
    for pair in zip(name, known, strict=False):
        letters = _differing_letters(*pair)
        if letters is None:
            return None
        differing += letters
    return differing, is_cut


@lru_cache(maxsize=_MAX_CACHED)  # names share their words
def _differing_letters(word: str, known: str) -> int | None:
    """Return how many letters or exchanged pairs differ in two words.

    Returns None if these are too many.
    """
    if word == known:
        return 0
    most = _most_differing(word, known)
    if abs(len(word) - len(known)) > most:
        return None
    before = [0]
    row = list(range(len(known) + 1))
    for i, letter in enumerate(word):
        earlier = before
        before = row
        row = [i + 1]
        for j, other in enumerate(known):
            cost = min(before[j] + (0 if letter == other else 1), before[j + 1] + 1, row[j] + 1)
            if i and j and (letter, other) == (known[j - 1], word[i - 1]):
                cost = min(cost, earlier[j - 1] + 1)
            row.append(cost)
    return row[-1] if row[-1] <= most else None


def _most_differing(word: str, known: str) -> int:
    """Return how many letters of a known word may be mistyped."""
    if len(known) < 4 or known.isdigit() or _are_distinct(word, known):
        return 0
    return 1 if len(known) < 7 else 2


def _are_distinct(word: str, known: str) -> bool:
    """Return whether two words differ in a side, axis or measure.

    This word may be joined to another word.
    """
    if {word, known} <= _DISTINCT or word[1:] == known[1:]:  # posx and posy, lwheel and rwheel
        return True
    if (
        len(word) == len(known)
        and word[:-1] == known[:-1]
        and {word[-1], known[-1]} <= _AXES_AND_SIDES
    ):
        return True
    pairs = product(_distinct_parts(word), _distinct_parts(known))
    return any(part != other for part, other in pairs)


def _distinct_parts(word: str) -> list[str]:
    """Return the sides, axes and measures that a word begins or ends with."""
    return [part for part in _DISTINCT if word.startswith(part) or word.endswith(part)]
