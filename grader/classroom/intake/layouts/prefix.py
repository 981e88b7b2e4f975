"""The part that all names of a class have in front of the student's: class repositories of GitHub are `<assignment>-<login>`."""

import re
from collections import Counter
from collections.abc import Callable, Sequence

_LAB = re.compile(r"lab-?\d+-", re.IGNORECASE)


def class_prefix(names: Sequence[str], rubric_id: str, knows: Callable[[str], bool] | None) -> str:
    """The prefix to remove from the names that have it, in lower case; empty where there is none.

    That is the rubric's id, or `lab` and a number, with a hyphen, where every name has it. With a roster, whose students `knows`
    recognises, it is the prefix behind which the most names are in the roster: one more folder cannot change what the others mean.
    """
    if not names or (knows and all(map(knows, names))):
        return ""
    found = _LAB.match(names[0])
    for prefix in (f"{rubric_id.lower()}-", found[0].lower() if found else ""):
        if len(prefix) > 1 and all(has_prefix(name, prefix) for name in names):
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
