"""Unresolved merge conflicts of git in a text, and the text with the first version of each.

This text keeps its lines.
"""

import re

from grader.base.grouping import Span
from grader.base.patterns import on_use
from grader.base.records import Named

_MARKER = on_use(r"^[ \t]*(<{7}|\|{7}|={7}|>{7})(?=\s|\Z)[^\n]*(?:\n|\Z)", re.MULTILINE)
_VISIBLE = on_use(r"[^\r\n]")


class _MergeConflict(Named):
    """The offsets of a conflict, and those of the parts that are removed.

    Removed are its marker lines, and every version but the first.
    """

    start: int
    end: int
    removed: tuple[Span, ...]


def find_conflicts(text: str) -> list[_MergeConflict]:
    """Return the conflicts of a text whose three marker lines are there."""
    conflicts: list[_MergeConflict] = []
    opened = None
    first_end = None
    has_middle = False
    if "<<<<<<<" not in text:
        return conflicts
    for marker in _MARKER.finditer(text):
        match marker[1][0]:
            case "<":
                opened = marker
                first_end = None
                has_middle = False
            case "|" | "=":
                first_end = first_end or marker
                has_middle = has_middle or marker[1][0] == "="
            case _ if opened is not None and first_end is not None and has_middle:
                removed = (opened.span(), (first_end.start(), marker.end()))
                conflicts.append(_MergeConflict(opened.start(), marker.end(), removed))
                opened = None
    return conflicts


def without_conflicts(text: str, conflicts: list[_MergeConflict]) -> str:
    """Return a text with blanks for what is removed of its conflicts.

    Nothing else moves.
    """
    pieces: list[str] = []
    position = 0
    for start, end in (span for conflict in conflicts for span in conflict.removed):
        pieces += (text[position:start], _VISIBLE.sub(" ", text[start:end]))
        position = end
    return "".join([*pieces, text[position:]])


def describe_conflicts(text: str, conflicts: list[_MergeConflict]) -> str:
    """Return what is wrong with a text that has conflicts, and what to do."""
    first = conflicts[0]
    start = text.count("\n", 0, first.start) + 1
    end = start + text.count("\n", first.start, first.end - 1)
    more = f" (and {len(conflicts) - 1} more)" if len(conflicts) > 1 else ""
    which = f"an unresolved merge conflict of git, lines {start} to {end}{more}"
    return f"{which}: keep one of the two versions and delete the three marker lines"


class _ResolvedFile(Named):
    """The bytes of a file with the first version of each conflict, and what is wrong.

    `line` is that of the first conflict.
    """

    data: bytes
    message: str
    line: int


def resolve_conflicts(data: bytes) -> _ResolvedFile | None:
    """Return a file with the first version of each conflict; None if it has no conflict."""
    if b"<<<<<<<" not in data:
        return None
    text = data.decode("utf-8", "surrogateescape")
    conflicts = find_conflicts(text)
    if not conflicts:
        return None
    line = text.count("\n", 0, conflicts[0].start) + 1
    resolved = without_conflicts(text, conflicts).encode("utf-8", "surrogateescape")
    return _ResolvedFile(resolved, describe_conflicts(text, conflicts), line)
