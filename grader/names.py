"""Did you mean: the known name that is closest to a mistyped one."""

from collections.abc import Iterable
from itertools import islice

from grader.text import quoted

_MAX_CANDIDATES = 300
MAX_LENGTH = 60  # characters of names that are compared


def closest(name: str, known: Iterable[str]) -> str | None:
    """Return the known name that is most like this one, or None if none is close."""
    from difflib import get_close_matches  # imported late: most files have no misspelt name

    if len(name) > MAX_LENGTH:
        return None
    lower = name.lower()
    others = (other for other in sorted(known, reverse=True) if other != name and len(other) <= MAX_LENGTH)
    candidates = {other.lower(): other for other in others}
    if len(candidates) > _MAX_CANDIDATES:  # comparing is slow: keep those that begin or end alike
        alike = (other for other in candidates if other[:3] == lower[:3] or other[-3:] == lower[-3:])
        candidates = {other: candidates[other] for other in islice(alike, _MAX_CANDIDATES)}
    matches = get_close_matches(lower, candidates, n=1, cutoff=0.7)
    if not matches:  # difflib rates swapped letters in short names too low, such as xzy for xyz
        matches = [other for other in candidates if sorted(other) == sorted(lower)]
    return candidates[matches[0]] if matches else None


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Return `; did you mean 'x'?` for the end of a message, or nothing if no known name is close."""
    match = closest(name, known)
    return f"; did you mean {quoted(match)}?" if match else ""


def folded(name: str) -> str:
    """Return the letters and digits of a name in lower case: my_robot, My-Robot and MYROBOT are one name."""
    return "".join(filter(str.isalnum, name.casefold()))
