"""What an editor asks of the names of a workspace."""

from collections import Counter
from collections.abc import Collection
from functools import cached_property

from grader.base.grouping import Strings
from grader.base.names import first_part
from grader.base.source import Location
from grader.workspace.index.all_names import WorkspaceNames, read_names
from grader.workspace.index.name_texts import list_texts
from grader.workspace.index.names_in_graph import ComputedName
from grader.workspace.index.offered_builds import find_macros
from grader.workspace.index.renamed_graph import (
    PARAMETER,
    computed_like,
    graph_under,
    open_ends,
    renamed_owner,
)
from grader.workspace.index.started_names import StartedName, started_in
from grader.workspace.index.words_left import files_for_parameters, words_left
from grader.workspace.index.written_names import WrittenName
from grader.workspace.opening.opened import OpenedWorkspace

# The kinds of names for which files are searched whose words no reader knows.
_GIVEN = ("parameter", "controller", "plugin section")  # kinds that name parameters
_IN_FILES = "plugin section"  # names that mean nothing in other files
_SEARCHED = (
    "parameter",
    "link",
    "frame",
    "joint",
    "controller",
    "node",
    "topic",
    "service",
    "action",
    _IN_FILES,
)

# Kinds that are listed where they are written, and not where a word for them is.
_WRITTEN = ("function", "program", "plugin", "file")


def _is_listed(name: WrittenName) -> bool:
    """Return whether a name is one that its file has for others."""
    if name.role != "definition" or (name.is_made and name.kind in _WRITTEN):
        return False
    at = name.location
    return (at.line, at.column) != (at.end_line, at.end_column)


class NamePlaces:
    """The names that the files of a workspace define and use."""

    def __init__(self, opened: OpenedWorkspace) -> None:
        self._opened = opened

    @cached_property
    def _names(self) -> WorkspaceNames:
        return read_names(self._opened.workspace)

    def at(self, path: str, line: int, column: int) -> WrittenName | None:
        """Return the name at a place of a file, the shortest of several; None where there is none.

        Line and column count from 1, columns in characters.
        """
        return next(iter(self._names.at(path, line, column)), None)

    def same(self, name: WrittenName) -> list[WrittenName]:
        """Return each place of a name, the definitions first."""
        return sorted(self._names.same_as(name), key=lambda place: place.role)

    def named_like(self, places: Collection[WrittenName], new: str) -> list[WrittenName]:
        """Return the places of another name of the kinds and owners that some places have.

        What owns a topic is its full name, which changes with it.
        """
        meant = {(place.kind, renamed_owner(place, new)) for place in places}
        return [
            place
            for place in self._names.names
            if place.name == new and (place.kind, place.owner) in meant
        ]

    def computed_like(self, places: Collection[WrittenName]) -> list[ComputedName]:
        """Return the names that no file writes and that may be the one of some places."""
        computed = list(computed_like(self._names.computed, places))
        return computed or list(open_ends(self._opened.workspace, places))

    def graph_under(self, kind: str, places: Collection[WrittenName], new: str) -> Counter[Strings]:
        """Return what runs after each launch, with another name in place of that of some places."""
        paths = {place.location.path for place in places}
        names = {place.name for place in places}
        named = {each.location.path for each in self._names.names if each.name in names}
        rows = graph_under(self._opened.workspace, places, new, named - paths)
        if kind not in _GIVEN:  # only parameters that differ from their defaults are rows
            for row in [row for row in rows if PARAMETER in row]:
                del rows[row]
        return rows

    def _searched(self, name: WrittenName, places: Collection[WrittenName]) -> Collection[str]:
        """Return the files in which a name may be written elsewhere than at its places."""
        if name.kind == _IN_FILES:
            return {place.location.path for place in places}
        if name.kind == "parameter":
            owners = {first_part(place.owner) for place in places}
            return list(files_for_parameters(self._opened.workspace, owners))
        return self._opened.whole_tree.files

    def words_left(self, places: Collection[WrittenName]) -> list[Location]:
        """Return where files have the name of some places, and no reader says what it is there."""
        name = next(iter(places))
        if name.kind not in _SEARCHED:
            return []
        named = [written for written in self._names.names if written.name == name.name]
        left = []
        for at in words_left(self._searched(name, places), self._opened.source, name):
            if not any(written.covers(*at[:3]) for written in named):
                left.append(at)
        return left

    def files_named_in(self, path: str) -> list[WrittenName]:
        """Return where a file names files of packages, each place once; their names are paths."""
        by_place = {
            written.location: written
            for written in self._names.names
            if written.location.path == path and written.kind == "file" and written.role == "use"
        }
        return list(by_place.values())

    def started_in(self, path: str) -> list[StartedName]:
        """Return the nodes and components that a launch file itself starts."""
        return list(started_in(self._opened.workspace, path))

    def list_texts(self, name: WrittenName) -> list[str]:
        """Return what else is known of a name, a fact each."""
        return list(list_texts(self._opened.workspace, name))

    @cached_property
    def _listed(self) -> list[WrittenName]:
        """The definitions that files have for others, each place once, in their order."""
        by_place: dict[object, WrittenName] = {}
        for definition in self._names.names:
            if _is_listed(definition):
                place = (definition.location, definition.kind, definition.name)
                by_place.setdefault(place, definition)
        return list(by_place.values())

    def defined_in(self, path: str) -> list[WrittenName]:
        """Return the names that a file defines, each place once, in its order."""
        return [definition for definition in self._listed if definition.location.path == path]

    def holding(self, text: str, most: int) -> list[WrittenName]:
        """Return the first definitions whose names hold a text, in whatever case."""
        holding = [each for each in self._listed if text.lower() in each.name.lower()]
        return holding[:most]

    def parameters_of_macro(self, name: str) -> list[tuple[str, list[str]]]:
        """Return the file of each macro of a name, and its parameters as they are written."""
        macros = find_macros(self._opened.workspace)
        return [(path, parameters) for path, macro, parameters in macros if macro == name]

    def values(self, name: WrittenName) -> list[str]:
        """Return the values that an argument has, as far as they are known, each once."""
        known_values: list[str] = []
        if name.kind == "launch argument":
            for launch in self._opened.workspace.launches.every:
                known_values += (
                    value for declared, value in launch.values if declared == name.name
                )
        if name.kind == "xacro argument":
            for robot in self._opened.workspace.urdfs:
                arguments = getattr(robot.reading.source, "declared_arguments", ())
                known_values += (
                    argument.value
                    for argument in arguments
                    if argument.name == name.name and argument.value
                )
        return list(dict.fromkeys(known_values))
