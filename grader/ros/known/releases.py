"""The releases of ROS 2, and the names that not all of them have."""

from collections.abc import Collection, Sequence
from functools import cache
from pathlib import Path
from typing import Literal, get_args

import tomli

from grader.base.grouping import Strings
from grader.base.records import Named
from grader.base.text import enumerated

# A release of ROS 2, oldest first: https://docs.ros.org/en/rolling/Releases.html
Release = Literal["foxy", "galactic", "humble", "iron", "jazzy", "kilted", "lyrical", "rolling"]
Releases = tuple[Release, ...]
RELEASES: Releases = get_args(Release)
NameKind = Literal[
    "plugin",
    "controller",
    "package",
    "program",
    "program argument",
    "launch file",
    "parameter",
    "topic",
    "argument",
    "class",
    "header",
]
_FILE = Path(__file__).with_name("releases.toml")
_MAX_PLACES = 2  # files that are named


class StatedReleases(Named):
    """The releases that a workspace is for, and the files or the option that say so.

    Names of every release are accepted if there are none.
    """

    releases: Releases = ()
    places: Strings = ()

    @property
    def words(self) -> str:
        """Return the releases and their places in words."""
        if not self.releases:
            return "release: not stated; names of every release are accepted"
        places = enumerated(self.places, _MAX_PLACES)
        return f"release: {enumerated(self.releases, len(RELEASES), 'or')} ({places})"


NOT_STATED = StatedReleases()


class _ReleaseName(Named):
    """A name in the releases from one on, up to another one.

    A star at its end stands for the rest.
    """

    name: str
    since: Release = RELEASES[0]
    until: Release = RELEASES[-1]

    @property
    def first(self) -> int:
        """The number of the first release that has it."""
        return RELEASES.index(self.since)

    @property
    def last(self) -> int:
        """The number of the last release that has it."""
        return RELEASES.index(self.until)

    def matches(self, name: str) -> bool:
        """Return whether a name is this one."""
        start = self.name.removesuffix("*")
        return name == self.name or (start != self.name and name.startswith(start))

    def is_in(self, release: Release) -> bool:
        """Return whether a release has it."""
        return self.first <= RELEASES.index(release) <= self.last

    def replace_name(self, other: "_ReleaseName", name: str) -> str:
        """Return what a name, which matches another one of the row, is here."""
        start = self.name.removesuffix("*")
        if start == self.name:
            return start
        return start + name.removeprefix(other.name.removesuffix("*"))


class _OtherName(Named):
    """What a name of other releases is called, in words; and the name, empty without one."""

    message: str
    name: str = ""


def other_name(
    kind: NameKind, name: str, releases: Collection[Release], *, shown: str = ""
) -> _OtherName | None:
    """Return what a name is called in the given releases.

    The result is None if one of them has it, or if none is given.

    Args:
        kind: What has the name.
        name: The name, as releases.toml has it.
        releases: The releases in one of which the name should be.
        shown: The start of the name that messages leave out, such as the package of a program.
    """
    row = _row_with(kind, name)
    named_row = next((other for other in row if other.matches(name)), None)
    if not named_row or not releases or any(map(named_row.is_in, releases)):
        return None
    release = min(releases, key=RELEASES.index)
    is_later = RELEASES.index(release) > named_row.last
    here = name.removeprefix(shown)
    for meant in row:
        if meant.is_in(release):
            there = meant.replace_name(named_row, name).removeprefix(shown)
            return _renamed(named_row, meant, here, there, is_later=is_later)
    if is_later:
        next_one = RELEASES[named_row.last + 1].title()
        return _OtherName(f"there is no {kind} {here!r} from {next_one} on")
    return _OtherName(f"there is no {kind} {here!r} before {named_row.since.title()}")


def _renamed(
    named_row: _ReleaseName, meant: _ReleaseName, here: str, there: str, *, is_later: bool
) -> _OtherName:
    """Return that a name is another one from a release on, or until one."""
    if is_later:
        first = RELEASES[max(named_row.last + 1, meant.first)]
        return _OtherName(f"{here!r} is {there!r} from {first.title()} on", there)
    last = RELEASES[min(named_row.first - 1, meant.last)]
    return _OtherName(f"{here!r} is {there!r} until {last.title()}", there)


def names_in(kind: NameKind) -> Sequence[str]:
    """Return the names of a kind, each once; with a star for the rest of some."""
    return list(dict.fromkeys(name.name for row in _rows(kind) for name in row))


def names_without(kind: NameKind, releases: Collection[Release]) -> Sequence[str]:
    """Return the names of a kind that none of some releases has; none without releases."""
    names = names_in(kind)
    return [name for name in names if releases and not {*releases_with(kind, name)} & {*releases}]


def is_before(release: Release, other: Release) -> bool:
    """Return whether a release is older than another one."""
    return RELEASES.index(release) < RELEASES.index(other)


def is_between(release: Release, first: Release, last: Release) -> bool:
    """Return whether a release is one of those from one to another."""
    return RELEASES.index(first) <= RELEASES.index(release) <= RELEASES.index(last)


def releases_with(kind: NameKind, name: str) -> Sequence[Release]:
    """Return the releases that have a name, in their order; none for a name without a row."""
    having: list[Release] = []
    for release_name in _row_with(kind, name):
        if release_name.matches(name):
            having += RELEASES[release_name.first : release_name.last + 1]
    return having


def _row_with(kind: NameKind, name: str) -> Sequence[_ReleaseName]:
    """Return the first row with a name; an empty one without."""
    for row in _rows(kind):
        if any(release_name.matches(name) for release_name in row):
            return row
    return ()


@cache
def _rows(kind: NameKind) -> list[list[_ReleaseName]]:
    rows = []
    for row in tomli.loads(_FILE.read_text("utf-8"))[kind]:
        rows.append([_ReleaseName(**name) for name in row])
    return rows
