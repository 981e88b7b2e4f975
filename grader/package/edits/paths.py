"""Paths that are put together from texts of a file: the edits of one text with which a path becomes another."""

import re
from collections.abc import Iterator
from itertools import islice

from grader.package.edits.python_file import PythonFile
from grader.source import Edit, Source

_PIECE = re.compile(r"[^\s\"'<>=(){},\[\]$;|]+")
_NAME = re.compile(r"\{[^{}]*\}")
_PACKAGE_ARGUMENT = re.compile(r"(?:package_share_\w+|package_prefix|FindPackage\w*|find-pkg-\w+)[\s(]*['\"]?$")
_MAX_PIECES = 1000  # of one file
_MAX_CALL = 80  # characters before an argument that are looked at
_REST_OF_ARGUMENT = re.compile(r"\s*,\s*")


def pieces(source: Source) -> Iterator[tuple[int, int]]:
    """Yield the offsets of the texts in a file that a path may be put together from."""
    if not source.path.endswith(".py"):
        yield from (match.span() for match in _PIECE.finditer(source.text))
        return
    for literal in PythonFile(source).literals:
        start = literal.start
        for name in _NAME.finditer(literal.text):
            yield start, literal.start + name.start()
            start = literal.start + name.end()
        yield start, literal.end


def moved(source: Source, actual: str, wanted: str, line: int = 1) -> list[Edit]:
    """Return the edits of one text each with which a path becomes the wanted one; those nearest to a line first."""
    found: dict[Edit, int] = {}
    for start, end in islice(pieces(source), _MAX_PIECES):
        piece = source.text[start:end]
        if piece.strip("./") and piece in actual:
            is_package = _PACKAGE_ARGUMENT.search(source.text, max(start - _MAX_CALL, 0), start) is not None
            for new in _replacements(piece, actual, wanted):
                if is_package and ("/" in new or not new):
                    continue  # the name of a package has no folders
                edit = source.edit(start, end, new) if new else _without(source, start, end)
                found.setdefault(edit, abs(edit.line - line))
    return sorted(found, key=lambda edit: (found[edit], -edit.line))


def _replacements(piece: str, actual: str, wanted: str) -> Iterator[str]:
    for place in re.finditer(re.escape(piece), actual):
        head, tail = actual[: place.start()], actual[place.end() :]
        if wanted.startswith(head) and wanted.endswith(tail) and len(head) + len(tail) <= len(wanted):
            new = wanted[len(head) : len(wanted) - len(tail)]
            if new != piece:
                yield new
        elif tail.startswith("/") and wanted == head + tail[1:]:
            yield ""


def _without(source: Source, start: int, end: int) -> Edit:
    """Return the edit that removes a text, as an argument with its quotes and comma where it is one."""
    text = source.text
    if text[start - 1 : start] in "'\"" and text[end : end + 1] == text[start - 1 : start]:
        after = _REST_OF_ARGUMENT.match(text, end + 1)
        if after is not None:
            return source.edit(start - 1, after.end(), "")
        before = re.search(r",\s*$", text[: start - 1])
        if before is not None:
            return source.edit(before.start(), end + 1, "")
    slash = text[end : end + 1] == "/"
    return source.edit(start, end + slash, "")
