"""The prefix of all names in a class: class repositories of GitHub are `<assignment>-<login>`."""

import re
from collections import Counter
from collections.abc import Callable, Sequence

_LAB = re.compile(r"lab-?\d+-", re.IGNORECASE)


def class_prefix(names: Sequence[str], rubric_id: str, knows: Callable[[str], bool] | None) -> str:
    """Return the prefix to remove from the names that have it, in lower case; empty if there is none.

    It is the rubric's id with a hyphen, or `lab` and a number if most names have it. With a roster (`knows` says whether a name is on
    it) it can be any prefix after which the most names are on the roster. One more folder cannot change what the others mean.
    """
    if not names or (knows and all(map(knows, names))):
        return ""
    own = f"{rubric_id.lower()}-"
    if len(own) > 1 and any(has_prefix(name, own) for name in names):
        return own
    labs = Counter(
        found[0].lower() for name in names if (found := _LAB.match(name)) and has_prefix(name, found[0].lower())
    )
    for prefix, count in labs.most_common(1):
        if count * 2 > len(names):
            return prefix
    return _roster_prefix(names, knows) if knows is not None else ""


def _roster_prefix(names: Sequence[str], knows: Callable[[str], bool]) -> str:
    """Return the prefix that leaves the most known names: at least two, and more than are known with their prefix."""
    counts = Counter(
        name[: index + 1].lower()
        for name in names
        for index, letter in enumerate(name)
        if letter == "-" and knows(name[index + 1 :])
    )
    minimum = max(1, sum(map(knows, names)))
    prefix, count = max(counts.items(), key=lambda item: (item[1], item[0]), default=("", 0))
    return prefix if count > minimum else ""


def has_prefix(name: str, prefix: str) -> bool:
    """Return whether a name starts with a prefix and continues after it, ignoring case."""
    return len(name) > len(prefix) and name[: len(prefix)].lower() == prefix
