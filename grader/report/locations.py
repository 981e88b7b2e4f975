"""Locations in a submission: the source line around them, and their path in the repository."""

import re
from typing import NamedTuple

from grader.source import Location, Source
from grader.text import printable

_MEANT = re.compile(r"""[^\s=<>"'/]+\s*=\s*(?:"[^"]*"?|'[^']*'?)|<[^\s>]*[^>]*>?|[\w.]+""")  # attribute, tag, word
_ARCHIVE = re.compile(r"(?i)(.*?\.(?:zip|tar|tgz|tar\.gz))/", re.DOTALL)
_MARGIN = 4  # characters before the marked part, if the line is cut
_MAX_CALLS = 3  # macros of xacro that are named
_MAX_TEXT = 500  # characters of a line: a whole file may be one line


class Excerpt(NamedTuple):
    """A source line, cut to the available width. The marked part starts at `start`, from 0, and is `width` long."""

    text: str
    start: int
    width: int


class Base(NamedTuple):
    """The location of a submission in a repository: the folder of its paths, with a slash at its end, or the archive that contains them.

    With `is_outside` it is in no repository.
    """

    folder: str = ""
    archive: str = ""
    is_outside: bool = False


class RepositoryLocation(NamedTuple):
    """A location as seen from the repository's root, from 1; `end` is the column after the marked part.

    Without a line it is the whole file. `text` is the source line, `meant` the part of it that is meant, empty if it is too long.
    """

    path: str
    line: int | None = None
    column: int = 1
    end: int = 1
    text: str = ""
    meant: str = ""


def width_of(line: str, column: int) -> int:
    """Return the length of the attribute, tag or word at a column; 1 if there is none."""
    found = _MEANT.match(line, column - 1)
    return len(found[0].rstrip()) if found else 1


def excerpt(source: Source, where: Location, room: int) -> Excerpt:
    """Return the source line of a location, cut to a number of characters around the marked part."""
    line = source.line(where.line)
    start = where.column - 1
    width = width_of(line, where.column)
    cut = len(line) - len(line.lstrip())
    if start + width - cut > room:
        cut = max(0, min(start - _MARGIN, len(line)))
    before, meant = printable(line[cut:start]), printable(line[start : start + width])
    text = (before + meant + printable(line[start + width :]))[:room].rstrip()
    return Excerpt(text, len(before), max(1, min(len(meant), room - len(before))))


def calls_text(where: Location) -> str:
    """Return the macro calls of xacro that led to a location, innermost first; empty if there are none."""
    calls = [f"in macro {printable(macro)}, called at {printable(at.path)}:{at.line}" for macro, at in where.calls]
    return "".join(f", {call}" for call in reversed(calls[-_MAX_CALLS:]))


def archive_around(path: str) -> str:
    """Return the archive in a submission that a file is in; empty if it is in none."""
    found = _ARCHIVE.match(path)
    return found[1] if found else ""


def in_repository(where: Location, source: Source | None, base: Base) -> RepositoryLocation:
    """Return a location of a submission as seen from the repository's root."""
    archive = base.archive or archive_around(where.path)
    if archive:
        return RepositoryLocation(archive if base.archive else base.folder + archive)
    path = base.folder + where.path
    if source is None:
        return RepositoryLocation(path, where.line, where.column, where.column)
    line = source.line(where.line)
    start, width = where.column - 1, width_of(line, where.column)
    meant = line[start : start + width] if width <= _MAX_TEXT else ""
    return RepositoryLocation(path, where.line, where.column, where.column + width, line.strip()[:_MAX_TEXT], meant)
