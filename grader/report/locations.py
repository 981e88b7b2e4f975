"""Places in a student's files: what is meant there, the line that is quoted, and the path in the repository around it."""

import re
from typing import NamedTuple

from grader.source import Location, Source
from grader.text import printable

_MEANT = re.compile(r"""[^\s=<>"'/]+\s*=\s*(?:"[^"]*"?|'[^']*'?)|<[^\s>]*[^>]*>?|[\w.]+""")
_INSIDE = re.compile(r"(?i)(.*?\.(?:zip|tar|tgz|tar\.gz))/", re.DOTALL)  # the archives that are looked into
_MARGIN = 4  # characters that are shown before what is meant, where the line is cut
_LONGEST = 500  # characters of a line that tell it from others: a whole file may stand in one


class Excerpt(NamedTuple):
    """A line of a file as far as there is room for it. What is meant begins at `start`, from 0, and is `width` long."""

    text: str
    start: int
    width: int


class Base(NamedTuple):
    """Where a submission stands in a repository: the folder of its paths, which ends in a slash, or the archive that they are in.

    `is_outside` tells that it stands in none: its paths name no file there.
    """

    folder: str = ""
    archive: str = ""
    is_outside: bool = False


class RepositoryLocation(NamedTuple):
    """A place as seen from the repository's root, counted from 1; `end` is the column behind what is meant.

    Without a line, the file as a whole is meant: it is an archive, or there is no better place. `text` is the line, `meant` the
    part of it that is meant; empty where that is too long to be quoted.
    """

    path: str
    line: int | None = None
    column: int = 1
    end: int = 1
    text: str = ""
    meant: str = ""


def width_of(line: str, column: int) -> int:
    """How many characters of a line are meant by a place in it: an attribute, a tag, a word; 1 where that cannot be told."""
    found = _MEANT.match(line, column - 1)
    return len(found[0].rstrip()) if found else 1


def excerpt(source: Source, where: Location, room: int) -> Excerpt:
    """The line of a place, cut to so many characters around what is meant."""
    line = source.line(where.line)
    start = where.column - 1
    width = width_of(line, where.column)
    cut = len(line) - len(line.lstrip())
    if start + width - cut > room:
        cut = max(0, min(start - _MARGIN, len(line)))
    before, meant = printable(line[cut:start]), printable(line[start : start + width])
    shown = (before + meant + printable(line[start + width :]))[:room].rstrip()
    return Excerpt(shown, len(before), max(1, min(len(meant), room - len(before))))


def archive_around(path: str) -> str:
    """The archive that a file of a submission stands in, by its path; empty for a file that stands in none."""
    found = _INSIDE.match(path)
    return found[1] if found else ""


def in_repository(where: Location, source: Source | None, base: Base) -> RepositoryLocation:
    """A place of a submission as seen from the repository's root."""
    around = base.archive or archive_around(where.path)
    if around:
        return RepositoryLocation(around if base.archive else base.folder + around)
    if source is None:
        return RepositoryLocation(base.folder + where.path, where.line, where.column, where.column)
    line = source.line(where.line)
    start, width = where.column - 1, width_of(line, where.column)
    meant = line[start : start + width] if width <= _LONGEST else ""
    path = base.folder + where.path
    return RepositoryLocation(path, where.line, where.column, where.column + width, line.strip()[:_LONGEST], meant)
