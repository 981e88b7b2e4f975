"""The parameters of well-known nodes, controllers and plugins, by release.

They are rows of the files of their packages.

docs/known-parameters.md describes the form of a row.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from typing import Any

from grader.base.grouping import Strings, as_list, only_one
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.ros.known.package_files import packages_with_files, tables_in_file
from grader.ros.known.package_rows import usual_names
from grader.ros.known.releases import RELEASES, Release, Releases, is_before, is_between
from grader.ros.known.typed_rows import read_row

# From Humble on, without Rolling, which changes.
COVERED: Releases = RELEASES[RELEASES.index("humble") : -1]
# The last release in which a table was read that does not say it.
_READ: Release = "kilted"
_PLACE = on_use(r"<([^<>]+)>")
_SEPARATOR = on_use("/|::")
_NUMBER, _REST = "#", "**"
_FIELDS = {  # by the keys of the files, where they have another name
    "required": "is_required",
    "with": "only_with",
    "min": "lower",
    "max": "upper",
    "subset_of": "entries",
    "class": "is_class",
}


class ParameterRow(Named):
    """A parameter of a node, in some releases.

    Parts of a name in angle brackets stand for others: `<joints>` for an entry of the list
    `joints`, `<#>` for a number, `<**>` for any rest, and any other word for any name.
    """

    name: str
    type: str = ""  # as generate_parameter_library calls it; empty for any
    default: Any = None  # None where there is none, or it is computed
    is_required: bool = False
    only_with: str = ""  # the parameter without which nothing reads this one
    unless: Mapping[str, Any] = {}  # the values of others without which it has no effect
    above: float | None = None
    below: float | None = None
    lower: float | None = None
    upper: float | None = None
    one_of: tuple[Any, ...] = ()
    entries: Strings = ()  # what a list may have
    size: int | None = None  # of a list
    libraries: Strings = ()  # of plugins that the package has in these releases
    loads_libraries: bool = False  # whether the node loads them itself, and stops at a second time
    since: Release = COVERED[0]
    until: Release = COVERED[-1]
    is_class: bool = False  # whether the value is a class, whose rows are beside this one

    def is_in(self, release: Release) -> bool:
        """Return whether a release has it."""
        return is_between(release, self.since, self.until)

    @property
    def pattern(self) -> re.Pattern[str]:
        """The names that it stands for; its groups are the parts in angle brackets."""
        return _make_pattern(self.name)

    @property
    def places(self) -> Sequence[str]:
        """The parts in angle brackets."""
        return _PLACE.findall(self.name)

    @property
    def releases(self) -> str:
        """The releases that have it, in words; empty for all."""
        if self.since == COVERED[0] and self.until == COVERED[-1]:
            return ""
        if self.since == COVERED[0]:
            return f"until {self.until.title()}"
        if self.since == self.until:
            return f"only {self.since.title()}"
        if self.until == COVERED[-1]:
            return f"since {self.since.title()}"
        return f"{self.since.title()} to {self.until.title()}"


class NodeRows(Named):
    """What a node, a controller or a plugin reads: its parameters, with where that is written."""

    node: str
    source: str
    rows: tuple[ParameterRow, ...]
    open_in: Releases = ()  # the releases in which it reads more than the rows say
    takes_any_type: bool = False
    since: Release = COVERED[0]
    until: Release = COVERED[-1]
    read: Release = _READ  # the last release in which it was read; later ones are not known

    @property
    def own_rows(self) -> tuple[ParameterRow, ...]:
        """The rows that no other node has before it."""
        table = _find_table(self.node)
        parameters = table.parameters if table else {}
        return tuple(row for row in self.rows if row.name in parameters)

    def is_in(self, release: Release) -> bool:
        """Return whether a release has the node."""
        return is_between(release, self.since, self.until)

    def is_known_in(self, release: Release) -> bool:
        """Return whether it is known what it reads in a release."""
        return release in COVERED and not is_before(self.read, release)

    def in_release(self, release: Release) -> tuple[ParameterRow, ...]:
        """Return the rows of a release."""
        return tuple(row for row in self.rows if row.is_in(release))


class NodeTable(Named):
    """The table of a node in the file of its package."""

    source: str = ""
    also: Strings = ()  # the nodes whose rows it has too
    open: Any = False  # whether it reads more than its rows, or the releases in which it does
    any_type: bool = False
    since: Release = COVERED[0]
    until: Release = COVERED[-1]
    read: Release = _READ
    parameters: Mapping[str, Any] = {}


def find_rows(node: str, release: Release | None = None) -> tuple[ParameterRow, ...]:
    """Return the parameters of a node in a release, or in any; none for a node that is not known.

    Args:
        node: `package/program`, the type of a controller or the class of a plugin.
        release: The release; None for the rows of all.
    """
    known = node_rows(node)
    if not known:
        return ()
    return known.rows if release is None else known.in_release(release)


def row_for(node: str, parameter: str, release: Release | None = None) -> ParameterRow | None:
    """Return the row of a parameter of a node in a release, or of the newest one that has it.

    The result is None without one.
    """
    rows = find_rows(node, release)
    for row in rows[::-1]:
        if row.pattern.fullmatch(parameter):
            return row
    return None


def known_nodes() -> Strings:
    """Return all nodes, controllers and plugins that have rows."""
    nodes: list[str] = []
    for package in sorted(packages_with_files()):
        nodes += (name for name in tables_in_file(package) if is_name_of_node(name))
    return tuple(nodes)


def is_name_of_node(table: str) -> bool:
    """Return whether a table of a package's file has the parameters of a node."""
    return _SEPARATOR.search(table) is not None


def node_called(name: str) -> str | None:
    """Return the node that a name means.

    The name is its own, the one that it usually has when it runs, such as `amcl`, the package of
    one node only, or the end of its own, such as `DiffDriveController`.
    """
    if name in usual_names():
        return usual_names()[name]
    if node_rows(name):
        return name
    ends = [node for node in known_nodes() if name in (_SEPARATOR.split(node)[0], node)]
    ends = ends or [node for node in known_nodes() if _SEPARATOR.split(node)[-1] == name]
    return only_one(ends)


@cache
def node_rows(node: str) -> NodeRows | None:
    """Return the rows of a node, with those of what it is made of; None for one without rows."""
    table = _find_table(node)
    if not table:
        return None
    rows = list(read_rows(table.parameters))
    open_in = table.open
    if isinstance(open_in, bool):
        open_in = list(COVERED) if open_in else []
    for other in table.also:
        known = node_rows(other)
        assert known, other
        written = {row.name for row in rows}
        rows += (row for row in known.rows if row.name not in written)
    return NodeRows(
        node,
        table.source,
        tuple(rows),
        tuple(open_in),
        table.any_type,
        table.since,
        table.until,
        table.read,
    )


def _find_table(node: str) -> NodeTable | None:
    table = tables_in_file(_SEPARATOR.split(node)[0]).get(node)
    return read_row(NodeTable, table) if table is not None else None


def read_rows(parameters: Mapping[str, Any]) -> Iterator[ParameterRow]:
    """Yield the rows of the parameters of a node. Raises ValueError for an unknown key."""
    for name, written in parameters.items():
        for keys in as_list(written):
            fields = {_FIELDS.get(key, key): value for key, value in keys.items()}
            yield read_row(ParameterRow, {"name": name, **fields})


@cache
def _make_pattern(name: str) -> re.Pattern[str]:
    parts = []
    for number, part in enumerate(_PLACE.split(name)):
        if number % 2 == 0:
            parts.append(re.escape(part))
        elif part == _NUMBER:
            parts.append(r"(\d+)")
        elif part == _REST:
            parts.append("(.+)")
        else:
            parts.append("([^.]+)")
    return re.compile("".join(parts))
