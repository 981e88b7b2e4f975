"""Versions of a file that its path says are outdated: in a folder `backup`, or named `my_robot_old.urdf`."""

import re

OUTDATED = "its path says that it is an old version"
_CAMEL = re.compile(r"(?<=[^\W\d_A-Z])(?=[A-Z])")
_WORD = re.compile(r"[^\W\d_]+")
_OLD = frozenset(
    {
        "backup", "backups", "bak", "old", "older", "oldest", "previous", "prev", "archive", "archived", "trash", "unused",
        "deprecated", "legacy", "copy", "copies", "kopie",
    }
)  # fmt: skip


def is_outdated(path: str) -> bool:
    """Return whether a part of a path says that it is an old version."""
    return not _OLD.isdisjoint(_WORD.findall(_CAMEL.sub(" ", path).casefold()))
