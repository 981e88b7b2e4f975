"""What a build would install by a package's setup.py: told by following the file, which is never run."""

import posixpath
import re
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import PurePosixPath
from typing import NamedTuple

from grader.errors import InputError
from grader.robot.source import Location, Source
from grader.submission.globbing import ORDERS, BeyondError, Listing
from grader.submission.python.library import plain_functions
from grader.submission.python.lookup import WRITING, EmptyGlob, file_functions
from grader.submission.python.machine import Machine
from grader.submission.python.methods import FOLDER, names_the_folder
from grader.submission.python.parse import Code, SyntaxFault
from grader.submission.python.values import Fault, Made, Spot, TooHard, Unknown, Value, unknown_in
from grader.submission.tree import Tree, is_ignored

_ROOT = f"/{FOLDER}"
_START = Spot(1, 1)
_SETUPS = ("setuptools.setup", "distutils.core.setup", "?.setup")
# Other ways to install files, which are not followed.
_OTHER_WAYS = ("package_data", "include_package_data", "cmdclass", "**")
# What gives setuptools the Python packages; without, it looks for them by itself, in folders but these.
_PACKAGES = ("packages", "py_modules", "ext_modules", "package_dir", "**")
_NO_PACKAGES = frozenset(
    {"ci", "bin", "debian", "doc", "docs", "documentation", "manpages", "news", "newsfragments", "changelog", "test", "tests",
     "unit_test", "unit_tests", "example", "examples", "scripts", "tools", "util", "utils", "python", "build", "benchmark",
     "benchmarks", "exercise", "exercises", "htmlcov", "tasks"}
)  # fmt: skip
_MOST_COPIES = 20_000
_MOST_PATH = 4_096
_MOST_SETTINGS = 64 * 1024
# Calls that make, move or delete files: what is there afterwards is not told.
_CHANGES = (
    WRITING, "os.link", "os.makedirs", "os.mkdir", "os.popen", "os.remove", "os.rename", "os.replace", "os.rmdir",
    "os.spawn", "os.exec", "os.symlink", "os.system", "os.unlink", "pathlib.Path.", "shutil.", "subprocess.", "tarfile.",
    "tempfile.", "urllib.", "xacro.", "zipfile.",
)  # fmt: skip


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

    @property
    def words(self) -> str:
        """What stops the build, for a sentence."""
        return f"data_files lists {self.path!r}, but {self.reason}" if self.path else self.reason


@dataclass(frozen=True, slots=True)
class Setup:
    """What is known of a setup.py. `fault` is set where Python cannot read it: nothing else is known then.

    `unknown` has what could not be told: a file that is not among `copies` may be installed all the same.
    """

    path: str
    source: Source
    fault: SyntaxFault | None = None
    name: str | None = None
    copies: tuple[Copy, ...] = ()
    stops: tuple[Stop, ...] = ()
    empty: tuple[EmptyGlob, ...] = ()
    faults: tuple[Fault, ...] = ()
    unknown: tuple[Unknown, ...] = ()
    is_called: bool = True
    called_at: Spot = _START
    code: Code | None = field(default=None, repr=False)

    def location(self, spot: Spot) -> Location:
        """A place in the file."""
        return place(self.source, spot)

    def installed(self) -> dict[str, str]:
        """Each installed file's source by its path below the prefix."""
        return {copy.target: copy.source for copy in self.copies}


def place(source: Source, spot: Spot) -> Location:
    """A place as Python counts it, in bytes, as a place in characters."""
    line = source.line(spot.line)
    column = len(line.encode("utf-8", "surrogateescape")[: spot.column - 1].decode("utf-8", "ignore"))
    return Location(source.path, spot.line, column + 1)


def read_setup(code: Code | SyntaxFault, tree: Tree) -> Setup:
    """Follow a setup.py whose package has these files. Never raises."""
    path = code.source.path
    if isinstance(code, SyntaxFault):
        return Setup(path, code.source, code)
    setup = _follow(code, tree, ORDERS[0])
    others = () if any(each.at == Spot(1, 1) for each in setup.unknown) else ORDERS[1:]
    if any(_outcome(_follow(code, tree, order)) != _outcome(setup) for order in others):
        doubt = Unknown("what is installed depends on the order in which folders are listed", Spot(1, 1))
        return replace(setup, copies=(), stops=(), unknown=(*setup.unknown, doubt))
    return setup


def _outcome(setup: Setup) -> tuple[set[Copy], set[Stop], set[Fault]]:
    return set(setup.copies), set(setup.stops), set(setup.faults)


def _follow(code: Code, tree: Tree, order: str) -> Setup:
    """What a file comes to where folders are listed in some order."""
    path = code.source.path
    listing = Listing(tree, order)
    library = {**plain_functions(_ROOT), **file_functions(listing, _ROOT)}
    machine = Machine(code, library, special={"__file__": f"{_ROOT}/setup.py"})
    machine.run()
    calls = [made for made in machine.made if made.name in _SETUPS]
    reader = _Entries(tree, listing)
    name = calls[0].kwargs.get("name") if calls else None
    try:
        for call in calls:
            reader.read(call)
    except TooHard as error:
        reader.unknown.append(Unknown(str(error), calls[0].at))
    reader.finish(next((made for made in machine.made if made.name.startswith(_CHANGES)), None))
    if machine.stopped:
        reader.unknown.append(Unknown(machine.stopped, Spot(1, 1)))
    return Setup(
        path,
        code.source,
        None,
        name if isinstance(name, str) else None,
        tuple(reader.copies),
        tuple(reader.stops),
        tuple(dict.fromkeys(note for note in machine.notes if isinstance(note, EmptyGlob))),
        tuple(sorted(machine.faults, key=lambda fault: fault.at)),
        tuple(reader.unknown),
        bool(calls) or bool(machine.stopped),
        calls[0].at if calls else Spot(1, 1),
        code,
    )


class _Entries:
    """Goes through data_files as setuptools' install_data does."""

    def __init__(self, tree: Tree, listing: Listing) -> None:
        self.tree = tree
        self.listing = listing
        self.copies: list[Copy] = []
        self.stops: list[Stop] = []
        self.unknown: list[Unknown] = []

    def read(self, call: Made) -> None:
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
            self.stops.append(Stop(entry[0], reason, at))
            return
        if not isinstance(entry, list | tuple) or len(entry) != 2:
            self.unknown.append(unknown_in(entry) or Unknown("an entry of data_files is not followed", at))
            return
        folder, files = entry
        if not isinstance(folder, str | PurePosixPath):
            self.unknown.append(unknown_in(folder) or Unknown("a folder in data_files is not followed", at))
            return
        if ".." in str(folder).split("/") or names_the_folder(str(folder)) or str(folder).startswith(_ROOT):
            self.unknown.append(Unknown(f"where {str(folder).replace(FOLDER, '...')} leads to is not followed", at))
            return
        if len(str(folder)) > _MOST_PATH:
            self.unknown.append(Unknown("a folder in data_files is too long to follow", at))
            return
        if isinstance(files, str) and files:
            reason = "the files of an entry are a text, not a list: write [...] around it"
            self.stops.append(Stop(files, reason, at))
            return
        if not isinstance(files, list | tuple):
            self.unknown.append(unknown_in(files) or Unknown("the files of an entry are not followed", at))
            return
        for file in files:
            self._copy(file, str(folder), at)

    def _copy(self, file: Value, folder: str, at: Spot) -> None:
        if len(self.copies) + len(self.stops) + len(self.unknown) > _MOST_COPIES:
            raise TooHard("it installs too many files to follow")
        if not isinstance(file, str | PurePosixPath):
            self.unknown.append(unknown_in(file) or Unknown("a file in data_files is not followed", at))
            return
        text = str(file).removeprefix(_ROOT + "/")
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
        elif path in self.listing.folders:
            self.stops.append(Stop(text, "it is a folder, and only files can be installed", at))
        elif str(PurePosixPath(text)) in self.tree.files:
            self.unknown.append(Unknown(f"whether {text} is taken for a file depends on the version of setuptools", at))
        elif is_ignored(posixpath.normpath(text)):
            self.unknown.append(Unknown(f"{text} is among files that are not looked at", at))
        else:
            self.stops.append(Stop(text, "there is no such file", at))

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


def near_misses(path: str, tree: Tree) -> Iterator[str]:
    """Files of a package that a path or pattern without a match may have meant: the same folder, or a similar name."""
    from grader.robot.names import closest

    folder = posixpath.dirname(path)
    below = [each for each in tree.files if posixpath.dirname(each) == folder]
    if folder and folder not in tree.folders:
        similar = closest(folder, tree.folders)
        below = [each for each in tree.files if similar and posixpath.dirname(each) == similar]
    yield from below[:5]
