"""The files that builds install, by their paths below the prefix, and the YAML files."""

import posixpath
from collections.abc import Callable, Collection, Iterator, Mapping
from functools import cache, cached_property

from grader.base.grouping import Strings, StringsByName
from grader.base.names import last_part
from grader.base.records import Record
from grader.base.source import Location
from grader.ros.config.yaml_nodes import YamlFault, YamlNode, read_yaml
from grader.ros.config.yaml_values import sections_in, values_in
from grader.ros.installation.places import PREFIX
from grader.ros.launch.launch_model import ParameterValue, StartedNode
from grader.ros.launch.node_parameters import value_in_file
from grader.workspace.model.launches import Launches
from grader.workspace.model.text_files import MAX_YAML, read_paths
from grader.workspace.model.workspace_folder import WorkspaceFolder


class InstalledFiles(Record):
    """The files that builds install, by their paths below the prefix, and the YAML files."""

    folder: WorkspaceFolder
    launches: Launches

    @cached_property
    def yaml(self) -> Mapping[str, YamlNode | YamlFault]:
        """The YAML files that are no launch files, or why one is not read.

        The keys are the paths of the files in the workspace.
        """
        files = {}
        for package in self.folder.packages:
            paths = [path for path in package.tree.files if path.endswith((".yaml", ".yml"))]
            launched = {path for owner, path, _ in self.launches.files if owner is package}
            for path in read_paths(package, (file for file in paths if file not in launched)):
                whole_path = package.path(path)
                data = package.tree.read(path, MAX_YAML)
                if data is not None:
                    files[whole_path] = self.folder.recall(_read_yaml, data, whole_path)
        return files

    @property
    def trees(self) -> Iterator[YamlNode]:
        """The YAML files that are read."""
        self.folder.charge(1 + len(self.yaml))
        for node in self.yaml.values():
            if isinstance(node, YamlNode):
                yield node

    @property
    def sections(self) -> Iterator[tuple[Strings, YamlNode]]:
        """The parameters of each node in these files, with the keys of the node."""
        for tree in self.trees:
            yield from sections_in(tree)

    def find_source(self, path: str) -> str | None:
        """Return the file of the workspace that is installed at a path.

        The path begins with the stand-in of the prefix.
        """
        inside = posixpath.normpath(path).removeprefix(f"{PREFIX}/")
        return self._sources_of_installed.get(inside)

    def has_file(self, path: str) -> bool:
        """Return whether a build of the workspace installs a file at a path below the prefix."""
        return path in self._sources_of_installed

    def tree_at(self, path: str) -> YamlNode | None:
        """Return the YAML file that is installed at a path.

        The path begins with the stand-in of the prefix.
        """
        return self.find_tree(self.find_source(path) or "")

    def find_tree(self, path: str) -> YamlNode | None:
        """Return the YAML file at a path in the workspace; None where it is not read."""
        tree = self.yaml.get(path)
        return tree if isinstance(tree, YamlNode) else None

    @cached_property
    def _sources_of_installed(self) -> StringsByName:
        """The files of the workspace, by the paths below the prefix where they are installed."""
        sources: dict[str, str] = {}
        for package in self.folder.packages:
            for target, source in package.installed.items():
                sources.setdefault(target, package.path(source))
        return sources

    @cached_property
    def typed_sections(self) -> frozenset[str]:
        """The names of controllers and others that parameter files give a type."""
        names = set()
        for keys, section in self.sections:
            if keys and section.get("type"):
                names.add(last_part(keys[-1]))
            for name, inner in section.table.items():
                if inner.get("type"):
                    names.add(name)
        return frozenset(names)

    @cached_property
    def controllers(self) -> frozenset[str]:
        """The names of sections in parameter files that may be those of controllers."""
        return frozenset(keys[-1] for keys, _ in self.sections if keys)

    def written_values(self, parameter: str) -> Iterator[ParameterValue]:
        """Yield the values that files have for a parameter, of whatever node."""
        for _, section in self.sections:
            node = section.get(*parameter.split("."))
            if node:
                yield value_in_file(node)

    @cached_property
    def passed_files(self) -> Collection[str]:
        """The parameter files that launch files pass to others, which they include."""
        files = set()
        for launch in self.launches.every:
            for passed in launch.passed:
                files |= {self.find_source(value or "") for _, value in passed.values}
        return {path for path in files if path is not None}

    def wildcard_places(self, node: StartedNode) -> frozenset[Location]:
        """Return the places of parameters that a file gives to every node."""
        places: set[Location] = set()
        for given in node.parameters or ():
            tree = self.tree_at(given.path) if given.path else None
            if tree:
                places |= self._wildcard_places_in(tree)
        self.folder.charge(len(places))
        return frozenset(places)

    @cached_property
    def _wildcard_places_in(self) -> Callable[[YamlNode], frozenset[Location]]:
        """The places in a file of the parameters that it gives to every node, found once."""
        return cache(_wildcard_places_in)


def _read_yaml(data: bytes, path: str) -> YamlNode | YamlFault:
    try:
        return read_yaml(data, path)
    except YamlFault as fault:
        return fault


def _wildcard_places_in(tree: YamlNode) -> frozenset[Location]:
    places = set()
    for keys, section in sections_in(tree):
        if not keys or any(key.strip("/") in ("*", "**") for key in keys):
            places |= {value.node.location for value in values_in(section)}
    return frozenset(places)
