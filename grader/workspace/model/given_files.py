"""The parameter files that nodes and controllers are given, and the parameters in these."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache, cached_property, partial

from grader.base.records import Record
from grader.ros.installation.places import PREFIX, share_parts
from grader.ros.launch.launch_model import GivenParameters, StartedNode
from grader.ros.launch.node_parameters import (
    FileTables,
    NodeParameters,
    collect_parameters,
    read_tables,
)
from grader.ros.package.installed_files import are_installs_known, meant_file, open_meant
from grader.ros.package.package import Package
from grader.workspace.model.installed_yaml import InstalledFiles
from grader.workspace.model.known_robots import Robots
from grader.workspace.model.launches import MANAGER, Launches, list_spawned
from grader.workspace.model.own_code import OwnCode
from grader.workspace.model.text_files import FILES_A_PART, MAX_YAML, TextFiles
from grader.workspace.model.workspace_folder import WorkspaceFolder

_OpenedFile = tuple[bytes, str]  # with its path

_BYTES_A_PART = 64  # of a file that a node is given, which are charged as one part


class GivenFiles(Record):
    """The parameter files that nodes and controllers are given, and the parameters in these."""

    folder: WorkspaceFolder
    texts: TextFiles
    launches: Launches
    installed: InstalledFiles
    robots: Robots
    code: OwnCode

    @cached_property
    def files(self) -> Mapping[str, list[StartedNode]]:
        """The parameter files with the nodes that are given them.

        The keys are the paths of the files in the workspace.
        """
        nodes: dict[str, list[StartedNode]] = {}
        for node in self.launches.nodes:
            for path in self.files_given(node):
                nodes.setdefault(path, []).append(node)
        return nodes

    def files_given(self, node: StartedNode) -> Iterator[str]:
        """Yield the parameter files that a node is given, by their paths in the workspace."""
        for given in node.parameters or ():
            if given.path and given.is_plain:
                path = self.installed.find_source(given.path)
                path = path or _meant_source(self.folder, given.path)
                if path:
                    yield path

    @cached_property
    def owners(self) -> Mapping[str, list[NodeParameters]]:
        """The parameters that nodes and controllers are given.

        The keys are the names of the nodes without namespaces.
        """
        owners: dict[str, list[NodeParameters]] = {}
        for package, launch in self.launches.roots:
            # What a controller manager and Gazebo are given, its controllers get too.
            shared: list[GivenParameters] = []
            for node in launch.nodes:
                if self.code.find_name(node) == MANAGER:
                    shared += node.parameters or ()
            shared += self.robots.given_in_gazebo
            for node in launch.nodes:
                for name, given in _given_by(self, package, node, shared):
                    owners.setdefault(name, []).append(given)
        return owners

    @cached_property
    def controller_files(self) -> frozenset[str]:
        """The parameter files that Gazebo and spawners give controllers.

        The keys are the paths of the files in the workspace.
        """
        given = list(self.robots.given_in_gazebo)
        for node in self.launches.nodes:
            for controller in list_spawned(node):
                given += controller.parameters or ()
        paths = {self.installed.find_source(each.path) for each in given if each.path}
        return frozenset(path for path in paths if path is not None)

    def given_to(self, package: Package, node: StartedNode) -> NodeParameters:
        """Return the parameters that a node gets, whose launch file is in a package."""
        return self.read(package, node, self.code.find_name(node) or "")

    def read(self, package: Package, node: StartedNode, name: str) -> NodeParameters:
        """Return the parameters that a node gets that is called so in its program.

        Raises NotDecided.
        """
        return collect_parameters(node, partial(self.open, package), name, self._read_tables)

    def read_given(self, package: Package, node: StartedNode, name: str) -> NodeParameters:
        """Return the same, where a file that surely is nowhere gives nothing. Raises NotDecided.

        Where misspelt names count as what is meant, so do those of files and of ros__parameters.
        """
        read = partial(self._read_tables, are_keys_meant=self.folder.reads_meant)
        return collect_parameters(node, partial(self.open_given, package), name, read)

    def given_in_code(
        self, package: Package, node: StartedNode, name: str | None = None
    ) -> NodeParameters:
        """Return the same for a node to which its code gives a name. Raises NotDecided."""
        return self.read_given(package, node, self.code.find_name(node) or name or "")

    @cached_property
    def _read_tables(self) -> Callable[..., FileTables]:
        """A reader of parameter files that reads each once."""
        return cache(read_tables)

    def open(self, package: Package, path: str) -> _OpenedFile | None:
        """Return a parameter file, as `open_meant` does. Raises NotDecided."""
        return self._charged(self._search(package, path, False))

    def open_given(self, package: Package, path: str) -> _OpenedFile | None:
        """Return a parameter file that a launch file of a package gives, as `open_meant` does.

        There is nothing in one that surely is nowhere. Raises NotDecided.
        """
        return self._charged(self._search(package, path, True))

    def _charged(self, file: _OpenedFile | None) -> _OpenedFile | None:
        """Return a file, and charge that a node is given it."""
        size = len(file[0]) if file is not None else 0
        self.folder.charge(1 + size // _BYTES_A_PART)
        return file

    @cached_property
    def _search(self) -> Callable[[Package, str, bool], _OpenedFile | None]:
        """A search for parameter files that searches each once."""
        return cache(self._find)

    def _find(self, package: Package, path: str, is_given: bool) -> _OpenedFile | None:
        """Return a parameter file; one that a launch file gives may be nowhere."""
        self.folder.charge(len(self.folder.tree.files) // FILES_A_PART)
        if not is_given:
            return open_meant(package, path)
        opened = open_meant(package, path, absent_are_empty=True)
        owner = package.find(share_parts(f"{PREFIX}/{path}")[0])
        is_empty = opened is None or not opened[0]
        if self.folder.reads_meant and owner and is_empty:
            meant = meant_file(owner, path)
            if meant:
                return owner.tree.read(meant, MAX_YAML) or b"", owner.path(meant)
        if opened is None and owner and are_installs_known(owner):
            return (b"", path) if self.texts.is_nowhere(owner, path) else None
        return opened


def _meant_source(folder: WorkspaceFolder, path: str) -> str:
    """Return the file that a path means which leads to none; empty if that is not known."""
    name, inside = share_parts(path)
    owner = folder.packages[0].find(name) if folder.packages else None
    if not owner or not folder.reads_meant:
        return ""
    meant = meant_file(owner, f"share/{name}/{inside}")
    return owner.path(meant) if meant else ""


def _given_by(
    files: GivenFiles, package: Package, node: StartedNode, shared: Sequence[GivenParameters]
) -> Iterator[tuple[str, NodeParameters]]:
    """Yield the parameters of a node, and of the controllers that it spawns, by names."""
    name = files.code.find_name(node)
    if name == MANAGER or (name is not None and node.package != MANAGER):
        yield name, files.read_given(package, node, name)
    own_nodes = files.code.find_nodes(node) if name is None and node.node_name == "" else ()
    for facts in own_nodes:  # several in one program
        if facts.name:
            yield facts.name, files.read_given(package, node, facts.name)
    for controller in list_spawned(node):
        given = (*shared, *(controller.parameters or ()))
        started = controller._replace(parameters=given)
        yield controller.node_name or "", files.read_given(package, started, "")
