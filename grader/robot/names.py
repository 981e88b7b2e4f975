"""Did you mean: the known name that a mistyped one is closest to."""

from collections.abc import Iterable


def closest(name: str, known: Iterable[str]) -> str | None:
    """The known name that is most like this one, or None where none is close."""
    from difflib import get_close_matches  # imported late: most files have no misspelt name

    if len(name) > 100:
        return None
    candidates = {each.lower(): each for each in sorted(known, reverse=True) if each != name and len(each) <= 100}
    matches = get_close_matches(name.lower(), candidates, n=1, cutoff=0.7)
    return candidates[matches[0]] if matches else None


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """`, did you mean 'x'?` to be put behind a message, or nothing where no known name is close."""
    match = closest(name, known)
    return f"; did you mean {match!r}?" if match else ""
