"""Did you mean: the known name that a mistyped one is closest to."""

from collections.abc import Iterable
from itertools import islice

_MOST_CANDIDATES = 300
_LONGEST = 60  # characters of a name that are shown


def quoted(name: str) -> str:
    """A name of the file for a message: between quotes, and cut where it is very long."""
    return repr(name) if len(name) <= _LONGEST else repr(name[: _LONGEST - 3] + "...")


def closest(name: str, known: Iterable[str]) -> str | None:
    """The known name that is most like this one, or None where none is close."""
    from difflib import get_close_matches  # imported late: most files have no misspelt name

    if len(name) > _LONGEST:
        return None
    lower = name.lower()
    candidates = {each.lower(): each for each in sorted(known, reverse=True) if each != name and len(each) <= _LONGEST}
    if len(candidates) > _MOST_CANDIDATES:  # comparing takes its time: keep those that begin or end alike
        alike = (each for each in candidates if each[:3] == lower[:3] or each[-3:] == lower[-3:])
        candidates = {each: candidates[each] for each in islice(alike, _MOST_CANDIDATES)}
    matches = get_close_matches(lower, candidates, n=1, cutoff=0.7)
    if not matches:  # swapped letters weigh too much in short names, such as xzy for xyz
        matches = [each for each in candidates if sorted(each) == sorted(lower)]
    return candidates[matches[0]] if matches else None


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """`; did you mean 'x'?` to be put behind a message, or nothing where no known name is close."""
    match = closest(name, known)
    return f"; did you mean {quoted(match)}?" if match else ""
