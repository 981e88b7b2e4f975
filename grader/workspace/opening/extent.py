"""What of a workspace was read, and what was not: without it, silence would be praise."""

from grader.base.records import Named
from grader.base.text import counted, enumerated, printable
from grader.ros.known.releases import StatedReleases
from grader.ros.package.finding import is_backup
from grader.ros.package.package import Package
from grader.workspace.model.read_calls import ReadCalls, read_calls
from grader.workspace.model.workspace import Workspace

_MAX_FILES = 3  # that are named
_CPP = (".cpp", ".cc", ".cxx")


class Extent(Named):
    """How many things of a workspace were read, and how many were not."""

    packages: int
    robots: int
    launch_files: int
    nodes: int  # of which the source was read
    all_nodes: int
    unread_packages: int  # of another workspace in the folder, with the name of one that is read
    unread_robots: int
    cpp_files: int
    computed_names: int  # of topics, services and actions
    expressions: int  # of launch files, setup.py and CMakeLists.txt that are not evaluated
    calls: ReadCalls  # of code that open topics and services, or declare parameters
    stated: StatedReleases  # of ROS 2, in one of which names should be

    @property
    def is_whole(self) -> bool:
        """Whether everything was read that may define or use names."""
        unread = (self.unread_packages, self.unread_robots, self.cpp_files, self.computed_names)
        has_names = self.robots + self.launch_files + self.calls.total > 0
        is_known = self.nodes == self.all_nodes and self.calls.known == self.calls.total
        return has_names and is_known and not any((*unread, self.expressions))

    @property
    def words(self) -> str:
        """Return what was read and what was not, in one line."""
        read = _counted_ones(
            (self.packages, "package"), (self.robots, "robot"), (self.launch_files, "launch file")
        )
        if self.nodes:
            nodes = counted(self.all_nodes, "node")
            is_all = self.nodes == self.all_nodes
            read.append(nodes if is_all else f"{self.nodes} of {nodes}")
        calls = self.calls
        if calls.total:
            is_all = calls.known == calls.total
            known = "" if is_all else f"{calls.known} of "
            read.append(f"{known}{counted(calls.total, 'call')}")
        unread = _counted_ones(
            (self.unread_robots, "robot"),
            (self.cpp_files, "C++ file"),
            (self.computed_names, "computed name"),
            (self.expressions, "expression"),
        )
        if calls.unread_files:
            files = [f"{printable(path)} ({count})" for path, count in calls.unread_files]
            unread.append(f"calls in {enumerated(files, _MAX_FILES)}")
        text = f"read: {', '.join(read) or 'nothing'}"
        if unread:
            text += f"; not read: {', '.join(unread)}"
        if self.unread_packages:
            others = counted(self.unread_packages, "package")
            text += f"; not inspected: {others} with the name of another: give one workspace"
        return f"{text}; {self.stated.words}"


def _counted_ones(*counts: tuple[int, str]) -> list[str]:
    """Return numbers with what they count, without those that are 0."""
    return [counted(number, word) for number, word in counts if number]


def make_extent(workspace: Workspace, unread_robots: int, stated: StatedReleases) -> Extent:
    """Return what of a workspace was read; `unread_robots` are not even opened."""
    nodes = workspace.code.nodes
    cpp_files = expressions = 0
    for package in workspace.packages:
        cpp_files += _unread_cpp_files(workspace, package)
        if package.installation:
            expressions += len(package.installation.unknown)
    for launch in workspace.launches.every:
        expressions += len(launch.unknown)
    computed_names = 0
    for node in nodes:
        for endpoint in node.endpoints:
            computed_names += endpoint.is_computed
    return Extent(
        packages=len(workspace.packages),
        robots=len(workspace.urdfs),
        launch_files=len(workspace.launches.files),
        nodes=len(nodes),
        all_nodes=len(nodes) + len(_unread_programs(workspace)),
        unread_packages=_count_copies(workspace),
        unread_robots=unread_robots,
        cpp_files=cpp_files,
        computed_names=computed_names,
        expressions=expressions,
        calls=read_calls(workspace),
        stated=stated,
    )


def _count_copies(workspace: Workspace) -> int:
    """Return how many packages have the name of one that is read, each in a workspace of its own.

    Backups, and copies in one workspace, of which a problem says that colcon refuses them, do not
    count.
    """
    used = {package.folder for package in workspace.packages}
    count = 0
    for package in workspace.folder.found_packages:
        is_left_out = package.ignored_by or package.copies or is_backup(package.folder)
        count += package.folder not in used and not is_left_out
    return count


def _unread_programs(workspace: Workspace) -> set[tuple[str, str]]:
    """Return the programs of the workspace that are started and whose nodes are not known."""
    unread = set()
    for launch in workspace.launches.outermost:
        for node in launch.nodes:
            owner = workspace.find_package(node)
            if not owner or workspace.code.own_node(node):
                continue
            if owner.has_program(*node.program) is not False:
                unread.add(node.program)
    return unread


def _unread_cpp_files(workspace: Workspace, package: Package) -> int:
    """Return how many files in C++ of a package, besides tests, are not read."""
    read = workspace.code.by_package[package.name].cpp_files
    unread = 0
    for path in package.tree.files:
        unread += path.endswith(_CPP) and not path.startswith("test/") and path not in read
    return unread
