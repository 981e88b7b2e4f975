"""A ROS 2 package of a workspace.

Its files are read one by one when they are needed, each once, and never run.
"""

from contextlib import suppress
from dataclasses import field, replace
from functools import cached_property
from pathlib import PurePosixPath
from posixpath import basename
from typing import TYPE_CHECKING

from grader.base.errors import InputError, MissingElement, NotDecided
from grader.base.grouping import Strings, StringsByName, distinct, group_values
from grader.base.names import closest, near
from grader.base.records import Record
from grader.base.reuse import Memory
from grader.base.source import Location, Source
from grader.base.text import enumerated, was_not_committed
from grader.files.tree import IS_LINK, Tree
from grader.ros.installation.places import (
    ENDINGS,
    PREFIX,
    SHARE,
    is_launch_file,
    is_launch_named,
    launch_stem,
    share_parts,
)
from grader.ros.python.budget import PYTHON_LIMIT, Budget

# The readers are imported when they are needed: a URDF on its own needs none of them.
if TYPE_CHECKING:
    from collections.abc import Sequence

    from grader.ros.config.rviz import RvizFile
    from grader.ros.installation.installation import Installation, InstalledFile, KnownPrograms
    from grader.ros.installation.manifest import Manifest
    from grader.ros.known.releases import Release
    from grader.ros.launch.launch_model import Launch, NamedFile


MANIFEST = "package.xml"
SETUP = "setup.py"
CMAKE = "CMakeLists.txt"
RESOURCE_INDEX = "share/ament_index/resource_index/packages/"
NO_PACKAGE = "the submission has no ROS 2 package: there is no package.xml"
_RVIZ_LIMIT = 512 * 1024  # bytes
_MAX_FIRST_LINE = 100  # bytes
_MAX_LAUNCHES = 10
# What a file of a kind is called in messages, and how its name ends.
_KINDS = {
    "urdf": ("URDF", (".urdf", ".xacro")),
    "rviz": ("RViz file", (".rviz",)),
    "launch": ("launch file", ENDINGS),
}


class Package(Record):
    """One ROS 2 package of a workspace, whose files are read and never run.

    `finding.py` finds the packages of a file tree.
    Checks ask it what a build installs, what its launch files start, and what RViz shows; launch
    files and xacro ask it for the files around them. Each file is evaluated when it is first
    needed, and once.

    >>> from grader.files.tree import make_tree, overlaid
    >>> from grader.ros.package.finding import read_packages
    >>> manifest = b"<package format='3'><name>arm</name></package>"
    >>> setup = b"from setuptools import setup; setup(data_files=[('share/arm', ['package.xml'])])"
    >>> files = {"src/arm/package.xml": manifest, "src/arm/setup.py": setup}
    >>> [package] = read_packages(overlaid(make_tree("ash", (), ()), files), "urdf/arm.urdf")
    >>> package.name, package.folder, package.installed
    ('arm', 'src/arm', {'share/arm/package.xml': 'package.xml'})
    """

    folder: str  # its path in the workspace
    tree: Tree  # its files, by their paths in the package
    manifest: "Manifest | None"
    packages: dict[str, "Package"]  # all of the workspace, by their names
    generated: Strings = ()  # paths in the workspace that a build has copied
    wanted_name: str = ""  # the name by which it was looked for
    wanted_packages: Strings = ()  # of several that were looked for, the names of all
    installed_besides: frozenset[str] = frozenset()  # packages that are on its machines
    ignored_by: str = ""  # the path of a file for which colcon ignores it
    # The folders of packages with its name that colcon finds below one folder src, if there are
    # several; first the one that seems to be kept of earlier work.
    copies: Strings = ()
    # Folders of packages in it, each with a slash, whose files it has: a build copies them.
    inner: Strings = ()
    memory: Memory = field(default_factory=Memory)
    own_memory: Memory = field(default_factory=Memory)  # of its copies: they have the same files
    arguments: StringsByName = field(default_factory=dict)  # that its launch files are given
    releases: "tuple[Release, ...]" = ()  # for which it is graded; none: any
    work: Budget = field(default_factory=Budget)  # to read and compare all files of the workspace
    budget: Budget = field(init=False)  # of the evaluation of its files
    _launches: "dict[str, Launch]" = field(default_factory=dict, init=False)
    _rviz_files: "dict[str, RvizFile]" = field(default_factory=dict, init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "budget", Budget(whole=self.work))

    def path(self, path: str) -> str:
        """Return a path of the package as one of the workspace."""
        if self.folder:
            return f"{self.folder}/{path}"
        return path

    def holds(self, path: str) -> bool:
        """Return whether a path of the workspace is in the package."""
        return path.startswith(self.path(""))

    def under(self, arguments: StringsByName) -> "Package":
        """Return the package with its launch files under these arguments."""
        return replace(self, arguments=arguments)

    @property
    def name(self) -> str:
        """The name that ROS 2 finds it by.

        Without a package.xml, it is that of setup.py or of the folder.
        """
        if self.manifest and self.manifest.name is not None:
            return self.manifest.name
        return (self.installation and self.installation.name) or PurePosixPath(
            self.folder or self.tree.name
        ).name

    def find(self, name: str) -> "Package | None":
        """Return the package of the workspace that ROS 2 finds by a name.

        It is this one, if it has the name.
        """
        if name == self.name:
            return self
        return self.packages.get(name) or self._by_registered_name.get(name)

    @cached_property
    def _by_registered_name(self) -> "dict[str, Package]":
        """The packages of the workspace by the names that setup.py registers them by."""
        packages: dict[str, Package] = {}
        for package in self.packages.values():
            for name in package.registered:
                packages.setdefault(name, package)
        return packages

    @cached_property
    def files_by_name(self) -> dict[str, list[str]]:
        """The paths of its files by the last part of each."""
        return group_values((basename(path), path) for path in self.tree.files)

    @property
    def copies_text(self) -> str:
        """What is wrong where a workspace has it more than once, at the first of `copies`."""
        others = enumerated([folder or "." for folder in self.copies[1:]])
        return (
            f"{others} has the package {self.name!r} as well, so colcon builds nothing: remove one "
            "of them, or put a file COLCON_IGNORE into its folder"
        )

    def depends_on(self, name: str) -> bool:
        """Return whether its package.xml depends on a package of this name."""
        return self.manifest is not None and name in self.manifest.dependencies

    @property
    def is_of_ros1(self) -> bool:
        """Whether its package.xml says that catkin of ROS 1 builds it."""
        return self._build_type == "catkin" and self.depends_on("catkin")

    @cached_property
    def names(self) -> Strings:
        """The names that ROS 2 finds it by.

        These are its own, and those that setup.py installs in the resource index.
        """
        return distinct([self.name, *self.registered])

    @cached_property
    def registered(self) -> Strings:
        """The names that setup.py registers it by: those of its files in the resource index."""
        return tuple(
            path.removeprefix(RESOURCE_INDEX)
            for path in self.installed
            if path.startswith(RESOURCE_INDEX)
        )

    @cached_property
    def share(self) -> str:
        """The folder below the prefix where ros2 looks for its files.

        It is that of the wanted name if the package has it, else that of its own.
        """
        return f"share/{self.wanted_name if self.wanted_name in self.names else self.name}/"

    @property
    def is_cmake(self) -> bool:
        """Return whether CMake, not setup.py, installs the package."""
        return CMAKE in self.tree.files and (
            SETUP not in self.tree.files or self.build_file == CMAKE
        )

    @property
    def build_file(self) -> str:
        """Return the file that should install the package, by its package.xml.

        This is setup.py or CMakeLists.txt.
        """
        if self._build_type in ("ament_python", ""):
            return SETUP
        return CMAKE

    def needed_manifest(self) -> "Manifest":
        """Return its package.xml.

        A broken one is returned too if its build type can be read.
        """
        manifest = self.manifest
        if manifest and manifest.unread:
            raise NotDecided(manifest.unread, "package.xml cannot be read")
        if not manifest:
            where = f"the folder {self.folder!r}" if self.folder else "the submission"
            message = f"{where} has a setup.py, but no package.xml, so it is not a ROS 2 package"
            raise MissingElement(MANIFEST, self.folder, message=message, absent=MANIFEST)
        if not manifest.build_type and manifest.refusals:
            problem = manifest.refusals[0]
            raise MissingElement(
                MANIFEST, self.folder, message=problem.message, location=problem.location
            )
        return manifest

    def needed_installation(self) -> "Installation":
        """Return what its setup.py or CMakeLists.txt installs.

        Raises MissingElement if there is none, or if it cannot be parsed; NotDecided if it needs
        manual grading.
        """
        setup = self.installation
        if not setup:
            message = f"the package has no {self.missing_build_file}, so a build installs nothing"
            raise MissingElement(
                SETUP, self.folder, message=message, absent=self.missing_build_file
            )
        if setup.fault and setup.fault.is_certain:
            raise MissingElement(
                SETUP, self.folder, message=setup.fault_text, location=setup.fault.location
            )
        if setup.unread:
            raise NotDecided(setup.unread, f"{setup.file} cannot be read")
        return setup

    @property
    def missing_build_file(self) -> str:
        """What a package without a build file lacks, in words.

        It is that of its build type, or either.
        """
        if self._build_type in ("catkin", ""):
            return f"{SETUP} or {CMAKE}"
        return self.build_file

    @property
    def _build_type(self) -> str:
        if self.manifest:
            return self.manifest.build_type
        return ""

    @cached_property
    def installation(self) -> "Installation | None":
        """Return what its setup.py or CMakeLists.txt installs; None without either."""
        return self.own_memory.recall("installation", None, self.budget, self._read_installation)

    def _read_installation(self, _: object) -> "Installation | None":
        name = CMAKE if self.is_cmake else SETUP
        file = self.tree.files.get(name)
        if not file:
            return None
        from grader.ros.installation.installation import Installation
        from grader.ros.python.parse import SyntaxFault

        path = self.path(name)
        try:
            data = file.read(PYTHON_LIMIT)
        except InputError as error:
            source = Source(path, "")
            fault = SyntaxFault(source, str(error), Location(path, 1, 1), is_certain=False)
            return Installation(source, fault)
        if self.is_cmake:
            from grader.ros.installation.cmake.cmake_lists import read_cmake

            declared = (self.manifest.name if self.manifest else None) or ""
            text = data.decode("utf-8", "replace")
            is_plain = self._build_type == "cmake"
            setup = read_cmake(text, path, self.tree, declared, self.budget, is_plain=is_plain)
            return setup.in_releases(self.releases)
        from grader.ros.installation.setup_py import read_setup

        return read_setup(data, path, self.tree, self.budget, self.releases)

    @cached_property
    def installed(self) -> dict[str, str]:
        """Each installed file's path in the package, by its path below the prefix."""
        if self.installation:
            return self.installation.installed()
        return {}

    @cached_property
    def python_scripts(self) -> "tuple[InstalledFile, ...]":
        """The Python files that a build installs as programs, by their ending or first line."""
        folder = f"lib/{self.name}/"
        copies = self.installation.copies if self.installation else ()
        return tuple(
            copy
            for copy in copies
            if copy.target.startswith(folder) and self._is_python(copy.source)
        )

    def _is_python(self, path: str) -> bool:
        if path.endswith(".py"):
            return True
        with suppress(InputError):
            first = self.tree.files[path].read(_MAX_FIRST_LINE, first=True).partition(b"\n")[0]
            return first.startswith(b"#!") and b"python" in first
        return False

    @cached_property
    def known_programs(self) -> "KnownPrograms":
        """The programs that a build installs; of a package with a build file."""
        assert self.installation
        return self.installation.known_programs()

    @cached_property
    def shadows_ros(self) -> str:
        """The name of a Python package that ros2 launch imports in place of its own.

        A build installs this package.
        """
        from grader.ros.known.ros_machine import ros_machine  # late: a URDF needs no table

        if not self.installation or self.installation.unknown:
            return ""
        imported = ros_machine().imported_by_launch
        return next((name for name in self.installation.packages if name in imported), "")

    @cached_property
    def launch_files(self) -> Strings:
        """The paths of its launch files.

        They are known by their names, or because they are in a folder named launch.
        """
        return tuple(filter(is_launch_file, self.tree.files))

    @cached_property
    def rviz_files(self) -> Strings:
        """The paths of its RViz files."""
        return tuple(path for path in self.tree.files if path.lower().endswith(".rviz"))

    def built(self, kind: str, name: str = "") -> str:
        """Return the end of a message on a missing file, if a build has one.

        The build has one of that kind, or the one of that name.
        """
        shares = [f"/{folder}/{self.name}/" for folder in ("build", "install", "share")]
        endings = (f"/{name}",) if name else _KINDS[kind][1]
        for path in self.generated:
            is_copied = any(share in f"/{path}" for share in shares)
            if is_copied and (path if name else path.lower()).endswith(endings):
                return was_not_committed(path)
        return ""

    def missing(self, kind: str, name: str = "") -> MissingElement | NotDecided:
        """Return the error for a package without a file of a kind: urdf, launch or rviz.

        `name` is that of the file that is wanted.
        """
        word, endings = _KINDS[kind]
        if self.tree.links:
            return NotDecided(f"the {word} may be in {self.tree.links[0]}, which {IS_LINK}")
        folder = ""
        if kind == "launch" and not any(basename(path) == kind for path in self.tree.folders):
            folder = ", and there is no folder launch"
        usual = enumerated(endings[:3], word="or")
        message = f"the package has no {word}: no file ends in {usual}{folder}"
        return MissingElement(
            f"{word} in the package",
            "",
            message=message,
            detail=self.built(kind),
            absent=f"{word} {name}".rstrip(),
        )

    def without_data_files(self, message: str) -> MissingElement:
        """Return the error for a setup.py that gives setup() no data_files.

        This mistake is the cause.
        """
        setup = self.installation
        at = setup.location(setup.called_at) if setup else None
        return MissingElement(
            "data_files",
            self.folder,
            message=message,
            location=at,
            problem=message,
            costs_once=True,
        )

    def launch_file(self, name: str) -> str | None:
        """Return the launch file of this name, if need be in another language.

        If there is none, return that of the closest name, else any.
        """
        files = sorted(
            self.launch_files,
            key=lambda path: (basename(path) != name, path.count("/"), path),
        )
        named = [path for path in files if is_launch_named(path, name)]
        if named:
            return named[0]
        names = {basename(path): path for path in reversed(files)}
        stem = launch_stem(name)
        similar = closest(name, names) or next(
            (other for other in names if launch_stem(other) == stem), None
        )
        if similar:
            return names[similar]
        return files[0] if files else None

    def launch(self, path: str, text: bytes | None = None) -> "Launch":
        """Return a launch file, evaluated: as it is, or with another text."""
        if path in self._launches and text is None:
            return self._launches[path]
        from grader.ros.launch.launch_file import read_launch
        from grader.ros.launch.launch_model import Launch

        full = self.path(path)
        try:
            data = text
            if data is None:
                data = self.tree.files[path].read(PYTHON_LIMIT)
            installed = self._installed_path(path)
            launch = read_launch(
                data,
                full,
                installed,
                self,
                self.arguments,
                self.memory,
                self.work,
                self.releases,
            )
        except InputError as error:
            launch = Launch(Source(full, ""), unread=str(error))
        launch = launch.in_releases(self.releases)
        if text is None:
            return self._launches.setdefault(path, launch)
        return launch

    def _installed_path(self, path: str) -> str:
        """Return where a build installs a file, below the prefix.

        A launch file that it does not install is read as if it did: that is another mistake.
        """
        for target, source in self.installed.items():
            if source == path:
                return target
        return f"share/{self.name}/{path}"

    def rviz(self, path: str) -> "RvizFile":
        """Return an RViz file."""
        if path in self._rviz_files:
            return self._rviz_files[path]
        from grader.ros.config.rviz import RvizFile, read_rviz

        full = self.path(path)
        try:
            rviz = read_rviz(self.tree.files[path].read(_RVIZ_LIMIT), full)
        except InputError as error:
            start = Location(full, 1, 1)
            rviz = RvizFile(Source(full, ""), None, None, start, (), unread=str(error))
        return self._rviz_files.setdefault(path, rviz)

    @property
    def launches(self) -> "list[Launch]":
        """What its launch files do."""
        return [self.launch(path) for path in self.launch_files[:_MAX_LAUNCHES]]

    def robot_references(self, name: str = "") -> "list[NamedFile]":
        """Return where its launch files read the robot in a file of this name, or in any file."""
        references = []
        for launch in self.launches:
            for reference in launch.named("urdf"):
                path = reference.path
                if path and (not name or f"/{path}".endswith(f"/{name}")):
                    references.append(reference)
        return references

    def rviz_file(self, name: str, launch: "Launch | None") -> str | None:
        """Return the RViz file that the launch file opens; else the one of this name; else any."""
        opened = self.rviz_opened(launch) if launch else None
        if opened:
            return opened
        return min(
            self.rviz_files,
            key=lambda path: (basename(path) != name, path.count("/"), path),
            default=None,
        )

    def owner_of_opened(self, launch: "Launch") -> "Package":
        """Return the package of the workspace whose RViz file a launch file opens.

        Without such a file, it is the package itself.
        """
        owners = [self, *(self.find(share_parts(path)[0]) for path in launch.rviz_paths)]
        for owner in owners:
            if owner and owner.rviz_opened(launch) is not None:
                return owner
        return self

    def rviz_opened(self, launch: "Launch") -> str | None:
        """Return the RViz file that a launch file opens, also by a wrong folder.

        A wrong folder is another error.
        """
        for path in launch.rviz_paths:
            source = self.find_source(path)
            if source in self.rviz_files:
                return source
        names = {basename(path) for path in launch.rviz_paths}
        for path in self.rviz_files:
            if basename(path) in names:
                return path
        return None

    def find_source(self, path: str) -> str | None:
        """Return the file of the package that a build installs at a path.

        The path begins with the prefix's stand-in.
        """
        shares = tuple(f"{SHARE}/{name}/" for name in self.names)
        if path.startswith(shares):
            return self.installed.get(path.removeprefix(f"{PREFIX}/"))
        return None

    @property
    def _all(self) -> "tuple[Package, ...]":
        return self, *self.packages.values()

    def has_package(self, name: str) -> bool:
        """Return whether a package certainly is on the machine.

        It is in the workspace, declared as needed, installed besides, or part of ROS 2.
        """
        from grader.ros.launch.started_nodes import (
            is_of_ros,  # late: as the readers of launch files
        )

        # rosdep installs what any package of a workspace needs.
        return (
            self.find(name) is not None
            or any(package.depends_on(name) for package in self._all)
            or name in self.installed_besides
            or is_of_ros(name)
        )

    def misspelt_package(self, name: str) -> str | None:
        """Return the package of the workspace that a name stands for, if there is one.

        The name is that of a package that certainly is not on the machine.
        """
        from grader.ros.known.package_rows import is_known_package  # late: as above
        from grader.ros.known.released import is_released  # late: as above

        # Where a package does not have the wanted name, that of the package is wrong.
        if name == self.wanted_name or self.has_package(name) or is_known_package(name):
            return None
        meant = near(name, [package.name for package in self._all])
        return None if meant is not None and is_released(name) else meant

    def has_program(self, package: str, name: str) -> bool | None:
        """Return whether a package has a program, as far as its setup.py tells.

        A package that is not known has it.
        """
        from grader.ros.known.package_rows import lacks_program  # late: as above

        owner = self.find(package)
        if not owner:
            return not lacks_program(package, name)
        if owner.installation:
            return owner.installation.has_program(name, package, owner.known_programs)
        return None

    def files_in(self, folder: str) -> "Sequence[str] | None":
        """Return the names of the files that builds install in a folder below the prefix.

        Returns None if not all are known.
        """
        owner = self.find(folder.removeprefix("share/").partition("/")[0])
        if (
            not owner
            or owner.installation is None
            or owner.installation.fault
            or owner.installation.unknown
        ):
            return None
        return tuple(
            basename(path) for path in owner.installed if path.rpartition("/")[0] == folder
        )

    def open_installed(self, path: str) -> tuple[bytes, str] | None:
        """Return what a build of any of its packages installs at a path below the prefix.

        Also return the file's path.
        """
        for package in self.packages.values():
            if path in package.installed:
                with suppress(InputError):
                    source = package.installed[path]
                    return package.tree.files[source].read(PYTHON_LIMIT), package.path(source)
        return None


Packages = tuple[Package, ...]
