"""Did you mean: the known name that a mistyped one is closest to."""

from collections.abc import Iterable
from itertools import islice

from grader.text import quoted

_MAX_CANDIDATES = 300
_MAX_LENGTH = 60  # characters of a name that is compared


def closest(name: str, known: Iterable[str]) -> str | None:
    """The known name that is most like this one, or None where none is close."""
    from difflib import get_close_matches  # imported late: most files have no misspelt name

    if len(name) > _MAX_LENGTH:
        return None
    lower = name.lower()
    candidates = {
        each.lower(): each for each in sorted(known, reverse=True) if each != name and len(each) <= _MAX_LENGTH
    }
    if len(candidates) > _MAX_CANDIDATES:  # comparing takes its time: keep those that begin or end alike
        alike = (each for each in candidates if each[:3] == lower[:3] or each[-3:] == lower[-3:])
        candidates = {each: candidates[each] for each in islice(alike, _MAX_CANDIDATES)}
    matches = get_close_matches(lower, candidates, n=1, cutoff=0.7)
    if not matches:  # swapped letters weigh too much in short names, such as xzy for xyz
        matches = [each for each in candidates if sorted(each) == sorted(lower)]
    return candidates[matches[0]] if matches else None


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """`; did you mean 'x'?` to be put behind a message, or nothing where no known name is close."""
    match = closest(name, known)
    return f"; did you mean {quoted(match)}?" if match else ""
