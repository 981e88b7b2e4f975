"""When the tables of facts about ROS 2 were read, and for which releases: the file tables.toml."""

import textwrap
from functools import cache
from typing import NamedTuple

from grader.ros.known.releases import RELEASES, Release
from grader.ros.known.typed_rows import read_file

_WIDTH = 80


class _KnownTable(NamedTuple):
    """A table of facts, or several of one kind."""

    name: str
    files: tuple[
        str, ...
    ]  # patterns of paths in grader/ros; the first table that has a file counts
    read: str  # when, in words
    until: Release  # the last release that was read
    source: str


class _Tables(NamedTuple):
    table: tuple[_KnownTable, ...]


@cache
def known_tables() -> tuple[_KnownTable, ...]:
    """Return the tables, in the order of their file."""
    return read_file(_Tables, "tables").table


def releases_explanation() -> str:
    """Return which releases of ROS 2 are known, and to which date."""
    names = ", ".join(release.title() for release in RELEASES)
    lines = [
        "Releases of ROS 2 that --distro and distro take, oldest first:",
        f"{names}.",
        "",
        "Each table was read up to a release. Of later ones it has only what it says of",
        "them, and what it does not know makes nothing wrong.",
    ]
    for table in known_tables():
        lines += ["", f"{table.name}"]
        lines.append(f"  Up to {table.until.title()}, read in {table.read}")
        lines += textwrap.wrap(
            f"Source: {table.source}", _WIDTH - 2, initial_indent="  ", subsequent_indent="  "
        )
    return "\n".join(lines) + "\n"
