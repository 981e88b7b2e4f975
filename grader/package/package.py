"""A ROS 2 package of a submission: its files are read one by one when they are needed, each once, and never run."""

from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from functools import cached_property
from pathlib import PurePosixPath
from typing import TYPE_CHECKING

from grader.errors import InputError
from grader.files.tree import Tree
from grader.names import closest, did_you_mean
from grader.package.launch.places import ENDINGS, PREFIX, SHARE, is_in_launch_folder, is_launch_named, launch_stem
from grader.source import Location, Source
from grader.text import enumerated

# The readers are imported when they are needed: a URDF on its own needs none of them.
if TYPE_CHECKING:
    from grader.package.launch.model import Launch
    from grader.package.manifest import Manifest
    from grader.package.rviz import RvizFile
    from grader.package.setup_py import Setup

MANIFEST, SETUP = "package.xml", "setup.py"
_INDEX = "share/ament_index/resource_index/packages/"
NO_PACKAGE = "the submission has no ROS 2 package: there is no package.xml"
PYTHON_LIMIT = 128 * 1024  # bytes; a syntax tree takes several hundred times as much
_RVIZ_LIMIT = 512 * 1024
_MAX_LAUNCHES = 10
_MAX_NAMED = 3  # files that a message names


@dataclass(frozen=True)
class Package:
    """One package; `folder` is its path in the submission, and `tree` has its files by their paths in the package.

    `packages` has every package of the submission by its name, this one included.
    """

    folder: str
    tree: Tree = field(repr=False)
    manifest: "Manifest | None" = field(repr=False)
    packages: dict[str, "Package"] = field(repr=False, compare=False)
    _launches: "dict[str, Launch]" = field(default_factory=dict, init=False, repr=False, compare=False)
    _rviz_files: "dict[str, RvizFile]" = field(default_factory=dict, init=False, repr=False, compare=False)

    def path(self, path: str) -> str:
        """Return a path of the package as one of the submission."""
        return f"{self.folder}/{path}" if self.folder else path

    @property
    def name(self) -> str:
        """The name that ROS 2 finds it by; without a package.xml, that of setup.py or of the folder."""
        declared = self.manifest.name if self.manifest is not None else None
        set_up = self.setup.name if declared is None and self.setup is not None else None
        return declared or set_up or PurePosixPath(self.folder or self.tree.name).name

    def find(self, name: str) -> "Package | None":
        """Return the package of the submission that ROS 2 finds by a name."""
        others = (package for package in self.packages.values() if name in package.names)
        return self.packages.get(name) or next(others, None)

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The names that ROS 2 finds it by: its own, and those that setup.py installs in the resource index."""
        entries = [target for target in self.setup.installed() if target.startswith(_INDEX)] if self.setup else []
        return tuple(dict.fromkeys([self.name, *(target.removeprefix(_INDEX) for target in entries)]))

    @property
    def is_cmake(self) -> bool:
        """Return whether CMake, not setup.py, installs the package."""
        other_type = self.manifest is not None and self.manifest.build_type not in ("ament_python", "")
        return "CMakeLists.txt" in self.tree.files and (SETUP not in self.tree.files or other_type)

    @cached_property
    def setup(self) -> "Setup | None":
        """Return the files that its setup.py would install; None without a setup.py."""
        file = self.tree.files.get(SETUP)
        if file is None:
            return None
        from grader.package.setup_py import Setup, read_setup
        from grader.static_python.parse import SyntaxFault, parse

        try:
            return read_setup(parse(file.read(PYTHON_LIMIT), self.path(SETUP)), self.tree)
        except InputError as error:
            source, start = self._unread(SETUP)
            return Setup(source.path, source, SyntaxFault(source, str(error), start, sure=False))

    @cached_property
    def launch_files(self) -> tuple[str, ...]:
        """The paths of its launch files: by their names, or because they are in a folder named launch."""
        return tuple(path for path in self.tree.files if path.endswith(ENDINGS) or is_in_launch_folder(path))

    @cached_property
    def rviz_files(self) -> tuple[str, ...]:
        """The paths of its RViz files."""
        return tuple(path for path in self.tree.files if path.lower().endswith(".rviz"))

    def missing_message(self, kind: str) -> str:
        """Return the message for a package without a file of a kind: urdf, launch or rviz."""
        if kind == "urdf":
            return "the package has no URDF: no file ends in .urdf or .xacro"
        if kind == "rviz":
            return "the package has no RViz file: no file ends in .rviz"
        message = "the package has no launch file: no file ends in .launch.py, .launch.xml or .launch.yaml"
        has_folder = any(folder.rpartition("/")[2] == "launch" for folder in self.tree.folders)
        return message if has_folder else f"{message}, and there is no folder launch"

    def pattern_hint(self, pattern: str) -> str:
        """Return the end of a message on a pattern that matches no file: why, or which files there are."""
        if "\\" in pattern:
            return ": separate the parts of a path with /, not with \\"
        folder, _, name = pattern.rpartition("/")
        if folder and folder not in self.tree.folders:
            return f", because there is no folder {folder!r}{did_you_mean(folder, self.tree.folders)}"
        files = [path for path in self.tree.files if name.strip("*") and fnmatchcase(path.rpartition("/")[2], name)]
        files = files or [path for path in self.tree.files if path.rpartition("/")[0] == folder]
        if not files:
            return f", because the folder {folder!r} is empty"
        return f"; there {'are' if len(files) > 1 else 'is'} {enumerated(files, _MAX_NAMED)}"

    def launch_file(self, name: str) -> str | None:
        """Return the launch file of this name, in any language; else the one with the closest name; else any."""
        files = sorted(self.launch_files, key=lambda path: (path.count("/"), path))
        exact = [path for path in files if is_launch_named(path, name)]
        if exact:
            return exact[0]
        names = {path.rpartition("/")[2]: path for path in reversed(files)}
        stem = launch_stem(name)
        similar = closest(name, names) or next((other for other in names if launch_stem(other) == stem), None)
        return names[similar] if similar else files[0] if files else None

    def launch(self, path: str) -> "Launch":
        """Return a launch file, evaluated."""
        if path not in self._launches:
            self._launches[path] = self._read_launch(path)
        return self._launches[path]

    def _read_launch(self, path: str) -> "Launch":
        from grader.package.launch.model import Launch
        from grader.package.launch.reader import read_launch

        try:
            data = self.tree.files[path].read(PYTHON_LIMIT)
        except InputError as error:
            return Launch(self.path(path), self._unread(path)[0], unread=str(error))
        installed = self.target(path) or f"share/{self.name}/{path}"
        return read_launch(data, self.path(path), installed, self._open_installed)

    def rviz(self, path: str) -> "RvizFile":
        """Return an RViz file."""
        if path not in self._rviz_files:
            self._rviz_files[path] = self._read_rviz(path)
        return self._rviz_files[path]

    def _read_rviz(self, path: str) -> "RvizFile":
        from grader.package.rviz import RvizFile, read_rviz

        try:
            data = self.tree.files[path].read(_RVIZ_LIMIT)
        except InputError as error:
            source, start = self._unread(path)
            return RvizFile(source.path, source, None, None, start, (), unread=str(error))
        return read_rviz(data, self.path(path))

    def robot_readers(self, name: str) -> set[str]:
        """Return the programs with which its launch files read the robot in a file of this name: xacro, cat or open."""
        launches = map(self.launch, self.launch_files[:_MAX_LAUNCHES])
        references = (reference for launch in launches for reference in launch.named("urdf"))
        return {reference.by for reference in references if (reference.path or "").rpartition("/")[2] == name}

    def rviz_file(self, name: str, launch: "Launch | None") -> str | None:
        """Return the RViz file that the launch file opens; else the one of this name; else any."""
        opened = self.rviz_opened(launch) if launch is not None else None
        files = sorted(self.rviz_files, key=lambda path: (path.rpartition("/")[2] != name, path.count("/"), path))
        return opened or (files[0] if files else None)

    def rviz_opened(self, launch: "Launch") -> str | None:
        """Return the RViz file that a launch file opens, also by a wrong folder: that is another error."""
        paths = [reference.path for reference in launch.named("rviz") if reference.path is not None]
        installed = [source for path in paths if (source := self.source_of(path)) in self.rviz_files]
        names = {path.rpartition("/")[2] for path in paths}
        return next(iter([*installed, *(path for path in self.rviz_files if path.rpartition("/")[2] in names)]), None)

    def target(self, path: str) -> str | None:
        """Return the path below the prefix that a build installs a file at; None where it does not."""
        copies = self.setup.copies if self.setup is not None else ()
        return next((copy.target for copy in copies if copy.source == path), None)

    def source_of(self, path: str) -> str | None:
        """Return the file of the package that a build installs at a path, which begins with the stand-in for the prefix."""
        shares = tuple(f"{SHARE}/{name}/" for name in self.names)
        if self.setup is None or not path.startswith(shares):
            return None
        return self.setup.installed().get(path.removeprefix(f"{PREFIX}/"))

    def _unread(self, path: str) -> tuple[Source, Location]:
        """Return an empty source, and its start, for a file that is not read."""
        return Source(self.path(path), ""), Location(self.path(path), 1, 1)

    def _open_installed(self, path: str) -> tuple[bytes, str] | None:
        """Return what a build installs at a path below the prefix, with its path, from any package of the submission."""
        for package in self.packages.values():
            source = package.setup.installed().get(path) if package.setup is not None else None
            if source is not None:
                try:
                    return package.tree.files[source].read(PYTHON_LIMIT), package.path(source)
                except InputError:
                    return None
        return None
