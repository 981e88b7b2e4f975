"""Files that a student kept of earlier work, told by their names. They are graded if there is nothing else."""

import re

BACKUP = "it is named like a backup"

_CAMEL = re.compile(r"(?<=[^\W\d_A-Z])(?=[A-Z])")
_WORD = re.compile(r"[^\W\d_]+")
_WORDS = frozenset(
    {
        "old", "older", "oldest", "backup", "backups", "bak", "copy", "copies", "kopie", "archive", "archived", "previous", "prev",
        "deprecated", "legacy", "unused", "trash", "draft", "drafts", "broken", "wrong",
    }
)  # fmt: skip


def is_backup(path: str) -> bool:
    """Return whether a file, or a folder around it, is named like a backup: old_ws, my_robot - Copy, my_robot.urdf.bak."""
    return not _WORDS.isdisjoint(_WORD.findall(_CAMEL.sub(" ", path).casefold()))
