"""The edits of a hint as the lines of a diff."""

from collections.abc import Callable, Iterator, Sequence
from difflib import SequenceMatcher
from itertools import groupby

from grader.source import Edit, Source
from grader.text import first_lines, printable

_MAX_LENGTH = 200  # characters of a line: where it is longer, only the old and the new text are shown
_MAX_LINES = 40


def diff_lines(edits: Sequence[Edit], source_of: Callable[[str], Source | None]) -> list[str]:
    """Return the printable lines of a diff: the name of each file, and each changed line before and after; of many the first."""
    lines: list[str] = []
    for path, of_file in groupby(sorted(edits), key=lambda edit: edit.path):
        changes, source = list(of_file), source_of(path)
        new_path = next((edit.renamed for edit in changes if edit.renamed), path)
        lines += [f"--- {path if source is not None else '/dev/null'}", f"+++ {new_path}"]
        for line, of_line in groupby(changes, key=lambda edit: edit.line):
            some = [edit for edit in of_line if edit.old or edit.new]
            if some:
                lines += [f"@@ line {line} @@", *_changed(*_texts(some, source))]
    return [printable(line) for line in first_lines(lines, _MAX_LINES)]


def _texts(edits: list[Edit], source: Source | None) -> tuple[str, str]:
    """Return the whole lines of some edits that begin in one line, before and after; only what changes where a line is long."""
    height = 1 + max(edit.old.count("\n") for edit in edits)
    start = edits[0].line
    before = "\n".join(source.line(start + number) for number in range(height)) if source is not None else ""
    after = before
    for edit in reversed(edits):
        column, old = edit.column - 1, edit.old.replace("\r\n", "\n")
        is_there = after.startswith(old, column) and len(after) <= _MAX_LENGTH * height
        if not is_there:
            return "\n".join(edit.old for edit in edits), "\n".join(edit.new for edit in edits)
        after = after[:column] + edit.new + after[column + len(old) :]
    return before, after


def _changed(before: str, after: str) -> Iterator[str]:
    old, new = ([line.removesuffix("\r") for line in text.split("\n")] for text in (before, after))
    for kind, old_start, old_end, new_start, new_end in SequenceMatcher(None, old, new, autojunk=False).get_opcodes():
        if kind != "equal":
            yield from (f"-{line}" for line in old[old_start:old_end])
            yield from (f"+{line}" for line in new[new_start:new_end])
