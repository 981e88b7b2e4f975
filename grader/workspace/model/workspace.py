"""A workspace as the rules of names see it: its folder, and what is read of it."""

from collections.abc import Mapping
from functools import cached_property

from grader.base.records import Record
from grader.base.reuse import Memory
from grader.files.tree import Tree
from grader.ros.known.releases import Release
from grader.ros.launch.launch_model import StartedNode
from grader.ros.package.package import Package
from grader.ros.package.robot_file import Read
from grader.workspace.model.given_files import GivenFiles
from grader.workspace.model.installed_yaml import InstalledFiles
from grader.workspace.model.known_robots import Robots
from grader.workspace.model.launches import Launches
from grader.workspace.model.own_code import OwnCode
from grader.workspace.model.text_files import TextFiles
from grader.workspace.model.workspace_folder import WorkspaceFolder


class Workspace(Record):
    """The packages of a folder with their robots, as the readers of names see them.

    Each file is read once.

    `OpenedWorkspace` makes it. Its parts read one another from the top: folder, texts, launches,
    installed, robots, code, parameters.
    """

    found_packages: tuple[Package, ...]  # the one that matches best first
    urdfs: tuple[Read, ...]  # the files of robots that are read
    tree: Tree  # all files, also those outside of packages
    has_unread_robots: bool  # whether other files may be robots
    releases: tuple[Release, ...] = ()  # in one of which names should be; () for any
    memory: Memory | None = None  # what was read of an earlier state of the files
    reads_meant: bool = False  # whether a misspelt name that is reported counts as the one meant
    # The path of the only launch file that is launched; empty for each that no other one includes.
    launched: str = ""

    def charge(self, parts: int) -> None:
        """Charge the work of comparing names to the budget of the workspace. Raises NotDecided."""
        self.folder.charge(parts)

    @property
    def packages(self) -> tuple[Package, ...]:
        """The packages that a build of the workspace has."""
        return self.folder.packages

    @cached_property
    def own_packages(self) -> Mapping[str, Package]:
        """The same packages by their names."""
        return {package.name: package for package in self.packages}

    def find_package(self, node: StartedNode) -> Package | None:
        """Return the package of the workspace whose program a node is."""
        return self.folder.find_package(node)

    @cached_property
    def folder(self) -> WorkspaceFolder:
        """The files and packages, and the budget."""
        return WorkspaceFolder(self.found_packages, self.tree, self.memory, self.reads_meant)

    @cached_property
    def texts(self) -> TextFiles:
        """The texts of files."""
        return TextFiles(self.folder)

    @cached_property
    def launches(self) -> Launches:
        """The launch files, and the nodes that they start."""
        return Launches(self.folder, self.launched)

    @cached_property
    def installed(self) -> InstalledFiles:
        """The files that builds install."""
        return InstalledFiles(self.folder, self.launches)

    @cached_property
    def robots(self) -> Robots:
        """The robots."""
        return Robots(self.urdfs, self.has_unread_robots, self.folder, self.texts, self.launches)

    @cached_property
    def code(self) -> OwnCode:
        """What the code of packages opens and declares."""
        return OwnCode(self.folder, self.installed)

    @cached_property
    def parameters(self) -> GivenFiles:
        """The parameters that nodes are given."""
        return GivenFiles(
            self.folder, self.texts, self.launches, self.installed, self.robots, self.code
        )
