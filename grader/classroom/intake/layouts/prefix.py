"""The part that all names of a class have in front of the student's: class repositories of GitHub are `<assignment>-<login>`."""

import re
from collections import Counter
from collections.abc import Callable, Sequence

_LAB = re.compile(r"lab-?\d+-", re.IGNORECASE)


def class_prefix(names: Sequence[str], rubric_id: str, knows: Callable[[str], bool] | None) -> str:
    """The prefix to remove from the names that have it, in lower case; empty where there is none.

    That is the rubric's id with a hyphen, or `lab` and a number where most names have it. With a roster, whose students `knows`
    recognises, it can be any prefix behind which the most names are in the roster. One more folder cannot change what the others mean.
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
    return _prefix_of_most(names, knows) if knows is not None else ""


def _prefix_of_most(names: Sequence[str], knows: Callable[[str], bool]) -> str:
    """The prefix that leaves the most known names: at least two, and more than are known as they are."""
    counts = Counter(
        name[: index + 1].lower()
        for name in names
        for index, letter in enumerate(name)
        if letter == "-" and knows(name[index + 1 :])
    )
    least = max(1, sum(map(knows, names)))
    best = max(counts.items(), key=lambda each: (each[1], each[0]), default=("", 0))
    return best[0] if best[1] > least else ""


def has_prefix(name: str, prefix: str) -> bool:
    """Whether a name goes on behind a prefix."""
    return len(name) > len(prefix) and name[: len(prefix)].lower() == prefix
