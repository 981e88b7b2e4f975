"""What the workspace's packages open, declare and define in their code and interfaces."""

from collections.abc import Callable, Mapping, Sequence
from functools import cache, cached_property, partial

from grader.base.records import Record
from grader.base.reuse import Answers
from grader.ros.known.end_rows import opened_ends
from grader.ros.known.package_rows import children_by_node, program_row
from grader.ros.launch.launch_model import StartedNode
from grader.ros.nodes.node_facts import NodeFacts, NodeProgram, PackageNodes
from grader.ros.nodes.python.python_nodes import read_nodes
from grader.ros.package.package import MANIFEST, Package
from grader.ros.package.package_interfaces import PackageInterfaces, read_interfaces
from grader.ros.package.program_names import surely_meant_program
from grader.workspace.model.installed_yaml import InstalledFiles
from grader.workspace.model.launches import MANAGER
from grader.workspace.model.text_files import CPP_ENDINGS, MAX_YAML
from grader.workspace.model.workspace_folder import WorkspaceFolder

# Of files without code: parameters, models, pictures and texts.
_NO_CODE = frozenset(
    {
        *(".yaml", ".yml", ".urdf", ".xacro", ".srdf", ".sdf", ".world", ".rviz", ".xml"),
        *(".stl", ".dae", ".obj", ".png", ".jpg", ".jpeg", ".gif", ".pgm", ".pdf", ".md"),
    }
)


class OwnCode(Record):
    """What the code of packages opens and declares, and the interfaces that packages define.

    The packages are those of the workspace.
    """

    folder: WorkspaceFolder
    installed: InstalledFiles

    @cached_property
    def by_package(self) -> Mapping[str, PackageNodes]:
        """The nodes of the installed Python modules and of C++, by the names of packages."""
        return {package.name: self._nodes_in(package) for package in self.folder.packages}

    @property
    def nodes(self) -> Sequence[NodeFacts]:
        """The nodes of all packages."""
        return [facts for code in self.by_package.values() for facts in code.nodes]

    def _nodes_in(self, package: Package) -> PackageNodes:
        reads_meant = self.folder.reads_meant
        read = partial(_read_nodes, package, reads_meant=reads_meant)
        if not self.folder.memory:
            return read(Answers(package))
        where = package.path(""), package.releases
        key = ("nodes", package.name, where, reads_meant, _program_texts(package))
        return self.folder.memory.recall(key, package, package.budget, read)

    @cached_property
    def interfaces(self) -> Mapping[str, PackageInterfaces]:
        """The messages, services and actions of the packages, by the names of these.

        Of a name that several packages have nothing is known.
        """
        interfaces_by_package = {}
        for package in self.folder.packages:
            is_one = self.folder.counts[package.name] < 2
            unknown = PackageInterfaces(is_complete=False)
            interfaces_by_package[package.name] = read_interfaces(package) if is_one else unknown
        return interfaces_by_package

    def own_node(self, node: StartedNode) -> NodeFacts | None:
        """Return the node of the workspace that a program starts.

        Where misspelt names count as what is meant, so does that of a program. The result is None
        if it starts none that is known.
        """
        owner = self.folder.find_package(node)
        if not owner or owner.name not in self.by_package:
            return None
        program = node.executable
        if self.folder.reads_meant:
            program = self._meant_program(owner, node.package, program)
        return self._nodes_by_program.get((owner.name, program))

    @cached_property
    def _meant_program(self) -> Callable[[Package, str, str], str]:
        """What the program of a package is called that a name means; each is searched once."""
        return cache(_meant_program)

    @cached_property
    def _nodes_by_program(self) -> Mapping[tuple[str, str], NodeFacts]:
        """The nodes by their packages and programs, of programs with one node.

        A component has its class in place of a program.
        """
        programs: dict[tuple[str, str], list[Sequence[NodeFacts]]] = {}
        for package, code in self.by_package.items():
            for program in code.programs:
                programs.setdefault((package, program.name), []).append(program.nodes)
        nodes = {}
        for key, of_programs in programs.items():
            if len(of_programs) == 1 and len(of_programs[0]) == 1:
                nodes[key] = of_programs[0][0]
        for package, code in self.by_package.items():
            for facts in code.nodes:
                if facts.location.path.endswith(CPP_ENDINGS):
                    nodes.setdefault((package, facts.class_name), facts)
        return nodes

    def find_nodes(self, node: StartedNode) -> Sequence[NodeFacts]:
        """Return the nodes that a program or a component is known to have, as far as one is read.

        The result is empty for what is not read.
        """
        facts = self.own_node(node)
        if facts:
            return [facts]
        named = self._find_programs(node)
        return named[0].nodes if len(named) == 1 else ()

    def find_all_nodes(self, node: StartedNode) -> Sequence[NodeFacts]:
        """Return the same, but none of several nodes of a program that may have more."""
        nodes = self.find_nodes(node)
        return () if len(nodes) > 1 and self.has_other_nodes(node) else nodes

    def has_other_nodes(self, node: StartedNode) -> bool:
        """Return whether the program of a node may have others, which are not known.

        Each node of a process reads its own section of the parameter files of that.
        """
        return any(program.may_have_more for program in self._find_programs(node))

    def _find_programs(self, node: StartedNode) -> Sequence[NodeProgram]:
        """Return the programs of the workspace with the name that a node is started by."""
        owner = self.folder.find_package(node)
        code = self.by_package.get(owner.name) if owner else None
        programs = code.programs if code else ()
        return [program for program in programs if program.name == node.executable]

    def is_read(self, node: StartedNode) -> bool:
        """Return whether all is known that the code of a node opens."""
        facts = self.own_node(node)
        return facts is not None and not facts.doubts

    def find_name(self, node: StartedNode) -> str | None:
        """Return the name that a node has, without its namespace; None where it is not known."""
        if node.node_name is None or node.node_name:
            return node.node_name
        return self.name_in_program(node)

    def name_in_program(self, node: StartedNode) -> str | None:
        """Return the name that the program of a node gives it; None where it is not known."""
        facts = self.own_node(node)
        if facts:
            return facts.name
        name = program_row(*node.program).name
        row = opened_ends(*node.program)
        return name or (row.name if row else "") or None

    def find_children(self, name: str) -> frozenset[str]:
        """Return the nodes that a node of another package makes in its process.

        They read its parameters.
        """
        children = frozenset(children_by_node().get(name, ()))
        return children | self.installed.typed_sections if name == MANAGER else children


def _meant_program(owner: Package, package: str, name: str) -> str:
    if owner.has_program(package, name) is not False:
        return name
    return surely_meant_program(owner, name) or name


def _program_texts(package: Package) -> tuple[tuple[str, bytes | None], ...]:
    """Return the files of a package, each with its bytes.

    It has None in place of the bytes if its ending says that it has no code, and for a launch file
    in a folder without modules.
    """
    texts = []
    launch_files = frozenset(package.launch_files)
    for path, file in package.tree.files.items():
        is_launch_file = path in launch_files and _is_beside_no_module(package, path)
        has_code = path == MANIFEST or (file.suffix not in _NO_CODE and not is_launch_file)
        texts.append((path, package.tree.read(path, MAX_YAML) if has_code else None))
    return tuple(texts)


def _is_beside_no_module(package: Package, path: str) -> bool:
    """Return whether a file is in a folder that is no package of Python."""
    folder, _, _ = path.rpartition("/")
    return bool(folder) and f"{folder}/__init__.py" not in package.tree.files


def _read_nodes(package: Package, answers: Answers[Package], *, reads_meant: bool) -> PackageNodes:
    nodes = read_nodes(package, answers, reads_meant=reads_meant)
    setup = package.installation
    if not setup or not any(target.sources for target in setup.targets):
        return nodes
    from grader.ros.nodes.cpp.cpp_nodes import read_cpp_nodes  # late: few workspaces have C++

    compiled = read_cpp_nodes(package)
    return nodes._replace(
        nodes=nodes.nodes + compiled.nodes,
        programs=nodes.programs + compiled.programs,
        doubts=nodes.doubts + compiled.doubts,
        has_loose_declarations=nodes.has_loose_declarations or compiled.has_loose_declarations,
        imports=nodes.imports + compiled.imports,
        field_uses=nodes.field_uses + compiled.field_uses,
        faults=nodes.faults + compiled.faults,
        synchronised=nodes.synchronised + compiled.synchronised,
        loose_frames=compiled.loose_frames,
        texts=compiled.texts,
        cpp_files=compiled.cpp_files,
    )
