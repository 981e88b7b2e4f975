"""What data_files of a setup.py installs, as setuptools' install_data does it: file by file, up to the first that it cannot."""

import posixpath
import re
from collections.abc import Mapping
from pathlib import PurePosixPath
from typing import NamedTuple

from grader.errors import InputError
from grader.files.tree import Tree, is_ignored
from grader.names import did_you_mean
from grader.package.globbing import BeyondError, Listing
from grader.static_python.methods import FOLDER, names_the_folder
from grader.static_python.values import Made, Spot, TooHard, Unknown, Value, unknown_in

# Other ways to install files, which are not followed.
_OTHER_WAYS = ("package_data", "include_package_data", "cmdclass", "**")
# What gives setuptools the Python packages; without, it looks for them by itself, in folders but these.
_PACKAGES = ("packages", "py_modules", "ext_modules", "package_dir", "**")
_NO_PACKAGES = frozenset(
    {"ci", "bin", "debian", "doc", "docs", "documentation", "manpages", "news", "newsfragments", "changelog", "test", "tests",
     "unit_test", "unit_tests", "example", "examples", "scripts", "tools", "util", "utils", "python", "build", "benchmark",
     "benchmarks", "exercise", "exercises", "htmlcov", "tasks"}
)  # fmt: skip
_MOST_GUESSES = 10
_MOST_COPIES = 20_000
_MOST_PATH = 4_096
_MOST_SETTINGS = 64 * 1024


class Copy(NamedTuple):
    """One file that is installed: its path in the package, where it goes below the prefix, and the place that says so."""

    source: str
    target: str
    at: Spot


class Stop(NamedTuple):
    """Something of data_files that cannot be installed, so that the build stops."""

    path: str
    reason: str
    at: Spot
    hint: str = ""  # what the path may mean instead

    @property
    def words(self) -> str:
        """What stops the build, for a sentence."""
        return f"data_files lists {self.path!r}, but {self.reason}" if self.path else self.reason


class Entries:
    """Goes through data_files as setuptools' install_data does."""

    def __init__(self, tree: Tree, listing: Listing, root: str, places: Mapping[str, Spot]) -> None:
        """`root` is the absolute path that the package's folder goes by; `places` tells where a path comes from."""
        self.tree = tree
        self.listing = listing
        self.root = root
        self.places = places
        self.copies: list[Copy] = []
        self.stops: list[Stop] = []
        self.unknown: list[Unknown] = []

    def read(self, call: Made) -> None:
        """Take in what a call of setup() installs."""
        for name in _OTHER_WAYS:
            if call.kwargs.get(name):
                what = "arguments that are unpacked" if name == "**" else name
                self.unknown.append(Unknown(f"{what} may install files, too", call.at))
        doubt = call.kwargs.get("?")
        if isinstance(doubt, Unknown):
            self.unknown.append(doubt)
            return
        self._find_packages(call)
        entries = call.kwargs.get("data_files")
        if not entries and _configures(self.tree, b"data[_-]files"):
            self.unknown.append(
                Unknown("data_files is set in setup.cfg or pyproject.toml, which is not followed", call.at)
            )
        if entries is None:
            return
        if not isinstance(entries, list | tuple):
            self.unknown.append(unknown_in(entries) or Unknown("data_files is not followed", call.at))
            return
        for entry in entries:
            self._entry(entry, call.at)

    def _entry(self, entry: Value, at: Spot) -> None:
        if isinstance(entry, str | PurePosixPath):
            self._copy(entry, "", at)
            return
        if isinstance(entry, list | tuple) and len(entry) == 1 and isinstance(entry[0], str):
            reason = "an entry is a folder and a list of files, and here the list is missing"
            self.stops.append(Stop(entry[0], reason, self.places.get(entry[0], at)))
            return
        if not isinstance(entry, list | tuple) or len(entry) != 2:
            self.unknown.append(unknown_in(entry) or Unknown("an entry of data_files is not followed", at))
            return
        folder, files = entry
        if not isinstance(folder, str | PurePosixPath):
            self.unknown.append(unknown_in(folder) or Unknown("a folder in data_files is not followed", at))
            return
        if ".." in str(folder).split("/") or names_the_folder(str(folder)) or str(folder).startswith(self.root):
            self.unknown.append(Unknown(f"where {str(folder).replace(FOLDER, '...')} leads to is not followed", at))
            return
        if len(str(folder)) > _MOST_PATH:
            self.unknown.append(Unknown("a folder in data_files is too long to follow", at))
            return
        if isinstance(files, str) and files:
            reason = "the files of an entry are a text, not a list: write [...] around it"
            self.stops.append(Stop(files, reason, self.places.get(files, at)))
            return
        if not isinstance(files, list | tuple):
            self.unknown.append(unknown_in(files) or Unknown("the files of an entry are not followed", at))
            return
        for file in files:
            self._copy(file, str(folder), at)

    def _copy(self, file: Value, folder: str, at: Spot) -> None:
        if len(self.copies) + len(self.stops) + len(self.unknown) > _MOST_COPIES:
            raise TooHard("it installs too many files to follow")
        if isinstance(file, list | tuple | dict | int | float | None) and unknown_in(file) is None:
            self.stops.append(
                Stop("", "an entry of data_files holds something that is no file: is a bracket misplaced?", at)
            )
            return
        if not isinstance(file, str | PurePosixPath):
            self.unknown.append(unknown_in(file) or Unknown("a file in data_files is not followed", at))
            return
        at = self.places.get(str(file), at)
        text = str(file).removeprefix(self.root + "/")
        if len(text) > _MOST_PATH:
            self.unknown.append(Unknown("the path of a file is too long to follow", at))
            return
        try:
            path = self.listing.real(text)
        except BeyondError:
            self.unknown.append(Unknown(f"{text} is outside of the package", at))
            return
        if names_the_folder(text):
            self.unknown.append(Unknown("the name of the package's folder is told only by a run", at))
        elif isinstance(file, PurePosixPath) and not folder:
            self.unknown.append(Unknown("not every setuptools takes a path here", at))
        elif path is not None and path in self.tree.files:
            target = posixpath.normpath(posixpath.join(folder, posixpath.basename(path)))
            self.copies.append(Copy(path, target, at))
        elif path is not None and path in self.listing.folders:
            self.stops.append(
                Stop(
                    text,
                    f"it is a folder, and only files can be installed{self._narrower(path)}",
                    at,
                )
            )
        elif str(PurePosixPath(text)) in self.tree.files:
            self.unknown.append(Unknown(f"whether {text} is taken for a file depends on the version of setuptools", at))
        elif is_ignored(posixpath.normpath(text)):
            self.unknown.append(Unknown(f"{text} is among files that are not looked at", at))
        else:
            guess = did_you_mean(text, self.tree.files) if len(self.stops) < _MOST_GUESSES else ""
            self.stops.append(Stop(text, "there is no such file", at, guess))

    def _narrower(self, folder: str) -> str:
        """A pattern that finds the files beside a folder, but not the folder."""
        above = posixpath.dirname(folder)
        if not above:
            return ""
        beside = [
            posixpath.splitext(name)[1]
            for name in self.listing.names(above)
            if posixpath.join(above, name) in self.tree.files
        ]
        endings = [ending for ending in beside if ending]
        return f": a pattern such as '*{max(sorted(set(endings)), key=endings.count)}' leaves it out" if endings else ""

    def _find_packages(self, call: Made) -> None:
        """Note where setuptools has to look for packages and stops, because it finds several."""
        if any(call.kwargs.get(name) is not None for name in _PACKAGES) or "src" in self.tree.folders:
            return
        if _configures(
            self.tree, rb"(?m)^\s*(packages|package[_-]dir|py[_-]modules|ext[_-]modules)\b|setuptools\.packages"
        ):
            return
        folders = [name for name in self.listing.names("") if name in self.tree.folders and name.isidentifier()]
        found = sorted(name for name in folders if name not in _NO_PACKAGES and not name.startswith("_"))
        if len(found) > 1:
            reason = f"packages=[...] is missing, and setuptools cannot choose among the folders {', '.join(found)}"
            self.stops.append(Stop("", reason, call.at))

    def finish(self, change: Made | None) -> None:
        """Take back what is not sure: files that get in each other's way, or that the file itself changes."""
        sources: dict[str, set[str]] = {}
        for copy in self.copies:
            sources.setdefault(copy.target, set()).add(copy.source)
        several = [copy for copy in self.copies if len(sources[copy.target]) > 1]
        self.copies = [copy for copy in self.copies if len(sources[copy.target]) == 1]
        for target, at in {copy.target: copy.at for copy in several}.items():
            self.unknown.append(Unknown(f"several files go to {target}: {', '.join(sorted(sources[target]))}", at))
        if change is not None:
            self.copies.clear()
            self.stops.clear()
            self.unknown.append(Unknown("the file itself makes or changes files", change.at))


def _configures(tree: Tree, pattern: bytes) -> bool:
    """Whether a package's other two files of settings may hold some key."""
    for name in ("setup.cfg", "pyproject.toml"):
        file = tree.files.get(name)
        try:
            if file is not None and re.search(pattern, file.read(_MOST_SETTINGS, first=True)):
                return True
        except InputError:
            return True
    return False
