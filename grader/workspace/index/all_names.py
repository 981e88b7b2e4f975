"""All names of a workspace where they are written, for editors.

They are what defines a name, and what else uses it.

The facts that are compared say what is wrong. Here are more uses than those: what the reader of
robots, xacro or a launch file itself reports makes no finding of a workspace. Nothing of this is
computed unless it is asked for.
"""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from contextlib import suppress
from functools import lru_cache

from grader.base.errors import NotDecided
from grader.base.source import Source, SourceOf
from grader.ros.known.shared_names import shared_names
from grader.workspace.index.names_in_files import names_in_launch_files, names_in_yaml
from grader.workspace.index.names_in_graph import ComputedName, GraphNames
from grader.workspace.index.names_in_packages import PackageNames
from grader.workspace.index.names_in_robots import names_in_robots
from grader.workspace.index.names_in_texts import names_in_texts
from grader.workspace.index.names_in_xacro import names_in_xacro
from grader.workspace.index.written_names import (
    Role,
    WrittenName,
    WrittenNames,
    find_written,
    make_reader,
)
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import Definition, Fact, Use
from grader.workspace.rules.reading import facts_once

_MAX_TEXT = 4 * 1024 * 1024  # bytes of a file
# Kinds that mean the same things: each link is a frame.
_ALIKE = {"frame": "link"}
# Kinds whose names belong to a robot, or to what is started with it, though a file does not say so.
_OF_ROBOTS = frozenset({"link", "joint", "xacro argument"})


class WorkspaceNames:
    """The names that the files of a workspace define and use, of all of its robots.

    `NamePlaces` makes it; editors ask it what is at a place, and where else that name is.
    """

    def __init__(self, names: Iterable[WrittenName], computed: Iterable[ComputedName] = ()) -> None:
        self.computed = tuple(dict.fromkeys(computed))
        self.names = tuple(sorted(dict.fromkeys(names), key=_order))
        self._by_path: dict[str, list[WrittenName]] = {}
        self._alike: dict[tuple[str, str], list[WrittenName]] = {}
        for written in self.names:
            self._by_path.setdefault(written.location.path, []).append(written)
            self._alike.setdefault(_key(written), []).append(written)

    def at(self, path: str, line: int, column: int) -> tuple[WrittenName, ...]:
        """Return the names at a place of a file, the shortest first.

        A made name may hold others, and a macro gives one place several names.
        """
        names = [
            written for written in self._by_path.get(path, ()) if written.covers(path, line, column)
        ]
        return tuple(sorted(names, key=_length))

    def same_as(self, one: WrittenName) -> tuple[WrittenName, ...]:
        """Return all places of a name.

        They are those of its owner, and those that share a place with them, as robots do that
        include one file.
        """
        alike = self._alike.get(_key(one), [])
        owners = {one.owner}
        count = 0
        while count < len(owners):
            count = len(owners)
            places = {other.location for other in alike if other.owner in owners}
            owners |= {other.owner for other in alike if other.location in places}
        return tuple(other for other in alike if other.owner in owners)


@lru_cache(maxsize=3)
def read_names(workspace: Workspace) -> WorkspaceNames:
    """Return the names that the files of a workspace define and use."""
    source_of = make_reader(lambda path: workspace.tree.read(path, _MAX_TEXT))
    names = list(names_in_robots(workspace.urdfs))
    names += names_in_xacro(workspace.urdfs, workspace.robots.xacro_sources)
    names += names_in_launch_files(workspace)
    names += names_in_texts(workspace, source_of)
    ends = GraphNames(workspace, source_of)
    computed = []
    with suppress(NotDecided):
        names += PackageNames(workspace, source_of).names()
    with suppress(NotDecided):
        names += ends.nodes()
        names += ends.parameters()
        for end in (*ends.frames(), *ends.names()):
            if isinstance(end, ComputedName):
                computed.append(end)
            else:
                names.append(end)
    nodes = {name.name for name in names if name.kind == "node"}
    names += names_in_yaml(workspace, nodes)
    written = {(_key(known_name), known_name.role, known_name.location) for known_name in names}
    for addition in _names_of_facts(source_of, facts_once(workspace)[0]):
        if (_key(addition), addition.role, addition.location) not in written:
            names.append(addition)
    return WorkspaceNames(_owned(workspace, names), computed)


def _key(name: WrittenName) -> tuple[str, str]:
    """Return the kind and the name by which names are the same."""
    return _ALIKE.get(name.kind, name.kind), name.name


def _length(name: WrittenName) -> tuple[int, int]:
    at = name.location
    return at.end_line - at.line, at.end_column - at.column


def _order(name: WrittenName) -> tuple[str, int, int, str, str, str]:
    at = name.location
    return at.path, at.line, at.column, name.kind, name.name, name.owner


def _names_of_facts(source_of: SourceOf, facts: Iterable[Fact]) -> WrittenNames:
    """Yield the names of facts at what is written of them.

    There are none for what no file of the workspace has.
    """
    for fact in facts:
        if not isinstance(fact, Definition | Use) or _is_of_no_place(fact):
            continue
        source = source_of(fact.location.path)
        role: Role = "definition" if isinstance(fact, Definition) else "use"
        if source and not _is_of_every_robot(fact, source):
            yield from find_written(source, fact.location, fact.kind, fact.name, role, fact.owner)


def _is_of_no_place(fact: Definition | Use) -> bool:
    """Return whether a fact is a definition that no place has, or that is read otherwise.

    An argument that is passed is declared to the comparison of names; topics are in the graph.
    """
    if fact.kind == "topic":
        return True
    is_argument = fact.kind in ("launch argument", "xacro argument")
    return isinstance(fact, Definition) and is_argument


def _is_of_every_robot(fact: Definition | Use, source: Source) -> bool:
    """Return whether a fact is a frame that every robot may have, said of its first link."""
    if fact.kind != "frame" or fact.name not in shared_names().frames:
        return False
    start = source.start_offset(fact.location)
    return source.text.startswith("<link", start)


def _owned(workspace: Workspace, names: Sequence[WrittenName]) -> WrittenNames:
    """Yield names, those that no robot has with the robots that are meant.

    These are the robots of their package, else all that define them.
    """
    owners: dict[tuple[str, str], dict[str, None]] = defaultdict(dict)
    for name in names:
        if name.role == "definition" and name.owner:
            owners[_key(name)][name.owner] = None
    for name in names:
        known_owners = list(owners.get(_key(name), ()))
        if name.owner or _key(name)[0] not in _OF_ROBOTS or not known_owners:
            yield name
            continue
        for owner in _owners_beside(workspace, name, known_owners) or known_owners:
            yield name._replace(owner=owner)


def _owners_beside(workspace: Workspace, name: WrittenName, owners: Sequence[str]) -> list[str]:
    """Return those robots that are in the package of a name."""
    for package in workspace.packages:
        if package.holds(name.location.path):
            return [owner for owner in owners if package.holds(owner)]
    return []
