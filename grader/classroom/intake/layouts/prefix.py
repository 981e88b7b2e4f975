"""The part that all names of a class have in front of the student's: class repositories of GitHub are `<assignment>-<login>`."""

import re
from collections.abc import Callable, Sequence

_LAB = re.compile(r"lab-?\d+-", re.IGNORECASE)


def class_prefix(names: Sequence[str], rubric_id: str, knows: Callable[[str], bool] | None) -> str:
    """What to take away in front of every name, in lower case; empty where nothing is.

    That is the rubric's id, or `lab` and a number, with a hyphen, where every name has it; or, with a roster, which `knows` its
    students, whatever leaves names that all stand in it.
    """
    if not names or (knows and all(map(knows, names))):
        return ""
    found = _LAB.match(names[0])
    for prefix in (f"{rubric_id.lower()}-", found[0].lower() if found else ""):
        if len(prefix) > 1 and all(has_prefix(name, prefix) for name in names):
            return prefix
    if knows is None:
        return ""
    first = names[0]
    for end in (index + 1 for index, letter in enumerate(first) if letter == "-"):
        prefix = first[:end]
        if not all(name.startswith(prefix) for name in names):
            return ""
        if all(knows(name[end:]) for name in names):
            return prefix.lower()
    return ""


def has_prefix(name: str, prefix: str) -> bool:
    """Whether a name goes on behind a prefix."""
    return len(name) > len(prefix) and name[: len(prefix)].lower() == prefix
