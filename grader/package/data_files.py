"""The files that data_files of a setup.py installs, in the order of setuptools' install_data."""

import posixpath
import re
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import PurePosixPath
from typing import NamedTuple

from grader.errors import InputError
from grader.files.names import ignored_part
from grader.files.tree import Tree
from grader.names import did_you_mean
from grader.package.globbing import PackageListing, SearchError
from grader.static_python.evaluation import EvaluationStopped
from grader.static_python.parse import Position
from grader.static_python.values import (
    MAX_PATH,
    PACKAGE_FOLDER,
    UNKNOWN_KEYS,
    Call,
    Unknown,
    Value,
    names_package_folder,
    unknown_in,
)
from grader.text import enumerated

# Other arguments that install files and are not evaluated.
_OTHER_WAYS = ("package_data", "include_package_data", "cmdclass", UNKNOWN_KEYS)
# The arguments that name the Python packages; without one, setuptools searches for packages, but not in the folders
# below, those of `FlatLayoutPackageFinder.DEFAULT_EXCLUDE`.
_PACKAGES = ("packages", "py_modules", "ext_modules", "package_dir", UNKNOWN_KEYS)
_NO_PACKAGES = frozenset(
    {"ci", "bin", "debian", "doc", "docs", "documentation", "manpages", "news", "newsfragments", "changelog", "test",
     "tests", "unit_test", "unit_tests", "example", "examples", "scripts", "tools", "util", "utils", "python", "build",
     "benchmark", "benchmarks", "exercise", "exercises", "htmlcov", "tasks", "dist", "venv", "env", "requirements",
     "fabfile", "site_scons"}
)  # fmt: skip
# The same arguments in setup.cfg and pyproject.toml: packages = find:, [tool.setuptools.packages.find].
_SET_PACKAGES = rb"(?m)^\s*(packages|package[_-]dir|py[_-]modules|ext[_-]modules)\b|setuptools\.packages"
_MAX_GUESSES = 10
_MAX_COPIES = 20_000
_MAX_SETTINGS = 64 * 1024  # bytes


class InstalledFile(NamedTuple):
    """One installed file: its path in the package, its path below the prefix, and the position that installs it."""

    source: str
    target: str
    at: Position


class InstallError(NamedTuple):
    """Something in data_files that cannot be installed, so that the build stops."""

    path: str
    reason: str
    at: Position
    hint: str = ""  # what the path may mean instead

    @property
    def message(self) -> str:
        """The error that stops the build, as part of a sentence."""
        return f"data_files lists {self.path!r}, but {self.reason}" if self.path else self.reason


@dataclass(slots=True)
class DataFiles:
    """Installs the files of data_files as setuptools' install_data does, without touching any."""

    tree: Tree
    listing: PackageListing
    root: str  # the absolute path that stands for the package's folder
    positions: Mapping[str, Position]  # the origin of each path
    copies: list[InstalledFile] = field(default_factory=list)
    stops: list[InstallError] = field(default_factory=list)
    unknown: list[Unknown] = field(default_factory=list)

    def read(self, call: Call) -> None:
        """Add the files that a call of setup() installs."""
        for name in _OTHER_WAYS:
            if call.kwargs.get(name):
                what = "unpacked arguments" if name == UNKNOWN_KEYS else name
                self.unknown.append(Unknown(f"{what} may install files, too", call.at))
        if call.uncertainty is not None:
            self.unknown.append(call.uncertainty)
            return
        self._find_packages(call)
        entries = call.kwargs.get("data_files")
        if not entries and _configures(self.tree, b"data[_-]files"):
            self._give_up(None, "data_files is set in setup.cfg or pyproject.toml, which is not supported", call.at)
        if isinstance(entries, list | tuple):
            for entry in entries:
                self._entry(entry, call.at)
        elif entries is not None:
            self._give_up(entries, "data_files is known only at run time", call.at)

    def finish(self, change: Call | None) -> None:
        """Remove what is not certain: files with the same target, and everything if the file itself changes files."""
        sources: dict[str, set[str]] = defaultdict(set)
        for copy in self.copies:
            sources[copy.target].add(copy.source)
        several = [copy for copy in self.copies if len(sources[copy.target]) > 1]
        self.copies = [copy for copy in self.copies if len(sources[copy.target]) == 1]
        for target, at in {copy.target: copy.at for copy in several}.items():
            self._give_up(None, f"several files are installed as {target}: {enumerated(sorted(sources[target]))}", at)
        if change is not None:
            self.copies.clear()
            self.stops.clear()
            self._give_up(None, "setup.py itself makes or changes files", change.at)

    def _give_up(self, value: Value, reason: str, at: Position) -> None:
        """Add the unknown parts of a value, or that it is not supported."""
        self.unknown.append(unknown_in(value) or Unknown(reason, at))

    def _stop(self, path: str, reason: str, at: Position) -> None:
        self.stops.append(InstallError(path, reason, self.positions.get(path, at) if path else at))

    def _entry(self, entry: Value, at: Position) -> None:
        match entry:
            case str() | PurePosixPath():
                self._file(entry, "", at)
            case [str() as path]:
                self._stop(path, "an entry is a folder and a list of files; the list is missing", at)
            case [str() | PurePosixPath() as folder, files]:
                self._folder(str(folder), files, at)
            case [folder, _]:
                self._give_up(folder, "a folder in data_files is known only at run time", at)
            case _:
                self._give_up(entry, "an entry of data_files is known only at run time", at)

    def _folder(self, folder: str, files: Value, at: Position) -> None:
        if ".." in folder.split("/") or names_package_folder(folder) or folder.startswith(self.root):
            self._give_up(None, f"the target {folder.replace(PACKAGE_FOLDER, '...')} is not supported", at)
        elif len(folder) > MAX_PATH:
            self._give_up(None, "a folder in data_files is too long", at)
        elif isinstance(files, str) and files:
            self._stop(files, "the files of an entry are a string, not a list: write [...] around it", at)
        elif isinstance(files, list | tuple):
            for file in files:
                self._file(file, folder, at)
        else:
            self._give_up(files, "the files of an entry are known only at run time", at)

    def _file(self, file: Value, folder: str, at: Position) -> None:
        if len(self.copies) + len(self.stops) + len(self.unknown) > _MAX_COPIES:
            raise EvaluationStopped("it installs too many files")
        if isinstance(file, list | tuple | dict | int | float | None) and unknown_in(file) is None:
            self._stop("", "an entry of data_files contains something other than a file: is a bracket misplaced?", at)
        elif isinstance(file, str | PurePosixPath):
            self._path(file, folder, self.positions.get(str(file), at))
        else:
            self._give_up(file, "a file in data_files is known only at run time", at)

    def _path(self, file: str | PurePosixPath, folder: str, at: Position) -> None:
        text = str(file).removeprefix(self.root + "/")
        if len(text) > MAX_PATH:
            self._give_up(None, "the path of a file is too long", at)
            return
        try:
            path = self.listing.real(text)
        except SearchError:
            self._give_up(None, f"{text} is outside of the package", at)
            return
        if names_package_folder(text):
            self._give_up(None, "the name of the package's folder is not known", at)
        elif isinstance(file, PurePosixPath) and not folder:
            self._give_up(None, "some versions of setuptools do not accept a path here", at)
        elif path is not None and path in self.tree.files:
            target = posixpath.normpath(posixpath.join(folder, posixpath.basename(path)))
            self.copies.append(InstalledFile(path, target, at))
        elif path is not None:
            reason = f"it is a folder, and only files can be installed{self._narrower(path)}"
            self.stops.append(InstallError(text, reason, at))
        elif str(PurePosixPath(text)) in self.tree.files:
            self._give_up(None, f"whether {text} names a file depends on the version of setuptools", at)
        elif ignored_part(posixpath.normpath(text)):
            self._give_up(None, f"{text} is an ignored file", at)
        else:
            guess = did_you_mean(text, self.tree.files) if len(self.stops) < _MAX_GUESSES else ""
            self.stops.append(InstallError(text, "there is no such file", at, guess))

    def _narrower(self, folder: str) -> str:
        """Return the hint about a pattern that matches the other files next to a folder, but not the folder."""
        above = posixpath.dirname(folder)
        names = self.listing.names(above) if above else []
        beside = [posixpath.splitext(name)[1] for name in names if posixpath.join(above, name) in self.tree.files]
        if not any(beside):
            return ""
        most_common = max(sorted(set(beside) - {""}), key=beside.count)
        return f": a pattern such as '*{most_common}' does not match it"

    def _find_packages(self, call: Call) -> None:
        """Add the error of setuptools where it searches for packages and finds several."""
        if any(call.kwargs.get(name) is not None for name in _PACKAGES) or "src" in self.tree.folders:
            return
        if _configures(self.tree, _SET_PACKAGES):
            return
        folders = [name for name in self.listing.names("") if name in self.tree.folders and name.isidentifier()]
        found = sorted(name for name in folders if name not in _NO_PACKAGES and not name.startswith("_"))
        if len(found) > 1:
            reason = f"packages=[...] is missing, and setuptools cannot choose between the folders {enumerated(found)}"
            self._stop("", reason, call.at)


def _configures(tree: Tree, pattern: bytes) -> bool:
    """Return whether setup.cfg or pyproject.toml may contain a key."""
    files = [tree.files[name] for name in ("setup.cfg", "pyproject.toml") if name in tree.files]
    try:
        return any(re.search(pattern, file.read(_MAX_SETTINGS, first=True)) for file in files)
    except InputError:
        return True
