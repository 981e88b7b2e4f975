"""The files that data_files of a setup.py installs, in the order of setuptools' install_data."""

import posixpath
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import PurePosixPath
from typing import NamedTuple

from grader.files.names import ignored_part
from grader.names import did_you_mean
from grader.package.globbing import PackageListing
from grader.python.library import MAX_PATH, PACKAGE_FOLDER
from grader.python.parse import Position
from grader.python.values import PLAIN, Call, Function, Items, QualifiedName, Undetermined, Unknown, Value, unknown_in
from grader.text import enumerated

_MAX_GUESSES = 10


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

    listing: PackageListing
    root: str  # the absolute path that stands for the package's folder
    written: Mapping[str, Position]  # where each text is written
    is_first: bool = True  # whether it is the run of setup.py in which colcon asks for data_files
    copies: list[InstalledFile] = field(default_factory=list)
    stops: list[InstallError] = field(default_factory=list)
    unknown: list[Unknown] = field(default_factory=list)  # what is installed as well, or elsewhere
    doubts: list[Unknown] = field(default_factory=list)  # with these, whether the build succeeds is not known either

    def read(self, entries: Value, at: Position) -> None:
        """Add the files of the argument data_files."""
        if not isinstance(entries, list | tuple):
            self._give_up(entries, "this value of data_files is not evaluated", at)
            return
        for entry in entries:
            self._entry(entry, at)

    def finish(self) -> None:
        """Remove what is not certain: files with the same target."""
        sources: dict[str, set[str]] = defaultdict(set)
        for copy in self.copies:
            sources[copy.target].add(copy.source)
        several = [copy for copy in self.copies if len(sources[copy.target]) > 1]
        self.copies = [copy for copy in self.copies if len(sources[copy.target]) == 1]
        for target, at in {copy.target: copy.at for copy in several}.items():
            reason = f"several files are installed as {target}: {enumerated(sorted(sources[target]))}"
            self.unknown.append(Unknown(reason, at))

    def _origin(self, path: str, at: Position) -> Position:
        """Return the position of the search that finds a path, or where it is written."""
        return self.listing.positions.get(path) or self.written.get(path, at) if path else at

    def _give_up(self, value: Value, reason: str, at: Position) -> None:
        """Add the unknown parts of a value, or that it is not supported."""
        self.doubts.append(unknown_in(value) or Unknown(reason, at))

    def stop(self, reason: str, at: Position, path: str = "") -> None:
        """Add an error that stops the build."""
        self.stops.append(InstallError(path, reason, self._origin(path, at)))

    def _entry(self, entry: Value, at: Position) -> None:
        """Add an entry, which colcon takes as a file, or as a tuple of a folder and a list of files."""
        match entry:
            case str():
                self._file(entry, "", at)
            case (folder, files) if isinstance(entry, tuple):
                self._folder(folder, files, at)
            case Unknown() | Call():
                self._give_up(entry, "an entry of data_files is not evaluated", at)
            case [str() as path, *_] if len(entry) == 1:
                self.stop("an entry is a folder and a list of files; the list is missing", at, path)
            case list() | dict() | set():
                self.stop("an entry of data_files is not a tuple: write (folder, [files])", at)
            case _:
                self.stop("an entry of data_files is not a tuple of a folder and a list of files", at)

    def _folder(self, folder: Value, files: Value, at: Position) -> None:
        if not isinstance(folder, str):
            self._not_text(folder, "the folder of an entry", at)
        elif folder.startswith(self.root):
            self._give_up(None, "a target in the package itself is not supported", at)
        elif folder.startswith("/"):
            self.stop(f"the folder {folder!r} is absolute; colcon takes one below the prefix, such as share/...", at)
        elif ".." in folder.split("/") or len(folder) > MAX_PATH:
            self.unknown.append(Unknown(f"the target {folder[:MAX_PATH]} is not supported", at))
        elif isinstance(files, str) and files:
            self.stop("the files of an entry are a string, not a list: write [...] around it", at, files)
        elif isinstance(files, list):
            for file in files:
                self._file(file, folder, at)
        else:
            self._not_list(files, at)

    def _not_list(self, files: Value, at: Position) -> None:
        if isinstance(files, Items):
            self.stop("the files of an entry are an iterator, not a list: write list(...) around it", at)
        elif isinstance(files, (*PLAIN, QualifiedName, Function)):
            kind = type(files).__name__
            self.stop(f"the files of an entry are of the type {kind}, not a list: write list(...) around it", at)
        else:
            self._give_up(files, "the files of an entry are not evaluated", at)

    def _not_text(self, value: Value, what: str, at: Position) -> None:
        if isinstance(value, PurePosixPath):
            self.stop(f"{what} is a path, and colcon takes strings only: write str(...) around it", at)
        elif isinstance(value, (*PLAIN, Items, QualifiedName, Function)):
            self.stop(f"{what} is not a string: is a bracket misplaced?", at)
        else:
            self._give_up(value, f"{what} is not evaluated", at)

    def _file(self, file: Value, folder: str, at: Position) -> None:
        self.listing.budget.charge(5)
        if isinstance(file, str):
            self._path(file, folder, self._origin(file, at))
        else:
            self._not_text(file, "a file of an entry", at)

    def _path(self, text: str, folder: str, at: Position) -> None:
        is_absolute = text.startswith(self.root + "/")
        text = text.removeprefix(self.root + "/")
        if len(text) > MAX_PATH:
            self._give_up(None, "the path of a file is too long", at)
            return
        try:
            path = self.listing.real(text)
        except Undetermined:
            if text.startswith("/"):
                self.stop("the path is absolute, and colcon takes paths in the package only", at, text)
            else:
                self._give_up(None, f"{text} is outside of the package, or ignored", at)
            return
        if PACKAGE_FOLDER in text:
            self._give_up(None, "the name of the package's folder is not known", at)
        elif is_absolute and self.is_first:
            self.stop("the path is absolute, and colcon takes paths in the package only", at, text)
            self._copy(path, folder, at)
        elif path is not None and not self._copy(path, folder, at):
            reason = f"it is a folder, and only files can be installed{self._narrower(path)}"
            self.stops.append(InstallError(text, reason, at))
        elif path is None and str(PurePosixPath(text)) in self.listing.files:
            self.stop("there is no such file: a path of a file does not end in /", at, text)
        elif path is None and ignored_part(posixpath.normpath(text)):
            self._give_up(None, f"{text} is an ignored file", at)
        elif path is None:
            guess = did_you_mean(text, self.listing.files) if len(self.stops) < _MAX_GUESSES else ""
            self.stops.append(InstallError(text, "there is no such file", at, guess))

    def _copy(self, path: str | None, folder: str, at: Position) -> bool:
        """Install a file of the package; return whether it is one."""
        if path is None or path not in self.listing.files:
            return False
        target = posixpath.normpath(posixpath.join(folder, posixpath.basename(path)))
        self.copies.append(InstalledFile(path, target, at))
        return True

    def _narrower(self, folder: str) -> str:
        """Return the hint about a pattern that matches the other files next to a folder, but not the folder."""
        above = posixpath.dirname(folder)
        names = self.listing.names(above) if above else []
        beside = [posixpath.splitext(name)[1] for name in names if posixpath.join(above, name) in self.listing.files]
        if not any(beside):
            return ""
        most_common = max(sorted(set(beside) - {""}), key=beside.count)
        return f": a pattern such as '*{most_common}' does not match it"
