"""A ROS 2 package as it was handed in: its files, read one by one when they are asked for, and never run."""

from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from functools import cached_property
from pathlib import PurePosixPath
from typing import TYPE_CHECKING

from grader.errors import InputError
from grader.files.tree import Tree
from grader.names import closest, did_you_mean
from grader.package.launch.places import ENDINGS, PREFIX, SHARE, is_launch_named, launch_stem, may_launch
from grader.source import Location, Source

# The readers are loaded when they are needed: a URDF on its own needs none of them.
if TYPE_CHECKING:
    from grader.package.launch.model import Launch
    from grader.package.manifest import Manifest
    from grader.package.rviz import RvizFile
    from grader.package.setup_py import Setup

MANIFEST, SETUP = "package.xml", "setup.py"
_INDEX = "share/ament_index/resource_index/packages/"
NO_PACKAGE = "no ROS 2 package was handed in: there is no package.xml"
PYTHON_LIMIT = 128 * 1024  # bytes; a syntax tree takes several hundred times as much
_RVIZ_LIMIT = 512 * 1024
_MOST_LAUNCHES = 10


@dataclass(frozen=True)
class Package:
    """One package; `folder` is its path in the submission, and `tree` has its files by their paths in the package.

    `known` has every package of the submission by its name, this one included.
    """

    folder: str
    tree: Tree = field(repr=False)
    manifest: "Manifest | None" = field(repr=False)
    known: dict[str, "Package"] = field(repr=False, compare=False)

    def path(self, path: str) -> str:
        """A path of the package as one of the submission."""
        return f"{self.folder}/{path}" if self.folder else path

    @property
    def name(self) -> str:
        """The name that ROS 2 knows it by; without a package.xml, that of setup.py or of the folder."""
        if self.manifest is not None and self.manifest.name is not None:
            return self.manifest.name
        return (self.setup.name if self.setup is not None else None) or PurePosixPath(
            self.folder or self.tree.name
        ).name

    def find(self, name: str) -> "Package | None":
        """The package of the submission that ROS 2 finds by a name."""
        every = self.known.values()
        return self.known.get(name) or next((package for package in every if name in package.names), None)

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The names that ROS 2 finds it by: its own, and those that setup.py enters in the resource index."""
        entered = [target for target in self.setup.installed() if target.startswith(_INDEX)] if self.setup else []
        return tuple(dict.fromkeys([self.name, *(target.removeprefix(_INDEX) for target in entered)]))

    @property
    def is_cmake(self) -> bool:
        """Whether CMake, not setup.py, says what is installed."""
        other_type = self.manifest is not None and self.manifest.build_type not in ("ament_python", "")
        return "CMakeLists.txt" in self.tree.files and (SETUP not in self.tree.files or other_type)

    @cached_property
    def setup(self) -> "Setup | None":
        """What its setup.py would install; None where there is none."""
        file = self.tree.files.get(SETUP)
        if file is None:
            return None
        from grader.package.setup_py import Setup, read_setup
        from grader.static_python.parse import SyntaxFault, parse

        try:
            return read_setup(parse(file.read(PYTHON_LIMIT), self.path(SETUP)), self.tree)
        except InputError as error:
            source = Source(self.path(SETUP), "")
            fault = SyntaxFault(source, str(error), Location(self.path(SETUP), 1, 1), sure=False)
            return Setup(self.path(SETUP), source, fault)

    @cached_property
    def launch_files(self) -> tuple[str, ...]:
        """The paths of its launch files: by their names, or because they stand in a folder launch."""
        return tuple(path for path in self.tree.files if path.endswith(ENDINGS) or may_launch(path))

    @cached_property
    def rviz_files(self) -> tuple[str, ...]:
        """The paths of its RViz files."""
        return tuple(path for path in self.tree.files if path.lower().endswith(".rviz"))

    def without(self, kind: str) -> str:
        """What to say of a package that has no file of a kind: urdf, launch or rviz."""
        if kind == "urdf":
            return "the package has no URDF: no file ends in .urdf or .xacro"
        if kind == "rviz":
            return "the package has no RViz file: none ends in .rviz"
        message = "the package has no launch file: none ends in .launch.py, .launch.xml or .launch.yaml"
        is_there = any(folder.rpartition("/")[2] == "launch" for folder in self.tree.folders)
        return message if is_there else f"{message}, and there is no folder launch"

    def instead(self, pattern: str) -> str:
        """What to say behind a pattern that finds no file: that its folder is missing, or what is in it instead."""
        if "\\" in pattern:
            return ": a path is written with / in setup.py, not with \\"
        folder = pattern.rpartition("/")[0]
        if folder and folder not in self.tree.folders:
            return f", because there is no folder {folder!r}{did_you_mean(folder, self.tree.folders)}"
        named = pattern.rpartition("/")[2]
        there = [path for path in self.tree.files if named.strip("*") and fnmatchcase(path.rpartition("/")[2], named)]
        there = there or [path for path in self.tree.files if path.rpartition("/")[0] == folder]
        if not there:
            return f", because the folder {folder!r} is empty"
        more = ", ..." if len(there) > 3 else ""
        return f"; there {'are' if len(there) > 1 else 'is'} {', '.join(there[:3])}{more}"

    def launch_file(self, name: str) -> str | None:
        """The launch file of this name, in any of the three languages; else the one that is named most like it; else any."""
        files = sorted(self.launch_files, key=lambda path: (path.count("/"), path))
        stem = launch_stem(name)
        exact = [path for path in files if is_launch_named(path, name)]
        if exact:
            return exact[0]
        names = {path.rpartition("/")[2]: path for path in reversed(files)}
        similar = closest(name, names) or next((each for each in names if launch_stem(each) == stem), None)
        return names[similar] if similar else files[0] if files else None

    def launch(self, path: str) -> "Launch":
        """A launch file, followed."""
        if path not in self._launches:
            self._launches[path] = self._read_launch(path)
        return self._launches[path]

    def readers(self, name: str) -> set[str]:
        """What its launch files have read the robot in a file of this name: xacro, cat or open."""
        launches = map(self.launch, self.launch_files[:_MOST_LAUNCHES])
        named = (each for launch in launches for each in launch.named("urdf") if each.path is not None)
        return {each.by for each in named if (each.path or "").rpartition("/")[2] == name}

    @cached_property
    def _launches(self) -> "dict[str, Launch]":
        return {}

    def _read_launch(self, path: str) -> "Launch":
        from grader.package.launch.model import Launch
        from grader.package.launch.reader import read_launch

        try:
            data = self.tree.files[path].read(PYTHON_LIMIT)
        except InputError as error:
            return Launch(self.path(path), Source(self.path(path), ""), unread=str(error))
        return read_launch(
            data, self.path(path), self.target(path) or f"share/{self.name}/{path}", self._open_installed
        )

    def rviz_file(self, name: str, launch: "Launch | None") -> str | None:
        """The RViz file that the launch file opens; else the one of this name; else any."""
        opened = self.rviz_opened(launch) if launch is not None else None
        files = sorted(self.rviz_files, key=lambda path: (path.rpartition("/")[2] != name, path.count("/"), path))
        return opened or (files[0] if files else None)

    def rviz_opened(self, launch: "Launch") -> str | None:
        """The RViz file that a launch file opens, or means to open: a wrong folder is a fault of its own."""
        paths = [each.path for each in launch.named("rviz") if each.path is not None]
        installed = [source for path in paths if (source := self.source_of(path)) in self.rviz_files]
        names = {path.rpartition("/")[2] for path in paths}
        meant = [path for path in self.rviz_files if path.rpartition("/")[2] in names]
        return next(iter([*installed, *meant]), None)

    def rviz(self, path: str) -> "RvizFile":
        """Return an RViz file."""
        if path not in self._rviz_files:
            self._rviz_files[path] = self._read_rviz(path)
        return self._rviz_files[path]

    @cached_property
    def _rviz_files(self) -> "dict[str, RvizFile]":
        return {}

    def _read_rviz(self, path: str) -> "RvizFile":
        from grader.package.rviz import RvizFile, read_rviz

        try:
            data = self.tree.files[path].read(_RVIZ_LIMIT)
        except InputError as error:
            start = Location(self.path(path), 1, 1)
            return RvizFile(self.path(path), Source(self.path(path), ""), None, None, start, (), unread=str(error))
        return read_rviz(data, self.path(path))

    def target(self, path: str) -> str | None:
        """Where a build puts a file of the package, below the prefix; None where it does not install it."""
        copies = self.setup.copies if self.setup is not None else ()
        return next((copy.target for copy in copies if copy.source == path), None)

    def source_of(self, path: str) -> str | None:
        """The file of the package that a build puts at this path, which begins with the stand-in for the prefix."""
        shares = tuple(f"{SHARE}/{name}/" for name in self.names)
        if self.setup is None or not path.startswith(shares):
            return None
        return self.setup.installed().get(path.removeprefix(f"{PREFIX}/"))

    def _open_installed(self, path: str) -> tuple[bytes, str] | None:
        """What the build puts at a path below the prefix, from whichever package of the submission it comes."""
        for package in self.known.values():
            source = package.setup.installed().get(path) if package.setup is not None else None
            if source is not None:
                try:
                    return package.tree.files[source].read(PYTHON_LIMIT), package.path(source)
                except InputError:
                    return None
        return None
