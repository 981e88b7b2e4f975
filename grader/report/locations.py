"""Locations in a submission.

They are in words, with their source line or an edit of it, and with their path in the repository.
"""

import re
from collections.abc import Iterable, Iterator, Sequence
from difflib import SequenceMatcher
from itertools import groupby

from grader.base.extents import find_end
from grader.base.source import Edit, Location, Source, SourceOf
from grader.base.text import first_lines, indent_of, printable

_ARCHIVE = r"(?is)(.*?\.(?:zip|tar|tgz|tar\.gz))/"
# A line of a file: its number, its text up to the marked part, that part if it has one, and the
# rest.
SourceLine = tuple[int, str, str | None, str]
_EXCERPT_WIDTH = 120
_AROUND = 2  # lines of the source before and after the marked one
_MAX_WIDTH = 160  # characters of a line on a page
_MARGIN = 4  # characters before the marked part, if the line is cut
_MAX_CALLS = 3  # macros of xacro that are named
_MAX_LENGTH = 200  # the same for a diff: of a longer line only the old and the new text are in it
_MAX_LINES = 40  # of a diff


def _end_in_line(source: Source, where: Location) -> int:
    """Return the offset in its line after what begins at a location.

    This is the line's end where it goes on in others.
    """
    end_line, end_column = find_end(source, where)
    if end_line != where.line:
        end_column = len(source.line(where.line).rstrip()) + 1
    return max(where.column, end_column - 1)


def excerpt(
    source: Source, where: Location, room: int, indent: int | None = None
) -> tuple[str, str, str]:
    """Return the source line of a location in three parts.

    The text before what is meant, that text as far as it is in the line, and the rest.

    Together they have a number of characters around the marked part; without `indent` the line is
    not indented.
    """
    line = source.line(where.line)
    start = where.column - 1
    end = _end_in_line(source, where)
    cut = len(indent_of(line)) if indent is None else min(indent, start)
    if end - cut > room:
        cut = max(0, min(start - _MARGIN, len(line)))
    before = printable(line[cut:start])
    meant = printable(line[start:end])
    meant = meant[: max(0, room - len(before))]
    return before, meant, printable(line[end:])[: max(0, room - len(before + meant))].rstrip()


def calls_text(where: Location) -> str:
    """Return the macro calls of xacro that led to a location, innermost first.

    It is empty if there are none.
    """
    calls = [
        f"in macro {printable(macro)}, called at {printable(at.path)}:{at.line}"
        for macro, at in where.calls
    ]
    return "".join(f", {call}" for call in reversed(calls[-_MAX_CALLS:]))


def message_at(message: str, where: Location) -> str:
    """Return a message after the macro calls of xacro that led to its location."""
    calls = calls_text(where).removeprefix(", ")
    return f"{calls}: {message}" if calls else message


def location_text(where: Location) -> str:
    """Return a location as editors take it, path:line:column.

    The macro calls that led to it follow.
    """
    return f"{printable(where.path)}:{where.line}:{where.column}{calls_text(where)}"


def excerpt_lines(where: Location, source_of: SourceOf) -> Iterator[str]:
    """Yield the source line of a location, and a line that underlines the marked part.

    It yields nothing without the file.
    """
    source = source_of(where.path)
    if source:
        before, meant, after = excerpt(source, where, _EXCERPT_WIDTH)
        number = str(where.line)
        yield f"{number} | {(before + meant + after).rstrip()}"
        yield f"{' ' * len(number)} | {' ' * len(before)}{'-' * max(1, len(meant))}"


def source_lines(where: Location, source_of: SourceOf, many: int = _AROUND) -> list[SourceLine]:
    """Return the lines around a location, without their common indentation.

    There are `many` before as after it.

    Of a very long line it is the part around the marked text; there are none if the line is empty.
    """
    source = source_of(where.path)
    line = source.line(where.line) if source else ""
    if not source or not line.strip():
        return []
    if len(line) > _MAX_WIDTH:
        return [(where.line, *excerpt(source, where, _MAX_WIDTH))]
    first = max(1, where.line - many)
    last = where.line + many
    while not source.line(last).strip():  # ends at the marked line
        last -= 1
    texts = [source.line(number) for number in range(first, last + 1)]
    indent = min(len(text) - len(text.lstrip()) for text in texts if text.strip())
    lines = list[SourceLine]()
    for number, text in enumerate(texts, first):
        if number == where.line:
            lines.append((number, *excerpt(source, where, _MAX_WIDTH, indent)))
        else:
            lines.append((number, printable(text[indent:][:_MAX_WIDTH]), None, ""))
    return lines


def archive_around(path: str) -> str:
    """Return the archive in a submission that a file is in; empty if it is in none."""
    match = re.match(_ARCHIVE, path)
    return match[1] if match else ""


def diff_lines(edits: Sequence[Edit], source_of: SourceOf) -> list[str]:
    """Return the printable lines of a diff.

    They are each file, and each changed line before and after; of many the first.
    """
    lines = []
    for path, of_file in groupby(sorted(edits), key=lambda edit: edit.path):
        changes = list(of_file)
        source = source_of(path)
        new_path = next((edit.renamed for edit in changes if edit.renamed), path)
        lines += [f"--- {path if source else '/dev/null'}", f"+++ {new_path}"]
        lines += _changed_lines(changes, source)
    return [printable(line) for line in first_lines(lines, _MAX_LINES)]


def _changed_lines(edits: Iterable[Edit], source: Source | None) -> Iterator[str]:
    """Yield the lines of a file before and after edits, each below its number."""
    for line, of_line in groupby(edits, key=lambda edit: edit.line):
        some = [edit for edit in of_line if edit.old or edit.new]
        if some:
            yield f"@@ line {line} @@"
            yield from _diff(*_texts_around(some, source))


def _texts_around(edits: list[Edit], source: Source | None) -> tuple[str, str]:
    """Return the whole lines of edits that begin in one line, before and after.

    Of long lines, return only what changes.
    """
    height = 1 + max(edit.old.count("\n") for edit in edits)
    start = edits[0].line
    before = ""
    if source:
        before = "\n".join(source.line(number) for number in range(start, start + height))
    after = before
    for edit in reversed(edits):
        column = edit.column - 1
        old = edit.old.replace("\r\n", "\n")
        is_there = after.startswith(old, column) and len(after) <= _MAX_LENGTH * height
        if not is_there:
            old_texts = (edit.old for edit in edits)
            new_texts = (edit.new for edit in edits)
            return "\n".join(old_texts), "\n".join(new_texts)
        after = after[:column] + edit.new + after[column + len(old) :]
    return before, after


def _diff(before: str, after: str) -> Iterator[str]:
    old = [line.removesuffix("\r") for line in before.split("\n")]
    new = [line.removesuffix("\r") for line in after.split("\n")]
    changes = SequenceMatcher(None, old, new, autojunk=False).get_opcodes()
    for kind, old_start, old_end, new_start, new_end in changes:
        if kind != "equal":
            yield from (f"-{line}" for line in old[old_start:old_end])
            yield from (f"+{line}" for line in new[new_start:new_end])
